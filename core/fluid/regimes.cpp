#include "fluid/regimes.hpp"

#include <cmath>

namespace railpatch {

namespace {

// Slope at an end by the parabola through three points, limited so that the curve does not turn.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (!(slope * d0 > 0)) return 0;
  if (!(d0 * d1 > 0) && std::fabs(slope) > 3.0 * std::fabs(d0)) return 3.0 * d0;
  return slope;
}

double inner_slope(double h0, double h1, double d0, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

water_regimes water_regimes::shipped() {
  water_regimes w;
  w.count = 3;
  w.knot[0] = {0, 1.0, 0.4, 0.55, 0.4, 0.6};
  w.knot[1] = {25e-9, 0.3, 0.1, 0.05, 1.0, 0.0};
  w.knot[2] = {1e-6, 0.3, 0.1, 0.30, 0.4, 0.2};
  return w;
}

double shape_preserving(const double *x, const double *y, int count, double at) {
  if (!(at > x[0])) return y[0];
  if (at >= x[count - 1]) return y[count - 1];
  int i = 0;
  while (at >= x[i + 1]) ++i;
  const auto h = [&](int k) { return x[k + 1] - x[k]; };
  const auto d = [&](int k) { return (y[k + 1] - y[k]) / h(k); };
  if (count == 2) return y[0] + d(0) * (at - x[0]);
  const auto slope = [&](int k) {
    if (k == 0) return end_slope(h(0), h(1), d(0), d(1));
    if (k == count - 1) return end_slope(h(k - 1), h(k - 2), d(k - 1), d(k - 2));
    return inner_slope(h(k - 1), h(k), d(k - 1), d(k));
  };
  const double t = (at - x[i]) / h(i), s = 1.0 - t;
  return y[i] * s * s * (1.0 + 2.0 * t) + y[i + 1] * t * t * (3.0 - 2.0 * t) +
         h(i) * (slope(i) * t * s * s - slope(i + 1) * t * t * s);
}

}  // namespace railpatch
