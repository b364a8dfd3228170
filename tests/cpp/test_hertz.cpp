// Hertz contact by what it says: a semi-ellipsoidal pressure displaces the surfaces by the
// approach less the undeformed distance. The displacement is integrated along rays here, without
// elliptic integrals.
#include "normal/hertz.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "normal/hertz_ratios.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

constexpr double modulus = 1.15e11;
// sums of thousands of terms against closed forms
constexpr double rounded = 2e-13;

// Displacement at a point within the ellipse, 1/(pi E*) int p dr dangle. Along a line through the
// point p^2 is a quadratic function, whose root's integral is known; the rule is exact to rounding
// since the sum goes over a period.
double displacement(const hertz_contact &c, double x, double y) {
  const double a2 = c.semi_axes[0] * c.semi_axes[0], b2 = c.semi_axes[1] * c.semi_axes[1];
  const double ratio = std::max(a2 / b2, b2 / a2);
  const int n = 40 + static_cast<int>(20 * std::sqrt(ratio));
  double sum = 0, lost = 0;
  for (int k = 0; k < n; ++k) {
    const double angle = pi * k / n, cos = std::cos(angle), sin = std::sin(angle);
    const double alpha = 1 - x * x / a2 - y * y / b2, beta = x * cos / a2 + y * sin / b2;
    const double gamma = cos * cos / a2 + sin * sin / b2;
    const double term = (alpha + beta * beta / gamma) / std::sqrt(gamma) - lost;
    const double next = sum + term;
    lost = (next - sum) - term;
    sum = next;
  }
  return c.max_pressure / (pi * modulus) * (pi / 2) * sum * pi / n;
}

void expect_contact(const hertz_contact &c) {
  const double a = c.semi_axes[0], b = c.semi_axes[1];
  EXPECT_NEAR(c.normal_force, 2.0 / 3 * pi * a * b * c.max_pressure, rounded * c.normal_force);
  EXPECT_NEAR(displacement(c, 0, 0), c.approach, rounded * c.approach) << a / b;
  for (const auto &[u, v] : {std::pair{0.8, 0.0}, {0.0, 0.8}, {0.5, -0.6}}) {
    const double x = u * a, y = v * b;
    const double distance = c.curvatures[0] * x * x + c.curvatures[1] * y * y;
    // the ratio of curvatures is found to the last bits of ln(a/b)
    EXPECT_NEAR(displacement(c, x, y), c.approach - distance, 5e-13 * c.approach) << a / b;
  }
}

TEST(Hertz, PressureMakesTheDisplacement) {
  for (double ratio = 1.0 / 400; ratio < 420; ratio *= 1.31) {
    const double axes[2] = {4e-3 * std::sqrt(ratio), 4e-3 / std::sqrt(ratio)};
    const hertz_contact c = hertz_from_ellipse(axes, modulus, 7e4);
    EXPECT_EQ(c.semi_axes[0], axes[0]);
    EXPECT_EQ(c.semi_axes[1], axes[1]);
    EXPECT_EQ(c.normal_force, 7e4);
    expect_contact(c);
    const hertz_contact pressed = hertz_ellipse_from_approach(axes, modulus, c.approach);
    EXPECT_NEAR(pressed.normal_force, 7e4, rounded * 7e4);
    expect_contact(pressed);

    const hertz_contact loaded = hertz_from_force(c.curvatures, modulus, 7e4);
    EXPECT_EQ(loaded.curvatures[0], c.curvatures[0]);
    EXPECT_EQ(loaded.curvatures[1], c.curvatures[1]);
    EXPECT_EQ(loaded.normal_force, 7e4);
    expect_contact(loaded);
    const hertz_contact near = hertz_from_approach(c.curvatures, modulus, c.approach);
    EXPECT_NEAR(near.approach, c.approach, rounded * c.approach);
    expect_contact(near);
    for (const hertz_contact &found : {loaded, near})
      for (int k : {0, 1})
        EXPECT_NEAR(found.semi_axes[k], axes[k], 5e-13 * axes[k]) << ratio << " " << k;
  }
}

