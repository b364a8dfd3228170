// Wrong calls: the right error, a message that names the field, outputs untouched; and no input,
// however odd, crashes (which is worth most under the sanitizers).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <type_traits>

#include "handle/case_fields.hpp"
#include "railpatch_fields.h"
#include "scenes.hpp"

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

// Enumerations out of their range, as a careless C program can pass them.
template <class E>
void put(E &target, int value) {
  static_assert(sizeof(E) == sizeof(int));
  std::memcpy(&target, &value, sizeof value);
}

rp_config default_config() {
  rp_config c;
  rp_default_config(&c);
  return c;
}

rp_input default_input() {
  rp_input in;
  rp_default_input(&in);
  return in;
}

// rp_create must refuse: pointer untouched, message with the field.
void expect_refused(const rp_config &c, rp_error expected, const std::string &field) {
  int mark = 0;
  auto *const before = reinterpret_cast<rp_contact *>(&mark);
  rp_contact *contact = before;
  rp_message message{};
  EXPECT_EQ(rp_create(&c, &contact, &message), expected) << field << ": " << message.text;
  EXPECT_EQ(contact, before) << field;
  EXPECT_NE(std::string(message.text).find(field), std::string::npos)
      << "'" << message.text << "' does not name " << field;
  EXPECT_EQ(rp_create(&c, &contact, nullptr), expected) << "without a message";
  if (contact != before) rp_destroy(contact);
}

// rp_step must refuse: result untouched, and the next step as if nothing had been.
void expect_refused(scenes::handle &contact, const rp_input &in, rp_error expected,
                    const std::string &field) {
  rp_result result, before;
  std::memset(&result, 0x5a, sizeof result);
  std::memset(&before, 0x5a, sizeof before);
  rp_message message{};
  EXPECT_EQ(rp_step(contact.get(), &in, &result, &message), expected) << field;
  EXPECT_EQ(std::memcmp(&result, &before, sizeof result), 0) << field << " changed the result";
  EXPECT_NE(std::string(message.text).find(field), std::string::npos)
      << "'" << message.text << "' does not name " << field;
  EXPECT_EQ(rp_step(contact.get(), &in, &result, nullptr), expected) << "without a message";
}

// --- null and undefaulted ----------------------------------------------------------------------

TEST(Null, PointersAreErrors) {
  rp_message message{};
  rp_config c = default_config();
  rp_contact *contact = nullptr;
  EXPECT_EQ(rp_create(nullptr, &contact, &message), RP_ERROR_NULL);
  EXPECT_NE(std::string(message.text).find("config"), std::string::npos);
  EXPECT_EQ(rp_create(&c, nullptr, &message), RP_ERROR_NULL);
  EXPECT_NE(std::string(message.text).find("contact"), std::string::npos);
  EXPECT_EQ(rp_create(nullptr, nullptr, nullptr), RP_ERROR_NULL);

  scenes::handle made(c);
  const rp_input in = default_input();
  rp_result result;
  EXPECT_EQ(rp_step(nullptr, &in, &result, &message), RP_ERROR_NULL);
  EXPECT_EQ(rp_step(made.get(), nullptr, &result, &message), RP_ERROR_NULL);
  EXPECT_NE(std::string(message.text).find("input"), std::string::npos);
  EXPECT_EQ(rp_step(made.get(), &in, nullptr, &message), RP_ERROR_NULL);
  EXPECT_NE(std::string(message.text).find("result"), std::string::npos);
  EXPECT_EQ(rp_step(nullptr, nullptr, nullptr, nullptr), RP_ERROR_NULL);

  size_t count = 0;
  double value = 0;
  rp_stage_info info[RP_STAGE_COUNT];
  EXPECT_EQ(rp_get_field(nullptr, 0, 0, RP_FIELD_X, &value, &count), RP_ERROR_NULL);
  EXPECT_EQ(rp_get_field(made.get(), 1, 0, RP_FIELD_X, &value, nullptr), RP_ERROR_NULL);
  EXPECT_EQ(rp_describe(nullptr, info), RP_ERROR_NULL);
  EXPECT_EQ(rp_describe(made.get(), nullptr), RP_ERROR_NULL);
  EXPECT_EQ(rp_state_size(nullptr), 0u);
  // these have nothing to report
  rp_default_config(nullptr);
  rp_default_input(nullptr);
  rp_reset(nullptr);
  rp_destroy(nullptr);
}

TEST(Derivatives, CallsAreChecked) {
  rp_config c = default_config();
  rp_message message{};
  rp_result change{};
  rp_input direction;
  rp_default_direction(&direction);
  direction.creepage[0] = 1;
  const auto refused = [&](rp_contact *contact, rp_error expected, const char *word) {
    change.z = 7;
    EXPECT_EQ(rp_differentiate(contact, &direction, &change, nullptr, &message), expected);
    EXPECT_NE(std::string(message.text).find(word), std::string::npos) << message.text;
    EXPECT_EQ(change.z, 7) << "outputs of an error stay untouched";
  };
  scenes::handle without(c);
  without.step(default_input());
  refused(without.get(), RP_ERROR_VALUE, "derivatives is 0");
  for (int bad : {-1, 2}) {
    c.derivatives = bad;
    expect_refused(c, RP_ERROR_VALUE, "derivatives");
  }
  c.derivatives = 1;
  scenes::handle contact(c);
  refused(nullptr, RP_ERROR_NULL, "contact");
  refused(contact.get(), RP_ERROR_STATE, "step");
  contact.step(default_input());
  EXPECT_EQ(rp_differentiate(contact.get(), &direction, &change, nullptr, nullptr), RP_OK);
  rp_derivative_kind kind = RP_DERIVATIVE_BY_DIFFERENCES;
  EXPECT_EQ(rp_differentiate(contact.get(), &direction, &change, &kind, &message), RP_OK);
  EXPECT_EQ(kind, RP_DERIVATIVE_EXACT);
  EXPECT_LT(change.side[RP_RIGHT].patch[0].creep_force[0], 0);
  EXPECT_EQ(rp_differentiate(contact.get(), nullptr, &change, nullptr, &message), RP_ERROR_NULL);
  EXPECT_EQ(rp_differentiate(contact.get(), &direction, nullptr, nullptr, &message), RP_ERROR_NULL);
  for (double bad : {nan, HUGE_VAL}) {
    direction.spin_creepage = bad;
    refused(contact.get(), RP_ERROR_VALUE, "spin_creepage");
  }
  direction.spin_creepage = 0;
  direction.cookie = 0;
  refused(contact.get(), RP_ERROR_NOT_DEFAULTED, "direction");
  rp_default_direction(&direction);
  const std::vector<unsigned char> state = contact.state();
  EXPECT_EQ(contact.restore(state), RP_OK);
  refused(contact.get(), RP_ERROR_STATE, "step");
  contact.step(default_input());
  EXPECT_EQ(rp_differentiate(contact.get(), &direction, &change, nullptr, nullptr), RP_OK);
  rp_reset(contact.get());
  refused(contact.get(), RP_ERROR_STATE, "step");
  rp_default_direction(nullptr);
}

