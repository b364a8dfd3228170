// The power that creepages and spin supply, by the result's own numbers, the wear number, and their
// rates.
#pragma once

#include <cmath>

#include "railpatch.h"

namespace railpatch {

// N, over the rolling speed: T gamma, which is positive where energy is taken.
inline double creep_work(const rp_patch_result &r) {
  return -(r.creep_force[0] * r.creepage[0] + r.creep_force[1] * r.creepage[1] +
           r.spin_moment * r.spin_creepage);
}

// speed: 1 in a shift. At standstill creepages supply nothing.
inline double creep_power(const rp_patch_result &r, double speed) {
  return speed > 0 ? creep_work(r) * speed : 0.0;
}

// In rolling. d: the rates of the others.
inline double creep_power_rate(const rp_patch_result &r, const rp_patch_result &d) {
  if (!(r.rolling_speed > 0)) return 0;
  double rate = d.spin_moment * r.spin_creepage + r.spin_moment * d.spin_creepage;
  for (int k = 0; k < 2; ++k)
    rate += d.creep_force[k] * r.creepage[k] + r.creep_force[k] * d.creepage[k];
  return creep_work(r) * d.rolling_speed - rate * r.rolling_speed;
}

// N, T gamma with each product by its size (Pearce and Sherratt 1991). force, moment: of the
// tractions, N and N m. Of rolling: by the way that is rolled, so that of a shift there is none,
// and 0 where nothing rolls.
inline double wear_number(const double force[2], double moment, const rp_patch_result &r) {
  if (!(r.rolling_speed > 0)) return 0;
  return std::fabs(force[0] * r.creepage[0]) + std::fabs(force[1] * r.creepage[1]) +
         std::fabs(moment * r.spin_creepage);
}

// A product that is zero has a kink there: the mean of both sides, which is none.
inline double wear_number_rate(const rp_patch_result &r, const rp_patch_result &d) {
  if (!(r.rolling_speed > 0)) return 0;
  const auto rate = [](double f, double c, double df, double dc) {
    const double change = df * c + f * dc;
    return f * c < 0 ? -change : f * c > 0 ? change : 0.0;
  };
  double sum = rate(r.spin_moment, r.spin_creepage, d.spin_moment, d.spin_creepage);
  for (int k = 0; k < 2; ++k)
    sum += rate(r.creep_force[k], r.creepage[k], d.creep_force[k], d.creepage[k]);
  return sum;
}

}  // namespace railpatch
