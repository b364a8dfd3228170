// Steady rolling contact with Coulomb friction, full theory (Kalker 1990, chapter 4), on the
// uniform grid of the normal problem.
//
// Rigid slip, wheel minus rail and over the rolling speed:
//   w_x = xi - phi y, w_y = eta + phi (x + offset);
// the tractions add B p = (u(x) - u(x + direction dx))/dx, a product by FFT. Equations and solver:
// rolling_newton.hpp.
#pragma once

#include "influence.hpp"
#include "rolling_newton.hpp"

namespace railpatch {

struct rolling_input {
  double creepage[2] = {0, 0};        // longitudinal, lateral
  double spin_creepage = 0;           // rad/m
  int direction = 1;                  // rolling towards +x or -x
  double spin_offset = 0;             // m, added to x in the spin term
  prescribed_force *force = nullptr;  // its components' creepages above are then 0
  double slip(int component, double x, double y) const {
    return component == 0 ? creepage[0] - spin_creepage * y
                          : creepage[1] + spin_creepage * (x + spin_offset);
  }
};

// Outputs of every tangential method, [ny][nx].
struct tangential_fields {
  double *px, *py;          // Pa on the wheel; start in, solution out
  double *sx, *sy;          // micro-slip, relative to the rolling speed
  unsigned char *division;  // rp_element
};

class tangential_solver {
 public:
  // forced: for inputs with a prescribed force.
  tangential_solver(int max_nx, int max_ny, bool forced);

  // bound: traction bound g on the grid (Pa), zero outside the contact area (pressure > 0).
  tangential_result solve(influence &a, const grid &g, const double *pressure, const double *bound,
                          const rolling_input &input, const tangential_options &options,
                          tangential_fields fields);
  size_t bytes() const;

 private:
  class grid_operator;
  void collect(const grid &g, const double *pressure, const double *bound,
               const rolling_input &input, const tangential_fields &fields);
  void release(const grid &g, tangential_fields fields) const;
  // f(element, grid index, indices of its components in vectors)
  template <class F>
  void for_each_element(F &&f) const;

  int count_ = 0, rows_ = 0;
  aligned_buffer<int> at_, row_start_;  // element -> index on the grid; first elements of the rows
  aligned_buffer<double> bound_, area_, rigid_, p_, s_;
  aligned_buffer<double> grid_px_, grid_py_, grid_sx_, grid_sy_;
  aligned_buffer<double> line_[2];  // the preconditioner's B in a row by offset, xx and yy
  rolling_newton newton_;
};

}  // namespace railpatch
