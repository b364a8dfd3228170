// The Newton method on operators that are monotone but nothing like a rolling contact's: rows of
// different length and scale, strongly skew, given as dense matrices. The conditions of stick and
// slip are checked here anew, and that the solution does not depend on the start.
#include "tangential/rolling_newton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "dense_operator.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;
using dense::dense_operator, dense::lengths, dense::without_steps;

constexpr double tolerance = 1e-9;

// skewness, and whether the linear systems break down: then the safeguard alone has to do
class Operators : public testing::TestWithParam<std::pair<double, bool>> {};

TEST_P(Operators, AreSolvedFromAnyStart) {
  std::mt19937_64 random(20240919);
  std::uniform_real_distribution<double> entry(-1, 1);
  rolling_newton newton(12, static_cast<int>(lengths.size()), false);
  // the safeguard is tried after every five Newton steps
  const int most = GetParam().second ? 2000 : 400;
  // without Newton steps each case takes hundreds of products
  const int cases = (GetParam().second ? 6 : 20) / (scenes::sanitized ? 3 : 1);
  for (int k = 0; k < cases; ++k) {
    const auto [skewness, broken] = GetParam();
    dense_operator b(skewness, random, broken);
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
      const tangential_result result = newton.solve(b, problem, {tolerance, most});
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

INSTANTIATE_TEST_SUITE_P(Skewness, Operators,
                         testing::Values(std::pair(0.0, false), std::pair(0.2, false),
                                         std::pair(1.0, false), std::pair(5.0, false)));
INSTANTIATE_TEST_SUITE_P(WithoutSteps, Operators,
                         testing::Values(std::pair(0.0, true), std::pair(0.2, true),
                                         std::pair(1.0, true)));

// The safeguard's steps come closer to the solution however little B's symmetric part is.
TEST(Safeguard, GainsOnAnySkewness) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> entry(-1, 1);
  rolling_newton newton(12, static_cast<int>(lengths.size()), false);
  for (double skewness : {1.0, 30.0, 1e3, 3e4}) {
    dense_operator b(skewness, random);
    without_steps hindered(b);
    const size_t n = b.size() / 2;
    std::vector<double> bound(n, 1e9), area(n, 1.0), rigid(2 * n), p(2 * n), s(2 * n);
    for (double &v : rigid) v = 2 * entry(random);
    const rolling_problem problem{static_cast<int>(lengths.size()),
                                  b.start().data(),
                                  bound.data(),
                                  area.data(),
                                  rigid.data(),
                                  p.data(),
                                  s.data()};
    // to be tried once, and again and again
    for (const tangential_options options : {tangential_options{0.9, 8}, {0.5, 200}}) {
      std::fill(p.begin(), p.end(), 0.0);
      const tangential_result result = newton.solve(hindered, problem, options);
      EXPECT_TRUE(result.converged) << "skewness " << skewness << ", left " << result.residual;
    }
  }
}

// Where all slides fast no linear system is needed.
TEST(Sliding, NeedsNoSteps) {
  std::mt19937_64 random(20261123);
  std::uniform_real_distribution<double> entry(-1, 1);
  rolling_newton newton(12, static_cast<int>(lengths.size()), false);
  dense_operator b(0.2, random);
  without_steps hindered(b);
  const size_t n = b.size() / 2;
  std::vector<double> bound(n), area(n, 1.0), rigid(2 * n), p(2 * n), s(2 * n);
  for (double &v : bound) v = std::fabs(entry(random));
  for (size_t i = 0; i < rigid.size(); ++i) rigid[i] = 100 + entry(random);
  const rolling_problem problem{static_cast<int>(lengths.size()),
                                b.start().data(),
                                bound.data(),
                                area.data(),
                                rigid.data(),
                                p.data(),
                                s.data()};
  const tangential_result result = newton.solve(hindered, problem, {tolerance, 400});
  EXPECT_TRUE(result.converged) << result.residual;
  EXPECT_EQ(result.newton_iterations, 0);
  EXPECT_EQ(result.slip, static_cast<int>(n));
}

}  // namespace
