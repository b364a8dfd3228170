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

#include <optional>

#include "numeric/gmres.hpp"
#include "numeric/row_blocks.hpp"
#include "tangential/force_constraint.hpp"
#include "tangential/row_elements.hpp"

namespace railpatch {

// Arrays belong to the caller.
struct rolling_problem {
  int rows = 0;
  const int *row_start = nullptr;      // [rows + 1], first element of each row
  const double *bound = nullptr;       // Pa, g of each element
  const double *area = nullptr;        // m^2, of each element
  const double *rigid_slip = nullptr;  // -, w, vector
  double *traction = nullptr;          // Pa, p, vector: start in, solution out
  double *micro_slip = nullptr;        // -, s, vector: out
  prescribed_force *force = nullptr;   // null: all creepages are part of the rigid slip
  // what is to be added to the rigid slip
  double creepage(int component) const { return force ? force->creepage[component] : 0.0; }
  int count() const { return row_start[rows]; }
};

// What a discretisation gives: micro-slip (-) from tractions (Pa). B is linear, or else the
// derivative of the micro-slip at the traction of the last call of linearise.
class rolling_operator {
 public:
  virtual ~rolling_operator() = default;
  // s = B v; v is kept.
  virtual void product(const double *v, double *s) = 0;
  // The same to some five digits, for what only steers the iteration.
  virtual void product_single(const double *v, double *s) { product(v, s); }
  // The micro-slip, w + B p where B is linear; w with the creepages that are unknown.
  virtual void micro_slip(const rolling_problem &problem, const double *p, double *s);
  // Sets B where the micro-slip is not linear, at the traction of the last call of micro_slip;
  // before the first call B is that of any fixed traction.
  virtual void linearise() {}
  // ds/dxi of a component of the creepage, as B at the traction of the last call of linearise.
  virtual void slip_of_creepage(const rolling_problem &problem, int component, double *s) const;
  // The parts of B within a row of n elements, s_x from p_x and s_y from p_y: n x n, column-major
  // (source by source), or what stands for them in the preconditioner.
  virtual void row_matrices(int row, double *bxx, double *byy) const = 0;
  // The row whose matrices begin with those of every other one; -1: there is none.
  virtual int common_row(const rolling_problem &) const { return -1; }
  // The row's part of B v where v is zero from this row on; false where that costs as much as a
  // product.
  virtual bool product_of_rows_before(int, const double *, double *) { return false; }
  // r of a row's elements, Pa: the inverse of a typical diagonal entry of B.
  virtual double projection_scale(int row) const = 0;
};

struct tangential_options {
  double tolerance;    // of the residual, relative to that of zero traction
  int max_iterations;  // Newton steps
};

struct tangential_result {
  bool converged = false;
  bool out_of_range = false;  // not converged, since the prescribed force cannot be carried
  double residual = 0;
  int newton_iterations = 0;
  int products = 0;
  int stick = 0, slip = 0;
  double friction = 0;  // N, frictional power over the rolling speed, see below
};

// In steady rolling the elastic energy is constant, so friction takes exactly the power that the
// rigid motion supplies: friction = -sum p . w dA >= 0. Summing p . s instead loses
// (Dp) A (Dp)/(2 dx) >= 0 with D the difference over one element: half the power on coarse grids.

class rolling_newton {
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
  // one solve's problem and operator, so that the steps need not pass them on
  struct task;
  double start(task &t, double size);
  void find_flexibility(task &t);
  void march(task &t, double *p);
  void accept_trial(task &t);
  double slide(task &t, double error, double goal);
  double descend(task &t, double goal);
  void projected_step(const task &t, const double *s, double length, double *out) const;
  double scale(const task &t) const;
  void micro_slip(task &t, const double *p, double *s);
  double residual(const task &t, const double *p, const double *s, double *f) const;
  void project(const task &t, double *p) const;
  void share_factors(task &t);
  void linearise(task &t);
  template <class F>
  size_t for_each_unknown(const task &t, F &&f) const;
  void expand(const task &t, const double *z, double *dp) const;
  void find_step(task &t, double tolerance);
  void solve_bordered(task &t, size_t size, double tolerance);
  void apply_jacobian(task &t, const double *v, double *out);
  void precondition(task &t, double *z);
  double try_step(task &t, double length);
  double line_search(task &t, double current);
  void finish(task &t);

  aligned_buffer<double> r_;  // per element
  aligned_buffer<double> f_, step_, best_p_, right_, unknowns_, normal_step_, trial_p_, trial_s_,
      trial_f_;
  aligned_buffer<double> row_matrix_[2], row_slip_;
  aligned_buffer<element_linearisation> linear_;
  aligned_buffer<unsigned char> stick_;
  row_blocks blocks_;
  gmres linear_solver_;
  std::optional<force_constraint> force_;
};

}  // namespace railpatch
