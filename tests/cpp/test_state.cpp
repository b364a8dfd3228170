// Save, restore, reset: the next step gives the same bits; a buffer that does not fit changes
// nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "scenes.hpp"

namespace {

using buffer = std::vector<unsigned char>;

// One kind of handle with inputs that build up a history.
struct scene {
  const char *name;
  rp_config config;
  std::vector<rp_input> inputs;
};

void PrintTo(const scene &s, std::ostream *out) { *out << s.name; }

const scenes::profile_pair &pair() {
  static const scenes::profile_pair p;
  return p;
}

std::vector<rp_input> patch_inputs() {
  return {scenes::patch_input(8e4, 1e-3, 2e-4, 0.1), scenes::patch_input(9e4, 1.2e-3, 1e-4, 0.2),
          scenes::patch_input(7e4, 1.5e-3, 0, 0.1), scenes::patch_input(1e5, 8e-4, -3e-4, 0)};
}

std::vector<rp_input> wheel_inputs(rp_track track) {
  std::vector<rp_input> all;
  for (double y : {1e-4, 3e-4, 6e-3, 5.9e-3}) {
    all.push_back(scenes::running(track));
    all.back().y = y;
    all.back().yaw = 0.003;
  }
  return all;
}

std::vector<scene> all_scenes() {
  std::vector<scene> all;
  const auto add = [&](const char *name, const rp_config &c, std::vector<rp_input> inputs) {
    all.push_back({name, c, std::move(inputs)});
  };
  add("half_space_full", scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 17),
      patch_inputs());
  add("hertz_fastsim", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTSIM), patch_inputs());
  add("kik_piotrowski_full", scenes::patch(RP_NORMAL_KIK_PIOTROWSKI, RP_TANGENTIAL_FULL),
      patch_inputs());
  add("analyn_fastsim", scenes::patch(RP_NORMAL_ANALYN, RP_TANGENTIAL_FASTSIM), patch_inputs());
  add("hertz_linear", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_LINEAR), patch_inputs());
  add("hertz_polach", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_POLACH), patch_inputs());
  add("hertz_fastrip", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTRIP), patch_inputs());
  add("half_space_polach", scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_POLACH),
      patch_inputs());
  add("half_space_fastrip", scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FASTRIP),
      patch_inputs());
  rp_config fitted = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL);
  fitted.fitted[0] = 9;
  fitted.fitted[1] = 7;
  add("hertz_fitted", fitted, patch_inputs());
  fitted.normal = RP_NORMAL_HALF_SPACE;
  add("half_space_fitted", fitted, patch_inputs());
  add("normal_only", scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE), patch_inputs());
  rp_config forced = scenes::forced_patch();
  forced.friction_coefficient = 0.3;
  const std::vector<rp_input> forces = {
      scenes::forced_input(8e4, 0.3, 0.5, 0.1), scenes::forced_input(9e4, 0.9, 0.6, 0.2),
      scenes::forced_input(7e4, 0.6, 2.5, 0.1), scenes::forced_input(1e5, 0.99, -1.0, 0)};
  add("prescribed_force", forced, forces);
  forced.fitted[0] = forced.fitted[1] = 8;
  add("prescribed_force_fitted", forced, forces);
  std::vector<rp_input> steps = patch_inputs();
  for (rp_input &in : steps) in.distance = 4e-4 * static_cast<double>(1 + (&in - steps.data()));
  steps[2].direction = -1;
  add("heated_steady", scenes::heated_patch(RP_STEADY_ROLLING), patch_inputs());
  add("heated_transient", scenes::heated_patch(RP_TRANSIENT_ROLLING), steps);
  rp_config sized = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  sized.geometry = RP_CURVATURES;
  sized.elements[0] = sized.elements[1] = 0;
  sized.element_size[0] = sized.element_size[1] = 7e-4;
  sized.max_elements[0] = sized.max_elements[1] = 30;
  add("growing_grid", sized, patch_inputs());
  add("wheelset_rail", scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair())),
      wheel_inputs(RP_RAIL));
  rp_config curved = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair()));
  curved.reference_surface = RP_REFERENCE_CURVED;
  add("wheelset_curved_surface", curved, wheel_inputs(RP_RAIL));
  add("wheelset_roller", scenes::coarse(scenes::wheels(RP_WHEELSET, RP_ROLLER, pair())),
      wheel_inputs(RP_ROLLER));
  rp_config falling = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair()));
  scenes::set_falling_friction(falling);
  add("wheelset_falling_friction", falling, wheel_inputs(RP_RAIL));
  rp_config one = scenes::coarse(scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair()));
  one.side = RP_LEFT;
  add("left_wheel", one, wheel_inputs(RP_RAIL));
  static const scenes::varying_track track;
  add("varying_track", scenes::coarse(track.config(RP_WHEELSET)), scenes::varying_track::inputs());
  static const scenes::turnout turnout;
  add("turnout", scenes::coarse(turnout.config(RP_WHEELSET)), scenes::turnout::inputs());
  return all;
}

