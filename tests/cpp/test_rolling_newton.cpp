// The Newton method on operators that are monotone but nothing like a rolling contact's: rows of
// different length and scale, strongly skew, given as dense matrices. The conditions of stick and
// slip are checked here anew, and that the solution does not depend on the start.
#include "tangential/rolling_newton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace railpatch;

constexpr double tolerance = 1e-9;
const std::vector<int> lengths = {1, 7, 12, 3, 9};

// B = diagonal + skew in the vectors' order, positive definite: p . B p = p . diagonal p.
class dense_operator final : public rolling_operator {
 public:
  dense_operator(double skewness, std::mt19937_64 &random) {
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
    for (size_t i = 0; i < size_; ++i) {
      s[i] = 0;
      for (size_t j = 0; j < size_; ++j) s[i] += b_[i * size_ + j] * p[j];
    }
  }
  void row_matrices(int row, double *bxx, double *byy) const override {
    const size_t n = static_cast<size_t>(lengths[static_cast<size_t>(row)]);
    const size_t x = 2 * static_cast<size_t>(start_[static_cast<size_t>(row)]), y = x + n;
    for (size_t source = 0; source < n; ++source)
      for (size_t observer = 0; observer < n; ++observer) {
        bxx[source * n + observer] = b_[(x + observer) * size_ + x + source];
        byy[source * n + observer] = b_[(y + observer) * size_ + y + source];
      }
  }
  double projection_scale(int row) const override { return 0.5 + 0.3 * row; }

  const std::vector<int> &start() const { return start_; }
  size_t size() const { return size_; }

 private:
  // p_x and p_y of one row, which do not act on each other
  bool crossed(size_t i, size_t j) const {
    for (size_t row = 0; row < lengths.size(); ++row) {
      const size_t x = 2 * static_cast<size_t>(start_[row]);
      const size_t n = static_cast<size_t>(lengths[row]);
      if (i >= x && j >= x && i < x + 2 * n && j < x + 2 * n) return (i < x + n) != (j < x + n);
    }
    return false;
  }
  std::vector<int> start_;
  size_t size_ = 0;
  std::vector<double> b_;
};

class Operators : public testing::TestWithParam<double> {};

TEST_P(Operators, AreSolvedFromAnyStart) {
  std::mt19937_64 random(20240919);
  std::uniform_real_distribution<double> entry(-1, 1);
  rolling_newton newton(12, static_cast<int>(lengths.size()), false);
  for (int k = 0; k < 20; ++k) {
    dense_operator b(GetParam(), random);
    const size_t n = b.size() / 2;
    std::vector<double> bound(n), area(n, 1.0), rigid(2 * n), p(2 * n), s(2 * n), first;
    for (double &v : bound) v = std::fabs(entry(random));
    for (double &v : rigid) v = 2 * entry(random);
    for (int start = 0; start < 3; ++start) {
      for (double &v : p) v = start == 0 ? 0.0 : 3 * entry(random);
      const rolling_problem problem{static_cast<int>(lengths.size()),
                                    b.start().data(),
                                    bound.data(),
                                    area.data(),
                                    rigid.data(),
                                    p.data(),
                                    s.data()};
      const tangential_result result = newton.solve(b, problem, {tolerance, 400});
      SCOPED_TRACE(testing::Message() << "case " << k << ", start " << start);
      ASSERT_TRUE(result.converged) << "residual " << result.residual;
      if (first.empty()) first = p;
      // the operator's smallest eigenvalue is 1, so the solution is as exact as the residual
      const double exact = 100 * tolerance * std::sqrt(static_cast<double>(b.size()));
      std::vector<double> slip(2 * n);
      b.product(p.data(), slip.data());
      for (size_t row = 0; row < lengths.size(); ++row)
        for (int i = 0; i < lengths[row]; ++i) {
          const auto element = static_cast<size_t>(b.start()[row] + i);
          const size_t x = static_cast<size_t>(2 * b.start()[row] + i);
          const size_t y = x + static_cast<size_t>(lengths[row]);
          const double sx = slip[x] + rigid[x], sy = slip[y] + rigid[y];
          const double size = std::hypot(p[x], p[y]), speed = std::hypot(sx, sy);
          EXPECT_LE(size, bound[element] * (1 + 1e-12));
          if (newton.sticks(static_cast<int>(element))) {
            EXPECT_LE(speed, exact);
          } else {
            EXPECT_NEAR(size, bound[element], exact);
            EXPECT_NEAR(p[x] * sx + p[y] * sy, -size * speed, exact * (1 + speed));
          }
        }
      for (size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], first[i], exact);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Skewness, Operators, testing::Values(0.0, 0.2, 1.0, 5.0));

}  // namespace
