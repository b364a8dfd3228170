#include "normal/hertz.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

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

// d R_D(0, y, z)/dy, which is symmetric in y and z. From the integral, by partial fractions,
// (R_D(0, y, z) - R_D(0, z, y))/(2 (z - y)); for nearly equal ones the integrand's series about
// their mean. here, there: R_D(0, y, z) and R_D(0, z, y).
double carlson_rd_rate(double y, double z, double here, double there) {
  const double mean = 0.5 * (y + z), apart = 0.5 * (z - y), ratio = apart / mean;
  if (std::abs(ratio) > 1e-3) return (here - there) / (4.0 * apart);
  const double power = mean * mean * std::sqrt(mean);
  return -(9.0 * pi / 32.0) * (1.0 + 35.0 / 32.0 * ratio * ratio) / power;
}

// Logarithmic rates of c0, c1 and approach at constant force, by ln a and ln b.
struct log_rates {
  double c0[2], c1[2], approach[2];
};

log_rates rates_of(const double semi_axes[2]) {
  const double a2 = semi_axes[0] * semi_axes[0], b2 = semi_axes[1] * semi_axes[1];
  const double d0 = carlson_rd(0, b2, a2), d1 = carlson_rd(0, a2, b2), f = carlson_rf(0, a2, b2);
  const double rate = carlson_rd_rate(a2, b2, d1, d0);
  const double m0 = 2.0 * b2 * rate / d0, m1 = 2.0 * a2 * rate / d1;
  return {{-3.0 - m0, m0}, {m1, -3.0 - m1}, {-a2 * d0 / (3.0 * f), -b2 * d1 / (3.0 * f)}};
}

// Rates from those of ln a, ln b and ln F.
hertz_contact from_logs(const hertz_contact &c, const double curvatures[2], const double axes[2],
                        double force, double approach) {
  return {{c.semi_axes[0] * axes[0], c.semi_axes[1] * axes[1]},
          {curvatures[0], curvatures[1]},
          c.normal_force * force,
          approach,
          c.max_pressure * (force - axes[0] - axes[1])};
}

// ln(c0/c1) of an ellipse with ln(a/b) = t, falling from +inf to -inf, and its rate by t.
double log_curvature_ratio(double t, double &rate) {
  const double a2 = exp(t), b2 = exp(-t);
  const double d0 = carlson_rd(0, b2, a2), d1 = carlson_rd(0, a2, b2);
  const double change = carlson_rd_rate(a2, b2, d1, d0);
  rate = -3.0 - 2.0 * (b2 * change / d0 + a2 * change / d1);
  return log(d0 / d1);
}

// ln(a/b) for given curvatures: Newton's method, kept between bounds. In logarithms the ratio is
// nearly a straight line, and the next error the square of the last step.
double log_axis_ratio(double c0, double c1) {
  const double target = log(c0 / c1);
  double lower = -25, upper = 25;
  // Hamrock and Brewe (1983): a/b = (c1/c0)^(2/pi), nearly
  double t = std::clamp(-2.0 / pi * target, lower, upper);
  for (int i = 0; i < 100; ++i) {
    double rate = 0;
    const double over = log_curvature_ratio(t, rate) - target;
    (over > 0 ? lower : upper) = t;
    double next = t - over / rate;
    const bool inside = next >= lower && next <= upper;
    if (!inside) next = 0.5 * (lower + upper);
    const double step = std::abs(next - t);
    t = next;
    if (inside ? step < 1e-8 : step < 1e-15 * std::max(1.0, std::abs(t))) break;
  }
  return t;
}

// rf: R_F(0, a^2, b^2).
hertz_contact complete(double a, double b, double rf, const double curvatures[2], double modulus,
                       double force) {
  return {{a, b},
          {curvatures[0], curvatures[1]},
          force,
          3.0 * force / (2.0 * pi * modulus) * rf,
          3.0 * force / (2.0 * pi * a * b)};
}

hertz_contact of_size(const hertz_shape &u, double size, double modulus, double force) {
  const double a = size * u.a, b = size * u.b;
  return complete(a, b, carlson_rf(0, a * a, b * b), u.curvatures, modulus, force);
}

}  // namespace

hertz_shape hertz_shape_of(const double curvatures[2]) {
  const double a = exp(0.5 * log_axis_ratio(curvatures[0], curvatures[1])), b = 1.0 / a;
  return {{curvatures[0], curvatures[1]},
          a,
          b,
          carlson_rd(0, b * b, a * a),
          carlson_rf(0, a * a, b * b)};
}

