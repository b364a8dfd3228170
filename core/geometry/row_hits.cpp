#include "geometry/row_hits.hpp"

#include <cmath>

#include "numeric/simd.hpp"

namespace railpatch {

namespace {

// Coefficients of the unknowns over x: first derivatives and halves of the second ones.
struct row_start {
  double p[3], n[3];
};

// With f1 = u - q_y and f2 = (q_x^2 + q_z^2 - r^2)/2, both none: their total derivatives by x.
row_start start_of(const row_of_lines &row) {
  const profile_piece &m = row.meridian;
  const double t = row.p - m.begin;
  const vec3 q = row.q0 + row.n * row.qn;
  const auto value = [t](const double *c) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
  const auto slope = [t](const double *c) { return c[1] + t * (2 * c[2] + 3 * t * c[3]); };
  const auto bend = [t](const double *c) { return 2 * c[2] + 6 * t * c[3]; };
  const double r = value(m.z), du = slope(m.y), dr = slope(m.z), rdr = r * dr;
  const double g = q[0] * row.qn[0] + q[2] * row.qn[2];
  const double det = du * g - rdr * row.qn[1];
  const auto solve = [&](double f1, double f2, double &p, double &n) {
    p = -(f1 * g + row.qn[1] * f2) / det;
    n = -(du * f2 + rdr * f1) / det;
  };
  row_start out;
  out.p[0] = row.p;
  out.n[0] = row.n;
  solve(-row.qx[1], q[0] * row.qx[0] + q[2] * row.qx[2], out.p[1], out.n[1]);
  const double ahead = row.qx[0] + out.n[1] * row.qn[0], down = row.qx[2] + out.n[1] * row.qn[2];
  const double square = out.p[1] * out.p[1];
  const double bent = ahead * ahead + down * down - (dr * dr + r * bend(m.z)) * square;
  solve(bend(m.y) * square, bent, out.p[2], out.n[2]);
  out.p[2] *= 0.5;
  out.n[2] *= 0.5;
  return out;
}

RAILPATCH_DISPATCH void meet_elements(const row_of_lines &row, double x0, double dx, int count,
                                      double *p, double *n, double *off) {
  const row_start from = start_of(row);
  const profile_piece m = row.meridian;
  const vec3 a = row.q0, b = row.qx, c = row.qn;
  const double length = m.end - m.begin;
  RAILPATCH_INDEPENDENT
  for (int i = 0; i < count; ++i) {
    const double x = x0 + i * dx;
    const double ps = from.p[0] + x * (from.p[1] + x * from.p[2]);
    const double ns = from.n[0] + x * (from.n[1] + x * from.n[2]);
    const double t = ps - m.begin;
    const double q0 = a[0] + x * b[0] + ns * c[0], q1 = a[1] + x * b[1] + ns * c[1],
                 q2 = a[2] + x * b[2] + ns * c[2];
    const double u = m.y[0] + t * (m.y[1] + t * (m.y[2] + t * m.y[3]));
    const double r = m.z[0] + t * (m.z[1] + t * (m.z[2] + t * m.z[3]));
    const double du = m.y[1] + t * (2 * m.y[2] + 3 * t * m.y[3]);
    const double rdr = r * (m.z[1] + t * (2 * m.z[2] + 3 * t * m.z[3]));
    const double f1 = u - q1, f2 = 0.5 * (q0 * q0 + q2 * q2 - r * r);
    const double g = q0 * c[0] + q2 * c[2], det = du * g - rdr * c[1];
    const double dp = -(f1 * g + c[1] * f2) / det, dn = -(du * f2 + rdr * f1) / det;
    p[i] = ps + dp;
    n[i] = ns + dn;
    const double at = t + dp;
    const bool there = (std::fabs(det) > grazing_cosine * r) & (std::fabs(dp) < close_step) &
                       (std::fabs(dn) < close_step) & (at >= 0) & (at <= length);
    off[i] = there ? 0.0 : 1.0;
  }
}

}  // namespace

void meet_row(const row_of_lines &row, double x0, double dx, int count, double *p, double *n,
              double *off) {
  meet_elements(row, x0, dx, count, p, n, off);
}

}  // namespace railpatch
