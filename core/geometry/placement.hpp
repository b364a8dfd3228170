// Where a wheel and its rail or roller stand and how they move: frames, velocities, creepages.
//
// The axes, signs and deviations of geometry.hpp. Templates on the scalar: double, or numbers that
// carry their rates of change (numeric/dual.hpp).
#pragma once

#include <array>
#include <cmath>
#include <type_traits>

#include "numeric/dual.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

template <class T>
using vec = std::array<T, 3>;
template <class T>
using mat = std::array<vec<T>, 3>;  // rows
using vec3 = vec<double>;
using mat3 = mat<double>;

template <class T>
struct basic_wheelset_state {
  T y = 0, z = 0;                                 // m
  T roll = 0, yaw = 0;                            // rad
  T speed = 0;                                    // m/s, of the track frame along the centre line
  T vy = 0, vz = 0;                               // m/s
  T roll_rate = 0, yaw_rate = 0, pitch_rate = 0;  // rad/s, relative to the track frame
};
using wheelset_state = basic_wheelset_state<double>;

template <class T>
struct basic_deviation {
  vec<T> offset{};            // m
  vec<T> rotation{};          // rad
  vec<T> velocity{};          // m/s
  vec<T> angular_velocity{};  // rad/s
};
using deviation = basic_deviation<double>;

enum class track_kind { rail, roller };

struct track_config {
  track_kind kind = track_kind::rail;
  double gauge = 0, gauge_height = 0;  // m
  double cant = 0;                     // rad, rail; > 0 leans towards the track centre
  double curvature = 0;                // 1/m, right-hand curve > 0
  double roller_radius = 0;            // m
  // m, rail: of its profile's origin where placed; else gauge and the rail's top say where it lies
  bool placed = false;
  double origin_y = 0, origin_z = 0;
};

struct wheel_config {
  double nominal_radius = 0, flange_back_distance = 0, flange_back_position = 0;  // m
  double standstill_speed = 0;                                                    // m/s
  // velocities of wheel and rail are those at one point, see contact_depth(); else of a point on
  // each, as the program CONTACT has it
  bool one_point = true;
};

// All that moves in a step, for one side.
template <class T>
struct basic_side_motion {
  basic_wheelset_state<T> wheelset;
  basic_deviation<T> wheel, rail;
  T roller_pitch_rate = 0;  // rad/s, > 0 forward
};
using side_motion = basic_side_motion<double>;

template <class T>
struct basic_contact_frame {
  vec<T> origin{};      // track axes, on the rail surface
  T contact_angle = 0;  // rad
  // rad, of the x axis below the track's: where a contact lies ahead of a roller's top, if asked
  // for
  double inclination = 0;
};
using contact_frame = basic_contact_frame<double>;

template <class T>
struct basic_creepage_state {
  T xi = 0, eta = 0;    // -, longitudinal, lateral
  T phi = 0;            // rad/m, spin
  T rolling_speed = 0;  // m/s, >= 0, what slip is divided by: geometry.hpp on standstill
  int direction = 0;    // rolling towards +x (1), -x (-1); 0 at standstill
};
using creepage_state = basic_creepage_state<double>;