// Curvatures whose ratio is beyond all rails still have an ellipse.
TEST(Hertz, SlenderEllipses) {
  for (double ratio : {1e-12, 1e-8, 1e8, 1e12}) {
    const double curvatures[2] = {0.5 * ratio, 0.5};
    const hertz_contact c = hertz_from_force(curvatures, modulus, 1e3);
    const hertz_contact back = hertz_from_ellipse(c.semi_axes, modulus, 1e3);
    for (int k : {0, 1}) EXPECT_NEAR(back.curvatures[k], curvatures[k], 1e-11 * curvatures[k]);
  }
}

TEST(Hertz, Line) {
  // Johnson (1985), section 4.2
  const double radius = 0.45, width = 7e-3, force = 6e4,
               a = std::sqrt(4 * force / width * radius / (pi * modulus));
  const hertz_contact c = hertz_line(radius, width, modulus, force);
  EXPECT_NEAR(c.semi_axes[0], a, 1e-14 * a);
  EXPECT_EQ(c.semi_axes[1], 0);
  EXPECT_EQ(c.approach, 0);
  EXPECT_EQ(c.normal_force, force);
  EXPECT_NEAR(c.curvatures[0], 1 / (2 * radius), 1e-14);
  EXPECT_EQ(c.curvatures[1], 0);
  EXPECT_NEAR(c.max_pressure, 2 * force / width / (pi * a), 1e-14 * c.max_pressure);
  EXPECT_EQ(inside_ellipse(c.semi_axes, 0.5 * c.semi_axes[0], 1.0), 0.75);
}

TEST(Hertz, InsideAndOutside) {
  const double axes[2] = {2.0, 4.0};
  EXPECT_EQ(inside_ellipse(axes, 0, 0), 1);
  EXPECT_EQ(inside_ellipse(axes, 1, 0), 0.75);
  EXPECT_EQ(inside_ellipse(axes, 0, 1), 0.9375);
  EXPECT_EQ(inside_ellipse(axes, -1, -2), 0.5);
  EXPECT_EQ(inside_ellipse(axes, 2, 4), -1);
}

// --- rates -----------------------------------------------------------------------------------

// Difference quotient of fourth order of everything.
template <class F>
hertz_contact slope(F &&f) {
  const double h = 1e-3;
  const hertz_contact p1 = f(h), m1 = f(-h), p2 = f(2 * h), m2 = f(-2 * h);
  const auto rate = [&](auto &&get) {
    return (8 * (get(p1) - get(m1)) - (get(p2) - get(m2))) / (12 * h);
  };
  hertz_contact r;
  for (int k : {0, 1}) {
    r.semi_axes[k] = rate([k](const hertz_contact &c) { return c.semi_axes[k]; });
    r.curvatures[k] = rate([k](const hertz_contact &c) { return c.curvatures[k]; });
  }
  r.normal_force = rate([](const hertz_contact &c) { return c.normal_force; });
  r.approach = rate([](const hertz_contact &c) { return c.approach; });
  r.max_pressure = rate([](const hertz_contact &c) { return c.max_pressure; });
  return r;
}

void expect_rates(const hertz_contact &found, const hertz_contact &wanted,
                  const hertz_contact &at) {
  // of the difference quotient: fourth power of the step; rounding over the step
  constexpr double error = 3e-10;
  for (int k : {0, 1}) {
    EXPECT_NEAR(found.semi_axes[k], wanted.semi_axes[k], error * at.semi_axes[k]) << k;
    EXPECT_NEAR(found.curvatures[k], wanted.curvatures[k], error * at.curvatures[k]) << k;
  }
  EXPECT_NEAR(found.normal_force, wanted.normal_force, error * at.normal_force);
  EXPECT_NEAR(found.approach, wanted.approach, error * at.approach);
  EXPECT_NEAR(found.max_pressure, wanted.max_pressure, error * at.max_pressure);
}

