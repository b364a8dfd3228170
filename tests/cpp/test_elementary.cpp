// The elementary functions: their errors beside long double's, their limits, and their very bits.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "numeric/elementary.hpp"

namespace {

using extended = long double;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int count = 20000;

// numbers that are the same everywhere (Steele, Lea and Flood 2014)
class numbers {
 public:
  uint64_t bits() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  // 2^low ... 2^high, as many in each octave
  double over_octaves(int low, int high) {
    const int n = low + static_cast<int>(bits() % static_cast<uint64_t>(high - low));
    return std::ldexp(within(1.0, 2.0), n);
  }

 private:
  uint64_t state_ = 1;
};

double unit_of(double v) {
  int exponent;
  std::frexp(v, &exponent);
  return std::ldexp(1.0, std::max(exponent - 53, -1074));
}

struct measured {
  double worst = 0, at = 0;
  uint64_t sum = 0xcbf29ce484222325u;  // of all bits (Fowler, Noll and Vo)

  void add(double x, double value, extended exact) {
    const auto truth = static_cast<double>(exact);
    const auto error = static_cast<double>(std::fabs(static_cast<extended>(value) - exact));
    if (error > worst * unit_of(truth)) worst = error / unit_of(truth), at = x;
    sum = (sum ^ std::bit_cast<uint64_t>(value)) * 0x100000001b3u;
  }
};

struct function {
  const char *name;
  double (*ours)(double);
  extended (*exact)(extended);
  double low, high;
  double bound;  // units in the last place
  uint64_t sum;
};

class elementary : public testing::TestWithParam<function> {};

TEST_P(elementary, errs_by_its_bound_and_has_its_bits) {
  const function &f = GetParam();
  numbers random;
  measured found;
  for (int i = 0; i < count; ++i) {
    const double x = random.within(f.low, f.high);
    found.add(x, f.ours(x), f.exact(x));
  }
  EXPECT_LT(found.worst, f.bound) << "at " << found.at;
  EXPECT_EQ(found.sum, f.sum) << std::hex << "0x" << found.sum << "u";
}

#define RAILPATCH_CASE(name, low, high, bound, sum)                                \
  function {                                                                       \
    #name, [](double x) { return railpatch::name(x); },                            \
        [](extended x) -> extended { return std::name(x); }, low, high, bound, sum \
  }
const function cases[] = {
    RAILPATCH_CASE(exp, -700, 700, 0.52, 0x951d1f6098283ae6u),
    RAILPATCH_CASE(exp, -1, 1, 0.52, 0xd282d46dd6972ebeu),
    RAILPATCH_CASE(exp2, -1000, 1000, 0.52, 0xa8fbb87586d9cf55u),
    RAILPATCH_CASE(exp2, -1, 0, 0.52, 0x3808b7dd842a43adu),
    RAILPATCH_CASE(expm1, -1, 1, 1.9, 0x6031039076184cfcu),
    RAILPATCH_CASE(expm1, -40, 60, 1.9, 0xe383ccaf321a967bu),
    RAILPATCH_CASE(log, 0.5, 2, 0.52, 0xf8c2cbc83c513fb4u),
    RAILPATCH_CASE(log, 0.99, 1.01, 0.52, 0xf6b82f80c20d6941u),
    RAILPATCH_CASE(log, 0, 1e4, 0.52, 0x7d0efb77747a8161u),
    RAILPATCH_CASE(cbrt, -8, 1, 0.51, 0x94eca5a1496ad6ddu),
    RAILPATCH_CASE(cbrt, 0, 1e12, 0.51, 0x1a79d6959fe627b3u),
    RAILPATCH_CASE(sin, -7, 7, 0.8, 0x49b5563bbe5188d9u),
    RAILPATCH_CASE(sin, -4e8, 4e8, 0.8, 0x76c5eff90ecd0638u),
    RAILPATCH_CASE(cos, -7, 7, 0.8, 0xbd05a10f00c62915u),
    RAILPATCH_CASE(cos, -4e8, 4e8, 0.8, 0x5a3de402db77c2efu),
    RAILPATCH_CASE(tan, -1.5, 1.5, 2.3, 0x461c098e83a4ac60u),
    RAILPATCH_CASE(asin, -1, 1, 0.52, 0xfd09448d71a79f3fu),
    RAILPATCH_CASE(acos, -1, 1, 0.52, 0xd465338114e1abfdu),
    RAILPATCH_CASE(atan, -1, 1, 0.52, 0x9540bb1a13921447u),
    RAILPATCH_CASE(atan, -50, 50, 0.52, 0xe89eea2c04a41336u),
    RAILPATCH_CASE(sinh, -3, 3, 2.5, 0x75b1a8436c71bfeau),
    RAILPATCH_CASE(sinh, -700, 700, 2.5, 0xda6c6a9afe3d8191u),
    RAILPATCH_CASE(cosh, -3, 3, 2.5, 0x2573e96f197d81e7u),
    RAILPATCH_CASE(cosh, -700, 700, 2.5, 0xcd9de58337f3b1fdu),
    RAILPATCH_CASE(asinh, -2, 2, 1.1, 0x541be39def71378au),
    RAILPATCH_CASE(asinh, -1e12, 1e12, 1.1, 0x564d5e2219442c54u),
    RAILPATCH_CASE(erfc, -3, 0.25, 4.5, 0x55d7f31574bc7e66u),
    RAILPATCH_CASE(erfc, 0.25, 5, 4.5, 0x39262ffbf1d30a47u),
    RAILPATCH_CASE(erfc, 5, 26, 4.5, 0x82549023b83795b9u),
};
INSTANTIATE_TEST_SUITE_P(functions, elementary, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<function> &at) {
                           return at.param.name + std::to_string(at.index);
                         });