TEST(Cookie, StructsMustBeDefaulted) {
  rp_config zero{};
  expect_refused(zero, RP_ERROR_NOT_DEFAULTED, "config");
  rp_config filled;
  std::memset(&filled, 0xcc, sizeof filled);
  expect_refused(filled, RP_ERROR_NOT_DEFAULTED, "config");
  scenes::handle contact(default_config());
  rp_input in{};
  expect_refused(contact, in, RP_ERROR_NOT_DEFAULTED, "input");
  std::memset(&in, 0xcc, sizeof in);
  expect_refused(contact, in, RP_ERROR_NOT_DEFAULTED, "input");
}

// --- config ------------------------------------------------------------------------------------

struct number_field {
  const char *name;
  std::function<double &(rp_config &)> at;
  double low, high;  // values that are refused besides NaN and infinities
};

const number_field patch_numbers[] = {
    {"shear_modulus[0]", [](rp_config &c) -> double & { return c.shear_modulus[0]; }, 0, 1e30},
    {"shear_modulus[1]", [](rp_config &c) -> double & { return c.shear_modulus[1]; }, -8e10, 1e30},
    {"poisson_ratio[0]", [](rp_config &c) -> double & { return c.poisson_ratio[0]; }, -0.1, 0.51},
    {"poisson_ratio[1]", [](rp_config &c) -> double & { return c.poisson_ratio[1]; }, -1, 1},
    {"semi_axes[0]", [](rp_config &c) -> double & { return c.semi_axes[0]; }, 0, 10},
    {"semi_axes[1]", [](rp_config &c) -> double & { return c.semi_axes[1]; }, -1e-3, 10},
    {"friction_coefficient", [](rp_config &c) -> double & { return c.friction_coefficient; }, -0.1,
     100},
    {"percent_kalker", [](rp_config &c) -> double & { return c.percent_kalker; }, 0, 201},
    {"polach_k_a", [](rp_config &c) -> double & { return c.polach_k_a; }, 0, 11},
    {"polach_k_s", [](rp_config &c) -> double & { return c.polach_k_s; }, 0, 11},
    {"fastsim_k0", [](rp_config &c) -> double & { return c.fastsim_k0; }, 0, 11},
    {"fastsim_alpha", [](rp_config &c) -> double & { return c.fastsim_alpha; }, -0.1, 1.1},
    {"fastsim_beta", [](rp_config &c) -> double & { return c.fastsim_beta; }, -0.1, 1001},
    {"layer_thickness", [](rp_config &c) -> double & { return c.layer_thickness; }, -1e-6, 1},
    {"tolerance", [](rp_config &c) -> double & { return c.tolerance; }, 0, 0.5},
};

const number_field wheel_numbers[] = {
    {"nominal_radius", [](rp_config &c) -> double & { return c.nominal_radius; }, 0, 100},
    {"flange_back_distance", [](rp_config &c) -> double & { return c.flange_back_distance; }, 0,
     100},
    {"flange_back_position", [](rp_config &c) -> double & { return c.flange_back_position; }, -70,
     70},
    {"gauge", [](rp_config &c) -> double & { return c.gauge; }, 0, 1435},
    {"gauge_height", [](rp_config &c) -> double & { return c.gauge_height; }, -0.014, 14},
    {"cant", [](rp_config &c) -> double & { return c.cant; }, -2, 2},
    {"curvature", [](rp_config &c) -> double & { return c.curvature; }, -1, 1},
    {"gauge_widening", [](rp_config &c) -> double & { return c.gauge_widening; }, -1, 1},
    {"rail_stiffness[0]", [](rp_config &c) -> double & { return c.rail_stiffness[0]; }, -1, 1e30},
    {"rail_damping[1]", [](rp_config &c) -> double & { return c.rail_damping[1]; }, -1, 1e30},
    {"shear_modulus[0]", [](rp_config &c) -> double & { return c.shear_modulus[0]; }, 0, 1e30},
    {"friction_coefficient", [](rp_config &c) -> double & { return c.friction_coefficient; }, -0.1,
     100},
};

void expect_numbers_checked(const rp_config &base, const number_field &f) {
  for (double bad : {f.low, f.high, nan, inf, -inf}) {
    rp_config c = base;
    f.at(c) = bad;
    expect_refused(c, RP_ERROR_VALUE, f.name);
  }
}

TEST(Config, NumbersOfAPatchAreChecked) {
  for (const number_field &f : patch_numbers) expect_numbers_checked(default_config(), f);
  rp_config c = default_config();
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 8e9;
  expect_numbers_checked(
      c, {"layer_shear_modulus", [](rp_config &k) -> double & { return k.layer_shear_modulus; }, 0,
          1e30});
  c = default_config();
  c.geometry = RP_CURVATURES;
  expect_numbers_checked(
      c, {"curvatures[0]", [](rp_config &k) -> double & { return k.curvatures[0]; }, 0, 1e9});
  expect_numbers_checked(
      c, {"curvatures[1]", [](rp_config &k) -> double & { return k.curvatures[1]; }, -1, 1e9});
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  expect_numbers_checked(
      c, {"element_size[1]", [](rp_config &k) -> double & { return k.element_size[1]; }, -1e-3, 2});
  c = default_config();
  c.geometry = RP_LINE_CONTACT;
  c.elements[1] = 1;
  expect_numbers_checked(
      c, {"line_contact_radius", [](rp_config &k) -> double & { return k.line_contact_radius; }, 0,
          1e9});
  expect_numbers_checked(c, {"width", [](rp_config &k) -> double & { return k.width; }, -1, 1e9});
}

TEST(Config, NumbersOfWheelsAreChecked) {
  const scenes::profile_pair pair;
  const rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  for (const number_field &f : wheel_numbers) expect_numbers_checked(c, f);
  const rp_config roller = scenes::wheels(RP_WHEELSET, RP_ROLLER, pair);
  expect_numbers_checked(
      roller, {"roller_radius", [](rp_config &k) -> double & { return k.roller_radius; }, 0, 1e9});
}

