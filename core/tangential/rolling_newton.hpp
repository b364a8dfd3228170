// Semi-smooth Newton method for steady rolling with Coulomb friction, for any discretisation whose
// elements lie in rows along rolling (Kalker 1990, chapter 4).
//
// Unknown: traction p = (p_x, p_y) in each element. Micro-slip, wheel minus rail and over the
// rolling speed: s = w + B p, with the rigid slip w and the operator B that the discretisation
// gives. Stick: s = 0, |p| <= g; slip: |p| = g, p opposite to s. Both are p = projection of
// p - r s on |p| <= g; with q = p - r s, n = q/|q|, theta = g/|q| the residual and its derivative
//   stick (|q| <= g): F = r s,        dF = r B dp
//   slip:             F = p - g n,    dF = dp - theta (I - n n^T)(dp - r B dp).
// r > 0 is a scale of the equations, one number per row, and does not change their solution.
// A slipping element's traction moves along its bound only, so the linear systems have two unknowns
// in an element that sticks and one in an element that slips. They are solved by GMRES with row
// blocks (numeric/row_blocks.hpp) as preconditioner.
//
// Convergence from any start. The problem is the variational inequality: find p with |p| <= g and
// s(p) . (q - p) >= 0 for all q with |q| <= g (sums with the elements' areas). On a grid of equal
// elements B is monotone: with S the shift by one element, A symmetric positive and unchanged by
// the shift, p . B p = p . A (p - S p)/dx = (p - S p) . A (p - S p)/(2 dx) > 0 for p other than 0.
// So there is one solution p*, and the extragradient step (Korpelevich 1976; Khobotov 1987)
//   q = P(p - t r s(p)),  p <- P(p - t r s(q)),  t so small that |t r (s(q) - s(p))| <= |q -
//   p|/2^0.5
// (norm with weights area/r, in which P, the projection on |p| <= g, is the same) never moves away
// from p*, |p_new - p*|^2 <= |p - p*|^2 - |p - q|^2/2, and |p - q| and with it |F| tend to 0.
// The merit is the least |F| so far. A Newton step takes the longest of five halved lengths that
// lowers |F|, else the whole one; where the merit has not come down to 0.9 of itself after five of
// them, extragradient steps from the best traction follow, at most 400 in an iteration, and go on
// in the next iterations from where they ended until they have brought it down. So the merit is
// lowered by a tenth again and again: it tends to 0. Near the solution Newton's steps are all that
// is taken. (Other discretisations inherit this as far as their B is monotone.)
//
// Full sliding. Where |r s| is great against the bound in every element, p = -g s/|s| is a
// contraction by g/|r s|: it is solved by such substitutions alone, without a Newton step.
//
// Vectors hold, row after row, the row's p_x and then its p_y (slip likewise): element k of a row
// that begins with element b and has n elements has its components at
//   2 b + (k - b) and 2 b + n + (k - b).
// Values per element are in the same order without the factor 2. Elements of a row may stand in any
// order and need not have neighbours, but the row blocks are factored fastest (and without pivots
// at their safest) where a row begins at its leading edge; no row is empty.
#pragma once

#include "numeric/row_blocks.hpp"
#include "tangential/row_newton.hpp"

namespace railpatch {

class rolling_newton : row_newton<rolling_newton, row_task> {
 public:
  // forced: for problems with a prescribed force.
  rolling_newton(int max_row, int max_rows, bool forced = false);

  tangential_result solve(rolling_operator &b, const rolling_problem &problem,
                          const tangential_options &options);
  // Whether an element sticks, after solve.
  bool sticks(int element) const { return stick_[static_cast<size_t>(element)] != 0; }
  row_blocks &blocks() { return blocks_; }
  size_t bytes() const;

 private:
  friend class row_newton<rolling_newton, row_task>;
  using task = row_task;

  // of row_newton: the law, and its derivative in the linear systems
  static constexpr double shortest_step = 0;
  void residual(const task &t, const double *p, const double *s, double *f) const;
  void resolvent(const task &t, const double *p, const double *s, double length, double *out) const;
  double start_bound(const task &t, size_t k) const { return t.problem.bound[k]; }
  void apply_jacobian(task &t, const double *z, double *out);
  void precondition(task &t, double *z);
  void border(const task &t, int component, const double *s, double *column, double *row,
              double &right);

  double start(task &t, double size);
  void iterate(task &t, double error, double size, const tangential_options &options);
  double slide(task &t, double error, double goal);
  double descend(task &t, double goal);
  void share_factors(task &t);
  void linearise(task &t);
  template <class F>
  size_t for_each_unknown(const task &t, F &&f) const;
  void expand(const task &t, const double *z, double *dp) const;
  void find_step(task &t, double tolerance);
  void finish(task &t);

  aligned_buffer<double> normal_step_, row_slip_;
  aligned_buffer<element_linearisation> linear_;
  aligned_buffer<unsigned char> stick_;
  row_blocks blocks_;
};

}  // namespace railpatch