TEST(elementary_pairs, err_by_their_bounds_and_have_their_bits) {
  numbers random;
  measured angle, length, power;
  for (int i = 0; i < count; ++i) {
    const double x = random.within(-3, 3), y = random.within(-3, 3) * random.over_octaves(-40, 4);
    angle.add(x, railpatch::atan2(y, x), std::atan2(extended{y}, extended{x}));
    length.add(x, railpatch::hypot(x, y), std::hypot(extended{x}, extended{y}));
    const double base = random.over_octaves(-20, 20), exponent = random.within(-3, 3);
    power.add(x, railpatch::pow(base, exponent), std::pow(extended{base}, extended{exponent}));
  }
  EXPECT_LT(angle.worst, 0.52);
  EXPECT_LT(length.worst, 1.2);
  EXPECT_LT(power.worst, 0.55);
  EXPECT_EQ(angle.sum, 0x6e65bfb0cabe4f0cu) << std::hex << "0x" << angle.sum << "u";
  EXPECT_EQ(length.sum, 0xb6b800306e02cae3u) << std::hex << "0x" << length.sum << "u";
  EXPECT_EQ(power.sum, 0x3251052924348344u) << std::hex << "0x" << power.sum << "u";
}

TEST(elementary_limits, over_all_magnitudes) {
  numbers random;
  measured log, root, angle, length;
  for (int i = 0; i < count; ++i) {
    const double x = random.over_octaves(-1074, 1023), y = random.over_octaves(-1074, 1023);
    log.add(x, railpatch::log(x), std::log(extended{x}));
    root.add(x, railpatch::cbrt(x), std::cbrt(extended{x}));
    angle.add(x, railpatch::atan2(y, x), std::atan2(extended{y}, extended{x}));
    length.add(x, railpatch::hypot(y, x), std::hypot(extended{y}, extended{x}));
  }
  EXPECT_LT(log.worst, 0.52);
  EXPECT_LT(root.worst, 0.51);
  // a share below the least number is rounded there
  EXPECT_LT(angle.worst, 1.01);
  EXPECT_LT(length.worst, 1.2);
}

void expect_same(double ours, double theirs, const char *what, double x, double y) {
  if (std::isnan(theirs)) {
    EXPECT_TRUE(std::isnan(ours)) << what << " " << x << " " << y << ": " << ours;
    return;
  }
  EXPECT_DOUBLE_EQ(ours, theirs) << what << " " << x << " " << y;
  EXPECT_EQ(std::signbit(ours), std::signbit(theirs)) << what << " " << x << " " << y;
}

