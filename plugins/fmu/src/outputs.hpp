// What the outputs are read from: the core's result, and what it knows of patches that are not
// there.
#pragma once

#include "railpatch.h"

namespace railpatch::fmu {

struct Outputs {
  rp_result result;  // first: the fields of either are counted from here
  // degrees C, of patches without contact: the warmer bulk temperature; 0: the scene has none
  double rest_temperature;
};

// Without contact a patch's temperature becomes the warmer bulk temperature of the input (NaN: the
// scene has none).
void fill_temperatures(Outputs &outputs, const rp_input &input);

// The same of rates: change.result holds the result's, direction the input's.
void fill_temperature_rates(const rp_input &input, const rp_input &direction, Outputs &change);

}  // namespace railpatch::fmu
