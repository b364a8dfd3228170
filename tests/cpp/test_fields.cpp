// What a result says of a patch is what its fields say: numbers of elements, greatest pressure,
// area, forces and moments are sums over the elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes.hpp"

namespace {

using scenes::handle;

struct scene {
  std::string name;
  rp_config config;
  rp_input input;
};

std::vector<scene> all_scenes() {
  const rp_input in = scenes::patch_input(1e5, 1e-3, -5e-4, 0.3);
  std::vector<scene> all;
  const auto add = [&](const char *name, const rp_config &c) { all.push_back({name, c, in}); };
  const auto full = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 15);
  add("full", full);
  add("full on Hertz", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL, 15));
  add("fastsim", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTSIM, 15));
  add("fastrip", scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTRIP, 15));
  for (int nodes : {8, 13}) {
    rp_config c = full;
    c.fitted[0] = nodes;
    c.fitted[1] = nodes - 1;
    add("fitted rows", c);
  }
  rp_config c = full;
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 1e9;
  c.layer_yield_stress = 1e8;
  add("plastic layer", c);
  c = full;
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.2;
  c.friction_amplitude[0] = 0.15;
  add("falling friction", c);
  add("transient", scenes::heated_patch(RP_TRANSIENT_ROLLING, 15));
  all.back().input.distance = 1e-3;
  c = full;
  c.regime = RP_SHIFT;
  add("shift", c);
  all.back().input.creepage[0] = 2e-5;
  all.back().input.creepage[1] = -1e-5;
  all.back().input.spin_creepage = 1e-3;
  return all;
}

// A wheel that no grid holds has no fields, whatever heights the search for its load went through.
TEST(Fields, OfAWheelBeyondItsGridAreNone) {
  const scenes::profile_pair pair;
  for (const rp_kind kind : {RP_WHEEL_RAIL, RP_WHEELSET})
    for (const int most : {22, 0}) {
      SCOPED_TRACE(std::to_string(kind) + " " + std::to_string(most));
      rp_config c = scenes::wheels(kind, RP_RAIL, pair);
      c.load = RP_FORCE;
      c.max_elements[0] = c.max_elements[1] = most;
      handle h(c);
      rp_input in = scenes::running(RP_RAIL);
      bool beyond = false;
      for (double force = 1e3; force < 2e7; force *= 3) {
        in.vertical_force = force;
        const rp_result r = h.step(in);
        for (int side = 0; side < 2; ++side)
          for (int i = 0; i < RP_MAX_PATCHES; ++i) {
            const rp_patch_result &p = r.side[side].patch[i];
            const size_t nx = static_cast<size_t>(p.grid[0]), ny = static_cast<size_t>(p.grid[1]);
            EXPECT_EQ(h.field(side, i, RP_FIELD_X).size(), nx) << force;
            EXPECT_EQ(h.field(side, i, RP_FIELD_PRESSURE).size(), nx * ny) << force;
            beyond |= p.status == RP_OUT_OF_RANGE && nx == 0;
          }
      }
      EXPECT_TRUE(beyond);
    }
}

