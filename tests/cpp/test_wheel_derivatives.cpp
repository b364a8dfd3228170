// Derivatives of wheels: against central differences of rp_step, against what moving both bodies
// alike must give, and that asking for them changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "handle/case_fields.hpp"
#include "patch/result_fields.hpp"
#include "scenes.hpp"

namespace {

using railpatch::for_each_number;
using railpatch::for_each_result_number;

constexpr int columns = 12, z_column = 2;
constexpr double fine = 1e-11;      // tolerance of the steps that differences are taken of
constexpr double agreement = 1e-5;  // relative to the greatest entry of a row

std::array<double *, columns> pose_and_velocity(rp_input &in) {
  return {&in.x,     &in.y,  &in.z,  &in.roll,      &in.yaw,      &in.pitch,
          &in.speed, &in.vy, &in.vz, &in.roll_rate, &in.yaw_rate, &in.pitch_rate};
}
// what changes an input by a good part of what matters, and a part of it for differences
constexpr double usual[columns] = {1e-3, 1e-3, 1e-4, 1e-4, 1e-3, 1e-3,
                                   1.0,  0.01, 0.01, 0.01, 0.01, 1.0};
constexpr double length[columns] = {1e-6, 2e-8, 1e-9, 1e-8, 4e-7, 1e-7,
                                    1e-4, 8e-5, 8e-5, 8e-5, 8e-5, 2e-4};

rp_input no_direction() {
  rp_input d;
  rp_default_input(&d);
  for_each_number(d, [](const char *, double &v, double) { v = 0; });
  return d;
}

double component(const rp_side_result &side, int i) {
  return i < 3 ? side.force[i] : side.moment[i - 3];
}

// The choices that an exact derivative keeps: patches, state and place of every element in contact,
// place of the greatest depth.
std::vector<double> choices(const scenes::handle &h, const rp_result &r) {
  std::vector<double> all;
  for (int side = 0; side < 2; ++side) {
    all.push_back(r.side[side].patch_count);
    for (int k = 0; k < r.side[side].patch_count + r.side[side].alternative_count; ++k) {
      const rp_patch_result &p = r.side[side].patch[k];
      const auto distance = h.field(side, k, RP_FIELD_UNDEFORMED_DISTANCE);
      const auto division = h.field(side, k, RP_FIELD_ELEMENT_DIVISION);
      const auto pressure = h.field(side, k, RP_FIELD_PRESSURE);
      const auto place = [&](int at) {
        for (int c = 0; c < 2; ++c)
          all.push_back(std::round(2 * p.grid_origin[c] / p.element_size[c]) +
                        2 * (c == 0 ? at % p.grid[0] : at / p.grid[0]));
      };
      for (int at = 0; at < static_cast<int>(distance.size()); ++at) {
        const auto i = static_cast<size_t>(at);
        const double state = division.empty() ? (pressure[i] > 0 ? 1 : 0) : division[i];
        if (state == 0) continue;
        place(at);
        all.push_back(state);
      }
      place(
          static_cast<int>(std::min_element(distance.begin(), distance.end()) - distance.begin()));
    }
  }
  return all;
}

struct scene {
  const char *name;
  rp_track track;
  rp_load load;
  int elements;  // 0: elements of 1 mm
  bool points = false;
  rp_normal_method normal = RP_NORMAL_HALF_SPACE;
  rp_regime regime = RP_STEADY_ROLLING;
};

void PrintTo(const scene &s, std::ostream *out) { *out << s.name; }

const scene all_scenes[] = {
    {"rail", RP_RAIL, RP_POSITION, 0},
    {"rail_with_vertical_force", RP_RAIL, RP_FORCE, 0},
    {"rail_with_elements", RP_RAIL, RP_POSITION, 14},
    {"rail_with_friction_by_angle_and_x", RP_RAIL, RP_POSITION, 12, true},
    {"rail_without_friction", RP_RAIL, RP_POSITION, 0, false, RP_NORMAL_HALF_SPACE, RP_REGIME_NONE},
    {"rail_by_hertz", RP_RAIL, RP_POSITION, 12, false, RP_NORMAL_HERTZ},
    {"roller", RP_ROLLER, RP_POSITION, 0},
    {"roller_with_vertical_force_and_elements", RP_ROLLER, RP_FORCE, 12},
};

class WheelDerivatives : public testing::TestWithParam<scene> {
 protected:
  rp_config config() const {
    const scene &s = GetParam();
    rp_config c = scenes::wheels(RP_WHEELSET, s.track, pair);
    if (scenes::sanitized) c = scenes::coarse(c);
    c.load = s.load;
    c.normal = s.normal;
    c.regime = s.regime;
    c.derivatives = 1;
    c.max_iterations = 1000;
    c.max_elements[0] = c.max_elements[1] = 64;
    c.curvature = s.track == RP_RAIL ? 1.0 / 400 : 0.0;
    if (s.elements > 0) {
      c.elements[0] = c.elements[1] = s.elements;
      c.element_size[0] = c.element_size[1] = 0;
      c.max_elements[0] = c.max_elements[1] = 0;
    }
    if (s.points) {
      c.friction_points = 2;
      c.friction_position[0] = -0.1;
      c.friction_position[1] = 0.5;
      c.friction_factor[0] = 1.0;
      c.friction_factor[1] = 0.5;
      c.friction_along_points = 2;
      c.friction_along_position[0] = -1.0;
      c.friction_along_position[1] = 1.0;
      c.friction_along_factor[0] = 0.9;
      c.friction_along_factor[1] = 1.1;
    }
    return c;
  }

