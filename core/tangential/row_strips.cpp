#include "tangential/row_strips.hpp"

#include <algorithm>

namespace railpatch {

row_strips::row_strips(int max_nx, int across) : across_(across) {
  for (auto &l : line_) l = aligned_buffer<double>(2 * static_cast<size_t>(max_nx) + 1);
}

void row_strips::matrices(const row_elements &elements, int row, int direction, double *bxx,
                          double *byy) const {
  const int *at = elements.at(row), n = elements.length(row);
  const double *xx = line_[0].data() + nx_, *yy = line_[1].data() + nx_;
  const bool gapless = elements.gapless(row);
  for (int source = 0; source < n; ++source) {
    double *x = bxx + source * n, *y = byy + source * n;
    if (gapless) {
      std::copy_n(xx - source, n, x);
      std::copy_n(yy - source, n, y);
      continue;
    }
    for (int observer = 0; observer < n; ++observer) {
      const int ahead = direction * (at[source] - at[observer]);
      x[observer] = xx[ahead];
      y[observer] = yy[ahead];
    }
  }
}

}  // namespace railpatch
