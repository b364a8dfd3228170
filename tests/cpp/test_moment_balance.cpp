// The search for a wheelset's balance on conditions whose zero is known, and what the C interface
// says of a wheelset in balance.
#include "wheel/moment_balance.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "scenes.hpp"

namespace {

using namespace railpatch;

// Conditions by a function; slopes too where given.
struct known_wheelset final : balanced_wheelset {
  using function = std::function<bool(const balance_pair &, balance_pair &)>;
  function f;
  std::function<bool(const balance_pair &, balance_slope &)> df;
  std::vector<balance_pair> asked;

  bool evaluate(const balance_pair &u, balance_pair &residual) override {
    asked.push_back(u);
    return f(u, residual);
  }
  bool slopes(balance_slope &slope) override { return df && df(asked.back(), slope); }
};

balance_search search_of(int count, balance_pair start) {
  balance_search s;
  s.count = count;
  s.start = start;
  s.limit = {1.0, 1.0};
  s.goal = 1e-10;
  s.tolerance = 1e-8;
  return s;
}

// Loads that go over from wheel to wheel within one limit and are all on one beyond, and a torque
// that saturates: as far away as wheels are from their balance before they roll.
bool saturating(const balance_pair &u, balance_pair &f) {
  f[0] = -std::tanh(2.0 * (u[0] - 4.0)) + 0.05 * u[1];
  f[1] = -0.3 * std::tanh(u[1] + 7.0) + 0.02 * (u[0] - 4.0);
  return true;
}

TEST(MomentBalance, FindsTheZeroFromFarAwayWithoutSlopes) {
  for (double at : {-9.0, 0.0, 3.9, 12.0}) {
    known_wheelset wheelset;
    wheelset.f = saturating;
    const balance_outcome found = find_balance(wheelset, search_of(2, {at, -at}));
    balance_pair f;
    saturating(found.unknown, f);
    EXPECT_TRUE(found.converged) << at << ' ' << wheelset.asked.size();
    EXPECT_LE(std::fabs(f[0]), 1e-10) << at;
    EXPECT_LE(std::fabs(f[1]), 1e-10) << at;
    // what the contacts hold belongs to what is reported
    EXPECT_EQ(wheelset.asked.back(), found.unknown) << at;
  }
}

TEST(MomentBalance, ExactSlopesTakeOneStepOnALine) {
  known_wheelset wheelset;
  wheelset.f = [](const balance_pair &u, balance_pair &f) {
    f = {-2.0 * (u[0] - 0.3) + 0.5 * (u[1] + 0.2), -(u[1] + 0.2) - 0.25 * (u[0] - 0.3)};
    return true;
  };
  wheelset.df = [](const balance_pair &, balance_slope &s) {
    s = {{{-2.0, 0.5}, {-0.25, -1.0}}};
    return true;
  };
  const balance_outcome found = find_balance(wheelset, search_of(2, {0.0, 0.0}));
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.unknown[0], 0.3, 1e-12);
  EXPECT_NEAR(found.unknown[1], -0.2, 1e-12);
  EXPECT_EQ(wheelset.asked.size(), 2u);
}

TEST(MomentBalance, OneUnknownWithAKink) {
  known_wheelset wheelset;
  wheelset.f = [](const balance_pair &u, balance_pair &f) {
    f[0] = u[0] < 0.7 ? -(u[0] - 0.7) : -500.0 * (u[0] - 0.7);
    return true;
  };
  for (double at : {0.0, 5.0}) {
    const balance_outcome found = find_balance(wheelset, search_of(1, {at, 0.0}));
    EXPECT_TRUE(found.converged) << at;
    EXPECT_NEAR(found.unknown[0], 0.7, 1e-9) << at;
  }
}