  // A state with both wheels in contact: z from a vertical force.
  rp_input random_input() {
    std::uniform_real_distribution<double> u(-1, 1);
    rp_input in = scenes::running(GetParam().track);
    in.vertical_force = 1.2e5 + 4e4 * u(random);
    in.y = 5e-3 * u(random);
    in.yaw = 8e-3 * u(random);
    in.roll = 2e-5 * u(random);
    in.vy = 0.03 * u(random);
    in.vz = 0.02 * u(random);
    in.roll_rate = 0.02 * u(random);
    in.yaw_rate = 0.03 * u(random);
    in.pitch_rate *= 1 + 1e-3 * u(random);
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k) {
        in.wheel_offset[side][k] = 3e-5 * u(random);
        in.wheel_rotation[side][k] = 1e-3 * u(random);
        in.rail_offset[side][k] = 3e-5 * u(random);
        in.wheel_velocity[side][k] = 1e-3 * u(random);
        in.rail_angular_velocity[side][k] = 1e-3 * u(random);
      }
    if (GetParam().load == RP_FORCE) return in;
    rp_config c = config();
    c.derivatives = 0;
    c.load = RP_FORCE;
    scenes::handle find(c);
    in.z = find.step(in).z;
    return in;
  }

  rp_jacobian jacobian(const scenes::handle &h) const {
    rp_jacobian out{};
    rp_message message{};
    EXPECT_EQ(rp_get_jacobian(h.get(), &out, &message), RP_OK) << message.text;
    return out;
  }
  rp_result differentiate(const scenes::handle &h, const rp_input &direction) const {
    rp_result out{};
    rp_message message{};
    rp_derivative_kind kind = RP_DERIVATIVE_BY_DIFFERENCES;
    EXPECT_EQ(rp_differentiate(h.get(), &direction, &out, &kind, &message), RP_OK) << message.text;
    EXPECT_EQ(kind, RP_DERIVATIVE_EXACT);
    return out;
  }

  scenes::profile_pair pair;
  std::mt19937_64 random{20261121};
};

