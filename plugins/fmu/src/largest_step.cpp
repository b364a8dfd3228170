#include "largest_step.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch::fmu {

namespace {

constexpr int kFreedoms = 6;   // x, y, z, roll, yaw, pitch
constexpr int kRounds = 200;   // of the power iteration
constexpr double kMost = 1.0;  // s
using Matrix = double[kFreedoms][kFreedoms];

// Greatest singular value by power iteration on A^T A; within 1 % long before the last round unless
// the two greatest are that near, where either serves.
double norm_of(const Matrix &a) {
  double v[kFreedoms], norm = 0;
  for (int i = 0; i < kFreedoms; ++i) v[i] = 1.0 + 0.1 * i;
  for (int round = 0; round < kRounds; ++round) {
    double w[kFreedoms] = {}, next[kFreedoms] = {}, length = 0;
    for (int i = 0; i < kFreedoms; ++i)
      for (int j = 0; j < kFreedoms; ++j) w[i] += a[i][j] * v[j];
    for (int i = 0; i < kFreedoms; ++i)
      for (int j = 0; j < kFreedoms; ++j) next[j] += a[i][j] * w[i];
    for (const double n : next) length += n * n;
    length = std::sqrt(length);
    if (!(length > 0)) return length;  // 0 or NaN
    for (int i = 0; i < kFreedoms; ++i) v[i] = next[i] / length;
    norm = std::sqrt(length);
  }
  return norm;
}

}  // namespace

double largest_step_of(const rp_jacobian &jacobian, const Inertia &inertia, bool with_z) {
  // rows of force and moment that belong to the columns
  constexpr int rows[kFreedoms] = {0, 1, 2, 3, 5, 4};
  const double mass[kFreedoms] = {inertia.mass,      inertia.mass,      inertia.mass,
                                  inertia.moment[0], inertia.moment[2], inertia.moment[1]};
  Matrix stiffness = {}, damping = {};
  for (int i = 0; i < kFreedoms; ++i)
    for (int j = 0; j < kFreedoms; ++j) {
      const double scale = 1 / std::sqrt(mass[i] * mass[j]);
      for (const auto &side : jacobian.side) {
        const bool counts = with_z || (i != 2 && j != 2);
        if (counts) stiffness[i][j] -= scale * side[rows[i]][j];
        if (counts) damping[i][j] -= scale * side[rows[i]][kFreedoms + j];
      }
    }
  const double w2 = norm_of(stiffness), c = norm_of(damping);
  if (!std::isfinite(w2) || !std::isfinite(c)) return 0;
  return std::min({kMost, 0.1 / std::sqrt(w2), 1 / c});
}

}  // namespace railpatch::fmu
