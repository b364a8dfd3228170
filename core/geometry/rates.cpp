#include "geometry/rates.hpp"

#include <algorithm>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// a plain number and its rates by direction
template <class Get>
rated gather(const side_motion &at, const motion_rates &motion, Get get) {
  rated out(get(at));
  for (int k = 0; k < motion.count; ++k) {
    const auto i = static_cast<size_t>(k);
    out.rate[i] = get(motion.direction[i]);
  }
  return out;
}

vec<rated> gather_vector(const side_motion &at, const motion_rates &motion,
                         deviation side_motion::*body, vec3 deviation::*part) {
  vec<rated> out;
  for (size_t i = 0; i < 3; ++i)
    out[i] = gather(at, motion, [&](const side_motion &m) { return ((m.*body).*part)[i]; });
  return out;
}

basic_deviation<rated> gather_deviation(const side_motion &at, const motion_rates &motion,
                                        deviation side_motion::*body) {
  return {gather_vector(at, motion, body, &deviation::offset),
          gather_vector(at, motion, body, &deviation::rotation),
          gather_vector(at, motion, body, &deviation::velocity),
          gather_vector(at, motion, body, &deviation::angular_velocity)};
}

basic_side_motion<rated> gather_motion(const side_motion &at, const motion_rates &motion) {
  const auto state = [&](double wheelset_state::*part) {
    return gather(at, motion, [part](const side_motion &m) { return m.wheelset.*part; });
  };
  basic_side_motion<rated> out;
  using w = wheelset_state;
  out.wheelset = {state(&w::y),        state(&w::z),         state(&w::roll), state(&w::yaw),
                  state(&w::speed),    state(&w::vy),        state(&w::vz),   state(&w::roll_rate),
                  state(&w::yaw_rate), state(&w::pitch_rate)};
  out.wheel = gather_deviation(at, motion, &side_motion::wheel);
  out.rail = gather_deviation(at, motion, &side_motion::rail);
  out.roller_pitch_rate =
      gather(at, motion, [](const side_motion &m) { return m.roller_pitch_rate; });
  return out;
}

}  // namespace

moving_geometry::moving_geometry(const side_geometry &side, const motion_rates &motion)
    : side_(side) {
  sizes_ = side.sizes_;
  track_ = side.track_;
  marker_y_ = side.marker_y_;
  marker_z_ = side.marker_z_;
  place_axes(gather_motion(side.motion_, motion));
  place_centre();
  const auto place = [](const placed_profile &at, const rated &angle, const rated &y,
                        const rated &z) {
    return meridian{&at, cos(angle), sin(angle), y, z, angle};
  };
  const double cant = track_.kind == track_kind::roller ? 0.0 : track_.cant;
  wheel_ = place(side.wheel_, motion_.wheel.rotation[0], motion_.wheel.offset[1],
                 motion_.wheel.offset[2]);
  rail_ = place(side.rail_, motion_.rail.rotation[0] - cant, marker_y_ + motion_.rail.offset[1],
                marker_z_ + motion_.rail.offset[2]);
}

moving_geometry::point moving_geometry::evaluate(const meridian &m, const rated &s) const {
  const curve_point p = m.at->curve().evaluate(s.value);
  const rated y = s.through(p.y, p.dy), z = s.through(p.z, p.dz);
  const rated dy = s.through(p.dy, p.d2y), dz = s.through(p.dz, p.d2z);
  return {m.y + m.cosine * y - m.sine * z, m.z + m.sine * y + m.cosine * z,
          m.cosine * dy - m.sine * dz, m.sine * dy + m.cosine * dz};
}

vec<rated> moving_geometry::wheel_point(const point &p, const rated &sine) const {
  const rated r = sizes_.nominal_radius + p.z;
  return axis_origin_ + turn(wheel_axes_, {r * sine, p.y, r * sqrt(1.0 - sine * sine)});
}

bool moving_geometry::rail_surface(const rated &x, const rated &y, rated &z, rated &angle) const {
  double s;
  if (!side_.rail_.find(y.value, s)) return false;
  const point start = evaluate(rail_, s);
  rated along = (y - start.y) / start.dy;
  along.value = s;
  const point p = evaluate(rail_, along);
  z = p.z;
  angle = atan2(p.dz, p.dy);
  if (track_.kind == track_kind::rail) return true;
  const rated r = axle_z_ - p.z, dx = x - axle_x_, square = r * r - dx * dx;
  if (!(square > 0.0)) return false;
  z = axle_z_ - sqrt(square);
  return true;
}

