// Y, Q and Y/Q of a wheel (EN 14363), the conicity that a wheelset rolls with, and their rates.
#pragma once

#include <cmath>

#include "railpatch.h"

namespace railpatch {

// The lateral force on the rail, outward, over that on the wheel.
inline double outward(int side) { return side == RP_LEFT ? 1.0 : -1.0; }

inline void set_loads(int of, rp_side_result &side) {
  side.guiding_force = 0.0 + outward(of) * side.force[1];
  side.wheel_load = 0.0 - side.force[2];
  if (side.wheel_load > 0) side.derailment_quotient = side.guiding_force / side.wheel_load;
}

// side: what they are rates of.
inline void set_load_rates(int of, const rp_side_result &side, rp_side_result &rate) {
  rate.guiding_force = outward(of) * rate.force[1];
  rate.wheel_load = -rate.force[2];
  if (side.wheel_load > 0)
    rate.derailment_quotient =
        (rate.guiding_force - side.derailment_quotient * rate.wheel_load) / side.wheel_load;
}

// Of a wheelset with both wheels at the lateral position y (m).
inline void set_conicity(double y, rp_result &out) {
  constexpr double least = 1e-5;  // m, below which the quotient is of roughness and rounding
  out.rolling_radius_difference =
      out.side[RP_RIGHT].rolling_radius - out.side[RP_LEFT].rolling_radius;
  if (std::fabs(y) >= least) out.conicity = 0.5 * out.rolling_radius_difference / y;
}

inline void set_conicity_rates(double y, double y_rate, const rp_result &value, rp_result &rate) {
  if (std::isnan(value.rolling_radius_difference)) return;
  rate.rolling_radius_difference =
      rate.side[RP_RIGHT].rolling_radius - rate.side[RP_LEFT].rolling_radius;
  if (!std::isnan(value.conicity))
    rate.conicity = (0.5 * rate.rolling_radius_difference - value.conicity * y_rate) / y;
}

}  // namespace railpatch
