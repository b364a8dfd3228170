// A left wheel is the mirror image of a right one: forces, moments, patches and fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "scenes.hpp"

namespace {

constexpr double imposed = 1e-12;  // relative

// --- reflection at the plane y = 0 -----------------------------------------------------------

rp_input mirrored(rp_input in) {
  for (double *v : {&in.y, &in.roll, &in.yaw, &in.vy, &in.roll_rate, &in.yaw_rate}) *v = -*v;
  for (auto *offset : {&in.wheel_offset, &in.rail_offset, &in.wheel_velocity, &in.rail_velocity})
    for (auto &side : *offset) side[1] = -side[1];
  for (auto *rotation : {&in.wheel_rotation, &in.rail_rotation, &in.wheel_angular_velocity,
                         &in.rail_angular_velocity})
    for (auto &side : *rotation) {
      side[0] = -side[0];
      side[2] = -side[2];
    }
  for (auto *pairs : {&in.wheel_offset, &in.rail_offset, &in.wheel_rotation, &in.rail_rotation,
                      &in.wheel_velocity, &in.rail_velocity, &in.wheel_angular_velocity,
                      &in.rail_angular_velocity})
    std::swap_ranges((*pairs)[0], (*pairs)[0] + 3, (*pairs)[1]);
  return in;
}

rp_config mirrored(rp_config c) {
  c.curvature = -c.curvature;
  c.side = c.side == RP_LEFT ? RP_RIGHT : RP_LEFT;
  std::swap(c.wheel[0], c.wheel[1]);
  std::swap(c.rail[0], c.rail[1]);
  return c;
}

rp_patch_result mirrored(rp_patch_result p) {
  for (double *v : {&p.creep_force[1], &p.spin_moment, &p.position[1], &p.contact_angle,
                    &p.creepage[1], &p.spin_creepage})
    *v = -*v;
  if (p.grid[1] > 0) p.grid_origin[1] = -(p.grid_origin[1] + (p.grid[1] - 1) * p.element_size[1]);
  return p;
}

rp_side_result mirrored(rp_side_result s) {
  s.force[1] = -s.force[1];
  s.moment[0] = -s.moment[0];
  s.moment[2] = -s.moment[2];
  for (rp_patch_result &p : s.patch) p = mirrored(p);
  return s;
}

rp_result mirrored(rp_result r) {
  r.force[1] = -r.force[1];
  r.moment[0] = -r.moment[0];
  r.moment[2] = -r.moment[2];
  r.roll = -r.roll;
  r.rolling_radius_difference = -r.rolling_radius_difference;
  for (rp_side_result &s : r.side) s = mirrored(s);
  std::swap(r.side[0], r.side[1]);
  return r;
}

// --- comparison ------------------------------------------------------------------------------

// Vectors count with their length: a component that is zero but for rounding has no size of its
// own.
double size_of(const std::vector<scenes::number> &all, size_t at) {
  double size = 0;
  for (size_t i = at > 2 ? at - 2 : 0; i < std::min(at + 3, all.size()); ++i)
    if (all[i].name == all[at].name && std::isfinite(all[i].value))
      size = std::max(size, std::fabs(all[i].value));
  return size;
}

void expect_equal(const rp_result &a, const rp_result &b, const std::string &what) {
  const std::vector<scenes::number> x = scenes::numbers(a), y = scenes::numbers(b);
  for (size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i].value) && std::isnan(y[i].value)) continue;
    EXPECT_NEAR(x[i].value, y[i].value, imposed * size_of(x, i)) << what << ": " << x[i].name;
  }
}

void expect_mirrored_field(const scenes::handle &a, const scenes::handle &b, int side, int patch,
                           rp_field name, const std::string &what) {
  const std::vector<double> x = a.field(side, patch, name);
  std::vector<double> y = b.field(1 - side, patch, name);
  ASSERT_EQ(x.size(), y.size()) << what;
  if (x.empty()) return;
  // of fitted rows every row has its own x
  const size_t ny = a.field(side, patch, RP_FIELD_Y).size();
  const size_t nx = a.field(side, patch, RP_FIELD_PRESSURE).size() / ny;
  const bool by_row = a.field(side, patch, RP_FIELD_X).size() > nx;
  const bool vectors = name == RP_FIELD_TRACTION || name == RP_FIELD_MICRO_SLIP;
  double scale = 0;
  for (double v : x) scale = std::max(scale, std::fabs(v));
  const auto expected = [&](size_t i) {
    if (name == RP_FIELD_X && !by_row) return y[i];
    if (name == RP_FIELD_Y) return -y[ny - 1 - i];
    const size_t plane = i / (nx * ny), row = i / nx % ny, column = i % nx;
    const double v = y[plane * nx * ny + (ny - 1 - row) * nx + column];
    return vectors && plane == 1 ? -v : v;
  };
  for (size_t i = 0; i < x.size(); ++i)
    ASSERT_NEAR(x[i], expected(i), imposed * scale) << what << ": field " << name << " at " << i;
}

