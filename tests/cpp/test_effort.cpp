// What a solution costs: iterations of every solver, as means over seeded samples of states, stay
// within a budget. A start that misses, a preconditioner that does not fit or a step that is cut
// too short changes no result, but shows here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>

#include "scenes.hpp"

namespace {

using scenes::handle;

struct effort {
  double normal = 0, newton = 0, inner = 0, outer = 0, evaluations = 0;
};

// what is needed, on average
struct needed {
  const char *name;
  effort mean;
};
constexpr needed of_patches[] = {
    {"cold_16", {5.0, 4.5, 28.2, 0.0}},
    {"cold_33", {6.0, 5.5, 38.5, 0.0}},
    {"cold_64", {7.0, 3.9, 34.8, 0.0}},
    {"warm_24", {0.2, 4.9, 33.7, 0.0}},
    {"position_24", {5.0, 4.6, 28.6, 0.0}},
    {"exact_24", {11.0, 7.5, 57.1, 0.0}},
    {"force_x", {5.0, 4.3, 29.6, 0.0}},
    {"force_y", {5.0, 4.1, 28.0, 0.0}},
    {"force", {5.0, 4.1, 27.6, 0.0}},
    {"force_warm", {0.2, 4.1, 28.5, 0.0}},
    {"fitted", {5.0, 6.0, 31.7, 0.0}},
    {"fitted_warm", {0.2, 6.0, 35.1, 0.0}},
    {"fitted_force", {5.0, 5.7, 32.0, 0.0}},
    {"falling", {5.0, 4.4, 32.7, 0.0}},
    {"falling_warm", {0.2, 4.3, 32.2, 0.0}},
    {"falling_force", {5.0, 3.7, 29.1, 0.0}},
    {"memory", {5.0, 4.3, 32.8, 0.0}},
    {"plastic", {5.0, 2.7, 11.3, 0.0}},
    {"plastic_hardening", {5.0, 2.8, 11.5, 0.0}},
    {"plastic_magnitude", {5.0, 2.9, 11.8, 0.0}},
    {"plastic_transient", {0.2, 2.3, 9.8, 0.0}},
    {"plastic_transient_magnitude", {0.2, 2.3, 9.8, 0.0}},
    {"softening_shift", {0.2, 2.9, 10.2, 0.0}},
    {"transient", {0.2, 4.5, 41.5, 0.0}},
    {"shift", {0.2, 5.4, 36.7, 0.0}},
    {"unlike", {13.0, 11.9, 81.7, 3.9}},
    {"heated", {0.0, 11.4, 74.9, 3.9}},
    {"heated_transient", {0.0, 7.4, 62.6, 2.4}},
    {"analyn", {1.0, 0.0, 0.0, 0.0}},
    {"kik_piotrowski", {3.0, 0.0, 0.0, 0.0}},
};

// a twentieth more: other compilers and transforms round differently; sanitizers look at fewer
// states, which have other means
void expect_within(const effort &mean, const effort &budget) {
  if (scenes::sanitized) return;
  const auto expect = [](const char *what, double found, double most) {
    EXPECT_LE(found, 1.05 * most + 0.1) << what;
  };
  expect("normal", mean.normal, budget.normal);
  expect("newton", mean.newton, budget.newton);
  expect("inner", mean.inner, budget.inner);
  expect("outer", mean.outer, budget.outer);
  expect("evaluations", mean.evaluations, budget.evaluations);
}

struct family {
  std::string name;
  rp_config config;
  bool cold;  // each state from none, else from the one before
};

void PrintTo(const family &f, std::ostream *out) { *out << f.name; }

// Creepages from a tenth to four times those of full sliding, spin at most twice.
rp_input random_input(const rp_config &c, std::mt19937_64 &random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double size = 1e-3 * std::exp(uniform(std::log(0.1), std::log(4.0)));
  const double angle = uniform(-3.14, 3.14);
  rp_input in = scenes::patch_input(uniform(5e4, 1.2e5), size * std::cos(angle),
                                    size * std::sin(angle), uniform(-0.4, 0.4));
  if (c.force_prescribed[0] || c.force_prescribed[1]) {
    in = scenes::forced_input(in.normal_force, uniform(0.1, 0.9), angle, in.spin_creepage);
    for (int k = 0; k < 2; ++k)
      if (!c.force_prescribed[k]) in.tangential_force[k] = 0;
  }
  if (c.regime == RP_SHIFT) {
    for (double &v : in.creepage) v *= 1e-2;
    in.spin_creepage *= 1e-2;
  }
  if (c.regime == RP_TRANSIENT_ROLLING) in.distance = uniform(2e-4, 2e-3);
  in.rolling_speed = 20;
  in.approach = 1e-9 * std::pow(in.normal_force, 2.0 / 3.0) * 25;
  return in;
}

std::vector<family> families() {
  std::vector<family> all;
  const auto add = [&](const char *name, const rp_config &c, bool cold) {
    all.push_back({name, c, cold});
  };
  const auto full = [](int n) {
    return scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, n);
  };
  add("cold_16", full(16), true);
  add("cold_33", full(33), true);
  add("cold_64", full(64), true);
  add("warm_24", full(24), false);
  rp_config c = full(24);
  c.load = RP_POSITION;
  add("position_24", c, true);
  c = full(24);
  c.semi_axes[0] = 2 * c.semi_axes[1];
  c.tolerance = 1e-9;
  add("exact_24", c, true);
  for (int which = 1; which < 4; ++which) {
    c = full(20);
    c.force_prescribed[0] = which & 1;
    c.force_prescribed[1] = which >> 1;
    add(which == 1 ? "force_x" : which == 2 ? "force_y" : "force", c, true);
  }
  add("force_warm", c, false);
  c = full(20);
  c.fitted[0] = 16;
  c.fitted[1] = 15;
  add("fitted", c, true);
  add("fitted_warm", c, false);
  add("fitted_force", scenes::forced_patch(14), true);
  c = full(20);
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.2;
  c.friction_amplitude[0] = 0.1;
  add("falling", c, true);
  add("falling_warm", c, false);
  c.force_prescribed[0] = 1;
  add("falling_force", c, true);
  c.force_prescribed[0] = 0;
  c.friction_memory_distance = 1e-3;
  add("memory", c, true);
  c = full(20);
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 1e9;
  c.layer_yield_stress = 1e8;
  add("plastic", c, true);
  c.layer_hardening = 1e13;
  add("plastic_hardening", c, true);
  c.layer_yield_stress = 2.2e8;
  c.layer_hardening = 1e12;
  c.plastic_rule = RP_PLASTIC_MAGNITUDE;
  add("plastic_magnitude", c, true);
  c = full(20);
  c.layer_thickness = 1e-4;
  c.layer_shear_modulus = 1e9;
  c.layer_yield_stress = 1e8;
  c.layer_hardening = 1e13;
  c.regime = RP_TRANSIENT_ROLLING;
  add("plastic_transient", c, false);
  c.plastic_rule = RP_PLASTIC_MAGNITUDE;
  add("plastic_transient_magnitude", c, false);
  c.regime = RP_SHIFT;
  c.layer_hardening = -1e12;
  add("softening_shift", c, false);
  c = full(20);
  c.regime = RP_TRANSIENT_ROLLING;
  add("transient", c, false);
  c.regime = RP_SHIFT;
  add("shift", c, false);
  c = full(20);
  c.shear_modulus[0] *= 0.3;
  add("unlike", c, true);
  c = scenes::heated_patch(RP_STEADY_ROLLING, 20);
  add("heated", c, true);
  c = scenes::heated_patch(RP_TRANSIENT_ROLLING, 20);
  add("heated_transient", c, false);
  add("analyn", scenes::patch(RP_NORMAL_ANALYN, RP_TANGENTIAL_FASTSIM, 20), true);
  add("kik_piotrowski", scenes::patch(RP_NORMAL_KIK_PIOTROWSKI, RP_TANGENTIAL_FASTRIP, 20), true);
  return all;
}

