// The sums that a result states of a wheel's patches and of its wheels, by the lists of their
// fields: by share, added, or the greatest; and their rates.
#pragma once

#include "patch/result_fields.hpp"

namespace railpatch {

// Of a wheel's patches and alternatives. Without any: what the scene's stages give unloaded.
void sum_patches(const patch_scene &scene, rp_side_result &side);
// The sums' rates from those of the patches; `value` is what they are rates of.
void sum_patch_rates(const rp_side_result &value, rp_side_result &rate);
// Of the wheels that are there; sum: the values themselves or their rates.
void sum_sides(const bool (&there)[2], const rp_result &value, rp_result &sum);

}  // namespace railpatch
