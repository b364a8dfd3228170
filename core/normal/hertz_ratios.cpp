#include "normal/hertz_ratios.hpp"

#include <algorithm>
#include <cmath>

#include "normal/hertz.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr int half_count = 250;
constexpr int count = 2 * half_count + 1;
constexpr double end = 13.815510557964274;  // ln(1e6)
constexpr double step = end / half_count;

// Cubic through the four nearest nodes; x in steps from the first node.
double cubic(const double *v, double x) {
  const int i = std::clamp(static_cast<int>(x) - 1, 0, count - 4);
  const double t = x - i, u = t - 1, r = t - 2, q = t - 3;
  return (-v[i] * u * r * q + 3 * v[i + 1] * t * r * q - 3 * v[i + 2] * t * u * q +
          v[i + 3] * t * u * r) /
         6;
}

}  // namespace

hertz_ratios::hertz_ratios() : edge_(count), pressure_(count) {
  for (int i = 0; i < count; ++i) {
    const double ratio = exp(step * (i - half_count));
    const double curvatures[2] = {ratio, 1.0};
    const hertz_contact h = hertz_from_approach(curvatures, 1.0, 1.0);
    edge_[static_cast<size_t>(i)] = log(ratio * h.semi_axes[0] * h.semi_axes[0]);
    pressure_[static_cast<size_t>(i)] = log(h.max_pressure / (ratio * h.semi_axes[0]));
  }
}

hertz_ratios::values hertz_ratios::at(double a, double b) const {
  const double ratio = log(a / b);
  // the lower end also for what is no number
  const double t = ratio > -end ? std::min(ratio, end) / step : -half_count;
  return {exp(cubic(edge_.data(), half_count + t)), exp(cubic(edge_.data(), half_count - t)),
          exp(cubic(pressure_.data(), half_count + t))};
}

}  // namespace railpatch
