#include "numeric/fft.hpp"

#include <algorithm>

namespace railpatch {

int fft_plans::find(int min_nx, int min_ny) const {
  for (size_t i = 0; i < sizes_x_.size(); ++i) {
    if (sizes_x_[i] < min_nx) continue;
    for (size_t j = 0; j < sizes_y_.size(); ++j)
      if (sizes_y_[j] >= min_ny) return static_cast<int>(i * sizes_y_.size() + j);
  }
  return -1;
}

fft_plans fft_plans::halved() const {
  const auto half = [](std::vector<int> sizes) {
    // a grid rounded up, seen from one element more
    for (int &size : sizes)
      if (size > 1) size = smooth_size(size / 2 + 1);
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    return sizes;
  };
  return fft_plans(half(sizes_x_), half(sizes_y_));
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
