// How large grids are: margins of unlike bodies, and what Kik and Piotrowski's theory needs.
#include "patch/patch_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes.hpp"

namespace {

using namespace railpatch;

constexpr double modulus = 1.1e11;  // Pa, G/(1 - nu)

TEST(GridRules, MarginsReachAsFarAsTheContactMay) {
  grid_rules rules;
  for (const int n : {2, 7, 1000, 1100}) EXPECT_EQ(rules.with_margin(n), n);
  // the least on either side that covers `reach` times the contact
  for (const double reach : {1.001, 1.125, 1.3, 2.5}) {
    rules.reach = reach;
    for (int n = 2; n <= 400; ++n) {
      const int wide = rules.with_margin(n);
      EXPECT_EQ((wide - n) % 2, 0) << n;
      EXPECT_GE(wide, reach * n * (1 - 1e-12)) << n;
      EXPECT_LT(wide - 2, reach * n * (1 + 1e-12)) << n;
    }
    // up to the most that grids are made of, but not less than the contact itself
    EXPECT_EQ(rules.with_margin(999), 1000);
    EXPECT_EQ(rules.with_margin(1000), 1000);
    EXPECT_EQ(rules.with_margin(1100), 1100);
  }
}

TEST(GridRules, OtherTheoriesNeedHertzsEllipse) {
  const double curvatures[2] = {1.1, 3.2};
  const hertz_contact hertz = hertz_from_force(curvatures, modulus, 1e5);
  for (const bool force : {false, true}) {
    grid_rules rules;
    rules.force_given = force;
    for (int k = 0; k < 2; ++k) EXPECT_EQ(rules.relative_size(hertz, k), 1);
  }
}

// Its region is where the undeformed paraboloid lies within 0.55 of the approach; the contact is an
// ellipse of the same area with Hertz's axis ratio. At equal force the approach is the one at which
// that ellipse carries it: the ellipse is s times Hertz's at equal approach, and so is its force,
// which grows with the power 3/2 of the approach, the sizes with the power 1/2.
TEST(GridRules, KikAndPiotrowskisCoversItsRegionAndItsContact) {
  grid_rules rules;
  rules.interpenetrates = true;
  for (const double b : {0.2, 1.1, 3.2, 20.0}) {
    const double curvatures[2] = {1.1, b};
    const hertz_contact hertz = hertz_from_force(curvatures, modulus, 1e5);
    double region[2], s = 1;
    for (int k = 0; k < 2; ++k) region[k] = std::sqrt(0.55 * hertz.approach / curvatures[k]);
    s = std::sqrt(region[0] * region[1] / (hertz.semi_axes[0] * hertz.semi_axes[1]));
    // of the approach at which the force is Hertz's
    const double less = std::pow(1 / s, 2.0 / 3);
    for (int k = 0; k < 2; ++k) {
      const double needed = std::max(region[k], s * hertz.semi_axes[k]) / hertz.semi_axes[k];
      rules.force_given = false;
      EXPECT_NEAR(rules.relative_size(hertz, k), needed, 1e-12 * needed) << b;
      rules.force_given = true;
      EXPECT_NEAR(rules.relative_size(hertz, k), std::sqrt(less) * needed, 1e-12 * needed) << b;
    }
  }
}

rp_config with_room_for(int along, int across) {
  rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL);
  c.geometry = RP_CURVATURES;
  c.curvatures[0] = 0.3;
  c.curvatures[1] = 3;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  c.max_elements[0] = along;
  c.max_elements[1] = across;
  return c;
}

// Steps that remember have the whole grid from the first on. Hertz's ellipse has to lie on it.
TEST(PatchGrids, OfStepsAreAsLargeAsTheyMayBe) {
  rp_config c = with_room_for(24, 40);
  c.regime = RP_TRANSIENT_ROLLING;
  scenes::handle h(c);
  rp_input in = scenes::patch_input(1e4, 1e-3, 0, 0);
  in.distance = 1e-3;
  const double stiffness = c.shear_modulus[0] / (1 - c.poisson_ratio[0]);
  bool too_long = false;
  for (double force = 1e4; force < 3e6; force *= 2) {
    in.normal_force = force;
    const hertz_contact hertz = hertz_from_force(c.curvatures, stiffness, force);
    if (2 * hertz.semi_axes[1] > 22e-3) break;
    const rp_patch_result r = h.step(in).side[RP_RIGHT].patch[0];
    if (2 * hertz.semi_axes[0] > 24e-3) {
      EXPECT_EQ(r.status, RP_OUT_OF_RANGE) << force;
      too_long = true;
      continue;
    }
    EXPECT_NE(r.status, RP_OUT_OF_RANGE) << force;
    EXPECT_EQ(r.grid[0], 24);
    EXPECT_EQ(r.grid[1], 40);
  }
  EXPECT_TRUE(too_long);
}

