// The rail's surface as the elements of a grid see it, against the contact frame: where it lies
// along n, and how it is inclined. Pressure acts along its normals and not along the frame's one.
#pragma once

#include <algorithm>
#include <cstddef>

namespace railpatch {

struct surface_slopes {
  // by element, m and -, or by row where columns is 1 and x makes no difference
  double *height = nullptr, *across = nullptr, *along = nullptr;
  int columns = 1;

  std::ptrdiff_t place(int row) const { return static_cast<std::ptrdiff_t>(row) * columns; }
  // of so many columns, none inclined
  void clear(int count, int rows) {
    columns = count;
    for (double *field : {height, across, along}) std::fill_n(field, place(rows), 0.0);
  }
};

}  // namespace railpatch
