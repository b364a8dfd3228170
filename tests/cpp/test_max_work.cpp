// A budget of work for a step: what is spent is counted, ends the search for the height, and leaves
// the result of the height that came nearest.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scenes.hpp"

namespace {

rp_config wheelset(const scenes::profile_pair &pair, int max_work) {
  rp_config c = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  c.tangential = RP_TANGENTIAL_POLACH;
  c.max_work = max_work;
  return c;
}

rp_input input(int k) {
  rp_input in = scenes::running(RP_RAIL);
  in.y = 5e-4 * k;
  in.yaw = 2e-3 * (k % 3 - 1);
  in.vertical_force = 1.6e5 + 2e4 * (k % 4);
  return in;
}

double miss(const rp_result &r, const rp_input &in) {
  return std::fabs(r.force[2] + in.vertical_force) / in.vertical_force;
}

// What the last evaluation of each wheel took, from its patches.
int last_work(const rp_result &r) {
  int sum = 0;
  for (const rp_side_result &side : r.side)
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i)
      sum += 1 + side.patch[i].normal_iterations + side.patch[i].inner_iterations;
  return sum;
}

TEST(MaxWork, EndsTheSearchAtTheNearestHeight) {
  const scenes::profile_pair pair;
  rp_config fixed = wheelset(pair, 0);
  fixed.load = RP_POSITION;
  const double tolerance = fixed.tolerance;
  int spent = 0, converged = 0;
  for (const int most : {1, 20, 40, 80}) {
    scenes::handle limited(wheelset(pair, most)), placed(fixed);
    for (int k = 0; k < 12; ++k) {
      SCOPED_TRACE(testing::Message() << most << ' ' << k);
      rp_input in = input(k);
      const rp_result r = limited.step(in);
      EXPECT_GE(r.work, last_work(r));
      // the budget is looked at after an evaluation, and the nearest may be solved again
      EXPECT_EQ(r.status, miss(r, in) <= tolerance ? RP_CONVERGED : RP_WORK_SPENT);
      in.z = r.z;
      const rp_result there = placed.step(in);
      EXPECT_NEAR(r.force[2], there.force[2], 1e-4 * in.vertical_force);
      if (r.status == RP_CONVERGED) {
        ++converged;
        continue;
      }
      ++spent;
      EXPECT_GE(r.work, most);
      EXPECT_EQ(r.reason, RP_REASON_WORK);
      EXPECT_NEAR(r.reason_value, miss(r, in), 1e-9);
      EXPECT_EQ(r.residual, r.reason_value);
      for (const rp_side_result &side : r.side) {
        EXPECT_EQ(side.status, side.patch_count > 0 ? RP_WORK_SPENT : RP_NO_CONTACT);
        if (side.patch_count > 0) {
          EXPECT_EQ(side.patch[0].status, RP_WORK_SPENT);
        }
      }
      if (most == 1) {
        EXPECT_EQ(r.evaluations, 1);
      }
    }
  }
  EXPECT_GT(spent, 12);
  EXPECT_GT(converged, 6);
}

// Steps of one evaluation each go on with the search of the step before.
TEST(MaxWork, LaterStepsGoOn) {
  const scenes::profile_pair pair;
  scenes::handle h(wheelset(pair, 1));
  const rp_input in = input(3);
  double before = HUGE_VAL;
  int steps = 0;
  for (rp_status status = RP_WORK_SPENT; status == RP_WORK_SPENT && steps < 12; ++steps) {
    const rp_result r = h.step(in);
    status = r.status;
    EXPECT_LT(miss(r, in), before);
    before = miss(r, in);
  }
  EXPECT_LT(steps, 12);
}

TEST(MaxWork, ChangesNothingWhereItIsNotSpent) {
  const scenes::profile_pair pair;
  scenes::handle free(wheelset(pair, 0)), limited(wheelset(pair, 100000));
  for (int k = 0; k < 4; ++k) {
    const rp_result a = free.step(input(k)), b = limited.step(input(k));
    EXPECT_EQ(a.z, b.z);
    EXPECT_EQ(a.force[1], b.force[1]);
    EXPECT_EQ(a.work, b.work);
    EXPECT_EQ(a.status, RP_CONVERGED);
  }
}

TEST(MaxWork, IsRefusedWhereNoHeightIsSearchedAlone) {
  const scenes::profile_pair pair;
  const auto refused = [](const rp_config &c) {
    rp_contact *contact = nullptr;
    rp_message message{};
    EXPECT_EQ(rp_create(&c, &contact, &message), RP_ERROR_VALUE);
    rp_destroy(contact);
    return std::string(message.text);
  };
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  c.max_work = 10;
  EXPECT_NE(refused(c).find("max_work must be 0 but with wheels"), std::string::npos);
  c = wheelset(pair, 10);
  c.load = RP_POSITION;
  EXPECT_NE(refused(c).find("no height is searched"), std::string::npos);
  c = wheelset(pair, 10);
  c.rail_stiffness[1] = 1e8;
  EXPECT_NE(refused(c).find("max_work must be 0 with rail_stiffness"), std::string::npos);
  c = wheelset(pair, 10);
  c.roll_balanced = 1;
  EXPECT_NE(refused(c).find("max_work must be 0 with roll_balanced"), std::string::npos);
  c = wheelset(pair, 10);
  c.accuracy = 0.1;
  EXPECT_NE(refused(c).find("max_work must be 0 with accuracy"), std::string::npos);
  c = wheelset(pair, -1);
  EXPECT_NE(refused(c).find("max_work"), std::string::npos);
}

TEST(MaxWork, StatusesJoin) {
  for (const rp_status good : {RP_CONVERGED, RP_NO_CONTACT, RP_ACCURACY_NOT_MET})
    EXPECT_EQ(rp_join_status(RP_WORK_SPENT, good), RP_WORK_SPENT);
  for (const rp_status bad : {RP_NOT_CONVERGED, RP_OUT_OF_RANGE})
    EXPECT_EQ(rp_join_status(RP_WORK_SPENT, bad), bad);
  EXPECT_STREQ(rp_status_text(RP_WORK_SPENT), "work_spent");
}

}  // namespace
