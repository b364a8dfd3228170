// Laws of friction and of yield, and factors along a profile, against what their definitions say,
// by formulas, dense samples and searches of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tangential/bound_law.hpp"
#include "tangential/friction_factor.hpp"

namespace {

using namespace railpatch;

// --- friction over slip velocity -----------------------------------------------------------------

double shape(rp_slip_law kind, double u) {
  if (kind == RP_SLIP_EXPONENTIAL) return std::pow(2.0, -u);
  if (kind == RP_SLIP_RATIONAL) return 1 / (1 + u);
  return std::max(0.0, 1 - u / 2);
}

constexpr rp_slip_law shapes[] = {RP_SLIP_EXPONENTIAL, RP_SLIP_RATIONAL, RP_SLIP_LINEAR};

TEST(SlipVelocity, CoefficientIsTheSumOfBothParts) {
  for (auto kind : shapes)
    for (const auto &[first, second] :
         {std::pair{0.2, 0.1}, {0.2, 0.0}, {0.0, -0.1}, {-0.1, 0.3}, {0.0, 0.0}}) {
      slip_velocity_law law;
      law.shape = kind;
      law.kinetic = 0.15;
      law.amplitude[0] = first, law.amplitude[1] = second;
      law.halving_speed[0] = 0.5, law.halving_speed[1] = 3.0;
      double most = 0;
      for (double speed = 0; speed < 12; speed += 0.03) {
        double slope, aside;
        const double mu = law.coefficient(speed, slope);
        EXPECT_NEAR(mu, 0.15 + first * shape(kind, speed / 0.5) + second * shape(kind, speed / 3.0),
                    1e-15);
        const double h = 1e-7, there = law.coefficient(speed + h, aside),
                     back = law.coefficient(speed - h, aside);
        // a kink of the linear law between both
        if (kind == RP_SLIP_LINEAR && (std::abs(speed - 1) < 2 * h || std::abs(speed - 6) < 2 * h))
          continue;
        EXPECT_NEAR(slope, (there - back) / (2 * h), 1e-7);
        most = std::max(most, mu);
      }
      double slope;
      EXPECT_NEAR(law.standing(), law.coefficient(0, slope), 1e-15);
      EXPECT_GE(law.greatest() + 1e-15, most);
      // no part in the bound that is not there
      EXPECT_NEAR(law.greatest(), 0.15 + std::max(first, 0.0) + std::max(second, 0.0), 1e-15);
      for (double rate : {0.3, 2.0}) {
        double steepest = 0;
        for (double length = 0; length < 12 / rate; length += 1e-3)
          law.coefficient(length * rate, slope), steepest = std::max(steepest, -slope * rate);
        EXPECT_GE(law.steepest_fall(rate), steepest * (1 - 1e-12));
        // and where both parts fall, it is steepest at rest
        if (first >= 0 && second >= 0) {
          EXPECT_NEAR(law.steepest_fall(rate), steepest, 1e-12);
        }
      }
    }
}

// With memory: the recurrence of the coefficient as it is written down, over some steps.
TEST(SlipVelocity, MemoryFollowsItsRecurrence) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 300; ++i) {
    bound_law law;
    law.by_velocity = true;
    law.step = 1e-3 * (0.5 + unit(random));
    law.speed = 20 * unit(random);
    law.slip.shape = shapes[i % 3];
    law.slip.kinetic = 0.2;
    law.slip.amplitude[0] = 0.2 * unit(random), law.slip.amplitude[1] = 0.2 * unit(random) - 0.1;
    law.slip.halving_speed[0] = 0.1 + unit(random), law.slip.halving_speed[1] = 2;
    law.slip.memory_distance = i % 4 == 0 ? 0.0 : 1e-4 * unit(random);
    law.slip.memory_speed = 0.1 * unit(random);
    const double normal = 1e9 * unit(random), e[2] = {0.6, -0.8};
    carried_state carried{};
    double mu = law.slip.standing();
    double greatest = 0;
    for (int k = 0; k < 6; ++k) {
      const double m = k == 2 ? 0 : 1e-4 * unit(random);
      const double speed = law.speed * m / law.step;
      double slope;
      const double now = law.slip.coefficient(speed, slope);
      const double way = std::max(speed, law.slip.memory_speed) * law.step / law.speed;
      const double d = law.slip.memory_distance;
      mu = d > 0 ? (d * mu + way * now) / (d + way) : now;
      const bound_point b = law.evaluate(normal, carried, e, m);
      EXPECT_NEAR(b.bound, normal * mu, 1e-12 * normal) << i;
      EXPECT_EQ(b.bound, b.friction);
      EXPECT_EQ(b.plastic, 0.0);
      EXPECT_EQ(b.yield_stress, HUGE_VAL);
      greatest = std::max(greatest, b.bound);
      // never steeper than what is said
      EXPECT_GE(b.by_slip, -law.steepest_fall(normal) * (1 + 1e-12));
      carried = b.state;
      EXPECT_NEAR(carried.v[0], mu - law.slip.standing(), 1e-14);
      EXPECT_NEAR(law.at_rest(normal, carried), law.evaluate(normal, carried, e, 0).bound,
                  1e-14 * normal);
    }
    EXPECT_LE(greatest, law.greatest(normal) * (1 + 1e-12));
  }
}