TEST_P(WheelDerivatives, JacobianEqualsDifferences) {
  rp_config c = config();
  c.tolerance = fine;
  scenes::handle h(c);
  int compared = 0, with_event = 0;
  const int states = scenes::sanitized ? 3 : 10;
  for (int n = 0; n < states; ++n) {
    const rp_input in = random_input();
    const rp_result result = h.step(in);
    if (result.status != RP_CONVERGED) continue;
    const rp_jacobian found = jacobian(h);
    ASSERT_EQ(found.kind, RP_DERIVATIVE_EXACT);
    ASSERT_EQ(found.status, RP_CONVERGED);
    const std::vector<double> here = choices(h, result);
    double greatest[2][6] = {};
    for (int column = 0; column < columns; ++column)
      for (int side = 0; side < 2; ++side)
        for (int i = 0; i < 6; ++i)
          greatest[side][i] =
              std::max(greatest[side][i], std::fabs(found.side[side][i][column]) * usual[column]);
    for (int column = 0; column < columns; ++column) {
      if (c.load == RP_FORCE && column == z_column) continue;
      rp_result ends[2];
      bool event = false;
      for (int k = 0; k < 2; ++k) {
        rp_input moved = in;
        *pose_and_velocity(moved)[static_cast<size_t>(column)] +=
            (k == 0 ? 1 : -1) * length[column];
        ends[k] = h.step(moved);
        event = event || ends[k].status != RP_CONVERGED || choices(h, ends[k]) != here;
      }
      ++(event ? with_event : compared);
      if (event) continue;
      for (int side = 0; side < 2; ++side)
        for (int i = 0; i < 6; ++i) {
          const double difference =
              (component(ends[0].side[side], i) - component(ends[1].side[side], i)) /
              (2 * length[column]);
          EXPECT_NEAR(found.side[side][i][column] * usual[column], difference * usual[column],
                      agreement * greatest[side][i])
              << "state " << n << ", side " << side << ", row " << i << ", column " << column;
        }
      EXPECT_NEAR(found.z[column] * usual[column],
                  (ends[0].z - ends[1].z) / (2 * length[column]) * usual[column], 1e-8)
          << "state " << n << ", column " << column;
    }
  }
  EXPECT_GT(compared, 6 * states);
  EXPECT_LT(with_event, compared / 2);
}

