#include "geometry/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/row_hits.hpp"
#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"

namespace railpatch {

namespace {

constexpr double grazing = grazing_cosine;
constexpr double step_limit = 2e-3;  // m, of a newton step along a profile

constexpr mat3 identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

}  // namespace

// A surface seen from the contact frame: of revolution about an axis, or prismatic along x.
struct surface {
  const placed_profile *meridian;
  vec3 q0, qx, qs, qn;  // frame origin and axes in the surface's own axes
  double radius, sign;  // r = radius + sign z
  bool prismatic;
  const longitudinal_shape *shape = nullptr;  // null: round, or level

  vec3 at(double x, double s) const { return q0 + x * qx + s * qs; }
};

namespace {

surface seen_from(const contact_frame &frame, const placed_profile &meridian, const vec3 &origin,
                  const mat3 &axes, double radius, double sign, bool prismatic) {
  const frame_axes<double> f = axes_of(frame);
  return {&meridian,
          turn_back(axes, frame.origin - origin),
          turn_back(axes, f.x),
          turn_back(axes, f.s),
          turn_back(axes, f.n),
          radius,
          sign,
          prismatic};
}

// What the shape adds to the radius or height of a surface at a point in its axes, and its
// derivative along n.
double added(const surface &f, const vec3 &q, double &slope) {
  if (f.prismatic) {
    slope = 0;
    return -f.shape->height(q[0]);
  }
  const double added = f.shape->runout(atan2(q[0], q[2]), slope);
  slope *= (q[2] * f.qn[0] - q[0] * f.qn[2]) / (q[0] * q[0] + q[2] * q[2]);
  return added;
}

// Where the line along n through a point meets a surface.
struct hit {
  double p = 0, n = 0;  // m, arc length of the meridian, height along n
  int interval = 0;
  bool valid = false;
};

// Newton for (p, n): u(p) = q_y and r(p) = distance from the axis, with q = base + n qn. Stops when
// the step leaves an error, quadratic in it, below 1e-10 m.
bool meet(const surface &f, const vec3 &base, hit &h) {
  const profile &curve = f.meridian->curve();
  for (int i = 0; i < 30; ++i) {
    h.interval = curve.interval(h.p, h.interval);
    const curve_point m = f.meridian->evaluate(h.p, h.interval);
    const vec3 q = base + h.n * f.qn;
    double r = f.radius + f.sign * m.z, added_slope = 0;
    const double dr = f.sign * m.dz;
    if (f.shape) r += added(f, q, added_slope);
    const double f1 = m.y - q[1];
    const double f2 = f.prismatic ? q[2] - r : 0.5 * (q[0] * q[0] + q[2] * q[2] - r * r) / r;
    double g = f.prismatic ? f.qn[2] : (q[0] * f.qn[0] + q[2] * f.qn[2]) / r;
    if (f.shape) g -= added_slope;
    const double det = m.dy * g - dr * f.qn[1];
    if (!(std::fabs(det) > grazing)) return h.valid = false;
    const double dp = -(f1 * g + f.qn[1] * f2) / det, dn = -(m.dy * f2 + dr * f1) / det;
    const double scale = std::fabs(dp) > step_limit ? step_limit / std::fabs(dp) : 1.0;
    h.p += scale * dp;
    h.n += scale * dn;
    if (std::fabs(dp) < close_step && std::fabs(dn) < close_step)
      return h.valid = curve.covers(h.p);
  }
  return h.valid = false;
}

// Angle of the surface in the plane across x: the gradient of (distance from the axis - r(u)) is
// normal to it, as (q_x/r, -dr/du, q_z/r) in the surface's axes.
double across(const surface &f, const hit &h) {
  const curve_point m = f.meridian->evaluate(h.p, f.meridian->curve().interval(h.p, h.interval));
  const vec3 q = f.q0 + h.n * f.qn;
  const double r = f.radius + f.sign * m.z, dr = f.sign * m.dz;
  const vec3 normal =
      f.prismatic ? vec3{0, -dr, m.dy} : vec3{q[0] / r * m.dy, -dr, q[2] / r * m.dy};
  return atan(-dot(normal, f.qs) / dot(normal, f.qn));
}

// the sample of the meridian nearest to the frame's origin starts the search; samples are ordered
// in y, so that those further aside than the nearest one need no look
hit nearest(const surface &f) {
  const placed_profile &m = *f.meridian;
  const double u = f.q0[1];
  const double r = f.prismatic ? f.q0[2] : hypot(f.q0[0], f.q0[2]);
  const int begin = m.first_not_before(u);
  double best = std::numeric_limits<double>::infinity();
  int at = m.first();
  // of those equally near the first one
  const auto closer = [&](int i, bool equal) {
    const double a = m.sample(i).y - u, b = f.radius + f.sign * m.sample(i).z - r;
    const double d = a * a + b * b;
    if (d < best || (equal && d == best)) best = d, at = i;
    return a * a <= best;
  };
  for (int i = begin; i <= m.last(); ++i)
    if (!closer(i, false)) break;
  for (int i = begin - 1; i >= m.first(); --i)
    if (!closer(i, true)) break;
  hit h;
  h.p = m.sample_s(at);
  h.interval = m.curve().interval(h.p);
  return h;
}

// One row from its middle column outwards, put(column, hit) for each; each start extrapolates its
// neighbours, so that one newton step is nearly always enough.
template <class Put>
void march(const surface &f, const surface_grid &g, int row, int from, int step, const hit &middle,
           Put put) {
  const double s = g.y0 + row * g.dy;
  hit a = middle, b = middle, c = middle;
  for (int i = from, k = 0; i >= 0 && i < g.nx; i += step, ++k) {
    hit h = a;
    if (k > 1) h.p = 2 * a.p - b.p;
    if (k > 2) h.n = 3 * (a.n - b.n) + c.n;
    if (!meet(f, f.at(g.x0 + i * g.dx, s), h)) {
      for (; i >= 0 && i < g.nx; i += step) put(i, h);
      return;
    }
    put(i, h);
    c = b;
    b = a;
    a = h;
  }
}

template <class Put>
void follow_row(const surface &f, const surface_grid &g, int row, int column, const hit &middle,
                Put put) {
  if (!middle.valid || (f.prismatic && !f.shape)) {
    for (int i = 0; i < g.nx; ++i) put(i, middle);
    return;
  }
  march(f, g, row, column, 1, middle, put);
  march(f, g, row, column - 1, -1, middle, put);
}

// A row of a round surface, heights at h, from its middle column outwards, where it ends at the
// first element that is missed.
void fill_row(const surface &f, const surface_grid &g, int row, int column, const hit &middle,
              double *h) {
  constexpr int strip = 256;
  double p[strip], n[strip], off[strip];
  const double s = g.y0 + row * g.dy, at = g.x0 + column * g.dx;
  const profile &curve = f.meridian->curve();
  row_of_lines lines{f.meridian->piece_at(curve.interval(middle.p, middle.interval)),
                     f.at(at, s),
                     f.qx,
                     f.qn,
                     middle.p,
                     middle.n};
  for (double &c : lines.meridian.z) c *= f.sign;
  lines.meridian.z[0] += f.radius;
  // the row's ends, outwards from the middle
  int ends[2] = {-1, g.nx};
  for (int first = 0; first < g.nx; first += strip) {
    const int count = std::min(strip, g.nx - first);
    // whole vectors
    const int filled = std::min(strip, (count + 3) / 4 * 4);
    meet_row(lines, g.x0 + first * g.dx - at, g.dx, filled, p, n, off);
    for (int k = 0; k < count; ++k) {
      const int i = first + k;
      if (off[k] != 0) {
        hit one{p[k], n[k], middle.interval, false};
        if (!meet(f, f.at(g.x0 + i * g.dx, s), one)) {
          if (i < column) ends[0] = i;
          if (i >= column) ends[1] = std::min(ends[1], i);
        }
        n[k] = one.n;
      }
      h[i] = n[k];
    }
  }
  for (int i = 0; i <= ends[0]; ++i) h[i] = nan;
  for (int i = ends[1]; i < g.nx; ++i) h[i] = nan;
}

// NaN where the surface is missed.
void heights_of_row(const surface &f, const surface_grid &g, int row, int column, const hit &middle,
                    double *h) {
  if (middle.valid && !f.prismatic && !f.shape)
    fill_row(f, g, row, column, middle, h);
  else
    follow_row(f, g, row, column, middle,
               [&](int i, const hit &on) { h[i] = on.valid ? on.n : nan; });
}

int clamp_index(double position, int count) {
  const double last = count - 1;
  return static_cast<int>(std::clamp(std::round(position), 0.0, last));
}

// rail minus wheel, in place of the wheel's heights
void subtract(const double *rail, int count, double *h) {
  for (int i = 0; i < count; ++i) {
    const double d = rail[i] - h[i];
    h[i] = std::isfinite(d) ? d : side_geometry::no_surface;
  }
}

// The last rows that were met, newest first, as long as none was missed in between.
struct rows_met {
  hit last[3];
  int count = 0;

