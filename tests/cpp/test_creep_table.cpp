// Creep forces from a table through the C interface: what is refused, what is shared, and that the
// numbers do not depend on where the table lies.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "scenes.hpp"
#include "tables.hpp"

namespace {

rp_config config_of(const tables::table &table) {
  rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_TABLE);
  c.elements[0] = c.elements[1] = 0;  // closed form: no grid
  c.creep_table = table.data();
  c.creep_table_size = table.size();
  return c;
}

std::string refusal(const rp_config &config) {
  rp_contact *contact = nullptr;
  rp_message message{};
  const rp_error error = rp_create(&config, &contact, &message);
  EXPECT_EQ(error, RP_ERROR_VALUE);
  EXPECT_EQ(contact, nullptr);
  return message.text;
}

TEST(CreepTable, BrokenBytesAreRefused) {
  const auto broken = [](const std::function<void(tables::table &)> &breaks, const char *why) {
    tables::table t = tables::small();
    breaks(t);
    const std::string text = refusal(config_of(t));
    EXPECT_NE(text.find("creep_table"), std::string::npos) << text;
    EXPECT_NE(text.find(why), std::string::npos) << text << " instead of " << why;
  };
  const auto with_header = [&](auto &&change, const char *why) {
    broken(
        [&](tables::table &t) {
          railpatch::creep_table_header h = t.header();
          change(h);
          t.set_header(h);
        },
        why);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  broken([](auto &t) { t.words.clear(); }, "");
  broken([](auto &t) { t.words.resize(5); }, "too short");
  broken([](auto &t) { t.words.pop_back(); }, "length");
  broken([](auto &t) { t.words.back() ^= 1; }, "checksum");
  with_header([](auto &h) { h.magic[7] = '2'; }, "version");
  with_header([](auto &h) { h.ratio_count = 3; }, "axis");
  with_header([](auto &h) { h.t_count = 100000; }, "axis");
  with_header([](auto &h) { h.psi_count = 7; }, "length");
  with_header([](auto &h) { h.recipe_bytes = -8; }, "length");
  with_header([](auto &h) { h.poisson_ratio[1] = 0.0; }, "out of range");
  with_header([&](auto &h) { h.log_ratio[0] = nan; }, "out of range");
  with_header([](auto &h) { h.radius = 0.0; }, "out of range");
  with_header([&](auto &h) { h.error[0] = nan; }, "out of range");
  broken(
      [&](tables::table &t) {
        std::memcpy(t.words.data() + sizeof(railpatch::creep_table_header) / 8, &nan, sizeof nan);
        t.seal();
      },
      "no numbers");
}

TEST(CreepTable, WrongPlacesAreRefused) {
  const tables::table t = tables::small();
  rp_config c = config_of(t);
  c.creep_table = nullptr;
  EXPECT_NE(refusal(c).find("creep_table is null"), std::string::npos);
  c.creep_table = static_cast<const char *>(t.data()) + 4;
  EXPECT_NE(refusal(c).find("aligned"), std::string::npos);
}

TEST(CreepTable, WhatItDoesNotKnowIsRefused) {
  const tables::table t = tables::small();
  rp_config c = config_of(t);
  c.layer_thickness = 1e-5;
  c.layer_shear_modulus = 1e9;
  EXPECT_NE(refusal(c).find("layer"), std::string::npos);
  c = config_of(t);
  c.spin_offset = RP_SPIN_OFFSET_SIXTH;
  EXPECT_NE(refusal(c).find("spin_offset"), std::string::npos);
  c = config_of(t);
  c.geometry = RP_LINE_CONTACT;
  EXPECT_NE(refusal(c).find("line contact"), std::string::npos);
}

// Without a tangential problem the table is not looked at.
TEST(CreepTable, IsLeftOutWhereNotNeeded) {
  rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_TABLE);
  c.regime = RP_REGIME_NONE;
  scenes::handle contact(c);
  EXPECT_EQ(contact.step(scenes::patch_input(1e5, 1e-3, 0, 0)).status, RP_CONVERGED);
}

TEST(CreepTable, HandlesShareIt) {
  const tables::table t = tables::small(), copy = t;
  scenes::handle first(config_of(t)), second(config_of(t)), third(config_of(copy));
  for (double size : {1e-7, 1e-4, 3e-3, 1.0}) {
    const rp_input in = scenes::patch_input(9e4, size, -0.4 * size, 90 * size);
    const rp_result a = first.step(in), b = second.step(in), c = third.step(in);
    EXPECT_EQ(scenes::difference(a, b), "");
    EXPECT_EQ(scenes::difference(a, c), "");
    EXPECT_EQ(a.status, RP_CONVERGED);
  }
}