// One direction through all inputs of wheels and the friction coefficient at once, for all numbers
// of the result.
TEST_P(WheelDerivatives, OfEveryNumberEqualDifferences) {
  rp_config c = config();
  c.tolerance = fine;
  scenes::handle h(c);
  int compared = 0, with_event = 0;
  for (int n = 0; n < (scenes::sanitized ? 3 : 8); ++n) {
    const rp_input in = random_input();
    std::uniform_real_distribution<double> u(-1, 1);
    rp_input direction = no_direction();
    const bool rolls = c.regime != RP_REGIME_NONE;
    const auto wheels_only = [rolls](const std::string &name) {
      if (name == "friction_scale") return rolls;
      for (const char *other :
           {"normal_force", "approach", "creepage", "tangential_force", "spin_creepage",
            "rolling_speed", "bulk_temperature", "distance", "time_step", "axle_torque",
            "longitudinal_force", "water_rate", "water_temperature", "oil_film", "rail_work"})
        if (name == other) return false;
      return true;
    };
    for_each_number(direction, [&](const char *name, double &v, double scale) {
      if (wheels_only(name)) v = u(random) * (scale > 0 ? scale : 1e4);
    });
    for (auto &side : direction.rail_rotation) side[1] = side[2] = 0;
    const rp_result result = h.step(in);
    if (result.status != RP_CONVERGED) continue;
    const std::vector<double> here = choices(h, result);
    rp_result found = differentiate(h, direction);
    EXPECT_EQ(found.status, RP_CONVERGED);
    for (int side = 0; side < 2; ++side)
      EXPECT_EQ(found.side[side].status, result.side[side].status);
    // differences over two lengths: their error of curvature is what they differ by, that of the
    // steps' tolerance and of rounding is a part of the number itself
    constexpr double along[2] = {4e-6, 8e-6};
    constexpr double rounding = 5e-11;
    std::vector<double> rates, difference[2], exact, number;
    rp_result base = result;
    // what is left of the moment's parts along the axle is rounded as they are
    base.axle_torque = std::hypot(base.moment[0], base.moment[1], base.moment[2]);
    for_each_result_number(base, [&](double &v) { number.push_back(v); });
    for_each_number(direction, [&](const char *, double &v, double) { rates.push_back(v); });
    for_each_result_number(found, [&](double &v) { exact.push_back(v); });
    bool event = false;
    for (int l = 0; l < 2; ++l) {
      std::vector<double> ends[2];
      for (int k = 0; k < 2; ++k) {
        rp_input moved = in;
        size_t next = 0;
        for_each_number(moved, [&](const char *, double &v, double) {
          v += (k == 0 ? 1 : -1) * along[l] * rates[next++];
        });
        const double friction = std::exchange(moved.friction_coefficient, 0.0);
        rp_set_friction_coefficient(h.get(), c.friction_coefficient + friction, nullptr);
        rp_result end = h.step(moved);
        event = event || end.status != RP_CONVERGED || choices(h, end) != here;
        for_each_result_number(end, [&](double &v) { ends[k].push_back(v); });
      }
      for (size_t i = 0; i < exact.size(); ++i)
        difference[l].push_back((ends[0][i] - ends[1][i]) / (2 * along[l]));
    }
    rp_set_friction_coefficient(h.get(), c.friction_coefficient, nullptr);
    ++(event ? with_event : compared);
    if (event) continue;
    for (size_t i = 0; i < exact.size(); ++i) {
      const double value = difference[0][i], error = std::fabs(value - difference[1][i]);
      ASSERT_EQ(std::isnan(exact[i]), std::isnan(value)) << "number " << i;
      if (std::isnan(value)) continue;
      EXPECT_NEAR(
          exact[i], value,
          agreement * std::fabs(value) + 4 * error + rounding * std::fabs(number[i]) / along[0])
          << "state " << n << ", number " << i;
    }
  }
  EXPECT_GT(compared, with_event);
}

// What moves wheelset and rails alike leaves every force as it is; so does all speeds growing
// alike.
TEST_P(WheelDerivatives, OfMovingBothBodiesAlikeAreZero) {
  scenes::handle h(config());
  const rp_input in = random_input();
  const rp_result result = h.step(in);
  ASSERT_EQ(result.status, RP_CONVERGED);
  const rp_jacobian whole = jacobian(h);
  const auto expect_none = [&](const rp_input &direction, double size) {
    const rp_result change = differentiate(h, direction);
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < 6; ++i)
        EXPECT_NEAR(component(change.side[side], i), 0, 1e-6 * size) << side << " row " << i;
  };
  const double stiffness = std::fabs(whole.side[RP_RIGHT][2][z_column]);
  rp_input sideways = no_direction(), down = no_direction();
  sideways.y = 1;
  // in a curve the track frame turns about its own origin
  sideways.speed = 0;
  down.z = 1;
  for (int side = 0; side < 2; ++side)
    sideways.rail_offset[side][1] = down.rail_offset[side][2] = 1;
  if (GetParam().track == RP_ROLLER) expect_none(sideways, stiffness);
  if (GetParam().load == RP_POSITION) expect_none(down, stiffness);
  rp_input faster = no_direction();
  const rp_input &v = in;
  faster.speed = v.speed;
  faster.vy = v.vy;
  faster.vz = v.vz;
  faster.roll_rate = v.roll_rate;
  faster.yaw_rate = v.yaw_rate;
  faster.pitch_rate = v.pitch_rate;
  faster.roller_pitch_rate = v.roller_pitch_rate;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 3; ++k) {
      faster.wheel_velocity[side][k] = v.wheel_velocity[side][k];
      faster.wheel_angular_velocity[side][k] = v.wheel_angular_velocity[side][k];
      faster.rail_velocity[side][k] = v.rail_velocity[side][k];
      faster.rail_angular_velocity[side][k] = v.rail_angular_velocity[side][k];
    }
  expect_none(faster, 1e5);
}

