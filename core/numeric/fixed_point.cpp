#include "numeric/fixed_point.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/sums.hpp"

namespace railpatch {

namespace {

constexpr double much_worse = 2.0, much_better = 0.5;
constexpr double least_damping = 1.0 / 256;
constexpr double ridge = 1e-12;  // of the normal equations' diagonal

}  // namespace

fixed_point::fixed_point(size_t max_count) {
  for (auto *b : {&remainder_, &last_x_, &last_remainder_, &best_x_, &best_remainder_})
    *b = aligned_buffer<double>(max_count);
  for (int k = 0; k < depth; ++k) {
    dx_[k] = aligned_buffer<double>(max_count);
    df_[k] = aligned_buffer<double>(max_count);
  }
}

void fixed_point::begin(size_t count) {
  n_ = count;
  kept_ = next_ = 0;
  damping_ = 1;
  started_ = false;
}

// The weights of the kept differences that leave the least remainder; their number.
int fixed_point::combine(double weight[depth]) const {
  double a[depth][depth];
  for (int r = 0; r < kept_; ++r) {
    for (int c = 0; c <= r; ++c) a[r][c] = dot(df_[r].data(), df_[c].data(), n_);
    a[r][r] *= 1 + ridge;
    weight[r] = dot(df_[r].data(), remainder_.data(), n_);
    if (!(a[r][r] > 0)) return 0;
  }
  // Cholesky, in place
  for (int r = 0; r < kept_; ++r)
    for (int c = 0; c <= r; ++c) {
      double sum = a[r][c];
      for (int k = 0; k < c; ++k) sum -= a[r][k] * a[c][k];
      if (r == c && !(sum > 0)) return 0;
      a[r][c] = r == c ? std::sqrt(sum) : sum / a[c][c];
    }
  for (int r = 0; r < kept_; ++r) {
    for (int k = 0; k < r; ++k) weight[r] -= a[r][k] * weight[k];
    weight[r] /= a[r][r];
  }
  for (int r = kept_ - 1; r >= 0; --r) {
    for (int k = r + 1; k < kept_; ++k) weight[r] -= a[k][r] * weight[k];
    weight[r] /= a[r][r];
  }
  return kept_;
}

void fixed_point::remember(const double *x) {
  for (size_t i = 0; i < n_; ++i) {
    dx_[next_][i] = x[i] - last_x_[i];
    df_[next_][i] = remainder_[i] - last_remainder_[i];
  }
  next_ = (next_ + 1) % depth;
  kept_ = std::min(kept_ + 1, depth);
}

void fixed_point::advance(double *x, const double *gx) {
  for (size_t i = 0; i < n_; ++i) remainder_[i] = gx[i] - x[i];
  const double size = std::sqrt(dot(remainder_.data(), remainder_.data(), n_));
  if (started_ && !(size <= much_worse * best_size_) && damping_ > least_damping) {
    damping_ *= 0.5;
    kept_ = next_ = 0;
    std::copy_n(best_x_.data(), n_, x);
    std::copy_n(best_remainder_.data(), n_, remainder_.data());
  } else {
    if (started_) remember(x);
    if (!started_ || size < best_size_) {
      if (started_ && size < much_better * best_size_) damping_ = std::min(1.0, 2 * damping_);
      best_size_ = size;
      std::copy_n(x, n_, best_x_.data());
      std::copy_n(remainder_.data(), n_, best_remainder_.data());
    }
  }
  started_ = true;
  std::copy_n(x, n_, last_x_.data());
  std::copy_n(remainder_.data(), n_, last_remainder_.data());
  double weight[depth];
  const int used = combine(weight);
  for (size_t i = 0; i < n_; ++i) x[i] += damping_ * remainder_[i];
  for (int k = 0; k < used; ++k)
    for (size_t i = 0; i < n_; ++i) x[i] -= weight[k] * (dx_[k][i] + damping_ * df_[k][i]);
}

}  // namespace railpatch
