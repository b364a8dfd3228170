// What a patch's result says where nothing touches, of laws that it does not have, and of its grid.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "normal/hertz.hpp"
#include "patch/patch_scene.hpp"
#include "patch/patch_workspace.hpp"
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
// Nothing rolls: no micro-slip has happened, whatever is asked for.
TEST(PatchResults, AtStandstillThereAreNoTractions) {
  for (const rp_tangential_method method : {RP_TANGENTIAL_FULL, RP_TANGENTIAL_FASTSIM}) {
    scenes::handle h(scenes::patch(RP_NORMAL_HALF_SPACE, method));
    rp_input in = scenes::patch_input(8e4, 1e-3, 2e-4, 0.1);
    in.rolling_speed = 0;
    const rp_result result = h.step(in);
    const rp_patch_result &r = result.side[RP_RIGHT].patch[0];
    ASSERT_EQ(r.status, RP_CONVERGED);
    EXPECT_GT(r.normal_force, 0);
    for (const double v : {r.creep_force[0], r.creep_force[1], r.spin_moment, r.friction_power})
      EXPECT_EQ(v, 0);
    EXPECT_EQ(r.elements[RP_SLIP], 0);
  }
}

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

// What is left behind is as warm as the warmer body.
TEST(PatchResults, WhereNothingTouchesTheSurfacesAreAsTheirBodies) {
  for (const bool rail_warmer : {false, true}) {
    patch_scene scene;
    scene.heat.emplace();
    scene.heat->bodies.body[rail_warmer].bulk = 80;
    scene.heat->bodies.body[!rail_warmer].bulk = 20;
    rp_patch_result r{};
    set_unloaded(scene, r);
    EXPECT_EQ(r.max_temperature, 80);
  }
}

// The error of forces was measured for each theory as it is published, with Coulomb's constant
// coefficient in steady rolling by given creepages, and for no other.
TEST(PatchResults, ErrorsOfForcesAreEstimatedWhereTheyWereMeasured) {
  const auto estimates = [](auto change, rp_tangential_method method = RP_TANGENTIAL_FASTSIM) {
    patch_scene scene;
    scene.normal = RP_NORMAL_HERTZ;
    scene.tangential = method;
    scene.fast.blending = RP_BLENDING_SLIDING;
    scene.fast.bound = RP_BOUND_AUTOMATIC;
    change(scene);
    return scene.estimates_force();
  };
  for (const rp_tangential_method method :
       {RP_TANGENTIAL_FULL, RP_TANGENTIAL_FASTSIM, RP_TANGENTIAL_POLACH, RP_TANGENTIAL_TABLE}) {
    const auto refuses = [&](auto change) { EXPECT_FALSE(estimates(change, method)) << method; };
    EXPECT_TRUE(estimates([](patch_scene &) {}, method)) << method;
    refuses([](patch_scene &s) { s.usual_spin = false; });
    refuses([](patch_scene &s) { s.prescribed[1] = true; });
    refuses([](patch_scene &s) { s.law = yielding(); });
    refuses([](patch_scene &s) {
      s.heat.emplace();
      s.heat->by_temperature = true;
    });
    // temperatures alone change nothing
    EXPECT_TRUE(estimates([](patch_scene &s) { s.heat.emplace(); }, method)) << method;
  }
  for (const motion regime : {motion::shift, motion::transient})
    EXPECT_FALSE(estimates([&](patch_scene &s) { s.regime = regime; }, RP_TANGENTIAL_FULL));
  const auto fast_refuses = [&](auto change) { EXPECT_FALSE(estimates(change)); };
  fast_refuses([](patch_scene &s) { s.fast.coefficient_factor = 0.9; });
  fast_refuses([](patch_scene &s) { s.fast.polach.adhesion = 0.5; });
  fast_refuses([](patch_scene &s) { s.fast.polach.slip = 0.5; });
  fast_refuses([](patch_scene &s) { s.fast.reduction.k0 = 0.5; });
  fast_refuses([](patch_scene &s) { s.fast.reduction.alpha = s.fast.reduction.beta = 0.5; });
  fast_refuses([](patch_scene &s) { s.fast.bound = RP_BOUND_PARABOLIC; });
  for (const rp_normal_method normal :
       {RP_NORMAL_HALF_SPACE, RP_NORMAL_KIK_PIOTROWSKI, RP_NORMAL_ANALYN}) {
    const auto other = [&](patch_scene &s) { s.normal = normal; };
    EXPECT_TRUE(estimates(other));
    EXPECT_FALSE(estimates(other, RP_TANGENTIAL_TABLE));
  }
}