TEST(Config, OfATrackThatVariesIsChecked) {
  const scenes::varying_track track;
  const rp_config good = track.config(RP_WHEELSET);
  for (const number_field &f : wheel_numbers) expect_numbers_checked(good, f);
  const auto refuse = [&](const char *field, rp_error error, auto &&spoil) {
    rp_config c = good;
    spoil(c);
    expect_refused(c, error, field);
  };
  refuse("rail_damping", RP_ERROR_VALUE, [](rp_config &c) { c.rail_stiffness[0] = 0; });
  refuse("rail_stiffness", RP_ERROR_VALUE, [](rp_config &c) { c.rail_stiffness[1] = 0.5; });
  refuse("section_count[0]", RP_ERROR_VALUE, [](rp_config &c) { c.section_count[0] = -1; });
  refuse("rail_sections", RP_ERROR_VALUE, [](rp_config &c) { c.rail_sections[1] = nullptr; });
  refuse("rail_sections", RP_ERROR_VALUE, [](rp_config &c) { c.section_position[1] = nullptr; });
  refuse("rail_sections", RP_ERROR_VALUE, [](rp_config &c) { c.section_count[0] = 1; });
  const double equal[2] = {1.0, 1.0}, wild[2] = {nan, 1.0};
  refuse("section_position[1]", RP_ERROR_VALUE,
         [&](rp_config &c) { c.section_position[1] = equal; });
  refuse("section_position[1]", RP_ERROR_VALUE,
         [&](rp_config &c) { c.section_position[1] = wild; });
  refuse("friction_along_points", RP_ERROR_VALUE,
         [](rp_config &c) { c.friction_along_points = 1; });
  refuse("friction_along_points", RP_ERROR_VALUE, [](rp_config &c) { c.kind = RP_PATCH; });
  refuse("friction_along_position[1]", RP_ERROR_VALUE,
         [](rp_config &c) { c.friction_along_position[1] = -1; });
  refuse("friction_along_factor[0]", RP_ERROR_VALUE,
         [](rp_config &c) { c.friction_along_factor[0] = -0.1; });
  // a section that is no profile, and one whose knots lie elsewhere
  rp_profile sections[2] = {track.sections[0], track.sections[1]};
  sections[1].y = nullptr;
  refuse("rail_sections[1]", RP_ERROR_PROFILE,
         [&](rp_config &c) { c.rail_sections[1] = sections; });
  sections[1] = track.sections[1];
  sections[1].count -= 1;
  refuse("rail_sections[1]", RP_ERROR_PROFILE,
         [&](rp_config &c) { c.rail_sections[1] = sections; });
  // of a side without a wheel nothing is read
  rp_config left = track.config(RP_WHEEL_RAIL);
  left.side = RP_LEFT;
  left.rail_sections[RP_RIGHT] = nullptr;
  EXPECT_EQ(scenes::handle(left).step(scenes::running(RP_RAIL)).status, RP_CONVERGED);
}

TEST(Config, OfATurnoutIsChecked) {
  const scenes::turnout track;
  const rp_config good = track.config(RP_WHEELSET);
  const auto refuse = [&](const char *field, rp_error error, auto &&spoil) {
    rp_config c = good;
    spoil(c);
    expect_refused(c, error, field);
  };
  refuse("wheel_section_count[0]", RP_ERROR_VALUE,
         [](rp_config &c) { c.wheel_section_count[0] = -1; });
  refuse("wheel_sections", RP_ERROR_VALUE, [](rp_config &c) { c.wheel_sections[1] = nullptr; });
  refuse("wheel_sections", RP_ERROR_VALUE,
         [](rp_config &c) { c.wheel_section_angle[1] = nullptr; });
  const double equal[4] = {0.0, 1.0, 1.0, 2.0}, beyond[4] = {0.0, 1.0, 2.0, 6.2832};
  const double before[4] = {-1e-3, 1.0, 2.0, 3.0};
  for (const double *angles : {equal, beyond, before})
    refuse("wheel_section_angle[1]", RP_ERROR_VALUE,
           [&](rp_config &c) { c.wheel_section_angle[1] = angles; });
  refuse("rail_origin_y", RP_ERROR_VALUE, [](rp_config &c) { c.rail_origin_z[1] = nan; });
  refuse("rail_origin_y[1]", RP_ERROR_VALUE, [](rp_config &c) { c.rail_origin_y[1] = 11; });
  refuse("rail_origin_z[1]", RP_ERROR_VALUE, [](rp_config &c) { c.rail_origin_z[1] = -1.1; });
  refuse("rail_origin_y", RP_ERROR_VALUE, [](rp_config &c) {
    c.track = RP_ROLLER;
    c.cant = 0;
  });
  refuse("section_match", RP_ERROR_VALUE, [](rp_config &c) { put(c.section_match, 2); });
  refuse("section_blend", RP_ERROR_VALUE, [](rp_config &c) { put(c.section_blend, -1); });
  // knots that lie elsewhere than those of the first: only by knot; as many always
  profiles::curve elsewhere = track.rails[1];
  elsewhere.s[3] += 1e-6;
  std::vector<rp_profile> moved = track.rail_views;
  moved[1] = elsewhere.view();
  rp_config by_knot = good;
  by_knot.rail_sections[1] = moved.data();
  EXPECT_EQ(scenes::handle(by_knot).step(scenes::turnout::inputs()[2]).status, RP_CONVERGED);
  refuse("rail_sections[1]", RP_ERROR_PROFILE, [&](rp_config &c) {
    c.section_match = RP_SECTIONS_BY_SHARE;
    c.rail_sections[1] = moved.data();
  });
  std::vector<rp_profile> fewer = track.wheel_views;
  fewer[2].count -= 1;
  refuse("wheel_sections[1]", RP_ERROR_PROFILE,
         [&](rp_config &c) { c.wheel_sections[1] = fewer.data(); });
  EXPECT_EQ(scenes::handle(good).step(scenes::turnout::inputs()[2]).status, RP_CONVERGED);
}

TEST(Config, FittedRowsAreChecked) {
  const auto expect = [](int nodes, int rows, const char *field, const auto &change) {
    rp_config c = default_config();
    c.fitted[0] = nodes;
    c.fitted[1] = rows;
    change(c);
    expect_refused(c, RP_ERROR_VALUE, field);
  };
  const auto nothing = [](rp_config &) {};
  for (int bad : {-2147483647, -1, 0, 2, 65, 2147483647}) {
    expect(bad, 8, "fitted[0]", nothing);
    expect(8, bad, "fitted[1]", nothing);
  }
  expect(8, 1, "fitted[1]", nothing);
  expect(64, 64, "fitted[0] * fitted[1]", nothing);
  expect(8, 3, "fitted[1]", [](rp_config &c) {
    c.geometry = RP_LINE_CONTACT;
    c.elements[1] = 1;
  });
  for (int theory : {RP_TANGENTIAL_LINEAR, RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_FASTRIP})
    expect(8, 8, "fitted", [&](rp_config &c) { put(c.tangential, theory); });
  expect(8, 8, "spin_offset", [](rp_config &c) { c.spin_offset = RP_SPIN_OFFSET_SIXTH; });
}

TEST(Config, CurvedReferenceSurfaceIsChecked) {
  const scenes::profile_pair pair;
  const auto expect = [&](const char *what, const std::function<void(rp_config &)> &change) {
    rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
    c.reference_surface = RP_REFERENCE_CURVED;
    change(c);
    expect_refused(c, RP_ERROR_VALUE, "reference_surface");
    expect_refused(c, RP_ERROR_VALUE, what);
  };
  expect("kind = patch", [](rp_config &c) { c.kind = RP_PATCH; });
  expect("half_space", [](rp_config &c) { c.normal = RP_NORMAL_HERTZ; });
  expect("half_space", [](rp_config &c) { c.normal = RP_NORMAL_ANALYN; });
  expect("full or none", [](rp_config &c) { c.tangential = RP_TANGENTIAL_FASTSIM; });
  expect("fitted", [](rp_config &c) { c.fitted[0] = c.fitted[1] = 8; });
  expect("(1-2nu)/G", [](rp_config &c) { c.shear_modulus[0] = 2e9; });
  const std::vector<double> level(16, 1e-4);
  expect("runout", [&](rp_config &c) {
    c.runout[RP_RIGHT] = level.data();
    c.runout_count[RP_RIGHT] = 16;
  });
}