// --- scenes ----------------------------------------------------------------------------------

struct scene {
  const char *name;
  rp_kind kind;
  rp_track track;
  rp_load load;
  double curvature;
  rp_normal_method normal = RP_NORMAL_HALF_SPACE;
  int fitted = 0;
  rp_reference_surface surface = RP_REFERENCE_PLANE;
  bool falling = false;  // friction
  rp_regime regime = RP_STEADY_ROLLING;
};

void PrintTo(const scene &s, std::ostream *out) { *out << s.name; }

const scene all_scenes[] = {
    {"wheel_on_rail", RP_WHEEL_RAIL, RP_RAIL, RP_FORCE, 0.0},
    {"wheel_on_rail_in_a_curve", RP_WHEEL_RAIL, RP_RAIL, RP_POSITION, 1.0 / 300},
    {"wheel_on_roller", RP_WHEEL_RAIL, RP_ROLLER, RP_FORCE, 0.0},
    {"wheelset_on_rails", RP_WHEELSET, RP_RAIL, RP_FORCE, 1.0 / 500},
    {"wheelset_on_rollers", RP_WHEELSET, RP_ROLLER, RP_FORCE, 0.0},
    {"kik_piotrowski", RP_WHEELSET, RP_RAIL, RP_FORCE, 0.0, RP_NORMAL_KIK_PIOTROWSKI},
    {"corrected", RP_WHEELSET, RP_RAIL, RP_FORCE, 0.0, RP_NORMAL_KIK_PIOTROWSKI_CORRECTED},
    {"analyn", RP_WHEEL_RAIL, RP_ROLLER, RP_POSITION, 0.0, RP_NORMAL_ANALYN},
    {"fitted_half_space", RP_WHEELSET, RP_RAIL, RP_FORCE, 0.0, RP_NORMAL_HALF_SPACE, 7},
    {"fitted_kik_piotrowski", RP_WHEELSET, RP_ROLLER, RP_FORCE, 0.0, RP_NORMAL_KIK_PIOTROWSKI, 8},
    {"fitted_hertz", RP_WHEEL_RAIL, RP_RAIL, RP_POSITION, 0.0, RP_NORMAL_HERTZ, 8},
    {"curved_rail", RP_WHEELSET, RP_RAIL, RP_FORCE, 1.0 / 500, RP_NORMAL_HALF_SPACE, 0,
     RP_REFERENCE_CURVED},
    {"curved_roller", RP_WHEEL_RAIL, RP_ROLLER, RP_POSITION, 0.0, RP_NORMAL_HALF_SPACE, 0,
     RP_REFERENCE_CURVED},
    {"falling_friction_on_rails", RP_WHEELSET, RP_RAIL, RP_FORCE, 0.0, RP_NORMAL_HALF_SPACE, 0,
     RP_REFERENCE_PLANE, true},
    {"falling_friction_on_a_roller", RP_WHEEL_RAIL, RP_ROLLER, RP_POSITION, 0.0, RP_NORMAL_ANALYN,
     0, RP_REFERENCE_PLANE, true},
    {"falling_friction_with_history", RP_WHEELSET, RP_RAIL, RP_FORCE, 1.0 / 500,
     RP_NORMAL_HALF_SPACE, 0, RP_REFERENCE_PLANE, true, RP_TRANSIENT_ROLLING},
};

