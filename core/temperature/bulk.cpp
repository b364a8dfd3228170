#include "temperature/bulk.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// (1 - exp(-x))/x
double faded(double x) { return x > 0 ? -expm1(-x) / x : 1.0; }

}  // namespace

// With y the change since the step began, C^-1 the inverse capacities and P the matrix of rates,
//   dy/dt = r - P y,  P = C^-1 (G [1 -1; -1 1] + diag(H)),  r = C^-1 (F + ...) at the beginning,
//   y = t phi(P t) r,  phi(x) = (1 - exp(-x))/x,
// and a function of a 2 x 2 matrix is the straight line through its values at the eigenvalues,
// here real and not negative: P is similar to a symmetric matrix.
void advance_bulk(const bulk_setup &setup, const bulk_flow &flow, double seconds,
                  double (&temperature)[2]) {
  const double g = flow.exchange;
  double own[2], rate[2] = {0, 0};  // 1/s, K/s
  for (int k = 0; k < 2; ++k) {
    if (!setup.stores(k)) continue;
    const double h = setup.conductance[k];
    own[k] = (g + h) / setup.capacity[k];
    rate[k] = (flow.heat[k] + h * (setup.air - temperature[k])) / setup.capacity[k];
  }
  if (!(setup.stores(0) && setup.stores(1) && g > 0)) {
    for (int k = 0; k < 2; ++k)
      if (setup.stores(k)) temperature[k] += rate[k] * seconds * faded(own[k] * seconds);
    return;
  }
  const double c[2] = {setup.capacity[0], setup.capacity[1]};
  const double h[2] = {setup.conductance[0], setup.conductance[1]};
  const double half_gap = hypot(0.5 * (own[0] - own[1]), g / (std::sqrt(c[0]) * std::sqrt(c[1])));
  const double fast = 0.5 * (own[0] + own[1]) + half_gap;
  // by the determinant, without differences of large numbers: 0 without air
  const double slow = (g / c[0] * (h[1] / c[1]) + h[0] / c[0] * ((g + h[1]) / c[1])) / fast;
  const double end = faded(slow * seconds), slope = (faded(fast * seconds) - end) / (fast - slow);
  const double across = g * (rate[0] - rate[1]);
  const double turned[2] = {(across + h[0] * rate[0]) / c[0], (h[1] * rate[1] - across) / c[1]};
  for (int k = 0; k < 2; ++k)
    temperature[k] += seconds * (end * rate[k] + slope * (turned[k] - slow * rate[k]));
}

bulk_temperatures::bulk_temperatures(const bulk_setup &setup) : setup_(setup) { reset(); }

void bulk_temperatures::reset() {
  kept_.begun = 0;
  for (int side = 0; side < 2; ++side) {
    std::copy_n(setup_.start, 2, kept_.temperature[side]);
    std::copy_n(setup_.start, 2, now_[side]);
    kept_.flow[side] = {};
  }
}

void bulk_temperatures::begin(double seconds) {
  for (int side = 0; side < 2; ++side) {
    std::copy_n(kept_.temperature[side], 2, now_[side]);
    if (kept_.begun > 0 && seconds > 0) advance_bulk(setup_, kept_.flow[side], seconds, now_[side]);
  }
}

bool bulk_temperatures::within_range() const {
  constexpr double coldest = -273.15, hottest = 1e4;
  for (const auto &side : now_)
    for (int k = 0; k < 2; ++k)
      if (setup_.stores(k) && !(side[k] > coldest && side[k] < hottest)) return false;
  return true;
}

void bulk_temperatures::keep(const bulk_flow (&flow)[2]) {
  kept_.begun = 1;
  for (int side = 0; side < 2; ++side) {
    std::copy_n(now_[side], 2, kept_.temperature[side]);
    kept_.flow[side] = flow[side];
  }
}

}  // namespace railpatch
