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

// By the input's bulk temperatures (NaN: the scene has none).
void set_rest_temperature(Outputs &outputs, const rp_input &input);
// By their rates.
void set_rest_temperature_rate(const rp_input &input, const rp_input &direction, Outputs &change);

}  // namespace railpatch::fmu
