#include "numeric/row_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/simd.hpp"

namespace railpatch {

namespace {

// Columns are eliminated in panels as wide as loops down a column take in one go, so that every
// loop runs over whole packs and none is left over.
constexpr int pack = 8;
constexpr int whole_packs(int n) { return (n + pack - 1) / pack * pack; }

// Factors serve equations whose slip directions and weights have changed no more than this: they
// precondition only, so it decides on speed and not on results.
constexpr double least_cosine = 0.98, greatest_change = 0.1;

// In slip an element's traction answers to the slip near it only, as friction itself resists: what
// lies further than this many elements away is left out of the factors.
constexpr int slip_band = 4 * pack;

// Elements of the longest row for each row at most, where rows share factors.
constexpr size_t least_sharing = 8;

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

// Rows below a panel, and columns behind it: next ... near and far ... end.
struct reach {
  int near, far, end;
};

constexpr reach reach_of(const block_shape &m, int k) {
  const int next = k + pack, end = next <= m.meet ? whole_packs(m.n) : m.order;
  const int near = next + m.band;
  if (k >= m.border || near >= m.border) return {end, end, end};
  return {near, m.border, end};
}

// First row that meets a panel from above.
constexpr int first_above(const block_shape &m, int k) {
  return k >= m.border ? 0 : std::max(0, k - m.band);
}

// A panel's columns from its diagonal block down: L below, U above, inverse pivots on the diagonal.
// `a` points to the first row.
RAILPATCH_INLINE void factor_panel(float *a, int stride, int k, const reach &below) {
  const int next = k + pack;
  const auto near = static_cast<size_t>((below.near - next) / pack) * pack;
  const auto far = static_cast<size_t>((below.end - below.far) / pack) * pack;
  for (int c = 0; c < pack; ++c) {
    float *__restrict column = a + c * stride + k;
    float *__restrict rest = a + c * stride + next, *__restrict border = a + c * stride + below.far;
    for (int e = 0; e < c; ++e) {
      const float *__restrict l = a + e * stride + k;
      const float *__restrict l_near = a + e * stride + next;
      const float *__restrict l_far = a + e * stride + below.far;
      const float u = column[e];
      for (int i = e + 1; i < pack; ++i) column[i] -= u * l[i];
      for (size_t i = 0; i < near; ++i) rest[i] -= u * l_near[i];
      for (size_t i = 0; i < far; ++i) border[i] -= u * l_far[i];
    }
    // only the matrix of no rolling contact has no pivot here
    const float inverse = column[c] != 0.0f ? 1.0f / column[c] : 1.0f;
    for (int i = c + 1; i < pack; ++i) column[i] *= inverse;
    for (size_t i = 0; i < near; ++i) rest[i] *= inverse;
    for (size_t i = 0; i < far; ++i) border[i] *= inverse;
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

// LU of what is kept of a matrix; `inverses` holds those of L and U of each panel's diagonal block.
// `trailing`, where given, takes what is still to be factored before each panel.
RAILPATCH_DISPATCH
void factor(float *a, const block_shape &m, int width, float *inverses, float *trailing = nullptr) {
  const int order = m.order;
  for (int k = 0; k < order; k += pack) {
    for (int j = k; trailing && j < order; ++j, trailing += order - k)
      std::copy_n(a + j * order + k, order - k, trailing);
    const int next = k + pack, last = next <= m.meet ? m.n : order;
    const reach to = reach_of(m, k);
    float *panel = a + k * order;
    float *lower = inverses + 2 * pack * k;
    factor_panel(panel, order, k, to);
    invert(panel + k, order, lower, lower + pack * pack);
    for (int j = next; j < last; ++j) {
      if (j == to.near) j = to.far;
      if (j >= last) break;
      float *target = a + j * order;
      apply(lower, width, target + k);
      eliminate(panel, order, next, to.near, target + k, target);
      if (to.far < to.end) eliminate(panel, order, to.far, to.end, target + k, target);
    }
  }
}

// The factors in the order that substitution takes them: for each panel its inverse and L below,
// then from the last panel on its inverse and U above.
constexpr size_t packed_size(size_t order) { return order * (order + pack); }

void pack_factors(const float *a, const block_shape &m, const float *inverses, float *out) {
  const auto take = [&](const float *from, int count) { out = std::copy_n(from, count, out); };
  for (int k = 0; k < m.order; k += pack) {
    const reach to = reach_of(m, k);
    take(inverses + 2 * pack * k, pack * pack);
    const float *panel = a + k * m.order;
    for (int c = 0; c < pack; ++c) take(panel + c * m.order + k + pack, to.near - k - pack);
    for (int c = 0; c < pack; ++c) take(panel + c * m.order + to.far, to.end - to.far);
  }
  for (int k = m.order - pack; k >= 0; k -= pack) {
    const int first = first_above(m, k);
    take(inverses + 2 * pack * k + pack * pack, pack * pack);
    for (int c = k; c < k + pack; ++c) take(a + c * m.order + first, k - first);
  }
}

RAILPATCH_DISPATCH
void substitute(const float *packed, const block_shape &m, int width, float *x) {
  for (int k = 0; k < m.order; k += pack) {
    const reach to = reach_of(m, k);
    apply(packed, width, x + k);
    packed += pack * pack;
    const int near = to.near - k - pack, far = to.end - to.far;
    eliminate(packed, near, 0, near, x + k, x + k + pack);
    packed += pack * near;
    if (far > 0) eliminate(packed, far, 0, far, x + k, x + to.far);
    packed += pack * far;
  }
  for (int k = m.order - pack; k >= 0; k -= pack) {
    const int first = first_above(m, k);
    apply(packed, width, x + k);
    packed += pack * pack;
    eliminate(packed, k - first, 0, k - first, x + k, x + first);
    packed += pack * (k - first);
  }
}

// The leading part of the factors, of `lead` unknowns: x[lead ... end) takes what they add there.
RAILPATCH_DISPATCH
void substitute_down(const float *a, int order, int width, int lead, int end, const float *inverses,
                     float *x) {
  for (int k = 0; k < lead; k += pack) {
    apply(inverses + 2 * pack * k, width, x + k);
    eliminate(a + k * order, order, k + pack, end, x + k, x);
  }
}

// The way back: from x[lead ... end) to the leading unknowns.
RAILPATCH_DISPATCH
void substitute_up(const float *a, int order, int width, int lead, int end, const float *inverses,
                   float *x) {
  for (int k = end - pack; k >= lead; k -= pack) eliminate(a + k * order, order, 0, lead, x + k, x);
  for (int k = whole_packs(lead) - pack; k >= 0; k -= pack) {
    apply(inverses + 2 * pack * k + pack * pack, width, x + k);
    eliminate(a + k * order, order, 0, k, x + k, x);
  }
}

// What a block is made of. scale: of the matrices xx and yy, whose columns lie `stride` apart.
template <class T>
struct block_filling {
  struct {
    int n, order, stride;
  } sizes;
  const T *xx, *yy;
  double scale;
  const element_linearisation *elements;
  float *columns, *row_x, *row_y;
  int *sticking;
};

// Equations and unknowns: first those of z, then those of z_y, then unit ones up to the order.
template <class T>
RAILPATCH_INLINE void fill_block(const block_filling<T> &f) {
  const auto [n, order, stride] = f.sizes;
  const element_linearisation *elements = f.elements;
  const auto column = [&](int j) { return f.columns + static_cast<size_t>(j * order); };
  float *__restrict row_x = f.row_x, *__restrict row_y = f.row_y;
  int *sticking = f.sticking;
  int sticks = 0;
  for (int i = 0; i < n; ++i) {
    const element_linearisation &e = elements[i];
    row_x[i] = static_cast<float>(f.scale * e.stiff * e.c[0]);
    row_y[i] = static_cast<float>(f.scale * e.stiff * e.c[1]);
    if (e.stick) sticking[sticks++] = i;
  }
  const auto stick_rows = [&](const T *y, double factor, float *out) {
    for (int i = 0; i < sticks; ++i)
      out[i] = static_cast<float>(f.scale * elements[sticking[i]].stiff * factor *
                                  static_cast<double>(y[sticking[i]]));
    std::fill(out + sticks, out + order - n, 0.0f);
  };
  for (int j = 0, next = n; j < n; ++j) {
    const element_linearisation &e = elements[j];
    const T *__restrict x = f.xx + j * stride, *__restrict y = f.yy + j * stride;
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

// dispatch does not go with templates
RAILPATCH_DISPATCH
void fill(const block_filling<float> &f) { fill_block(f); }
RAILPATCH_DISPATCH
void fill(const block_filling<double> &f) { fill_block(f); }

int leading_sticks(const element_linearisation *elements, int n) {
  int k = 0;
  while (k < n && elements[k].stick) ++k;
  return k;
}

// Where the matrix left after `eliminated` unknowns lies among all of them.
constexpr size_t trailing_at(int order, int eliminated) {
  size_t sum = 0;
  for (int k = 0; k < eliminated; k += pack)
    sum += static_cast<size_t>(order - k) * static_cast<size_t>(order - k);
  return sum;
}

}  // namespace

row_blocks::row_blocks(int max_row, int max_rows) : max_order_(whole_packs(2 * max_row)) {
  const auto row = static_cast<size_t>(max_row), rows = static_cast<size_t>(max_rows);
  const auto order = static_cast<size_t>(max_order_);
  factors_ = aligned_buffer<float>::uninitialized(packed_size(order) * rows);
  block_ = aligned_buffer<float>::uninitialized(order * order);
  inverses_ = aligned_buffer<float>::uninitialized(2 * pack * order);
  blocks_ = aligned_buffer<block>(rows);
  factored_ = aligned_buffer<element_linearisation>(row * rows);
  vector_ = aligned_buffer<float>(order);
  const int shared = whole_packs(max_row);
  row_x_ = aligned_buffer<float>(static_cast<size_t>(shared));
  row_y_ = aligned_buffer<float>(static_cast<size_t>(shared));
  sticking_ = aligned_buffer<int>(row);
  // few rows gain nothing
  if (rows * least_sharing < row) return;
  for (int c = 0; c < 2; ++c) {
    shared_[c] = aligned_buffer<float>::uninitialized(static_cast<size_t>(shared * shared));
    shared_inverses_[c] =
        aligned_buffer<float>::uninitialized(2 * pack * static_cast<size_t>(shared));
    trailing_[c] = aligned_buffer<float>::uninitialized(trailing_at(shared, shared));
  }
}

void row_blocks::start(int rows, const int *row_start) {
  rows_ = rows;
  row_start_ = row_start;
  for (int row = 0; row < rows; ++row) blocks_[static_cast<size_t>(row)] = {};
  shared_order_ = 0;
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

void row_blocks::share(int n, const double *bxx, const double *byy) {
  shared_order_ = whole_packs(n);
  shared_scale_ = bxx[0];
  if (shared_[0].size() == 0 || !(shared_scale_ > 0)) {
    shared_order_ = 0;
    return;
  }
  const double *b[2] = {bxx, byy};
  for (int c = 0; c < 2; ++c) {
    float *a = shared_[c].data();
    for (int j = 0; j < shared_order_; ++j) {
      float *column = a + j * shared_order_;
      std::fill_n(column, shared_order_, 0.0f);
      if (j >= n) column[j] = 1.0f;
      for (int i = 0; i < n && j < n; ++i)
        column[i] = static_cast<float>(b[c][j * n + i] / shared_scale_);
    }
    const block_shape all{shared_order_, shared_order_, shared_order_, shared_order_,
                          shared_order_};
    factor(a, all, pack, shared_inverses_[c].data(), trailing_[c].data());
  }
}

bool row_blocks::set_row(int row, const element_linearisation *elements) {
  if (shared_order_ == 0) return false;
  const int n = row_start_[row + 1] - row_start_[row];
  const int sticks = leading_sticks(elements, n);
  const int lead = sticks == n ? n : sticks / pack * pack, stride = shared_order_ - lead;
  prepare(row, lead, sticks - lead, slip_band, elements);
  if (lead == n) return true;
  const size_t at = trailing_at(shared_order_, lead);
  fill(block_filling<float>{{n - lead, shape_of(row).order, stride},
                            trailing_[0].data() + at,
                            trailing_[1].data() + at,
                            shared_scale_,
                            elements + lead,
                            block_.data(),
                            row_x_.data(),
                            row_y_.data(),
                            sticking_.data()});
  factor_row(row);
  return true;
}

void row_blocks::set_row(int row, const double *bxx, const double *byy,
                         const element_linearisation *elements) {
  const int n = row_start_[row + 1] - row_start_[row];
  prepare(row, 0, leading_sticks(elements, n), max_order_, elements);
  fill(block_filling<double>{{n, shape_of(row).order, n},
                             bxx,
                             byy,
                             1.0,
                             elements,
                             block_.data(),
                             row_x_.data(),
                             row_y_.data(),
                             sticking_.data()});
  factor_row(row);
}

void row_blocks::factor_row(int row) {
  factor(block_.data(), shape_of(row), pack, inverses_.data());
  pack_factors(block_.data(), shape_of(row), inverses_.data(), factors(row));
}

void row_blocks::prepare(int row, int lead, int meet, int band,
                         const element_linearisation *elements) {
  const auto sticks = [](const element_linearisation &e) { return e.stick; };
  const int n = row_start_[row + 1] - row_start_[row];
  const int size = n + static_cast<int>(std::count_if(elements, elements + n, sticks));
  const int own = n - lead, own_size = size - 2 * lead, order = whole_packs(own_size);
  const int border = own_size > own ? own / pack * pack : order;
  blocks_[static_cast<size_t>(row)] = {size, lead, {order, own, meet, band, border}};
  std::copy_n(elements, n, factored_.data() + row_start_[row]);
}

void row_blocks::solve(int row, double *v) {
  const auto [size, lead, shape] = blocks_[static_cast<size_t>(row)];
  // scaled to unit size, so that single precision neither overflows nor loses small tractions
  double scale = 0;
  for (int k = 0; k < size; ++k) scale = std::max(scale, std::abs(v[k]));
  if (!(scale > 0)) return;
  const int n = row_start_[row + 1] - row_start_[row], end = whole_packs(n);
  // own unknowns: z, then z_y, of the elements behind the leading ones
  const int own = n - lead, own_size = size - 2 * lead;
  double *own_z = v + lead, *own_y = v + n + lead;
  float *x = vector_.data();
  for (int k = 0; k < own; ++k) x[k] = static_cast<float>(own_z[k] / scale);
  for (int k = own; k < own_size; ++k) x[k] = static_cast<float>(own_y[k - own] / scale);
  std::fill(x + own_size, x + shape.order, 0.0f);
  float *lead_x = row_x_.data(), *lead_y = row_y_.data();
  const element_linearisation *rest = factored_.data() + row_start_[row] + lead;
  if (lead > 0) {
    for (int k = 0; k < lead; ++k) {
      lead_x[k] = static_cast<float>(v[k] / scale);
      lead_y[k] = static_cast<float>(v[n + k] / scale);
    }
    for (int c = 0; c < 2; ++c) {
      float *part = c == 0 ? lead_x : lead_y;
      std::fill(part + lead, part + end, 0.0f);
      substitute_down(shared_[c].data(), shared_order_, pack, lead, end, shared_inverses_[c].data(),
                      part);
    }
    // L's rows of an element that slips are those of its components, as its equation is
    const double unit = factored_[static_cast<size_t>(row_start_[row])].stiff;
    for (int k = 0, second = own; k < own; ++k) {
      const element_linearisation &e = rest[k];
      const auto weight = static_cast<float>(e.stiff / unit);
      x[k] += weight * (static_cast<float>(e.c[0]) * lead_x[lead + k] +
                        static_cast<float>(e.c[1]) * lead_y[lead + k]);
      if (e.stick) x[second++] += weight * lead_y[lead + k];
    }
  }
  substitute(factors(row), shape, pack, x);
  if (lead > 0) {
    for (int k = 0, second = own; k < own; ++k) {
      const element_linearisation &e = rest[k];
      lead_x[lead + k] = static_cast<float>(e.c[0]) * x[k];
      lead_y[lead + k] = e.stick ? x[second++] : static_cast<float>(e.c[1]) * x[k];
    }
    // in stick the equations are those of the shared matrix times stiff and its scale
    const double unit =
        1.0 / (factored_[static_cast<size_t>(row_start_[row])].stiff * shared_scale_);
    for (int c = 0; c < 2; ++c) {
      float *part = c == 0 ? lead_x : lead_y;
      std::fill(part + n, part + end, 0.0f);
      for (int k = 0; k < lead; ++k) part[k] *= static_cast<float>(unit);
      substitute_up(shared_[c].data(), shared_order_, pack, lead, end, shared_inverses_[c].data(),
                    part);
    }
    for (int k = 0; k < lead; ++k) {
      v[k] = scale * static_cast<double>(lead_x[k]);
      v[n + k] = scale * static_cast<double>(lead_y[k]);
    }
  }
  for (int k = 0; k < own; ++k) own_z[k] = scale * static_cast<double>(x[k]);
  for (int k = own; k < own_size; ++k) own_y[k - own] = scale * static_cast<double>(x[k]);
}

size_t row_blocks::bytes() const {
  return factors_.bytes() + block_.bytes() + inverses_.bytes() + factored_.bytes() +
         blocks_.bytes() + vector_.bytes() + row_x_.bytes() + row_y_.bytes() + sticking_.bytes() +
         2 * (shared_[0].bytes() + shared_inverses_[0].bytes() + trailing_[0].bytes());
}

}  // namespace railpatch