// Of every scene, after its first step.
const std::map<std::string, buffer> &states_after_a_step() {
  static const auto states = [] {
    std::map<std::string, buffer> all;
    for (const scene &s : all_scenes()) {
      scenes::handle contact(s.config);
      contact.step(s.inputs[0]);
      all[s.name] = contact.state();
    }
    return all;
  }();
  return states;
}

class State : public testing::TestWithParam<scene> {
 protected:
  const scene &s = GetParam();

  // the handle after the first two steps
  void warm_up(scenes::handle &contact) const {
    contact.step(s.inputs[0]);
    contact.step(s.inputs[1]);
  }
  std::vector<std::vector<double>> fields(const scenes::handle &contact) const {
    std::vector<std::vector<double>> all;
    for (int side : {RP_LEFT, RP_RIGHT})
      for (int patch = 0; patch < 2; ++patch)
        for (int name = RP_FIELD_X; name <= RP_FIELD_ELEMENT_DIVISION; ++name)
          all.push_back(contact.field(side, patch, static_cast<rp_field>(name)));
    return all;
  }
  void expect_same_step(scenes::handle &contact, const rp_result &expected,
                        const std::vector<std::vector<double>> &expected_fields) const {
    const rp_result result = contact.step(s.inputs[2]);
    EXPECT_EQ(scenes::difference(result, expected), "");
    const auto found = fields(contact);
    ASSERT_EQ(found.size(), expected_fields.size());
    for (size_t i = 0; i < found.size(); ++i)
      EXPECT_TRUE(scenes::same_bits(found[i], expected_fields[i])) << "field number " << i;
  }
};

TEST_P(State, RestoredStepsToTheSameBits) {
  scenes::handle contact(s.config), other(s.config);
  warm_up(contact);
  const buffer state = contact.state();
  const rp_result expected = contact.step(s.inputs[2]);
  const auto expected_fields = fields(contact);

  contact.step(s.inputs[3]);
  ASSERT_EQ(contact.restore(state), RP_OK);
  expect_same_step(contact, expected, expected_fields);
  // a fresh handle, and the same after it has a history of its own
  ASSERT_EQ(other.restore(state), RP_OK);
  expect_same_step(other, expected, expected_fields);
  other.step(s.inputs[3]);
  ASSERT_EQ(other.restore(state), RP_OK);
  EXPECT_TRUE(other.state() == state);
  expect_same_step(other, expected, expected_fields);
}

TEST_P(State, OfAFreshHandleCanBeRestored) {
  scenes::handle contact(s.config);
  const buffer state = contact.state();
  const rp_result expected = contact.step(s.inputs[2]);
  const auto expected_fields = fields(contact);
  contact.step(s.inputs[0]);
  ASSERT_EQ(contact.restore(state), RP_OK);
  expect_same_step(contact, expected, expected_fields);
}

TEST_P(State, ResetStepsAsTheFirstTime) {
  scenes::handle contact(s.config);
  const rp_result first = contact.step(s.inputs[2]);
  const auto first_fields = fields(contact);
  warm_up(contact);
  rp_reset(contact.get());
  expect_same_step(contact, first, first_fields);
}

