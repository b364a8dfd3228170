// The bound law: its derivatives against central differences, and its resolvent put back into the
// law, for random laws and states.
#include "tangential/bound_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "handle/case_fields.hpp"

namespace {

using namespace railpatch;

struct draw {
  bound_law law;
  carried_state before{};
  double friction, e[2], m;
};

// In units of 1: pressure, lengths, speeds.
draw random_draw(std::mt19937_64 &random) {
  std::uniform_real_distribution<double> unit(0, 1);
  draw d;
  bound_law &law = d.law;
  law.step = 0.5 + unit(random);
  law.speed = 0.5 + unit(random);
  const auto kind = random() % 3;
  law.by_velocity = kind != 0;
  if (law.by_velocity) {
    law.slip.shape = static_cast<rp_slip_law>(random() % choice_count<rp_slip_law>);
    law.slip.kinetic = 0.2 + unit(random);
    for (int i = 0; i < 2; ++i) {
      law.slip.amplitude[i] = unit(random) - (i == 1 ? 0.3 : 0.0) * law.slip.kinetic;
      law.slip.halving_speed[i] = 0.2 + unit(random);
    }
    // rising: one in four
    if (random() % 4 == 0)
      for (double &a : law.slip.amplitude) a = -0.4 * unit(random) * law.slip.kinetic;
    law.slip.memory_distance = random() % 2 ? unit(random) : 0.0;
    law.slip.memory_speed = 0.05;
    if (law.remembers()) d.before.v[0] = -0.5 * unit(random) * law.slip.amplitude[0];
  }
  if (kind != 1) {
    law.by_magnitude = random() % 2;
    law.yield = hardening_curve::straight(0.1 + unit(random), 3 * (unit(random) - 0.4));
    if (random() % 2) {
      law.yield = {};
      law.yield.points = 4;
      for (int i = 0; i < 4; ++i) {
        law.yield.displacement[i] = i * (0.2 + 0.3 * unit(random));
        law.yield.stress[i] = 0.1 + unit(random);
      }
      std::sort(law.yield.displacement, law.yield.displacement + 4);
    }
    d.before.v[1] = unit(random) - (law.by_magnitude ? 0.5 : 0.0);
    if (law.by_magnitude) d.before.v[2] = unit(random) - 0.5;
  }
  d.friction = 0.5 + unit(random);
  const double angle = 6.283 * unit(random);
  d.e[0] = std::cos(angle);
  d.e[1] = std::sin(angle);
  d.m = 0.8 * unit(random);
  return d;
}

bound_point at(const draw &d, double m, double turn, int state, double change) {
  carried_state before = d.before;
  if (state >= 0) before.v[state] += change;
  const double c = std::cos(turn), s = std::sin(turn);
  const double e[2] = {d.e[0] * c - d.e[1] * s, d.e[0] * s + d.e[1] * c};
  return d.law.evaluate(d.friction, before, e, m);
}

// The derivative is that of one side where a kink lies between.
bool near_one_side(double found, double left, double middle, double right, double h) {
  const double slopes[] = {(right - left) / (2 * h), (right - middle) / h, (middle - left) / h};
  return std::any_of(slopes, slopes + 3, [&](double slope) {
    return std::abs(found - slope) <= 2e-4 * (1 + std::abs(slope));
  });
}

TEST(BoundLaw, DerivativesAreThoseOfDifferences) {
  std::mt19937_64 random(20261121);
  constexpr double h = 1e-6;
  for (int i = 0; i < 20000; ++i) {
    const draw d = random_draw(random);
    const bound_point b = at(d, d.m, 0, -1, 0);
    const auto check = [&](const char *what, const bound_point &left, const bound_point &right,
                           double bound, const double *state, int stride) {
      EXPECT_TRUE(near_one_side(bound, left.bound, b.bound, right.bound, h)) << what << " " << i;
      for (int k = 0; k < 3; ++k)
        EXPECT_TRUE(
            near_one_side(state[k * stride], left.state.v[k], b.state.v[k], right.state.v[k], h))
            << what << " of state " << k << " " << i;
    };
    check("slip", at(d, d.m - h, 0, -1, 0), at(d, d.m + h, 0, -1, 0), b.by_slip, b.state_by_slip,
          1);
    check("angle", at(d, d.m, -h, -1, 0), at(d, d.m, h, -1, 0), b.by_angle, b.state_by_angle, 1);
    for (int k = 0; k < 3; ++k) {
      const bool carried = k == 0   ? d.law.remembers()
                           : k == 1 ? d.law.plastic()
                                    : d.law.plastic() && d.law.by_magnitude;
      if (carried)
        check("state", at(d, d.m, 0, k, -h), at(d, d.m, 0, k, h), b.by_state[k],
              &b.state_by_state[0][k], 3);
    }
  }
}

// Traction within both bounds after the step, and with the bound of each part that is there: only
// friction that falls may leave the yield stress that was reached before.
TEST(BoundLaw, PartsHaveTheirBounds) {
  std::mt19937_64 random(20);
  int shared = 0;
  for (int i = 0; i < 4000; ++i) {
    const draw d = random_draw(random);
    const bound_point b = d.law.evaluate(d.friction, d.before, d.e, d.m);
    const double close = 1e-12 * d.friction;
    EXPECT_LE(b.bound, b.yield_stress + close) << i;
    EXPECT_LE(b.bound, b.friction + close) << i;
    EXPECT_GE(b.plastic, 0.0) << i;
    EXPECT_LE(b.plastic, d.m) << i;
    if (b.plastic < d.m) {
      EXPECT_NEAR(b.bound, b.friction, close) << i;
    }
    const double rest = d.law.plastic() ? d.law.evaluate(d.friction, d.before, d.e, 0).friction : 0;
    if (b.plastic > 0 && b.friction >= rest) {
      EXPECT_NEAR(b.bound, b.yield_stress, close) << i;
    }
    shared += b.plastic > 0 && b.plastic < d.m && b.friction > rest + close;
  }
  EXPECT_GT(shared, 20);
}

TEST(BoundLaw, ResolventSolvesTheLaw) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const draw d = random_draw(random);
    const double stiffness = 0.1 + 2 * d.law.fall_of_each(d.friction);
    const double size = d.law.at_rest(d.friction, d.before) * (1 + unit(random)) + 1e-6;
    const double m = d.law.resolve(d.friction, d.before, d.e, size, stiffness);
    ASSERT_GT(m, 0) << i;
    const bound_point b = d.law.evaluate(d.friction, d.before, d.e, m);
    ASSERT_NEAR(b.bound, size - stiffness * m, 1e-12 * size) << i;
    // never above either bound
    EXPECT_LE(b.bound, std::min(b.friction, b.yield_stress) * (1 + 1e-9)) << i;
    EXPECT_GE(b.plastic, 0);
    EXPECT_LE(b.plastic, m);
    // b falls nowhere faster than what makes it unique
    EXPECT_GE(b.by_slip, -d.law.steepest_fall(d.friction) * (1 + 1e-9)) << i;
  }
}

