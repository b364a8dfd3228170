#include "outputs.hpp"

#include <cmath>

namespace railpatch::fmu {

namespace {

// Of the warmer body.
double bulk_of(const rp_input &of, const rp_input &input) {
  const double *bulk = input.bulk_temperature;
  return of.bulk_temperature[bulk[1] > bulk[0] ? 1 : 0];
}

// Where there is no contact the core knows no temperature.
void fill(double rest, Outputs &outputs) {
  outputs.rest_temperature = std::isfinite(rest) ? rest : 0.0;
  for (auto &side : outputs.result.side)
    for (auto &patch : side.patch)
      if (std::isnan(patch.max_temperature)) patch.max_temperature = outputs.rest_temperature;
}

}  // namespace

void fill_temperatures(Outputs &outputs, const rp_input &input) {
  fill(bulk_of(input, input), outputs);
}

void fill_temperature_rates(const rp_input &input, const rp_input &direction, Outputs &change) {
  fill(bulk_of(direction, input), change);
}

}  // namespace railpatch::fmu
