// Pose and velocity of a wheelset as the columns of rp_jacobian, and the force and moment of a
// wheel as its rows.
#pragma once

#include "wheel/input_numbers.hpp"

namespace railpatch {

constexpr int jacobian_columns = 12, z_column = 2, roll_column = 3, pitch_rate_column = 11;

inline double *pose_and_velocity(rp_input &in, int column) {
  double *const numbers[jacobian_columns] = {&in.x,   &in.y,         &in.z,        &in.roll,
                                             &in.yaw, &in.pitch,     &in.speed,    &in.vy,
                                             &in.vz,  &in.roll_rate, &in.yaw_rate, &in.pitch_rate};
  return numbers[column];
}

inline rp_input unit_direction(const rp_input &like, int column) {
  rp_input d = like;
  for_each_number(d, [](const char *, double &v, double) { v = 0; });
  *pose_and_velocity(d, column) = 1.0;
  return d;
}

// force and moment, one after the other
inline double component(const rp_side_result &side, int i) {
  return i < 3 ? side.force[i] : side.moment[i - 3];
}

}  // namespace railpatch
