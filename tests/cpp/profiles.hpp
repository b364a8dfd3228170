// Wheel and rail profiles made of lines and arcs: points, and derivatives by arc length, are exact.
//
// Right-hand profiles, from the flange or gauge side (-y) to the field side (+y), z down, m.
#pragma once

#include <cmath>
#include <vector>

#include "railpatch.h"

namespace profiles {

// A profile's arrays; they must outlive the rp_profile made of them.
struct curve {
  std::vector<double> s, y, z, dy, dz;

  rp_profile view() const {
    return {s.data(), y.data(), z.data(), dy.data(), dz.data(), static_cast<int32_t>(s.size())};
  }
};

// Draws lines and arcs one after the other, tangents joined. Slopes are inclinations atan2(dz, dy);
// curvature > 0 bends towards +z.
class pen {
 public:
  explicit pen(double angle) : angle_(angle) { add(); }

  void line(double length) { arc(length, 0); }
  void arc(double length, double curvature) {
    const int count = 1 + static_cast<int>(length / spacing);
    const double y0 = y_, z0 = z_, angle0 = angle_, s0 = s_;
    for (int i = 1; i <= count; ++i) {
      const double t = length * i / count, half = 0.5 * curvature * t;
      // chord of the arc; sin(half)/half is 1 for a line
      const double chord = half == 0 ? t : t * std::sin(half) / half;
      s_ = s0 + t;
      angle_ = angle0 + curvature * t;
      y_ = y0 + chord * std::cos(angle0 + half);
      z_ = z0 + chord * std::sin(angle0 + half);
      add();
    }
  }
  // an arc up to an inclination
  void turn_to(double angle, double radius) {
    arc(radius * std::fabs(angle - angle_), angle > angle_ ? 1 / radius : -1 / radius);
  }

  // The drawing, moved so that `y` is at (0, 0) of the profile.
  curve moved_to_origin(double y) const {
    curve c = drawn_;
    double z = 0;
    for (size_t i = 0; i + 1 < c.y.size(); ++i)
      if (c.y[i] <= y && y <= c.y[i + 1])
        z = c.z[i] + (c.z[i + 1] - c.z[i]) * (y - c.y[i]) / (c.y[i + 1] - c.y[i]);
    for (double &v : c.y) v -= y;
    for (double &v : c.z) v -= z;
    return c;
  }
  double y() const { return y_; }

 private:
  static constexpr double spacing = 5e-4;

  void add() {
    drawn_.s.push_back(s_);
    drawn_.y.push_back(y_);
    drawn_.z.push_back(z_);
    drawn_.dy.push_back(std::cos(angle_));
    drawn_.dz.push_back(std::sin(angle_));
  }

  curve drawn_;
  double s_ = 0, y_ = 0, z_ = 0, angle_;
};

// A wheel with a flange of 65 degrees, a root of 14 mm, a hollow transition of 330 mm and a cone of
// 1:40; the running circle is at y = 0, the flange's face about 38 mm from it.
inline curve wheel() {
  const double flange = 65 * M_PI / 180, cone = -1.0 / 40;
  // from the flange tip, which points down
  pen p(std::atan(0.2));
  p.turn_to(-flange, 0.012);
  p.line(0.006);
  p.turn_to(-0.12, 0.014);
  p.turn_to(std::atan(cone), 0.33);
  p.line(0.05);
  return p.moved_to_origin(p.y() - 0.055);
}

// A rail head with a crown of 300 mm, shoulders of 80 mm and corners of 13 mm, highest at y = 0.
inline curve rail() {
  pen p(-80 * M_PI / 180);
  p.line(0.01);
  p.turn_to(-0.2, 0.013);
  p.turn_to(-0.035, 0.08);
  const double begin = p.y();
  p.turn_to(0.035, 0.3);
  const double end = p.y();
  p.turn_to(0.2, 0.08);
  p.turn_to(80 * M_PI / 180, 0.013);
  p.line(0.01);
  return p.moved_to_origin(0.5 * (begin + end));
}

}  // namespace profiles
