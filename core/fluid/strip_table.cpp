#include "fluid/strip_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

constexpr double least_s = 1e-6, most_s = 1e5, least_r = 0.01, most_r = 0.55;

// [row][column]: theta of X_c, share, P from the leading edge to X_c
constexpr double solved[] = {
#include "fluid/strip_table.inc"
};
static_assert(sizeof solved / sizeof solved[0] ==
              strip_table::rows * strip_table::columns * strip_table::numbers);

// Weights of four nodes 0, 1, 2, 3 at x (Lagrange).
void weigh(double x, double w[4]) {
  const double a = x, b = x - 1, c = x - 2, d = x - 3;
  w[0] = b * c * d / -6.0;
  w[1] = a * c * d / 2.0;
  w[2] = a * b * d / -2.0;
  w[3] = a * b * c / 6.0;
}

// The first of the four nodes about a place, 0 ... count - 1.
int first_of(double at, int count) {
  return std::clamp(static_cast<int>(std::floor(at)) - 1, 0, count - 4);
}

}  // namespace

double strip_table::s_of(int row) {
  const double low = log(least_s);
  return exp(low + row * (log(most_s) - low) / (rows - 1));
}

double strip_table::r_of(int column) {
  const double low = std::sqrt(least_r);
  const double root = low + column * (std::sqrt(most_r) - low) / (columns - 1);
  return root * root;
}

strip_table::place strip_table::place_of(double s, double r) {
  place p;
  const double low = log(least_s), across = log(most_s) - low;
  const double at_s = (log(std::clamp(s, least_s, most_s)) - low) / across * (rows - 1);
  const double low_r = std::sqrt(least_r), across_r = std::sqrt(most_r) - low_r;
  const double at_r =
      (std::sqrt(std::clamp(r, least_r, most_r)) - low_r) / across_r * (columns - 1);
  p.s = first_of(at_s, rows);
  p.r = first_of(at_r, columns);
  weigh(at_s - p.s, p.of_s);
  weigh(at_r - p.r, p.of_r);
  return p;
}

const double *strip_table::node(int s, int r) { return solved + (s * columns + r) * numbers; }

strip_table::strip strip_table::at(double s, double r) {
  const place p = place_of(s, r);
  strip found{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const double w = p.of_s[i] * p.of_r[j], *v = node(p.s + i, p.r + j);
      found.end += w * v[0];
      found.share += w * v[1];
      for (int k = 0; k < profile_nodes; ++k) found.liquid[static_cast<size_t>(k)] += w * v[2 + k];
    }
  return found;
}

double strip_table::share(double s, double r) {
  const place p = place_of(s, r);
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) sum += p.of_s[i] * p.of_r[j] * node(p.s + i, p.r + j)[1];
  return std::clamp(sum, 0.0, 1.0);
}

// Of a row at y = b sin(v) the load is as cos^2(v), r as cos(v): sum of share cos^3(v) dv 3/4.
double strip_table::share_of_ellipse(double s, double r) {
  // Gauss and Legendre's six points of one half, 0 to pi/2
  static constexpr double x[3] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  static constexpr double w[3] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    for (int sign = -1; sign <= 1; sign += 2) {
      const double c = cos(0.25 * pi * (1.0 + sign * x[k]));
      sum += w[k] * c * c * c * share(s, r * c);
    }
  return std::clamp(0.25 * pi * 1.5 * sum, 0.0, 1.0);
}

double strip_table::strip::pressure(double theta) const {
  if (!(theta < end) || !(theta > 0)) return 0;
  // nodes at theta = end (1 - cos(pi k/(nodes - 1)))/2
  const double at = acos(1.0 - 2.0 * theta / end) / pi * (profile_nodes - 1);
  const int first = first_of(at, profile_nodes);
  double w[4], sum = 0;
  weigh(at - first, w);
  for (int k = 0; k < 4; ++k) sum += w[k] * liquid[static_cast<size_t>(first + k)];
  return std::max(sum, 0.0);
}

}  // namespace railpatch
