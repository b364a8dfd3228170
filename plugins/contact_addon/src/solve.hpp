// A case: from what was set to a result, and what is asked of it.
#pragma once

#include <string>
#include <vector>

#include "problem.hpp"

namespace contact_addon {

// Solves the case; what the interface's calculate answers.
int solve(problem &p, const char *call);

// Of the last case. patch: icp of module 1, else ignored; null where there is none.
const rp_patch_result *patch_of(const problem &p, int icp);
int index_of(const problem &p, int icp);
// The caller's grid of a patch: of module 1 the core's.
grid_data grid_of(const problem &p, const rp_patch_result &r);
// The profile of wheel or rail where the last case has it.
const profile_curve &profile_now(const problem &p, bool rail);
// A field on that grid, SI, signs of the core; parts: 1, or 2 with all of the first ahead. Empty
// where the scene has none.
std::vector<double> field_of(const problem &p, int icp, rp_field field, int parts = 1);
// Moment about n at the caller's origin.
double spin_moment_of(const problem &p, const rp_patch_result &r);
// Stresses and displacements at the points of a block: 0, or an error. Needs a solved patch.
int solve_block(problem &p, int icp, block &b, std::string &why);
// Difference of the bodies' displacements at the surface, rail minus wheel (m), [3][n]: x, y, n.
std::vector<double> displacements_of(const problem &p, int icp);
// Rates of Fn, Fx, Fy, Mz by penetration and creepages, in the caller's units: [nin][nout].
void sensitivities(const char *call, problem &p, const rp_patch_result &r, int nout, int nin,
                   double *values);

}  // namespace contact_addon
