#include "normal/row_curve.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

quadratic through(const double *f, const grid &g, int j) {
  const int m = std::clamp(j, 1, g.ny - 2);
  const double rise = (f[m + 1] - f[m - 1]) / (2 * g.dy);
  const double bend = (f[m + 1] - 2 * f[m] + f[m - 1]) / (2 * g.dy * g.dy);
  const double t = (j - m) * g.dy;
  return {f[j], rise + 2 * bend * t, bend};
}

double value_at(const double *f, const grid &g, double y) {
  const double inside = (y - g.y0) / g.dy;
  const double place = inside > 0 ? std::min(inside, g.ny - 1.0) : 0.0;  // the first for no number
  const int j = std::min(static_cast<int>(place), g.ny - 2);
  const double t = y - g.y(j), share = place - j;
  return (1 - share) * through(f, g, j).at(t) + share * through(f, g, j + 1).at(t - g.dy);
}

double lowest_between(const double *f, const grid &g, int j, double from, double to,
                      double &value) {
  const quadratic p = through(f, g, j), q = through(f, g, j + 1);
  // (1 - t) p + t q as a cubic of t = 0 ... 1
  const double rise = p.c1 * g.dy, bend = p.c2 * g.dy * g.dy, last = q.c2 * g.dy * g.dy;
  const double back = f[j + 1] - q.c1 * g.dy + last;  // q's parabola at row j
  const double slope = q.c1 * g.dy - 2 * last;        // and its slope there
  const double c1 = rise - f[j] + back, c2 = bend - rise + slope, c3 = last - bend;
  const auto at = [&](double t) { return f[j] + (c1 + (c2 + c3 * t) * t) * t; };
  double best = from;
  value = at(from);
  const auto take = [&](double t) {
    if (t > from && t <= to && at(t) < value) best = t, value = at(t);
  };
  take(to);
  // where the slope c1 + 2 c2 t + 3 c3 t^2 vanishes and rises
  const double root = c2 * c2 - 3 * c1 * c3;
  if (root > 0) {
    const double s = std::sqrt(root);
    take(c2 > 0 ? -c1 / (c2 + s) : (s - c2) / (3 * c3));
  }
  return best;
}

double mean_curvature(const double *f, const grid &g, int j, double reach) {
  const double y = g.y(j);
  return 0.5 * (value_at(f, g, y + reach) - 2 * f[j] + value_at(f, g, y - reach)) / (reach * reach);
}

}  // namespace railpatch
