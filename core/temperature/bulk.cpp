#include "temperature/bulk.hpp"

#include "numeric/elementary.hpp"

namespace railpatch {

double bulk_after(double temperature, double heat, double capacity, double conductance, double air,
                  double seconds) {
  const double decay = conductance * seconds / capacity;
  // (1 - exp(-x))/x, 1 without air
  const double share = decay > 0 ? -expm1(-decay) / decay : 1.0;
  return temperature + (heat + conductance * (air - temperature)) * seconds / capacity * share;
}

bulk_temperatures::bulk_temperatures(const bulk_setup &setup) : setup_(setup) { reset(); }

void bulk_temperatures::reset() {
  kept_.begun = 0;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 2; ++k) {
      kept_.temperature[side][k] = now_[side][k] = setup_.start[k];
      kept_.heat[side][k] = 0;
    }
}

void bulk_temperatures::begin(double seconds) {
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 2; ++k) {
      now_[side][k] = kept_.temperature[side][k];
      if (setup_.stores(k) && kept_.begun > 0 && seconds > 0)
        now_[side][k] = bulk_after(now_[side][k], kept_.heat[side][k], setup_.capacity[k],
                                   setup_.conductance[k], setup_.air, seconds);
    }
}

bool bulk_temperatures::within_range() const {
  constexpr double coldest = -273.15, hottest = 1e4;
  for (const auto &side : now_)
    for (int k = 0; k < 2; ++k)
      if (setup_.stores(k) && !(side[k] > coldest && side[k] < hottest)) return false;
  return true;
}

void bulk_temperatures::keep(const double (&heat)[2][2]) {
  kept_.begun = 1;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 2; ++k) {
      kept_.temperature[side][k] = now_[side][k];
      kept_.heat[side][k] = heat[side][k];
    }
}

}  // namespace railpatch