hertz_contact hertz_from_force(const hertz_shape &u, double modulus, double force) {
  const double size = cbrt(force * u.rd0 / (2.0 * pi * modulus * u.curvatures[0]));
  return of_size(u, size, modulus, force);
}

hertz_contact hertz_from_force(const double curvatures[2], double modulus, double force) {
  return hertz_from_force(hertz_shape_of(curvatures), modulus, force);
}

hertz_contact hertz_from_approach(const double curvatures[2], double modulus, double approach) {
  return hertz_from_approach(hertz_shape_of(curvatures), modulus, approach);
}

hertz_contact hertz_from_approach(const hertz_shape &u, double modulus, double approach) {
  const double size = std::sqrt(approach * u.rd0 / (3.0 * u.curvatures[0] * u.rf));
  const double force = 2.0 * pi * modulus * u.curvatures[0] * size * size * size / u.rd0;
  return of_size(u, size, modulus, force);
}

hertz_ellipse hertz_ellipse_of(const double semi_axes[2]) {
  const double a2 = semi_axes[0] * semi_axes[0], b2 = semi_axes[1] * semi_axes[1];
  return {{semi_axes[0], semi_axes[1]},
          {carlson_rd(0, b2, a2), carlson_rd(0, a2, b2)},
          carlson_rf(0, a2, b2)};
}

hertz_contact hertz_from_ellipse(const hertz_ellipse &e, double modulus, double force) {
  const double size = force / (2.0 * pi * modulus);
  const double curvatures[2] = {size * e.rd[0], size * e.rd[1]};
  return complete(e.semi_axes[0], e.semi_axes[1], e.rf, curvatures, modulus, force);
}

hertz_contact hertz_from_ellipse(const double semi_axes[2], double modulus, double force) {
  return hertz_from_ellipse(hertz_ellipse_of(semi_axes), modulus, force);
}

hertz_contact hertz_ellipse_from_approach(const hertz_ellipse &e, double modulus, double approach) {
  return hertz_from_ellipse(e, modulus, 2.0 * pi * modulus * approach / (3.0 * e.rf));
}

hertz_contact hertz_ellipse_from_approach(const double semi_axes[2], double modulus,
                                          double approach) {
  return hertz_ellipse_from_approach(hertz_ellipse_of(semi_axes), modulus, approach);
}

hertz_contact hertz_line(double radius, double width, double modulus, double force) {
  hertz_contact result;
  result.normal_force = force;
  result.curvatures[0] = 0.5 / radius;
  result.semi_axes[0] = std::sqrt(4.0 * force / width * radius / (pi * modulus));
  result.max_pressure = 2.0 * force / (pi * width * result.semi_axes[0]);
  return result;
}

// d ln(c0/c1) fixes d ln(a/b), then d ln c0 the size.
hertz_contact hertz_rate_of_force(const hertz_contact &c, const double curvatures[2],
                                  double force) {
  const log_rates r = rates_of(c.semi_axes);
  const double k0 = curvatures[0] / c.curvatures[0], k1 = curvatures[1] / c.curvatures[1];
  const double load = force / c.normal_force;
  const double ratio = (k0 - k1) / (r.c0[0] - r.c1[0]);  // d ln(a/b)
  // d ln c0 = c0[0] (ratio + d ln b) + c0[1] d ln b + d ln F, with c0[0] + c0[1] = -3
  const double b = (k0 - load - r.c0[0] * ratio) / -3.0, axes[2] = {b + ratio, b};
  return from_logs(c, curvatures, axes, load,
                   c.approach * (load + r.approach[0] * axes[0] + r.approach[1] * axes[1]));
}

hertz_contact hertz_rate_of_approach(const hertz_contact &c, const double curvatures[2],
                                     double approach) {
  // linear in the force: what the approach wants beyond that of no change in force
  const hertz_contact still = hertz_rate_of_force(c, curvatures, 0.0);
  const double none[2] = {0, 0};
  const hertz_contact loaded = hertz_rate_of_force(c, none, 1.0);
  const double force = (approach - still.approach) / loaded.approach;
  return hertz_rate_of_force(c, curvatures, force);
}

hertz_contact hertz_rate_of_line(const hertz_contact &c, double force) {
  const double load = force / c.normal_force, curvatures[2] = {0, 0};
  const double axes[2] = {0.5 * load, 0.0};
  return from_logs(c, curvatures, axes, load, 0.0);
}

hertz_contact hertz_rate_of_ellipse(const hertz_contact &c, double force) {
  const double load = force / c.normal_force, axes[2] = {0, 0};
  const double curvatures[2] = {c.curvatures[0] * load, c.curvatures[1] * load};
  return from_logs(c, curvatures, axes, load, c.approach * load);
}

}  // namespace railpatch
