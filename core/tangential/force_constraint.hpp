// Prescribed creep force in steady rolling: the creepages that carry it as further unknowns of the
// Newton method of rolling_newton.hpp.
//
// With a component c of the creep force prescribed, the creepage xi_c is unknown and joins p:
//   F(p, xi) = 0,  R p = T,  R_c p = sum over the elements of area p_c.
// The Newton step solves [J C; R -delta](dp, dxi) = (-F, T - R p) with C = dF/dxi, by GMRES with
// block elimination as preconditioner: with M the row blocks, S = R M^-1 C + delta,
//   z = M^-1 a,  dxi = S^-1 (R z - b),  dp = z - M^-1 C dxi.
// S stands for -dF/dxi > 0 of the creep curve and vanishes where all slips; delta, a millionth of
// the curve's initial slope (less far out), keeps the step finite and its sign right there, and
// vanishes from the solution with T - R p. The force counts with the weight |g|/(sum of area g)
// among the equations of the elements, so that 1e-5 of it is 1e-5 of full sliding.
//
// The creep curve is concave: seen from too small a creepage the step is too short, seen from full
// sliding it is far too long. Steps therefore are bounded to half of the present creepage and half
// of what the linear theory needs for full sliding, `unit`; traction follows the shortened step by
// M^-1 C. Since creepage at most grows by half a step and 1000 times the unit or the given rigid
// slip are the end, a force that cannot be carried ends the iteration too.
#pragma once

#include <algorithm>

#include "numeric/gmres.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct rolling_problem;

// Components that are not prescribed have creepage 0 here: theirs is part of the rigid slip.
struct prescribed_force {
  bool component[2] = {false, false};  // longitudinal, lateral
  double force[2] = {0, 0};            // N on the wheel
  double creepage[2] = {0, 0};         // -, start in, found out
};

class force_constraint {
 public:
  explicit force_constraint(int max_elements);
  size_t bytes() const { return 4 * column_[0].bytes() + 2 * row_[0].bytes(); }

  // Begins a solve; tolerance: of the force, relative.
  void begin(const rolling_problem &problem, double tolerance);
  int unknowns() const { return unknowns_; }
  int component(int m) const { return component_[m]; }
  // What zero traction leaves of R p = T.
  double size() const { return weight_ * target_size_; }
  // T - R p of an unknown, and of all together |T - R p|; weighted.
  double remainder(int m, const rolling_problem &problem) const;
  double miss(const rolling_problem &problem, const double *p) const;
  // Whether the force is beyond friction, or the creepage has come to its end without carrying it.
  bool beyond() const { return beyond_; }

  // flexibility: L of the simplified theory for x and y, over the ramp of areas in
  // row_newton::march, which carries ramp_force in either component.
  void set_units(const rolling_problem &problem, const double flexibility[2], double ramp_force);
  // Start: the creepages with which the simplified theory carries the force.
  void guess(const rolling_problem &problem, const double flexibility[2]);

  // Whether a start lies on the flat of the creep curve and is far from a solution (relative
  // residual) or carries more than the force asked for: nothing there says how far to go back.
  bool overshoots(const rolling_problem &problem, const double *p, double residual) const;

  // The creepages of the present solution, and of a trial along the step.
  void keep(const rolling_problem &problem);
  void go_back(const rolling_problem &problem) const { move(problem, 0.0); }
  void move(const rolling_problem &problem, double length) const;

  // The creepages of the best solution so far.
  void remember();
  void recall(const rolling_problem &problem);
  // Steps of row_newton::extragradient, in which the creepage steps against the force
  // that is missing: xi - length sigma (T - R p), one unit where all of friction is missing. The
  // operator (s(p, xi), T - R p) is as monotone as s alone: the parts with xi cancel. `pull` steps
  // to a trial and adds to the squares of the step and of the operator's change over it, in the
  // metric 1/sigma; `pull_again` steps from the present creepages with the trial's force, and
  // keeps.
  void pull(const rolling_problem &problem, const double *p, const double *trial_p, double length,
            double *moved, double *turned) const;
  void pull_again(const rolling_problem &problem, const double *trial_p, double length);

  // The bordered system over n unknowns of the elements; column(m) and row(m) are to be filled
  // before `solve`, which takes the elements' Jacobian, apply(v, out), and preconditioner,
  // precondition(v), in place. The step is bounded.
  double *column(int m) { return column_[m].data(); }
  double *row(int m) { return row_[m].data(); }
  double weight() const { return weight_; }
  template <class Apply, class Precondition>
  void solve(gmres &solver, size_t n, const double *right, double *step, double tolerance,
             int most_products, Apply &&apply_elements, Precondition &&precondition_elements) {
    for (int m = 0; m < unknowns_; ++m) {
      std::copy_n(column_[m].data(), n, reduced_[m].data());
      precondition_elements(reduced_[m].data());
    }
    factor(n);
    solver.solve(
        n + static_cast<size_t>(unknowns_), right, step, tolerance, most_products,
        [&](const double *v, double *out) {
          apply_elements(v, out);
          apply(n, v, out);
        },
        [&](double *v) {
          precondition_elements(v);
          precondition(n, v);
        });
    bound_step(n, step);
  }
  // Whether the last step was bounded: on the way to another creepage, the residual need not fall.
  // Not more often than the way from one end to the other takes.
  bool travels() const { return shortened_ && travelled_ <= longest_way; }

 private:
  void factor(size_t n);
  // out has J v of the elements and gets the rest.
  void apply(size_t n, const double *v, double *out) const;
  // v has M^-1 of the elements' part and becomes the preconditioned vector.
  void precondition(size_t n, double *v) const;
  // Bounds the creepages' part of a Newton step v and lets the elements' part follow.
  void bound_step(size_t n, double *v);
  double carried(int m, const rolling_problem &problem, const double *p) const;
  void solve_schur(const double s[2][2], double *b) const;
  bool bounded(const double *creepage, double *step) const;

  int unknowns_ = 0, component_[2] = {0, 0};
  double target_[2] = {0, 0}, target_size_ = 0;  // N
  double capacity_ = 0;                          // N, sum of area g
  double weight_ = 0, unit_[2] = {1, 1};
  double kept_[2] = {0, 0}, best_[2] = {0, 0}, step_[2] = {0, 0}, delta_[2] = {0, 0},
         schur_[2][2] = {};
  bool beyond_ = false, shortened_ = false;
  int travelled_ = 0;
  static constexpr int longest_way = 30;
  aligned_buffer<double> column_[2], reduced_[2], row_[2];
};

}  // namespace railpatch
