// Steps that go on to finer grids until their error estimate is what was asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "tables.hpp"

namespace {

constexpr double force = 1e5, friction = 0.3;

rp_config rows(double accuracy, int nodes = 6, int finer = 3) {
  rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL);
  c.fitted[0] = c.fitted[1] = nodes;
  c.accuracy = accuracy;
  c.finer_grids = finer;
  return c;
}

// From little to much spin, where the coarse grid does not do.
rp_input input(double share, double spin) {
  return scenes::patch_input(force, 2e-3 * share, 1e-3 * share, spin);
}

double excess(const rp_patch_result &patch, double accuracy) {
  return patch.error_estimate[0] / (accuracy * friction * patch.normal_force);
}

int nodes(const scenes::handle &h) {
  return static_cast<int>(h.field(RP_RIGHT, 0, RP_FIELD_PRESSURE).size());
}

TEST(GridLevels, EndWhereTheEstimateIsSmallEnough) {
  const double accuracy = 0.008;
  int finer = 0;
  for (const double share : {0.05, 0.3, 1.0, 3.0})
    for (const double spin : {0.0, 0.5, 2.0}) {
      scenes::handle h(rows(accuracy));
      const rp_result found = h.step(input(share, spin));
      const rp_patch_result &patch = found.side[RP_RIGHT].patch[0];
      ASSERT_EQ(found.status, RP_CONVERGED) << share << " " << spin;
      EXPECT_LE(excess(patch, accuracy), 1.0);
      if (nodes(h) == 36) continue;
      ++finer;
      // the grid before was not enough, and this one alone finds the same
      const int across = patch.grid[0], before = across == 16 ? 12 : across == 12 ? 8 : 6;
      // 6 nodes times 1.4, 1.96 and 2.744
      ASSERT_TRUE(across == 8 || across == 12 || across == 16) << across;
      scenes::handle coarse(rows(0, before, 0)), fine(rows(0, across, 0));
      EXPECT_GT(excess(coarse.step(input(share, spin)).side[RP_RIGHT].patch[0], accuracy), 1.0);
      const rp_result alone = fine.step(input(share, spin));
      for (int k = 0; k < 2; ++k)
        EXPECT_NEAR(patch.creep_force[k], alone.side[RP_RIGHT].patch[0].creep_force[k],
                    2e-5 * friction * force);
    }
  EXPECT_GT(finer, 2);
}

// Numbers are those of the grid all the same.
TEST(GridLevels, SayWhereTheAccuracyCannotBeHad) {
  scenes::handle asked(rows(1e-4, 6, 0)), plain(rows(0, 6, 0));
  rp_result a = asked.step(input(1, 0.5));
  const rp_result b = plain.step(input(1, 0.5));
  EXPECT_EQ(a.status, RP_ACCURACY_NOT_MET);
  EXPECT_EQ(a.side[RP_RIGHT].status, RP_ACCURACY_NOT_MET);
  EXPECT_EQ(a.side[RP_RIGHT].patch[0].status, RP_ACCURACY_NOT_MET);
  rp_side_result &side = a.side[RP_RIGHT];
  rp_patch_result &patch = side.patch[0];
  EXPECT_EQ(a.reason, RP_REASON_ACCURACY);
  EXPECT_NEAR(a.reason_value, patch.error_estimate[0] / (friction * force), 1e-12);
  a.status = side.status = patch.status = RP_CONVERGED;
  a.reason = side.reason = patch.reason = RP_REASON_NONE;
  a.reason_value = side.reason_value = patch.reason_value = b.reason_value;
  EXPECT_EQ(scenes::difference(a, b), "");
  EXPECT_STREQ(rp_status_text(RP_ACCURACY_NOT_MET), "accuracy_not_met");
}

// A prescribed force has no estimate: no finer grid would give one.
TEST(GridLevels, AreNotTriedWithoutAnEstimate) {
  rp_config c = scenes::forced_patch(6);
  c.accuracy = 0.01;
  c.finer_grids = 2;
  scenes::handle h(c);
  EXPECT_EQ(h.step(scenes::forced_input(force, 0.4, 0.3, 0.1)).status, RP_ACCURACY_NOT_MET);
  EXPECT_EQ(nodes(h), 36);
}

TEST(GridLevels, JoinBetweenContactAndNoSolution) {
  for (const rp_status good : {RP_CONVERGED, RP_NO_CONTACT})
    EXPECT_EQ(rp_join_status(RP_ACCURACY_NOT_MET, good), RP_ACCURACY_NOT_MET);
  for (const rp_status bad : {RP_NOT_CONVERGED, RP_OUT_OF_RANGE})
    EXPECT_EQ(rp_join_status(RP_ACCURACY_NOT_MET, bad), bad);
}

TEST(GridLevels, AreKeptWhereARunIsSmooth) {
  scenes::handle h(rows(0.01));
  int changes = 0, last = 0, most = 0, least = 1 << 20;
  for (int i = 0; i <= 60; ++i) {
    // there and back, with a small ripple
    const double at = 1.0 - std::abs(i / 30.0 - 1.0) + 0.01 * (i % 2);
    ASSERT_EQ(h.step(input(1.5 * at, 1.5 * at)).status, RP_CONVERGED) << i;
    changes += i > 0 && nodes(h) != last;
    last = nodes(h);
    most = std::max(most, last);
    least = std::min(least, last);
  }
  EXPECT_GT(most, least);
  // up and down once each, level by level
  EXPECT_LE(changes, 6);
}

