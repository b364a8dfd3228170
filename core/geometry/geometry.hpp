// Placement of wheelset, track and roller; contact locus; undeformed distance; creepages.
//
// Axes. Track: x forward, y right, z down, origin in the plane of the rails' (rollers') tops.
// Wheelset: turned by Rx(roll) Rz(yaw), centre one nominal radius above that plane at z = 0.
// Contact frame: x as the track's, s lateral along the surface, n into the rail; turned by the
// contact angle about x: s = (0, cos, sin), n = (0, -sin, cos).
// Standstill. Slip over the rolling speed V has no limit there. Below V0 = standstill_speed it is
// divided by (V^2 + V0^2)/(2 V0), which joins V with equal slope at V0 and is V0/2 at rest; and
// where the heading h, the mean of the forward speeds, is below V0, the spin creepage is scaled by
// u = |h| (3 V0^2 - h^2)/(2 V0^3): its lateral force changes sign with the direction of rolling.
// Signs. Undeformed distance > 0 is a gap. Creepages are wheel minus rail, divided by the rolling
// speed. Everything here is a right-hand side; a left one is its mirror image: feed mirrored
// inputs, mirror the results back. Mirroring changes signs only, so it is exact.
//
// Deviations. A wheel's offset y, z and rotation about x move its profile in its meridian plane
// (about the profile's origin); it still turns about the wheelset's axis. Offset x and rotation
// about z move that axis for this wheel. Rotation about y does nothing: the wheel is round.
// A rail's offset y, z and rotation about x move it; offset x and rotations about y, z have no
// effect on a prismatic rail. A roller's offset moves its axle, the rotation about x turns its
// profile in its meridian plane; rotations about y, z have no effect.
// Their rates give the material velocities that the offsets and rotations would have: about the
// profile's origin, of a wheel or roller about the axis (y), of a wheel about the point of its axis
// in the plane of that origin (z).
#pragma once

#include "geometry/gap_samples.hpp"
#include "geometry/longitudinal_shape.hpp"
#include "geometry/placement.hpp"
#include "geometry/profile.hpp"
#include "geometry/profile_sections.hpp"
#include "geometry/surface_slopes.hpp"

namespace railpatch {

struct surface_grid {
  int nx = 0, ny = 0;
  double x0 = 0, y0 = 0;  // centre of element (0, 0): x, s
  double dx = 0, dy = 0;
};

wheelset_state mirrored(wheelset_state w);
deviation mirrored(deviation d);
side_motion mirrored(side_motion m);
track_config mirrored(track_config t);
contact_frame mirrored(contact_frame f);
creepage_state mirrored(creepage_state c);
vec3 mirrored_vector(vec3 v);  // force, position
vec3 mirrored_axial(vec3 v);   // moment, rotation

// The vertical gap at a point of the contact locus: on each lateral position the longitudinal
// position where the surfaces come closest.
struct locus_point {
  bool valid = false;        // both profiles reach there
  vec3 wheel{};              // m, track axes, on the wheel
  double sine = 0;           // of the angle along the wheel's circumference
  double gap = 0;            // m, vertical, rail minus wheel
  double rail_z = 0;         // m, of the rail surface there
  double contact_angle = 0;  // rad, of the rail surface
  double curvature = 0;      // 1/m, the gap grows with curvature x^2
  vec3 normal{};             // of the wheel's surface there, over its part along z
};

// Both surfaces on the line along n through a frame's origin.
struct section_point {
  bool valid = false;
  double wheel = 0, rail = 0;              // m, heights along n
  double wheel_angle = 0, rail_angle = 0;  // rad, about x from the frame's s to the surface
};

// Where on both profiles the last point of the locus was found: the next one is looked for from
// there on. What is found does not depend on it.
struct locus_place {
  int wheel = 0;
  profile_place rail;
};

struct surface;

struct surface_visitor {
  virtual ~surface_visitor() = default;
  // p: arc length of the surface's profile; n: height along n, m
  virtual void meet(int column, int row, double p, double n) = 0;
};

template <class Use>
class each_element final : public surface_visitor {
 public:
  explicit each_element(Use use) : use_(use) {}
  void meet(int column, int row, double p, double n) override { use_(column, row, p, n); }