TEST(elementary_limits, are_those_of_c) {
  const double ends[] = {0.0, -0.0, infinity, -infinity, not_a_number, 5e-324, -5e-324, 1e-310,
                         1.0, -1.0, 2.0,      -2.0,      0.5,          1e308,  -1e308,  3.0};
  for (const double x : ends) {
    expect_same(railpatch::exp(x), std::exp(x), "exp", x, 0);
    expect_same(railpatch::exp2(x), std::exp2(x), "exp2", x, 0);
    expect_same(railpatch::expm1(x), std::expm1(x), "expm1", x, 0);
    expect_same(railpatch::log(x), std::log(x), "log", x, 0);
    expect_same(railpatch::cbrt(x), std::cbrt(x), "cbrt", x, 0);
    expect_same(railpatch::asin(x), std::asin(x), "asin", x, 0);
    expect_same(railpatch::acos(x), std::acos(x), "acos", x, 0);
    expect_same(railpatch::atan(x), std::atan(x), "atan", x, 0);
    expect_same(railpatch::sinh(x), std::sinh(x), "sinh", x, 0);
    expect_same(railpatch::cosh(x), std::cosh(x), "cosh", x, 0);
    expect_same(railpatch::asinh(x), std::asinh(x), "asinh", x, 0);
    if (!std::isnan(x)) {
      EXPECT_NEAR(railpatch::erfc(x), std::erfc(x), 1e-15);
    }
    if (std::abs(x) < 1e300 || !std::isfinite(x)) {
      expect_same(railpatch::sin(x), std::sin(x), "sin", x, 0);
      expect_same(railpatch::cos(x), std::cos(x), "cos", x, 0);
    }
    for (const double y : ends) {
      expect_same(railpatch::atan2(x, y), std::atan2(x, y), "atan2", x, y);
      expect_same(railpatch::hypot(x, y), std::hypot(x, y), "hypot", x, y);
      expect_same(railpatch::pow(x, y), std::pow(x, y), "pow", x, y);
    }
  }
  EXPECT_EQ(railpatch::exp(0.0), 1.0);
  EXPECT_EQ(railpatch::cos(0.0), 1.0);
  EXPECT_EQ(railpatch::erfc(0.0), 1.0);
  EXPECT_EQ(railpatch::cbrt(27.0), 3.0);
  EXPECT_EQ(railpatch::pow(0.5, 3.0), 0.125);
  EXPECT_EQ(railpatch::atan2(1.0, 1.0), std::atan(1.0));
}

TEST(elementary_rows, asinh_of_many_is_that_of_each) {
  numbers random;
  // of no whole number of chunks, at ends of what is done at once, and what is not
  std::vector<double> values = {
      0.0, -0.0, infinity, -infinity, not_a_number, 5e-324,   1e308,       -1e-310,
      1.0, -1.0, 1e8,      0x1p-30,   -1e8,         -0x1p-30, 1.0000001e8, 0x1.0000000000001p-30};
  for (int i = 0; i < count; ++i) {
    const double x = random.over_octaves(-33, 30);
    values.push_back(random.bits() % 2 == 0 ? x : -x);
  }
  for (const size_t length : {values.size(), size_t{1}, size_t{63}, size_t{64}, size_t{65}}) {
    std::vector<double> found(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(length));
    railpatch::asinh_of(found.data(), static_cast<int>(length));
    for (size_t k = 0; k < length; ++k)
      EXPECT_EQ(std::bit_cast<uint64_t>(found[k]),
                std::bit_cast<uint64_t>(railpatch::asinh(values[k])))
          << values[k];
  }
}

TEST(elementary_limits, angles_beyond_all_measure_stay_sines) {
  numbers random;
  for (int i = 0; i < count; ++i) {
    const double x = random.over_octaves(28, 1023), s = railpatch::sin(x), c = railpatch::cos(x);
    EXPECT_NEAR(s * s + c * c, 1.0, 1e-15) << x;
    // of an angle that is known to half its last digit
    if (x < 1e15) {
      EXPECT_NEAR(s, static_cast<double>(std::sin(extended{x})), 0.5 * unit_of(x) + 1e-15);
    }
  }
}

}  // namespace
