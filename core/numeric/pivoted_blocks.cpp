#include "numeric/pivoted_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numeric/simd.hpp"

namespace railpatch {

namespace {

// y -= a x
RAILPATCH_DISPATCH
void subtract(int n, float a, const float *__restrict x, float *__restrict y) {
  for (int i = 0; i < n; ++i) y[i] -= a * x[i];
}

}  // namespace

pivoted_blocks::pivoted_blocks(int max_row, int max_rows)
    : max_order_(2 * max_row),
      block_(static_cast<size_t>(max_order_) * static_cast<size_t>(max_order_)) {
  factors_ = aligned_buffer<float>::uninitialized(block_ * static_cast<size_t>(max_rows));
  vector_ = aligned_buffer<float>(static_cast<size_t>(max_order_));
  pivots_ = aligned_buffer<int>(static_cast<size_t>(max_order_) * static_cast<size_t>(max_rows));
}

void pivoted_blocks::factor(int row, int n) {
  const int order = 2 * n;
  float *a = matrix(row);
  int *pivot = pivots_.data() + static_cast<size_t>(row) * static_cast<size_t>(max_order_);
  for (int k = 0; k < order; ++k) {
    float *column = a + k * order;
    int p = k;
    for (int i = k + 1; i < order; ++i)
      if (std::abs(column[i]) > std::abs(column[p])) p = i;
    pivot[k] = p;
    if (p != k)
      for (int j = 0; j < order; ++j) std::swap(a[j * order + k], a[j * order + p]);
    // a singular block still preconditions, by what is regular of it
    const float inverse = column[k] != 0.0f ? 1.0f / column[k] : 1.0f;
    for (int i = k + 1; i < order; ++i) column[i] *= inverse;
    for (int j = k + 1; j < order; ++j)
      if (const float u = a[j * order + k]; u != 0.0f)
        subtract(order - k - 1, u, column + k + 1, a + j * order + k + 1);
    column[k] = inverse;
  }
}

void pivoted_blocks::solve(int row, int n, double *v) {
  const int order = 2 * n;
  const float *a = matrix(row);
  const int *pivot = pivots_.data() + static_cast<size_t>(row) * static_cast<size_t>(max_order_);
  float *x = vector_.data();
  // scaled to unit size, so that single precision neither overflows nor loses small tractions
  double scale = 0;
  for (int i = 0; i < order; ++i) scale = std::max(scale, std::abs(v[i]));
  if (!(scale > 0)) return;
  for (int i = 0; i < order; ++i) x[i] = static_cast<float>(v[i] / scale);
  for (int k = 0; k < order; ++k) std::swap(x[k], x[pivot[k]]);
  for (int k = 0; k < order; ++k) subtract(order - k - 1, x[k], a + k * order + k + 1, x + k + 1);
  for (int k = order - 1; k >= 0; --k) {
    x[k] *= a[k * order + k];
    subtract(k, x[k], a + k * order, x);
  }
  for (int i = 0; i < order; ++i) v[i] = scale * static_cast<double>(x[i]);
}

}  // namespace railpatch
