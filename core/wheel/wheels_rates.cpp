// Rates of wheels, where they come from the equations: in one direction, and by pose and velocity.
#include <algorithm>
#include <cmath>
#include <utility>

#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"
#include "patch/result_sums.hpp"
#include "patch/status.hpp"
#include "wheel/jacobian_columns.hpp"
#include "wheel/wheel_loads.hpp"
#include "wheel/wheels.hpp"
#include "wheel/wheelset_power.hpp"

namespace railpatch {

namespace {

constexpr double exact_tolerance = 1e-8, coarse_tolerance = 1e-6;  // of the linear systems
// the columns that a round wheel on a rail without end depends on; x by its friction at most
constexpr int directions[] = {1, z_column, 3, 4, 6, 7, 8, 9, 10, 11, 0};
constexpr int direction_count = static_cast<int>(std::size(directions));
static_assert(direction_count <= wheel_derivative::most_directions);

// n equations row by row, the right sides as last column; NaN where they have no one solution.
void solve_small(double (&a)[3][4], int n, double *x) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[best][k])) best = i;
    if (best != k) std::swap(a[k], a[best]);
    if (a[k][k] == 0) {
      std::fill_n(x, n, nan);
      return;
    }
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (int j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      a[i][3] -= factor * a[k][3];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    double rest = a[k][3];
    for (int j = k + 1; j < n; ++j) rest -= a[k][j] * x[j];
    x[k] = rest / a[k][k];
  }
}

}  // namespace

size_t wheels::derivative_bytes() const {
  const size_t own = rates_ ? sizeof *rates_ + rates_->wheels.bytes() +
                                  rates_->changes.size() * sizeof(rp_side_result)
                            : 0;
  return solver_.derivative_bytes() + own;
}

// Of the friction coefficient with its factors along the track and of a wheel.
friction_rates wheels::friction_rate(const rp_input &direction, const rp_input &input,
                                     int side) const {
  const double change = direction.friction_scale[side];
  friction_rates out{direction.friction_coefficient, change, direction.water_rate,
                     direction.water_temperature, direction.oil_film};
  if (!friction_along_.varies()) return out;
  const double slope = friction_along_.slope(input.x);
  out.scale = input.friction_scale[side] * slope * direction.x;
  out.scale += friction_along_.at(input.x) * change;
  return out;
}

int wheels::found_columns(int (&columns)[3]) const {
  int count = 0;
  if (force_given_) columns[count++] = z_column;
  if (balance_ && balance_->roll) columns[count++] = roll_column;
  if (balance_ && balance_->axle) columns[count++] = pitch_rate_column;
  return count;
}

// Of the condition that belongs to a column of what is found: the vertical force, the roll moment,
// the torque about the axle or the longitudinal force. rate: of the wheels by side.
double wheels::found_rate(int column, const rp_input &at, const rp_input &direction,
                          const rp_result &result, const side_rates &rate) const {
  if (column == pitch_rate_column && !balance_->along)
    return torque_rate(at, direction, result, rate) - direction.axle_torque;
  if (column == pitch_rate_column) {
    double along = -direction.longitudinal_force;
    for (const auto &wheel : wheels_) along += rate[wheel.side()]->force[0];
    return along;
  }
  double sum = column == z_column ? direction.vertical_force : 0.0;
  for (const auto &wheel : wheels_)
    sum += column == z_column ? rate[wheel.side()]->force[2] : rate[wheel.side()]->moment[0];
  return sum;
}

