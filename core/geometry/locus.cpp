// Where wheel and rail are closest, along the wheel's profile.
#include <algorithm>
#include <cmath>

#include "geometry/geometry.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

// Sine of the angle along the circumference. With P = (r sin, u, r cos) and the normal
// N = (sin du, -dr, cos du) in wheel axes, a rail asks for N_x = 0 in track axes; a roller for
// equal slopes -N_x/N_z = (x - axle)/(axle_z - z), with z = wheel's z + gap the roller's.
double side_geometry::locus_sine(const curve_point &p, double gap, double tolerance) const {
  const mat3 &m = wheel_axes_;
  double sine = m[0][1] * p.dz / (m[0][0] * p.dy);
  if (track_.kind == track_kind::rail) return sine;
  const double r = sizes_.nominal_radius + p.z;
  double change = 1;
  for (int i = 0; i < 8 && std::fabs(change) > tolerance; ++i) {
    sine = std::clamp(sine, -0.9, 0.9);
    const double cosine = std::sqrt(1 - sine * sine);
    const vec3 n = turn(m, {sine * p.dy, -p.dz, cosine * p.dy});
    const vec3 at = wheel_point(p, sine);
    const double reach = axle_z_ - at[2] - gap;
    const double f = -n[0] / n[2] - (at[0] - axle_x_) / reach;
    const double dnx = m[0][0] * p.dy * cosine;
    const double dnz = (m[2][0] * cosine - m[2][2] * sine) * p.dy;
    const double slope = -(dnx * n[2] - n[0] * dnz) / (n[2] * n[2]) - m[0][0] * r * cosine / reach;
    change = f / slope * cosine;
    sine -= change;
  }
  return sine;
}

vec3 side_geometry::wheel_point(const curve_point &p, double sine) const {
  const double r = sizes_.nominal_radius + p.z;
  return axis_origin_ + turn(wheel_axes_, {r * sine, p.y, r * std::sqrt(1 - sine * sine)});
}

bool side_geometry::rail_point(double x, double y, double &z, curve_point &p,
                               profile_place &last) const {
  double s;
  if (!rail_.find(y, s, p, last)) return false;
  z = p.z;
  if (shape_) z -= shape_->height(x);
  if (track_.kind == track_kind::rail) return true;
  const double r = axle_z_ - p.z, dx = x - axle_x_;
  if (!(r * r > dx * dx)) return false;
  z = axle_z_ - std::sqrt(r * r - dx * dx);
  return true;
}

bool side_geometry::rail_surface(double x, double y, double &z, double &angle) const {
  curve_point p;
  profile_place anywhere;
  const bool there = rail_point(x, y, z, p, anywhere);
  if (there) angle = inclination(p);
  return there;
}

double side_geometry::gap(double s, locus_place &last) const {
  if (shape_) {
    const locus_point l = locus(s, last);
    return l.valid ? l.gap : far_apart;
  }
  double slope;
  return gap(s, last, slope);
}

// Of the slope: at the locus the gap does not change with x, so that only the way of its point in y
// counts, with what that moves by its turning along the circumference.
double side_geometry::gap(double s, locus_place &last, double &slope) const {
  slope = 0;
  last.wheel = wheel_.curve().interval(s, last.wheel);
  const curve_point p = wheel_.evaluate(s, last.wheel);
  if (!wheel_.curve().covers(s) || !(p.dy > 0)) return far_apart;
  const double sine = locus_sine(p, sampled_gap(s), 1e-7);
  if (!(std::fabs(sine) < 0.9)) return far_apart;
  const vec3 at = wheel_point(p, sine);
  double z;
  curve_point rail;
  if (!rail_point(at[0], at[1], z, rail, last.rail)) return far_apart;
  const double cosine = std::sqrt(1 - sine * sine), r = sizes_.nominal_radius + p.z;
  const vec3 along = turn(wheel_axes_, {p.dz * sine, p.dy, p.dz * cosine});
  double rise = rail.dz / rail.dy, across = along[2];
  if (track_.kind == track_kind::roller) {
    const double ahead = at[0] - axle_x_, above = axle_z_ - z;
    rise *= (axle_z_ - rail.z) / above;
    across -= ahead / above * along[0];
  }
  const double turning =
      wheel_axes_[0][1] / wheel_axes_[0][0] * (p.d2z * p.dy - p.dz * p.d2y) / (p.dy * p.dy) * r;
  const double aside = turning * (wheel_axes_[1][0] - wheel_axes_[1][2] * sine / cosine) / along[1];
  slope = (rise * along[1] - across) * (1 + aside);
  return z - at[2];
}