 private:
  Use use_;
};

// By row: what a surface's height along n changes by with the position of its sections.
struct section_visitor {
  virtual ~section_visitor() = default;
  virtual void meet(int row, double rate) = 0;
};

// At a lateral position: how the vertical depth of the overlap and the rail's angle change with the
// place of the rail's sections (per m) and with the wheel's pitch (per rad).
struct section_growth {
  double depth[2] = {0, 0}, angle[2] = {0, 0};
};

class side_geometry : private placement<double> {
 public:
  static constexpr double no_surface = 0.01;  // m, undeformed distance where a profile has ended
  static constexpr double far_apart = 1.0;    // m, gap along the locus there
  static constexpr double closeness = 2e-5;   // m, sampled gaps below this are looked at closely

  // The profiles must outlive this object. Allocates; nothing else here does.
  side_geometry(const profile &wheel, const profile &rail, const wheel_config &wheel_sizes,
                const track_config &track);

  // at_height: z is where it will stay; samples that cannot be near the rail may then be left out,
  // and first_touch() and find_appearances() may not be asked.
  void place(const side_motion &motion, bool at_height = false);
  // A profile has changed; place() must follow.
  void reload_wheel();
  void reload_rail();
  // Only z changes: the locus stays as it is, so this is nearly free.
  void move_to(double z);
  const side_motion &motion() const { return motion_; }

  // Approximate vertical gaps at equally spaced points of the wheel's profile (within 1 um), for
  // the contact search; no_overlap() where the profiles have no lateral position in common.
  int sample_count() const { return static_cast<int>(samples_.gap.size()); }
  double sample_gap(int i) const {
    return samples_.gap[static_cast<std::size_t>(i)] - motion_.wheelset.z;
  }
  // The first sample from i on that has been looked at; those before and it are not close.
  int next_sample(int i) const {
    for (; i < sample_count(); i = (i / gap_samples::block + 1) * gap_samples::block)
      if (samples_.stretches[static_cast<std::size_t>(i / gap_samples::block)].known) break;
    return i;
  }
  double sample_s(int i) const { return wheel_.sample_s(i); }
  bool no_overlap() const { return !overlap_; }

  // What varies along the rolling direction, null: nothing; place it before place().
  void set_shape(const longitudinal_shape *shape) { shape_ = shape; }
  bool shaped() const { return shape_ != nullptr; }

  // Profiles that vary along the track and round the wheel, null: they do not. Both must hold the
  // profile that was loaded last; section_slopes.cpp has what follows.
  void set_sections(const profile_sections *rail, const profile_sections *wheel);
  bool varies(body which) const { return which == body::rail ? rail_sections_ : wheel_sections_; }
  // m, of the wheel ahead of the wheelset's place along the rail: its profile's plane at the axle.
  double section_place(const side_motion &motion) const;
  // From there to the wheelset's centre, reversed.
  const vec3 &wheel_offset() const { return axis_offset_; }
  section_growth section_growth_at(double s, const locus_point &at) const;
  // Rates of a surface's height along n in the middle of each row, m by the position: of the rail
  // at a place of the track, of the wheel.
  void section_heights(body which, const contact_frame &frame, const surface_grid &grid,
                       section_visitor &visitor) const;
  // A moment of 1 about this takes 1 by the wheel's pitch and nothing by the wheelset's roll and
  // yaw.
  vec3 pitch_direction() const;
  // Whether the rail has no slope along x.
  bool level() const {
    return track_.kind == track_kind::rail && !(shape_ && shape_->has_height());
  }
  bool one_point() const { return sizes_.one_point; }
  // With a shape: the overlap along x in the row at s, y at its mean and dy/ds of the meridian.
  row_overlap overlap(double s, double &y, double &dy) const;

  // Exact, at arc length s of the wheel's profile; with a shape the gap is the least one of the
  // row, see longitudinal_shape.hpp.
  locus_point locus(double s) const {
    locus_place anywhere;
    return locus(s, anywhere);
  }
  locus_point locus(double s, locus_place &last) const;
  // Its gap alone; far_apart where it is not valid.
  double gap(double s) const {
    locus_place anywhere;
    return gap(s, anywhere);
  }
  double gap(double s, locus_place &last) const;
  // And its derivative, where nothing is shaped along x; on a roller nearly, if yawed.
  double gap(double s, locus_place &last, double &slope) const;
  // The rail surface at (x, y): z, and the angle of its profile; false beyond the profile.
  bool rail_surface(double x, double y, double &z, double &angle) const;
  // start: arc lengths of wheel and rail profile to search from, NaN where they are not known; out
  // those found.
  section_point section(const contact_frame &frame, double start[2]) const;