TEST_P(WheelDerivatives, LeaveTheStateAsItIs) {
  scenes::handle asked(config()), left_alone(config());
  for (int n = 0; n < 3; ++n) {
    const rp_input in = random_input();
    const rp_result a = asked.step(in), b = left_alone.step(in);
    EXPECT_EQ(scenes::difference(a, b), "") << n;
    const auto before = asked.state();
    const auto traction = asked.field(RP_RIGHT, 0, RP_FIELD_TRACTION);
    const rp_jacobian first = jacobian(asked), second = jacobian(asked);
    differentiate(asked, in);
    EXPECT_EQ(asked.state(), before);
    EXPECT_TRUE(scenes::same_bits(asked.field(RP_RIGHT, 0, RP_FIELD_TRACTION), traction));
    EXPECT_EQ(std::memcmp(first.side, second.side, sizeof first.side), 0);
  }
}

TEST_P(WheelDerivatives, MirrorLeftAndRight) {
  rp_config c = config();
  c.curvature = 0;  // a curve is not its own mirror image
  scenes::handle a(c), b(c);
  rp_input in = random_input();
  for (int side = 0; side < 2; ++side) {
    std::fill_n(in.wheel_offset[side], 3, 0.0);
    std::fill_n(in.wheel_rotation[side], 3, 0.0);
    std::fill_n(in.rail_offset[side], 3, 0.0);
    std::fill_n(in.wheel_velocity[side], 3, 0.0);
    std::fill_n(in.rail_angular_velocity[side], 3, 0.0);
  }
  rp_input image = in;
  for (double *v :
       {&image.y, &image.roll, &image.yaw, &image.vy, &image.roll_rate, &image.yaw_rate})
    *v = -*v;
  a.step(in);
  b.step(image);
  const rp_jacobian x = jacobian(a), y = jacobian(b);
  const double odd_row[6] = {1, -1, 1, -1, 1, -1};
  const double odd_column[columns] = {1, -1, 1, -1, -1, 1, 1, -1, 1, -1, -1, 1};
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < columns; ++k) {
      const double v = x.side[RP_LEFT][i][k];
      if (std::isnan(v)) continue;
      EXPECT_NEAR(odd_row[i] * odd_column[k] * y.side[RP_RIGHT][i][k], v, 1e-9 * std::fabs(v));
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, WheelDerivatives, testing::ValuesIn(all_scenes),
                         [](const auto &info) { return std::string(info.param.name); });

TEST(WheelDerivative, ByDifferencesWhereThereAreNoExactOnes) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  c.derivatives = 1;
  c.load = RP_POSITION;
  c.patch_rule = RP_PATCHES_CONTACT;
  rp_config exact = c;
  exact.patch_rule = RP_PATCHES_BLENDED;
  scenes::handle by_differences(c), by_conditions(exact);
  rp_input in = scenes::running(RP_RAIL);
  in.y = 1e-3;
  in.yaw = 1e-3;
  {
    rp_config force = c;
    force.derivatives = 0;
    force.load = RP_FORCE;
    in.vertical_force = 6e4;
    scenes::handle find(force);
    in.z = find.step(in).z;
  }
  // one patch, for which both rules are the same
  ASSERT_EQ(by_differences.step(in).side[RP_RIGHT].patch_count, 1);
  by_conditions.step(in);
  rp_jacobian a{}, b{};
  ASSERT_EQ(rp_get_jacobian(by_differences.get(), &a, nullptr), RP_OK);
  ASSERT_EQ(rp_get_jacobian(by_conditions.get(), &b, nullptr), RP_OK);
  EXPECT_EQ(a.kind, RP_DERIVATIVE_BY_DIFFERENCES);
  EXPECT_EQ(b.kind, RP_DERIVATIVE_EXACT);
  for (int i = 0; i < 3; ++i)
    for (int column : {1, 2, 4, 7, 11}) {
      double row = 0;
      for (int k = 0; k < columns; ++k)
        row = std::max(row, std::fabs(b.side[RP_RIGHT][i][k]) * usual[k]);
      // elements change their state within the differences' length
      EXPECT_NEAR(a.side[RP_RIGHT][i][column] * usual[column],
                  b.side[RP_RIGHT][i][column] * usual[column], 0.05 * row)
          << i << ' ' << column;
    }
}

