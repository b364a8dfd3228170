#include "tangential/row_elements.hpp"

#include <algorithm>

namespace railpatch {

row_elements::row_elements(int max_nx, int max_ny) {
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  at_ = aligned_buffer<int>(n);
  row_start_ = aligned_buffer<int>(static_cast<size_t>(max_ny) + 1);
  for (auto &b : grid_) b = aligned_buffer<double>(n);
}

void row_elements::collect(const grid &g, const double *pressure, int direction) {
  count_ = rows_ = 0;
  for (int j = 0; j < g.ny; ++j) {
    const int begin = count_;
    for (int k = 0; k < g.nx; ++k) {
      const int at = j * g.nx + (direction > 0 ? g.nx - 1 - k : k);
      if (pressure[at] > 0) at_[static_cast<size_t>(count_++)] = at;
    }
    if (count_ == begin) continue;
    row_start_[static_cast<size_t>(rows_++)] = begin;
  }
  row_start_[static_cast<size_t>(rows_)] = count_;
  for (int k = 0; k < 2; ++k) std::fill_n(grid_[k].data(), g.count(), 0.0);
}

int row_elements::common_row() const {
  int longest = 0;
  for (int row = 0; row < rows_; ++row) {
    if (!gapless(row)) return -1;
    if (length(row) > length(longest)) longest = row;
  }
  return longest;
}

}  // namespace railpatch
