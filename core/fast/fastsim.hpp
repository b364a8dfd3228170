// FASTSIM, the simplified theory of rolling contact (Kalker 1982, Vehicle System Dynamics 11), with
// three flexibilities L1, L2, L3 from the creepage coefficients, marched along the rows of the
// uniform grid from the leading edge. Modified FASTSIM (Spiryagin, Polach, Cole 2013, Vehicle
// System Dynamics 51) divides them by k = k0 (alpha + (1 - alpha)/(1 + beta e)), e: see polach.hpp;
// with the flexibilities of the program CONTACT e is that of the stiffness times k0, as its
// published curve shows (to 0.4 % of e, the reading error of beta there being 0.8 %).
//
// Blended flexibilities (the program CONTACT): from w = 0 at small creepage to w = 1 where the
// creepage is three times that which saturates the linear theory, L_i -> (1 - w) L_i + w L*, L* one
// flexibility for all three, so that full sliding points exactly against the creepage. Against the
// full theory this halves the median error in force.
//
// The friction is that of the slip which the theory sees, with spin's part scaled by L1/L3 and
// L2/L3 (row_ends): it differs from what creep force and moment do on the creepages where spin is
// large.
#pragma once

#include "fast/fast_problem.hpp"

namespace railpatch {

flexibilities kalker_flexibilities(const creepage_coefficients &c, double shear_modulus,
                                   const double semi_axes[2]);
// capacity: N, mu times the normal force.
flexibilities blend(const flexibilities &l, const creepage_coefficients &c, double shear_modulus,
                    const double semi_axes[2], double capacity, const rolling_input &input);

// One step of the march: adds the traction that the rigid slip causes over a length, cuts it to the
// bound and gives the micro-slip. Returns whether it was cut.
bool march(const flexibilities &l, double length, double wx, double wy, double bound, double p[2],
           double s[2]);

// whole_steps: every step is one element long and ends in the element's centre, also the first,
// instead of reaching from the leading edge or the centre before; the rigid slip is then that at
// the centre, instead of the middle of the step.
tangential_result fastsim(const grid &g, const double *pressure, const double *bound,
                          const row_ends &rows, const flexibilities &l, bool whole_steps,
                          const rolling_input &input, tangential_fields fields);
tangential_result solve_fastsim(const fast_problem &problem, tangential_fields fields,
                                creep_resultants &sums);

}  // namespace railpatch