// What `rp_describe` says of the derivatives is what they are found by.
TEST(WheelDerivative, TheStageSaysHowTheyAreFound) {
  const scenes::profile_pair pair;
  const std::vector<double> uneven(64, 1e-5);
  const auto expect = [](rp_config c, rp_derivative_kind expected, const char *words) {
    SCOPED_TRACE(words);
    c.derivatives = 1;
    c.load = RP_FORCE;
    scenes::handle h(c);
    rp_input in = scenes::running(c.track);
    in.vertical_force = 6e4;
    ASSERT_EQ(h.step(in).status, RP_CONVERGED);
    rp_stage_info stages[RP_STAGE_COUNT];
    ASSERT_EQ(rp_describe(h.get(), stages), RP_OK);
    const std::string reason = stages[RP_STAGE_DERIVATIVES].reason;
    EXPECT_NE(reason.find(words), std::string::npos) << reason;
    const rp_input direction = no_direction();
    rp_result change{};
    rp_derivative_kind kind;
    ASSERT_EQ(rp_differentiate(h.get(), &direction, &change, &kind, nullptr), RP_OK);
    EXPECT_EQ(kind, expected);
  };
  const auto exact = [&](const rp_config &c) {
    expect(c, RP_DERIVATIVE_EXACT, "from the solved conditions");
  };
  const auto by_differences = [&](const rp_config &c) {
    expect(c, RP_DERIVATIVE_BY_DIFFERENCES, "by differences of further steps");
  };
  const rp_config rail = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  exact(rail);
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_ROLLER, pair);
  exact(c);
  c.contact_frame = RP_FRAME_INCLINED;
  by_differences(c);
  c = rail;
  c.patch_rule = RP_PATCHES_CONTACT;
  by_differences(c);
  c = rail;
  c.tangential = RP_TANGENTIAL_FASTSIM;
  by_differences(c);
  c = rail;
  c.runout[c.side] = uneven.data();
  c.runout_count[c.side] = static_cast<int32_t>(uneven.size());
  by_differences(c);
  c = rail;
  c.rail_stiffness[1] = 5e7;
  by_differences(c);
  const scenes::varying_track track;
  c = track.config(RP_WHEEL_RAIL);
  c.rail_stiffness[0] = c.rail_stiffness[1] = c.rail_damping[0] = c.rail_damping[1] = 0;
  by_differences(c);
}

