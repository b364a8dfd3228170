#include "fft.hpp"

namespace railpatch {

int fft_plans::find(int min_nx, int min_ny) const {
  for (size_t i = 0; i < sizes_x_.size(); ++i) {
    if (sizes_x_[i] < min_nx) continue;
    for (size_t j = 0; j < sizes_y_.size(); ++j)
      if (sizes_y_[j] >= min_ny) return static_cast<int>(i * sizes_y_.size() + j);
  }
  return -1;
}

int smooth_size(int n) {
  for (int m = n + n % 2;; m += 2) {
    // FFTW takes memory from the heap in every execution with these numbers of rows
    if (m == 576 || m == 640) continue;
    int rest = m;
    for (int prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return m;
  }
}

}  // namespace railpatch