TEST(MomentBalance, WhatHasNoZeroIsNotFound) {
  known_wheelset wheelset;
  wheelset.f = [](const balance_pair &u, balance_pair &f) {
    f[0] = 1.0 + 0.1 * std::tanh(-u[0]);
    return true;
  };
  const balance_outcome found = find_balance(wheelset, search_of(1, {0.0, 0.0}));
  EXPECT_TRUE(found.known);
  EXPECT_FALSE(found.converged);
  EXPECT_GT(found.residual, 0.8);
  EXPECT_LT(wheelset.asked.size(), 100u);
  wheelset.f = [](const balance_pair &, balance_pair &) { return false; };
  EXPECT_FALSE(find_balance(wheelset, search_of(1, {0.0, 0.0})).known);
}

// --- the C interface -------------------------------------------------------------------------

class BalancedWheelset : public testing::Test {
 protected:
  rp_config config(bool exact) const {
    rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
    c.load = RP_FORCE;
    c.roll_balanced = c.axle_free = 1;
    if (!exact) c.tangential = RP_TANGENTIAL_FASTSIM;
    return c;
  }
  static rp_input input(double y) {
    rp_input in = scenes::running(RP_RAIL);
    in.y = y;
    in.vertical_force = 1.2e5;
    // not read
    in.roll = 0.3;
    in.pitch_rate = 7;
    return in;
  }
  scenes::profile_pair pair;
};

TEST_F(BalancedWheelset, HasNoRollMomentAndNoTorque) {
  for (bool exact : {true, false}) {
    scenes::handle h(config(exact));
    const rp_result r = h.step(input(2e-3));
    SCOPED_TRACE(exact);
    EXPECT_EQ(r.status, RP_CONVERGED);
    EXPECT_LE(std::fabs(r.moment[0]), 1e-6 * 1.2e5 * 0.7175);
    EXPECT_LE(std::fabs(r.axle_torque), 1e-6 * 1.2e5 * 0.46);
    EXPECT_LE(std::fabs(r.roll), 1e-2);
    EXPECT_NEAR(r.pitch_rate, -20 / 0.46, 0.5);
  }
}

// y turned round: the same to the last bit but for the signs of a mirror.
TEST_F(BalancedWheelset, IsItsMirrorImage) {
  scenes::handle right(config(true)), left(config(true)), middle(config(true));
  const rp_result a = right.step(input(2e-3)), b = left.step(input(-2e-3));
  EXPECT_NEAR(a.roll, -b.roll, 1e-7 * std::fabs(a.roll));
  EXPECT_NEAR(a.pitch_rate, b.pitch_rate, 1e-7 * std::fabs(a.pitch_rate));
  const rp_result m = middle.step(input(0));
  EXPECT_EQ(m.roll, 0);
  EXPECT_EQ(m.side[0].force[2], m.side[1].force[2]);
}

TEST_F(BalancedWheelset, StateBringsBackTheSameBits) {
  scenes::handle h(config(false)), other(config(false));
  h.step(input(1e-3));
  const auto state = h.state();
  const rp_result first = h.step(input(2e-3));
  ASSERT_EQ(other.restore(state), RP_OK);
  const rp_result again = other.step(input(2e-3));
  EXPECT_EQ(first.roll, again.roll);
  EXPECT_EQ(first.pitch_rate, again.pitch_rate);
  EXPECT_EQ(first.z, again.z);
}

TEST_F(BalancedWheelset, WhatDoesNotGoIsRefused) {
  rp_config c = config(false);
  rp_contact *contact = nullptr;
  rp_message message{};
  const auto refused = [&](const char *name) {
    EXPECT_EQ(rp_create(&c, &contact, &message), RP_ERROR_VALUE);
    EXPECT_NE(std::string(message.text).find(name), std::string::npos) << message.text;
  };
  c.kind = RP_WHEEL_RAIL;
  refused("roll_balanced");
  c = config(false);
  c.tangential = RP_TANGENTIAL_NONE;
  refused("axle_free");
  c = config(false);
  c.roll_balanced = 2;
  refused("roll_balanced");
  c = config(true);
  c.derivatives = 1;
  scenes::handle h(c);
  h.step(input(1e-3));
  rp_jacobian jacobian;
  EXPECT_EQ(rp_get_jacobian(h.get(), &jacobian, &message), RP_ERROR_VALUE);
  EXPECT_NE(std::string(message.text).find("roll_balanced"), std::string::npos) << message.text;
}

}  // namespace