// Steps beside the last one that do not converge are told where there is something to tell: of the
// side in use and its patches.
TEST(WheelDerivative, DifferencesThatFailAreThoseOfTheSidesInUse) {
  const scenes::profile_pair pair;
  std::vector<std::pair<rp_config, rp_input>> all;
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FASTSIM);
  all.emplace_back(c, scenes::patch_input(8e4, 4e-4, -2e-4, 0.3));
  for (const int side : {RP_LEFT, RP_RIGHT}) {
    c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
    c.side = side;
    c.load = RP_FORCE;
    c.patch_rule = RP_PATCHES_CONTACT;
    all.emplace_back(c, scenes::running(RP_RAIL));
    all.back().second.vertical_force = 6e4;
  }
  for (auto &[config, in] : all) {
    config.derivatives = 1;
    config.tolerance = 1e-2;
    bool found = false;
    for (config.max_iterations = 1; config.max_iterations < 40 && !found; ++config.max_iterations) {
      scenes::handle h(config);
      const rp_result r = h.step(in);
      rp_input faster = no_direction();
      faster.speed = faster.normal_force = 1;
      rp_result change{};
      ASSERT_EQ(rp_differentiate(h.get(), &faster, &change, nullptr, nullptr), RP_OK);
      if (r.status != RP_CONVERGED || change.status == RP_CONVERGED) continue;
      found = true;
      const int used = config.kind == RP_PATCH ? RP_RIGHT : config.side;
      EXPECT_EQ(change.status, RP_NOT_CONVERGED);
      EXPECT_EQ(change.side[used].status, RP_NOT_CONVERGED);
      EXPECT_EQ(change.side[used].patch[0].status, RP_NOT_CONVERGED);
      EXPECT_EQ(change.side[1 - used].status, r.side[1 - used].status);
    }
    EXPECT_TRUE(found);
  }
}

// An offset in the spin's term is a lateral creepage of its own.
TEST(PatchDerivative, OfAnOffsetSpinIsThatOfLateralCreepageToo) {
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 12);
  c.derivatives = 1;
  c.tolerance = 1e-9;
  c.spin_offset = RP_SPIN_OFFSET_NONE;
  scenes::handle plain(c);
  const std::pair<rp_spin_offset, double> places[] = {{RP_SPIN_OFFSET_SIXTH, 1.0 / 6},
                                                      {RP_SPIN_OFFSET_QUARTER, 0.25},
                                                      {RP_SPIN_OFFSET_AUTOMATIC, 0.25}};
  for (const auto &[place, share] : places)
    for (const int way : {1, -1}) {
      c.spin_offset = place;
      scenes::handle offset(c);
      rp_input in = scenes::patch_input(8e4, 4e-4, -2e-4, 0.3);
      in.direction = way;
      const rp_patch_result r = offset.step(in).side[RP_RIGHT].patch[0];
      ASSERT_EQ(r.status, RP_CONVERGED);
      const double shift = way * r.element_size[0] * share;
      in.creepage[1] += shift * in.spin_creepage;
      const rp_patch_result same = plain.step(in).side[RP_RIGHT].patch[0];
      EXPECT_NEAR(r.creep_force[1], same.creep_force[1], 1e-6 * std::fabs(same.creep_force[1]));
      const auto rates = [](scenes::handle &h, double lateral, double spin) {
        rp_input direction = no_direction();
        direction.creepage[1] = lateral;
        direction.spin_creepage = spin;
        rp_result change{};
        rp_derivative_kind kind;
        EXPECT_EQ(rp_differentiate(h.get(), &direction, &change, &kind, nullptr), RP_OK);
        EXPECT_EQ(kind, RP_DERIVATIVE_EXACT);
        const rp_patch_result &p = change.side[RP_RIGHT].patch[0];
        return std::array{p.creep_force[0], p.creep_force[1], p.spin_moment, p.friction_power};
      };
      const auto found = rates(offset, 0, 1);
      auto expected = rates(plain, shift, 1);
      // but friction's power is without it
      const double speed = in.rolling_speed, spin = in.spin_creepage;
      EXPECT_NEAR(r.friction_power,
                  same.friction_power + speed * shift * spin * same.creep_force[1],
                  1e-6 * same.friction_power);
      expected[3] += speed * shift * (same.creep_force[1] + spin * expected[1]);
      for (size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 1e-4 * std::fabs(expected[k])) << k;
    }
}

