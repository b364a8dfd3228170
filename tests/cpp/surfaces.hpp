// Wheel and rail or roller as surfaces in track axes, put together anew from their sizes and what
// moves: points from angles, heights by halving. Slow, and without any of the core's own geometry
// but the curve of a profile.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "geometry/geometry.hpp"
#include "profiles.hpp"

namespace surfaces {

using railpatch::profile;
using railpatch::side_motion;
using railpatch::track_config;
using railpatch::track_kind;
using railpatch::wheel_config;
using vector = std::array<double, 3>;
using matrix = std::array<vector, 3>;  // rows

inline vector times(const matrix &m, const vector &v) {
  vector out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) out[i] += m[i][k] * v[k];
  return out;
}
inline matrix times(const matrix &a, const matrix &b) {
  matrix out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k)
      for (size_t j = 0; j < 3; ++j) out[i][k] += a[i][j] * b[j][k];
  return out;
}
inline matrix transposed(const matrix &a) {
  matrix out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) out[i][k] = a[k][i];
  return out;
}
inline vector plus(const vector &a, const vector &b, double factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
inline double product(const vector &a, const vector &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const vector &a) { return std::sqrt(product(a, a)); }

// about an axis of unit length (Rodrigues)
inline matrix about(const vector &axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  matrix out;
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) out[i][k] = (1 - c) * axis[i] * axis[k] + (i == k ? c : 0.0);
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[k][j] += s * axis[i];
    out[j][k] -= s * axis[i];
  }
  return out;
}
constexpr vector ex{1, 0, 0}, ey{0, 1, 0}, ez{0, 0, 1};

inline railpatch::profile_view view(const profiles::curve &c) {
  return {c.s.data(),  c.y.data(),  c.z.data(),
          c.dy.data(), c.dz.data(), static_cast<int>(c.s.size())};
}

// A profile in its meridian plane.
struct meridian {
  const profile *curve;
  double sign;  // 1: rail, highest at least z
  double angle = 0, y = 0, z = 0;

  std::array<double, 2> at(double s) const {
    const auto p = curve->evaluate(s);
    return {y + std::cos(angle) * p.y - std::sin(angle) * p.z,
            z + std::sin(angle) * p.y + std::cos(angle) * p.z};
  }
  // arc length of the extreme, by sampling and thirds
  double extreme() const {
    const double step = (curve->end() - curve->begin()) / 2000;
    double best = curve->begin();
    for (int i = 0; i <= 2000; ++i)
      if (const double s = curve->begin() + i * step; sign * at(s)[1] < sign * at(best)[1])
        best = s;
    double low = std::max(curve->begin(), best - step), high = std::min(curve->end(), best + step);
    for (int i = 0; i < 80; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (sign * at(a)[1] < sign * at(b)[1] ? high : low) = sign * at(a)[1] < sign * at(b)[1] ? b : a;
    }
    return 0.5 * (low + high);
  }
  // z at a lateral position of what lies between two arc lengths with y growing; NaN beyond
  double height(double lateral, double from, double to) const {
    if (!(lateral >= at(from)[0] && lateral <= at(to)[0])) return std::nan("");
    double low = from, high = to;
    for (int i = 0; i < 55; ++i) {
      const double m = 0.5 * (low + high);
      (at(m)[0] <= lateral ? low : high) = m;
    }
    return at(0.5 * (low + high))[1];
  }
};

struct scene {
  profiles::curve wheel_points = profiles::wheel(), rail_points = profiles::rail();
  profile wheel_curve{view(wheel_points)}, rail_curve{view(rail_points)};
  wheel_config sizes{0.46, 1.36, -0.065, 0};
  track_config track;
  side_motion motion;
  double marker_y = 0, marker_z = 0;
  // by angle ahead of the lowest point, and by x
  std::function<double(double)> runout, rise;
  // arc lengths of what is looked at
  double wheel_from, wheel_to, rail_from, rail_to;

