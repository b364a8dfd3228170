#include "patch/fluid_ehl.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"

namespace railpatch {

namespace {

constexpr double tolerance = 1e-9;
constexpr int most_iterations = 100;
// of the greatest pressure: less is no contact for the tangential problem
constexpr double least_part = 1e-6;

// m, of liquid before the contact: on the surfaces, or spread over the width of the dry contact;
// 0: plenty, as the solver has it
double layer_of(const fluid_supply &supply, double speed, double width) {
  double layer = 0;
  if (supply.layer >= 0) layer = supply.layer;
  if (supply.water_rate >= 0 && speed > 0 && width > 0) {
    const double spread = supply.water_rate / (speed * width);
    layer = layer > 0 ? std::min(layer, spread) : spread;
  }
  return layer;
}

double width_of(const grid &g, const double *pressure) {
  int rows = 0;
  for (int j = 0; j < g.ny; ++j)
    rows +=
        std::any_of(pressure + j * g.nx, pressure + (j + 1) * g.nx, [](double p) { return p > 0; });
  return rows * g.dy;
}

// All liquid is pressed out: the dry pressure stays.
fluid_outcome stand_still(const grid &g, patch_memory &memory, const fluid_outcome &found) {
  for (auto *field : {&memory.fluid_pressure, &memory.fluid_film, &memory.fluid_shear})
    if (field->size()) std::fill_n(field->data(), g.count(), 0.0);
  return found;
}

}  // namespace

fluid_outcome fluid_ehl::solve(const patch_problem &problem, const patch_scene &scene,
                               double temperature, influence &a, patch_memory &memory,
                               pressure_outcome &pressure) {
  const fluid_scene &fluid = *scene.fluid;
  const grid &g = problem.g;
  const double boundary = fluid.own_boundary ? fluid.boundary_friction : scene.friction_coefficient;
  fluid_outcome out;
  out.found = true;
  out.temperature = fluid.liquid.liquid == RP_LIQUID_GIVEN ? nan : temperature;
  out.friction = boundary;
  out.shear_part = 0;
  if (!(problem.rolling_speed > 0)) return stand_still(g, memory, out);
  ehl_problem lubricated;
  lubricated.area = g;
  lubricated.direction = problem.rolling.direction < 0 ? -1 : 1;
  lubricated.speed = problem.rolling_speed;
  lubricated.distance = memory.undeformed_distance.data();
  lubricated.force_given = problem.force_given;
  lubricated.force = problem.force;
  lubricated.approach = problem.approach;
  lubricated.liquid = {
      fluid.liquid.at(temperature).value, fluid.pressure_coefficient,
      fluid.pressure_coefficient > 0 ? ehl_viscosity::roelands : ehl_viscosity::constant, false};
  lubricated.roughness = {fluid.roughness, fluid.hardness};
  lubricated.inlet_film =
      layer_of(scene.supply, lubricated.speed, width_of(g, memory.pressure.data()));
  const ehl_result found =
      solver_.solve(a, lubricated, false, {tolerance, most_iterations, scene.ask});
  out.converged = found.converged;
  out.film_thickness = take_over(problem, lubricated, memory, pressure);
  pressure.normal_force = found.normal_force;
  pressure.approach = found.approach;
  pressure.residual = found.residual;
  pressure.iterations += found.iterations;
  out.asperity_share = 1 - found.fluid_force / found.normal_force;
  out.friction = boundary * out.asperity_share;
  if (fluid.eyring_stress > 0) {
    const double shear = add_shear(problem, scene, lubricated, memory) / found.normal_force;
    out.friction += shear;
    if (shear > 0) out.shear_part = shear / out.friction;
  }
  return out;
}

// Returns the mean film where the pressure is greatest.
double fluid_ehl::take_over(const patch_problem &problem, const ehl_problem &lubricated,
                            patch_memory &memory, pressure_outcome &pressure) {
  const grid &g = problem.g;
  const ehl_system &s = solver_.system();
  double greatest = 0, energy = 0, middle = 0;
  for (size_t k = 0; k < s.count(); ++k) {
    const double p = s.pressure[k] + s.asperity[k];
    greatest = std::max(greatest, p);
    energy += 0.5 * p * s.displacement[k] * g.dx * g.dy;
  }
  int touching = 0;
  for (int i = 0; i < g.nx; ++i)
    for (int j = 0; j < g.ny; ++j) {
      const auto k = static_cast<size_t>(i * g.ny + j);
      const size_t at = s.on_grid(i, j);
      const double p = s.pressure[k] + s.asperity[k];
      const bool bears = p > least_part * greatest;
      touching += bears;
      memory.pressure[at] = bears ? p : 0.0;
      memory.fluid_pressure[at] = bears ? std::max(s.pressure[k], 0.0) : 0.0;
      memory.fluid_film[at] = film_of(lubricated.roughness, s.gap[k]).film.value;
      if (p == greatest) middle = memory.fluid_film[at];
    }
  // area and size stay those of the dry contact: liquid presses far before it
  pressure.max_pressure = greatest;
  pressure.elastic_energy = energy;
  pressure.exterior = g.count() - touching;
  return middle;
}

// Returns its sum, N.
double fluid_ehl::add_shear(const patch_problem &problem, const patch_scene &scene,
                            const ehl_problem &lubricated, patch_memory &memory) const {
  const grid &g = problem.g;
  const rolling_input &rolling = problem.rolling;
  const double stress = scene.fluid->eyring_stress;
  double sum = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      const double p = memory.fluid_pressure[at];
      memory.fluid_shear[at] = 0;
      if (!(p > 0)) continue;
      const double slip =
          lubricated.speed * hypot(rolling.creepage[0] - rolling.spin_creepage * g.y(j),
                                   rolling.creepage[1] + rolling.spin_creepage * g.x(i));
      const double eta = lubricated.liquid.viscosity * viscosity_ratio(lubricated.liquid, p).value;
      const double newton = eta * slip / memory.fluid_film[at];
      memory.fluid_shear[at] =
          std::min(stress * asinh(newton / stress), scene.fluid->limiting_friction * p);
      sum += memory.fluid_shear[at] * g.dx * g.dy;
    }
  return sum;
}

}  // namespace railpatch
