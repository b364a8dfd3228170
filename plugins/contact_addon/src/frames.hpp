// Where rail and wheel stand in the track: frames to hand results out in. Right-handed axes of the
// track on both sides; profiles are those of the right side, mirrored for the left one.
#pragma once

#include <array>

#include "problem.hpp"

namespace contact_addon {

using vector3 = std::array<double, 3>;
using matrix3 = std::array<vector3, 3>;  // rows: an own vector's components in the track

struct marker {
  vector3 place{};
  matrix3 axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  vector3 inside(const vector3 &track) const;  // a vector of the track, in own axes
  vector3 point_inside(const vector3 &track) const;
};

struct frames {
  marker rail, wheelset, wheel;
  double rail_roll = 0;  // rad, about x
  double wheel_roll = 0, wheel_yaw = 0;
};

// Needs a solved case.
frames frames_of(const problem &p);
// The rail's marker by gauge, height and cant alone, without its deviation: y, z.
std::array<double, 2> design_place(const profile_curve &rail, bool roller, double gauge,
                                   double gauge_height, double cant);

// Force and moment on the wheel, track axes, moment about the wheelset's centre.
struct wrench {
  vector3 force{}, moment{};
};
wrench wrench_of(const problem &p, const rp_patch_result &r);
vector3 cross(const vector3 &a, const vector3 &b);
vector3 minus(const vector3 &a, const vector3 &b);

}  // namespace contact_addon
