#include "frames.hpp"

#include <algorithm>
#include <cmath>

#include "angles.hpp"
#include "solve.hpp"

namespace contact_addon {

namespace {

matrix3 times(const matrix3 &a, const matrix3 &b) {
  matrix3 out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      for (size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
  return out;
}

matrix3 about_x(double angle) {
  const double c = contact_addon::cos(angle), s = contact_addon::sin(angle);
  return {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
}

matrix3 about_z(double angle) {
  const double c = contact_addon::cos(angle), s = contact_addon::sin(angle);
  return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

vector3 turned(const matrix3 &m, const vector3 &v) {
  vector3 out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) out[i] += m[i][k] * v[k];
  return out;
}

vector3 plus(const vector3 &a, const vector3 &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

}  // namespace

vector3 minus(const vector3 &a, const vector3 &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

vector3 cross(const vector3 &a, const vector3 &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

vector3 marker::inside(const vector3 &track) const {
  vector3 out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) out[i] += axes[k][i] * track[k];
  return out;
}

vector3 marker::point_inside(const vector3 &track) const { return inside(minus(track, place)); }

// As the rails are placed by railpatch.h: the top at z = 0 (rollers: the marker), the gauge side
// half the gauge from the track's centre.
std::array<double, 2> design_place(const profile_curve &rail, bool roller, double gauge,
                                   double gauge_height, double cant) {
  const double c = contact_addon::cos(-cant), s = contact_addon::sin(-cant);
  const auto at = [&](double arc, double &y, double &z) {
    double y0, z0, slope;
    rail.at(arc, y0, z0, slope);
    y = c * y0 - s * z0;
    z = s * y0 + c * z0;
  };
  constexpr int parts = 16;
  const size_t pieces = rail.y.size() - 1;
  const auto arc_of = [&](size_t k) {
    const size_t piece = std::min(k / parts, pieces - 1);
    const double share = static_cast<double>(k - piece * parts) / parts;
    return rail.arc_length[piece] + share * (rail.arc_length[piece + 1] - rail.arc_length[piece]);
  };
  // the top, by thirds about the highest of many points
  size_t best = 0;
  double least = HUGE_VAL, y, z;
  for (size_t k = 0; k <= pieces * parts; ++k) {
    at(arc_of(k), y, z);
    if (z < least) least = z, best = k;
  }
  double low = arc_of(best > 0 ? best - 1 : 0), high = arc_of(std::min(best + 1, pieces * parts));
  for (int i = 0; i < 100; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    double za, zb;
    at(a, y, za);
    at(b, y, zb);
    (za < zb ? high : low) = za < zb ? b : a;
  }
  at(0.5 * (low + high), y, z);
  const double top = z, level = top + gauge_height;
  // the innermost point above the gauge's height; where it is the crossing itself, that
  double inner = HUGE_VAL;
  for (size_t k = 0; k <= pieces * parts; ++k) {
    at(arc_of(k), y, z);
    if (z <= level) inner = std::min(inner, y);
    if (k == 0) continue;
    double z_before, y_before;
    at(arc_of(k - 1), y_before, z_before);
    if ((z_before <= level) == (z <= level)) continue;
    double a = arc_of(k - 1), b = arc_of(k);
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (a + b);
      at(middle, y, z);
      ((z <= level) == (z_before <= level) ? a : b) = middle;
    }
    at(a, y, z);
    inner = std::min(inner, y);
  }
  return {0.5 * gauge - inner, roller ? 0.0 : -top};
}

frames frames_of(const problem &p) {
  const wheel_data &w = p.wheel;
  const rp_config &c = p.mapped.config;
  const int s = p.side();
  const double side = p.left() ? -1.0 : 1.0;
  frames f;
  const std::array<double, 2> place =
      w.gauge_height > 0
          ? design_place(profile_now(p, true), p.roller(), c.gauge, c.gauge_height, c.cant)
          : std::array<double, 2>{side * c.rail_origin_y[s], c.rail_origin_z[s]};
  f.rail_roll = -side * c.cant + p.input.rail_rotation[s][0];
  f.rail.place = {0, side * place[0] + p.input.rail_offset[s][1],
                  place[1] + p.input.rail_offset[s][2]};
  const double *deflection = p.at_side().rail_deflection;
  for (size_t k = 0; k < 2; ++k)
    if (std::isfinite(deflection[k])) f.rail.place[1 + k] += deflection[k];
  f.rail.axes = about_x(f.rail_roll);
  const double z = p.result.z;
  f.wheelset.place = {0, w.position[1], z - w.nominal_radius};
  f.wheelset.axes = times(about_x(w.position[3]), about_z(w.position[4]));
  const double *d = w.flexibility;
  const double middle = 0.5 * w.flange_back_distance - w.flange_back_position;
  const vector3 own{d[0], side * middle + d[1], w.nominal_radius + d[2]};
  f.wheel.place = plus(f.wheelset.place, turned(f.wheelset.axes, own));
  f.wheel_roll = w.position[3] + d[3];
  f.wheel_yaw = w.position[4] + d[4];
  f.wheel.axes = times(times(about_x(w.position[3]), about_z(f.wheel_yaw)), about_x(d[3]));
  return f;
}

wrench wrench_of(const problem &p, const rp_patch_result &r) {
  const double c = contact_addon::cos(r.contact_angle), s = contact_addon::sin(r.contact_angle);
  const vector3 across{0, c, s}, normal{0, -s, c};
  const vector3 centre{0, p.wheel.position[1], p.result.z - p.wheel.nominal_radius};
  wrench out;
  for (size_t k = 0; k < 3; ++k)
    out.force[k] = -r.normal_force * normal[k] + r.creep_force[1] * across[k] +
                   (k == 0 ? r.creep_force[0] : 0.0);
  const vector3 lever = minus({r.position[0], r.position[1], r.position[2]}, centre);
  out.moment = cross(lever, out.force);
  for (size_t k = 0; k < 3; ++k) out.moment[k] += r.spin_moment * normal[k];
  return out;
}

}  // namespace contact_addon
