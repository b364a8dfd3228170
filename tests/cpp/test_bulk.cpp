// Masses that heat warms and the air cools: closed forms, and equations solved another way.
#include "temperature/bulk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using namespace railpatch;

// Of one body beside another that keeps its temperature.
double alone(double start, double heat, double conductance, double seconds) {
  bulk_setup setup;
  setup.capacity[0] = 900;
  setup.conductance[0] = conductance;
  setup.air = 15;
  double temperature[2] = {start, 40};
  advance_bulk(setup, {{heat, -heat}, 0}, seconds, temperature);
  EXPECT_EQ(temperature[1], 40);
  return temperature[0];
}

TEST(Bulk, IsTheExponentialTowardsTheBalance) {
  const double conductance = 6, heat = 300, start = 80, end = 15 + heat / conductance;
  for (double t : {0.0, 1e-9, 0.3, 50.0, 1e4, 1e9})
    EXPECT_NEAR(alone(start, heat, conductance, t),
                end + (start - end) * std::exp(-conductance * t / 900), 1e-12 * start)
        << t;
  // without air all heat is stored
  EXPECT_DOUBLE_EQ(alone(start, heat, 0, 30), start + heat * 30 / 900);
  // steps can be cut
  double cut = start;
  for (int i = 0; i < 10; ++i) cut = alone(cut, heat, conductance, 7);
  EXPECT_NEAR(cut, alone(start, heat, conductance, 70), 1e-12 * start);
}

// Friction of 300 W and 500 W, and g W/K between the bodies.
struct pair_of_bodies {
  bulk_setup setup;
  double g = 0;
  bulk_flow flow(const double (&t)[2]) const {
    return {{300 + g * (t[1] - t[0]), 500 + g * (t[0] - t[1])}, g};
  }
  void advance(double seconds, double (&t)[2]) const { advance_bulk(setup, flow(t), seconds, t); }
};

pair_of_bodies pair_with(double g, double air_wheel, double air_rail) {
  pair_of_bodies pair;
  pair.g = g;
  pair.setup.capacity[0] = 900;
  pair.setup.capacity[1] = 2500;
  pair.setup.conductance[0] = air_wheel;
  pair.setup.conductance[1] = air_rail;
  pair.setup.air = 15;
  return pair;
}

// The classical Runge-Kutta method with many steps knows nothing of eigenvalues.
TEST(Bulk, OfTwoBodiesSolvesTheirEquations) {
  for (const auto &[g, h0, h1] : {std::array{80.0, 6.0, 20.0}, std::array{80.0, 0.0, 0.0},
                                  std::array{1e-9, 9.0, 25.0}, std::array{50.0, 0.0, 10.0}}) {
    const pair_of_bodies pair = pair_with(g, h0, h1);
    const auto rate = [&, air = std::array{h0, h1}](const double (&t)[2], double (&r)[2]) {
      for (int k = 0; k < 2; ++k)
        r[k] = (pair.flow(t).heat[k] + air[static_cast<size_t>(k)] * (15 - t[k])) /
               pair.setup.capacity[k];
    };
    double t[2] = {80, 20}, fine[2] = {80, 20};
    const double seconds = 40;
    const int steps = 2000;
    for (int n = 0; n < steps; ++n) {
      const double h = seconds / steps, place[4] = {0, 0.5 * h, 0.5 * h, h};
      double sum[2] = {0, 0}, r[2] = {0, 0};
      for (int stage = 0; stage < 4; ++stage) {
        const double at[2] = {fine[0] + place[stage] * r[0], fine[1] + place[stage] * r[1]};
        rate(at, r);
        for (int k = 0; k < 2; ++k) sum[k] += (stage == 1 || stage == 2 ? 2 : 1) * r[k];
      }
      for (int k = 0; k < 2; ++k) fine[k] += h / 6 * sum[k];
    }
    pair.advance(seconds, t);
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(t[k], fine[k], 1e-9) << g << " " << k;
  }
}

TEST(Bulk, StepsGoOnFromThoseThatWereKept) {
  bulk_setup setup;
  setup.capacity[0] = 1000;
  setup.start[0] = 50;
  setup.start[1] = 20;
  bulk_temperatures bulk(setup);
  const bulk_flow heat[2] = {{{100, 200}, 0}, {{400, 300}, 0}};
  // no time passes before the first step
  bulk.begin(10);
  EXPECT_EQ(bulk.now(0, 0), 50);
  bulk.keep(heat);
  bulk.begin(5);
  EXPECT_DOUBLE_EQ(bulk.now(0, 0), 50.5);
  EXPECT_DOUBLE_EQ(bulk.now(1, 0), 52);
  EXPECT_EQ(bulk.now(0, 1), 20);
  // a step that failed is made again from where it began
  bulk.begin(10);
  EXPECT_DOUBLE_EQ(bulk.now(0, 0), 51);
  bulk.keep(heat);
  bulk.begin(0);
  EXPECT_DOUBLE_EQ(bulk.now(0, 0), 51);
  EXPECT_TRUE(bulk.within_range());
  // a held flow leads below absolute zero, and above what steel bears
  for (double flow : {-4e5, 1e7, std::nan("")}) {
    const bulk_flow away[2] = {{}, {{flow, 0}, 0}};
    bulk.reset();
    bulk.keep(away);
    bulk.begin(1);
    EXPECT_FALSE(bulk.within_range()) << flow;
  }
  bulk.reset();
  bulk.begin(10);
  EXPECT_EQ(bulk.now(1, 0), 50);
}

// What friction brings is stored or given to the air, whatever the contact lets through.
TEST(Bulk, OfTwoBodiesKeepsTheirHeat) {
  for (double g : {0.0, 3.0, 1e4})
    for (double seconds : {1e-3, 1.0, 1e3}) {
      const pair_of_bodies pair = pair_with(g, 0, 0);
      double t[2] = {80, 20};
      pair.advance(seconds, t);
      const double stored = 900 * (t[0] - 80) + 2500 * (t[1] - 20);
      // of what flowed between them at most
      EXPECT_NEAR(stored, 800 * seconds, 1e-12 * (800 * seconds + 900 * 80 + 2500 * 20)) << g;
    }
}

// However long the steps: towards the balance, never past it. Of equal temperatures without air
// the cold body only warms, the warm one only cools.
TEST(Bulk, NeverOscillates) {
  for (double seconds : {1.0, 100.0, 1e5, 1e12}) {
    const pair_of_bodies pair = pair_with(4e3, 6, 20);
    // the balance: G d = H0 (T0 - air) - 300, H0 (T0 - air) + H1 (T1 - air) = 800
    const double gap = (300 - 6 * 800 / 26.0) / (4e3 + 6 * 20 / 26.0);
    const double end[2] = {15 + (800 + 20 * gap) / 26, 15 + (800 - 6 * gap) / 26};
    double t[2] = {end[0] - 8, end[1] - 3}, before[2];
    for (int n = 0; n < 4; ++n) {
      std::copy_n(t, 2, before);
      pair.advance(seconds, t);
      for (int k = 0; k < 2; ++k) EXPECT_LE(t[k], end[k] + 1e-9) << seconds;
      EXPECT_GE(900 * t[0] + 2500 * t[1], 900 * before[0] + 2500 * before[1] - 1e-6) << seconds;
    }
    if (seconds >= 1e5) {
      for (int k = 0; k < 2; ++k) EXPECT_NEAR(t[k], end[k], 1e-9) << seconds;
    }
  }
}

}  // namespace
