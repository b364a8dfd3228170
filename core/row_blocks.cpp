#include "row_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "simd.hpp"

namespace railpatch {

namespace {

// Columns are eliminated in panels as wide as loops down a column take in one go, so that every
// loop runs over whole packs and none is left over.
constexpr int pack = 8;
constexpr int whole_packs(int n) { return (n + pack - 1) / pack * pack; }

// target[begin ... end) -= the panel's columns, each times its factor
RAILPATCH_DISPATCH
void eliminate(const float *__restrict panel, int stride, int begin, int end, const float *factors,
               float *__restrict target) {
  const float *l[pack];
  float u[pack];
  for (int c = 0; c < pack; ++c) {
    l[c] = panel + static_cast<size_t>(c) * static_cast<size_t>(stride) + begin;
    u[c] = factors[c];
  }
  target += begin;
  const auto count = static_cast<size_t>((end - begin) / pack) * pack;
  for (size_t i = 0; i < count; ++i)
    target[i] -= ((l[0][i] * u[0] + l[1][i] * u[1]) + (l[2][i] * u[2] + l[3][i] * u[3])) +
                 ((l[4][i] * u[4] + l[5][i] * u[5]) + (l[6][i] * u[6] + l[7][i] * u[7]));
}

// target <- L^-1 target within a panel's rows; L in a[row + column stride], unit diagonal
inline void solve_lower(const float *a, int stride, float *target) {
  for (int c = 0; c + 1 < pack; ++c)
    for (int i = c + 1; i < pack; ++i) target[i] -= a[c * stride + i] * target[c];
}

inline void solve_upper(const float *a, int stride, float *target) {
  for (int c = pack - 1; c >= 0; --c) {
    target[c] *= a[c * stride + c];
    for (int i = 0; i < c; ++i) target[i] -= a[c * stride + i] * target[c];
  }
}

// A panel's columns from its diagonal block down to `end`: L below, U above, inverse pivots on the
// diagonal. `a` points to the block, rows are counted from there.
RAILPATCH_DISPATCH
void factor_panel(float *a, int stride, int end) {
  for (int c = 0; c < pack; ++c) {
    float *__restrict column = a + c * stride;
    for (int e = 0; e < c; ++e) {
      const float *__restrict l = a + e * stride;
      const float u = column[e];
      for (int i = e + 1; i < pack; ++i) column[i] -= u * l[i];
      for (int i = pack; i < end; ++i) column[i] -= u * l[i];
    }
    // only the matrix of no rolling contact has no pivot here
    const float inverse = column[c] != 0.0f ? 1.0f / column[c] : 1.0f;
    for (int i = c + 1; i < end; ++i) column[i] *= inverse;
    column[c] = inverse;
  }
}

}  // namespace

row_blocks::row_blocks(int max_row, int max_rows) {
  const auto row = static_cast<size_t>(max_row), rows = static_cast<size_t>(max_rows);
  const auto order = static_cast<size_t>(whole_packs(2 * max_row));
  factors_ = aligned_buffer<float>::uninitialized(order * order * rows);
  blocks_ = aligned_buffer<block>(rows);
  vector_ = aligned_buffer<float>(order);
  row_x_ = aligned_buffer<float>(row);
  row_y_ = aligned_buffer<float>(row);
  sticking_ = aligned_buffer<int>(row);
}

// Equations and unknowns: first those of z, then those of z_y, then unit ones up to the order.
RAILPATCH_DISPATCH
void row_blocks::fill(int n, const double *bxx, const double *byy,
                      const element_linearisation *elements, float *columns, int order) {
  const auto column = [&](int j) { return columns + static_cast<size_t>(j * order); };
  float *__restrict row_x = row_x_.data(), *__restrict row_y = row_y_.data();
  int *sticking = sticking_.data();
  int sticks = 0;
  for (int i = 0; i < n; ++i) {
    const element_linearisation &e = elements[i];
    row_x[i] = static_cast<float>(e.stiff * e.c[0]);
    row_y[i] = static_cast<float>(e.stiff * e.c[1]);
    if (e.stick) sticking[sticks++] = i;
  }
  const auto stick_rows = [&](const double *y, double factor, float *out) {
    for (int i = 0; i < sticks; ++i)
      out[i] = static_cast<float>(elements[sticking[i]].stiff * factor * y[sticking[i]]);
    std::fill(out + sticks, out + order - n, 0.0f);
  };
  for (int j = 0, next = n; j < n; ++j) {
    const element_linearisation &e = elements[j];
    const double *__restrict x = bxx + j * n, *__restrict y = byy + j * n;
    float *__restrict out = column(j);
    if (e.stick) {
      for (int i = 0; i < n; ++i) out[i] = row_x[i] * static_cast<float>(x[i]);
      std::fill(out + n, out + order, 0.0f);
      float *__restrict other = column(next++);
      for (int i = 0; i < n; ++i) other[i] = row_y[i] * static_cast<float>(y[i]);
      stick_rows(y, 1.0, other + n);
    } else {
      const auto cx = static_cast<float>(e.c[0]), cy = static_cast<float>(e.c[1]);
      for (int i = 0; i < n; ++i)
        out[i] =
            row_x[i] * (cx * static_cast<float>(x[i])) + row_y[i] * (cy * static_cast<float>(y[i]));
      out[j] += static_cast<float>(e.keep);
      stick_rows(y, e.c[1], out + n);
    }
  }
  for (int j = n + sticks; j < order; ++j) {
    std::fill_n(column(j), order, 0.0f);
    column(j)[j] = 1.0f;
  }
}

void row_blocks::add_row(int n, const double *bxx, const double *byy,
                         const element_linearisation *elements) {
  const auto sticks = [](const element_linearisation &e) { return e.stick; };
  const int size = n + static_cast<int>(std::count_if(elements, elements + n, sticks));
  const int order = whole_packs(size);
  float *a = factors_.data() + used_;
  blocks_[static_cast<size_t>(rows_++)] = {used_, size, order};
  used_ += static_cast<size_t>(order) * static_cast<size_t>(order);
  fill(n, bxx, byy, elements, a, order);
  // before the first element that slips, x and y do not meet
  const int meet = static_cast<int>(std::find_if_not(elements, elements + n, sticks) - elements);
  for (int k = 0; k < order; k += pack) {
    const int next = k + pack;
    const int last = next <= meet ? n : order, end = whole_packs(last);
    float *panel = a + static_cast<size_t>(k * order);
    factor_panel(panel + k, order, end - k);
    for (int j = next; j < last; ++j) {
      float *target = a + static_cast<size_t>(j * order);
      solve_lower(panel + k, order, target + k);
      eliminate(panel, order, next, end, target + k, target);
    }
  }
}

void row_blocks::solve(int row, double *v) {
  float *x = vector_.data();
  const auto [at, size, order] = blocks_[static_cast<size_t>(row)];
  // scaled to unit size, so that single precision neither overflows nor loses small tractions
  double scale = 0;
  for (int k = 0; k < size; ++k) scale = std::max(scale, std::abs(v[k]));
  if (!(scale > 0)) return;
  for (int k = 0; k < size; ++k) x[k] = static_cast<float>(v[k] / scale);
  std::fill(x + size, x + order, 0.0f);
  substitute(factors_.data() + at, order, x);
  for (int k = 0; k < size; ++k) v[k] = scale * static_cast<double>(x[k]);
}

void row_blocks::substitute(const float *a, int order, float *x) const {
  for (int k = 0; k < order; k += pack) {
    const float *panel = a + static_cast<size_t>(k * order);
    solve_lower(panel + k, order, x + k);
    eliminate(panel, order, k + pack, order, x + k, x);
  }
  for (int k = order - pack; k >= 0; k -= pack) {
    const float *panel = a + static_cast<size_t>(k * order);
    solve_upper(panel + k, order, x + k);
    eliminate(panel, order, 0, k, x + k, x);
  }
}

size_t row_blocks::bytes() const {
  return factors_.bytes() + blocks_.bytes() + vector_.bytes() + row_x_.bytes() + row_y_.bytes() +
         sticking_.bytes();
}

}  // namespace railpatch
