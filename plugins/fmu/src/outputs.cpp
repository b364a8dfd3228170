#include "outputs.hpp"

#include <cmath>

namespace railpatch::fmu {

namespace {

// Of the warmer body.
double bulk_of(const rp_input &of, const rp_input &input) {
  const double *bulk = input.bulk_temperature;
  return of.bulk_temperature[bulk[1] > bulk[0] ? 1 : 0];
}

}  // namespace

void set_rest_temperature(Outputs &outputs, const rp_input &input) {
  const double bulk = bulk_of(input, input);
  outputs.rest_temperature = std::isfinite(bulk) ? bulk : 0.0;
}

void set_rest_temperature_rate(const rp_input &input, const rp_input &direction, Outputs &change) {
  const double rate = bulk_of(direction, input);
  change.rest_temperature = std::isfinite(rate) ? rate : 0.0;
}

}  // namespace railpatch::fmu
