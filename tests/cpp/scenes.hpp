// Scenes shared by the tests, a handle that cleans up, and comparison of results bit by bit.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "profiles.hpp"
#include "railpatch_fields.h"

namespace scenes {

// Whether the core was built with sanitizers (core/sanitized.cpp). They look at memory and
// undefined behaviour, eight times slower: there the smaller cases of a test that goes through the
// same code with each are enough.
extern const bool sanitized;

class handle {
 public:
  explicit handle(const rp_config &config) {
    rp_message message{};
    const rp_error error = rp_create(&config, &contact_, &message);
    EXPECT_EQ(error, RP_OK) << message.text;
  }
  ~handle() { rp_destroy(contact_); }
  handle(const handle &) = delete;
  handle &operator=(const handle &) = delete;

  rp_contact *get() const { return contact_; }
  rp_result step(const rp_input &input) {
    rp_result result{};
    rp_message message{};
    const rp_error error = rp_step(contact_, &input, &result, &message);
    EXPECT_EQ(error, RP_OK) << message.text;
    return result;
  }
  std::vector<double> field(int side, int patch, rp_field name) const {
    size_t count = 0;
    if (rp_get_field(contact_, side, patch, name, nullptr, &count) != RP_ERROR_SIZE) return {};
    std::vector<double> values(count);
    EXPECT_EQ(rp_get_field(contact_, side, patch, name, values.data(), &count), RP_OK);
    return values;
  }
  std::vector<unsigned char> state() const {
    std::vector<unsigned char> buffer(rp_state_size(contact_));
    EXPECT_EQ(rp_save_state(contact_, buffer.data(), buffer.size()), RP_OK);
    return buffer;
  }
  rp_error restore(const std::vector<unsigned char> &buffer) {
    return rp_restore_state(contact_, buffer.data(), buffer.size());
  }

 private:
  rp_contact *contact_ = nullptr;
};

// --- configurations ------------------------------------------------------------------------

inline rp_config patch(rp_normal_method normal, rp_tangential_method tangential,
                       int elements = 16) {
  rp_config c;
  rp_default_config(&c);
  c.normal = normal;
  c.tangential = tangential;
  c.elements[0] = c.elements[1] = elements;
  return c;
}

// The full theory with both components of the creep force prescribed; nodes: across, on fitted
// rows.
inline rp_config forced_patch(int nodes = 0) {
  rp_config c = patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL);
  c.fitted[0] = c.fitted[1] = nodes;
  c.force_prescribed[0] = c.force_prescribed[1] = 1;
  return c;
}

// Friction that falls with temperature, a wheel warmer than the rail, temperatures below the
// surface; the inputs of transient rolling need a distance.
inline rp_config heated_patch(rp_regime regime, int elements = 16) {
  rp_config c = patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FULL, elements);
  c.regime = regime;
  c.temperature = 1;
  c.bulk_temperature[0] = 80;
  c.bulk_temperature[1] = 20;
  c.temperature_depth = 1e-5;
  c.friction_law = RP_TEMPERATURE;
  c.friction_reference = 0.4;
  c.friction_change = -0.3;
  c.friction_reference_temperature = 40;
  c.friction_temperature_range = 100;
  return c;
}

// Wheel kinds with the profiles of profiles.hpp on both sides; `wheel` and `rail` must stay alive.
struct profile_pair {
  profiles::curve wheel = profiles::wheel(), rail = profiles::rail();
};

inline rp_config wheels(rp_kind kind, rp_track track, const profile_pair &pair) {
  rp_config c;
  rp_default_config(&c);
  c.kind = kind;
  c.track = track;
  c.cant = track == RP_RAIL ? 0.025 : 0.0;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  for (int side = 0; side < 2; ++side) {
    c.wheel[side] = pair.wheel.view();
    c.rail[side] = pair.rail.view();
  }
  return c;
}

// Wheels on elements of 2 mm, where it does not matter how many there are.
inline rp_config coarse(rp_config c) {
  c.element_size[0] = c.element_size[1] = 2e-3;
  return c;
}

