#include "numeric/band_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

band_matrix::band_matrix(size_t max_rows, size_t max_numbers)
    : numbers_(aligned_buffer<double>::uninitialized(max_numbers)), inverse_(max_rows) {}

void band_matrix::set_size(size_t rows, size_t below, size_t above) {
  rows_ = rows;
  below_ = std::min(below, rows - 1);
  above_ = std::min(above, rows - 1);
  width_ = below_ + above_ + 1;
  std::fill_n(numbers_.data(), rows * width_, 0.0);
}

bool band_matrix::factor() {
  for (size_t k = 0; k < rows_; ++k) {
    const double pivot = at(k, k);
    if (!(std::abs(pivot) > 0)) return false;
    inverse_[k] = 1 / pivot;
    const size_t last = std::min(k + below_, rows_ - 1);
    const size_t length = std::min(above_, rows_ - 1 - k);
    const double *from = &at(k, k) + 1;
    for (size_t i = k + 1; i <= last; ++i) {
      double *factor = &at(i, k);
      if (*factor == 0) continue;
      *factor *= inverse_[k];
      const double times = *factor;
      double *to = factor + 1;
      for (size_t m = 0; m < length; ++m) to[m] -= times * from[m];
    }
  }
  return true;
}

void band_matrix::solve(double *v) const {
  for (size_t i = 0; i < rows_; ++i) {
    const double *row = numbers_.data() + i * width_ + below_ - i;
    double sum = v[i];
    for (size_t k = i > below_ ? i - below_ : 0; k < i; ++k) sum -= row[k] * v[k];
    v[i] = sum;
  }
  for (size_t i = rows_; i-- > 0;) {
    const double *row = numbers_.data() + i * width_ + below_ - i;
    double sum = v[i];
    for (size_t k = i + 1; k <= std::min(i + above_, rows_ - 1); ++k) sum -= row[k] * v[k];
    v[i] = sum * inverse_[i];
  }
}

}  // namespace railpatch