TEST(CreepTable, StatesOfOneTableDoNotFitAnother) {
  const tables::table t = tables::small();
  tables::table other = t;
  railpatch::creep_table_header h = other.header();
  h.radius = 3.0;
  other.set_header(h);
  scenes::handle contact(config_of(t)), same(config_of(t)), another(config_of(other));
  contact.step(scenes::patch_input(9e4, 1e-3, 0, 0));
  EXPECT_EQ(same.restore(contact.state()), RP_OK);
  EXPECT_EQ(another.restore(contact.state()), RP_ERROR_STATE);
}

// No creepage, no friction, creepages beyond all sense: always numbers, and never above the bound.
TEST(CreepTable, ExtremeInputsGiveNumbers) {
  const tables::table t = tables::small();
  for (double friction : {0.0, 1e-300, 0.3, 10.0}) {
    rp_config c = config_of(t);
    c.friction_coefficient = friction;
    scenes::handle contact(c);
    for (double size : {0.0, 5e-324, 1e-200, 1e-3, 1e10, 1e200, 1.7e308})
      for (double force : {1e-300, 1.0, 1e5, 1e300}) {
        const rp_result r = contact.step(scenes::patch_input(force, size, -size, size));
        const rp_patch_result &p = r.side[RP_RIGHT].patch[0];
        const double f = std::hypot(p.creep_force[0], p.creep_force[1]);
        EXPECT_LE(f, friction * force) << friction << " " << size << " " << force;
        EXPECT_TRUE(std::isfinite(p.spin_moment));
        EXPECT_GE(p.friction_power, 0.0);
      }
  }
}

// Far beyond saturation all slides, and the force keeps its direction for creepages of any size.
TEST(CreepTable, SlidingKeepsItsDirection) {
  const tables::table t = tables::small();
  scenes::handle contact(config_of(t));
  const auto force = [&](double size) {
    const rp_result r = contact.step(scenes::patch_input(1e5, size, -0.3 * size, 20 * size));
    return std::array{r.side[RP_RIGHT].patch[0].creep_force[0],
                      r.side[RP_RIGHT].patch[0].creep_force[1]};
  };
  const auto wanted = force(1e20);
  for (double size : {1e140, 1e160, 1e200, 1e306}) {
    EXPECT_NEAR(force(size)[0], wanted[0], 1e-9 * std::abs(wanted[0])) << size;
    EXPECT_NEAR(force(size)[1], wanted[1], 1e-9 * std::abs(wanted[1])) << size;
  }
}

// A table need not hold every Poisson's ratio.
TEST(CreepTable, KnowsItsPoissonRatios) {
  tables::table t = tables::small();
  railpatch::creep_table_header h = t.header();
  h.poisson_ratio[0] = 0.2;
  h.poisson_ratio[2] = 0.3;
  t.set_header(h);
  for (double ratio : {0.19, 0.2, 0.28, 0.3, 0.31}) {
    rp_config c = config_of(t);
    c.poisson_ratio[0] = c.poisson_ratio[1] = ratio;
    scenes::handle contact(c);
    const bool known = ratio >= 0.2 && ratio <= 0.3;
    EXPECT_EQ(contact.step(scenes::patch_input(1e5, 1e-3, 0, 0)).status,
              known ? RP_CONVERGED : RP_OUT_OF_RANGE)
        << ratio;
  }
}

// The rows of a grid stand for the ellipse of the same width and area.
TEST(CreepTable, StandsForContactsOfAnyShape) {
  const tables::table t = tables::small();
  const rp_input in = scenes::patch_input(1e5, 4e-4, 2e-4, 0.1);
  scenes::handle exact(config_of(t));
  const rp_result wanted = exact.step(in);
  rp_config c = config_of(t);
  c.normal = RP_NORMAL_HALF_SPACE;
  c.elements[0] = c.elements[1] = 64;
  scenes::handle contact(c);
  const rp_result r = contact.step(in);
  EXPECT_EQ(r.status, RP_CONVERGED);
  const double *f = r.side[RP_RIGHT].patch[0].creep_force;
  const double *w = wanted.side[RP_RIGHT].patch[0].creep_force;
  // elements in contact count as a whole, so that either axis may be too long by one of 64 at each
  // end; forces of small creepage grow with the product
  EXPECT_NEAR(f[0], w[0], 4.0 / 64.0 * std::abs(w[0]));
  EXPECT_NEAR(f[1], w[1], 4.0 / 64.0 * std::abs(w[1]));
  EXPECT_TRUE(contact.field(RP_RIGHT, 0, RP_FIELD_TRACTION).empty());
}

}  // namespace
