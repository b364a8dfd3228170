// Rates of wheels, where they come from the equations: in one direction, and by pose and velocity.
#include <algorithm>
#include <cmath>

#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"
#include "patch/result_sums.hpp"
#include "patch/status.hpp"
#include "wheel/jacobian_columns.hpp"
#include "wheel/wheels.hpp"
#include "wheel/wheelset_power.hpp"

namespace railpatch {

namespace {

constexpr double exact_tolerance = 1e-8, coarse_tolerance = 1e-6;  // of the linear systems
// the columns that a round wheel on a rail without end depends on; x by its friction at most
constexpr int directions[] = {1, z_column, 3, 4, 6, 7, 8, 9, 10, 11, 0};
constexpr int direction_count = static_cast<int>(std::size(directions));
static_assert(direction_count <= wheel_derivative::most_directions);

}  // namespace

size_t wheels::derivative_bytes() const {
  const size_t own = rates_ ? sizeof *rates_ + rates_->wheels.bytes() +
                                  rates_->changes.size() * sizeof(rp_side_result)
                            : 0;
  return solver_.derivative_bytes() + own;
}

// Of the friction coefficient with its factor along the track.
double wheels::friction_rate(const rp_input &direction, const rp_input &input) const {
  const patch_scene &scene = solver_.scene();
  double rate = scene.friction_scale * direction.friction_coefficient;
  if (friction_along_.varies()) {
    const double slope = friction_along_.slope(input.x);
    rate += scene.friction_coefficient * slope * direction.x;
  }
  return rate;
}

void wheels::differentiate(const rp_input &direction, const rp_input &input,
                           const rp_result &result, rp_result &out) {
  // z is an input, or found with the rates of the vertical force
  const bool forced = force_given_;
  rp_input both[2] = {direction, unit_direction(direction, z_column)};
  if (forced) both[0].z = 0;
  const int count = forced ? 2 : 1;
  const double friction[2] = {friction_rate(direction, input), 0};
  double missing = -direction.vertical_force, slope = 0;
  for (size_t w = 0; w < wheels_.size(); ++w) {
    const wheel_contact &wheel = wheels_[w];
    const int side = wheel.side();
    rp_side_result *changes = &rates_->changes[static_cast<size_t>(side * count)];
    const derivative_outcome outcome =
        wheel.differentiate(solver_, memory_of(w), rates_->wheels, both, friction, count, {},
                            result.side[side], changes);
    missing -= changes[0].force[2];
    if (forced) slope += changes[1].force[2];
    if (outcome.converged) continue;
    fail_rates(out);
    fail_rates_of_wheel(out.side[side]);
  }
  const double z = !forced ? direction.z : slope != 0 ? missing / slope : nan;
  // what the result does not know stays NaN
  const auto set = [](double &rate, double v) {
    if (!std::isnan(rate)) rate = v;
  };
  set(out.z, z);
  for (const auto &wheel : wheels_) {
    const int side = wheel.side();
    rp_side_result *changes = &rates_->changes[static_cast<size_t>(side * count)];
    double *to[result_numbers];
    int numbers = 0, next = 0;
    const auto collect = [&](double &v) { to[numbers++] = &v; };
    for_each_side_number(out.side[side], collect);
    for_each_side_number(changes[0], [&](double &v) { set(*to[next++], v); });
    next = 0;
    if (forced) for_each_side_number(changes[1], [&](double &v) { *to[next++] += z * v; });
  }
  bool there[2] = {false, false};
  for (const auto &wheel : wheels_) {
    const rp_side_result &side = result.side[wheel.side()];
    rp_side_result &rate = out.side[wheel.side()];
    there[wheel.side()] = true;
    sum_patch_rates(side, rate);
    rate.contact_power =
        wheelset_power_rate(input, direction, {side.force, side.moment}, {rate.force, rate.moment});
  }
  sum_sides(there, result, out);
}

void wheels::jacobian(const rp_input &input, const rp_result &result, rp_jacobian &out) {
  rp_input inputs[direction_count];
  double friction[direction_count];
  const int count = friction_along_.varies() ? direction_count : direction_count - 1;
  for (int k = 0; k < count; ++k) {
    inputs[k] = unit_direction(input, directions[k]);
    friction[k] = friction_rate(inputs[k], input);
  }
  // no better than the solution they belong to
  const double tolerance = std::clamp(0.1 * tolerance_, exact_tolerance, coarse_tolerance);
  const derivative_options options{tolerance, false};
  double vertical[jacobian_columns] = {};
  for (size_t w = 0; w < wheels_.size(); ++w) {
    const wheel_contact &wheel = wheels_[w];
    const int side = wheel.side();
    const derivative_outcome outcome =
        wheel.differentiate(solver_, memory_of(w), rates_->wheels, inputs, friction, count, options,
                            result.side[side], rates_->changes.data());
    if (!outcome.converged && out.status == RP_CONVERGED) out.status = RP_NOT_CONVERGED;
    for (int k = 0; k < count; ++k) {
      const rp_side_result &change = rates_->changes[static_cast<size_t>(k)];
      for (int i = 0; i < 6; ++i) out.side[side][i][directions[k]] = component(change, i);
      vertical[directions[k]] += change.force[2];
    }
  }
  out.z[z_column] = 1.0;
  if (!force_given_) return;
  out.z[z_column] = 0.0;
  // without contact no height carries anything
  const double slope = vertical[z_column] != 0 ? vertical[z_column] : nan;
  out.z_force = -1.0 / slope;
  for (int column : directions) {
    if (column == z_column) continue;
    out.z[column] = -vertical[column] / slope;
    for (const auto &wheel : wheels_)
      for (auto &row : out.side[wheel.side()]) row[column] += row[z_column] * out.z[column];
  }
}

}  // namespace railpatch