// Of a prescribed force the wheelset's way is found by the same differences, however it is asked.
TEST(WheelDerivative, ByDifferencesTheHeightFollowsTheForce) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  c.derivatives = 1;
  c.patch_rule = RP_PATCHES_CONTACT;
  scenes::handle h(c);
  rp_input in = scenes::running(RP_RAIL), direction;
  in.vertical_force = 6e4;
  ASSERT_EQ(h.step(in).status, RP_CONVERGED);
  rp_jacobian found{};
  ASSERT_EQ(rp_get_jacobian(h.get(), &found, nullptr), RP_OK);
  EXPECT_EQ(found.kind, RP_DERIVATIVE_BY_DIFFERENCES);
  rp_default_direction(&direction);
  direction.vertical_force = 1;
  rp_result change{};
  rp_derivative_kind kind{};
  ASSERT_EQ(rp_differentiate(h.get(), &direction, &change, &kind, nullptr), RP_OK);
  EXPECT_EQ(found.z_force, change.z);
  EXPECT_GT(found.z_force, 0);
}

// With a wheel on tread and flange root, moving wheel and rail alike changes nothing.
TEST(WheelDerivative, OfTwoPatchesMovingBothBodiesAlikeIsZero) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  c.load = RP_FORCE;
  c.side = RP_RIGHT;
  rp_input in = scenes::running(RP_RAIL);
  in.vertical_force = 6e4;
  in.y = 5.95e-3;
  {
    scenes::handle find(c);
    in.z = find.step(in).z;
  }
  c.derivatives = 1;
  c.load = RP_POSITION;
  scenes::handle h(c);
  const rp_result r = h.step(in);
  ASSERT_EQ(r.status, RP_CONVERGED);
  ASSERT_EQ(r.side[RP_RIGHT].patch_count, 2);
  const auto rates = [&](const rp_input &direction) {
    rp_result change{};
    rp_derivative_kind kind{};
    EXPECT_EQ(rp_differentiate(h.get(), &direction, &change, &kind, nullptr), RP_OK);
    EXPECT_EQ(kind, RP_DERIVATIVE_EXACT);
    return change.side[RP_RIGHT];
  };
  for (const int k : {1, 2}) {
    rp_input wheel = no_direction(), both = no_direction();
    (k == 1 ? wheel.y : wheel.z) = 1;
    (k == 1 ? both.y : both.z) = both.rail_offset[RP_RIGHT][k] = 1;
    const rp_side_result alone = rates(wheel), alike = rates(both);
    const double stiffness = std::fabs(alone.force[2]);
    EXPECT_GT(stiffness, 1e7);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(component(alike, i), 0, 1e-6 * stiffness) << i;
    for (int i = 0; i < 2; ++i) {
      EXPECT_NE(alone.patch[i].normal_force, 0);
      EXPECT_NEAR(alike.patch[i].normal_force, 0, 1e-6 * stiffness) << i;
    }
  }
}

TEST(WheelDerivative, NeedsASceneWithDerivativesAndAStep) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  rp_jacobian out{};
  rp_message message{};
  scenes::handle without(c);
  EXPECT_EQ(rp_get_jacobian(without.get(), &out, &message), RP_ERROR_VALUE);
  EXPECT_NE(std::string(message.text).find("derivatives"), std::string::npos);
  c.derivatives = 1;
  scenes::handle with(c);
  EXPECT_EQ(rp_get_jacobian(with.get(), &out, &message), RP_ERROR_STATE);
  EXPECT_EQ(rp_get_jacobian(with.get(), nullptr, &message), RP_ERROR_NULL);
  EXPECT_EQ(rp_get_jacobian(nullptr, &out, &message), RP_ERROR_NULL);
  rp_config patch = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  patch.derivatives = 1;
  scenes::handle of_patch(patch);
  EXPECT_EQ(rp_get_jacobian(of_patch.get(), &out, &message), RP_ERROR_VALUE);
  EXPECT_NE(std::string(message.text).find("kind"), std::string::npos);
}

}  // namespace
