// The rates of a wheel's solution come in batches of directions: each of many at once is what it is
// by itself, whichever batch it falls into.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "handle/scene_of.hpp"
#include "patch/result_fields.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;

rp_input no_direction() {
  rp_input d;
  rp_default_direction(&d);
  return d;
}

std::vector<double> numbers(rp_side_result &change) {
  std::vector<double> all;
  for_each_side_number(change, [&](double &v) { all.push_back(v); });
  return all;
}

// A wheel whose solution is there.
class RateBatches : public testing::Test {
 protected:
  explicit RateBatches(bool by_hertz = false) : made(scene_of(config_of(pair, by_hertz))) {
    const wheels_setup &setup = *made.wheels;
    for (int i = 0; i < setup.max_patches; ++i)
      memory.emplace_back(setup.largest.nx * setup.largest.ny, setup.largest.ny, made.patch);
    rp_input in = scenes::running(RP_RAIL);
    in.yaw = 2e-3;
    in.vy = 0.02;
    wheel.place(in);
    double z = 0;
    EXPECT_TRUE(wheel.first_touch(z));
    wheel.move_to(z + 6e-5);
    wheel.evaluate(solver, memory.data(), result);
    EXPECT_EQ(result.status, RP_CONVERGED);
    EXPECT_TRUE(made.patch.exact);
  }
  static rp_config config_of(const scenes::profile_pair &pair, bool by_hertz) {
    rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
    c.side = RP_RIGHT;
    c.derivatives = 1;
    c.load = RP_POSITION;
    if (by_hertz) {
      c.normal = RP_NORMAL_HERTZ;
      c.elements[0] = c.elements[1] = 12;
      c.element_size[0] = c.element_size[1] = 0;
    }
    return c;
  }
  void differentiate(const rp_input *directions, const friction_rates *friction, int count,
                     rp_side_result *changes) {
    wheel.differentiate(solver, memory.data(), work, directions, friction, count, {1e-10, false},
                        result, changes);
  }
  std::vector<double> alone(const rp_input &direction, const friction_rates &friction) {
    rp_side_result change{};
    differentiate(&direction, &friction, 1, &change);
    return numbers(change);
  }
  static void expect_same(const std::vector<double> &found, const std::vector<double> &expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
      if (std::isnan(expected[i]))
        EXPECT_TRUE(std::isnan(found[i])) << "number " << i;
      else
        EXPECT_NEAR(found[i], expected[i], 1e-6 * std::fabs(expected[i]) + 1e-9) << "number " << i;
    }
  }

  const scenes::profile_pair pair;
  const scene made;
  const fft_plans plans{made.transforms[0], made.transforms[1]};
  patch_contact solver{made.patch, plans, made.wheels->largest.nx, made.wheels->largest.ny,
                       made.marks};
  std::vector<patch_memory> memory;
  wheel_contact wheel{made.wheels->wheel[0]};
  wheel_derivative work{made.patch, made.wheels->largest.nx *made.wheels->largest.ny,
                        made.wheels->largest.ny};
  rp_side_result result{};
};

TEST_F(RateBatches, EveryDirectionIsWhatItIsAlone) {
  // what moves the surfaces, and then velocities alone
  constexpr int most = wheel_derivative::most_directions;
  rp_input directions[most];
  friction_rates friction[most];
  for (int k = 0; k < most; ++k) {
    directions[k] = no_direction();
    friction[k].coefficient = 0.1 * (k + 1);
    double *const rates[] = {&directions[k].y,         &directions[k].z,  &directions[k].roll,
                             &directions[k].yaw,       &directions[k].vy, &directions[k].speed,
                             &directions[k].pitch_rate};
    *rates[k < 4 ? k : 4 + k % 3] = 1.0 + k;
  }
  std::vector<std::vector<double>> each;
  for (int k = 0; k < most; ++k) each.push_back(alone(directions[k], friction[k]));
  // whole batches, parts of them, and one more than asked for, which stays as it is
  for (int count : {1, 5, 6, 7, 11, 12}) {
    std::vector<rp_side_result> changes(most + 1);
    for (rp_side_result &c : changes) c.rolling_radius = c.patch[0].normal_force = 12345;
    differentiate(directions, friction, count, changes.data());
    for (int k = 0; k < count; ++k) {
      SCOPED_TRACE(testing::Message() << "direction " << k << " of " << count);
      expect_same(numbers(changes[static_cast<size_t>(k)]), each[static_cast<size_t>(k)]);
    }
    for (size_t k = static_cast<size_t>(count); k < changes.size(); ++k) {
      EXPECT_EQ(changes[k].rolling_radius, 12345) << k;
      EXPECT_EQ(changes[k].patch[0].normal_force, 12345) << k;
    }
  }
}

// Before a direction that moves the wheelset, each that moves a side is known to move surfaces.
TEST_F(RateBatches, WhatMovesASideMovesItsSurfacesAlone) {
  const friction_rates friction[2];
  for (const bool rail : {false, true})
    for (int k = 0; k < 6; ++k) {
      if (rail && k > 3) continue;  // rails turn about x only
      SCOPED_TRACE(testing::Message() << (rail ? "rail " : "wheel ") << k);
      rp_input directions[2] = {no_direction(), no_direction()};
      auto &offset = rail ? directions[0].rail_offset : directions[0].wheel_offset;
      auto &rotation = rail ? directions[0].rail_rotation : directions[0].wheel_rotation;
      (k < 3 ? offset[RP_RIGHT][k] : rotation[RP_RIGHT][k - 3]) = 1;
      directions[1].yaw = 1;
      rp_side_result changes[2] = {};
      differentiate(directions, friction, 2, changes);
      expect_same(alone(directions[0], {}), numbers(changes[0]));
    }
}

class RateBatchesByHertz : public RateBatches {
 protected:
  RateBatchesByHertz() : RateBatches(true) {}
};

// A whole batch that moves the surfaces, and a velocity in the next one.
TEST_F(RateBatchesByHertz, WhatMovesSurfacesDoesNotReachTheNextBatch) {
  rp_input directions[rate_directions + 1];
  const friction_rates friction[rate_directions + 1];
  for (rp_input &d : directions) d = no_direction();
  directions[0].y = directions[1].z = directions[2].roll = directions[3].yaw = 1;
  directions[4].wheel_offset[RP_RIGHT][1] = directions[5].rail_offset[RP_RIGHT][2] = 1;
  directions[6].vy = 1;
  rp_side_result changes[rate_directions + 1] = {};
  differentiate(directions, friction, rate_directions + 1, changes);
  for (int k = 0; k <= rate_directions; ++k) {
    SCOPED_TRACE(k);
    expect_same(numbers(changes[k]), alone(directions[k], {}));
  }
}

}  // namespace
