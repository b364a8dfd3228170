// Shares of the patches of a wheel: every part of contact counts once, and nothing jumps.
#include "geometry/patch_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace railpatch;

constexpr double rounding = 1e-14;

part part_of(double begin, double end, double angle = 0) {
  part p;
  p.first = {0, begin, 0};
  p.last = {0, end, 0};
  p.angle = angle;
  return p;
}

double join_of(double width, double distance, double angle = 0, double bump = 0) {
  part before = part_of(-0.005, 0);
  before.bump = bump;
  return joined(blend_rules{}, before, part_of(distance, distance + width, angle));
}

// A number with its derivative, as little as the templates need.
struct dual {
  double v = 0, d = 0;
  dual() = default;
  dual(double value) : v(value) {}
  dual(double value, double slope) : v(value), d(slope) {}
  dual &operator+=(const dual &b) { return *this = {v + b.v, d + b.d}; }
  dual &operator*=(const dual &b) { return *this = {v * b.v, d * b.v + v * b.d}; }
  dual &operator/=(const dual &b) { return *this = {v / b.v, (d - v / b.v * b.d) / b.v}; }
};
dual operator+(dual a, const dual &b) { return a += b; }
dual operator-(const dual &a) { return {-a.v, -a.d}; }
dual operator-(const dual &a, const dual &b) { return {a.v - b.v, a.d - b.d}; }
dual operator*(dual a, const dual &b) { return a *= b; }
dual operator/(dual a, const dual &b) { return a /= b; }
bool operator<(const dual &a, const dual &b) { return a.v < b.v; }
bool operator>(const dual &a, const dual &b) { return a.v > b.v; }
dual sqrt(const dual &a) { return {std::sqrt(a.v), 0.5 * a.d / std::sqrt(a.v)}; }
dual fabs(const dual &a) { return a.v < 0 ? -a : a; }
dual hypot(const dual &a, const dual &b) { return sqrt(a * a + b * b); }
dual cos(const dual &a) { return {std::cos(a.v), -std::sin(a.v) * a.d}; }
dual sin(const dual &a) { return {std::sin(a.v), std::cos(a.v) * a.d}; }

// A locus with a parabolic gap of depth and half-width about the middle.
template <class T>
struct bowl {
  struct point {
    bool valid;
    T gap, contact_angle, curvature;
    std::array<T, 3> wheel, normal;
  };
  T depth, half, middle;

  point operator()(const T &s) const {
    const T t = (s - middle) / half;
    return {true, depth * (t * t - 1.0), 0.1 * s, T(1.1), {0.02 * s, s, T(0)}, {T(0), T(0), T(1)}};
  }
};

TEST(PatchParts, EveryPartCountsOnce) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 1 + trial % max_parts;
    double join[max_parts];
    // ends of the range too: then most intervals have no share
    for (double &j : join) j = std::round(any(random) * 3) / 3;
    if (trial % 2) join[0] = any(random);
    for (int k = 0; k < count; ++k) {
      double sum = 0;
      for (int begin = 0; begin <= k; ++begin)
        for (int end = k + 1; end <= count; ++end) {
          const double share = interval_share(join, count, begin, end);
          EXPECT_GE(share, 0);
          sum += share;
        }
      EXPECT_NEAR(sum, 1, rounding) << "seed 7, trial " << trial << ", part " << k;
    }
  }
}

TEST(PatchParts, FadeHasTwoContinuousDerivatives) {
  EXPECT_EQ(fade(-1.0), 1);
  EXPECT_EQ(fade(0.0), 1);
  EXPECT_EQ(fade(1.0), 0);
  EXPECT_EQ(fade(2.0), 0);
  for (double t = 0.01; t < 1; t += 0.01) {
    EXPECT_NEAR(fade(t) + fade(1 - t), 1, rounding);
    EXPECT_GT(fade(t - 0.01), fade(t));
  }
  // the quintic leaves its ends with 10 t^3: slope and bend are zero there
  for (double t : {1e-2, 1e-3}) EXPECT_NEAR((1 - fade(t)) / (t * t * t), 10, 15.1 * t);
}

TEST(PatchParts, APartIsBornOnItsOwnAndSplitsAsOne) {
  for (double d : {1e-6, 1e-4, 0.9e-2}) {
    EXPECT_EQ(join_of(0, d), 0) << d;
    // it joins with the third power of its width
    const double share = 1e-3 / blend_rules{}.grown;
    EXPECT_LT(join_of(1e-3 * d, d), 10 * share * share * share) << d;
  }
  for (double w : {1e-6, 1e-4, 1e-2})
    for (double angle : {0.0, 0.5, 1.2, 2.0}) EXPECT_EQ(join_of(w, 0, angle), 1) << w;
  EXPECT_EQ(join_of(5e-3, 8e-3, 0, 2.4e-5), 1);
  EXPECT_EQ(join_of(5e-3, 8e-3, 0, 7.6e-5), 0);
  EXPECT_EQ(join_of(5e-3, 8e-3, 1.6, 2.4e-5), 0);
  EXPECT_EQ(join_of(5e-3, 16.1e-3), 0);
}

