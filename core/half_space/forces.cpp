#include "half_space/forces.hpp"

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

}  // namespace railpatch
