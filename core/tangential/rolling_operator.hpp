// The tangential problem on rows of elements as the Newton methods see it, and what a
// discretisation gives them. Notation and vectors: rolling_newton.hpp.
#pragma once

#include "numeric/interrupt.hpp"
#include "numeric/nan.hpp"
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
  interrupt ask{};
};

struct tangential_result {
  bool converged = false;
  bool out_of_range = false;  // not converged, since the prescribed force cannot be carried
  bool of_heat = false;       // not converged, as friction and temperature do not agree
  double residual = 0;
  int newton_iterations = 0;
  int products = 0;
  int stick = 0, slip = 0;
  double friction = 0;  // N, frictional power over the rolling speed, see below
  // Pa m, p . A p over the elements, where it is known
  double stored = nan;
};

// In steady rolling the elastic energy is constant, so friction takes exactly the power that the
// rigid motion supplies: friction = -sum p . w dA >= 0. Summing p . s instead loses
// (Dp) A (Dp)/(2 dx) >= 0 with D the difference over one element: half the power on coarse grids.

}  // namespace railpatch
