// Operators that are monotone but nothing like a rolling contact's: rows of different length and
// scale, strongly skew, given as dense matrices.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "numeric/sums.hpp"
#include "tangential/rolling_newton.hpp"

namespace dense {

using namespace railpatch;

inline const std::vector<int> lengths = {1, 7, 12, 3, 9};

// B = diagonal + skew in the vectors' order, positive definite: p . B p = p . diagonal p.
class dense_operator final : public rolling_operator {
 public:
  // broken: its row matrices are beyond single precision, so that steps are no numbers
  dense_operator(double skewness, std::mt19937_64 &random, bool broken = false) : broken_(broken) {
    start_.push_back(0);
    for (int n : lengths) start_.push_back(start_.back() + n);
    size_ = 2 * static_cast<size_t>(start_.back());
    b_.resize(size_ * size_);
    std::uniform_real_distribution<double> entry(-1, 1);
    for (size_t i = 0; i < size_; ++i) {
      b_[i * size_ + i] = 1;
      for (size_t j = 0; j < i; ++j) {
        if (crossed(i, j)) continue;
        b_[i * size_ + j] = skewness * entry(random);
        b_[j * size_ + i] = -b_[i * size_ + j];
      }
    }
  }
  void product(const double *p, double *s) override {
    for (size_t i = 0; i < size_; ++i) s[i] = dot(b_.data() + i * size_, p, size_);
  }
  void row_matrices(int row, double *bxx, double *byy) const override {
    const size_t n = static_cast<size_t>(lengths[static_cast<size_t>(row)]);
    const size_t x = 2 * static_cast<size_t>(start_[static_cast<size_t>(row)]), y = x + n;
    if (broken_) {
      std::fill_n(bxx, n * n, 1e300);
      std::fill_n(byy, n * n, 1e300);
      return;
    }
    for (size_t source = 0; source < n; ++source)
      for (size_t observer = 0; observer < n; ++observer) {
        bxx[source * n + observer] = b_[(x + observer) * size_ + x + source];
        byy[source * n + observer] = b_[(y + observer) * size_ + y + source];
      }
  }
  double projection_scale(int row) const override { return 0.5 + 0.3 * row; }

  // The same problem with the two components in each other's place.
  dense_operator exchanged() const {
    dense_operator other(*this);
    for (size_t i = 0; i < size_; ++i)
      for (size_t j = 0; j < size_; ++j)
        other.b_[partner(i) * size_ + partner(j)] = b_[i * size_ + j];
    return other;
  }
  std::vector<double> exchanged(const std::vector<double> &v) const {
    std::vector<double> other(v.size());
    for (size_t i = 0; i < v.size(); ++i) other[partner(i)] = v[i];
    return other;
  }

  const std::vector<int> &start() const { return start_; }
  size_t size() const { return size_; }

 private:
  // where the other component of the same element stands
  size_t partner(size_t i) const {
    size_t row = 0;
    while (i >= 2 * static_cast<size_t>(start_[row + 1])) ++row;
    const size_t x = 2 * static_cast<size_t>(start_[row]), n = static_cast<size_t>(lengths[row]);
    return i < x + n ? i + n : i - n;
  }
  // p_x and p_y of one row, which do not act on each other
  bool crossed(size_t i, size_t j) const {
    for (size_t row = 0; row < lengths.size(); ++row) {
      const size_t x = 2 * static_cast<size_t>(start_[row]);
      const size_t n = static_cast<size_t>(lengths[row]);
      if (i >= x && j >= x && i < x + 2 * n && j < x + 2 * n) return (i < x + n) != (j < x + n);
    }
    return false;
  }
  bool broken_;
  std::vector<int> start_;
  size_t size_ = 0;
  std::vector<double> b_;
};

// The same with which no linear system can be solved, so that steps are no numbers.
class without_steps final : public rolling_operator {
 public:
  explicit without_steps(dense_operator &b) : b_(b) {}
  void product(const double *p, double *s) override { b_.product(p, s); }
  void product_single(const double *, double *s) override { std::fill_n(s, b_.size(), NAN); }
  void row_matrices(int row, double *bxx, double *byy) const override {
    b_.row_matrices(row, bxx, byy);
  }
  double projection_scale(int row) const override { return b_.projection_scale(row); }

 private:
  dense_operator &b_;
};

}  // namespace dense
