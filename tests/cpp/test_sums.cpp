// Sums in parts against sums in greater precision, for every number of terms that is left over.
#include "numeric/sums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace railpatch;

constexpr double eps = std::numeric_limits<double>::epsilon();

std::vector<double> drawn(size_t n, std::mt19937_64 &random) {
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<double> v(n);
  for (double &x : v) x = value(random);
  return v;
}

TEST(Sums, AreThoseOfGreaterPrecision) {
  std::mt19937_64 random(3);
  for (size_t n = 0; n <= 41; ++n) {
    const std::vector<double> a = drawn(n, random), b = drawn(n, random);
    long double sum = 0, product = 0;
    for (size_t i = 0; i < n; ++i) {
      sum += a[i];
      product += static_cast<long double>(a[i]) * b[i];
    }
    // no more roundings than terms, none above the number of terms
    const double bound = eps * static_cast<double>(n * n);
    EXPECT_NEAR(total(a.data(), n), static_cast<double>(sum), bound) << n;
    EXPECT_NEAR(dot(a.data(), b.data(), n), static_cast<double>(product), bound) << n;
  }
}

TEST(Sums, OfSeveralVectorsAreThoseOfEach) {
  std::mt19937_64 random(4);
  for (size_t n : {1u, 8u, 13u})
    for (int count = 0; count <= 9; ++count) {
      const size_t stride = n + 3;
      const std::vector<double> a = drawn(stride * 10, random), v = drawn(n, random);
      const std::vector<double> factor = drawn(10, random);
      std::vector<double> out(10, 77.0), left = v;
      left.push_back(77.0);
      dots(a.data(), stride, count, v.data(), n, out.data());
      subtract(a.data(), stride, count, factor.data(), left.data(), n);
      for (size_t m = 0; m < 10; ++m)
        EXPECT_EQ(out[m], m < static_cast<size_t>(count) ? dot(&a[m * stride], v.data(), n) : 77.0);
      for (size_t i = 0; i < n; ++i) {
        long double value = v[i];
        for (size_t m = 0; m < static_cast<size_t>(count); ++m)
          value -= static_cast<long double>(factor[m]) * a[m * stride + i];
        EXPECT_NEAR(left[i], static_cast<double>(value), 4 * eps * (count + 1))
            << n << " " << count;
      }
      EXPECT_EQ(left[n], 77.0);
    }
}

}  // namespace
