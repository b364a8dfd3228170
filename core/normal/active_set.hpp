// Normal contact of viscoelastic bodies in rolling: that of normal.hpp with an operator that is not
// symmetric, where conjugate gradients have no ground.
//
// Newton's method on e = h + A p - approach, p = max(0, p - r e) (primal-dual active set:
// Hintermueller, Ito and Kunisch 2003, SIAM J. Optim. 13): with the contact area C, the elements
// with p > 0 or e < 0, a round solves
//   A_CC dp = -e_C, with the force given also dp summing to what it lacks and e but for a constant,
// by GMRES with an approximate inverse along the rows as preconditioner, cuts p at zero and looks
// at the area again. Rounds end where e is within the tolerance on the area and p >= 0, e >= 0
// hold, which is all that is asked of a solution; A is positive (half_space/viscous_influence.hpp),
// so there is one only. Where rounds return to areas they have had, their steps get shorter, until
// the area stays.
#pragma once

#include "half_space/viscous_influence.hpp"
#include "normal/normal.hpp"
#include "numeric/gmres.hpp"

namespace railpatch {

class active_set_solver {
 public:
  explicit active_set_solver(int max_count);

  // pressure holds the start (all zero: none) and the solution; of the grid that a has.
  // iterations: products.
  normal_result with_approach(viscous_influence &a, const grid &g,
                              const double *undeformed_distance, double approach,
                              const normal_options &options, double *pressure);
  normal_result with_force(viscous_influence &a, const grid &g, const double *undeformed_distance,
                           double force, const normal_options &options, double *pressure);
  size_t bytes() const;

 private:
  struct problem;
  normal_result solve(problem &s, double *pressure);
  void start(problem &s, double *pressure);
  void scale_to_force(const problem &s, double *pressure) const;
  void evaluate(problem &s, const double *pressure);
  void find_area(problem &s, const double *pressure);
  void find_step(problem &s, const double *pressure);
  void advance(problem &s, double *pressure);
  void precondition(problem &s, double *v);
  void spread(const problem &s, const double *v);
  void gather(const problem &s, const double *field, double *v) const;

  static constexpr int krylov_size = 40, max_products = 120;
  aligned_buffer<double> displacement_, error_, field_, image_, right_, step_, ones_;
  aligned_buffer<int> area_;
  aligned_buffer<unsigned char> inside_;
  gmres linear_solver_;
};

}  // namespace railpatch