TEST(Config, ChoicesAndCountsAreChecked) {
  struct {
    const char *name;
    std::function<void(rp_config &, int)> set;
    int low, high;
  } const fields[] = {
      {"kind", [](rp_config &c, int v) { put(c.kind, v); }, -1, 3},
      {"geometry", [](rp_config &c, int v) { put(c.geometry, v); }, -1, 4},
      {"load", [](rp_config &c, int v) { put(c.load, v); }, -1, 2},
      {"regime", [](rp_config &c, int v) { put(c.regime, v); }, -1, 4},
      {"normal", [](rp_config &c, int v) { put(c.normal, v); }, -1, 5},
      {"tangential", [](rp_config &c, int v) { put(c.tangential, v); }, -1, 6},
      {"traction_bound", [](rp_config &c, int v) { put(c.traction_bound, v); }, -1, 3},
      {"flexibility_blending", [](rp_config &c, int v) { put(c.flexibility_blending, v); }, -1, 3},
      {"spin_offset", [](rp_config &c, int v) { put(c.spin_offset, v); }, -1, 5},
      {"reference_surface", [](rp_config &c, int v) { put(c.reference_surface, v); }, -1, 2},
      {"elements[0]", [](rp_config &c, int v) { c.elements[0] = v; }, -5, 100000},
      {"force_prescribed[0]", [](rp_config &c, int v) { c.force_prescribed[0] = v; }, -1, 2},
      {"force_prescribed[1]", [](rp_config &c, int v) { c.force_prescribed[1] = v; }, -1, 2},
      {"elements[1]", [](rp_config &c, int v) { c.elements[1] = v; }, 1, 100000},
      {"max_elements[0]", [](rp_config &c, int v) { c.max_elements[0] = v; }, -1, 1 << 30},
      {"max_iterations", [](rp_config &c, int v) { c.max_iterations = v; }, 0, 1 << 30},
  };
  for (const auto &f : fields)
    for (int bad :
         {f.low, f.high, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
      rp_config c = default_config();
      f.set(c, bad);
      expect_refused(c, RP_ERROR_VALUE, f.name);
    }
  const scenes::profile_pair pair;
  for (int bad : {-1, 2, 100}) {
    rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
    c.side = bad;
    expect_refused(c, RP_ERROR_VALUE, "side");
    c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
    put(c.track, bad);
    expect_refused(c, RP_ERROR_VALUE, "track");
    c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
    c.max_patches = bad == 2 ? 0 : bad;
    expect_refused(c, RP_ERROR_VALUE, "max_patches");
    c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
    put(c.patch_rule, bad);
    expect_refused(c, RP_ERROR_VALUE, "patch_rule");
    c = scenes::wheels(RP_WHEELSET, RP_ROLLER, pair);
    put(c.contact_frame, bad);
    expect_refused(c, RP_ERROR_VALUE, "contact_frame");
    c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
    c.standstill_speed = bad;
    expect_refused(c, RP_ERROR_VALUE, "standstill_speed");
  }
}

TEST(Config, RelationsAreChecked) {
  rp_config c = default_config();
  c.element_size[0] = c.element_size[1] = 1e-3;
  expect_refused(c, RP_ERROR_VALUE, "element_size");  // both
  c = default_config();
  c.elements[0] = c.elements[1] = 0;
  expect_refused(c, RP_ERROR_VALUE, "elements");  // neither
  c = default_config();
  c.geometry = RP_LINE_CONTACT;
  c.elements[1] = 1;
  c.load = RP_POSITION;
  expect_refused(c, RP_ERROR_VALUE, "approach");
  c.load = RP_FORCE;
  c.tangential = RP_TANGENTIAL_FASTSIM;
  expect_refused(c, RP_ERROR_VALUE, "fast theory");
  for (rp_normal_method method :
       {RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN}) {
    c.tangential = RP_TANGENTIAL_FULL;
    c.normal = method;
    expect_refused(c, RP_ERROR_VALUE, "line contact");
  }
  c = default_config();
  c.tangential = RP_TANGENTIAL_FASTSIM;
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 8e9;
  expect_refused(c, RP_ERROR_VALUE, "layer");
  c = default_config();
  c.percent_kalker = 60;
  expect_refused(c, RP_ERROR_VALUE, "percent_kalker");
  c = default_config();
  c.tangential = RP_TANGENTIAL_FASTRIP;
  c.traction_bound = RP_BOUND_PARABOLIC;
  expect_refused(c, RP_ERROR_VALUE, "traction_bound");
  c.traction_bound = RP_BOUND_AUTOMATIC;
  c.flexibility_blending = RP_BLENDING_CONTACT;
  expect_refused(c, RP_ERROR_VALUE, "flexibility_blending");
  c.flexibility_blending = RP_BLENDING_SLIDING;
  c.polach_k_s = 0.4;
  expect_refused(c, RP_ERROR_VALUE, "polach_k_s");
  c = default_config();
  c.tangential = RP_TANGENTIAL_POLACH;
  c.fastsim_beta = 0.6;
  expect_refused(c, RP_ERROR_VALUE, "fastsim_beta");
  // unlike bodies: what else couples the normal and the tangential problem
  for (rp_normal_method normal : {RP_NORMAL_HERTZ, RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN}) {
    c = default_config();
    c.shear_modulus[0] = 26e9;
    c.normal = normal;
    expect_refused(c, RP_ERROR_VALUE, "shear_modulus");
  }
  for (rp_tangential_method tangential : {RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_POLACH}) {
    c = default_config();
    c.shear_modulus[0] = 26e9;
    c.normal = RP_NORMAL_HALF_SPACE;
    c.tangential = tangential;
    expect_refused(c, RP_ERROR_VALUE, "shear_modulus");
  }
  c = default_config();
  c.shear_modulus[0] = 26e9;
  c.fitted[0] = c.fitted[1] = 8;
  expect_refused(c, RP_ERROR_VALUE, "shear_modulus");
  const scenes::profile_pair pair;
  c = scenes::wheels(RP_WHEELSET, RP_ROLLER, pair);
  c.cant = 0.025;
  expect_refused(c, RP_ERROR_VALUE, "cant");
  c = scenes::wheels(RP_WHEELSET, RP_ROLLER, pair);
  c.curvature = 1e-3;
  expect_refused(c, RP_ERROR_VALUE, "curvature");
}

TEST(Config, UndeformedDistanceIsChecked) {
  std::vector<double> gap(100, 1e-6);
  rp_config c = default_config();
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  c.distance_shape[0] = c.distance_shape[1] = 10;
  expect_refused(c, RP_ERROR_VALUE, "undeformed_distance");  // null
  c.undeformed_distance = gap.data();
  {
    const scenes::handle usable(c);
  }
  for (double bad : {nan, inf, -5.0}) {
    gap[57] = bad;
    expect_refused(c, RP_ERROR_VALUE, "undeformed_distance[57]");
  }
  gap[57] = 0;
  for (int bad : {-1, 0, 100000}) {
    rp_config d = c;
    d.distance_shape[1] = bad;
    expect_refused(d, RP_ERROR_VALUE, "distance_shape[1]");
  }
  rp_config d = c;
  d.normal = RP_NORMAL_HERTZ;
  expect_refused(d, RP_ERROR_VALUE, "undeformed_distance");
  for (rp_normal_method method :
       {RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN}) {
    d.normal = method;
    const scenes::handle usable(d);
  }
}

// --- profiles ----------------------------------------------------------------------------------

TEST(Profiles, AreChecked) {
  const scenes::profile_pair good;
  struct {
    const char *name;
    std::function<void(profiles::curve &)> spoil;
  } const cases[] = {
      {"arc length not growing", [](profiles::curve &p) { std::swap(p.s[10], p.s[11]); }},
      {"arc length standing still", [](profiles::curve &p) { p.s[11] = p.s[10]; }},
      {"s nan", [](profiles::curve &p) { p.s[3] = nan; }},
      {"y nan", [](profiles::curve &p) { p.y[20] = nan; }},
      {"z infinite", [](profiles::curve &p) { p.z.back() = inf; }},
      {"dy nan", [](profiles::curve &p) { p.dy[0] = nan; }},
      {"dz infinite", [](profiles::curve &p) { p.dz[7] = -inf; }},
      {"derivatives of another parameter",
       [](profiles::curve &p) {
         for (double &v : p.dy) v *= 1e-3;
         for (double &v : p.dz) v *= 1e-3;
       }},
      {"millimetres",
       [](profiles::curve &p) {
         for (auto *a : {&p.s, &p.y, &p.z})
           for (double &v : *a) v *= 1e3;
       }},
      {"left instead of right",
       [](profiles::curve &p) {
         for (double &v : p.y) v = -v;
         for (double &v : p.dy) v = -v;
       }},
  };
  const char *names[2][2] = {{"wheel_left", "wheel_right"}, {"rail_left", "rail_right"}};
  for (const auto &spoilt : cases)
    for (int part = 0; part < 2; ++part)
      for (int side = 0; side < 2; ++side) {
        rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, good);
        profiles::curve curve = part == 0 ? good.wheel : good.rail;
        spoilt.spoil(curve);
        (part == 0 ? c.wheel : c.rail)[side] = curve.view();
        SCOPED_TRACE(spoilt.name);
        expect_refused(c, RP_ERROR_PROFILE, names[part][side]);
      }
}