// The shape is without a load: what is kept of it gives each load's ellipse to the bit.
TEST(Hertz, OfAShapeThatIsKept) {
  for (double ratio : {1e-3, 0.4, 1.0, 7.0}) {
    const double curvatures[2] = {ratio, 0.8};
    const hertz_shape shape = hertz_shape_of(curvatures);
    EXPECT_NEAR(shape.a * shape.b, 1.0, 1e-15);
    for (double size : {0.3, 1.0, 40.0}) {
      const hertz_contact pairs[2][2] = {{hertz_from_force(shape, modulus, 1e3 * size),
                                          hertz_from_force(curvatures, modulus, 1e3 * size)},
                                         {hertz_from_approach(shape, modulus, 1e-5 * size),
                                          hertz_from_approach(curvatures, modulus, 1e-5 * size)}};
      for (const auto &[kept, found] : pairs) {
        for (int k = 0; k < 2; ++k) EXPECT_EQ(kept.semi_axes[k], found.semi_axes[k]);
        EXPECT_EQ(kept.normal_force, found.normal_force);
        EXPECT_EQ(kept.approach, found.approach);
        EXPECT_EQ(kept.max_pressure, found.max_pressure);
      }
    }
  }
}

TEST(Hertz, RatesAreThoseOfTheSolution) {
  // nearly circular ones too: (a^2 - b^2)/(a^2 + b^2) on both sides of 1e-3
  for (double ratio : {0.07, 0.6, 0.9989, 0.9991, 1.0, 1.0004, 1.00099, 1.00101, 1.7, 21.0}) {
    SCOPED_TRACE(ratio);
    const double axes[2] = {4e-3 * std::sqrt(ratio), 4e-3 / std::sqrt(ratio)};
    const hertz_contact c = hertz_from_ellipse(axes, modulus, 7e4);
    for (const auto &[d0, d1, d2] :
         {std::array{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {0.4, -0.7, 0.6}}) {
      const auto curved = [&, d0 = d0, d1 = d1](double t, double k[2]) {
        k[0] = c.curvatures[0] * (1 + d0 * t);
        k[1] = c.curvatures[1] * (1 + d1 * t);
      };
      const double k[2] = {c.curvatures[0] * d0, c.curvatures[1] * d1};
      const double force = c.normal_force, approach = c.approach;
      const hertz_contact by_force = slope([&, d2 = d2](double t) {
        double at[2];
        curved(t, at);
        return hertz_from_force(at, modulus, force * (1 + d2 * t));
      });
      expect_rates(hertz_rate_of_force(c, k, force * d2), by_force, c);
      const hertz_contact by_approach = slope([&, d2 = d2](double t) {
        double at[2];
        curved(t, at);
        return hertz_from_approach(at, modulus, approach * (1 + d2 * t));
      });
      expect_rates(hertz_rate_of_approach(c, k, approach * d2), by_approach, c);
    }
    const double force = c.normal_force;
    expect_rates(hertz_rate_of_ellipse(c, 0.7 * force), slope([&](double t) {
                   return hertz_from_ellipse(axes, modulus, force * (1 + 0.7 * t));
                 }),
                 c);
  }
  const hertz_contact line = hertz_line(0.45, 7e-3, modulus, 6e4);
  expect_rates(
      hertz_rate_of_line(line, 0.7 * 6e4),
      slope([&](double t) { return hertz_line(0.45, 7e-3, modulus, 6e4 * (1 + 0.7 * t)); }), line);
}

// --- the table of ratios ---------------------------------------------------------------------

TEST(HertzRatios, EndsAreTheNearestValues) {
  const hertz_ratios table;
  const auto same = [](const hertz_ratios::values &a, const hertz_ratios::values &b) {
    EXPECT_NEAR(a.edge_along, b.edge_along, 1e-12 * b.edge_along);
    EXPECT_NEAR(a.edge_across, b.edge_across, 1e-12 * b.edge_across);
    EXPECT_NEAR(a.pressure, b.pressure, 1e-12 * b.pressure);
  };
  same(table.at(1e9, 1), table.at(1e6, 1));
  same(table.at(1, 1e9), table.at(1, 1e6));
  same(table.at(1, 0), table.at(1e6, 1));
  same(table.at(std::numeric_limits<double>::quiet_NaN(), 1), table.at(1, 1e6));
  EXPECT_GE(table.bytes(), 2 * sizeof(double) * 501);
  // what is exchanged, and what goes with size
  const hertz_ratios::values one = table.at(3.0, 0.2), other = table.at(0.2, 3.0);
  EXPECT_NEAR(one.edge_along, other.edge_across, 1e-14 * one.edge_along);
  EXPECT_NEAR(one.edge_across, other.edge_along, 1e-14 * one.edge_across);
  same(table.at(3e3, 0.2e3), one);
}

}  // namespace
