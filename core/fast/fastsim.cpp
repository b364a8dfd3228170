#include "fast/fastsim.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "railpatch.h"

namespace railpatch {

using std::numbers::pi;

flexibilities kalker_flexibilities(const creepage_coefficients &c, double shear_modulus,
                                   const double semi_axes[2]) {
  const double a = semi_axes[0];
  return {8.0 * a / (3.0 * c.c11 * shear_modulus), 8.0 * a / (3.0 * c.c22 * shear_modulus),
          pi * a * std::sqrt(a / semi_axes[1]) / (4.0 * c.c23 * shear_modulus)};
}

flexibilities blend(const flexibilities &l, const creepage_coefficients &c, double shear_modulus,
                    const double semi_axes[2], double capacity, const rolling_input &input) {
  const double turn = std::abs(input.spin_creepage) * 3.0 * pi * semi_axes[0] / 32.0;
  const double greatest =
      std::max({std::abs(input.creepage[0]), std::abs(input.creepage[1]), turn});
  if (!(greatest > 0)) return l;
  const double xi = input.creepage[0] / greatest, eta = input.creepage[1] / greatest;
  const double spin = turn / greatest;
  const double unit = capacity / (semi_axes[0] * semi_axes[1] * shear_modulus);
  const double saturating = hypot(unit / c.c11, unit / c.c22);
  const double creepage = greatest * hypot(xi, eta);
  const double w = saturating > 0 ? std::min(1.0, creepage / saturating / 3.0) : 1.0;
  const double one = (xi * xi + eta * eta + spin * spin) /
                     (xi * xi / l.l1 + eta * eta / l.l2 + spin * spin / l.l3);
  const auto mix = [&](double own) { return (1.0 - w) * own + w * one; };
  return {mix(l.l1), mix(l.l2), mix(l.l3)};
}

bool march(const flexibilities &l, double length, double wx, double wy, double bound, double p[2],
           double s[2]) {
  p[0] -= length * wx / l.l1;
  p[1] -= length * wy / l.l2;
  s[0] = s[1] = 0;
  const double size = hypot(p[0], p[1]);
  if (!(size > bound)) return false;
  const double cut = 1.0 - bound / size;
  s[0] = -l.l1 * cut * p[0] / length;
  s[1] = -l.l2 * cut * p[1] / length;
  p[0] *= bound / size;
  p[1] *= bound / size;
  return true;
}

tangential_result fastsim(const grid &g, const double *pressure, const double *bound,
                          const row_ends &rows, const flexibilities &l, bool whole_steps,
                          const rolling_input &input, tangential_fields fields) {
  tangential_result result;
  for (int j = 0; j < g.ny; ++j) {
    double p[2] = {0, 0}, s[2], before = rows.leading[j];
    bool entered = false;
    const double spin = input.spin_creepage, middle = 0.5 * (rows.leading[j] + rows.trailing[j]);
    const double wx =
        input.creepage[0] - spin * (rows.centre + (g.y(j) - rows.centre) * l.l1 / l.l3);
    for (int n = 0; n < g.nx; ++n) {
      const int i = input.direction > 0 ? g.nx - 1 - n : n;
      const int at = j * g.nx + i;
      fields.px[at] = fields.py[at] = fields.sx[at] = fields.sy[at] = 0;
      fields.division[at] = static_cast<unsigned char>(RP_EXTERIOR);
      if (!(pressure[at] > 0)) {
        // traction does not cross a gap: behind it the row begins afresh
        p[0] = p[1] = 0;
        if (entered) before = g.x(i) - input.direction * 0.5 * g.dx;
        continue;
      }
      entered = true;
      const double x = g.x(i);
      const double length = whole_steps ? g.dx : std::abs(before - x);
      const double where = (whole_steps ? x : 0.5 * (before + x)) + input.spin_offset;
      const double wy = input.creepage[1] + spin * (middle + (where - middle) * l.l2 / l.l3);
      before = x;
      const bool slip = march(l, length, wx, wy, bound[at], p, s);
      fields.px[at] = p[0];
      fields.py[at] = p[1];
      fields.sx[at] = s[0];
      fields.sy[at] = s[1];
      result.friction -= (p[0] * wx + p[1] * wy) * length * g.dy;
      fields.division[at] = static_cast<unsigned char>(slip ? RP_SLIP : RP_STICK);
      ++(slip ? result.slip : result.stick);
    }
  }
  result.converged = true;
  return result;
}

tangential_result solve_fastsim(const fast_problem &p, tangential_fields fields,
                                creep_resultants & /*sums*/) {
  return fastsim(p.g, p.pressure, p.bound, p.rows, p.l, p.options.blending == RP_BLENDING_CONTACT,
                 p.rolling, fields);
}

}  // namespace railpatch
