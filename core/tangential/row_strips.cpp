#include "tangential/row_strips.hpp"

#include <algorithm>

namespace railpatch {

row_strips::row_strips(int max_nx, int across) : across_(across) {
  for (auto &l : line_) l = aligned_buffer<double>(2 * static_cast<size_t>(max_nx) + 1);
}

void row_strips::set(influence &a, const grid &g, int rows, bool transposed) {
  nx_ = g.nx;
  const int strip = 1 + rows / across_;
  set_line(a, g, kernel::xx, strip, transposed, line_[0].data() + nx_);
  set_line(a, g, kernel::yy, strip, transposed, line_[1].data() + nx_);
}

// Rows of a strip that lie j apart are strip - j pairs.
void row_strips::set_line(influence &a, const grid &g, kernel k, int strip, bool transposed,
                          double *line) const {
  std::fill(line - g.nx, line + g.nx + 1, 0.0);
  for (int j = 0; j < strip; ++j) {
    const double weight = (j == 0 ? 1.0 : 2.0) * (strip - j) / (strip * g.dx);
    double before = a.coefficient(k, g.nx + 1, j);
    for (int ahead = -g.nx; ahead <= g.nx; ++ahead) {
      const double here = a.coefficient(k, ahead, j);
      line[transposed ? -ahead : ahead] += weight * (here - before);
      before = here;
    }
  }
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
