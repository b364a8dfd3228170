// Resultants of pressure and traction, in the contact frame and at the wheelset centre.
//
// Contact frame seen from the track frame with contact angle d: e_x = (1, 0, 0),
// e_s = (0, cos d, sin d), n = (0, -sin d, cos d); the pressure pushes the wheel along -n.
#pragma once

#include "influence.hpp"

namespace railpatch {

struct patch_wrench {
  double force[3];   // N on the wheel: longitudinal, lateral, along n
  double moment[3];  // N m on the wheel about the contact reference, contact frame
};

// px, py may be null where the scene has no tangential stage.
patch_wrench sum_tractions(const grid &g, const double *pressure, const double *px,
                           const double *py);
// Adds the wrench at a contact reference `lever` away from the wheelset centre (track axes).
void add_wrench(const patch_wrench &wrench, double contact_angle, const double lever[3],
                double force[3], double moment[3]);

}  // namespace railpatch