// Friction that falls by half from sticking to the slip of tenths of a metre per second.
inline void set_falling_friction(rp_config &c) {
  c.friction_law = RP_SLIP_VELOCITY;
  c.friction_kinetic = 0.15;
  c.friction_amplitude[0] = 0.2;
  c.friction_halving_speed[0] = 0.05;
  c.friction_memory_distance = 5e-4;
}

inline rp_input patch_input(double force, double xi, double eta, double phi) {
  rp_input in;
  rp_default_input(&in);
  in.normal_force = force;
  in.creepage[0] = xi;
  in.creepage[1] = eta;
  in.spin_creepage = phi;
  return in;
}

// A creep force at an angle, as a share of friction's most (coefficient 0.3).
inline rp_input forced_input(double force, double share, double angle, double phi) {
  rp_input in = patch_input(force, 0, 0, phi);
  in.tangential_force[0] = 0.3 * force * share * std::cos(angle);
  in.tangential_force[1] = 0.3 * force * share * std::sin(angle);
  return in;
}

// Running at 20 m/s, on rollers standing still above them.
inline rp_input running(rp_track track, double radius = 0.46, double roller_radius = 1.0) {
  rp_input in;
  rp_default_input(&in);
  in.pitch_rate = -20.0 / radius;
  if (track == RP_RAIL)
    in.speed = 20.0;
  else
    in.roller_pitch_rate = 20.0 / roller_radius;
  return in;
}

// Track that varies in all ways at once: rails on springs whose right profile turns inwards over
// 2 m, with friction that falls; must stay alive as long as its configs are read.
struct varying_track {
  profile_pair pair;
  profiles::curve turned = profiles::rail();
  rp_profile sections[2];
  double positions[2] = {1.0, 3.0};

  varying_track() {
    const double c = std::cos(0.01), s = std::sin(0.01);
    const auto turn = [&](std::vector<double> &y, std::vector<double> &z) {
      for (size_t i = 0; i < y.size(); ++i) {
        const double v = c * y[i] - s * z[i];
        z[i] = s * y[i] + c * z[i];
        y[i] = v;
      }
    };
    turn(turned.y, turned.z);
    turn(turned.dy, turned.dz);
    sections[0] = pair.rail.view();
    sections[1] = turned.view();
  }
  varying_track(const varying_track &) = delete;
  varying_track &operator=(const varying_track &) = delete;

  rp_config config(rp_kind kind) const {
    rp_config c = wheels(kind, RP_RAIL, pair);
    c.rail[RP_RIGHT] = rp_profile{};
    c.rail_sections[RP_RIGHT] = sections;
    c.section_position[RP_RIGHT] = positions;
    c.section_count[RP_RIGHT] = 2;
    c.friction_along_points = 2;
    c.friction_along_position[1] = 4.0;
    c.friction_along_factor[0] = 1.0;
    c.friction_along_factor[1] = 0.5;
    c.rail_stiffness[0] = 2e7;
    c.rail_stiffness[1] = 5e7;
    c.rail_damping[0] = 2e4;
    c.rail_damping[1] = 5e4;
    return c;
  }
  // along the track at 20 m/s
  static std::vector<rp_input> inputs() {
    std::vector<rp_input> all;
    for (int i = 0; i < 6; ++i) {
      all.push_back(running(RP_RAIL));
      all.back().x = 0.8 * i;
      all.back().y = 5e-4 * i;
      all.back().yaw = 1e-3;
      all.back().time_step = i > 0 ? 1e-3 : 0.0;
    }
    return all;
  }
};

// A switch: the right rail's sections by knot, of which the second has its knots elsewhere, cubic
// with a kink, placed by its profile's origin, under a wheel of four profiles round it; must stay
// alive as long as its configs are read.
struct turnout {
  profile_pair pair;
  std::vector<profiles::curve> rails, wheels;
  std::vector<rp_profile> rail_views, wheel_views;
  double positions[4] = {1.0, 2.0, 2.7, 3.5}, angles[4] = {0.0, 1.5, 3.0, 4.5};
  int32_t kinks[4] = {0, 1, 0, 0};

