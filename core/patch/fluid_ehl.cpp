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
constexpr double least_layer = 1e-30;  // m
// layers of less than so much of the roughness bear nothing, at whatever speed: then one is taken
// at which the equations are well scaled
constexpr double least_wetting = 1e-6, dry_speed = 100, dry_viscosity = 1e-3;  // -, m/s, Pa s

// m, of liquid before the contact: on the surfaces, or spread over the width of the dry contact;
// infinite: plenty
double layer_of(const fluid_supply &supply, double speed, double width) {
  double layer = HUGE_VAL;
  if (supply.layer >= 0) layer = supply.layer;
  if (supply.water_rate >= 0 && speed > 0 && width > 0)
    layer = std::min(layer, supply.water_rate / (speed * width));
  return layer;
}

double width_of(const grid &g, const double *pressure) {
  int rows = 0;
  for (int j = 0; j < g.ny; ++j)
    rows +=
        std::any_of(pressure + j * g.nx, pressure + (j + 1) * g.nx, [](double p) { return p > 0; });
  return rows * g.dy;
}

// Shear stress of the film in an element (Pa), whose own work warms it: heated evenly between
// surfaces as warm as the liquid, the temperature across it is a parabola, its mean above them
// tau v h/(12 k). As viscosity falls with it, so does tau: one root, within a bracket.
struct film_shear {
  const fluid_scene &fluid;
  const ehl_liquid &liquid;
  double temperature;           // degrees C
  double pressure, film, slip;  // Pa, m, m/s
  double at(double rise) const {
    ehl_liquid warm = liquid;
    if (rise > 0) {
      warm.viscosity = fluid.liquid.at(temperature + rise).value;
      // the exponent z of Roelands' law stays
      const double left = (log(warm.viscosity) + 9.67) / (log(liquid.viscosity) + 9.67);
      warm.pressure_coefficient *= std::max(left, 0.0);
    }
    const double eta = warm.viscosity * viscosity_ratio(warm, pressure).value;
    const double newton = eta * slip / film;
    return std::min(fluid.eyring_stress * asinh(newton / fluid.eyring_stress),
                    fluid.limiting_friction * pressure);
  }
  double solve() const {
    const double cold = at(0);
    if (!(fluid.inlet_conductivity > 0)) return cold;
    const double per_stress = slip * film / (12.0 * fluid.inlet_conductivity);  // K/Pa
    double low = 0, high = per_stress * cold, below = -high;  // K; of rise - per_stress tau
    double above = high - per_stress * at(high);
    if (!(above > 0)) return cold;  // at its limit, however warm
    int last = 0;
    for (int k = 0; k < 100 && high - low > 1e-13 * high; ++k) {
      const double rise = low + (high - low) * below / (below - above);
      const double value = rise - per_stress * at(rise);
      if (!(value != 0)) return at(rise);
      // Illinois: an end that stays counts half
      if (value < 0) {
        low = rise, below = value;
        if (last < 0) above *= 0.5;
      } else {
        high = rise, above = value;
        if (last > 0) below *= 0.5;
      }
      last = value < 0 ? -1 : 1;
      if (std::fabs(value) < 1e-13 * high) break;
    }
    return at(last < 0 ? low : high);
  }
};

// All liquid is pressed out: the dry pressure stays.
fluid_outcome stand_still(const grid &g, patch_memory &memory, const fluid_outcome &found) {
  memory.film_entry = HUGE_VAL;
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
  const double dry = scene.friction_coefficient;
  const double layer =
      layer_of(scene.supply, problem.rolling_speed, width_of(g, memory.pressure.data()));
  boundary_ = asperity_friction(fluid.own_boundary ? fluid.boundary_friction : dry, dry, layer,
                                fluid.roughness);
  fluid_outcome out;
  out.found = true;
  out.temperature = fluid.liquid.liquid == RP_LIQUID_GIVEN ? nan : temperature;
  out.friction = boundary_;
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
  if (layer < least_wetting * fluid.roughness) {
    lubricated.speed = dry_speed;
    lubricated.liquid = {dry_viscosity, 0, ehl_viscosity::constant, false};
  }
  // none at all is not plenty, which 0 is for the solver
  if (std::isfinite(layer)) lubricated.inlet_film = std::max(layer, least_layer);
  const ehl_result found =
      solver_.solve(a, lubricated, false, {tolerance, most_iterations, scene.ask});
  out.converged = found.converged;
  out.film_thickness = take_over(problem, lubricated, memory, pressure);
  memory.film_entry = entry() / out.film_thickness;
  pressure.normal_force = found.normal_force;
  pressure.approach = found.approach;
  pressure.residual = found.residual;
  pressure.iterations += found.iterations;
  // pressures of which the search was given up may bear more than the load
  out.asperity_share = std::clamp(1 - found.fluid_force / found.normal_force, 0.0, 1.0);
  out.friction = boundary_ * out.asperity_share;
  if (fluid.eyring_stress > 0) {
    const double shear =
        add_shear(problem, scene, lubricated, temperature, memory) / found.normal_force;
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

// m, the mean film where the liquid enters the grid, in the row of the greatest pressure; infinite
// where it enters torn, since its inlet then lies on the grid.
double fluid_ehl::entry() const {
  const ehl_system &s = solver_.system();
  const auto load = [&](size_t k) { return s.pressure[k] + s.asperity[k]; };
  size_t top = 0;
  for (size_t k = 0; k < s.count(); ++k)
    if (load(k) > load(top)) top = k;
  const size_t first = top % static_cast<size_t>(s.rows());
  return s.empty[first] > least_part ? HUGE_VAL : s.gap[first];
}

// Returns its sum, N.
double fluid_ehl::add_shear(const patch_problem &problem, const patch_scene &scene,
                            const ehl_problem &lubricated, double temperature,
                            patch_memory &memory) const {
  const grid &g = problem.g;
  const rolling_input &rolling = problem.rolling;
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
      const film_shear shear{*scene.fluid, lubricated.liquid, temperature, p, memory.fluid_film[at],
                             slip};
      memory.fluid_shear[at] = shear.solve();
      sum += memory.fluid_shear[at] * g.dx * g.dy;
    }
  return sum;
}

}  // namespace railpatch