// tau = 0.7 - u meets g = 0.4 + 1.2 s from m = 0.25 on: then each metre of m takes six of the layer
// and five of slip back, until at 0.3 there is no slip left. Three solutions at twice the layer's
// own fall, (1.12 - 2 m): where friction rises, where both give way, and where the layer softens.
TEST(BoundLaw, RisingFrictionLetsASofteningLayerFallFaster) {
  bound_law law;
  law.by_velocity = true;
  law.speed = law.step = 1;
  law.slip.shape = RP_SLIP_LINEAR;
  law.slip.kinetic = 1;
  law.slip.amplitude[0] = -0.6;
  law.slip.halving_speed[0] = 0.25;
  law.yield = hardening_curve::straight(0.7, -1);
  const carried_state before{};
  const double e[2] = {1, 0};
  for (const auto &[m, bound, slope] :
       {std::array{0.2, 0.64, 1.2}, {0.26, 0.64, -6.0}, {0.29, 0.46, -6.0}, {0.5, 0.2, -1.0}}) {
    const bound_point b = law.evaluate(1, before, e, m);
    EXPECT_NEAR(b.bound, bound, 1e-14) << m;
    EXPECT_NEAR(b.by_slip, slope, 1e-12) << m;
  }
  EXPECT_EQ(law.fall_of_each(1), 1);
  EXPECT_EQ(law.steepest_fall(1), HUGE_VAL);
  EXPECT_TRUE(law.ambiguous(1, before, e, 1.12, 2));
  // of a line steeper than all of it one
  EXPECT_FALSE(law.ambiguous(1, before, e, 0.58 + 8 * 0.27, 8));
}

// Laws and memories of all sizes: speeds at which the law has fallen before the least way of the
// memory, terms that rise, what material may carry.
TEST(BoundLaw, FrictionFallsNoFasterThanItsLimit) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto decades = [&](double low, double high) {
    return std::pow(10.0, low + (high - low) * unit(random));
  };
  int near = 0;
  for (int i = 0; i < 200000; ++i) {
    bound_law law;
    law.by_velocity = true;
    law.speed = 1;
    slip_velocity_law &slip = law.slip;
    slip.shape = static_cast<rp_slip_law>(random() % choice_count<rp_slip_law>);
    slip.amplitude[0] = 0.4 * unit(random);
    slip.amplitude[1] = random() % 3 ? 0.4 * (unit(random) - 0.5) : 0.0;
    slip.kinetic = std::max(-slip.amplitude[1], 0.0) + 0.2 * unit(random);
    for (double &h : slip.halving_speed) h = decades(-2, 2);
    slip.memory_distance = random() % 3 ? decades(-2, 2) : 0.0;
    slip.memory_speed = decades(-3, 1);
    carried_state before{};
    if (law.remembers()) {
      const double least = slip.kinetic + std::min(slip.amplitude[1], 0.0) - slip.standing();
      const double most = slip.greatest() - slip.standing();
      before.v[0] = random() % 3 ? least + (most - least) * unit(random) : most;
    }
    const double e[2] = {1, 0}, m = decades(-4, 3);
    const double fall = -law.evaluate(1.0, before, e, m).by_slip, most = law.steepest_fall(1.0);
    ASSERT_LE(fall, most * (1 + 1e-9) + 1e-15) << i;
    near += fall > 0.9 * most;
  }
  EXPECT_GT(near, 1000);
}

}  // namespace
