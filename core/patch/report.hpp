// The one writer of rp_patch_result: what the stages found, as the interface states it.
#pragma once

#include "half_space/forces.hpp"
#include "patch/error_estimate.hpp"
#include "patch/outcomes.hpp"
#include "patch/patch_derivative.hpp"
#include "patch/patch_memory.hpp"
#include "railpatch.h"

namespace railpatch {

// A patch in contact. wrench: in the contact frame, of the pressure and tractions.
void report(const patch_scene &scene, const patch_problem &problem, const pressure_outcome &n,
            const traction_outcome &t, const heat_outcome &h, const patch_wrench &wrench,
            rp_patch_result &result);
// What viscoelastic bodies add to it.
void describe_viscous(const patch_problem &problem, const pressure_outcome &n,
                      const traction_outcome &t, const patch_wrench &wrench,
                      rp_patch_result &result);
// What the liquid is in it; scale: of the friction law in this step.
void describe_fluid(const fluid_outcome &f, double power, double scale, rp_patch_result &result);
// A problem whose bodies turned out not to touch.
void report_unloaded(const patch_scene &scene, const patch_problem &problem,
                     const pressure_outcome &n, const heat_outcome &h, rp_patch_result &result);
// Bodies that are apart by their approach: no problem was there to solve.
void report_apart(const patch_scene &scene, const patch_place &place, double approach,
                  const heat_outcome &h, rp_patch_result &result);
// A patch that no grid of this handle can hold; g: the one it asks for, empty where there is none.
void report_beyond(const patch_place &place, const grid &g, rp_patch_result &result);
// Rates of what a patch in contact found; where the result has no number, its rate stays as it is.
void report_rates(const rp_patch_result &value, const patch_change &change, rp_patch_result &rate);
void report_errors(const error_bounds &bounds, rp_patch_result &result);
// What an outer loop says of a patch afterwards: a status no better, a residual no smaller.
void report_search(const verdict &found, double residual, rp_patch_result &result);

}  // namespace railpatch
