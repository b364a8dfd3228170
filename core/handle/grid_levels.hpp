// The grids that a handle may solve a step on where an accuracy is asked for, from the coarsest to
// the finest: each is a driver with its own memory, made with the handle.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "patch/driver.hpp"
#include "railpatch.h"

namespace railpatch {

// The configurations of all levels: the one given, and finer_grids finer ones, fewer where fitted
// rows have no more room.
std::vector<rp_config> configs_of_levels(const rp_config &config);

// The greatest error estimate of a creep force over what is allowed of it, over all solutions of
// patches; 0 where nothing is to be had by a finer grid, because there is no creep force or what
// was solved is no solution; infinite where one has no estimate.
double excess_of(const rp_result &result, const std::array<double, 2> &friction, double accuracy);
// What is solved but not as accurate as asked for.
void report_inaccurate(const std::array<double, 2> &friction, double accuracy, rp_result &out);

// Begins on another grid with the last solution of this one, as far as it fits.
void carry_over(driver &from, driver &to);
// The same of what belongs to no patch.
void carry_kept(driver &from, driver &to);

}  // namespace railpatch