TEST(Profiles, MustBeGivenAndLongEnough) {
  const scenes::profile_pair good;
  rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, good);
  for (int count : {-1, 0, 1, 3}) {
    rp_config d = c;
    d.wheel[RP_RIGHT].count = count;
    expect_refused(d, RP_ERROR_PROFILE, "wheel_right");
  }
  for (int field = 0; field < 5; ++field) {
    rp_config d = c;
    rp_profile &p = d.rail[RP_LEFT];
    const double **arrays[] = {&p.arc_length, &p.y, &p.z, &p.dy, &p.dz};
    *arrays[field] = nullptr;
    expect_refused(d, RP_ERROR_PROFILE, "rail_left");
  }
  // one wheel needs the profiles of its side only
  c.kind = RP_WHEEL_RAIL;
  c.side = RP_LEFT;
  c.wheel[RP_RIGHT] = c.rail[RP_RIGHT] = rp_profile{};
  {
    const scenes::handle usable(c);
  }
  c.side = RP_RIGHT;
  expect_refused(c, RP_ERROR_PROFILE, "wheel_right");
}

// --- input -------------------------------------------------------------------------------------

struct input_field {
  const char *name;
  std::function<double &(rp_input &)> at;
  std::vector<double> bad;  // besides NaN and infinities
};

void expect_inputs_checked(const rp_config &config, const rp_input &good,
                           const std::vector<input_field> &fields) {
  scenes::handle contact(config), undisturbed(config);
  contact.step(good);
  undisturbed.step(good);
  for (const input_field &f : fields) {
    std::vector<double> bad = f.bad;
    bad.insert(bad.end(), {nan, inf, -inf});
    for (double value : bad) {
      rp_input in = good;
      f.at(in) = value;
      expect_refused(contact, in, RP_ERROR_VALUE, f.name);
    }
  }
  EXPECT_EQ(scenes::difference(contact.step(good), undisturbed.step(good)), "");
}

TEST(Input, OfAPatchIsChecked) {
  const rp_config c = default_config();
  expect_inputs_checked(
      c, scenes::patch_input(1e5, 1e-3, 0, 0.1),
      {{"normal_force", [](rp_input &in) -> double & { return in.normal_force; }, {-1e-9, -1e5}},
       {"creepage[0]", [](rp_input &in) -> double & { return in.creepage[0]; }, {}},
       {"creepage[1]", [](rp_input &in) -> double & { return in.creepage[1]; }, {}},
       {"spin_creepage", [](rp_input &in) -> double & { return in.spin_creepage; }, {}},
       {"rolling_speed", [](rp_input &in) -> double & { return in.rolling_speed; }, {-1}},
       {"friction_coefficient",
        [](rp_input &in) -> double & { return in.friction_coefficient; },
        {0.3, -1e-9}}});
  scenes::handle contact(c);
  for (int direction : {0, 2, -2, std::numeric_limits<int>::min()}) {
    rp_input in = default_input();
    in.direction = direction;
    expect_refused(contact, in, RP_ERROR_VALUE, "direction");
  }
  rp_config position = c;
  position.load = RP_POSITION;
  rp_input in = default_input();
  in.approach = 5e-5;
  expect_inputs_checked(position, in,
                        {{"approach", [](rp_input &i) -> double & { return i.approach; }, {}}});
}

TEST(Config, APrescribedForceNeedsAPatchAndTheFullTheory) {
  rp_config c = scenes::forced_patch();
  c.tangential = RP_TANGENTIAL_FASTSIM;
  expect_refused(c, RP_ERROR_VALUE, "force_prescribed");
  c = scenes::forced_patch();
  c.regime = RP_REGIME_NONE;
  expect_refused(c, RP_ERROR_VALUE, "force_prescribed");
  const scenes::profile_pair pair;
  c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  c.force_prescribed[1] = 1;
  expect_refused(c, RP_ERROR_VALUE, "force_prescribed");
}

