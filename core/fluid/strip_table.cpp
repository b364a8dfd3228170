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

strip_table::place strip_table::place_of_s(double s) {
  const double at = (log(std::clamp(s, least_s, most_s)) - low_s) / across_s * (rows - 1);
  place p;
  p.first = first_of(at, rows);
  weigh(at - p.first, p.weight);
  return p;
}

strip_table::place strip_table::place_of_r(double r) {
  const double at = (std::sqrt(std::clamp(r, least_r, most_r)) - low_r) / across_r * (columns - 1);
  place p;
  p.first = first_of(at, columns);
  weigh(at - p.first, p.weight);
  return p;
}

const double *strip_table::node(int s, int r) { return solved + (s * columns + r) * numbers; }

strip_table::rows_of::rows_of(double s) {
  const place p = place_of_s(s);
  const double *v[4];
  for (int i = 0; i < 4; ++i) v[i] = node(p.first + i, 0);
  const double *w = p.weight;
  for (size_t k = 0; k < of_r_.size(); ++k)
    of_r_[k] = w[0] * v[0][k] + w[1] * v[1][k] + w[2] * v[2][k] + w[3] * v[3][k];
}

strip_table::strip strip_table::rows_of::at(double r) const {
  const place p = place_of_r(r);
  const double *v[4], *w = p.weight;
  for (int j = 0; j < 4; ++j) v[j] = of_r_.data() + (p.first + j) * numbers;
  const auto sum = [&](int k) {
    return w[0] * v[0][k] + w[1] * v[1][k] + w[2] * v[2][k] + w[3] * v[3][k];
  };
  strip found{};
  found.end = sum(0);
  found.share = sum(1);
  for (int k = 0; k < profile_nodes; ++k) found.liquid[static_cast<size_t>(k)] = sum(2 + k);
  return found;
}

strip_table::strip strip_table::at(double s, double r) { return rows_of(s).at(r); }

double strip_table::number(double s, double r, int which) {
  const place of_s = place_of_s(s), of_r = place_of_r(r);
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      sum += of_s.weight[i] * of_r.weight[j] * node(of_s.first + i, of_r.first + j)[which];
  return sum;
}

double strip_table::share(double s, double r) { return std::clamp(number(s, r, 1), 0.0, 1.0); }

double strip_table::end(double s, double r) { return number(s, r, 0); }

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

// of the nodes' number
double strip_table::strip::between(double at) const {
  const int first = first_of(at, profile_nodes);
  double w[4], sum = 0;
  weigh(at - first, w);
  for (int k = 0; k < 4; ++k) sum += w[k] * liquid[static_cast<size_t>(first + k)];
  return std::max(sum, 0.0);
}

double strip_table::strip::pressure(double theta) const {
  if (!(theta < end) || !(theta > 0)) return 0;
  // nodes at theta = end (1 - cos(pi k/(nodes - 1)))/2
  return between(acos(1.0 - 2.0 * theta / end) / pi * (profile_nodes - 1));
}

void strip_table::strip::pressures(const double *x, int count, double *found) const {
  const double over = 2.0 / end, cavitation = -cos(end), each = (profile_nodes - 1) / pi;
  for (int i = 0; i < count; ++i) found[i] = near_acos(1.0 - over * near_acos(-x[i]));
  for (int i = 0; i < count; ++i)
    found[i] = x[i] > -1 && x[i] < cavitation ? between(found[i] * each) : 0.0;
}

}  // namespace railpatch