// Hertz's strip of any width: an area, but no approach of half-spaces.
TEST(PatchResults, LineContactsHaveAStripsArea) {
  for (const double width : {0.02, 0.7, 3.0}) {
    rp_config c = scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_NONE);
    c.geometry = RP_LINE_CONTACT;
    c.line_contact_radius = 0.25;
    c.width = width;
    c.elements[1] = 1;
    scenes::handle h(c);
    const double force = 4e6 * width;
    const rp_patch_result r = h.step(scenes::patch_input(force, 0, 0, 0)).side[RP_RIGHT].patch[0];
    ASSERT_EQ(r.status, RP_CONVERGED);
    double compliance = 0;
    for (int k = 0; k < 2; ++k) compliance += 0.5 * (1 - c.poisson_ratio[k]) / c.shear_modulus[k];
    // a^2 = 4 F' R/(pi E*), 1/E* the sum of both bodies' (1 - nu)/(2 G) (Johnson 1985, eq. 4.43)
    const double a = std::sqrt(4 * force / width * 0.25 * compliance / std::acos(-1.0));
    EXPECT_NEAR(r.contact_area, 2 * a * width, 1e-12 * r.contact_area);
    EXPECT_TRUE(std::isnan(r.approach) && std::isnan(r.elastic_energy));
  }
}

// A strip's pressure moves unlike surfaces by K/(2 G) of it on either side, apart from each other:
// from element to element the slip is K/G times the mean of both, twice, whatever the width.
TEST(PatchResults, UnlikeStripsSlipByTheirPressure) {
  const double moduli[2] = {20e9, 82e9}, ratios[2] = {0.2, 0.28};
  for (const double width : {0.01, 4.0}) {
    patch_scene scene;
    scene.elastic = combine(moduli, ratios);
    scene.line_width = width;
    const grid g{12, 1, 1e-3, width, -5.5e-3, 0};
    const fft_plans plans({smooth_size(2 * g.nx + 1)}, {1});
    patch_workspace shared(scene, {}, plans, g.count());
    ASSERT_TRUE(shared.coupled.has_value());
    std::vector<double> p, none(12, 0.0), far(12, 0.0);
    for (int i = 0; i < 12; ++i) p.push_back(1e7 * (1 + std::sin(i)));
    shared.coupled->begin(g, far.data(), none.data(), none.data());
    rolling_input rolling{{0, 0}, 0.0, 1, 0.0, nullptr};
    rolling.regime = motion::steady;
    shared.coupled->set_slip(p.data(), rolling);
    const double factor = scene.elastic.mismatch / scene.elastic.shear_modulus;
    for (int i = 0; i < 11; ++i) {
      const auto at = static_cast<size_t>(i);
      EXPECT_NEAR(shared.coupled->slip(0)[i], factor * (p[at] + p[at + 1]),
                  1e-10 * std::fabs(factor) * 4e7);
      EXPECT_NEAR(shared.coupled->slip(1)[i], 0, 1e-10 * std::fabs(factor) * 4e7);
    }
    // the gap's error is what the tractions move, over the scale
    std::vector<double> moved(12);
    coupling_influence direct(scene.elastic, true, plans);
    ASSERT_TRUE(direct.set_grid(g));
    direct.from_traction(p.data(), none.data(), moved.data());
    double most = 0;
    for (const double u : moved) most = std::max(most, std::fabs(u));
    for (const double scale : {1e-6, 3e-5, 2.0}) {
      shared.coupled->set_scale(scale);
      const double error = shared.coupled->error(p.data(), p.data(), none.data(), false);
      EXPECT_NEAR(error, most / scale, 1e-10 * most / scale);
    }
  }
}

}  // namespace
