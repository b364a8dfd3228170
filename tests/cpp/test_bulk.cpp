// One mass that heat warms and the air cools: closed forms.
#include "temperature/bulk.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace railpatch;

TEST(Bulk, IsTheExponentialTowardsTheBalance) {
  const double capacity = 900, conductance = 6, air = 15, heat = 300, start = 80;
  const double end = air + heat / conductance;
  for (double t : {0.0, 1e-9, 0.3, 50.0, 1e4, 1e9})
    EXPECT_NEAR(bulk_after(start, heat, capacity, conductance, air, t),
                end + (start - end) * std::exp(-conductance * t / capacity), 1e-12 * start)
        << t;
  // without air all heat is stored
  EXPECT_DOUBLE_EQ(bulk_after(start, heat, capacity, 0, air, 30), start + heat * 30 / capacity);
  // steps can be cut
  double cut = start;
  for (int i = 0; i < 10; ++i) cut = bulk_after(cut, heat, capacity, conductance, air, 7);
  EXPECT_NEAR(cut, bulk_after(start, heat, capacity, conductance, air, 70), 1e-12 * start);
}

TEST(Bulk, StepsGoOnFromThoseThatWereKept) {
  bulk_setup setup;
  setup.capacity[0] = 1000;
  setup.start[0] = 50;
  setup.start[1] = 20;
  bulk_temperatures bulk(setup);
  const double heat[2][2] = {{100, 200}, {400, 300}};
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
    const double away[2][2] = {{0, 0}, {flow, 0}};
    bulk.reset();
    bulk.keep(away);
    bulk.begin(1);
    EXPECT_FALSE(bulk.within_range()) << flow;
  }
  bulk.reset();
  bulk.begin(10);
  EXPECT_EQ(bulk.now(1, 0), 50);
}

}  // namespace
