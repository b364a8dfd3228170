// What the outputs are read from: the core's result, and sums over its patches beside it.
#pragma once

#include "railpatch.h"

namespace railpatch::fmu {

struct Sums {
  double friction_power, elastic_energy;  // W, J, of the patches by their shares
  double power;          // W, of force and moment at the velocities of the wheelset that are inputs
  double residual;       // -, greatest of the patches
  double plastic_power;  // W, of the patches by their shares
  double max_temperature;  // degrees C, greatest of the patches; else the warmer bulk temperature
  double mean_force[3], mean_moment[3];  // N, N m, over the last communication step
};

struct Outputs {
  rp_result result;  // first: the fields of either are counted from here
  Sums sums[3];      // left, right, both
  // degrees C, of patches without contact: the warmer bulk temperature; 0: the scene has none
  double rest_temperature;
};

// Fills the sums but the means, which become force and moment themselves. Without contact a patch's
// temperature becomes the warmer bulk temperature of the input (NaN: the scene has none).
void add_sums(Outputs &outputs, const rp_input &input);

// Rates of the sums: change.result holds the result's, direction the input's. Those of residual are
// 0: it is the solver's own. Of greatest temperatures they are those of the patch that has it.
void add_sum_rates(const Outputs &outputs, const rp_input &input, const rp_input &direction,
                   Outputs &change);

}  // namespace railpatch::fmu