  turnout() {
    for (int k = 0; k < 4; ++k) {
      profiles::curve rail = pair.rail, wheel = pair.wheel;
      for (size_t i = 0; i < rail.s.size(); ++i) {
        rail.y[i] += 1e-3 * k;
        rail.z[i] += 2e-4 * (k % 3);
        // stretched about its begin
        const double stretch = 1 + 0.01 * (k % 2);
        rail.s[i] = rail.s[0] + stretch * (rail.s[i] - rail.s[0]);
        for (auto *of : {&rail.y, &rail.z}) (*of)[i] = (*of)[0] + stretch * ((*of)[i] - (*of)[0]);
      }
      for (double &z : wheel.z) z += 5e-5 * (k % 2);
      rails.push_back(rail);
      wheels.push_back(wheel);
    }
    for (size_t k = 0; k < 4; ++k) {
      rail_views.push_back(rails[k].view());
      wheel_views.push_back(wheels[k].view());
    }
  }
  turnout(const turnout &) = delete;
  turnout &operator=(const turnout &) = delete;

  rp_config config(rp_kind kind) const {
    rp_config c = scenes::wheels(kind, RP_RAIL, pair);
    c.rail[RP_RIGHT] = c.wheel[RP_RIGHT] = rp_profile{};
    c.rail_sections[RP_RIGHT] = rail_views.data();
    c.section_position[RP_RIGHT] = positions;
    c.section_kink[RP_RIGHT] = kinks;
    c.section_count[RP_RIGHT] = 4;
    c.wheel_sections[RP_RIGHT] = wheel_views.data();
    c.wheel_section_angle[RP_RIGHT] = angles;
    c.wheel_section_count[RP_RIGHT] = 4;
    c.section_match = RP_SECTIONS_BY_KNOT;
    c.section_blend = RP_SECTIONS_CUBIC;
    c.rail_origin_y[RP_RIGHT] = 0.754;
    c.rail_origin_z[RP_RIGHT] = 1e-4;
    return c;
  }
  // along the track at 20 m/s
  static std::vector<rp_input> inputs() {
    std::vector<rp_input> all;
    for (int i = 0; i < 6; ++i) {
      all.push_back(running(RP_RAIL));
      all.back().x = 0.6 * i + 0.7;
      all.back().pitch = -1.1 * i;
    }
    return all;
  }
};

// --- comparison ----------------------------------------------------------------------------

// Every number of a result, in order; padding left out.
template <class T, class Add>
void visit_member(const char *name, const T &member, Add &&add) {
  if constexpr (std::is_array_v<T>)
    for (const auto &part : member) visit_member(name, part, add);
  else
    add(name, member);
}

#define RP_VISIT(type, name, ...) visit_member(#name, r.name, add);
#define RP_VISIT_PARTS(type, name, count) \
  for (const type &part : r.name) visit(part, add);

template <class Add>
void visit(const rp_patch_result &r, Add &&add) {
  RP_PATCH_RESULT_FIELDS(RP_VISIT, RP_VISIT_PARTS)
}

template <class Add>
void visit(const rp_side_result &r, Add &&add) {
  RP_SIDE_RESULT_FIELDS(RP_VISIT, RP_VISIT_PARTS)
}

template <class Add>
void visit(const rp_result &r, Add &&add) {
  RP_RESULT_FIELDS(RP_VISIT, RP_VISIT_PARTS)
}

#undef RP_VISIT
#undef RP_VISIT_PARTS

struct number {
  std::string name;
  double value;
};

template <class Result>
std::vector<number> numbers(const Result &r) {
  std::vector<number> all;
  visit(r, [&](const char *name, double v) { all.push_back({name, v}); });
  return all;
}

// The first field whose bits differ, empty where there is none.
template <class Result>
std::string difference(const Result &a, const Result &b) {
  const std::vector<number> x = numbers(a), y = numbers(b);
  for (size_t i = 0; i < x.size(); ++i)
    if (std::bit_cast<uint64_t>(x[i].value) != std::bit_cast<uint64_t>(y[i].value))
      return x[i].name + " (number " + std::to_string(i) + "): " + std::to_string(x[i].value) +
             " and " + std::to_string(y[i].value);
  return {};
}

inline bool same_bits(const std::vector<double> &a, const std::vector<double> &b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

}  // namespace scenes
