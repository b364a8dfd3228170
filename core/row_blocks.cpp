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

// Factors serve equations whose slip directions and weights have changed no more than this: they
// precondition only, so it decides on speed and not on results.
constexpr double least_cosine = 0.98, greatest_change = 0.1;

// target[begin ... end) -= the panel's columns, each times its factor
RAILPATCH_INLINE void eliminate(const float *__restrict panel, int stride, int begin, int end,
                                const float *factors, float *__restrict target) {
  const float *l[pack];
  float u[pack];
  for (int c = 0; c < pack; ++c) {
    l[c] = panel + c * stride + begin;
    u[c] = factors[c];
  }
  target += begin;
  const auto count = static_cast<size_t>((end - begin) / pack) * pack;
  for (size_t i = 0; i < count; ++i)
    target[i] -= ((l[0][i] * u[0] + l[1][i] * u[1]) + (l[2][i] * u[2] + l[3][i] * u[3])) +
                 ((l[4][i] * u[4] + l[5][i] * u[5]) + (l[6][i] * u[6] + l[7][i] * u[7]));
}

// x <- M x within a panel's rows, M dense in columns. The number of rows is not given as a constant
// only because loops of unknown length are made of whole SIMD registers by every compiler.
RAILPATCH_INLINE void apply(const float *__restrict m, int rows, float *__restrict x) {
  float u[pack];
  for (int c = 0; c < pack; ++c) u[c] = x[c];
  const auto count = static_cast<size_t>(rows / pack) * pack;
  for (size_t i = 0; i < count; ++i)
    x[i] =
        ((m[i] * u[0] + m[pack + i] * u[1]) + (m[2 * pack + i] * u[2] + m[3 * pack + i] * u[3])) +
        ((m[4 * pack + i] * u[4] + m[5 * pack + i] * u[5]) +
         (m[6 * pack + i] * u[6] + m[7 * pack + i] * u[7]));
}

// A panel's columns from its diagonal block down to `end`: L below, U above, inverse pivots on the
// diagonal. `a` points to the block, rows are counted from there.
RAILPATCH_INLINE void factor_panel(float *a, int stride, int end) {
  const auto below = static_cast<size_t>((end - pack) / pack) * pack;
  for (int c = 0; c < pack; ++c) {
    float *__restrict column = a + c * stride;
    float *__restrict rest = column + pack;
    for (int e = 0; e < c; ++e) {
      const float *__restrict l = a + e * stride;
      const float u = column[e];
      for (int i = e + 1; i < pack; ++i) column[i] -= u * l[i];
      for (size_t i = 0; i < below; ++i) rest[i] -= u * l[pack + i];
    }
    // only the matrix of no rolling contact has no pivot here
    const float inverse = column[c] != 0.0f ? 1.0f / column[c] : 1.0f;
    for (int i = c + 1; i < pack; ++i) column[i] *= inverse;
    for (size_t i = 0; i < below; ++i) rest[i] *= inverse;
    column[c] = inverse;
  }
}

// Inverses of a panel's L and U within its rows, each dense.
inline void invert(const float *a, int stride, float *lower, float *upper) {
  std::fill_n(lower, pack * pack, 0.0f);
  std::fill_n(upper, pack * pack, 0.0f);
  for (int c = 0; c < pack; ++c) {
    float *l = lower + c * pack, *u = upper + c * pack;
    l[c] = 1.0f;
    for (int e = c; e < pack; ++e)
      for (int i = e + 1; i < pack; ++i) l[i] -= a[e * stride + i] * l[e];
    u[c] = 1.0f;
    for (int e = c; e >= 0; --e) {
      u[e] *= a[e * stride + e];
      for (int i = 0; i < e; ++i) u[i] -= a[e * stride + i] * u[e];
    }
  }
}

