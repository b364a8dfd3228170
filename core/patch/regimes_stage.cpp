// Creep forces by regimes of water: Polach's theory at the knots beside the rate, and their blend.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "patch/tangential_stage.hpp"

namespace railpatch {

namespace {

// What is blended: force, moment, power over speed, and the coefficient.
constexpr int blended = 5;

slip_velocity_law law_of(const polach_regime &knot) {
  slip_velocity_law law;
  law.shape = RP_SLIP_EXPONENTIAL;
  law.kinetic = knot.coefficient * knot.a;
  law.amplitude[0] = knot.coefficient - law.kinetic;
  if (knot.b > 0) {
    law.halving_speed[0] = std::numbers::ln2 / knot.b;
  } else {
    law.kinetic = knot.coefficient;
    law.amplitude[0] = 0;
  }
  return law;
}

}  // namespace

tangential_result tangential_stage::solve_regimes(const fast_patch &patch,
                                                  const rolling_input &rolling,
                                                  creep_resultants &sums) {
  const water_regimes &regimes = shared_.scene.fluid->regimes;
  const fluid_supply &supply = shared_.scene.supply;
  const double rate = std::max(supply.water_rate, 0.0);
  double x[RP_MAX_KNOTS], y[blended][RP_MAX_KNOTS] = {};
  for (int k = 0; k < regimes.count; ++k) x[k] = log(regimes.knot[k].rate + regimes.reference_rate);
  const double at = log(rate + regimes.reference_rate);
  tangential_result result;
  result.converged = true;
  const double slip = rolling.speed * hypot(rolling.creepage[0], rolling.creepage[1]);
  for (int k = 0; k < regimes.count; ++k) {
    // the curve between two knots knows the next ones, and recovery the first
    const bool near = (k == 0 || x[k - 1] <= at || (k > 1 && x[k - 2] <= at)) &&
                      (k + 1 == regimes.count || x[k + 1] >= at ||
                       (k + 2 < regimes.count && x[k + 2] >= at) || k + 2 == regimes.count);
    const bool cleans = k == 0 && regimes.recovery > 0;
    if (!near && !cleans) continue;
    const slip_velocity_law law = law_of(regimes.knot[k]);
    fast_->set_polach({regimes.knot[k].k_a, regimes.knot[k].k_s}, law);
    creep_resultants own;
    const tangential_result found = fast_->solve(patch, rolling, {}, own);
    result.converged = result.converged && found.converged;
    double slope;
    const double values[blended] = {own.force[0], own.force[1], own.moment, own.friction,
                                    law.coefficient(slip, slope)};
    for (int n = 0; n < blended; ++n) y[n][k] = values[n];
  }
  const double left = regimes.recovery > 0 ? exp(-regimes.recovery * supply.work) : 1.0;
  double now[blended];
  for (int n = 0; n < blended; ++n)
    now[n] = left * shape_preserving(x, y[n], regimes.count, at) + (1.0 - left) * y[n][0];
  sums.force[0] = now[0];
  sums.force[1] = now[1];
  sums.moment = now[2];
  sums.friction = result.friction = now[3];
  shared_.scene.wet_friction = now[4];
  sums.capacity = now[4] * patch.friction_scale * patch.normal_force;
  return result;
}

}  // namespace railpatch
