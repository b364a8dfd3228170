#include "patch/report.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "patch/creep_power.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

void describe_heat(const heat_outcome &h, rp_patch_result &result) {
  if (!h.found) return;
  result.max_temperature = h.max_temperature;
  result.wheel_heat = h.heat[0];
  result.rail_heat = h.heat[1];
}

// Fitted rows have elements of many sizes: their places are in the fields.
void describe_grid(const patch_scene &scene, const grid &g, rp_patch_result &result) {
  const bool fitted = scene.is_fitted();
  result.grid[0] = fitted ? scene.fitted[0] : g.nx;
  result.grid[1] = fitted ? scene.fitted[1] : g.ny;
  result.grid_origin[0] = fitted ? 0.0 : g.x0;
  result.grid_origin[1] = fitted ? 0.0 : g.y0;
  result.element_size[0] = fitted ? 0.0 : g.dx;
  result.element_size[1] = fitted ? 0.0 : g.dy;
}

void describe_place(const patch_place &place, rp_patch_result &result) {
  std::copy_n(place.position, 3, result.position);
  result.contact_angle = place.contact_angle;
  std::copy_n(place.on_wheel_profile, 2, result.wheel_profile_position);
  std::copy_n(place.on_rail_profile, 2, result.rail_profile_position);
  result.share = place.share;
  result.rolling_speed = place.rolling_speed;
  result.direction = place.direction;
}

// What a problem states of itself, and its pressure.
void describe(const patch_scene &scene, const patch_problem &problem, const pressure_outcome &n,
              rp_patch_result &result) {
  describe_grid(scene, problem.g, result);
  describe_place(problem.place, result);
  result.approach = problem.place.on_wheel ? problem.place.depth : n.approach;
  result.normal_iterations = n.iterations;
  result.residual = n.residual;
  result.elements[RP_EXTERIOR] = n.exterior;
  result.status = n.status;
  result.reason = n.reason;
  result.reason_value = n.reason_value;
  if (scene.tangential == RP_TANGENTIAL_NONE) return;
  std::copy_n(problem.rolling.creepage, 2, result.creepage);
  result.spin_creepage = problem.rolling.spin_creepage;
}

void describe_tractions(const patch_scene &scene, const patch_problem &problem,
                        const traction_outcome &t, const patch_wrench &wrench,
                        rp_patch_result &result) {
  for (int c = 0; c < 2; ++c)
    if (scene.prescribed[c]) result.creepage[c] = t.creepage[c];
  result.creep_force[0] = wrench.force[0];
  result.creep_force[1] = wrench.force[1];
  result.spin_moment = wrench.moment[2];
  // of steps that go on from the last one's tractions the force is the mean of both ends
  result.creep_power =
      std::isnan(t.supplied) ? creep_power(result, result.rolling_speed) : t.supplied;
  const patch_wrench &own = t.own ? *t.own : wrench;
  result.wear_number = problem.shifts ? nan : wear_number(own.force, own.moment[2], result);
  const double size = hypot(own.force[0], own.force[1]);
  if (result.normal_force > 0) result.traction_coefficient = size / result.normal_force;
  if (t.capacity > 0) result.utilised_friction = size / t.capacity;
  result.max_traction = t.max_traction;
  result.friction_power = t.friction_power;
  result.plastic_power = t.plastic_power;
  result.elastic_energy += t.elastic_energy;
  result.elastic_energy += t.coupling_energy;
  result.elements[RP_EXTERIOR] = t.exterior;
  result.elements[RP_STICK] = t.stick;
  result.elements[RP_SLIP] = t.slip;
  result.elements[RP_PLASTIC] = t.plastic;
  result.ambiguous_elements = t.ambiguous;
  result.newton_iterations = t.newton_iterations;
  result.inner_iterations = t.inner_iterations;
  result.outer_iterations = t.outer_iterations;
  // written so that a residual that is no number stays visible
  if (!(t.residual <= result.residual)) result.residual = t.residual;
  degrade(result, t);
}

}  // namespace

void report(const patch_scene &scene, const patch_problem &problem, const pressure_outcome &n,
            const traction_outcome &t, const heat_outcome &h, const patch_wrench &wrench,
            rp_patch_result &result) {
  describe(scene, problem, n, result);
  // on a curved surface the rows' pressures do not all act along the patch's normal
  result.normal_force = scene.curved ? -wrench.force[2] : n.normal_force;
  result.max_pressure = n.max_pressure;
  result.contact_area = n.contact_area;
  std::copy_n(n.size, 2, result.contact_size);
  result.elastic_energy = result.pressure_energy = n.elastic_energy;
  if (scene.tangential != RP_TANGENTIAL_NONE) describe_tractions(scene, problem, t, wrench, result);
  describe_heat(h, result);
}