// The warm start is worth keeping: without it the tests above would show nothing.
TEST_P(State, HoldsAHistory) {
  scenes::handle contact(s.config);
  const buffer fresh = contact.state();
  warm_up(contact);
  // with Hertz, resultants in closed form leave nothing behind
  const bool resultants =
      s.config.tangential == RP_TANGENTIAL_LINEAR || s.config.tangential == RP_TANGENTIAL_POLACH;
  EXPECT_EQ(contact.state() != fresh, !(s.config.normal == RP_NORMAL_HERTZ && resultants));
  // the same again: a step far away may well start afresh
  const rp_result warm = contact.step(s.inputs[1]);
  rp_reset(contact.get());
  const bool closed_form =
      s.config.normal != RP_NORMAL_HALF_SPACE && s.config.tangential != RP_TANGENTIAL_FULL;
  EXPECT_EQ(scenes::difference(contact.step(s.inputs[1]), warm).empty(), closed_form);
}

TEST_P(State, BuffersThatDoNotFitChangeNothing) {
  scenes::handle contact(s.config);
  warm_up(contact);
  const buffer state = contact.state();
  const rp_result expected = contact.step(s.inputs[2]);
  const auto expected_fields = fields(contact);
  ASSERT_EQ(contact.restore(state), RP_OK);

  const auto refuse = [&](const buffer &bad, const std::string &what) {
    EXPECT_EQ(contact.restore(bad), RP_ERROR_STATE) << what;
    EXPECT_TRUE(contact.state() == state) << what;
  };
  const unsigned char none = 0;
  EXPECT_EQ(rp_restore_state(contact.get(), &none, 0), RP_ERROR_STATE);
  EXPECT_EQ(rp_restore_state(contact.get(), nullptr, state.size()), RP_ERROR_NULL);

  // every byte of the head, and a sample of the rest
  std::mt19937_64 random(7);
  for (size_t i = 0; i < 300; ++i) {
    const size_t at = i < 160 ? std::min(i, state.size() - 1) : random() % state.size();
    buffer bad = state;
    bad[at] = static_cast<unsigned char>(bad[at] ^ (1u << (random() % 8)));
    refuse(bad, "damaged byte " + std::to_string(at));
  }
  for (size_t i = 0; i < 100; ++i) {
    buffer bad = state;
    bad.resize(i < 60 ? i : random() % state.size());
    if (bad.empty()) continue;
    refuse(bad, "cut to " + std::to_string(bad.size()) + " of " + std::to_string(state.size()));
  }
  buffer longer = state;
  longer.push_back(0);
  refuse(longer, "one byte more");
  refuse(buffer(state.size(), 0), "zeros");
  buffer noise(state.size());
  std::generate(noise.begin(), noise.end(), [&] { return static_cast<unsigned char>(random()); });
  refuse(noise, "noise");
  expect_same_step(contact, expected, expected_fields);
}

TEST_P(State, OfOtherScenesIsRefused) {
  scenes::handle contact(s.config);
  warm_up(contact);
  const buffer state = contact.state();
  const rp_result expected = contact.step(s.inputs[2]);
  const auto expected_fields = fields(contact);
  ASSERT_EQ(contact.restore(state), RP_OK);
  for (const auto &[name, foreign] : states_after_a_step()) {
    EXPECT_EQ(contact.restore(foreign), name == s.name ? RP_OK : RP_ERROR_STATE) << name;
    ASSERT_EQ(contact.restore(state), RP_OK);
  }
  // the same scene with another material or friction: not this handle's state either
  rp_config changed = s.config;
  changed.friction_coefficient = 0.2;
  scenes::handle other(changed);
  other.step(s.inputs[0]);
  EXPECT_EQ(contact.restore(other.state()), RP_ERROR_STATE) << "another friction coefficient";
  EXPECT_TRUE(contact.state() == state);
  expect_same_step(contact, expected, expected_fields);
}