class Effort : public testing::TestWithParam<family> {};

TEST_P(Effort, OfAPatchIsWithinItsBudget) {
  const family &f = GetParam();
  handle h(f.config);
  std::mt19937_64 random(20261122);
  effort mean;
  // the more elements, the dearer a state and the less the states differ
  const int count = (f.config.elements[0] > 40 ? 8 : 24) / (scenes::sanitized ? 4 : 1);
  for (int k = 0; k < count; ++k) {
    const rp_input in = random_input(f.config, random);
    if (f.cold) rp_reset(h.get());
    const rp_patch_result r = h.step(in).side[RP_RIGHT].patch[0];
    EXPECT_EQ(r.status, RP_CONVERGED) << "state " << k;
    mean.normal += 1.0 * r.normal_iterations / count;
    mean.newton += 1.0 * r.newton_iterations / count;
    mean.inner += 1.0 * r.inner_iterations / count;
    mean.outer += 1.0 * r.outer_iterations / count;
  }
  const auto *found = std::find_if(std::begin(of_patches), std::end(of_patches),
                                   [&](const needed &n) { return f.name == n.name; });
  ASSERT_NE(found, std::end(of_patches));
  expect_within(mean, found->mean);
}

// round wheels on rails, cold, on rollers, on springs, with dampers, on a curved surface
constexpr effort of_wheels_needed[] = {
    {1.40, 0.50, 3.50, 0.00, 4.10},  {1.75, 0.70, 4.75, 0.00, 3.90},
    {1.10, 0.45, 3.15, 0.00, 3.70},  {1.45, 1.60, 8.60, 0.00, 13.50},
    {1.35, 1.40, 7.75, 0.00, 12.50}, {2.35, 0.95, 6.30, 0.80, 3.80}};