  explicit scene(track_kind kind)
      : track(kind == track_kind::rail ? track_config{kind, 1.435, 0.014, 0.025, 1.0 / 500, 0}
                                       : track_config{kind, 1.435, 0.014, 0, 0, 1.0}),
        wheel_from(wheel_curve.begin() + 0.018),
        wheel_to(wheel_curve.end()),
        rail_from(rail_curve.begin() + 0.012),
        rail_to(rail_curve.end() - 0.012) {
    // where the gauge is measured, and the top at z = 0
    meridian m{&rail_curve, 1, kind == track_kind::rail ? -track.cant : 0.0, 0, 0};
    const double top = m.extreme(), level = m.at(top)[1] + track.gauge_height;
    double least = m.at(top)[0];
    for (double s = top; s > rail_curve.begin() && m.at(s)[1] < level; s -= 2e-6)
      least = std::min(least, m.at(s)[0]);
    marker_y = 0.5 * track.gauge - least;
    marker_z = kind == track_kind::rail ? -m.at(top)[1] : 0;
  }
  bool roller() const { return track.kind == track_kind::roller; }

  // --- where the wheel stands ------------------------------------------------------------------

  vector centre() const { return {0, motion.wheelset.y, motion.wheelset.z - sizes.nominal_radius}; }
  matrix axes() const {
    return times(about(ex, motion.wheelset.roll), about(ez, motion.wheelset.yaw));
  }
  matrix wheel_axes() const { return times(axes(), about(ez, motion.wheel.rotation[2])); }
  vector axis_point() const {
    const double marker = 0.5 * sizes.flange_back_distance - sizes.flange_back_position;
    return plus(centre(), times(axes(), vector{motion.wheel.offset[0], marker, 0}));
  }
  vector axle() const {
    return {motion.rail.offset[0], 0, track.roller_radius + motion.rail.offset[2]};
  }
  meridian wheel_meridian() const {
    return {&wheel_curve, -1, motion.wheel.rotation[0], motion.wheel.offset[1],
            motion.wheel.offset[2]};
  }
  meridian rail_meridian() const {
    const double cant = roller() ? 0 : track.cant;
    return {&rail_curve, 1, motion.rail.rotation[0] - cant, marker_y + motion.rail.offset[1],
            marker_z + motion.rail.offset[2]};
  }

  // --- how far a point lies outside a surface ----------------------------------------------------

  double outside_wheel(const vector &p) const {
    const vector q = times(transposed(wheel_axes()), plus(p, axis_point(), -1));
    double r = sizes.nominal_radius + wheel_meridian().height(q[1], wheel_from, wheel_to);
    if (runout) r += runout(std::atan2(q[0], q[2]));
    return std::hypot(q[0], q[2]) - r;
  }
  double inside_rail(const vector &p) const {
    const double z = rail_meridian().height(p[1], rail_from, rail_to);
    if (!roller()) return p[2] - z + (rise ? rise(p[0]) : 0.0);
    const vector a = axle();
    return (a[2] - z) - std::hypot(p[0] - a[0], p[2] - a[2]);
  }
  // Height of a surface along n from a point, NaN where there is none.
  template <class F>
  static double along(const vector &from, const vector &n, F out) {
    double low = -0.004, high = 0.004;
    if (!(out(plus(from, n, low)) < 0 && out(plus(from, n, high)) > 0)) return std::nan("");
    for (int i = 0; i < 48; ++i) {
      const double m = 0.5 * (low + high);
      (out(plus(from, n, m)) < 0 ? low : high) = m;
    }
    return 0.5 * (low + high);
  }
  double wheel_height(const vector &from, const vector &n) const {
    return along(from, n, [&](const vector &p) { return outside_wheel(p); });
  }
  double rail_height(const vector &from, const vector &n) const {
    return along(from, n, [&](const vector &p) { return inside_rail(p); });
  }
  // Of the rail over the wheel, vertical.
  double gap(double x, double y, double z) const {
    return rail_height({x, y, z}, ez) - wheel_height({x, y, z}, ez);
  }
};

struct frame {
  vector origin, x, s, n;

  explicit frame(const railpatch::contact_frame &f) : origin(f.origin) {
    // turned about its own y by the inclination, then about its own x
    const matrix m = times(about(ey, -f.inclination), about(ex, f.contact_angle));
    for (size_t i = 0; i < 3; ++i) x[i] = m[i][0], s[i] = m[i][1], n[i] = m[i][2];
  }
  vector at(double along, double across) const { return plus(plus(origin, x, along), s, across); }
};

}  // namespace surfaces
