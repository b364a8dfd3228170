#include "half_space/below_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// Primitives over the rectangle of the potentials' derivatives that belong to one direction a in
// the surface; b is the other one.
struct along {
  double v_a, v_aa, v_az;          // of V
  double f_a, f_aa, f_aaa, f_aab;  // of F
  double f1_aa, f1_aaa, f1_aab;    // of F1
};
// ... and to both or neither.
struct shared {
  double v, v_z, v_ab, v_zz, f_ab, f1_ab;
};

struct corner_point {
  double r, z;
  double least;  // m^2, of what a logarithm is taken of

  // ln(R + t), where least_square is R^2 - t^2
  double log_sum(double t, double square) const {
    return t > 0 ? log(r + t) : log(std::max(square, least) / (r - t));
  }
  // 1/(R + t)
  double inverse_sum(double t, double square) const {
    return t > 0 ? 1.0 / (r + t) : (r - t) / std::max(square, least);
  }

  // a, b: the coordinates; log_b, log_z: ln(R + b), ln(R + z)
  along in(double a, double b, double log_b, double log_z) const {
    const double over = 1.0 / r, lift = 1.0 / (r + z);
    const double flat = (a * a + b * b) * lift;  // R - z
    const double angle = atan2(a * b * flat, a * a * r + b * b * z);
    const double spread = inverse_sum(b, a * a + z * z);
    along d{};
    d.v_a = log_b;
    d.v_aa = a * over * spread;
    d.v_az = z * over * spread;
    d.f_a = b * log_z - b + z * log_b + a * angle;
    d.f_aa = angle;
    d.f_aaa = -b * over * lift - d.v_az;
    d.f_aab = a * over * lift;
    d.f1_aa = z * angle - a * log_b;
    d.f1_aaa = b * lift - log_b;
    d.f1_aab = -a * lift;
    return d;
  }
};

// Of a traction along a; s_ab, s_az, s_bz, u_a, u_b by their places in the result.
struct places {
  int aa, bb, ab, az, bz, ua, ub;
};

void of_traction(const along &a, const along &b, const shared &s, double nu, double z,
                 const double scale[2], const places &at, double *out) {
  const double n = 2.0 * nu;
  out[at.aa] = scale[0] * (2.0 * (1.0 + nu) * a.v_a + n * a.f1_aaa - z * a.f_aaa);
  out[at.bb] = scale[0] * (n * a.v_a + n * b.f1_aab - z * b.f_aab);
  out[below::zz] = scale[0] * (-z * a.v_az);
  out[at.ab] = scale[0] * (b.v_a + n * a.f1_aab - z * a.f_aab);
  out[at.az] = scale[0] * (s.v_z - z * a.v_aa);
  out[at.bz] = scale[0] * (-z * s.v_ab);
  out[at.ua] = scale[1] * (2.0 * s.v + n * a.f1_aa - z * a.f_aa);
  out[at.ub] = scale[1] * (n * s.f1_ab - z * s.f_ab);
  out[below::uz] = scale[1] * ((1.0 - n) * a.f_a - z * a.v_a);
}

}  // namespace

below_coefficients below_corner(const body_constants &body, double x, double y, double z,
                                double length) {
  const double nu = body.poisson_ratio;
  const double least = 1e-24 * length * length;
  const double r = std::sqrt(std::max(x * x + y * y + z * z, least));
  const corner_point c{r, z, least};
  const double log_z = log(r + z);
  const double log_x = c.log_sum(x, y * y + z * z), log_y = c.log_sum(y, x * x + z * z);
  const along in_x = c.in(x, y, log_y, log_z), in_y = c.in(y, x, log_x, log_z);
  const double round = atan2(x * y, z * r);
  shared s{};
  s.v = x * log_y + y * log_x - z * round;
  s.v_z = -round;
  s.v_ab = 1.0 / r;
  s.v_zz = -(in_x.v_aa + in_y.v_aa);
  s.f_ab = log_z;
  s.f1_ab = z * log_z - r;

  const double scale[2] = {0.5 / std::numbers::pi, 0.25 / (std::numbers::pi * body.shear_modulus)};
  const double part = 1.0 - 2.0 * nu;
  below_coefficients k{};
  double *p = k.data() + below::at(below::p, 0);
  p[below::xx] = scale[0] * (2.0 * nu * s.v_z - z * in_x.v_aa - part * in_x.f_aa);
  p[below::yy] = scale[0] * (2.0 * nu * s.v_z - z * in_y.v_aa - part * in_y.f_aa);
  p[below::zz] = scale[0] * (s.v_z - z * s.v_zz);
  p[below::xy] = -scale[0] * (part * s.f_ab + z * s.v_ab);
  p[below::yz] = -scale[0] * z * in_y.v_az;
  p[below::zx] = -scale[0] * z * in_x.v_az;
  p[below::ux] = -scale[1] * (part * in_x.f_a + z * in_x.v_a);
  p[below::uy] = -scale[1] * (part * in_y.f_a + z * in_y.v_a);
  p[below::uz] = scale[1] * (2.0 * (1.0 - nu) * s.v - z * s.v_z);
  using b = below;
  of_traction(in_x, in_y, s, nu, z, scale, {b::xx, b::yy, b::xy, b::zx, b::yz, b::ux, b::uy},
              k.data() + b::at(b::qx, 0));
  of_traction(in_y, in_x, s, nu, z, scale, {b::yy, b::xx, b::xy, b::yz, b::zx, b::uy, b::ux},
              k.data() + b::at(b::qy, 0));
  return k;
}

below_coefficients below_rectangle(const body_constants &body, const double size[2], double x,
                                   double y, double z) {
  below_coefficients sum{};
  const double length = std::max(size[0], size[1]);
  for (int i = -1; i <= 1; i += 2)
    for (int j = -1; j <= 1; j += 2) {
      const below_coefficients c =
          below_corner(body, x + 0.5 * i * size[0], y + 0.5 * j * size[1], z, length);
      for (size_t k = 0; k < c.size(); ++k) sum[k] += i * j * c[k];
    }
  return sum;
}

}  // namespace railpatch
