// How surfaces of blended sections move as their position does: the rail's with the place along
// the track, the wheel's with its pitch.
#include "geometry/geometry.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// Of a point at an arc length, with the profile's turning.
section_rate placed_rate(const profile_sections &sections, const placed_profile &on, double p) {
  const profile &curve = on.curve();
  const int piece = curve.interval(p);
  const profile_piece at = curve.piece_at(piece);
  const section_rate r = sections.rate(piece, (p - at.begin) / (at.end - at.begin));
  const double c = cos(on.angle()), s = sin(on.angle());
  return {c * r.y - s * r.z, s * r.y + c * r.z, c * r.dy - s * r.dz, s * r.dy + c * r.dz};
}

}  // namespace

void side_geometry::set_sections(const profile_sections *rail, const profile_sections *wheel) {
  rail_sections_ = rail;
  wheel_sections_ = wheel;
}

double side_geometry::section_place(const side_motion &motion) const {
  placement<double> at;
  at.sizes_ = sizes_;
  at.place_axes(motion);
  return at.axis_offset_[0] - motion.rail.offset[0];
}

// Where no place is given the profile's own top and face say it: at the height below the top that
// the face is taken at, or where it lies furthest in.
void side_geometry::find_marker_rates(const placed_profile::inner_face &face) {
  const double top = placed_rate(*rail_sections_, rail_, rail_.extreme()).z;
  const section_rate at = placed_rate(*rail_sections_, rail_, face.s);
  double inwards = at.y;
  if (face.at_height) {
    const curve_point p = rail_.evaluate(face.s);
    inwards -= p.dy / p.dz * (at.z - top);
  }
  marker_rate_[0] = -inwards;
  marker_rate_[1] = -top;
}

section_rate side_geometry::rail_rate_at(double p) const {
  section_rate r = placed_rate(*rail_sections_, rail_, p);
  r.y += marker_rate_[0];
  r.z += marker_rate_[1];
  return r;
}

section_growth side_geometry::section_growth_at(double s, const locus_point &l) const {
  section_growth out;
  double p;
  if (rail_sections_ && rail_.find(l.wheel[1], p)) {
    // z(y) of the rail changes by what its point moves across the tangent
    const curve_point m = rail_.evaluate(p);
    const section_rate r = rail_rate_at(p);
    const double slope = m.dz / m.dy, bend = (m.d2z * m.dy - m.dz * m.d2y) / (m.dy * m.dy);
    out.depth[0] = -(r.z - slope * r.y);
    out.angle[0] = (r.dz - bend * r.y - slope * r.dy) / m.dy / (1 + slope * slope);
  }
  if (wheel_sections_) {
    const section_rate r = placed_rate(*wheel_sections_, wheel_, s);
    const double cosine = std::sqrt(1 - l.sine * l.sine);
    out.depth[1] = dot(l.normal, turn(wheel_axes_, {r.z * l.sine, r.y, r.z * cosine}));
  }
  return out;
}

void side_geometry::section_heights(body which, const contact_frame &frame, const surface_grid &g,
                                    section_visitor &visitor) const {
  const bool rail = which == body::rail;
  const frame_axes<double> f = axes_of(frame);
  const vec3 from = turn_back(wheel_axes_, frame.origin - axis_origin_);
  const vec3 across = turn_back(wheel_axes_, f.s), n = turn_back(wheel_axes_, f.n);
  surface_grid centre = g;
  centre.nx = 1;
  centre.x0 = 0;
  each_element use([&](int, int row, double p, double height) {
    if (rail) {
      const curve_point m = rail_.evaluate(p);
      const section_rate r = rail_rate_at(p);
      return visitor.meet(row, (m.dy * r.z - m.dz * r.y) / (m.dy * f.n[2] - m.dz * f.n[1]));
    }
    const curve_point m = wheel_.evaluate(p);
    const section_rate r = placed_rate(*wheel_sections_, wheel_, p);
    const vec3 q = from + (g.y0 + row * g.dy) * across + height * n;
    const double radius = sizes_.nominal_radius + m.z;
    const double outwards = (q[0] * n[0] + q[2] * n[2]) / radius;
    visitor.meet(row, (m.dy * r.z - m.dz * r.y) / (m.dy * outwards - m.dz * n[1]));
  });
  meet_surface(which, frame, centre, use);
}

vec3 side_geometry::pitch_direction() const {
  const double roll = motion_.wheelset.roll;
  return {0, cos(roll) / wheel_axes_[0][0], sin(roll) / wheel_axes_[0][0]};
}

}  // namespace railpatch