void describe_viscous(const patch_problem &problem, const pressure_outcome &n,
                      const traction_outcome &t, const patch_wrench &wrench,
                      rp_patch_result &result) {
  result.viscous_power = n.viscous_power + t.viscous_power;
  // forward of the origin pressure holds the rolling up, whichever way that is
  result.rolling_resistance_moment = problem.rolling.direction * wrench.moment[1];
}

void describe_fluid(const fluid_outcome &f, double power, double scale, rp_patch_result &result) {
  result.central_film_thickness = f.film_thickness;
  result.mean_asperity_share = f.asperity_share;
  result.fluid_temperature = f.temperature;
  result.effective_friction = f.friction * scale;
  result.fluid_power = std::isnan(power) ? f.shear_part * result.friction_power : power;
}

void report_unloaded(const patch_scene &scene, const patch_problem &problem,
                     const pressure_outcome &n, const heat_outcome &h, rp_patch_result &result) {
  describe(scene, problem, n, result);
  set_unloaded(scene, result);
  if (problem.shifts) result.wear_number = nan;
  describe_heat(h, result);
}

void report_apart(const patch_scene &scene, const patch_place &place, double approach,
                  const heat_outcome &h, rp_patch_result &result) {
  describe_place(place, result);
  result.status = RP_NO_CONTACT;
  result.approach = approach;
  set_unloaded(scene, result);
  describe_heat(h, result);
}

void report_beyond(const patch_place &place, const grid &g, rp_patch_result &result) {
  describe_place(place, result);
  result.status = RP_CONVERGED;
  const double count = static_cast<double>(g.nx) * g.ny;
  if (count > 0)
    degrade(result, RP_OUT_OF_RANGE, RP_REASON_GRID_ROOM, count);
  else
    degrade(result, RP_OUT_OF_RANGE, RP_REASON_NO_GRID);
}

void report_rates(const rp_patch_result &value, const patch_change &change, rp_patch_result &rate) {
  const auto set = [](double value_of, double &to, double v) {
    if (!std::isnan(value_of)) to = v;
  };
  set(value.normal_force, rate.normal_force, change.normal_force);
  set(value.max_pressure, rate.max_pressure, change.max_pressure);
  set(value.contact_area, rate.contact_area, change.contact_area);
  set(value.elastic_energy, rate.elastic_energy, change.elastic_energy);
  set(value.pressure_energy, rate.pressure_energy, change.pressure_energy);
  for (int c = 0; c < 2; ++c) set(value.creep_force[c], rate.creep_force[c], change.creep_force[c]);
  set(value.spin_moment, rate.spin_moment, change.spin_moment);
  set(value.friction_power, rate.friction_power, change.friction_power);
  for (int c = 0; c < 2; ++c)
    set(value.contact_size[c], rate.contact_size[c], value.contact_size[c] * change.growth[c]);
  set(value.central_film_thickness, rate.central_film_thickness, change.film.film_thickness);
  set(value.mean_asperity_share, rate.mean_asperity_share, change.film.share);
  set(value.fluid_temperature, rate.fluid_temperature, change.film.temperature);
  set(value.effective_friction, rate.effective_friction, change.film.friction);
  if (value.fluid_power > 0)
    set(value.fluid_power, rate.fluid_power,
        value.fluid_power / value.friction_power * change.friction_power +
            value.friction_power * change.shear_part);
  const double size = hypot(value.creep_force[0], value.creep_force[1]);
  const double traction = value.traction_coefficient, used = value.utilised_friction;
  set(traction, rate.traction_coefficient,
      (change.creep_size - traction * change.normal_force) / value.normal_force);
  // what friction could carry is the force over the part of it that is used
  set(used, rate.utilised_friction,
      used > 0 ? used * (change.creep_size - used * change.capacity) / size : 0.0);
}

void report_errors(const error_bounds &bounds, rp_patch_result &result) {
  result.error_estimate[0] = bounds.creep_force;
  result.error_estimate[1] = bounds.spin_moment;
  result.error_estimate[2] = bounds.max_pressure;
}

void report_search(const verdict &found, double residual, rp_patch_result &result) {
  degrade(result, found);
  result.residual = std::max(result.residual, residual);
}

}  // namespace railpatch
