#include "forces.hpp"

#include <cmath>

namespace railpatch {

patch_wrench sum_tractions(const grid &g, const double *pressure, const double *px,
                           const double *py) {
  patch_wrench w{};
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      const double x = g.x(i), y = g.y(j), p = pressure[at];
      w.force[2] -= p;
      w.moment[0] -= y * p;
      w.moment[1] += x * p;
      if (!px) continue;
      w.force[0] += px[at];
      w.force[1] += py[at];
      w.moment[2] += x * py[at] - y * px[at];
    }
  const double area = g.dx * g.dy;
  for (int k = 0; k < 3; ++k) {
    w.force[k] *= area;
    w.moment[k] *= area;
  }
  return w;
}

void add_wrench(const patch_wrench &wrench, double contact_angle, const double lever[3],
                double force[3], double moment[3]) {
  const double c = std::cos(contact_angle), s = std::sin(contact_angle);
  const auto rotate = [&](const double v[3], double out[3]) {
    out[0] = v[0];
    out[1] = c * v[1] - s * v[2];
    out[2] = s * v[1] + c * v[2];
  };
  double f[3], m[3];
  rotate(wrench.force, f);
  rotate(wrench.moment, m);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, n = (k + 2) % 3;
    force[k] += f[k];
    moment[k] += m[k] + lever[l] * f[n] - lever[n] * f[l];
  }
}

}  // namespace railpatch
