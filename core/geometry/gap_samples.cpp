// Samples of the gap along the wheel's profile, all of them or those that can be near the rail.
#include "geometry/gap_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/geometry.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr double aside = 0.02;     // m, what yaw may move the locus sideways
constexpr double flat = 0.5;       // -, greatest sine along the circumference of a bound
constexpr double rounding = 1e-9;  // m, added to what a point may have moved
constexpr double step = 0.5 * gap_samples::reach;  // m, from one place to the next that follows it

// How far samples of a stretch have moved along one of the track's axes, and by how much that may
// be wrong. A point is o + a0 r s + a1 y + a2 r c, s = t dz/dy and c = sqrt(1 - s^2).
struct shift {
  double mean = 0, most = 0;
};
shift shift_of(const gap_samples::stretch &b, const look_place &from, const look_place &to,
               size_t axis) {
  const vec3 &a = from.axes[axis], &c = to.axes[axis];
  const double t = from.axes[0][1] / from.axes[0][0], u = to.axes[0][1] / to.axes[0][0];
  const double square = b.steepest * b.steepest, radius = b.r + b.half_r;
  const double tilt = std::max(t * t, u * u) * square;
  const double dy = c[1] - a[1], dr = c[2] - a[2];
  shift out;
  out.mean = to.origin[axis] - from.origin[axis] + dy * b.y + dr * b.r;
  out.most = std::fabs(dy) * b.half_y + std::fabs(dr) * (b.half_r + radius * tilt) +
             std::fabs(c[0] * u - a[0] * t) * radius * b.steepest +
             std::fabs(a[2]) * radius * std::fabs(u * u - t * t) * square + rounding;
  return out;
}

}  // namespace

gap_samples::gap_samples(int count)
    : gap(static_cast<size_t>(count)),
      stretches(static_cast<size_t>((count + block - 1) / block)) {}

bool gap_samples::follows(const look_place &at) const {
  if (!begun || at.wheel_moved != last.wheel_moved || at.rail_moved[0] != last.rail_moved[0])
    return false;
  double most = 0;
  for (size_t i = 0; i < 3; ++i) {
    most = std::max(most, std::fabs(at.origin[i] - last.origin[i]));
    for (size_t k = 0; k < 3; ++k)
      most = std::max(most, std::fabs(at.axes[i][k] - last.axes[i][k]));
  }
  for (size_t i = 1; i < 3; ++i)
    most = std::max(most, std::fabs(at.rail_moved[i] - last.rail_moved[i]));
  return most < step;
}

bool gap_samples::set_bounds(const look_place &at) {
  const look_place &from = reference;
  if (!referred || at.wheel_moved != from.wheel_moved || at.rail_moved[0] != from.rail_moved[0])
    return false;
  const double t = std::max(std::fabs(from.axes[0][1] / from.axes[0][0]),
                            std::fabs(at.axes[0][1] / at.axes[0][0]));
  for (stretch &b : stretches) {
    b.bound = -std::numeric_limits<double>::infinity();
    if (!(t * b.steepest < flat)) continue;
    const shift y = shift_of(b, from, at, 1), z = shift_of(b, from, at, 2);
    const double moved = y.mean - (at.rail_moved[1] - from.rail_moved[1]);
    if (!(std::fabs(moved) + y.most < reach)) return false;
    b.bound = b.least - (z.mean - (at.rail_moved[2] - from.rail_moved[2])) - z.most;
  }
  return true;
}

look_place side_geometry::look() const {
  return {axis_origin_,
          wheel_axes_,
          {wheel_.angle(), wheel_.moved_y(), wheel_.moved_z()},
          {rail_.angle(), rail_.moved_y(), rail_.moved_z()}};
}

void side_geometry::scan(bool at_height) {
  gap_samples &g = samples_;
  overlap_ = false;
  const look_place now = look();
  const bool follows = at_height && g.follows(now);
  g.last = now;
  g.begun = true;
  for (auto &b : g.stretches) b.known = false;
  if (at_height && g.set_bounds(now)) return;
  scan_all();
  g.referred = follows;
  if (follows) refer();
}

void side_geometry::scan_all() {
  const int count = static_cast<int>(samples_.stretches.size());
  for (int b = 0; b < count; ++b) scan_block(b);
}

// The blocks in which gaps may be below the limit, with their neighbours.
void side_geometry::scan_near(double limit) {
  auto &all = samples_.stretches;
  const int count = static_cast<int>(all.size());
  for (int b = 0; b < count; ++b) {
    if (!(all[static_cast<size_t>(b)].bound < limit)) continue;
    for (int k = std::max(b - 1, 0); k <= std::min(b + 1, count - 1); ++k)
      if (!all[static_cast<size_t>(k)].known) scan_block(k);
  }
  if (overlap_) return;
  for (int b = 0; b < count; ++b)
    if (!all[static_cast<size_t>(b)].known) scan_block(b);
}

