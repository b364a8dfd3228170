#include "row_blocks.hpp"

#include <cmath>
#include <utility>

#include "simd.hpp"

namespace railpatch {

namespace {

// Right-looking LU with partial pivoting, column-major: every inner loop runs down a column.
RAILPATCH_DISPATCH
void factor(float *a, int *pivot, int n) {
  for (int k = 0; k < n; ++k) {
    float *column = a + static_cast<size_t>(k) * static_cast<size_t>(n);
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(column[i]) > std::fabs(column[best])) best = i;
    pivot[k] = best;
    if (best != k)
      for (int j = 0; j < n; ++j) std::swap(a[j * n + k], a[j * n + best]);
    const float inverse = column[k] != 0.0f ? 1.0f / column[k] : 0.0f;
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
    for (int j = k + 1; j < n; ++j) {
      float *target = a + static_cast<size_t>(j) * static_cast<size_t>(n);
      const float factor = target[k];
      if (factor == 0.0f) continue;
      for (int i = k + 1; i < n; ++i) target[i] -= factor * column[i];
    }
  }
}

RAILPATCH_DISPATCH
void substitute(const float *a, const int *pivot, int n, float *v) {
  for (int k = 0; k < n; ++k) std::swap(v[k], v[pivot[k]]);
  for (int k = 0; k < n; ++k) {
    const float *column = a + static_cast<size_t>(k) * static_cast<size_t>(n);
    const float value = v[k];
    for (int i = k + 1; i < n; ++i) v[i] -= value * column[i];
  }
  for (int k = n - 1; k >= 0; --k) {
    const float *column = a + static_cast<size_t>(k) * static_cast<size_t>(n);
    const float value = column[k] != 0.0f ? v[k] / column[k] : 0.0f;
    v[k] = value;
    for (int i = 0; i < k; ++i) v[i] -= value * column[i];
  }
}

}  // namespace

row_blocks::row_blocks(int max_row, int max_rows) {
  const auto row = static_cast<size_t>(max_row), rows = static_cast<size_t>(max_rows);
  factors_ = aligned_buffer<float>::uninitialized(4 * row * row * rows);
  pivots_ = aligned_buffer<int>::uninitialized(2 * row * rows);
  vector_ = aligned_buffer<float>(2 * row);
}

void row_blocks::add_row(int n, const double *bxx, const double *byy,
                         const element_linearisation *elements) {
  const int size = 2 * n;
  float *block = factors_.data() + used_;
  for (int col = 0; col < n; ++col)
    for (int row = 0; row < n; ++row) {
      const element_linearisation &e = elements[row];
      const double bx = bxx[col * n + row], by = byy[col * n + row];
      const double one = row == col ? 1.0 : 0.0;
      block[col * size + row] = static_cast<float>(e.stiff[0] * bx + one * e.keep[0]);
      block[col * size + n + row] = static_cast<float>(e.stiff[1] * bx + one * e.keep[1]);
      block[(n + col) * size + row] = static_cast<float>(e.stiff[1] * by + one * e.keep[1]);
      block[(n + col) * size + n + row] = static_cast<float>(e.stiff[2] * by + one * e.keep[2]);
    }
  factor(block, pivots_.data() + pivots_used_, size);
  used_ += static_cast<size_t>(size) * static_cast<size_t>(size);
  pivots_used_ += static_cast<size_t>(size);
}

void row_blocks::solve(const int *row_start, int rows, double *v) {
  const float *block = factors_.data();
  const int *pivot = pivots_.data();
  for (int row = 0; row < rows; ++row) {
    const int size = 2 * (row_start[row + 1] - row_start[row]);
    double *part = v + 2 * row_start[row];
    // scaled to unit size, so that single precision neither overflows nor loses small tractions
    double scale = 0;
    for (int k = 0; k < size; ++k) scale = std::fmax(scale, std::fabs(part[k]));
    if (scale > 0) {
      for (int k = 0; k < size; ++k)
        vector_[static_cast<size_t>(k)] = static_cast<float>(part[k] / scale);
      substitute(block, pivot, size, vector_.data());
      for (int k = 0; k < size; ++k) part[k] = scale * vector_[static_cast<size_t>(k)];
    }
    block += static_cast<size_t>(size) * static_cast<size_t>(size);
    pivot += size;
  }
}

size_t row_blocks::bytes() const { return factors_.bytes() + pivots_.bytes() + vector_.bytes(); }

}  // namespace railpatch