  // Of a roller's surface along x, rad, > 0 where it falls.
  double roller_inclination(const vec3 &at) const;

  // h[ny][nx], x fastest; no_surface beyond the profiles. slopes: of a level rail, if asked for, as
  // rail_slopes() finds them.
  void undeformed_distance(const contact_frame &frame, const surface_grid &grid, double *h,
                           surface_slopes *slopes = nullptr) const;

  // The rail's slopes on a grid, zero where the rail does not reach; along_rows: by element where
  // they differ along x, else those at x = 0.
  void rail_slopes(const contact_frame &frame, const surface_grid &grid, bool along_rows,
                   surface_slopes &out) const;

  // Where the lines along n through a grid's elements meet one of the surfaces.
  void meet_surface(body which, const contact_frame &frame, const surface_grid &grid,
                    surface_visitor &visitor) const;

  using placement<double>::creepages;
  // m, along n from a frame's origin: of the point whose velocities are a wheel's and a rail's, and
  // at which creep forces act.
  using placement<double>::contact_depth;
  // From the wheelset centre to the contact reference, track axes: for moments.
  using placement<double>::lever;
  // Distance of the wheel's contact point from the wheelset's axis.
  using placement<double>::rolling_radius;
  // The contact reference in the axes of the profiles: y, z.
  using placement<double>::on_wheel_profile;
  using placement<double>::on_rail_profile;

  double rail_marker_y() const { return marker_y_; }
  double rail_marker_z() const { return marker_z_; }
  std::size_t bytes() const;

 private:
  void place_rail_marker();
  void find_marker_rates(const placed_profile::inner_face &face);
  section_rate rail_rate_at(double p) const;
  look_place look() const;
  void scan(bool at_height);
  void scan_all();
  void scan_near(double limit);
  void scan_block(int index);
  void refer();
  double highest_rail(double y, int &from) const;
  bool rail_point(double x, double y, double &z, curve_point &p, profile_place &last) const;
  surface wheel_seen_from(const contact_frame &frame) const;
  surface rail_seen_from(const contact_frame &frame) const;
  double locus_sine(const curve_point &p, double gap, double tolerance) const;
  double sampled_gap(double s) const;
  vec3 wheel_point(const curve_point &p, double sine) const;
  longitudinal_row row_of(const curve_point &p, double sine, double gap) const;
  void put_slope(const vec3 &origin, const frame_axes<double> &f, const std::array<double, 2> &at,
                 double p, double n, std::ptrdiff_t to, surface_slopes &out) const;
  double sideways(double x, double sine, const curve_point &p) const;
  void find_closest(const curve_point &p, double sine, locus_point &l) const;

  friend class moving_geometry;  // rates.hpp
  friend class locus_walk;

  placed_profile wheel_, rail_;
  gap_samples samples_;
  bool overlap_ = false;
  const longitudinal_shape *shape_ = nullptr;
  const profile_sections *rail_sections_ = nullptr, *wheel_sections_ = nullptr;
  double marker_rate_[2] = {0, 0};  // of y, z by the place along the rail
};

// Points of the locus that lie near each other, one after the other: side_geometry::locus() of each
// but for rounding. On a level rail each is found from the one before.
class locus_walk {
 public:
  explicit locus_walk(const side_geometry &side);
  locus_point operator()(double s);

 private:
  bool follow(double s, locus_point &l);
  bool meet_rail(double y);
  double angle_of(double dy, double dz);

  const side_geometry &side_;
  bool level_, begun_ = false;
  double low_, high_;  // m, y of the rail's running branch
  locus_place place_;
  profile_piece wheel_{}, rail_{};  // those of the last point
  double at_ = 0;                   // m, on the rail's piece
  double y_ = 0, dy_ = 1, d2y_ = 0;
  // rad, of a direction near the last ones
  double angle_ = 0, along_ = 0, down_ = 0;
};

}  // namespace railpatch