TEST(SlipVelocity, WithoutSpeedNothingIsForgotten) {
  bound_law law;
  law.by_velocity = true;
  law.slip.kinetic = 0.2;
  law.slip.amplitude[0] = 0.1;
  law.slip.memory_distance = 1e-4;
  const carried_state before{{-0.04, 0, 0}};
  const double e[2] = {1, 0};
  const bound_point b = law.evaluate(2.0, before, e, 1e-3);
  EXPECT_NEAR(b.bound, 2.0 * (0.3 - 0.04), 1e-15);
  EXPECT_EQ(b.by_slip, 0.0);
  EXPECT_EQ(b.by_state[0], 2.0);
  EXPECT_EQ(b.state.v[0], -0.04);
  EXPECT_EQ(b.state_by_state[0][0], 1.0);
}

// --- yield stress --------------------------------------------------------------------------------

hardening_curve drawn_curve(std::mt19937_64 &random) {
  std::uniform_real_distribution<double> unit(0, 1);
  hardening_curve c;
  c.points = 1 + static_cast<int>(random() % 5);
  for (int i = 0; i < c.points; ++i) {
    c.displacement[i] = i == 0 ? 0 : c.displacement[i - 1] + 0.1 + unit(random);
    c.stress[i] = 0.2 + unit(random);
  }
  c.last_slope = random() % 2 ? unit(random) : 0;
  return c;
}

double stress_of(const hardening_curve &c, double u) {
  const int last = c.points - 1;
  if (u >= c.displacement[last]) return c.stress[last] + c.last_slope * (u - c.displacement[last]);
  int i = 0;
  while (u >= c.displacement[i + 1]) ++i;
  const double share = (u - c.displacement[i]) / (c.displacement[i + 1] - c.displacement[i]);
  return (1 - share) * c.stress[i] + share * c.stress[i + 1];
}

TEST(Hardening, IsStraightBetweenPoints) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    const hardening_curve c = drawn_curve(random);
    double most = 0, steepest = 0, slope, aside;
    for (double u = 0; u < 7; u += 0.01) {
      EXPECT_NEAR(c.at(u, slope), stress_of(c, u), 1e-13);
      steepest = std::max(steepest, std::abs(slope));
      most = std::max(most, stress_of(c, u));
      const double h = 1e-7, after = (c.at(u + h, aside) - stress_of(c, u)) / h;
      EXPECT_NEAR(slope, after, 1e-6) << u;
    }
    for (int k = 0; k < c.points; ++k) {
      EXPECT_NEAR(c.at(c.displacement[k], slope), c.stress[k], 1e-14);
      most = std::max(most, c.stress[k]);
    }
    EXPECT_NEAR(c.steepest(), steepest, 1e-13);
    if (c.last_slope > 0) {
      EXPECT_EQ(c.greatest(), HUGE_VAL);
    } else {
      EXPECT_NEAR(c.greatest(), most, 1e-14);
    }
  }
}

// The first crossing of a level by a dense walk up and down, then halved.
TEST(Hardening, LevelsAreFoundOnEitherSide) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr double step = 1e-3;
  int there = 0, nowhere = 0;
  for (int i = 0; i < 300; ++i) {
    const hardening_curve c = drawn_curve(random);
    const double from = 3 * unit(random), level = 0.2 + 1.2 * unit(random);
    const auto walk = [&](double sign, double end) {
      double at = from;
      const bool above = stress_of(c, from) > level;
      while (sign * (end - at) > 0) {
        double next = at + sign * step;
        if (sign < 0) next = std::max(next, end);
        if ((stress_of(c, next) > level) != above) {
          for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (at + next);
            ((stress_of(c, middle) > level) == above ? at : next) = middle;
          }
          return 0.5 * (at + next);
        }
        at = next;
      }
      return sign * HUGE_VAL;
    };
    const double up = walk(1, 12), down = walk(-1, 0);
    const double found = c.next_above(from, level), below = c.next_below(from, level);
    if (std::isfinite(up)) {
      EXPECT_NEAR(found, up, 1e-10) << i;
      ++there;
    } else {
      EXPECT_GT(found, 12.0) << i;
      ++nowhere;
    }
    if (std::isfinite(down)) {
      EXPECT_NEAR(below, down, 1e-10) << i;
    } else {
      EXPECT_LT(below, 0.0) << i;
    }
  }
  EXPECT_GT(there, 50);
  EXPECT_GT(nowhere, 50);
}

