#include "tangential/row_elements.hpp"

#include <algorithm>

namespace railpatch {

row_elements::row_elements(int max_nx, int max_ny) {
  const auto n = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  at_ = aligned_buffer<int>(n);
  within_ = aligned_buffer<int>(n);
  row_start_ = aligned_buffer<int>(static_cast<size_t>(max_ny) + 1);
  for (auto &b : grid_) b = aligned_buffer<double>(n);
}

void row_elements::collect(const grid &g, const double *pressure, int direction, bool boxed) {
  count_ = rows_ = 0;
  int low[2] = {g.nx, g.ny}, high[2] = {-1, -1};
  for (int j = 0; j < g.ny; ++j) {
    const int begin = count_;
    for (int k = 0; k < g.nx; ++k) {
      const int at = j * g.nx + (direction > 0 ? g.nx - 1 - k : k);
      if (pressure[at] > 0) at_[static_cast<size_t>(count_++)] = at;
    }
    if (count_ == begin) continue;
    const int ends[2] = {at_[static_cast<size_t>(begin)] % g.nx,
                         at_[static_cast<size_t>(count_ - 1)] % g.nx};
    low[0] = std::min({low[0], ends[0], ends[1]});
    high[0] = std::max({high[0], ends[0], ends[1]});
    low[1] = std::min(low[1], j);
    high[1] = j;
    row_start_[static_cast<size_t>(rows_++)] = begin;
  }
  row_start_[static_cast<size_t>(rows_)] = count_;
  const int whole[2] = {g.nx, g.ny};
  for (int c = 0; c < 2; ++c) {
    const bool all = !boxed || count_ == 0;
    box_[c] = all ? 0 : low[c];
    box_[2 + c] = all ? whole[c] : high[c] - low[c] + 1;
  }
  for (size_t k = 0; k < static_cast<size_t>(count_); ++k)
    within_[k] = (at_[k] / g.nx - box_[1]) * box_[2] + at_[k] % g.nx - box_[0];
  for (int k = 0; k < 2; ++k) std::fill_n(grid_[k].data(), box_[2] * box_[3], 0.0);
}

grid row_elements::product_grid(const grid &g) const {
  return {box_[2], box_[3], g.dx, g.dy, g.x(box_[0]), g.y(box_[1])};
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
