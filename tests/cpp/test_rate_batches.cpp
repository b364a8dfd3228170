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

TEST(RateBatches, EveryDirectionIsWhatItIsAlone) {
  const scenes::profile_pair pair;
  rp_config config = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  config.side = RP_RIGHT;
  config.derivatives = 1;
  config.load = RP_POSITION;
  const scene made = scene_of(config);
  const wheels_setup &setup = *made.wheels;
  const fft_plans plans(made.transforms[0], made.transforms[1]);
  patch_contact solver(made.patch, plans, setup.largest.nx, setup.largest.ny, made.marks);
  std::vector<patch_memory> memory;
  for (int i = 0; i < setup.max_patches; ++i)
    memory.emplace_back(setup.largest.nx * setup.largest.ny, setup.largest.ny, made.patch);
  wheel_contact wheel(setup.wheel[0]);
  wheel_derivative work(made.patch, setup.largest.nx * setup.largest.ny, setup.largest.ny);
  rp_input in = scenes::running(RP_RAIL);
  in.yaw = 2e-3;
  in.vy = 0.02;
  wheel.place(in);
  double z = 0;
  ASSERT_TRUE(wheel.first_touch(z));
  wheel.move_to(z + 6e-5);
  rp_side_result result{};
  wheel.evaluate(solver, memory.data(), result);
  ASSERT_EQ(result.status, RP_CONVERGED);
  ASSERT_TRUE(wheel.differentiates());

  // what moves the surfaces, and then velocities alone
  constexpr int most = wheel_derivative::most_directions;
  rp_input directions[most];
  double friction[most];
  for (int k = 0; k < most; ++k) {
    directions[k] = no_direction();
    friction[k] = 0.1 * (k + 1);
    double *const rates[] = {&directions[k].y,         &directions[k].z,  &directions[k].roll,
                             &directions[k].yaw,       &directions[k].vy, &directions[k].speed,
                             &directions[k].pitch_rate};
    *rates[k < 4 ? k : 4 + k % 3] = 1.0 + k;
  }
  const derivative_options options{1e-10, false};
  std::vector<std::vector<double>> alone;
  for (int k = 0; k < most; ++k) {
    rp_side_result change{};
    wheel.differentiate(solver, memory.data(), work, directions + k, friction + k, 1, options,
                        result, &change);
    alone.push_back(numbers(change));
  }
  // whole batches, parts of them, and one more than asked for, which stays as it is
  for (int count : {1, 5, 6, 7, 11, 12}) {
    SCOPED_TRACE(count);
    std::vector<rp_side_result> changes(most + 1);
    for (rp_side_result &c : changes) c.rolling_radius = c.patch[0].normal_force = 12345;
    wheel.differentiate(solver, memory.data(), work, directions, friction, count, options, result,
                        changes.data());
    for (int k = 0; k < count; ++k) {
      const std::vector<double> found = numbers(changes[static_cast<size_t>(k)]);
      const std::vector<double> &expected = alone[static_cast<size_t>(k)];
      ASSERT_EQ(found.size(), expected.size());
      for (size_t i = 0; i < found.size(); ++i) {
        if (std::isnan(expected[i]))
          EXPECT_TRUE(std::isnan(found[i])) << "direction " << k << ", number " << i;
        else
          EXPECT_NEAR(found[i], expected[i], 1e-6 * std::fabs(expected[i]) + 1e-9)
              << "direction " << k << ", number " << i;
      }
    }
    for (size_t k = static_cast<size_t>(count); k < changes.size(); ++k) {
      EXPECT_EQ(changes[k].rolling_radius, 12345) << k;
      EXPECT_EQ(changes[k].patch[0].normal_force, 12345) << k;
    }
  }
}

}  // namespace