TEST(GridLevels, BelongToTheState) {
  scenes::handle a(rows(0.01));
  a.step(input(0.3, 2.0));
  ASSERT_GT(nodes(a), 36);
  const std::vector<unsigned char> state = a.state();
  const rp_result next = a.step(input(0.32, 2.0));
  scenes::handle b(rows(0.01));
  ASSERT_EQ(b.restore(state), RP_OK);
  EXPECT_EQ(scenes::difference(b.step(input(0.32, 2.0)), next), "");
  ASSERT_EQ(a.restore(state), RP_OK);
  EXPECT_EQ(scenes::difference(a.step(input(0.32, 2.0)), next), "");
  rp_reset(a.get());
  scenes::handle fresh(rows(0.01));
  EXPECT_EQ(scenes::difference(a.step(input(0.3, 2.0)), fresh.step(input(0.3, 2.0))), "");
}

// On the grid where the step ended.
TEST(GridLevels, HaveDerivatives) {
  rp_config c = rows(0.01);
  c.derivatives = 1;
  c.tolerance = 1e-9;
  scenes::handle h(c);
  const rp_input in = input(0.3, 2.0);
  const int across = h.step(in).side[RP_RIGHT].patch[0].grid[0];
  ASSERT_GT(across, 6);
  rp_input direction;
  rp_default_direction(&direction);
  direction.creepage[0] = 1;
  rp_result rates{};
  rp_derivative_kind kind{};
  ASSERT_EQ(rp_differentiate(h.get(), &direction, &rates, &kind, nullptr), RP_OK);
  rp_config alone = rows(0, across, 0);
  alone.tolerance = 1e-9;
  scenes::handle fine(alone);
  double ends[2];
  for (const int k : {0, 1}) {
    rp_input beside = in;
    beside.creepage[0] += (k - 0.5) * 2e-6;
    ends[k] = fine.step(beside).side[RP_RIGHT].patch[0].creep_force[0];
  }
  const double rate = (ends[1] - ends[0]) / 2e-6;
  EXPECT_NEAR(rates.side[RP_RIGHT].patch[0].creep_force[0], rate, 1e-3 * std::abs(rate));
}

TEST(GridLevels, FollowATable) {
  rp_config c = rows(0.004, 10, 3);
  c.tangential = RP_TANGENTIAL_TABLE;
  const tables::table table = tables::small();
  c.creep_table = table.data();
  c.creep_table_size = table.size();
  scenes::handle h(c);
  int by_table = 0, by_rows = 0;
  for (const double share : {0.002, 0.3, 1.0, 6.0}) {
    const rp_result found = h.step(input(share, 0.1));
    const rp_patch_result &patch = found.side[RP_RIGHT].patch[0];
    EXPECT_EQ(found.status, RP_CONVERGED);
    EXPECT_LE(excess(patch, 0.004), 1.0);
    ++(patch.grid[0] > 0 ? by_rows : by_table);
  }
  EXPECT_GT(by_rows, 0);
}

TEST(GridLevels, OfWheelsHoldForEachPatch) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  c.elements[0] = c.elements[1] = 12;
  c.element_size[0] = c.element_size[1] = 0;
  c.fitted[0] = c.fitted[1] = 6;
  c.accuracy = 0.006;
  c.finer_grids = 2;
  scenes::handle h(c);
  rp_input in = scenes::running(RP_RAIL);
  in.vertical_force = 1.5e5;
  int finer = 0;
  for (const double y : {0.0, 2e-3, 4e-3}) {
    in.y = y;
    in.yaw = y;
    const rp_result found = h.step(in);
    ASSERT_TRUE(found.status == RP_CONVERGED || found.status == RP_ACCURACY_NOT_MET);
    EXPECT_NEAR(found.force[2], -in.vertical_force, 1e-4 * in.vertical_force);
    bool met = true;
    for (const rp_side_result &side : found.side)
      for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
        const bool own = excess(side.patch[i], c.accuracy) <= 1;
        EXPECT_EQ(side.patch[i].status, own ? RP_CONVERGED : RP_ACCURACY_NOT_MET);
        finer += side.patch[i].grid[0] > 6;
        met = met && own;
      }
    EXPECT_EQ(found.status == RP_CONVERGED, met);
  }
  EXPECT_GT(finer, 0);
}

TEST(GridLevels, AreRefusedByName) {
  const auto refused = [](const rp_config &c) {
    rp_contact *contact = nullptr;
    rp_message message{};
    EXPECT_EQ(rp_create(&c, &contact, &message), RP_ERROR_VALUE);
    rp_destroy(contact);
    return std::string(message.text);
  };
  rp_config c = rows(0.01);
  c.accuracy = 0;
  EXPECT_NE(refused(c).find("finer_grids must be 0 without accuracy"), std::string::npos);
  c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  c.accuracy = 0.01;
  c.regime = RP_TRANSIENT_ROLLING;
  EXPECT_NE(refused(c).find("accuracy must be 0 but in steady rolling"), std::string::npos);
  c.regime = RP_STEADY_ROLLING;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  c.finer_grids = 1;
  EXPECT_NE(refused(c).find("finer_grids need elements"), std::string::npos);
  c = rows(1.5);
  EXPECT_NE(refused(c).find("accuracy is 1.5"), std::string::npos);
  c = rows(0.01);
  c.finer_grids = 9;
  EXPECT_NE(refused(c).find("finer_grids is 9"), std::string::npos);
}

}  // namespace
