#include "normal/strip.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "numeric/elementary.hpp"
#include "numeric/fade.hpp"

namespace railpatch {

namespace {

// Gauss-Legendre nodes and weights on [-1, 1]
constexpr double gauss2 = 0.57735026918962576;
constexpr double gauss5[] = {-0.90617984593866399, -0.53846931010568309, 0.0, 0.53846931010568309,
                             0.90617984593866399};
constexpr double weight5[] = {0.23692688505618909, 0.47862867049936647, 0.56888888888888889,
                              0.47862867049936647, 0.23692688505618909};

// of the chord squared in the middle of an interval: where it ends with less the rule for ends of
// contact counts, and beyond the second alone the one for smooth chords; both in between, so that
// no rule's error comes or goes at once
constexpr double ends_below = 0.5, smooth_above = 0.6;

double log_primitive(double y) { return y == 0 ? 0.0 : y * (log(std::abs(y)) - 1); }

// Real roots in ascending order, without cancellation; their number.
int roots(const quadratic &q, double r[2]) {
  const double discriminant = q.c1 * q.c1 - 4 * q.c0 * q.c2;
  if (!(discriminant > 0)) return 0;
  const double s = -0.5 * (q.c1 + std::copysign(std::sqrt(discriminant), q.c1));
  int n = 0;
  if (s != 0) r[n++] = q.c0 / s;
  if (q.c2 != 0) r[n++] = s / q.c2;
  if (n == 2 && r[0] > r[1]) std::swap(r[0], r[1]);
  return n;
}

}  // namespace

strip::strip(const quadratic &q, double dy) {
  const double half = 0.5 * dy;
  double cut[4] = {-half}, r[2];
  int n = 1;
  for (int k = 0, count = roots(q, r); k < count; ++k)
    if (r[k] > -half && r[k] < half) cut[n++] = r[k];
  // where a chord becomes least, which two ends of contact begin at
  const double waist = q.c2 > 0 && n == 1 ? -0.5 * q.c1 / q.c2 : half;
  if (waist > -half && waist < half) cut[n++] = waist;
  cut[n] = half;
  for (int k = 0; k < n; ++k)
    if (q.at(0.5 * (cut[k] + cut[k + 1])) > 0) add_interval(q, cut[k], cut[k + 1]);
}

void strip::add_interval(const quadratic &q, double from, double to) {
  from_[intervals_] = from;
  to_[intervals_++] = to;
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const auto add = [&](double t, double weight) {
    t_[nodes_] = t;
    weight_[nodes_] = weight;
    squared_[nodes_++] = std::max(0.0, q.at(t));
  };
  const double least = std::min(q.at(from), q.at(to)) / q.at(middle);
  const double ends = fade((least - ends_below) / (smooth_above - ends_below));
  // far from the ends of contact the chord is smooth
  if (ends < 1)
    for (double s : {-gauss2, gauss2}) add(middle + half * s, (1 - ends) * half);
  // t as a cubic of the Gauss variable: its slope vanishes where the chord ends like a root
  for (int k = 0; k < 5 && ends > 0; ++k) {
    const double s = gauss5[k];
    add(middle + half * s * (1.5 - 0.5 * s * s), ends * half * weight5[k] * 1.5 * (1 - s * s));
  }
}

double strip::width() const {
  double sum = 0;
  for (int k = 0; k < intervals_; ++k) sum += to_[k] - from_[k];
  return sum;
}

double strip::log_integral(double y) const {
  double sum = 0;
  for (int k = 0; k < intervals_; ++k)
    sum += log_primitive(y + to_[k]) - log_primitive(y + from_[k]);
  return sum;
}

double row_potential(double l2, double y) {
  if (!(l2 > 0)) return 0;
  // arithmetic-geometric mean: K = pi/(2 M), K - E = K (k^2/2 + sum 2^(n-1) c_n^2)
  const double size = std::sqrt(l2 + y * y);
  double a = 1, b = std::abs(y) / size, power = 0.5, sum = 0.5 * l2 / (l2 + y * y);
  for (int n = 0; n < 12 && a - b > 1e-9 * a; ++n) {
    const double c = 0.5 * (a - b), mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
    power *= 2;
    sum += power * c * c;
  }
  return 2 * std::numbers::pi * size * sum / (a + b);
}

}  // namespace railpatch
