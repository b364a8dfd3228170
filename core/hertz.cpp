#include "hertz.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace railpatch {

namespace {

using std::numbers::pi;

// Carlson (1995), Numerical Algorithms 10: duplication until the fifth-order series is exact.
double carlson_rf(double x, double y, double z) {
  for (;;) {
    const double mean = (x + y + z) / 3.0;
    const double dx = 1.0 - x / mean, dy = 1.0 - y / mean, dz = -dx - dy;
    if (!(std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) >= 1e-3)) {  // or NaN
      const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
      return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) /
             std::sqrt(mean);
    }
    const double lambda = std::sqrt(x * y) + std::sqrt(x * z) + std::sqrt(y * z);
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
  }
}

double carlson_rd(double x, double y, double z) {
  double sum = 0, power = 1;
  for (;;) {
    const double mean = (x + y + 3.0 * z) / 5.0;
    const double dx = 1.0 - x / mean, dy = 1.0 - y / mean, dz = -(dx + dy) / 3.0;
    if (!(std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) >= 1e-3)) {  // or NaN
      const double xy = dx * dy, z2 = dz * dz;
      const double e2 = xy - 6.0 * z2, e3 = (3.0 * xy - 8.0 * z2) * dz;
      const double e4 = 3.0 * (xy - z2) * z2, e5 = xy * z2 * dz;
      const double series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 -
                            3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0 + 3.0 * e5 / 26.0;
      return 3.0 * sum + power * series / (mean * std::sqrt(mean));
    }
    const double lambda = std::sqrt(x * y) + std::sqrt(x * z) + std::sqrt(y * z);
    sum += power / (std::sqrt(z) * (z + lambda));
    power *= 0.25;
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
  }
}

// ln(c0/c1) of an ellipse with ln(a/b) = t, falling from +inf to -inf.
double log_curvature_ratio(double t) {
  const double a2 = std::exp(t), b2 = std::exp(-t);
  return std::log(carlson_rd(0, b2, a2) / carlson_rd(0, a2, b2));
}

// ln(a/b) for given curvatures: bisection to the last bit is cheap and cannot fail.
double log_axis_ratio(double c0, double c1) {
  const double target = std::log(c0 / c1);
  double lower = -25, upper = 25;
  for (int i = 0; i < 100 && upper - lower > 1e-15 * std::max(1.0, std::abs(lower)); ++i) {
    const double t = 0.5 * (lower + upper);
    (log_curvature_ratio(t) > target ? lower : upper) = t;
  }
  return 0.5 * (lower + upper);
}

struct unit_ellipse {
  double a, b, rd0, rf;  // semi-axes with a b = 1 and their integrals
};

unit_ellipse shape(double log_ratio) {
  const double a = std::exp(0.5 * log_ratio), b = 1.0 / a;
  return {a, b, carlson_rd(0, b * b, a * a), carlson_rf(0, a * a, b * b)};
}

hertz_contact complete(double a, double b, const double curvatures[2], double modulus,
                       double force) {
  const double rf = carlson_rf(0, a * a, b * b);
  return {{a, b},
          {curvatures[0], curvatures[1]},
          force,
          3.0 * force / (2.0 * pi * modulus) * rf,
          3.0 * force / (2.0 * pi * a * b)};
}

}  // namespace

hertz_contact hertz_from_force(const double curvatures[2], double modulus, double force) {
  const unit_ellipse u = shape(log_axis_ratio(curvatures[0], curvatures[1]));
  const double size = std::cbrt(force * u.rd0 / (2.0 * pi * modulus * curvatures[0]));
  return complete(size * u.a, size * u.b, curvatures, modulus, force);
}

hertz_contact hertz_from_approach(const double curvatures[2], double modulus, double approach) {
  const unit_ellipse u = shape(log_axis_ratio(curvatures[0], curvatures[1]));
  const double size = std::sqrt(approach * u.rd0 / (3.0 * curvatures[0] * u.rf));
  const double force = 2.0 * pi * modulus * curvatures[0] * size * size * size / u.rd0;
  return complete(size * u.a, size * u.b, curvatures, modulus, force);
}

hertz_contact hertz_from_ellipse(const double semi_axes[2], double modulus, double force) {
  const double a2 = semi_axes[0] * semi_axes[0], b2 = semi_axes[1] * semi_axes[1];
  const double size = force / (2.0 * pi * modulus);
  const double curvatures[2] = {size * carlson_rd(0, b2, a2), size * carlson_rd(0, a2, b2)};
  return complete(semi_axes[0], semi_axes[1], curvatures, modulus, force);
}

hertz_contact hertz_ellipse_from_approach(const double semi_axes[2], double modulus,
                                          double approach) {
  const double a2 = semi_axes[0] * semi_axes[0], b2 = semi_axes[1] * semi_axes[1];
  return hertz_from_ellipse(semi_axes, modulus,
                            2.0 * pi * modulus * approach / (3.0 * carlson_rf(0, a2, b2)));
}

hertz_contact hertz_line(double radius, double width, double modulus, double force) {
  hertz_contact result;
  result.normal_force = force;
  result.curvatures[0] = 0.5 / radius;
  result.semi_axes[0] = std::sqrt(4.0 * force / width * radius / (pi * modulus));
  result.max_pressure = 2.0 * force / (pi * width * result.semi_axes[0]);
  return result;
}

}  // namespace railpatch