rated_locus moving_geometry::locus(const rated &s) const {
  rated_locus l;
  const locus_point at = side_.locus(s.value);
  if (!at.valid) return l;
  const point p = evaluate(wheel_, s);
  const mat<rated> &m = wheel_axes_;
  rated sine = m[0][1] * p.dz / (m[0][0] * p.dy), rail_z, angle;
  if (track_.kind == track_kind::roller) {
    // equal slopes of wheel and roller in x, with the sine as unknown
    const rated free = unknown(at.sine, sine_slot);
    const rated cosine = sqrt(1.0 - free * free);
    const vec<rated> n = turn(m, {free * p.dy, -p.dz, cosine * p.dy});
    const vec<rated> on_wheel = wheel_point(p, free);
    if (!rail_surface(on_wheel[0], on_wheel[1], rail_z, angle)) return l;
    const rated residual = -n[0] / n[2] - (on_wheel[0] - axle_x_) / (axle_z_ - rail_z);
    sine = solved(at.sine, residual, sine_slot);
  }
  l.wheel = wheel_point(p, sine);
  l.valid = rail_surface(l.wheel[0], l.wheel[1], rail_z, l.contact_angle);
  if (!l.valid) return l;
  l.gap = rail_z - l.wheel[2];
  const vec<rated> normal = turn(m, {sine * p.dy, -p.dz, sqrt(1.0 - sine * sine) * p.dy});
  l.normal = (1.0 / normal[2]) * normal;
  if (track_.kind == track_kind::rail) l.normal[0] = 0.0;
  l.curvature = 0.5 / (sizes_.nominal_radius + p.z);
  if (track_.kind == track_kind::roller) l.curvature += 0.5 / (axle_z_ - rail_z);
  return l;
}

// Where the gap is zero; a part that a profile's end cuts off ends at a sample that stays.
rated moving_geometry::edge(double s) const {
  constexpr double zero = 1e-8;  // m
  const rated_locus l = locus(unknown(s, arc_slot));
  return l.valid && std::fabs(l.gap.value) < zero ? solved(s, l.gap, arc_slot) : rated(s);
}

basic_part<rated> moving_geometry::part_of(const part &found) const {
  basic_part<rated> out;
  out.begin = edge(found.begin);
  out.end = edge(found.end);
  out.cut_off = found.cut_off;
  sum_rows([this](const rated &s) { return locus(s); }, out);
  // its place is that of the greatest gap, so it may be held fixed
  out.bump = found.bump > 0 ? locus(rated(found.bump_at)).gap : rated(0.0);
  return out;
}

namespace {

// A surface that moves in the contact frame, at points on it: how its height along n changes.
//
// With q a point in the surface's own axes, u its position across the meridian and r(u) the
// meridian's distance from the axis, the surface is u(p) = q_y, r(p) = |(q_x, q_z)|. What moves are
// the frame, dq = t + w x q as a rigid body, and the meridian in its plane. For fixed x and s
//   dn = c . dq + k_u du + k_r dr, c = -normal/(normal along n).
class moving_surface final : public surface_visitor {
 public:
  struct setting {
    const placed_profile *meridian;
    vec<rated> q0, qx, qs, qn;  // frame seen from the surface's axes
    rated radius, angle, y, z;  // axis to profile; the profile in its meridian plane
    double sign;
    bool prismatic;
  };

  moving_surface(const setting &at, const surface_grid &g, const lattice_rates *lattice, int count,
                 double gain, double *const *rates)
      : at_(at), grid_(g), count_(count), gain_(gain), rates_(rates) {
    for (size_t i = 0; i < 3; ++i) {
      q0_[i] = at.q0[i].value;
      qx_[i] = at.qx[i].value;
      qs_[i] = at.qs[i].value;
      qn_[i] = at.qn[i].value;
    }
    for (int k = 0; k < count; ++k) set_rates(static_cast<size_t>(k), lattice);
  }