// Samples of the wheel against chords of the rail: both are ordered in y, so walk along both.
void side_geometry::scan_block(int index) {
  const auto begin = static_cast<size_t>(index) * gap_samples::block;
  const size_t end = std::min(begin + gap_samples::block, samples_.gap.size());
  for (size_t i = begin; i < end; ++i) samples_.gap[i] = far_apart;
  samples_.stretches[static_cast<size_t>(index)].known = true;
  const bool roller = track_.kind == track_kind::roller;
  const double from = rail_.sample(rail_.first()).y - aside,
               to = rail_.sample(rail_.last()).y + aside;
  const vec3 origin = samples_.last.origin;
  const mat3 axes = wheel_axes_;
  int k = -1;
  const int first = std::max(static_cast<int>(begin), wheel_.first());
  const int last = std::min(static_cast<int>(end) - 1, wheel_.last());
  for (int i = first; i <= last; ++i) {
    const curve_point m = wheel_.sample(i);
    const double radius = sizes_.nominal_radius + m.z;
    // where the profiles have no lateral position in common there is nothing to find
    const double y = origin[1] + (axes[1][1] * m.y + axes[1][2] * radius);
    if (y < from || y > to) continue;
    // the gap is least there, so that its error is that of the sine squared
    const double sine = roller ? locus_sine(m, 0, 3e-2) : axes[0][1] * m.dz / (axes[0][0] * m.dy);
    if (!(std::fabs(sine) < 0.9)) continue;
    // wheel_point(), written out as it is asked for at every sample
    const vec3 own = {radius * sine, m.y, radius * std::sqrt(1 - sine * sine)};
    const auto along = [&](size_t j) {
      return origin[j] + (axes[j][0] * own[0] + axes[j][1] * own[1] + axes[j][2] * own[2]);
    };
    const vec3 p = {along(0), along(1), along(2)};
    if (k < 0)
      k = std::max(rail_.first(), std::min(rail_.first_not_before(p[1]), rail_.last()) - 1);
    while (k + 2 <= rail_.last() && rail_.sample(k + 1).y < p[1]) ++k;
    while (k > rail_.first() && rail_.sample(k).y >= p[1]) --k;
    const curve_point a = rail_.sample(k), b = rail_.sample(std::min(k + 1, rail_.last()));
    if (!(p[1] >= a.y && p[1] <= b.y)) continue;
    double z = a.z + (b.z - a.z) * (p[1] - a.y) / std::max(b.y - a.y, 1e-12);
    if (roller) {
      const double x = p[0] - axle_x_, r = axle_z_ - z;
      z = axle_z_ - std::sqrt(std::max(r * r - x * x, 0.0));
    }
    samples_.gap[static_cast<size_t>(i)] = z - p[2];
    if (shape_) {
      double angle;
      samples_.gap[static_cast<size_t>(i)] = row_of(m, sine, z - p[2]).least(angle);
    }
    overlap_ = true;
  }
}

// After a full look on a rail: it is the reference of looks that follow.
void side_geometry::refer() {
  samples_.reference = samples_.last;
  const vec3 &origin = samples_.last.origin;
  const mat3 &axes = wheel_axes_;
  int from = rail_.first();  // rail samples before it are out of reach
  for (size_t index = 0; index < samples_.stretches.size(); ++index) {
    gap_samples::stretch &b = samples_.stretches[index];
    b = {};
    b.known = true;
    b.least = far_apart;
    const int first = std::max(static_cast<int>(index) * gap_samples::block, wheel_.first());
    const int last =
        std::min((static_cast<int>(index) + 1) * gap_samples::block - 1, wheel_.last());
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = first; i <= last; ++i) {
      const curve_point m = wheel_.sample(i);
      const double own[2] = {m.y, sizes_.nominal_radius + m.z};
      for (int j = 0; j < 2; ++j)
        low[j] = std::min(low[j], own[j]), high[j] = std::max(high[j], own[j]);
      b.steepest = std::max(b.steepest, std::fabs(m.dz / m.dy));
      const double sine = axes[0][1] * m.dz / (axes[0][0] * m.dy);
      if (!(std::fabs(sine) < flat)) continue;  // such blocks are never passed over
      const vec3 at =
          origin + turn(axes, {own[1] * sine, own[0], own[1] * std::sqrt(1 - sine * sine)});
      b.least = std::min(b.least, highest_rail(at[1], from) - at[2]);
    }
    if (first > last) continue;
    b.y = 0.5 * (low[0] + high[0]);
    b.half_y = 0.5 * (high[0] - low[0]);
    b.r = 0.5 * (low[1] + high[1]);
    b.half_r = 0.5 * (high[1] - low[1]);
  }
}

// The least z of the rail's chords within reach of y; far_apart where there is none. from: where
// the last search for a neighbouring y began.
double side_geometry::highest_rail(double y, int &from) const {
  const double low = y - gap_samples::reach, high = y + gap_samples::reach;
  while (from + 1 < rail_.last() && rail_.sample(from + 1).y <= low) ++from;
  while (from > rail_.first() && rail_.sample(from).y > low) --from;
  double least = HUGE_VAL;
  if (rail_.sample(from).y > high || rail_.sample(rail_.last()).y < low) return HUGE_VAL;
  for (int k = from; k <= rail_.last(); ++k) {
    least = std::min(least, rail_.sample(k).z);
    if (rail_.sample(k).y >= high) break;
  }
  return least;
}

}  // namespace railpatch
