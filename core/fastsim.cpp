#include "fastsim.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "railpatch.h"

namespace railpatch {

namespace {

// rows a/b = 0.1 ... 1 and then b/a = 0.9 ... 0.1; columns c11, c22, c23 at nu = 0, 1/4, 1/2
constexpr std::array<std::array<double, 9>, 19> table = {{
    {2.51, 3.31, 4.85, 2.51, 2.52, 2.53, 0.334, 0.473, 0.731},
    {2.59, 3.37, 4.81, 2.59, 2.63, 2.66, 0.483, 0.603, 0.809},
    {2.68, 3.44, 4.80, 2.68, 2.75, 2.81, 0.607, 0.715, 0.889},
    {2.78, 3.53, 4.82, 2.78, 2.88, 2.98, 0.720, 0.823, 0.977},
    {2.88, 3.62, 4.83, 2.88, 3.01, 3.14, 0.827, 0.929, 1.07},
    {2.98, 3.72, 4.91, 2.98, 3.14, 3.31, 0.930, 1.03, 1.18},
    {3.09, 3.81, 4.97, 3.09, 3.28, 3.48, 1.03, 1.14, 1.29},
    {3.19, 3.91, 5.05, 3.19, 3.41, 3.65, 1.13, 1.25, 1.40},
    {3.29, 4.01, 5.12, 3.29, 3.54, 3.82, 1.23, 1.36, 1.51},
    {3.40, 4.12, 5.20, 3.40, 3.67, 3.98, 1.33, 1.47, 1.63},
    {3.51, 4.22, 5.30, 3.51, 3.81, 4.16, 1.44, 1.59, 1.77},
    {3.65, 4.36, 5.42, 3.65, 3.99, 4.39, 1.58, 1.75, 1.94},
    {3.82, 4.54, 5.58, 3.82, 4.21, 4.67, 1.76, 1.95, 2.18},
    {4.06, 4.78, 5.80, 4.06, 4.50, 5.04, 2.01, 2.23, 2.50},
    {4.37, 5.10, 6.11, 4.37, 4.90, 5.56, 2.35, 2.62, 2.96},
    {4.84, 5.57, 6.57, 4.84, 5.48, 6.31, 2.88, 3.24, 3.70},
    {5.57, 6.34, 7.34, 5.57, 6.40, 7.51, 3.79, 4.32, 5.01},
    {6.96, 7.78, 8.82, 6.96, 8.14, 9.79, 5.72, 6.63, 7.89},
    {10.7, 11.7, 12.9, 10.7, 12.8, 16.0, 12.2, 14.6, 18.0},
}};

double axis_ratio_of(size_t row) {
  const double step = 0.1 * static_cast<double>(row + 1);
  return row < 10 ? step : 1.0 / (2.0 - step);
}

// parabola through the values at nu = 0, 1/4, 1/2
double at_poisson_ratio(const double *v, double nu) {
  const double t = 4.0 * nu;
  return v[0] * (t - 1.0) * (t - 2.0) / 2.0 - v[1] * t * (t - 2.0) + v[2] * t * (t - 1.0) / 2.0;
}

struct flexibilities {
  double l1, l2, l3;  // m/Pa
};

flexibilities from_kalker(const kalker_coefficients &c, double shear_modulus,
                          const double semi_axes[2]) {
  const double a = semi_axes[0];
  return {8.0 * a / (3.0 * c.c11 * shear_modulus), 8.0 * a / (3.0 * c.c22 * shear_modulus),
          std::numbers::pi * a * std::sqrt(a / semi_axes[1]) / (4.0 * c.c23 * shear_modulus)};
}

}  // namespace

kalker_coefficients interpolate_kalker(double axis_ratio, double poisson_ratio) {
  const double clamped = std::clamp(axis_ratio, 0.1, 10.0);
  size_t row = 0;
  while (row + 2 < table.size() && axis_ratio_of(row + 1) < clamped) ++row;
  const double lower = std::log(axis_ratio_of(row)), upper = std::log(axis_ratio_of(row + 1));
  const double t = (std::log(clamped) - lower) / (upper - lower);
  double c[3];
  for (size_t k = 0; k < 3; ++k)
    c[k] = (1.0 - t) * at_poisson_ratio(&table[row][3 * k], poisson_ratio) +
           t * at_poisson_ratio(&table[row + 1][3 * k], poisson_ratio);
  return {c[0], c[1], c[2], axis_ratio >= 0.1 && axis_ratio <= 10.0};
}

tangential_result fastsim(const elastic_constants &elastic, const grid &g, const double *pressure,
                          const double *bound, const double *leading, const double semi_axes[2],
                          const rolling_input &input, tangential_fields fields) {
  const kalker_coefficients c =
      interpolate_kalker(semi_axes[0] / semi_axes[1], elastic.poisson_ratio);
  const flexibilities l = from_kalker(c, elastic.shear_modulus, semi_axes);
  tangential_result result;
  for (int j = 0; j < g.ny; ++j) {
    double px = 0, py = 0, before = leading[j];
    for (int n = 0; n < g.nx; ++n) {
      const int i = input.direction > 0 ? g.nx - 1 - n : n;
      const int at = j * g.nx + i;
      fields.px[at] = fields.py[at] = fields.sx[at] = fields.sy[at] = 0;
      fields.division[at] = static_cast<unsigned char>(RP_EXTERIOR);
      if (!(pressure[at] > 0)) continue;
      // rigid slip at the middle of the step from the previous point
      const double x = g.x(i), length = std::abs(before - x);
      const double middle = 0.5 * (before + x) + input.spin_offset, y = g.y(j);
      const double wx = input.creepage[0] - input.spin_creepage * y * l.l1 / l.l3;
      const double wy = input.creepage[1] + input.spin_creepage * middle * l.l2 / l.l3;
      px -= length * wx / l.l1;
      py -= length * wy / l.l2;
      before = x;
      const double size = std::hypot(px, py);
      const bool slip = size > bound[at];
      if (slip) {
        const double cut = 1.0 - bound[at] / size;
        fields.sx[at] = -l.l1 * cut * px / length;
        fields.sy[at] = -l.l2 * cut * py / length;
        px -= cut * px;
        py -= cut * py;
      }
      fields.px[at] = px;
      fields.py[at] = py;
      result.friction -= (px * wx + py * wy) * length * g.dy;
      fields.division[at] = static_cast<unsigned char>(slip ? RP_SLIP : RP_STICK);
      ++(slip ? result.slip : result.stick);
    }
  }
  result.converged = c.in_range;
  return result;
}

}  // namespace railpatch