// A level that the curve has at a point only, and where it stays on it.
TEST(Hardening, LevelsAtPoints) {
  hardening_curve c;
  c.points = 4;
  const double u[] = {0, 1, 2, 3}, stress[] = {1, 2, 2, 1};
  std::copy(u, u + 4, c.displacement);
  std::copy(stress, stress + 4, c.stress);
  EXPECT_EQ(c.next_above(0, 2), 1.0);
  EXPECT_EQ(c.next_above(0.5, 1.5), 2.5);
  EXPECT_EQ(c.next_above(0.25, 1.5), 0.5);
  EXPECT_EQ(c.next_above(2.5, 1), 3.0);
  EXPECT_EQ(c.next_above(0, 3), HUGE_VAL);
  EXPECT_EQ(c.next_below(3, 1.5), 2.5);
  EXPECT_EQ(c.next_below(2.25, 1.5), 0.5);
  EXPECT_EQ(c.next_below(0.25, 1.5), -1.0);
  EXPECT_EQ(c.next_below(0.25, 1), 0.0);
}

TEST(Hardening, StraightDoesNotFallBelowATenth) {
  double slope;
  const hardening_curve soft = hardening_curve::straight(2.0, -0.5);
  for (double u = 0; u < 8; u += 0.1)
    EXPECT_NEAR(soft.at(u, slope), std::max(2.0 - 0.5 * u, 0.2), 1e-14);
  EXPECT_EQ(soft.greatest(), 2.0);
  EXPECT_NEAR(soft.steepest(), 0.5, 1e-15);
  for (double hardening : {0.0, 0.7}) {
    const hardening_curve hard = hardening_curve::straight(2.0, hardening);
    for (double u = 0; u < 8; u += 0.1) EXPECT_NEAR(hard.at(u, slope), 2.0 + hardening * u, 1e-14);
    EXPECT_EQ(hard.greatest(), hardening > 0 ? HUGE_VAL : 2.0);
    EXPECT_EQ(hard.steepest(), hardening);
  }
}

// --- both together -------------------------------------------------------------------------------

// Coulomb friction on a yielding layer: the recurrence of the plastic displacement as written down,
// by length of the path or by length of the vector sum.
TEST(Yield, FollowsItsRecurrence) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  int both = 0;
  for (int i = 0; i < 400; ++i) {
    bound_law law;
    law.by_magnitude = i % 2;
    law.yield = drawn_curve(random);
    const double friction = 0.4 + unit(random);
    carried_state carried{};
    for (int k = 0; k < 5; ++k) {
      const double angle = 6.28 * unit(random), m = 0.8 * unit(random);
      const double e[2] = {std::cos(angle), std::sin(angle)};
      const auto after = [&](double part) {
        return law.by_magnitude ? std::hypot(carried.v[1] + part * e[0], carried.v[2] + part * e[1])
                                : carried.v[1] + part;
      };
      // plastic as long as the layer carries less than friction does, finely walked
      double plastic = 0;
      constexpr int steps = 4000;
      while (plastic < m && stress_of(law.yield, after(plastic)) < friction) plastic += m / steps;
      plastic = std::min(plastic, m);
      const bound_point b = law.evaluate(friction, carried, e, m);
      // a peak of the curve that just touches friction may lie between two steps
      double most = 0;
      for (int s = 0; s <= steps; ++s)
        most = std::max(most, stress_of(law.yield, after(m * s / steps)));
      if (std::abs(most - friction) > 1e-2) {
        EXPECT_NEAR(b.plastic, plastic, 1.01 * m / steps) << i << " " << k;
      }
      EXPECT_NEAR(
          b.bound,
          b.plastic < m ? friction : std::min(friction, stress_of(law.yield, after(b.plastic))),
          1e-12)
          << i;
      EXPECT_NEAR(law.at_rest(friction, carried),
                  std::min(friction, stress_of(law.yield, after(0))), 1e-13);
      both += b.plastic > 0 && b.plastic < m;
      const double moved[2] = {b.plastic * (law.by_magnitude ? e[0] : 1.0),
                               law.by_magnitude ? b.plastic * e[1] : 0.0};
      EXPECT_NEAR(b.state.v[1], carried.v[1] + moved[0], 1e-15);
      EXPECT_NEAR(b.state.v[2], carried.v[2] + moved[1], 1e-15);
      EXPECT_LE(b.bound, law.greatest(friction));
      carried = b.state;
    }
  }
  EXPECT_GT(both, 50);
}

