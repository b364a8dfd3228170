#include "patch/patch_grid.hpp"

#include <algorithm>
#include <cmath>

#include "normal/row_contact.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr int most_elements = 1000;  // of grids of unlike bodies, and to add ahead of any

}  // namespace

int grid_rules::with_margin(int n) const {
  if (reach == 1) return n;
  const int wanted = n + 2 * static_cast<int>(std::ceil(0.5 * (reach - 1.0) * n));
  return std::max(n, std::min(wanted, most_elements));
}

int grid_rules::ahead_of(int n, double wanted) const {
  const double more = std::min(wanted, farthest) - reach;
  return more > 0 ? std::min(static_cast<int>(std::ceil(0.5 * more * n)), most_elements) : 0;
}

// Kik-Piotrowski needs its contact, an ellipse with Hertz's axis ratio and the area
// pi 0.55 d/sqrt(A B), and the interpenetration region it is stretched from; with (a b) that is s^2
// times as large, its force at equal approach d is s times as large. Corrected, the overlap's depth
// is that of Hertz's area, sqrt(A B) a b, and s is 1.
double grid_rules::relative_size(const hertz_contact &hertz, int k) const {
  if (!interpenetrates) return 1.0;
  const double *c = hertz.curvatures, *axes = hertz.semi_axes;
  const double depth = corrected ? std::sqrt(c[0]) * axes[0] * std::sqrt(c[1]) * axes[1]
                                 : virtual_interpenetration * hertz.approach;
  const double half[2] = {std::sqrt(depth / c[0]), std::sqrt(depth / c[1])};
  const double size = std::sqrt(half[0] / axes[0]) * std::sqrt(half[1] / axes[1]);
  // at equal force the approach is smaller, and with it both regions
  const double load = force_given ? 1.0 / cbrt(size) : 1.0;
  return load * std::max(size, half[k] / axes[k]);
}

}  // namespace railpatch