  void meet(int column, int row, double p, double n) override {
    const double x = grid_.x0 + column * grid_.dx, s = grid_.y0 + row * grid_.dy;
    const vec3 q = q0_ + x * qx_ + s * qs_ + n * qn_;
    const curve_point m = at_.meridian->evaluate(p);
    const double r = at_.radius.value + at_.sign * m.z, dr = at_.sign * m.dz;
    const vec3 out = at_.prismatic ? vec3{0, 0, 1} : vec3{q[0] / r, 0, q[2] / r};
    const double det = m.dy * dot(out, qn_) - dr * qn_[1];
    const double k_r = m.dy / det, k_u = -dr / det;
    const vec3 c = -k_r * out + vec3{0, -k_u, 0};
    const double by_x = dot(c, qx_), by_s = dot(c, qs_);
    const vec3 moment = cross(q, c);
    const double turned = k_r * at_.sign * (m.y - at_.y.value) - k_u * (m.z - at_.z.value);
    const int to = row * grid_.nx + column;
    for (int k = 0; k < count_; ++k) {
      const motion &d = motions_[static_cast<size_t>(k)];
      const double dx = d.lattice.origin[0] + column * d.lattice.size[0],
                   ds = d.lattice.origin[1] + row * d.lattice.size[1];
      rates_[k][to] += gain_ * (dot(c, d.velocity) + dot(moment, d.spin) + k_u * d.y + k_r * d.r +
                                turned * d.angle + by_x * dx + by_s * ds);
    }
  }

 private:
  struct motion {
    vec3 velocity, spin;  // of the frame, in the surface's axes, about their origin
    double y, r, angle;   // of the profile
    lattice_rates lattice;
  };

  void set_rates(size_t k, const lattice_rates *lattice) {
    const auto rate = [k](const vec<rated> &v) {
      return vec3{v[0].rate[k], v[1].rate[k], v[2].rate[k]};
    };
    motion &d = motions_[k];
    // of a rigid body's axes e: spin = 1/2 sum of e x de
    d.spin = 0.5 * (cross(qx_, rate(at_.qx)) + cross(qs_, rate(at_.qs)) + cross(qn_, rate(at_.qn)));
    d.velocity = rate(at_.q0) - cross(d.spin, q0_);
    d.y = at_.y.rate[k];
    d.r = at_.radius.rate[k] + at_.sign * at_.z.rate[k];
    d.angle = at_.angle.rate[k];
    d.lattice = lattice ? lattice[k] : lattice_rates{};
  }

  const setting &at_;
  const surface_grid &grid_;
  int count_;
  double gain_;
  double *const *rates_;
  vec3 q0_, qx_, qs_, qn_;
  std::array<motion, rate_directions> motions_;
};

}  // namespace

void moving_geometry::distance_rates(const rated_frame &frame, const surface_grid &grid,
                                     const lattice_rates *lattice, int count,
                                     double *const *rates) const {
  for (int k = 0; k < count; ++k) std::fill_n(rates[k], grid.nx * grid.ny, 0.0);
  const bool roller = track_.kind == track_kind::roller;
  const frame_axes<rated> f = axes_of(frame);
  mat<rated> identity{};
  for (size_t i = 0; i < 3; ++i) identity[i][i] = rated(1.0);
  const vec<rated> axle = roller ? vec<rated>{axle_x_, 0.0, axle_z_} : vec<rated>{};
  const auto see = [&](const meridian &m, const vec<rated> &origin, const mat<rated> &axes,
                       const rated &radius, double sign, bool prismatic) {
    return moving_surface::setting{m.at,
                                   turn_back(axes, frame.origin - origin),
                                   turn_back(axes, f.x),
                                   turn_back(axes, f.s),
                                   turn_back(axes, f.n),
                                   radius,
                                   m.angle,
                                   m.y,
                                   m.z,
                                   sign,
                                   prismatic};
  };
  const contact_frame fixed{{frame.origin[0].value, frame.origin[1].value, frame.origin[2].value},
                            frame.contact_angle.value};
  const auto on_wheel =
      see(wheel_, axis_origin_, wheel_axes_, rated(sizes_.nominal_radius), 1.0, false);
  const auto on_rail =
      see(rail_, axle, identity, roller ? axle_z_ : rated(0.0), roller ? -1.0 : 1.0, !roller);
  moving_surface wheel(on_wheel, grid, lattice, count, -1.0, rates);
  side_.meet_surface(body::wheel, fixed, grid, wheel);
  moving_surface rail(on_rail, grid, lattice, count, 1.0, rates);
  side_.meet_surface(body::rail, fixed, grid, rail);
}

}  // namespace railpatch
