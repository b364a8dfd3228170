// The largest step for which a master may hold the forces of the contact.
#pragma once

#include "railpatch.h"

namespace railpatch::fmu {

struct Inertia {
  double mass;       // kg
  double moment[3];  // kg m^2, about x, the axle, z
};

// s, at most 1; 0 where a derivative is not known. With M the inertia of the wheelset, K and C the
// negative derivatives of force and moment by pose and velocity, and the spectral norms of
// M^(-1/2) K M^(-1/2) = w^2 and M^(-1/2) C M^(-1/2) = c, it is the least of
//   0.1/w  a held force acts half a step late on average, like a damper -K h/2: at w h = 0.1 that
//          takes w h/4, 2.5 %, of critical damping from an oscillation on the contact's stiffness;
//   1/c    creep forces then do not overshoot: v(t + h) = (1 - h c) v(t).
// z counts where it is given; where the vertical force is given it follows.
double largest_step_of(const rp_jacobian &jacobian, const Inertia &inertia, bool with_z);

}  // namespace railpatch::fmu
