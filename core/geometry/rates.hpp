// Rates of change of one side's geometry with its motion: the quantities of geometry.hpp and
// patch_parts.hpp in numbers that carry their rates along several directions at once.
//
// What is found there as a root (the point of the locus, the rail's arc length at a lateral
// position, the ends of a part) is differentiated here as an implicit function of the motion. At a
// kink of a profile's curvature the rates are those of the interval that holds the point.
#pragma once

#include "geometry/geometry.hpp"
#include "geometry/patch_parts.hpp"

namespace railpatch {

constexpr int rate_directions = 6;
// behind the directions: what is solved for, the sine along the wheel's circumference and the arc
// length of its profile
constexpr size_t sine_slot = rate_directions, arc_slot = rate_directions + 1;
using rated = dual<rate_directions + 2>;
using rated_frame = basic_contact_frame<rated>;

inline rated unknown(double value, size_t slot) {
  rated out(value);
  out.rate[slot] = 1.0;
  return out;
}

// The unknown of a slot as a function of the others, where its residual stays zero.
inline rated solved(double value, const rated &residual, size_t slot) {
  rated out(value);
  for (size_t k = 0; k < out.rate.size(); ++k)
    out.rate[k] = k == slot ? 0.0 : -residual.rate[k] / residual.rate[slot];
  return out;
}

// Directions: rates of everything that moves, of a right-hand side.
struct motion_rates {
  std::array<side_motion, rate_directions> direction;
  int count = 0;
};

struct rated_locus {
  bool valid = false;
  vec<rated> wheel, normal;
  rated gap, contact_angle, curvature;
};

// Rates of a lattice, m: centre of element (0, 0) and size, along rolling and lateral.
struct lattice_rates {
  double origin[2] = {0, 0}, size[2] = {0, 0};
};

class moving_geometry : private placement<rated> {
 public:
  // The side must be placed, and stay so. Nothing here allocates.
  moving_geometry(const side_geometry &side, const motion_rates &motion);

  // As those of side_geometry.
  rated_locus locus(const rated &s) const;
  bool rail_surface(const rated &x, const rated &y, rated &z, rated &angle) const;
  using placement<rated>::creepages;
  using placement<rated>::contact_depth;
  using placement<rated>::lever;
  using placement<rated>::rolling_radius;
  using placement<rated>::on_wheel_profile;
  using placement<rated>::on_rail_profile;

  // A part found there.
  basic_part<rated> part_of(const part &found) const;
  // rates[k][ny][nx] of the undeformed distance, for the first `count` directions; the elements
  // move with the lattice, whose rates are by direction too (null: it stands still in the frame).
  // Where there is no surface they mean nothing.
  void distance_rates(const rated_frame &frame, const surface_grid &grid,
                      const lattice_rates *lattice, int count, double *const *rates) const;
  // The same of the rail's slopes, out[k]; along_rows: of each element where they differ along x.
  void rail_slope_rates(const rated_frame &frame, const surface_grid &grid,
                        const lattice_rates *lattice, int count, bool along_rows,
                        surface_slopes *out) const;

 private:
  // The profile in its meridian plane.
  struct meridian {
    const placed_profile *at;
    rated cosine, sine, y, z, angle;
  };
  struct point {
    rated y, z, dy, dz;
  };
  point evaluate(const meridian &m, const rated &s) const;
  vec<rated> wheel_point(const point &p, const rated &sine) const;
  rated edge(double s) const;

  const side_geometry &side_;
  meridian wheel_, rail_;
};

}  // namespace railpatch
