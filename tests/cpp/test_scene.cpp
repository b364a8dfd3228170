// What a configuration becomes: rules of grids, tolerances, laws and transforms of the scene.
#include <gtest/gtest.h>

#include <cmath>

#include "handle/scene_of.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;

// A wheel on rigid rail, without lateral strain: K/(1 - nu) = 1/2.
rp_config on_rigid(double friction) {
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  c.shear_modulus[1] = 1e30;
  c.poisson_ratio[0] = c.poisson_ratio[1] = 0;
  c.friction_coefficient = friction;
  return c;
}

// 1 + 2 e over the root of 1 - 4 e^2, with tan(pi e) half of the friction coefficient.
TEST(Scene, GridsOfUnlikeBodiesReachAsFarAsTheyStretch) {
  const auto reach = [](const rp_config &c) { return scene_of(c).single->grid.reach; };
  EXPECT_NEAR(reach(on_rigid(2 * std::tan(M_PI / 4))), 1.5 / std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(reach(on_rigid(2 * std::tan(M_PI / 6))), 4 / std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(reach(on_rigid(2 * std::tan(M_PI / 12))), (7.0 / 6) / std::sqrt(35.0 / 36), 1e-12);
  EXPECT_EQ(reach(on_rigid(0)), 1);
  // to where contacts are reported
  EXPECT_EQ(reach(on_rigid(10)), 2.5);
  // the other way round alike
  rp_config c = on_rigid(2);
  std::swap(c.shear_modulus[0], c.shear_modulus[1]);
  EXPECT_NEAR(reach(c), std::sqrt(3.0), 1e-12);
  // without traction nothing is stretched, and equal bodies stretch nothing
  c.regime = RP_REGIME_NONE;
  EXPECT_EQ(reach(c), 1);
  EXPECT_EQ(reach(scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL)), 1);
  const scenes::profile_pair pair;
  c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  EXPECT_EQ(scene_of(c).wheels->wheel[0].grid.reach, 1);
  c.shear_modulus[1] = 1e30;
  c.poisson_ratio[0] = c.poisson_ratio[1] = 0;
  c.friction_coefficient = 2;
  const scene found = scene_of(c);
  for (const wheel_setup &w : found.wheels->wheel) EXPECT_NEAR(w.grid.reach, std::sqrt(3.0), 1e-12);
}

// Where a force or the place of a rail is found, each evaluation is ten times as exact.
TEST(Scene, TolerancesLeaveRoomForTheSearch) {
  const scenes::profile_pair pair;
  for (const double tolerance : {1e-3, 1e-6, 1e-11, 1e-13}) {
    const double finer = std::max(tolerance / 10, 1e-12);
    rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
    c.tolerance = tolerance;
    c.load = RP_POSITION;
    scene s = scene_of(c);
    for (const double v : {s.tolerance, s.patch.tolerance, s.patch.normal_tolerance})
      EXPECT_EQ(v, tolerance);
    c.load = RP_FORCE;
    s = scene_of(c);
    EXPECT_EQ(s.tolerance, tolerance);
    EXPECT_EQ(s.patch.tolerance, tolerance);
    EXPECT_DOUBLE_EQ(s.patch.normal_tolerance, finer);
    for (const rp_load load : {RP_FORCE, RP_POSITION}) {
      c.load = load;
      c.rail_stiffness[0] = c.rail_stiffness[1] = 1e7;
      s = scene_of(c);
      EXPECT_EQ(s.tolerance, tolerance);
      EXPECT_DOUBLE_EQ(s.patch.tolerance, finer);
      EXPECT_DOUBLE_EQ(s.patch.normal_tolerance, finer);
    }
    c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
    c.tolerance = tolerance;
    c.load = RP_FORCE;
    EXPECT_EQ(scene_of(c).patch.normal_tolerance, tolerance);
  }
}

TEST(Scene, LawsHoldWhatTheyWereGiven) {
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  EXPECT_FALSE(scene_of(c).patch.law);
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.2;
  c.friction_memory_distance = 1e-3;
  c.friction_memory_speed = 0.02;
  for (int i = 0; i < 2; ++i) {
    c.friction_amplitude[i] = 0.1 + 0.05 * i;
    c.friction_halving_speed[i] = 3.0 + i;
  }
  const auto law = [&] { return scene_of(c).patch.law.value(); };
  EXPECT_TRUE(law().by_velocity);
  EXPECT_EQ(law().slip.kinetic, 0.2);
  EXPECT_EQ(law().slip.memory_distance, 1e-3);
  EXPECT_EQ(law().slip.memory_speed, 0.02);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(law().slip.amplitude[i], c.friction_amplitude[i]);
    EXPECT_EQ(law().slip.halving_speed[i], c.friction_halving_speed[i]);
  }
  EXPECT_FALSE(law().plastic());
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 1e9;
  c.layer_yield_stress = 1e8;
  c.layer_hardening = 1e12;
  double slope = 0;
  EXPECT_DOUBLE_EQ(law().yield.at(1e-5, slope), 1.1e8);
  EXPECT_EQ(slope, 1e12);
  c.hardening_points = 3;
  for (int i = 0; i < 3; ++i) {
    c.hardening_displacement[i] = 1e-5 * i * i;
    c.hardening_stress[i] = 1e8 * (1 + i);
  }
  EXPECT_DOUBLE_EQ(law().yield.at(2.5e-5, slope), 2.5e8);
  EXPECT_EQ(law().yield.at(1, slope), 3e8);
  EXPECT_EQ(slope, 0);
  EXPECT_DOUBLE_EQ(scene_of(c).patch.layer_flexibility, 1e-13);
}

}  // namespace
