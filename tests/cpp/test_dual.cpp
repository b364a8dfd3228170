// Numbers with rates: every operation against central differences of the same in plain numbers, and
// where the rates are a matter of convention against that.
#include "numeric/dual.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace railpatch;
using number = dual<3>;

number drawn(std::mt19937_64 &random, double low, double high) {
  std::uniform_real_distribution<double> value(low, high), rate(-2, 2);
  number a(value(random));
  for (double &r : a.rate) r = rate(random);
  return a;
}

// f in duals against differences of f in plain numbers along each direction
template <class F>
void expect_derivative(const char *name, const number &a, const number &b, F &&f) {
  using std::abs;
  const number found = f(a, b);
  const double h = 1e-6;
  EXPECT_EQ(found.value, f(a.value, b.value)) << name;
  for (size_t k = 0; k < 3; ++k) {
    const double there = f(a.value + h * a.rate[k], b.value + h * b.rate[k]);
    const double back = f(a.value - h * a.rate[k], b.value - h * b.rate[k]);
    const double slope = (there - back) / (2 * h);
    EXPECT_NEAR(found.rate[k], slope, 1e-7 * (1 + abs(slope))) << name << " " << k;
  }
}

TEST(Dual, OperationsHaveTheRatesOfDifferences) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i) {
    const number a = drawn(random, 0.3, 2.0), c = drawn(random, -2.0, -0.3);
    for (const number &b : {drawn(random, 0.3, 2.0), drawn(random, -2.0, -0.3)}) {
      expect_derivative("+", a, b, [](auto x, auto y) { return x + y; });
      expect_derivative("-", a, b, [](auto x, auto y) { return x - y; });
      expect_derivative("*", a, b, [](auto x, auto y) { return x * y; });
      expect_derivative("/", a, b, [](auto x, auto y) { return x / y; });
      expect_derivative("negative", a, b, [](auto x, auto) { return -x; });
      expect_derivative("with constants", a, b,
                        [](auto x, auto y) { return 2.0 * x - y / 3.0 + 1.0 / x - 0.5; });
      expect_derivative("+=", a, b, [](auto x, auto y) { return x += y; });
      expect_derivative("-=", a, b, [](auto x, auto y) { return x -= y; });
      expect_derivative("*=", a, b, [](auto x, auto y) { return x *= y; });
      expect_derivative("/=", a, b, [](auto x, auto y) { return x /= y; });
      for (const number &v : {a, c}) {
        expect_derivative("sin", v, b, [](auto x, auto) {
          using railpatch::sin;
          return sin(x);
        });
        expect_derivative("cos", v, b, [](auto x, auto) {
          using railpatch::cos;
          return cos(x);
        });
        expect_derivative("fabs", v, b, [](auto x, auto) {
          using std::fabs;
          return fabs(x);
        });
        expect_derivative("atan2", v, b, [](auto x, auto y) {
          using railpatch::atan2;
          return atan2(x, y);
        });
        expect_derivative("hypot", v, b, [](auto x, auto y) {
          using railpatch::hypot;
          return hypot(x, y);
        });
      }
      expect_derivative("sqrt", a, b, [](auto x, auto) {
        using std::sqrt;
        return sqrt(x);
      });
      for (double exponent : {-1.5, 0.25, 1.0, 3.0})
        expect_derivative("pow", a, b, [=](auto x, auto) {
          using railpatch::pow;
          return pow(x, exponent);
        });
      EXPECT_EQ(a < b, a.value < b.value);
      EXPECT_EQ(a > b, a.value > b.value);
      EXPECT_EQ(a <= b, a.value <= b.value);
      EXPECT_EQ(a >= b, a.value >= b.value);
    }
    EXPECT_FALSE(a < a);
    EXPECT_FALSE(a > a);
    EXPECT_TRUE(a <= a);
    EXPECT_TRUE(a >= a);
    EXPECT_EQ(value_of(a), a.value);
    EXPECT_EQ(value_of(a.value), a.value);
  }
}

// Where there is no derivative the rates are finite: those of a number that stays.
TEST(Dual, RatesAtKinksAreNumbers) {
  number zero(0.0);
  zero.rate = {1, -2, 3};
  const std::array<double, 3> none{};
  EXPECT_EQ(number(7.0).rate, none);
  EXPECT_EQ(number().value, 0.0);
  EXPECT_EQ(sqrt(zero).rate, none);
  EXPECT_EQ(sqrt(zero).value, 0.0);
  EXPECT_EQ(hypot(zero, zero).rate, none);
  EXPECT_EQ(hypot(zero, zero).value, 0.0);
  EXPECT_EQ(pow(zero, 0.5).rate, none);
  EXPECT_EQ(pow(zero, 0.5).value, 0.0);
  EXPECT_EQ(fabs(zero).rate, zero.rate);
}

}  // namespace
