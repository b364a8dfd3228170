#include "wheel/wheelset_power.hpp"

#include "geometry/placement.hpp"
#include "numeric/dual.hpp"

namespace railpatch {

namespace {

using rated = dual<1>;

rated with_rate(double value, double rate) {
  rated v(value);
  v.rate[0] = rate;
  return v;
}

template <class T>
T power(const basic_wheelset_state<T> &w, const vec<T> &force, const vec<T> &moment) {
  return dot(force, vec<T>{w.speed, w.vy, w.vz}) + dot(moment, angular_velocity(w));
}

}  // namespace

// along the axle, as what turns about it at 1 rad/s does
double axle_torque(const rp_input &in, const double *m) {
  wheelset_state w;
  w.roll = in.roll;
  w.yaw = in.yaw;
  w.pitch_rate = 1.0;
  return dot(vec3{m[0], m[1], m[2]}, angular_velocity(w));
}

double axle_torque_rate(const rp_input &in, const rp_input &d, const double *m,
                        const double *rate) {
  basic_wheelset_state<rated> w;
  w.roll = with_rate(in.roll, d.roll);
  w.yaw = with_rate(in.yaw, d.yaw);
  w.pitch_rate = rated(1.0);
  vec<rated> moment;
  for (size_t k = 0; k < 3; ++k) moment[k] = with_rate(m[k], rate[k]);
  return dot(moment, angular_velocity(w)).rate[0];
}

double wheelset_power(const rp_input &in, const force_and_moment &on) {
  const wheelset_state w{in.y,  in.z,  in.roll,      in.yaw,      in.speed,
                         in.vy, in.vz, in.roll_rate, in.yaw_rate, in.pitch_rate};
  const double *f = on.force, *m = on.moment;
  return power<double>(w, {f[0], f[1], f[2]}, {m[0], m[1], m[2]});
}

double wheelset_power_rate(const rp_input &in, const rp_input &d, const force_and_moment &on,
                           const force_and_moment &rate) {
  const basic_wheelset_state<rated> w{with_rate(in.y, d.y),
                                      with_rate(in.z, d.z),
                                      with_rate(in.roll, d.roll),
                                      with_rate(in.yaw, d.yaw),
                                      with_rate(in.speed, d.speed),
                                      with_rate(in.vy, d.vy),
                                      with_rate(in.vz, d.vz),
                                      with_rate(in.roll_rate, d.roll_rate),
                                      with_rate(in.yaw_rate, d.yaw_rate),
                                      with_rate(in.pitch_rate, d.pitch_rate)};
  vec<rated> force, moment;
  for (size_t k = 0; k < 3; ++k) {
    force[k] = with_rate(on.force[k], rate.force[k]);
    moment[k] = with_rate(on.moment[k], rate.moment[k]);
  }
  return power<rated>(w, force, moment).rate[0];
}

}  // namespace railpatch