class Mirror : public testing::TestWithParam<scene> {
 protected:
  // random motion and deviations; the load leaves the flange lightly loaded at most
  rp_input random_input(std::mt19937_64 &random) {
    std::uniform_real_distribution<double> u(-1, 1);
    rp_input in = scenes::running(GetParam().track);
    in.time_step = 1e-4;
    in.vertical_force = GetParam().kind == RP_WHEELSET ? 1.2e5 : 6e4;
    in.y = 4e-3 * u(random);
    in.yaw = 5e-3 * u(random);
    in.roll = 1e-3 * u(random);
    in.vy = 0.1 * u(random);
    in.vz = 0.02 * u(random);
    in.roll_rate = 0.02 * u(random);
    in.yaw_rate = 0.1 * u(random);
    in.pitch_rate *= 1 + 2e-3 * u(random);
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k) {
        in.wheel_offset[side][k] = 3e-4 * u(random);
        in.wheel_rotation[side][k] = 2e-3 * u(random);
        in.rail_offset[side][k] = 3e-4 * u(random);
        if (k == 0) in.rail_rotation[side][k] = 2e-3 * u(random);
      }
    for (auto *rates : {&in.wheel_velocity, &in.rail_velocity, &in.wheel_angular_velocity,
                        &in.rail_angular_velocity})
      for (auto &side : *rates)
        for (double &rate : side) rate = 0.03 * u(rates_);
    return in;
  }

  scenes::profile_pair one, two;

 private:
  std::mt19937_64 rates_{20240609};
};

TEST_P(Mirror, EqualsTheMirroredMotion) {
  // the profiles of the two sides differ: the left rail is worn by 10 micrometres
  for (double &z : two.rail.z) z += 1e-5;
  rp_config c = scenes::wheels(GetParam().kind, GetParam().track, one);
  // rows of strips need their elements where the contact is narrow
  if (GetParam().normal == RP_NORMAL_HALF_SPACE) c = scenes::coarse(c);
  c.curvature = GetParam().curvature;
  c.normal = GetParam().normal;
  c.reference_surface = GetParam().surface;
  c.regime = GetParam().regime;
  if (GetParam().falling) scenes::set_falling_friction(c);
  c.fitted[0] = GetParam().fitted;
  c.fitted[1] = GetParam().fitted > 0 ? GetParam().fitted + 1 : 0;
  c.load = RP_FORCE;
  c.max_elements[0] = c.max_elements[1] = 64;
  c.rail[RP_LEFT] = two.rail.view();
  rp_config position = c;
  position.load = RP_POSITION;
  scenes::handle a(c), b(mirrored(c)), at(position), mirrored_at(mirrored(position));
  std::mt19937_64 random(20240608);
  int patches = 0;
  for (int n = 0; n < 12; ++n) {
    const std::string what = std::string(GetParam().name) + " input " + std::to_string(n);
    rp_input in = random_input(random);
    rp_result result = a.step(in);
    scenes::handle *original = &a, *image = &b;
    ASSERT_EQ(result.status, RP_CONVERGED) << what;
    if (GetParam().load == RP_POSITION) {
      in.z = result.z;
      original = &at;
      image = &mirrored_at;
      result = at.step(in);
    }
    const rp_result other = image->step(mirrored(in));
    expect_equal(result, mirrored(other), what);
    for (int side : {RP_LEFT, RP_RIGHT})
      for (int patch = 0; patch < result.side[side].patch_count; ++patch, ++patches)
        for (int name = RP_FIELD_X; name <= RP_FIELD_ELEMENT_DIVISION; ++name)
          expect_mirrored_field(*original, *image, side, patch, static_cast<rp_field>(name), what);
    if (HasFailure()) return;
  }
  EXPECT_GE(patches, 12);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Mirror, testing::ValuesIn(all_scenes),
                         [](const auto &info) { return std::string(info.param.name); });

// Centred and straight: left and right are each other's image in one solve.
TEST(Symmetry, OfACentredWheelset) {
  const scenes::profile_pair pair;
  for (rp_track track : {RP_RAIL, RP_ROLLER}) {
    scenes::handle contact(scenes::wheels(RP_WHEELSET, track, pair));
    rp_input in = scenes::running(track);
    in.pitch_rate *= 1.001;
    const rp_result r = contact.step(in);
    ASSERT_EQ(r.status, RP_CONVERGED);
    expect_equal(r, mirrored(r), "centred");
    EXPECT_EQ(r.force[1], 0);
    EXPECT_EQ(r.moment[0], 0);
    EXPECT_EQ(r.moment[2], 0);
    // turning faster than it rolls, the wheelset drives forward
    EXPECT_GT(r.force[0], 0);
  }
}

}  // namespace