// no change greater than the steepest slope of the fade explains
TEST(PatchParts, JoinedFollowsGapWidthDistanceAndAngle) {
  const blend_rules rule;
  constexpr double steepest = 1.01 * 1.875, step = 1e-7;
  const auto change = [](double a, double b) { return std::fabs(a - b); };
  for (double bump = 0; bump < 1e-4; bump += 1.3e-6) {
    const double here = join_of(4e-3, 8e-3, 0, bump);
    EXPECT_LE(change(join_of(4e-3, 8e-3, 0, bump + step), here),
              steepest * step / (rule.high - rule.low));
    for (double angle = 0.9; angle < 1.7; angle += 0.01)
      EXPECT_LE(change(join_of(4e-3, 8e-3, angle + step, bump), join_of(4e-3, 8e-3, angle, bump)),
                100 * step);
  }
  for (double d = 1e-4; d < 14e-3; d += 9.7e-5)
    for (double w = 1e-5; w < 3e-3; w += 7e-5) {
      EXPECT_LE(change(join_of(w + step, d), join_of(w, d)), steepest * step / (rule.grown * d));
      EXPECT_LE(change(join_of(w, d + step), join_of(w, d)),
                steepest * step * (1 / d + 1 / (rule.two - rule.one)));
    }
}

TEST(PatchParts, NeighboursInteractAsInTheProgramContact) {
  const auto at = [](double d) {
    return interaction(blend_rules{}, part_of(-0.005, 0), part_of(d, d + 0.005));
  };
  EXPECT_EQ(at(3.9e-3), 1);
  EXPECT_NEAR(at(6e-3), std::pow(0.5, 0.8), rounding);
  EXPECT_EQ(at(8.1e-3), 0);
}

// with the symmetric gap of a bowl the means lie in its middle, and its width is known
TEST(PatchParts, SumsOfASymmetricPart) {
  const bowl<double> gap{2e-5, 3e-3, 0.7};
  part p;
  p.begin = gap.middle - gap.half;
  p.end = gap.middle + gap.half;
  sum_rows(gap, p);
  EXPECT_NEAR(p.y, 0.7, 1e-12);
  EXPECT_NEAR(p.angle, 0.07, 1e-12);
  EXPECT_NEAR(lateral_width(p), 6e-3, 1e-12);
  // integral of (1 - t^2)^2.5 over -1 ... 1 is 5 pi/16
  const double closed = 5 * std::numbers::pi / 16 * 3e-3 * std::pow(2e-5, 2.5) / std::sqrt(1.1);
  EXPECT_NEAR(p.weight / closed, 1, 2e-3);
}

// the templates with numbers that carry derivatives, against central differences
TEST(PatchParts, DerivativesByForwardNumbers) {
  const auto share_and_place = []<class T>(const T &u, T *out) {
    basic_part<T> parts[2];
    const T depth[2] = {T(2e-5) + 1e-6 * u, T(8e-6) + 2e-6 * u};
    const T middle[2] = {T(0.70), T(0.7105) + 1e-4 * u};
    for (int k = 0; k < 2; ++k) {
      using std::sqrt;
      const T half = sqrt(depth[k] / 3.0);
      parts[k].begin = middle[k] - half;
      parts[k].end = middle[k] + half;
      sum_rows(bowl<T>{depth[k], half, middle[k]}, parts[k]);
    }
    parts[0].bump = T(4e-5) + 2e-6 * u;
    const T join = joined(blend_rules{}, parts[0], parts[1]);
    const basic_interval<T> both = sum_parts(parts, 0, 2);
    const std::array<T, 3> origin{both.x, both.y, T(0)};
    const basic_bounds<T> bounds = bounds_of(parts, both, origin, both.angle);
    const T values[] = {interval_share(&join, 2, 0, 2),
                        both.y,
                        both.angle,
                        bounds.s_min,
                        bounds.s_max,
                        bounds.x_max};
    std::copy_n(values, 6, out);
  };
  constexpr double h = 1e-4;
  double low[6], high[6];
  dual found[6];
  share_and_place(-h, low);
  share_and_place(h, high);
  share_and_place(dual(0, 1), found);
  EXPECT_GT(found[0].v, 0.1);
  EXPECT_LT(found[0].v, 0.9);
  for (int k = 0; k < 6; ++k) {
    const double slope = (high[k] - low[k]) / (2 * h);
    EXPECT_NEAR(found[k].d, slope, 1e-6 * std::fabs(slope)) << k;
  }
}

}  // namespace