  void add(const hit &h) {
    last[2] = last[1];
    last[1] = last[0];
    last[0] = h;
    count = std::min(count + 1, 3);
  }
  // where the next row will be met
  hit next() const {
    hit h = last[0];
    if (count == 2) {
      h.p = 2 * last[0].p - last[1].p;
      h.n = 2 * last[0].n - last[1].n;
    } else if (count == 3) {
      h.p = 3 * (last[0].p - last[1].p) + last[2].p;
      h.n = 3 * (last[0].n - last[1].n) + last[2].n;
    }
    return h;
  }
};

// calls use(row, middle) for all rows, from the one nearest to the origin outwards
template <class F>
void for_rows(const surface &f, const surface_grid &g, int column, F use) {
  const double x = g.x0 + column * g.dx;
  const int start = clamp_index(-g.y0 / g.dy, g.ny);
  hit origin = nearest(f);
  meet(f, f.at(0, 0), origin);
  rows_met first;  // from the start on, for the way back
  for (int direction : {1, -1}) {
    hit h = origin;
    rows_met met;
    if (direction < 0)
      for (int k = first.count; k > 0; --k) met.add(first.last[first.count - k]);
    for (int row = direction > 0 ? start : start - 1; row >= 0 && row < g.ny; row += direction) {
      const vec3 at = f.at(x, g.y0 + row * g.dy);
      hit next = met.count > 0 ? met.next() : h;
      bool there = meet(f, at, next);
      if (!there && met.count > 1) there = meet(f, at, next = h);
      // a row that is missed leaves the start of the next one as it was
      if (there)
        met.add(h = next);
      else
        met.count = 0;
      if (direction > 0 && row < start + 3 && met.count == row - start + 1) first = met;
      use(row, next);
    }
  }
}

}  // namespace

wheelset_state mirrored(wheelset_state w) {
  for (double *v : {&w.y, &w.roll, &w.yaw, &w.vy, &w.roll_rate, &w.yaw_rate}) *v = -*v;
  return w;
}

deviation mirrored(deviation d) {
  return {mirrored_vector(d.offset), mirrored_axial(d.rotation), mirrored_vector(d.velocity),
          mirrored_axial(d.angular_velocity)};
}

side_motion mirrored(side_motion m) {
  return {mirrored(m.wheelset), mirrored(m.wheel), mirrored(m.rail), m.roller_pitch_rate};
}

track_config mirrored(track_config t) {
  t.curvature = -t.curvature;
  t.origin_y = -t.origin_y;
  return t;
}

contact_frame mirrored(contact_frame f) {
  return {mirrored_vector(f.origin), -f.contact_angle, f.inclination};
}

creepage_state mirrored(creepage_state c) {
  c.eta = -c.eta;
  c.phi = -c.phi;
  return c;
}

vec3 mirrored_vector(vec3 v) { return {v[0], -v[1], v[2]}; }
vec3 mirrored_axial(vec3 v) { return {-v[0], v[1], -v[2]}; }

side_geometry::side_geometry(const profile &wheel, const profile &rail,
                             const wheel_config &wheel_sizes, const track_config &track)
    : wheel_(wheel, body::wheel),
      rail_(rail, body::rail),
      samples_(static_cast<int>((wheel.end() - wheel.begin()) / wheel_.step() + 1.5)) {
  sizes_ = wheel_sizes;
  track_ = track;
  place_rail_marker();
  place({});
}

void side_geometry::place_rail_marker() {
  if (track_.placed) {
    marker_y_ = track_.origin_y;
    marker_z_ = track_.origin_z;
    return;
  }
  const bool roller = track_.kind == track_kind::roller;
  rail_.place(roller ? 0 : -track_.cant, 0, 0);
  const placed_profile::inner_face face = rail_.innermost(track_.gauge_height);
  marker_y_ = 0.5 * track_.gauge - face.y;
  marker_z_ = roller ? 0 : -rail_.evaluate(rail_.extreme()).z;
  if (rail_sections_) find_marker_rates(face);
}

void side_geometry::reload_wheel() {
  wheel_.reload();
  samples_.referred = samples_.begun = false;
}

void side_geometry::reload_rail() {
  rail_.reload();
  samples_.referred = samples_.begun = false;
  place_rail_marker();
}

void side_geometry::place(const side_motion &motion, bool at_height) {
  place_axes(motion);
  const vec3 &off = motion.wheel.offset, &rail_off = motion.rail.offset;
  const bool roller = track_.kind == track_kind::roller;
  wheel_.place(motion.wheel.rotation[0], off[1], off[2]);
  const double lean = motion.rail.rotation[0] - (roller ? 0 : track_.cant);
  rail_.place(lean, marker_y_ + rail_off[1], marker_z_ + rail_off[2]);
  // scanned at z = 0, so that a position reached by move_to() gives the same bits
  motion_.wheelset.z = 0;
  place_centre();
  scan(at_height && track_.kind == track_kind::rail && !shape_);
  move_to(motion.wheelset.z);
}

void side_geometry::move_to(double z) {
  motion_.wheelset.z = z;
  place_centre();
  scan_near(z + closeness);
}

double side_geometry::roller_inclination(const vec3 &at) const {
  return atan2(at[0] - axle_x_, axle_z_ - at[2]);
}

surface side_geometry::wheel_seen_from(const contact_frame &frame) const {
  surface f = seen_from(frame, wheel_, axis_origin_, wheel_axes_, sizes_.nominal_radius, 1, false);
  if (shape_ && shape_->has_runout()) f.shape = shape_;
  return f;
}

surface side_geometry::rail_seen_from(const contact_frame &frame) const {
  if (track_.kind == track_kind::rail) {
    surface f = seen_from(frame, rail_, {0, 0, 0}, identity, 0, 1, true);
    if (shape_ && shape_->has_height()) f.shape = shape_;
    return f;
  }
  return seen_from(frame, rail_, {axle_x_, 0, axle_z_}, identity, axle_z_, -1, false);
}

void side_geometry::undeformed_distance(const contact_frame &frame, const surface_grid &g,
                                        double *h, surface_slopes *slopes) const {
  const int column = clamp_index(-g.x0 / g.dx, g.nx);
  const auto at = [&](int row) { return h + static_cast<std::ptrdiff_t>(row) * g.nx; };
  const surface wheel = wheel_seen_from(frame);
  for_rows(wheel, g, column,
           [&](int row, const hit &m) { heights_of_row(wheel, g, row, column, m, at(row)); });
  // the rail's heights are used row by row, in strips that fit on the stack
  const surface rail = rail_seen_from(frame);
  const frame_axes<double> axes = axes_of(frame);
  if (slopes) slopes->clear(1, g.ny);
  constexpr int strip = 256;
  double heights[strip];
  for (int first = 0; first < g.nx; first += strip) {
    surface_grid part = g;
    part.nx = std::min(strip, g.nx - first);
    part.x0 = g.x0 + first * g.dx;
    const int middle = std::clamp(column - first, 0, part.nx - 1);
    for_rows(rail, part, middle, [&](int row, const hit &m) {
      heights_of_row(rail, part, row, middle, m, heights);
      if (slopes && first == 0 && m.valid)
        put_slope(frame.origin, axes, {0.0, g.y0 + row * g.dy}, m.p, m.n, slopes->place(row),
                  *slopes);
      subtract(heights, part.nx, at(row) + first);
    });
  }
}

void side_geometry::meet_surface(body which, const contact_frame &frame, const surface_grid &g,
                                 surface_visitor &visitor) const {
  const int column = clamp_index(-g.x0 / g.dx, g.nx);
  const surface f = which == body::wheel ? wheel_seen_from(frame) : rail_seen_from(frame);
  for_rows(f, g, column, [&](int row, const hit &middle) {
    follow_row(f, g, row, column, middle, [&](int i, const hit &h) {
      if (h.valid) visitor.meet(i, row, h.p, h.n);
    });
  });
}

section_point side_geometry::section(const contact_frame &frame, double start[2]) const {
  const surface both[2] = {wheel_seen_from(frame), rail_seen_from(frame)};
  double height[2], turn[2];
  for (int k = 0; k < 2; ++k) {
    const surface &f = both[k];
    hit h;
    if (std::isnan(start[k]))
      h = nearest(f);
    else
      h.p = start[k];
    if (!meet(f, f.at(0, 0), h)) return {};
    start[k] = h.p;
    height[k] = h.n;
    turn[k] = across(f, h);
  }
  return {true, height[0], height[1], turn[0], turn[1]};
}

size_t side_geometry::bytes() const {
  return sizeof *this + wheel_.bytes() + rail_.bytes() + samples_.gap.size() * sizeof(double) +
         samples_.stretches.size() * sizeof(gap_samples::stretch);
}

}  // namespace railpatch