// The same of an ellipse given by its semi-axes, whose grid needs no capacity to be known.
TEST(PatchGrids, OfStepsOnAnEllipseAreWhatTheyMayBe) {
  for (const rp_regime regime : {RP_SHIFT, RP_TRANSIENT_ROLLING, RP_STEADY_ROLLING})
    for (const int along : {0, 28, 40})
      for (const int across : {0, 30}) {
        rp_config c = with_room_for(along, across);
        c.geometry = RP_SEMI_AXES;
        c.element_size[0] = c.element_size[1] = 5e-4;
        c.regime = regime;
        scenes::handle h(c);
        rp_input in = scenes::patch_input(1e5, 1e-6, 0, 0);
        if (regime == RP_TRANSIENT_ROLLING) in.distance = 1e-3;
        for (int k = 0; k < 2; ++k) {
          const rp_patch_result r = h.step(in).side[RP_RIGHT].patch[0];
          EXPECT_EQ(r.status, RP_CONVERGED);
          // 24 elements across 12 mm and one free on either side
          const bool steady = regime == RP_STEADY_ROLLING;
          EXPECT_EQ(r.grid[0], steady || along == 0 ? 26 : along);
          EXPECT_EQ(r.grid[1], steady || across == 0 ? 26 : across);
          EXPECT_NEAR(r.grid_origin[0], -0.5 * (r.grid[0] - 1) * 5e-4, 1e-12);
          EXPECT_NEAR(r.grid_origin[1], -0.5 * (r.grid[1] - 1) * 5e-4, 1e-12);
        }
      }
}

// An ellipse does not fit less than it needs; more than that is not kept for it.
TEST(PatchGrids, OfAnEllipseKeepWithinTheirCapacity) {
  const auto bytes = [](const rp_config &c) {
    const scenes::handle h(c);
    rp_stage_info stages[RP_STAGE_COUNT];
    EXPECT_EQ(rp_describe(h.get(), stages), RP_OK);
    return stages[RP_STAGE_GEOMETRY].bytes;
  };
  rp_config c = with_room_for(0, 0);
  c.geometry = RP_SEMI_AXES;
  c.element_size[0] = c.element_size[1] = 5e-4;
  const size_t chosen = bytes(c);
  c.max_elements[0] = c.max_elements[1] = 200;
  EXPECT_EQ(bytes(c), chosen);
  c.max_elements[1] = 25;
  scenes::handle h(c);
  EXPECT_EQ(h.step(scenes::patch_input(1e5, 1e-6, 0, 0)).status, RP_OUT_OF_RANGE);
}

// The margins of unlike bodies take what room there is, along and across.
TEST(PatchGrids, MarginsKeepWithinTheRoom) {
  for (const bool turned : {false, true}) {
    rp_config c = turned ? with_room_for(90, 20) : with_room_for(20, 90);
    c.normal = RP_NORMAL_HALF_SPACE;
    c.shear_modulus[1] = 1e9;
    c.friction_coefficient = 1;
    c.curvatures[0] = c.curvatures[1] = 1;
    const double g = 2 / (1 / c.shear_modulus[0] + 1 / c.shear_modulus[1]);
    const double nu =
        0.5 * g *
        (c.poisson_ratio[0] / c.shear_modulus[0] + c.poisson_ratio[1] / c.shear_modulus[1]);
    // 17 elements across and one free on either side leave room for one more
    double force = 1;
    while (2e3 * hertz_from_force(c.curvatures, g / (1 - nu), force).semi_axes[0] < 16.5)
      force *= 1.02;
    scenes::handle h(c);
    const rp_patch_result r = h.step(scenes::patch_input(force, 0, 0, 0)).side[RP_RIGHT].patch[0];
    ASSERT_EQ(r.status, RP_CONVERGED);
    EXPECT_EQ(r.grid[turned], 20);
    EXPECT_GT(r.grid[!turned], 20);
    EXPECT_LE(r.grid[!turned], 90);
  }
}

}  // namespace
