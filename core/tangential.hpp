// Steady rolling contact with Coulomb friction, full theory (Kalker 1990, chapter 4).
//
// Unknown: traction p = (p_x, p_y) on the wheel in each element of the contact area. Micro-slip,
// wheel minus rail and over the rolling speed: s = w + B p with the rigid slip
//   w_x = xi - phi y, w_y = eta + phi (x + offset)
// and B p = (u(x) - u(x + direction dx))/dx. Stick: s = 0, |p| <= g; slip: |p| = g, p opposite to
// s. Both are p = projection of p - r s on |p| <= g, solved by a semi-smooth Newton method; with q
// = p - r s, n = q/|q|, theta = g/|q| the residual and its derivative are
//   stick (|q| <= g): F = r s,        dF = r B dp
//   slip:             F = p - g n,    dF = dp - theta (I - n n^T)(dp - r B dp).
// Linear systems: GMRES, products by FFT, exact row blocks as preconditioner.
#pragma once

#include "gmres.hpp"
#include "influence.hpp"
#include "row_blocks.hpp"

namespace railpatch {

struct rolling_input {
  double creepage[2] = {0, 0};  // longitudinal, lateral
  double spin_creepage = 0;     // rad/m
  int direction = 1;            // rolling towards +x or -x
  double spin_offset = 0;       // m, added to x in the spin term
  double slip(int component, double x, double y) const {
    return component == 0 ? creepage[0] - spin_creepage * y
                          : creepage[1] + spin_creepage * (x + spin_offset);
  }
};

struct tangential_options {
  double tolerance;    // of the residual, relative to that of zero traction
  int max_iterations;  // Newton steps
};

struct tangential_result {
  bool converged = false;
  double residual = 0;
  int newton_iterations = 0;
  int products = 0;
  int stick = 0, slip = 0;
  double friction = 0;  // N, frictional power over the rolling speed, see below
};

// In steady rolling the elastic energy is constant, so friction takes exactly the power that the
// rigid motion supplies: friction = -sum p . w dA >= 0. Summing p . s instead loses
// (Dp) A (Dp)/(2 dx) >= 0 with D the difference over one element: half the power on coarse grids.

// Outputs of every tangential method, [ny][nx].
struct tangential_fields {
  double *px, *py;          // Pa on the wheel; start in, solution out
  double *sx, *sy;          // micro-slip, relative to the rolling speed
  unsigned char *division;  // rp_element
};

class tangential_solver {
 public:
  tangential_solver(int max_nx, int max_ny);

  // bound: traction bound g on the grid (Pa), zero outside the contact area (pressure > 0).
  tangential_result solve(influence &a, const grid &g, const double *pressure, const double *bound,
                          const rolling_input &input, const tangential_options &options,
                          tangential_fields fields);
  size_t bytes() const;

 private:
  void collect(const grid &g, const double *pressure, const double *bound,
               const rolling_input &input, const tangential_fields &fields);
  void elastic_slip(influence &a, const double *v, double *out);
  void micro_slip(influence &a, const double *p, double *s);
  double residual(const double *p, const double *s, double *f) const;
  double scale() const;
  void linearise(influence &a, const double *p, const double *s);
  void apply_jacobian(influence &a, const double *v, double *out);
  void project(double *p) const;
  double try_step(influence &a, double length);
  double line_search(influence &a, double current, int &products);
  void release(const grid &g, tangential_fields fields, tangential_result &result);

  size_t vector_size() const { return 2 * static_cast<size_t>(count_); }
  template <class F>
  void for_each_element(F &&f) const;

  int count_ = 0, rows_ = 0;
  int nx_ = 0;
  int direction_ = 1;
  double r_ = 0, dx_ = 0;
  aligned_buffer<int> column_, row_of_, row_start_;  // element -> grid column and row; row starts
  aligned_buffer<double> bound_, rigid_, p_, s_, f_, step_, right_, trial_p_, trial_s_, trial_f_;
  aligned_buffer<double> grid_px_, grid_py_, grid_sx_, grid_sy_;
  aligned_buffer<element_linearisation> linear_;
  row_blocks blocks_;
  gmres linear_solver_;
};

}  // namespace railpatch