TEST(Input, OfAPrescribedForceIsChecked) {
  rp_config c = scenes::forced_patch();
  c.friction_coefficient = 0.3;
  const auto force = [](int k) {
    return [k](rp_input &in) -> double & { return in.tangential_force[k]; };
  };
  const auto creepage = [](int k) {
    return [k](rp_input &in) -> double & { return in.creepage[k]; };
  };
  const auto speed = [](rp_input &in) -> double & { return in.rolling_speed; };
  // friction carries 3e4 N, of which 1e4 N lie across
  rp_input in = scenes::patch_input(1e5, 0, 0, 0.1);
  in.tangential_force[0] = 2.5e4;
  in.tangential_force[1] = -1e4;
  expect_inputs_checked(c, in,
                        {{"tangential_force", force(0), {3e4, -2.9e4}},
                         {"tangential_force", force(1), {3e4, 1.7e4}},
                         {"creepage[0]", creepage(0), {1e-3}},
                         {"creepage[1]", creepage(1), {-1e-9}},
                         {"rolling_speed", speed, {0, -1}}});
  c.force_prescribed[1] = 0;
  in.tangential_force[1] = 0;
  in.creepage[1] = 1e-3;
  expect_inputs_checked(c, in,
                        {{"tangential_force", force(0), {3.1e4}},
                         {"tangential_force[1]", force(1), {1.0}},
                         {"creepage[0]", creepage(0), {1e-3}},
                         {"creepage[1]", creepage(1), {}}});
  // the present friction coefficient counts
  scenes::handle contact(c);
  contact.step(in);
  ASSERT_EQ(rp_set_friction_coefficient(contact.get(), 0.2, nullptr), RP_OK);
  expect_refused(contact, in, RP_ERROR_VALUE, "tangential_force");
}

// A coefficient in per cent, or above 1, is doubted as it was set last, not as the case has it.
TEST(Input, FrictionSetIsDoubted) {
  scenes::handle contact(scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTSIM));
  const uint32_t bit = uint32_t{1} << RP_WARNING_FRICTION;
  for (double coefficient : {0.3, 1.5, 0.4}) {
    ASSERT_EQ(rp_set_friction_coefficient(contact.get(), coefficient, nullptr), RP_OK);
    EXPECT_EQ(contact.step(default_input()).warnings & bit, coefficient > 1 ? bit : 0u);
  }
}

// Where the normal force follows from the approach, the solve tells.
TEST(Input, ForceBeyondFrictionIsAStatus) {
  for (int nodes : {0, 8}) {
    rp_config c = scenes::forced_patch(nodes);
    c.load = RP_POSITION;
    c.friction_coefficient = 0.3;
    scenes::handle contact(c);
    rp_input in = default_input();
    in.approach = 5e-5;
    const double most = 0.3 * contact.step(in).side[RP_RIGHT].patch[0].normal_force;
    for (double share : {0.999, 1.001, 3.0, 0.5}) {
      in.tangential_force[0] = -share * most;
      const rp_patch_result p = contact.step(in).side[RP_RIGHT].patch[0];
      EXPECT_EQ(p.status, share > 1 ? RP_OUT_OF_RANGE : RP_CONVERGED) << share;
      EXPECT_TRUE(std::isfinite(p.residual) && std::isfinite(p.creepage[0])) << share;
      // the residual does not hide the missing force
      EXPECT_GE(p.residual, share > 1 ? 0.99 * (1 - 1 / share) : 0.0) << share;
      if (share < 1) {
        EXPECT_NEAR(p.creep_force[0], in.tangential_force[0], 1.01e-5 * most) << share;
      }
    }
  }
}

TEST(Input, OfAWheelsetIsChecked) {
  const scenes::profile_pair pair;
  const rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  std::vector<input_field> fields{
      {"y", [](rp_input &in) -> double & { return in.y; }, {-2, 2}},
      {"roll", [](rp_input &in) -> double & { return in.roll; }, {-2, 2}},
      {"yaw", [](rp_input &in) -> double & { return in.yaw; }, {-2, 2}},
      {"speed", [](rp_input &in) -> double & { return in.speed; }, {}},
      {"vy", [](rp_input &in) -> double & { return in.vy; }, {}},
      {"vz", [](rp_input &in) -> double & { return in.vz; }, {}},
      {"roll_rate", [](rp_input &in) -> double & { return in.roll_rate; }, {}},
      {"yaw_rate", [](rp_input &in) -> double & { return in.yaw_rate; }, {}},
      {"pitch_rate", [](rp_input &in) -> double & { return in.pitch_rate; }, {}},
      {"vertical_force", [](rp_input &in) -> double & { return in.vertical_force; }, {-1e-9, -1}},
      {"wheel_offset[1]", [](rp_input &in) -> double & { return in.wheel_offset[0][1]; }, {2}},
      {"wheel_offset[2]", [](rp_input &in) -> double & { return in.wheel_offset[1][2]; }, {2}},
      {"wheel_rotation[0]", [](rp_input &in) -> double & { return in.wheel_rotation[0][0]; }, {2}},
      {"rail_offset[0]", [](rp_input &in) -> double & { return in.rail_offset[1][0]; }, {-2}},
      {"rail_rotation[2]", [](rp_input &in) -> double & { return in.rail_rotation[1][2]; }, {2}},
      {"x", [](rp_input &in) -> double & { return in.x; }, {}},
      {"pitch", [](rp_input &in) -> double & { return in.pitch; }, {}},
      {"wheel_velocity[0]", [](rp_input &in) -> double & { return in.wheel_velocity[0][0]; }, {}},
      {"wheel_angular_velocity[1]",
       [](rp_input &in) -> double & { return in.wheel_angular_velocity[1][1]; },
       {}},
      {"rail_velocity[2]", [](rp_input &in) -> double & { return in.rail_velocity[0][2]; }, {}},
      {"rail_angular_velocity[2]",
       [](rp_input &in) -> double & { return in.rail_angular_velocity[1][2]; },
       {}},
      {"time_step", [](rp_input &in) -> double & { return in.time_step; }, {-1e-3}},
      {"roller_pitch_rate", [](rp_input &in) -> double & { return in.roller_pitch_rate; }, {}}};
  expect_inputs_checked(c, scenes::running(RP_RAIL), fields);
  rp_config position = c;
  position.load = RP_POSITION;
  expect_inputs_checked(position, scenes::running(RP_RAIL),
                        {{"z", [](rp_input &in) -> double & { return in.z; }, {-2, 2}}});
}

// --- fields ------------------------------------------------------------------------------------

TEST(Fields, AreChecked) {
  scenes::handle contact(scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE, 8));
  std::vector<double> values(1000, 7.0);
  size_t count = values.size();
  EXPECT_EQ(rp_get_field(contact.get(), RP_RIGHT, 0, RP_FIELD_PRESSURE, values.data(), &count),
            RP_ERROR_NO_FIELD)
      << "before the first step";
  contact.step(default_input());
  for (int side : {-1, 0, 2})
    EXPECT_EQ(rp_get_field(contact.get(), side, 0, RP_FIELD_X, values.data(), &count),
              RP_ERROR_NO_FIELD);
  for (int patch : {-1, 1, 1000})
    EXPECT_EQ(rp_get_field(contact.get(), RP_RIGHT, patch, RP_FIELD_X, values.data(), &count),
              RP_ERROR_NO_FIELD);
  EXPECT_EQ(rp_get_field(contact.get(), RP_RIGHT, 0, RP_FIELD_TRACTION, values.data(), &count),
            RP_ERROR_NO_FIELD)
      << "a scene without tangential problem";
  // a number beyond the list that C++ lets the enumeration hold
  rp_field name;
  put(name, RP_FIELD_ERROR_FEATURES + 1);
  EXPECT_EQ(rp_get_field(contact.get(), RP_RIGHT, 0, name, values.data(), &count),
            RP_ERROR_NO_FIELD);
  count = 99;
  EXPECT_EQ(rp_get_field(contact.get(), RP_RIGHT, 0, RP_FIELD_PRESSURE, values.data(), &count),
            RP_ERROR_SIZE);
  EXPECT_EQ(count, 100u);
  for (double v : values) EXPECT_EQ(v, 7.0) << "values written in spite of the error";
}