TEST_P(State, SaveChecksItsBuffer) {
  scenes::handle contact(s.config);
  warm_up(contact);
  buffer state(rp_state_size(contact.get()) - 1, 0x5a);
  const buffer before = state;
  EXPECT_EQ(rp_save_state(contact.get(), state.data(), state.size()), RP_ERROR_SIZE);
  EXPECT_EQ(state, before);
  EXPECT_EQ(rp_save_state(contact.get(), nullptr, state.size()), RP_ERROR_NULL);
  EXPECT_EQ(rp_save_state(nullptr, state.data(), state.size()), RP_ERROR_NULL);
  EXPECT_EQ(rp_restore_state(nullptr, state.data(), state.size()), RP_ERROR_NULL);
}

// The arrays of a config count to their last number.
TEST(StateOfArrays, WithOtherNumbersIsRefused) {
  std::vector<double> heights(30, 1e-5);
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  c.undeformed_distance = heights.data();
  c.distance_shape[0] = 6;
  c.distance_shape[1] = 5;
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 8e9;
  c.friction_points = c.hardening_points = 4;
  for (int i = 0; i < 4; ++i) {
    c.friction_position[i] = c.hardening_displacement[i] = 1e-3 * i;
    c.friction_factor[i] = 1;
    c.hardening_stress[i] = 1e8;
  }
  c.layer_yield_stress = 1e8;
  const auto state_of = [](const rp_config &config) { return scenes::handle(config).state(); };
  rp_config given = c;
  std::vector<double> own(4 * 7 * 5, 0.0);
  for (size_t k = 0; k < 3; ++k) own[k * 7 * 5] = 1e-13;
  given.layer_thickness = given.layer_yield_stress = 0;
  given.hardening_points = 0;
  given.own_influence = 1;
  given.influence_coefficients = own.data();
  scenes::handle with_own(given);
  EXPECT_EQ(with_own.restore(state_of(given)), RP_OK);
  own[4] = 1e-15;
  EXPECT_EQ(with_own.restore(state_of(given)), RP_ERROR_STATE);
  scenes::handle contact(c);
  EXPECT_EQ(contact.restore(state_of(c)), RP_OK);
  for (int i = 0; i < 4; ++i)
    for (double (rp_config::*array)[RP_MAX_POINTS] :
         {&rp_config::friction_position, &rp_config::friction_factor,
          &rp_config::hardening_displacement, &rp_config::hardening_stress}) {
      // displacements begin at 0, and the first stress is the yield stress
      if (i == 0 && array != &rp_config::friction_factor && array != &rp_config::friction_position)
        continue;
      rp_config other = c;
      (other.*array)[i] += 1e-6 * (1 + std::fabs((other.*array)[i]));
      EXPECT_EQ(contact.restore(state_of(other)), RP_ERROR_STATE) << i;
    }
  for (double &h : heights) {
    h += 1e-9;
    EXPECT_EQ(contact.restore(state_of(c)), RP_ERROR_STATE) << &h - heights.data();
    h -= 1e-9;
    h = 1e-5;
  }
}

// Profiles that no wheel is made from are not read, nor do they tell scenes apart.
TEST(StateOfArrays, OfASideWithoutAWheelAreNotRead) {
  const auto *nowhere = reinterpret_cast<const double *>(alignof(double));
  const rp_profile wild{nowhere, nowhere, nowhere, nowhere, nowhere, 1 << 20};
  const scenes::varying_track track;
  for (const int side : {RP_LEFT, RP_RIGHT}) {
    rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair());
    c.side = side;
    const std::vector<unsigned char> state = scenes::handle(c).state();
    c.wheel[1 - side] = c.rail[1 - side] = wild;
    EXPECT_EQ(scenes::handle(c).restore(state), RP_OK);
  }
  rp_config c = track.config(RP_WHEELSET);
  const std::vector<unsigned char> state = scenes::handle(c).state();
  c.rail[RP_RIGHT] = wild;
  EXPECT_EQ(scenes::handle(c).restore(state), RP_OK);
}

INSTANTIATE_TEST_SUITE_P(Scenes, State, testing::ValuesIn(all_scenes()),
                         [](const auto &info) { return std::string(info.param.name); });

}  // namespace
