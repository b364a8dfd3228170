#include "half_space/stress_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;
constexpr double sqrt2 = 1.41421356237309504880;

double mean_of(const stress_tensor &s) { return (s[0] + s[1] + s[2]) / 3.0; }

// sum of squares of a deviator
double square_of(const stress_tensor &s, double mean) {
  double sum = 0;
  for (size_t k = 0; k < 3; ++k) sum += (s[k] - mean) * (s[k] - mean) + 2.0 * s[k + 3] * s[k + 3];
  return sum;
}

}  // namespace

std::array<double, 3> principal_stresses(const stress_tensor &s) {
  const double mean = mean_of(s), p = std::sqrt(square_of(s, mean) / 6.0);
  if (!(p > 0)) return {mean, mean, mean};
  const double a = (s[0] - mean) / p, b = (s[1] - mean) / p, c = (s[2] - mean) / p;
  const double xy = s[3] / p, yz = s[4] / p, zx = s[5] / p;
  const double half_determinant =
      0.5 * (a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx));
  const double angle = acos(std::clamp(half_determinant, -1.0, 1.0)) / 3.0;
  const double high = mean + 2.0 * p * cos(angle);
  const double low = mean + 2.0 * p * cos(angle + 2.0 * pi / 3.0);
  return {high, 3.0 * mean - high - low, low};
}

double von_mises_stress(const stress_tensor &s) {
  return std::sqrt(1.5 * square_of(s, mean_of(s)));
}

double greatest_shear(const stress_tensor &s) {
  const auto principal = principal_stresses(s);
  return 0.5 * (principal[0] - principal[2]);
}

dang_van_cycle::dang_van_cycle(int most_states)
    : state_(static_cast<size_t>(most_states)),
      point_(static_cast<size_t>(most_states)),
      weight_(static_cast<size_t>(most_states)) {}

void dang_van_cycle::add(const stress_tensor &s) {
  const double mean = mean_of(s);
  const auto at = static_cast<size_t>(count_++);
  state_[at] = s;
  for (size_t k = 0; k < 3; ++k) {
    point_[at][k] = s[k] - mean;
    point_[at][k + 3] = sqrt2 * s[k + 3];
  }
}

dang_van_cycle::deviator dang_van_cycle::middle() {
  constexpr int most = 2000;
  constexpr double enough = 1e-7;  // -, of the ball's squared radius
  const auto n = static_cast<size_t>(count_);
  deviator c{};
  for (size_t i = 0; i < n; ++i) {
    weight_[i] = 1.0 / static_cast<double>(n);
    for (size_t k = 0; k < 6; ++k) c[k] += weight_[i] * point_[i][k];
  }
  for (int step = 0; step < most; ++step) {
    double mean = 0, farthest = -1, nearest = HUGE_VAL;
    size_t far = 0, near = 0;
    for (size_t i = 0; i < n; ++i) {
      double d = 0;
      for (size_t k = 0; k < 6; ++k) d += (point_[i][k] - c[k]) * (point_[i][k] - c[k]);
      mean += weight_[i] * d;
      if (d > farthest) farthest = d, far = i;
      if (weight_[i] > 0 && d < nearest) nearest = d, near = i;
    }
    if (!(farthest - mean > enough * mean)) break;
    const bool away = mean - nearest > farthest - mean && nearest > 0;
    // of the way to the farthest one, or away from the nearest one until that counts no longer
    double part = 0.5 * (farthest - mean) / farthest;
    bool dropped = false;
    if (away) {
      const double limit = weight_[near] / (1.0 - weight_[near]);
      const double best = 0.5 * (mean - nearest) / nearest;
      dropped = best >= limit;
      part = -std::min(best, limit);
    }
    const size_t to = away ? near : far;
    for (size_t i = 0; i < n; ++i) weight_[i] *= 1.0 - part;
    weight_[to] = dropped ? 0.0 : weight_[to] + part;
    for (size_t k = 0; k < 6; ++k) c[k] += part * (point_[to][k] - c[k]);
  }
  return c;
}

double dang_van_cycle::equivalent(double a) {
  if (count_ == 0) return 0.0;
  const deviator c = middle();
  double most = -HUGE_VAL;
  for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
    stress_tensor s;
    for (size_t k = 0; k < 6; ++k) s[k] = (point_[i][k] - c[k]) / (k < 3 ? 1.0 : sqrt2);
    most = std::max(most, greatest_shear(s) + a * mean_of(state_[i]));
  }
  return most;
}

}  // namespace railpatch
