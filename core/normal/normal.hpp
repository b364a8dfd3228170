// Normal contact on the half-space: pressure and contact area, approach or force prescribed.
//
// Find p >= 0 with e = h + A p - approach, e = 0 where p > 0 and e >= 0 elsewhere (h: undeformed
// distance, negative where the undeformed bodies overlap). Bound-constrained conjugate gradients
// (Polonsky and Keer 1999, Wear 231) with the circulant inverse of A as preconditioner (Vollebregt
// 2014, J. Comput. Phys. 257), projected on constant force where the force is prescribed.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/interrupt.hpp"

namespace railpatch {

// Contact areas close to each other, solved on one grid with their mutual influence reduced: part k
// holds the rows from first_row[k] up to first_row[k+1]; factor[k] (0 ... 1) between parts k, k+1.
struct contact_parts {
  static constexpr int capacity = 8;
  int count = 1;
  int first_row[capacity] = {};
  double factor[capacity - 1] = {};
};

struct normal_options {
  double tolerance;  // of e on the contact area, relative to the greatest displacement
  int max_iterations;
  interrupt ask{};
  // one or two elements either way are all the bodies that there are: no border that way
  bool strips = false;
  // the grid has grown with the contact: so has the start
  bool grows = false;
};

struct normal_result {
  bool converged = false;
  bool touches_border = false;  // the contact area reaches the edge of the grid
  double approach = 0;          // m, rigid shift added to the undeformed distance
  double normal_force = 0;      // N
  double residual = 0;          // -
  double scale = 0;             // m, greatest displacement
  int iterations = 0;
  int contact_count = 0;
};

// The approach (m) that leaves no mean error of the gap where n elements with the pressure p touch.
double mean_approach(size_t n, const double *undeformed_distance, const double *displacement,
                     const double *p);

// Elements in contact, and whether they reach the border.
void count_contact(const grid &g, const double *pressure, bool strips, normal_result &result);

class normal_solver {
 public:
  explicit normal_solver(int max_count);

  // pressure holds the start (all zero: none) and the solution.
  normal_result with_approach(influence &a, const grid &g, const double *undeformed_distance,
                              double approach, const normal_options &options, double *pressure,
                              const contact_parts &parts = {});
  normal_result with_force(influence &a, const grid &g, const double *undeformed_distance,
                           double force, const normal_options &options, double *pressure,
                           const contact_parts &parts = {});
  // u = A p, the influence between separate parts reduced; single precision where not exact.
  void product(influence &a, const grid &g, const contact_parts &parts, const double *pressure,
               double *displacement, bool exact);
  size_t bytes() const;

 private:
  struct problem;
  normal_result solve(problem &state, double *pressure);
  void start(problem &state, double *pressure);
  // single: for what only steers the iteration
  enum class precision { full, single };
  void product(problem &state, const double *pressure, double *displacement, precision digits);
  void cold_start(problem &state, double *pressure);
  void fit_size(problem &state, double *pressure);
  void evaluate(problem &state, const double *pressure);
  void check_conditions(problem &state, const double *pressure);
  bool search_direction(problem &state, bool restart);
  bool advance(problem &state, double *pressure);
  void scale_to_force(problem &state, double *pressure);

  aligned_buffer<double> displacement_, error_, residual_, direction_, product_, preconditioned_,
      ones_, previous_, part_pressure_, part_displacement_;
  aligned_buffer<unsigned char> free_;
};

}  // namespace railpatch