locus_point side_geometry::locus(double s, locus_place &last) const {
  locus_point l;
  last.wheel = wheel_.curve().interval(s, last.wheel);
  const curve_point p = wheel_.evaluate(s, last.wheel);
  if (!wheel_.curve().covers(s) || !(p.dy > 0)) return l;
  const double sine = locus_sine(p, sampled_gap(s), 1e-7);
  if (!(std::fabs(sine) < 0.9)) return l;
  l.sine = sine;
  l.wheel = wheel_point(p, sine);
  curve_point rail;
  l.valid = rail_point(l.wheel[0], l.wheel[1], l.rail_z, rail, last.rail);
  if (!l.valid) return l;
  l.contact_angle = inclination(rail);
  l.gap = l.rail_z - l.wheel[2];
  const double cosine = std::sqrt(1 - sine * sine);
  const vec3 normal = turn(wheel_axes_, {sine * p.dy, -p.dz, cosine * p.dy});
  l.normal = (1 / normal[2]) * normal;
  // as the search asks for
  if (track_.kind == track_kind::rail) l.normal[0] = 0;
  // how the gap opens in x
  l.curvature = 0.5 / (sizes_.nominal_radius + p.z);
  if (track_.kind == track_kind::roller) l.curvature += 0.5 / (axle_z_ - l.rail_z);
  if (shape_) find_closest(p, sine, l);
  return l;
}

longitudinal_row side_geometry::row_of(const curve_point &p, double sine, double gap) const {
  const double r = sizes_.nominal_radius + p.z;
  longitudinal_row row;
  row.shape = shape_;
  row.angle = asin(sine);
  row.radius = r;
  row.gap = gap;
  row.x0 = wheel_point(p, sine)[0];
  row.advance = wheel_axes_[0][0] * r;
  row.bend = track_.kind == track_kind::roller ? 0.5 / axle_z_ : 0.0;
  return row;
}

// What a yawed wheel's meridian plane moves sideways on the way to x.
double side_geometry::sideways(double x, double sine, const curve_point &p) const {
  return wheel_axes_[1][0] / wheel_axes_[0][0] * (x - wheel_point(p, sine)[0]);
}

// From the round wheel on the level rail to the least gap of the row.
void side_geometry::find_closest(const curve_point &p, double sine, locus_point &l) const {
  const double level = l.gap + shape_->height(l.wheel[0]);
  const longitudinal_row row = row_of(p, sine, level);
  double angle;
  l.gap = row.least(angle);
  const double x = row.x(angle);
  l.wheel[1] += sideways(x, sine, p);
  l.wheel[0] = x;
}

row_overlap side_geometry::overlap(double s, double &y, double &dy) const {
  const curve_point p = wheel_.evaluate(s);
  dy = p.dy;
  const double sine = locus_sine(p, sampled_gap(s), 1e-9);
  const vec3 at = wheel_point(p, sine);
  double z, angle;
  if (!rail_surface(at[0], at[1], z, angle)) return {};
  const longitudinal_row row = row_of(p, sine, z + shape_->height(at[0]) - at[2]);
  const row_overlap sum = row.overlap();
  y = at[1] + sideways(sum.x, sine, p);
  return sum;
}

// by chords between the samples: near enough where only the roller's slope depends on it
double side_geometry::sampled_gap(double s) const {
  if (track_.kind == track_kind::rail) return 0;
  const double at = (s - wheel_.curve().begin()) / wheel_.step();
  const int i = std::clamp(static_cast<int>(at), 0, sample_count() - 2);
  const double a = sample_gap(i), b = sample_gap(i + 1), share = at - i;
  return std::max(a, b) < 0.5 * far_apart ? a + share * (b - a) : 0;
}