TEST(Fields, AddUpToTheResult) {
  for (const scene &s : all_scenes()) {
    SCOPED_TRACE(s.name);
    handle h(s.config);
    h.step(s.input);
    const rp_result result = h.step(s.input);
    ASSERT_EQ(result.status, RP_CONVERGED);
    const rp_patch_result &r = result.side[RP_RIGHT].patch[0];
    const std::vector<double> p = h.field(RP_RIGHT, 0, RP_FIELD_PRESSURE);
    const std::vector<double> t = h.field(RP_RIGHT, 0, RP_FIELD_TRACTION);
    const std::vector<double> division = h.field(RP_RIGHT, 0, RP_FIELD_ELEMENT_DIVISION);
    const std::vector<double> x = h.field(RP_RIGHT, 0, RP_FIELD_X);
    const std::vector<double> y = h.field(RP_RIGHT, 0, RP_FIELD_Y);
    const auto n = static_cast<size_t>(r.grid[0] * r.grid[1]);
    ASSERT_EQ(division.size(), n);
    ASSERT_EQ(p.size(), n);
    ASSERT_EQ(t.size(), 2 * n);
    for (int state : {RP_EXTERIOR, RP_STICK, RP_SLIP, RP_PLASTIC})
      EXPECT_EQ(std::count(division.begin(), division.end(), state), r.elements[state]) << state;
    EXPECT_GT(r.elements[RP_STICK] + r.elements[RP_SLIP] + r.elements[RP_PLASTIC], 0);
    for (size_t i = 0; i < n; ++i) {
      EXPECT_EQ(static_cast<int>(division[i]) == RP_EXTERIOR, !(p[i] > 0)) << i;
      if (!(p[i] > 0)) {
        EXPECT_EQ(std::hypot(t[i], t[n + i]), 0.0) << i;
      }
    }
    const double area = r.element_size[0] * r.element_size[1];
    if (!(area > 0)) continue;
    double load = 0, force[2] = {0, 0}, moment = 0, absolute = 0;
    for (size_t i = 0; i < n; ++i) {
      load += area * p[i];
      for (size_t c = 0; c < 2; ++c) force[c] += area * t[c * n + i];
      const size_t column = i % static_cast<size_t>(r.grid[0]);
      const size_t row = i / static_cast<size_t>(r.grid[0]);
      moment += area * (x[column] * t[n + i] - y[row] * t[i]);
      absolute += area * std::hypot(t[i], t[n + i]);
    }
    EXPECT_NEAR(load, r.normal_force, 1e-4 * load);
    EXPECT_NEAR(moment, r.spin_moment, 1e-9 * absolute * (x.back() - x.front()));
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(force[c], r.creep_force[c], 1e-9 * absolute);
    if (s.config.normal != RP_NORMAL_HALF_SPACE) continue;
    EXPECT_EQ(*std::max_element(p.begin(), p.end()), r.max_pressure);
    const auto touching = std::count_if(p.begin(), p.end(), [](double v) { return v > 0; });
    EXPECT_NEAR(static_cast<double>(touching) * area, r.contact_area, 1e-12 * r.contact_area);
  }
}

// On a curved surface the rows of a wheel lie one after the other along its section, each chord at
// its rows' mean angle, and about the patch's own place.
TEST(Fields, RowsOfACurvedSurfaceFollowItsAngle) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  c.reference_surface = RP_REFERENCE_CURVED;
  c.element_size[0] = c.element_size[1] = 2e-3;
  scenes::handle h(c);
  const rp_result result = h.step(scenes::running(RP_RAIL));
  for (const int side : {RP_LEFT, RP_RIGHT}) {
    const rp_patch_result &p = result.side[side].patch[0];
    ASSERT_EQ(p.status, RP_CONVERGED);
    const auto place = h.field(side, 0, RP_FIELD_ROW_POSITION);
    const auto angle = h.field(side, 0, RP_FIELD_ROW_ANGLE), y = h.field(side, 0, RP_FIELD_Y);
    const auto rows = static_cast<size_t>(p.grid[1]);
    ASSERT_EQ(place.size(), 2 * rows);
    ASSERT_EQ(angle.size(), rows);
    for (size_t j = 0; j + 1 < rows; ++j) {
      const double dy = place[j + 1] - place[j], dz = place[rows + j + 1] - place[rows + j];
      const double bend = angle[j + 1] - angle[j], size = p.element_size[1];
      EXPECT_NEAR(std::hypot(dy, dz) / size, 1, 0.1 * std::fabs(bend) + 1e-12) << j;
      EXPECT_NEAR(std::atan2(dz, dy), 0.5 * (angle[j] + angle[j + 1]),
                  0.1 * std::fabs(bend) + 1e-12)
          << j;
      // the origin of y is the patch's place, up to the depth that the bodies are pressed in
      if (y[j] > 0 || y[j + 1] <= 0) continue;
      const double share = -y[j] / (y[j + 1] - y[j]);
      EXPECT_NEAR(place[j] + share * dy, p.position[1], 1e-4);
      EXPECT_NEAR(place[rows + j] + share * dz, p.position[2], 1e-4);
    }
  }
}

}  // namespace
