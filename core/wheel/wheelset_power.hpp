// The power that a contact force and its moment about the wheelset's centre give the wheelset, by
// the velocities of a step's input, and its rate.
#pragma once

#include "railpatch.h"

namespace railpatch {

// A force with its moment, and either both values or both rates.
struct force_and_moment {
  const double *force, *moment;  // N, N m [3], track axes
};

double wheelset_power(const rp_input &input, const force_and_moment &on);
// Their torque about the axle: the moment, and its rate.
double axle_torque(const rp_input &input, const double *moment);
double axle_torque_rate(const rp_input &input, const rp_input &direction, const double *moment,
                        const double *rate);
double wheelset_power_rate(const rp_input &input, const rp_input &direction,
                           const force_and_moment &on, const force_and_moment &rate);

}  // namespace railpatch
