#include "half_space/conformal_coupling.hpp"

#include <cmath>

namespace railpatch {

conformal_coupling::conformal_coupling(influence &a, int max_count) : a_(a) {
  for (auto &b : slip_) b = aligned_buffer<double>(static_cast<size_t>(max_count));
}

bool conformal_coupling::set_grid(const grid &g) {
  grid_ = g;
  return true;
}

void conformal_coupling::from_pressure(double offset, const double *p, double *ux, double *uy) {
  a_.curved().from_pressure(p, 0, grid_.dx, ux, uy);
  if (offset == 0) return;
  double *sx = slip_[0].data(), *sy = slip_[1].data();
  a_.curved().from_pressure(p, offset > 0 ? 1 : -1, grid_.dx, sx, sy);
  for (int i = 0; i < grid_.count(); ++i) {
    ux[i] -= std::abs(offset) * sx[i];
    uy[i] -= std::abs(offset) * sy[i];
  }
}

void conformal_coupling::from_traction(const double *px, const double *py, double *un) {
  a_.curved().from_traction(px, py, un);
}

}  // namespace railpatch