TEST(Texts, ExistForEveryCode) {
  // all that C++ lets these enumerations hold, known or not
  for (int code = 0; code < 16; ++code) {
    rp_error error;
    put(error, code);
    EXPECT_GT(std::strlen(rp_error_text(error)), 1u);
  }
  for (int code = 0; code < 4; ++code) {
    rp_status status;
    put(status, code);
    EXPECT_GT(std::strlen(rp_status_text(status)), 1u);
  }
}

// --- anything at all ---------------------------------------------------------------------------

class Garbage : public testing::Test {
 protected:
  double number() {
    static const double special[] = {0,    -0.0, nan,   inf,  -inf, 1e308, -1e308, 5e-324,
                                     1e-9, -1,   1e-30, 1e30, 0.5,  1,     1e6,    -1e-3};
    switch (random() % 4) {
      case 0:
        return special[random() % std::size(special)];
      case 1: {
        const uint64_t bits = random();
        double v;
        std::memcpy(&v, &bits, sizeof v);
        return v;
      }
      default:
        return (static_cast<double>(random() % 2001) - 1000) / 1000 *
               std::pow(10.0, static_cast<double>(random() % 12) - 8);
    }
  }
  // small and sometimes wrong, so that memory and time stay small
  int count() { return static_cast<int>(random() % 23) - 2; }
  bool rarely() { return random() % 6 == 0; }
  bool seldom() { return random() % 15 == 0; }