void wheels::differentiate(const rp_input &direction, const rp_input &input,
                           const rp_result &result, rp_result &out) {
  // z is an input, or found with the rates of the vertical force; roll and pitch rate likewise
  rp_input at = input;
  at.roll = result.roll;
  at.pitch_rate = result.pitch_rate;
  rp_input total = direction;
  int column[3];
  const int found = found_columns(column);
  for (int k = 0; k < found; ++k) *pose_and_velocity(total, column[k]) = 0;
  rp_input inputs[4] = {total};
  for (int k = 0; k < found; ++k) inputs[k + 1] = unit_direction(direction, column[k]);
  const int count = 1 + found;
  for (size_t w = 0; w < wheels_.size(); ++w) {
    const wheel_contact &wheel = wheels_[w];
    const int side = wheel.side();
    const friction_rates friction[4] = {friction_rate(direction, input, side), {}, {}, {}};
    solver_.set_friction_scale(scale_[side]);
    const derivative_outcome outcome = wheel.differentiate(
        solver_, memory_of(w), rates_->wheels, inputs, friction, count, {}, result.side[side],
        rates_->changes.data() + static_cast<ptrdiff_t>(side) * count);
    if (outcome.converged) continue;
    fail_rates(out);
    fail_rates_of_wheel(out.side[side]);
  }
  double equations[3][4], rate[3];
  for (int j = 0; j < count; ++j) {
    const side_rates of_sides = {&rates_->changes[static_cast<size_t>(j)],
                                 &rates_->changes[static_cast<size_t>(count + j)]};
    for (int i = 0; i < found; ++i) {
      const double v = found_rate(column[i], at, inputs[j], result, of_sides);
      (j == 0 ? equations[i][3] : equations[i][j - 1]) = j == 0 ? -v : v;
    }
  }
  solve_small(equations, found, rate);
  for (int k = 0; k < found; ++k) *pose_and_velocity(total, column[k]) = rate[k];
  // what the result does not know stays NaN
  const auto set = [](double &rate, double v) {
    if (!std::isnan(rate)) rate = v;
  };
  set(out.z, total.z);
  set(out.roll, total.roll);
  set(out.pitch_rate, total.pitch_rate);
  for (const auto &wheel : wheels_) {
    const int side = wheel.side();
    rp_side_result *changes = &rates_->changes[static_cast<size_t>(side * count)];
    double *to[result_numbers];
    int numbers = 0, next = 0;
    const auto collect = [&](double &v) { to[numbers++] = &v; };
    for_each_side_number(out.side[side], collect);
    for_each_side_number(changes[0], [&](double &v) { set(*to[next++], v); });
    for (int k = 0; k < found; ++k) {
      next = 0;
      for_each_side_number(changes[k + 1], [&](double &v) { *to[next++] += rate[k] * v; });
    }
  }
  bool there[2] = {false, false};
  for (const auto &wheel : wheels_) {
    const rp_side_result &side = result.side[wheel.side()];
    rp_side_result &change = out.side[wheel.side()];
    there[wheel.side()] = true;
    sum_patch_rates(side, change);
    change.contact_power =
        wheelset_power_rate(at, total, {side.force, side.moment}, {change.force, change.moment});
    set_load_rates(wheel.side(), side, change);
  }
  sum_sides(there, result, out);
  set(out.axle_torque, torque_rate(at, total, result, {&out.side[0], &out.side[1]}));
  if (there[RP_LEFT] && there[RP_RIGHT]) set_conicity_rates(at.y, total.y, result, out);
}

// Exact slopes of the balance's conditions by what it finds; where the vertical force is prescribed
// z follows. Returns false where they are not known.
bool wheels::balance_slopes(const rp_input &at, const rp_result &result, balance_slope &slope) {
  rp_input inputs[3];
  const friction_rates friction[3];
  int column[3];
  const int count = found_columns(column), z = force_given_ ? 1 : 0;
  for (int k = 0; k < count; ++k) inputs[k] = unit_direction(at, column[k]);
  for (size_t w = 0; w < wheels_.size(); ++w) {
    const int side = wheels_[w].side();
    solver_.set_friction_scale(scale_[side]);
    const derivative_outcome outcome = wheels_[w].differentiate(
        solver_, memory_of(w), rates_->wheels, inputs, friction, count, {coarse_tolerance, false},
        result.side[side], rates_->changes.data() + static_cast<ptrdiff_t>(side) * count);
    if (!outcome.converged) return false;
  }
  double rates[3][3];
  for (int j = 0; j < count; ++j) {
    const side_rates of_sides = {&rates_->changes[static_cast<size_t>(j)],
                                 &rates_->changes[static_cast<size_t>(count + j)]};
    for (int i = 0; i < count; ++i)
      rates[i][j] = found_rate(column[i], at, inputs[j], result, of_sides);
  }
  for (int i = z; i < count; ++i)
    for (int j = z; j < count; ++j) {
      double &s = slope[static_cast<size_t>(i - z)][static_cast<size_t>(j - z)];
      s = rates[i][j];
      if (z == 1) s -= rates[i][0] * rates[0][j] / rates[0][0];
    }
  return true;
}

void wheels::jacobian(const rp_input &input, const rp_result &result, rp_jacobian &out) {
  rp_input inputs[direction_count];
  friction_rates friction[direction_count];
  const int count = friction_along_.varies() ? direction_count : direction_count - 1;
  for (int k = 0; k < count; ++k) {
    inputs[k] = unit_direction(input, directions[k]);
  }
  // no better than the solution they belong to
  const double tolerance = std::clamp(0.1 * tolerance_, exact_tolerance, coarse_tolerance);
  const derivative_options options{tolerance, false};
  double vertical[jacobian_columns] = {};
  for (size_t w = 0; w < wheels_.size(); ++w) {
    const wheel_contact &wheel = wheels_[w];
    const int side = wheel.side();
    solver_.set_friction_scale(scale_[side]);
    for (int k = 0; k < count; ++k) friction[k] = friction_rate(inputs[k], input, side);
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
