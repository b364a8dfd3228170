// What the outputs are read from: the core's result, and sums over its patches beside it.
#pragma once

#include "railpatch.h"

namespace railpatch::fmu {

struct Sums {
  double friction_power, elastic_energy;  // W, J, of the patches by their shares
  double power;     // W, of force and moment at the velocities of the wheelset that are inputs
  double residual;  // -, greatest of the patches
  double mean_force[3], mean_moment[3];  // N, N m, over the last communication step
};

struct Outputs {
  rp_result result;  // first: the fields of either are counted from here
  Sums sums[3];      // left, right, both
};

// Fills the sums but the means, which become force and moment themselves.
void add_sums(Outputs &outputs, const rp_input &input);

// Rates of the sums: change.result holds the result's, direction the input's. Those of residual are
// 0: it is the solver's own.
void add_sum_rates(const Outputs &outputs, const rp_input &input, const rp_input &direction,
                   Outputs &change);

}  // namespace railpatch::fmu
