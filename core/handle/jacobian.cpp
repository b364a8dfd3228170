// Derivatives of wheels: in one direction, and by pose and velocity at once.
#include <algorithm>
#include <cmath>

#include "handle/case_fields.hpp"
#include "handle/contact_derivative.hpp"
#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

constexpr double exact_tolerance = 1e-8, coarse_tolerance = 1e-6;  // of the linear systems
constexpr int columns = 12, z_column = 2;

double *pose_and_velocity(rp_input &in, int column) {
  double *const numbers[columns] = {&in.x,   &in.y,         &in.z,        &in.roll,
                                    &in.yaw, &in.pitch,     &in.speed,    &in.vy,
                                    &in.vz,  &in.roll_rate, &in.yaw_rate, &in.pitch_rate};
  return numbers[column];
}

// the columns that a round wheel on a rail without end depends on; x by its friction at most
constexpr int directions[] = {1, z_column, 3, 4, 6, 7, 8, 9, 10, 11, 0};
constexpr int direction_count = static_cast<int>(std::size(directions));
static_assert(direction_count <= wheel_derivative::most_directions);

rp_input unit_direction(const rp_input &like, int column) {
  rp_input d = like;
  for_each_number(d, [](const char *, double &v, double) { v = 0; });
  *pose_and_velocity(d, column) = 1.0;
  return d;
}

// force and moment, one after the other
double component(const rp_side_result &side, int i) {
  return i < 3 ? side.force[i] : side.moment[i - 3];
}

void degrade(rp_status &status, bool converged) {
  if (!converged && status == RP_CONVERGED) status = RP_NOT_CONVERGED;
}

}  // namespace

// Of the friction coefficient with its factor along the track.
double contact::friction_rate(const rp_input &direction) const {
  const patch_scene &scene = solver_.scene();
  double rate = scene.friction_scale * direction.friction_coefficient;
  if (friction_along_.varies()) {
    const double slope = friction_along_.slope(derivative_->input.x);
    rate += scene.friction_coefficient * slope * direction.x;
  }
  return rate;
}

void contact::differentiate_wheels(const rp_input &direction, rp_result &out) {
  derivative_record &record = *derivative_;
  // z is an input, or found with the rates of the vertical force
  const bool forced = config_.load == RP_FORCE;
  rp_input both[2] = {direction, unit_direction(direction, z_column)};
  if (forced) both[0].z = 0;
  const int count = forced ? 2 : 1;
  const double friction[2] = {friction_rate(direction), 0};
  double missing = -direction.vertical_force, slope = 0;
  for (const auto &wheel : wheels_) {
    const int side = wheel.side();
    rp_side_result *changes = &record.changes[static_cast<size_t>(side * count)];
    const derivative_outcome outcome =
        wheel.differentiate(solver_, &memory(side, 0), *record.wheels, both, friction, count, {},
                            record.result.side[side], changes);
    missing -= changes[0].force[2];
    if (forced) slope += changes[1].force[2];
    degrade(out.side[side].status, outcome.converged);
    degrade(out.status, outcome.converged);
  }
  const double z = !forced ? direction.z : slope != 0 ? missing / slope : nan;
  // what the result does not know stays NaN
  const auto set = [](double &rate, double v) {
    if (!std::isnan(rate)) rate = v;
  };
  set(out.z, z);
  for (const auto &wheel : wheels_) {
    const int side = wheel.side();
    rp_side_result *changes = &record.changes[static_cast<size_t>(side * count)];
    double *to[result_numbers];
    int numbers = 0, next = 0;
    const auto collect = [&](double &v) { to[numbers++] = &v; };
    for_each_side_number(out.side[side], collect);
    for_each_side_number(changes[0], [&](double &v) { set(*to[next++], v); });
    next = 0;
    if (forced) for_each_side_number(changes[1], [&](double &v) { *to[next++] += z * v; });
  }
  for (int k = 0; k < 3; ++k) {
    out.force[k] = out.moment[k] = 0;
    for (const auto &wheel : wheels_) {
      out.force[k] += out.side[wheel.side()].force[k];
      out.moment[k] += out.side[wheel.side()].moment[k];
    }
  }
}

void contact::jacobian(rp_jacobian &out) {
  rp_jacobian found{};
  found.status = derivative_->result.status;
  found.z_force = nan;
  derivative_->wheels ? exact_jacobian(found) : jacobian_by_differences(found);
  out = found;
}

void contact::exact_jacobian(rp_jacobian &out) {
  derivative_record &record = *derivative_;
  out.kind = RP_DERIVATIVE_EXACT;
  rp_input inputs[direction_count];
  double friction[direction_count];
  const int count = friction_along_.varies() ? direction_count : direction_count - 1;
  for (int k = 0; k < count; ++k) {
    inputs[k] = unit_direction(record.input, directions[k]);
    friction[k] = friction_rate(inputs[k]);
  }
  // no better than the solution they belong to
  const double tolerance = std::clamp(0.1 * config_.tolerance, exact_tolerance, coarse_tolerance);
  const derivative_options options{tolerance, false};
  double vertical[columns] = {};
  for (const auto &wheel : wheels_) {
    const int side = wheel.side();
    const derivative_outcome outcome =
        wheel.differentiate(solver_, &memory(side, 0), *record.wheels, inputs, friction, count,
                            options, record.result.side[side], record.changes.data());
    degrade(out.status, outcome.converged);
    for (int k = 0; k < count; ++k) {
      const rp_side_result &change = record.changes[static_cast<size_t>(k)];
      for (int i = 0; i < 6; ++i) out.side[side][i][directions[k]] = component(change, i);
      vertical[directions[k]] += change.force[2];
    }
  }
  out.z[z_column] = 1.0;
  if (config_.load == RP_POSITION) return;
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

void contact::jacobian_by_differences(rp_jacobian &out) {
  out.kind = RP_DERIVATIVE_BY_DIFFERENCES;
  const bool forced = config_.load == RP_FORCE;
  for (int column = 0; column < columns; ++column) {
    rp_result change = rates_of_nothing(derivative_->result);
    if (!(forced && column == z_column))
      differentiate_by_differences(unit_direction(derivative_->input, column), change);
    if (change.status == RP_NOT_CONVERGED) out.status = change.status;
    for (const auto &wheel : wheels_)
      for (int i = 0; i < 6; ++i)
        out.side[wheel.side()][i][column] =
            forced && column == z_column ? nan : component(change.side[wheel.side()], i);
    out.z[column] = change.z;
  }
  if (!forced) return;
  rp_input by_force = unit_direction(derivative_->input, z_column);
  by_force.z = 0;
  by_force.vertical_force = 1.0;
  rp_result change = rates_of_nothing(derivative_->result);
  differentiate_by_differences(by_force, change);
  out.z_force = change.z;
}

}  // namespace railpatch