// Wheels: evaluations of the contact to find the height, and the solvers' on the way.
effort of_wheels(const rp_config &config, rp_track track, bool cold) {
  handle h(config);
  std::mt19937_64 random(20261123);
  effort mean;
  const int count = scenes::sanitized ? 3 : 10;
  for (int k = 0; k < count; ++k) {
    std::uniform_real_distribution<double> u(-1, 1);
    rp_input in = scenes::running(track);
    in.vertical_force = 1.2e5 + 4e4 * u(random);
    in.y = 4e-3 * u(random);
    in.yaw = 6e-3 * u(random);
    in.vy = 0.03 * u(random);
    in.x = 0.1 * k;
    in.time_step = k > 0 ? 2e-3 : 0;
    if (cold) rp_reset(h.get());
    const rp_result r = h.step(in);
    EXPECT_EQ(r.status, RP_CONVERGED) << "state " << k;
    mean.evaluations += 1.0 * r.evaluations / count;
    for (const rp_side_result &side : r.side)
      for (int i = 0; i < side.patch_count; ++i) {
        mean.normal += 0.5 * side.patch[i].normal_iterations / count;
        mean.newton += 0.5 * side.patch[i].newton_iterations / count;
        mean.inner += 0.5 * side.patch[i].inner_iterations / count;
        mean.outer += 0.5 * side.patch[i].outer_iterations / count;
      }
  }
  return mean;
}

TEST(Effort, OfWheelsIsWithinItsBudget) {
  const scenes::profile_pair pair;
  const scenes::varying_track varying;
  for (int kind = 0; kind < 6; ++kind) {
    const rp_track track = kind == 2 ? RP_ROLLER : RP_RAIL;
    rp_config c = scenes::wheels(RP_WHEELSET, track, pair);
    c.load = RP_FORCE;
    if (kind == 3 || kind == 4) c = varying.config(RP_WHEELSET);
    if (kind == 4) c.load = RP_FORCE;
    if (kind == 3) c.load = RP_FORCE, c.rail_damping[0] = c.rail_damping[1] = 0;
    if (kind == 5) c.reference_surface = RP_REFERENCE_CURVED;
    const effort mean = of_wheels(c, track, kind == 1);
    SCOPED_TRACE(kind);
    expect_within(mean, of_wheels_needed[kind]);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Effort, testing::ValuesIn(families()),
                         [](const auto &info) { return info.param.name; });

}  // namespace
