// Where the lines along n through the elements of a row meet a surface of revolution: all elements
// side by side, each by Newton's step from the row's middle, along which both unknowns are known to
// the second order.
#pragma once

#include "geometry/placement.hpp"
#include "geometry/profile.hpp"

namespace railpatch {

// A surface's meridian u(t), r(t) on one piece of its profile, t from the piece's begin, and the
// lines: q = q0 + x qx + n qn in the surface's axes, the second of which is its own.
struct row_of_lines {
  profile_piece meridian;  // m: y is u, z is r
  vec3 q0{}, qx{}, qn{};
  double p = 0, n = 0;  // m, of the middle, x = 0
};

// Least cosine between n and a surface's normal.
constexpr double grazing_cosine = 0.03;
// m, of newton's step, which leaves an error quadratic in it
constexpr double close_step = 4e-7;

// Arc lengths p (m) and heights n (m) at x = x0 + i dx; off: 1 where a step is not enough, or the
// piece has ended, else 0.
void meet_row(const row_of_lines &row, double x0, double dx, int count, double *p, double *n,
              double *off);

}  // namespace railpatch