// LU of a matrix whose first n columns do not meet the others before column `meet`; `inverses`
// holds those of L and U of each panel's diagonal block.
RAILPATCH_DISPATCH
void factor(float *a, int order, int n, int meet, int width, float *inverses) {
  for (int k = 0; k < order; k += pack) {
    const int next = k + pack;
    const int last = next <= meet ? n : order, end = whole_packs(last);
    float *panel = a + k * order;
    float *lower = inverses + 2 * pack * k;
    factor_panel(panel + k, order, end - k);
    invert(panel + k, order, lower, lower + pack * pack);
    for (int j = next; j < last; ++j) {
      float *target = a + j * order;
      apply(lower, width, target + k);
      eliminate(panel, order, next, end, target + k, target);
    }
  }
}

RAILPATCH_DISPATCH
void substitute(const float *a, int order, int width, const float *inverses, float *x) {
  for (int k = 0; k < order; k += pack) {
    apply(inverses + 2 * pack * k, width, x + k);
    eliminate(a + k * order, order, k + pack, order, x + k, x);
  }
  for (int k = order - pack; k >= 0; k -= pack) {
    apply(inverses + 2 * pack * k + pack * pack, width, x + k);
    eliminate(a + k * order, order, 0, k, x + k, x);
  }
}

}  // namespace

row_blocks::row_blocks(int max_row, int max_rows) : max_order_(whole_packs(2 * max_row)) {
  const auto row = static_cast<size_t>(max_row), rows = static_cast<size_t>(max_rows);
  const auto order = static_cast<size_t>(max_order_);
  factors_ = aligned_buffer<float>::uninitialized(order * order * rows);
  inverses_ = aligned_buffer<float>::uninitialized(2 * pack * order * rows);
  blocks_ = aligned_buffer<block>(rows);
  factored_ = aligned_buffer<element_linearisation>(row * rows);
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

void row_blocks::start(int rows, const int *row_start) {
  rows_ = rows;
  row_start_ = row_start;
  for (int row = 0; row < rows; ++row) blocks_[static_cast<size_t>(row)] = {0, 0};
}

bool row_blocks::serves(int row, const element_linearisation *elements) const {
  if (blocks_[static_cast<size_t>(row)].size == 0) return false;
  const element_linearisation *factored = factored_.data() + row_start_[row];
  const int n = row_start_[row + 1] - row_start_[row];
  return std::equal(elements, elements + n, factored, [](const auto &e, const auto &f) {
    if (e.stick || f.stick) return e.stick == f.stick;
    return e.c[0] * f.c[0] + e.c[1] * f.c[1] >= least_cosine &&
           std::abs(e.keep - f.keep) <= greatest_change;
  });
}

void row_blocks::set_row(int row, const double *bxx, const double *byy,
                         const element_linearisation *elements) {
  const auto sticks = [](const element_linearisation &e) { return e.stick; };
  const int n = row_start_[row + 1] - row_start_[row];
  const int size = n + static_cast<int>(std::count_if(elements, elements + n, sticks));
  const int order = whole_packs(size);
  blocks_[static_cast<size_t>(row)] = {size, order};
  std::copy_n(elements, n, factored_.data() + row_start_[row]);
  fill(n, bxx, byy, elements, factors(row), order);
  // before the first element that slips, x and y do not meet
  const int meet = static_cast<int>(std::find_if_not(elements, elements + n, sticks) - elements);
  factor(factors(row), order, n, meet, pack, inverses(row));
}

void row_blocks::solve(int row, double *v) {
  float *x = vector_.data();
  const auto [size, order] = blocks_[static_cast<size_t>(row)];
  // scaled to unit size, so that single precision neither overflows nor loses small tractions
  double scale = 0;
  for (int k = 0; k < size; ++k) scale = std::max(scale, std::abs(v[k]));
  if (!(scale > 0)) return;
  for (int k = 0; k < size; ++k) x[k] = static_cast<float>(v[k] / scale);
  std::fill(x + size, x + order, 0.0f);
  substitute(factors(row), order, pack, inverses(row), x);
  for (int k = 0; k < size; ++k) v[k] = scale * static_cast<double>(x[k]);
}

size_t row_blocks::bytes() const {
  return factors_.bytes() + inverses_.bytes() + factored_.bytes() + blocks_.bytes() +
         vector_.bytes() + row_x_.bytes() + row_y_.bytes() + sticking_.bytes();
}

}  // namespace railpatch