template <class T>
vec<T> operator+(const vec<T> &a, const vec<T> &b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
vec<T> operator-(const vec<T> &a, const vec<T> &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
vec<T> operator*(const std::type_identity_t<T> &c, const vec<T> &a) {
  return {c * a[0], c * a[1], c * a[2]};
}
// Angular velocity of the wheelset but for its turning about the axle, track axes: roll about x,
// yaw about the z axis that the roll turned.
template <class T>
vec<T> swing_of(const basic_wheelset_state<T> &w) {
  return vec<T>{w.roll_rate, T(0), T(0)} + w.yaw_rate * vec<T>{T(0), -sin(w.roll), cos(w.roll)};
}

// All of it: with the pitch about the axle.
template <class T>
vec<T> angular_velocity(const basic_wheelset_state<T> &w) {
  const T d = cos(w.yaw);
  return swing_of(w) + w.pitch_rate * vec<T>{-sin(w.yaw), cos(w.roll) * d, sin(w.roll) * d};
}

template <class T>
T dot(const vec<T> &a, const vec<T> &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
vec<T> cross(const vec<T> &a, const vec<T> &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
vec<T> turn(const mat<T> &m, const vec<T> &a) {
  return {dot(m[0], a), dot(m[1], a), dot(m[2], a)};
}
template <class T>
vec<T> column(const mat<T> &m, size_t j) {
  return {m[0][j], m[1][j], m[2][j]};
}
template <class T>
vec<T> turn_back(const mat<T> &m, const vec<T> &a) {
  return {dot(column(m, 0), a), dot(column(m, 1), a), dot(column(m, 2), a)};
}

// Rx(roll) Rz(yaw): its first row has no z component, which keeps the locus in closed form
template <class T>
mat<T> roll_yaw(const T &roll, const T &yaw) {
  const T c = cos(roll), s = sin(roll), d = cos(yaw), t = sin(yaw);
  return {{{d, -t, T(0)}, {c * t, c * d, -s}, {s * t, s * d, c}}};
}

template <class T>
struct frame_axes {
  vec<T> x, s, n;
};
template <class T>
frame_axes<T> axes_of(const basic_contact_frame<T> &f) {
  const T c = cos(f.contact_angle), s = sin(f.contact_angle);
  if (f.inclination == 0) return {{T(1), T(0), T(0)}, {T(0), c, s}, {T(0), -s, c}};
  const double d = cos(f.inclination), t = sin(f.inclination);
  return {{T(d), T(0), T(t)}, {-t * s, c, d * s}, {-t * c, -s, d * c}};
}

// whether its velocities are to be looked at
inline bool moves(const deviation &d) {
  return d.velocity != vec3{} || d.angular_velocity != vec3{};
}
template <int n>
bool moves(const basic_deviation<dual<n>> &) {
  return true;
}

// What slip is divided by at the rolling speed V, and the part of the spin creepage that stays as
// the heading h turns: see geometry.hpp, Standstill.
template <class T>
T slip_divisor(const T &speed, double slow) {
  return speed < slow ? 0.5 * (speed * speed + slow * slow) / slow : speed;
}
template <class T>
T turning_share(const T &heading, double slow) {
  using std::fabs;
  const T t = fabs(heading);
  return t < slow ? 0.5 * (t / slow) * (3.0 - (t / slow) * (t / slow)) : T(1);
}

template <class T>
struct placement {
  static constexpr double standstill = 1e-12;  // m/s

  wheel_config sizes_;
  track_config track_;
  double marker_y_ = 0, marker_z_ = 0;  // m, rail
  basic_side_motion<T> motion_;
  T axle_z_ = 0, axle_x_ = 0;             // roller
  vec<T> centre_{};                       // wheelset
  vec<T> axis_origin_{}, axis_offset_{};  // of this wheel, from track origin and wheelset centre
  mat<T> wheelset_axes_{}, wheel_axes_{};

  void place_axes(const basic_side_motion<T> &motion) {
    motion_ = motion;
    const basic_wheelset_state<T> &w = motion.wheelset;
    const double marker = 0.5 * sizes_.flange_back_distance - sizes_.flange_back_position;
    wheelset_axes_ = roll_yaw(w.roll, w.yaw);
    wheel_axes_ = roll_yaw(w.roll, T(w.yaw + motion.wheel.rotation[2]));
    // the wheel's own yaw turns about its marker's plane, where u = 0 then lies
    axis_offset_ = turn(wheelset_axes_, {motion.wheel.offset[0], T(marker), T(0)});
    axle_x_ = motion.rail.offset[0];
    axle_z_ = track_.roller_radius + motion.rail.offset[2];
  }
  void place_centre() {
    centre_ = {T(0), motion_.wheelset.y, motion_.wheelset.z - sizes_.nominal_radius};
    axis_origin_ = centre_ + axis_offset_;
  }

  // Velocity of the wheel's material by the rates of its deviation, but for the one about its axis.
  vec<T> wheel_rate(const vec<T> &at) const {
    const basic_deviation<T> &d = motion_.wheel;
    const vec<T> own = turn_back(wheelset_axes_, at - axis_origin_);
    const vec<T> below = own - vec<T>{T(0), d.offset[1], sizes_.nominal_radius + d.offset[2]};
    const vec<T> rate = d.velocity + cross({d.angular_velocity[0], T(0), T(0)}, below) +
                        cross({T(0), T(0), d.angular_velocity[2]}, own);
    return turn(wheelset_axes_, rate);
  }

  // The same of the rail; of a roller without the rate about its axle.
  vec<T> rail_rate(const vec<T> &at) const {
    const basic_deviation<T> &d = motion_.rail;
    const vec<T> origin = vec<T>{T(0), T(marker_y_), T(marker_z_)} + d.offset;
    vec<T> spin = d.angular_velocity;
    if (track_.kind == track_kind::roller) spin[1] = T(0);
    return d.velocity + cross(spin, at - origin);
  }

  basic_creepage_state<T> creepages(const basic_contact_frame<T> &frame, const T &approach) const;

  // Where the velocities of both surfaces, as far from it as their curvatures along x say, agree
  // when they roll on each other: the same point for both lets a common motion of both make no slip
  // and gives back as power what the creepages take.
  T contact_depth(const basic_contact_frame<T> &frame, const T &approach) const {
    using std::sqrt;
    if (!sizes_.one_point) return T(0);
    if (track_.kind == track_kind::rail) return approach;
    const T ahead = frame.origin[0] - axle_x_, below = axle_z_ - frame.origin[2];
    const T radius = sqrt(ahead * ahead + below * below);
    return approach * radius / (radius + rolling_radius(frame, approach));
  }

  vec<T> lever(const basic_contact_frame<T> &frame) const { return frame.origin - centre_; }

  T rolling_radius(const basic_contact_frame<T> &frame, const T &approach) const {
    return on_axle(frame, approach)[1];
  }

  // The contact reference in the axes of the wheel's profile, y and z, as it was given.
  std::array<T, 2> on_wheel_profile(const basic_contact_frame<T> &frame, const T &approach) const {
    const std::array<T, 2> at = on_axle(frame, approach);
    const basic_deviation<T> &d = motion_.wheel;
    return turned_back(d.rotation[0], at[0] - d.offset[1],
                       at[1] - sizes_.nominal_radius - d.offset[2]);
  }
  // The same of the rail's.
  std::array<T, 2> on_rail_profile(const basic_contact_frame<T> &frame) const {
    using std::sqrt;
    const basic_deviation<T> &d = motion_.rail;
    T angle = d.rotation[0], z = frame.origin[2];
    if (track_.kind == track_kind::roller) {
      const T ahead = frame.origin[0] - axle_x_, below = axle_z_ - z;
      z = axle_z_ - sqrt(ahead * ahead + below * below);
    } else {
      angle -= track_.cant;
    }
    return turned_back(angle, frame.origin[1] - marker_y_ - d.offset[1],
                       z - marker_z_ - d.offset[2]);
  }

 private:
  // m, along the axle from the profile's plane, and from the axle.
  std::array<T, 2> on_axle(const basic_contact_frame<T> &frame, const T &approach) const {
    using std::sqrt;
    const vec<T> at = frame.origin + approach * axes_of(frame).n - axis_origin_;
    const vec<T> axis = column(wheel_axes_, 1);
    const T along = dot(at, axis);
    const vec<T> off_axis = at - along * axis;
    return {along, sqrt(dot(off_axis, off_axis))};
  }
  static std::array<T, 2> turned_back(const T &angle, const T &y, const T &z) {
    const T c = cos(angle), s = sin(angle);
    return {c * y + s * z, c * z - s * y};
  }
};

template <class T>
basic_creepage_state<T> placement<T>::creepages(const basic_contact_frame<T> &frame,
                                                const T &approach) const {
  using std::fabs;
  const basic_wheelset_state<T> &w = motion_.wheelset;
  const frame_axes<T> f = axes_of(frame);
  const T depth = contact_depth(frame, approach);
  const vec<T> under = frame.origin + depth * f.n;
  const vec<T> at = sizes_.one_point ? under : frame.origin + approach * f.n;
  // the track frame follows the centre line: in a curve it turns about its z axis
  const vec<T> frame_spin{T(0), T(0), track_.curvature * w.speed};
  const vec<T> swing = swing_of(w);
  const vec<T> &wheel_spin = motion_.wheel.angular_velocity,
               &rail_spin = motion_.rail.angular_velocity;
  const bool wheel_moves = moves(motion_.wheel), rail_moves = moves(motion_.rail);
  const vec<T> roll = (w.pitch_rate + wheel_spin[1]) * column(wheel_axes_, 1);
  vec<T> carried = vec<T>{w.speed, w.vy, w.vz} + cross(frame_spin, at) + cross(swing, at - centre_);
  if (wheel_moves) carried = carried + wheel_rate(at);
  const vec<T> turned = cross(roll, at - axis_origin_);
  const vec<T> roller_spin{T(0), motion_.roller_pitch_rate + rail_spin[1], T(0)};
  const bool roller = track_.kind == track_kind::roller;
  vec<T> slip = carried + turned, spin = frame_spin + swing + roll;
  if (wheel_moves) spin = spin + turn(wheelset_axes_, {wheel_spin[0], T(0), wheel_spin[2]});
  if (rail_moves) spin = spin - (roller ? vec<T>{rail_spin[0], T(0), rail_spin[2]} : rail_spin);
  T forward = carried[0], backward = turned[0];
  if (rail_moves && !roller) {
    const vec<T> below = rail_rate(under);
    forward -= below[0];
    slip = slip - below;
  }
  if (roller) {
    vec<T> below = cross(roller_spin, under - vec<T>{axle_x_, T(0), axle_z_});
    if (rail_moves) below = below + rail_rate(under);
    forward = -below[0];
    backward = slip[0];
    slip = slip - below;
    spin = spin - roller_spin;
  }
  basic_creepage_state<T> out;
  const T mean = 0.5 * (fabs(forward) + fabs(backward));
  const double slow = sizes_.standstill_speed;
  const bool rolls = mean > standstill;
  if (!rolls && slow == 0) return out;
  const T difference = forward - backward;
  const T heading = fabs(difference) > standstill ? difference : forward;
  if (rolls) out.direction = heading > 0 ? 1 : -1;
  const T speed = slip_divisor(mean, slow);
  out.rolling_speed = speed;
  out.xi = slip[0] / speed;
  out.eta = dot(f.s, slip) / speed;
  out.phi = dot(f.n, spin) / speed * turning_share(T(0.5 * difference), slow);
  return out;
}

}  // namespace railpatch
