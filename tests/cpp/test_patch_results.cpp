// What a patch's result says where nothing touches, of laws that it does not have, and of its grid.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "patch/patch_scene.hpp"
#include "patch/result_fields.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;

bound_law yielding() {
  bound_law law;
  law.yield = hardening_curve::straight(1e8, 0);
  return law;
}

TEST(PatchResults, WhereNothingTouchesForcesAreZero) {
  for (const bool rolls : {false, true})
    for (const bool yields : {false, true}) {
      SCOPED_TRACE(testing::Message() << rolls << yields);
      patch_scene scene;
      scene.tangential = rolls ? RP_TANGENTIAL_FULL : RP_TANGENTIAL_NONE;
      if (yields) scene.law = yielding();
      rp_patch_result r;
      for_each_patch_number(r, [](double &v) { v = 7; });
      for (double &v : r.error_estimate) v = 7;
      r.grid[0] = r.elements[RP_EXTERIOR] = 7;
      set_unloaded(scene, r);
      for (const double v :
           {r.normal_force, r.max_pressure, r.contact_area, r.elastic_energy, r.error_estimate[2]})
        EXPECT_EQ(v, 0);
      for (const double v : {r.creep_force[0], r.creep_force[1], r.spin_moment, r.friction_power,
                             r.creep_power, r.error_estimate[0], r.error_estimate[1]})
        EXPECT_EQ(v, rolls ? 0 : 7);
      EXPECT_EQ(r.plastic_power, rolls && yields ? 0 : 7);
      // where it lies, how it moves and on what grid is as it was
      for (const double v :
           {r.position[0], r.position[2], r.contact_angle, r.creepage[0], r.creepage[1],
            r.spin_creepage, r.rolling_speed, r.share, r.element_size[1], r.max_temperature})
        EXPECT_EQ(v, 7);
      EXPECT_EQ(r.grid[0], 7);
      EXPECT_EQ(r.elements[RP_EXTERIOR], 7);
    }
}

TEST(PatchResults, CoulombsLawHasOneSolution) {
  for (const rp_tangential_method method : {RP_TANGENTIAL_FULL, RP_TANGENTIAL_FASTSIM}) {
    scenes::handle h(scenes::patch(RP_NORMAL_HERTZ, method));
    const rp_result result = h.step(scenes::patch_input(8e4, 1e-3, 2e-4, 0.1));
    const rp_patch_result &r = result.side[RP_RIGHT].patch[0];
    ASSERT_EQ(r.status, RP_CONVERGED);
    EXPECT_EQ(r.ambiguous_elements, 0);
    EXPECT_EQ(r.elements[RP_PLASTIC], 0);
    EXPECT_TRUE(std::isnan(r.plastic_power));
    EXPECT_EQ(r.outer_iterations, 0);
    EXPECT_EQ(r.elements[RP_EXTERIOR] + r.elements[RP_STICK] + r.elements[RP_SLIP],
              r.grid[0] * r.grid[1]);
  }
}

// Pressures and area are those of elements as they were given.
TEST(PatchResults, GivenHeightsAreOnTheGridOfTheirElements) {
  constexpr int nx = 21, ny = 17;
  constexpr double size[2] = {8e-4, 1.1e-3};
  std::vector<double> heights;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = size[0] * (i - 10), y = size[1] * (j - 8);
      heights.push_back(1.1 * x * x + 1.4 * y * y);
    }
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE);
  c.elements[0] = c.elements[1] = 0;
  for (int k = 0; k < 2; ++k) c.element_size[k] = size[k];
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.undeformed_distance = heights.data();
  c.distance_shape[0] = nx;
  c.distance_shape[1] = ny;
  scenes::handle h(c);
  const rp_result result = h.step(scenes::patch_input(5e4, 0, 0, 0));
  const rp_patch_result &r = result.side[RP_RIGHT].patch[0];
  ASSERT_EQ(r.status, RP_CONVERGED);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(r.element_size[k], size[k]);
    EXPECT_EQ(r.grid[k], k == 0 ? nx : ny);
    EXPECT_DOUBLE_EQ(r.grid_origin[k], -0.5 * (r.grid[k] - 1) * size[k]);
  }
  double sum = 0;
  int touching = 0;
  for (const double p : h.field(RP_RIGHT, 0, RP_FIELD_PRESSURE)) sum += p, touching += p > 0;
  EXPECT_GT(touching, 20);
  EXPECT_NEAR(sum * size[0] * size[1], 5e4, 5e4 * 1e-9);
  EXPECT_NEAR(r.contact_area, touching * size[0] * size[1], 1e-12);
}

}  // namespace
