// Every double of an input, in order.
#pragma once

#include <cmath>

#include "railpatch.h"

namespace railpatch {

// at most, for an array of them
constexpr int most_input_numbers = 128;

// f(name, number, scale): scale is what changes it by a good part of what matters, of numbers that
// are zero at rest; 0: the number itself is its scale.
template <class Input, class F>
void for_each_number(Input &in, F &&f) {
  f("normal_force", in.normal_force, 0.0);
  f("approach", in.approach, 0.0);
  for (auto &v : in.creepage) f("creepage", v, 1e-3);
  for (auto &v : in.tangential_force) f("tangential_force", v, 0.0);
  f("spin_creepage", in.spin_creepage, 0.1);
  f("rolling_speed", in.rolling_speed, 0.0);
  for (auto &v : in.bulk_temperature) f("bulk_temperature", v, 10.0);
  f("distance", in.distance, 0.0);
  f("x", in.x, 1e-3);
  f("pitch", in.pitch, 1e-3);
  f("y", in.y, 1e-3);
  f("z", in.z, 1e-4);
  f("vertical_force", in.vertical_force, 0.0);
  f("roll", in.roll, 1e-4);
  f("yaw", in.yaw, 1e-3);
  f("speed", in.speed, 1.0);
  f("vy", in.vy, 0.01);
  f("vz", in.vz, 0.01);
  f("roll_rate", in.roll_rate, 0.01);
  f("yaw_rate", in.yaw_rate, 0.01);
  f("pitch_rate", in.pitch_rate, 1.0);
  for (auto &row : in.wheel_offset)
    for (auto &v : row) f("wheel_offset", v, 1e-4);
  for (auto &row : in.wheel_rotation)
    for (auto &v : row) f("wheel_rotation", v, 1e-3);
  for (auto &row : in.rail_offset)
    for (auto &v : row) f("rail_offset", v, 1e-4);
  for (auto &row : in.rail_rotation)
    for (auto &v : row) f("rail_rotation", v, 1e-3);
  for (auto &row : in.wheel_velocity)
    for (auto &v : row) f("wheel_velocity", v, 0.01);
  for (auto &row : in.wheel_angular_velocity)
    for (auto &v : row) f("wheel_angular_velocity", v, 0.01);
  for (auto &row : in.rail_velocity)
    for (auto &v : row) f("rail_velocity", v, 0.01);
  for (auto &row : in.rail_angular_velocity)
    for (auto &v : row) f("rail_angular_velocity", v, 0.01);
  f("time_step", in.time_step, 1e-3);
  f("roller_pitch_rate", in.roller_pitch_rate, 1.0);
  f("friction_coefficient", in.friction_coefficient, 0.1);
}

}  // namespace railpatch
