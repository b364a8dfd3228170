// Steps that their caller ends: when it is asked, what it gets, and that the handle is as new.
#include <gtest/gtest.h>

#include "scenes.hpp"

namespace {

// Asks for the end the n-th time that it is asked.
struct countdown {
  int left = 1 << 30, asked = 0;
  static int ask(void *user) {
    auto &self = *static_cast<countdown *>(user);
    ++self.asked;
    return --self.left <= 0 ? 1 : 0;
  }
};

// Scenes whose loops are each other's: wheels whose z is found, rows fitted to the area, unlike
// bodies, a creep force that is prescribed, a law that falls, steps that follow each other.
struct named_scene {
  const char *name;
  rp_config config;
  rp_input input;
};

std::vector<named_scene> scenes_of(const scenes::profile_pair &pair) {
  rp_input rolling;
  rp_default_input(&rolling);
  rolling.creepage[0] = 1e-3;
  const auto full = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  std::vector<named_scene> all{{"full", full, rolling}, {"fitted", full, rolling}};
  all[1].config.fitted[0] = all[1].config.fitted[1] = 8;
  all.push_back({"unlike", full, rolling});
  all.back().config.shear_modulus[0] = 26e9;
  all.push_back({"falling", full, rolling});
  all.back().config.friction_law = RP_SLIP_VELOCITY;
  all.back().config.friction_kinetic = 0.2;
  all.back().config.friction_amplitude[0] = 0.1;
  all.push_back({"transient", full, rolling});
  all.back().config.regime = RP_TRANSIENT_ROLLING;
  all.back().input.distance = 5e-4;
  all.push_back({"forced", scenes::forced_patch(), rolling});
  all.back().input.creepage[0] = 0;
  all.back().input.tangential_force[0] = 1e4;
  rp_input running = scenes::running(RP_RAIL);
  running.vertical_force = 1.2e5;
  running.y = 1e-3;
  all.push_back({"wheelset", scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair)), running});
  all.push_back({"balanced", all.back().config, running});
  all.back().config.roll_balanced = all.back().config.axle_free = 1;
  return all;
}

TEST(Interrupt, EndsAStepAndLeavesAHandleAsNew) {
  const scenes::profile_pair pair;
  for (named_scene &scene : scenes_of(pair)) {
    SCOPED_TRACE(scene.name);
    scenes::handle plain(scene.config);
    const rp_result expected = plain.step(scene.input);
    countdown ends;
    scene.config.interrupt = countdown::ask;
    scene.config.interrupt_user = &ends;
    scenes::handle h(scene.config);
    // who is asked and goes on changes nothing
    EXPECT_EQ(scenes::difference(h.step(scene.input), expected), "");
    const int asked = ends.asked;
    EXPECT_GE(asked, 5);
    for (int at : {1, asked / 2, asked}) {
      rp_reset(h.get());
      ends.left = at;
      rp_result untouched{};
      untouched.z = 17;
      rp_message message{};
      EXPECT_EQ(rp_step(h.get(), &scene.input, &untouched, &message), RP_ERROR_INTERRUPTED) << at;
      EXPECT_STREQ(message.text, "rp_step was interrupted");
      EXPECT_EQ(untouched.z, 17);
      ends.left = 1 << 30;
      EXPECT_EQ(scenes::difference(h.step(scene.input), expected), "");
    }
  }
}

// By differences: the last step stays, and its derivatives can be asked for again.
TEST(Interrupt, OfADerivativeLeavesTheLastStep) {
  countdown ends;
  rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL, 12);
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.2;
  c.friction_amplitude[0] = 0.1;
  c.derivatives = 1;
  c.interrupt = countdown::ask;
  c.interrupt_user = &ends;
  scenes::handle h(c);
  rp_input in, direction;
  rp_default_input(&in);
  in.creepage[0] = 1e-3;
  rp_default_direction(&direction);
  direction.creepage[0] = 1;
  h.step(in);
  rp_result first{}, again{};
  rp_derivative_kind kind;
  ASSERT_EQ(rp_differentiate(h.get(), &direction, &first, &kind, nullptr), RP_OK);
  ASSERT_EQ(kind, RP_DERIVATIVE_BY_DIFFERENCES);
  ends.left = 2;
  EXPECT_EQ(rp_differentiate(h.get(), &direction, &again, &kind, nullptr), RP_ERROR_INTERRUPTED);
  ends.left = 1 << 30;
  ASSERT_EQ(rp_differentiate(h.get(), &direction, &again, &kind, nullptr), RP_OK);
  EXPECT_EQ(scenes::difference(again, first), "");
}

}  // namespace