namespace {

double value(const double *c, double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
double slope(const double *c, double t) { return c[1] + t * (2 * c[2] + 3 * t * c[3]); }

// where a piece, known up to its end, is left for another
bool beyond(const profile_piece &piece, double t) {
  return !(t >= 0 && t <= piece.end - piece.begin);
}

}  // namespace

locus_walk::locus_walk(const side_geometry &side)
    : side_(side),
      level_(side.level() && !side.shaped()),
      low_(side.rail_.sample(side.rail_.first()).y),
      high_(side.rail_.sample(side.rail_.last()).y) {}

locus_point locus_walk::operator()(double s) {
  locus_point l;
  if (level_ && follow(s, l)) return l;
  begun_ = false;
  return side_.locus(s, place_);
}

bool locus_walk::follow(double s, locus_point &l) {
  const profile &curve = side_.wheel_.curve();
  if (!curve.covers(s)) return false;
  if (!begun_ || beyond(wheel_, s - wheel_.begin)) {
    place_.wheel = curve.interval(s, place_.wheel);
    wheel_ = side_.wheel_.piece_at(place_.wheel);
  }
  const double t = s - wheel_.begin, z = value(wheel_.z, t);
  const double dy = slope(wheel_.y, t), dz = slope(wheel_.z, t);
  if (!(dy > 0)) return false;
  const mat3 &m = side_.wheel_axes_;
  l.sine = m[0][1] * dz / (m[0][0] * dy);
  if (!(std::fabs(l.sine) < 0.9)) return false;
  const double r = side_.sizes_.nominal_radius + z, cosine = std::sqrt(1 - l.sine * l.sine);
  l.wheel = side_.axis_origin_ + turn(m, {r * l.sine, value(wheel_.y, t), r * cosine});
  if (!meet_rail(l.wheel[1])) return false;
  l.valid = true;
  l.rail_z = value(rail_.z, at_);
  l.gap = l.rail_z - l.wheel[2];
  l.contact_angle = angle_of(dy_, slope(rail_.z, at_));
  const vec3 along{l.sine * dy, -dz, cosine * dy};
  const double down = 1 / dot(m[2], along);
  l.normal = {0, down * dot(m[1], along), down * dot(m[2], along)};
  l.curvature = 0.5 / r;
  return true;
}

// Newton's steps of the second order from the last point; their error falls with the cube.
bool locus_walk::meet_rail(double y) {
  constexpr double far = 1e-3, close = 1e-6;  // m
  const placed_profile &rail = side_.rail_;
  if (!(y >= low_ && y <= high_)) return false;
  if (!begun_) {
    double s;
    curve_point p;
    if (!rail.find(y, s, p, place_.rail)) return false;
    place_.rail.interval = rail.curve().interval(s, place_.rail.interval);
    rail_ = rail.piece_at(place_.rail.interval);
    at_ = s - rail_.begin;
    begun_ = true;
    along_ = 0;
  } else {
    const double way = (y - y_) / dy_;
    at_ += way - 0.5 * d2y_ / dy_ * way * way;
    if (!(std::fabs(way) < far)) return false;
  }
  for (int i = 0; i < 8; ++i) {
    if (beyond(rail_, at_)) {
      const double s = rail_.begin + at_;
      if (!rail.curve().covers(s)) return false;
      place_.rail.interval = rail.curve().interval(s, place_.rail.interval);
      rail_ = rail.piece_at(place_.rail.interval);
      at_ = s - rail_.begin;
    }
    dy_ = slope(rail_.y, at_);
    d2y_ = 2 * rail_.y[2] + 6 * at_ * rail_.y[3];
    y_ = value(rail_.y, at_);
    const double way = (y - y_) / dy_, change = way - 0.5 * d2y_ / dy_ * way * way;
    if (!(std::fabs(change) < far)) return false;
    at_ += change;
    if (std::fabs(change) > close) continue;
    y_ = y;
    dy_ += change * d2y_;
    return dy_ > 0;
  }
  return false;
}

// rad, as atan2: by its series from a direction that is not far off.
double locus_walk::angle_of(double dy, double dz) {
  constexpr double near = 0.1;
  const double x = (dz * along_ - dy * down_) / (dy * along_ + dz * down_);
  if (!(std::fabs(x) < near)) {
    along_ = dy;
    down_ = dz;
    return angle_ = atan2(dz, dy);
  }
  const double u = x * x;
  double sum = 0;
  for (int k = 15; k > 1; k -= 2) sum = u * (1.0 / k - sum);
  return angle_ + x * (1 - sum);
}

}  // namespace railpatch