  // doubles; whole numbers and choices are spoiled by name
  template <class T>
  void spoil_numbers(T &field) {
    if constexpr (std::is_array_v<T>) {
      for (auto &value : field) spoil_numbers(value);
    } else if constexpr (std::is_same_v<T, double>) {
      if (random() % 80 == 0) field = number();
    }
  }
  // pieces of physics with numbers that may pass
  void enable(rp_config &c) {
    if (seldom()) {
      c.friction_law = RP_SLIP_VELOCITY;
      c.slip_law = static_cast<rp_slip_law>(random() % 3);
      c.friction_kinetic = 0.2;
      c.friction_amplitude[0] = 0.1;
      c.friction_halving_speed[0] = 0.5;
      if (random() % 2) c.friction_memory_distance = 1e-3, c.friction_memory_speed = 1e-3;
    }
    if (seldom()) {
      c.layer_thickness = 2e-5;
      c.layer_shear_modulus = 8.2e9;
      if (random() % 2) c.layer_yield_stress = 2e8, c.layer_hardening = 3e12;
    }
    if (seldom()) {
      c.temperature = 1;
      for (int k = 0; k < 2; ++k)
        c.conductivity[k] = 50, c.heat_capacity[k] = 450, c.density[k] = 7850;
      if (random() % 2) {
        c.friction_law = RP_TEMPERATURE;
        c.friction_reference = 0.36;
        c.friction_change = -0.18;
        c.friction_temperature_range = 600;
      }
    }
    if (seldom()) c.derivatives = 1;
    if (seldom()) c.force_prescribed[random() % 2] = 1;
    if (seldom()) c.reference_surface = RP_REFERENCE_CURVED;
    if (seldom()) c.patch_rule = RP_PATCHES_CONTACT;
    if (seldom()) c.contact_frame = RP_FRAME_INCLINED;
    if (seldom())
      for (int k = 0; k < 2; ++k) c.rail_stiffness[k] = 1e8, c.rail_damping[k] = 1e5;
    if (seldom()) {
      c.friction_points = 2;
      c.friction_position[0] = -0.5, c.friction_position[1] = 0.5;
      c.friction_factor[0] = 1, c.friction_factor[1] = 0.7;
    }
    if (c.kind == RP_PATCH || !seldom()) return;
    const auto side = static_cast<size_t>(random() % 2);
    if (random() % 2) {
      for (double &v : out_of_round) v = rarely() ? number() : 1e-5;
      c.runout[side] = out_of_round.data();
      c.runout_count[side] = static_cast<int32_t>(out_of_round.size());
    } else {
      for (double &v : heights) v = rarely() && rarely() ? number() : 1e-5;
      c.rail_height[side] = random() % 8 ? heights.data() : nullptr;
      c.rail_height_count[side] = static_cast<int32_t>(heights.size());
      c.rail_height_start = -0.5;
      c.rail_height_spacing = 0.05;
    }
  }
#define RAILPATCH_SPOIL(type, field, ...) spoil_numbers(c.field);
#define RAILPATCH_SKIP(type, field, count)
#define RAILPATCH_DRY(type, field, ...)                                                          \
  if (std::strncmp(#field, "fluid_", 6) == 0 || std::strncmp(#field, "viscoelastic", 12) == 0 || \
      std::strncmp(#field, "relaxation", 10) == 0 || std::strcmp(#field, "own_influence") == 0)  \
    std::memcpy(&c.field, &whole.field, sizeof c.field);
  // without liquid, whose keys a case without it refuses, and of elastic half-spaces
  static void dry(rp_config &c) {
    const rp_config whole = default_config();
    RP_CONFIG_FIELDS(RAILPATCH_DRY, RAILPATCH_SKIP)
  }
  void spoil(rp_config &c) {
    enable(c);
    RP_CONFIG_FIELDS(RAILPATCH_SPOIL, RAILPATCH_SKIP)
    for (int k = 0; k < 2; ++k) {
      c.elements[k] = count();
      c.max_elements[k] = 12 + count();
      if (rarely()) c.element_size[k] = std::fabs(number());
      if (c.element_size[k] > 0 && random() % 2) c.elements[k] = 0;
    }
    // a capacity goes with elements of a size
    const bool counted = c.elements[0] > 0 || c.elements[1] > 0;
    if (counted && !rarely()) c.max_elements[0] = c.max_elements[1] = 0;
    if (random() % 2) c.geometry = static_cast<rp_geometry>(random() % 4);
    if (c.geometry == RP_LINE_CONTACT) c.elements[1] = 1;
    if (random() % 2) c.load = static_cast<rp_load>(random() % 2);
    if (random() % 2) c.regime = static_cast<rp_regime>(random() % 4);
    if (random() % 2) c.normal = static_cast<rp_normal_method>(random() % 5);
    if (random() % 2) c.tangential = static_cast<rp_tangential_method>(random() % 8);
    if (random() % 2) c.spin_offset = static_cast<rp_spin_offset>(random() % 5);
    if (random() % 60 == 0) put(c.kind, static_cast<int>(random()));
    if (rarely())
      for (int &n : c.fitted) n = count();
    if (rarely()) c.max_iterations = count();
    if (rarely()) c.max_patches = count();
    if (rarely()) c.side = count();
  }
  void spoil(rp_input &in) {
    railpatch::for_each_number(in, [&](const char *, double &v, double) {
      if (random() % 24 == 0) v = number();
    });
    if (rarely()) in.direction = count();
  }
  // runs a config with some inputs; counts what was accepted
  void try_out(const rp_config &c, const rp_input &start) {
    rp_contact *contact = nullptr;
    rp_message message{};
    const rp_error error = rp_create(&c, &contact, &message);
    if (error != RP_OK) {
      EXPECT_EQ(contact, nullptr);
      EXPECT_GT(std::strlen(message.text), 5u);
      return;
    }
    ++created;
    for (int i = 0; i < 4; ++i) {
      rp_input in = start;
      spoil(in);
      rp_result result;
      if (rp_step(contact, &in, &result, nullptr) != RP_OK) continue;
      ++stepped;
      EXPECT_TRUE(result.status >= RP_CONVERGED && result.status <= RP_WORK_SPENT);
      const bool solved = c.kind == RP_PATCH && result.status == RP_CONVERGED;
      EXPECT_TRUE(!solved || std::isfinite(result.side[RP_RIGHT].patch[0].normal_force));
      std::vector<double> values(1 << 12);
      size_t size = values.size();
      rp_get_field(contact, RP_RIGHT, 0, RP_FIELD_TRACTION, values.data(), &size);
      if (c.derivatives == 1 && i == 0) differentiate(contact);
    }
    rp_destroy(contact);
  }

  // along a direction in which anything may change
  // Without what varies along the track or round the wheels, and placed by the gauge.
  static void of_one_profile(rp_config &c) {
    const rp_config whole = default_config();
    c.section_match = whole.section_match;
    c.section_blend = whole.section_blend;
    c.regime_changes = 0;
    for (int side = 0; side < 2; ++side) {
      c.section_count[side] = c.wheel_section_count[side] = 0;
      c.runout_count[side] = c.rail_height_count[side] = 0;
      c.rail_origin_y[side] = c.rail_origin_z[side] = nan;
    }
  }
  void differentiate(rp_contact *contact) {
    rp_input direction;
    rp_default_direction(&direction);
    direction.creepage[0] = direction.y = 1;
    spoil(direction);
    rp_result change;
    rp_derivative_kind kind;
    differentiated += rp_differentiate(contact, &direction, &change, &kind, nullptr) == RP_OK;
  }

  std::mt19937_64 random{20240609};
  std::array<double, 32> out_of_round{}, heights{};
  int created = 0, stepped = 0, differentiated = 0;
};

TEST_F(Garbage, ConfigsOfPatchesDoNotCrash) {
  std::vector<double> gap(20 * 20, 0.0), own(4 * 20 * 21, 0.0);
  for (int n = 0; n < 5000; ++n) {
    rp_config c = default_config();
    spoil(c);
    // half of them without what goes with few others only
    if (n % 2) {
      const rp_config whole = default_config();
      c.spin_offset = whole.spin_offset;
      c.friction_memory_distance = whole.friction_memory_distance;
      c.friction_memory_speed = whole.friction_memory_speed;
      dry(c);
    }
    for (double &v : gap) v = rarely() ? number() : 1e-6;
    for (double &v : own) v = rarely() ? number() : 1e-14;
    if (c.geometry == RP_UNDEFORMED_DISTANCE) {
      c.undeformed_distance = rarely() ? nullptr : gap.data();
      for (int &shape : c.distance_shape) shape = std::min(count(), 20);
      c.influence_coefficients = rarely() ? nullptr : own.data();
    }
    SCOPED_TRACE("number " + std::to_string(n));
    try_out(c, default_input());
  }
  EXPECT_GT(created, 300);
  EXPECT_GT(stepped, 300);
  EXPECT_GT(differentiated, 10);
}

TEST_F(Garbage, ConfigsOfWheelsDoNotCrash) {
  const scenes::profile_pair pair;
  for (int n = 0; n < 2500; ++n) {
    const rp_track track = random() % 2 ? RP_RAIL : RP_ROLLER;
    rp_config c = scenes::wheels(random() % 2 ? RP_WHEELSET : RP_WHEEL_RAIL, track, pair);
    c.element_size[0] = c.element_size[1] = 2e-3;
    spoil(c);
    if (n % 2) {
      dry(c);
      of_one_profile(c);
      if (n % 4 == 1) c.derivatives = 1;
    }
    SCOPED_TRACE("number " + std::to_string(n));
    try_out(c, scenes::running(track));
  }
  EXPECT_GT(created, 30);
  EXPECT_GT(stepped, 30);
  EXPECT_GT(differentiated, 0);
}

TEST_F(Garbage, ProfilesDoNotCrash) {
  const scenes::profile_pair good;
  for (int n = 0; n < 1500; ++n) {
    scenes::profile_pair bad = good;
    profiles::curve &p = random() % 2 ? bad.wheel : bad.rail;
    const size_t points = p.s.size();
    switch (random() % 4) {
      case 0:  // a few wrong numbers
        for (auto *a : {&p.s, &p.y, &p.z, &p.dy, &p.dz})
          if (random() % 2) (*a)[random() % points] = number();
        break;
      case 1:  // noise of all sizes, which may pass
        for (auto *a : {&p.y, &p.z, &p.dy, &p.dz}) {
          const double size = std::pow(10.0, -static_cast<double>(random() % 8));
          for (double &v : *a) v += size * (static_cast<double>(random() % 2001) - 1000) * 1e-3;
        }
        break;
      case 2:  // a short piece
        for (auto *a : {&p.s, &p.y, &p.z, &p.dy, &p.dz}) {
          const size_t keep = 4 + random() % 20;
          a->resize(std::min(keep, points));
        }
        break;
      default:  // bent, moved and turned
        for (size_t i = 0; i < points; ++i) {
          p.y[i] += 0.1 * number();
          p.z[i] *= -1;
        }
    }
    rp_config c = scenes::wheels(n % 4 == 0 ? RP_WHEELSET : RP_WHEEL_RAIL,
                                 random() % 2 ? RP_RAIL : RP_ROLLER, bad);
    c.element_size[0] = c.element_size[1] = 2e-3;
    c.tangential = RP_TANGENTIAL_NONE;
    // pieces of different length: the shortest array counts
    for (rp_profile *view : {&c.wheel[0], &c.wheel[1]})
      view->count =
          static_cast<int32_t>(std::min({bad.wheel.s.size(), bad.wheel.y.size(), bad.wheel.z.size(),
                                         bad.wheel.dy.size(), bad.wheel.dz.size()}));
    for (rp_profile *view : {&c.rail[0], &c.rail[1]})
      view->count =
          static_cast<int32_t>(std::min({bad.rail.s.size(), bad.rail.y.size(), bad.rail.z.size(),
                                         bad.rail.dy.size(), bad.rail.dz.size()}));
    SCOPED_TRACE("number " + std::to_string(n));
    try_out(c, scenes::running(c.track));
  }
  EXPECT_GT(created, 100);
}

}  // namespace