// More than one solution of size - stiffness m = b(m), counted on samples of another spacing.
TEST(Bounds, AreAmbiguousWhereMoreThanOneSlipSolvesThem) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const double e[2] = {1, 0};
  std::array<int, 2> seen{};
  for (int i = 0; i < 400; ++i) {
    bound_law law;
    law.speed = 1;
    if (i % 2) {
      law.by_velocity = true;
      law.slip.kinetic = 0.1 + 0.3 * unit(random);
      law.slip.amplitude[0] = 0.5 * unit(random);
      law.slip.halving_speed[0] = 0.1;
    } else {
      law.yield = hardening_curve::straight(0.5 + 0.5 * unit(random), -unit(random));
    }
    const carried_state before{};
    const double rest = law.at_rest(1.0, before), size = rest * (0.7 + 0.6 * unit(random));
    const double stiffness = law.steepest_fall(1.0) * (0.1 + 1.2 * unit(random)) + 1e-3;
    constexpr int samples = 20000;
    int crossings = size <= rest ? 1 : 0;
    bool above = size > rest;
    double nearest = 1;
    for (int k = 1; k <= samples; ++k) {
      const double m = size / stiffness * k / samples;
      const double gap = size - stiffness * m - law.evaluate(1.0, before, e, m).bound;
      if (k > 20) nearest = std::min(nearest, std::abs(gap) / size);
      crossings += (gap > 0) != above;
      above = gap > 0;
    }
    // two solutions so near each other that samples miss them: not for counting
    const bool ambiguous = law.ambiguous(1.0, before, e, size, stiffness);
    if (crossings > 1 && !ambiguous) continue;
    EXPECT_EQ(ambiguous, crossings > 1) << i << " " << nearest;
    ++seen[ambiguous];
  }
  EXPECT_GT(seen[0], 100);
  EXPECT_GT(seen[1], 50);
}

// --- factors along a profile ---------------------------------------------------------------------

TEST(FrictionFactor, IsStraightBetweenItsPoints) {
  std::array<double, RP_MAX_POINTS> place{}, factor{};
  const double places[] = {-0.03, -0.01, 0.0, 0.02}, factors[] = {0.5, 1.5, 1.0, 0.8};
  std::copy(places, places + 4, place.begin());
  std::copy(factors, factors + 4, factor.begin());
  const friction_factor f(4, place.data(), factor.data());
  EXPECT_TRUE(f.varies());
  EXPECT_FALSE(friction_factor().varies());
  EXPECT_FALSE(friction_factor(0, place.data(), factor.data()).varies());
  for (int k = 0; k < 4; ++k) EXPECT_EQ(f.at(places[k]), factors[k]);
  for (double x : {-1.0, -0.031}) {
    EXPECT_EQ(f.at(x), 0.5);
    EXPECT_EQ(f.slope(x), 0.0);
  }
  for (double x : {0.02, 0.021, 1.0}) {
    EXPECT_EQ(f.at(x), 0.8);
    EXPECT_EQ(f.slope(x), 0.0);
  }
  for (int k = 0; k < 3; ++k)
    for (double share : {0.0, 0.25, 0.9}) {
      const double width = places[k + 1] - places[k];
      EXPECT_NEAR(f.at(places[k] + share * width),
                  (1 - share) * factors[k] + share * factors[k + 1], 1e-14);
      EXPECT_NEAR(f.slope(places[k] + share * width), (factors[k + 1] - factors[k]) / width, 1e-12);
    }
  const friction_factor one(1, place.data(), factor.data());
  EXPECT_TRUE(one.varies());
  for (double x : {-1.0, -0.03, 0.5}) {
    EXPECT_EQ(one.at(x), 0.5);
    EXPECT_EQ(one.slope(x), 0.0);
  }
}

}  // namespace
