#include "patch/fluid_stage.hpp"

#include <algorithm>
#include <cmath>

#include "patch/film_contact_of.hpp"

namespace railpatch {

fluid_stage::fluid_stage(patch_workspace &shared, int max_nx, int max_ny) : shared_(shared) {
  if (shared.scene.has_ehl()) ehl_.emplace(max_nx, max_ny);
  if (shared.scene.has_strips())
    strips_.emplace(shared.scene.normal == RP_NORMAL_HERTZ, max_nx, max_ny);
}

fluid_outcome fluid_stage::solve(const patch_problem &problem, pressure_outcome &pressure,
                                 patch_memory &memory) {
  patch_scene &scene = shared_.scene;
  if (!scene.fluid) return {};
  const stage_mark mark = shared_.marks.enter(RP_STAGE_FLUID);
  // the tangential problem has them
  if (scene.fluid->model == RP_FLUID_REGIMES) return {true, nan, nan, nan, nan};
  const double temperature = supplied_temperature(scene);
  if (ehl_) return solve_ehl(temperature, problem, memory, pressure);
  if (scene.fluid->model == RP_FLUID_STRIP) {
    hertz_contact hertz = problem.hertz;
    hertz.normal_force = pressure.normal_force;
    return solve_strips(hertz, temperature, problem, memory);
  }
  return solve_film(temperature, problem, pressure.normal_force, memory);
}

fluid_outcome fluid_stage::solve_film(double temperature, const patch_problem &problem,
                                      double force, patch_memory &memory) {
  patch_scene &scene = shared_.scene;
  const hertz_contact ellipse = wet_ellipse(scene, problem, memory.pressure.data(), force);
  const wet_contact contact = film_contact_of(scene, problem, ellipse);
  fluid_supply supply = scene.supply;
  supply.temperature = temperature;
  const film_outcome film = railpatch::solve_film(*scene.fluid, supply, contact);
  scene.wet_friction = film.friction;
  memory.wet = {ellipse, film.friction, film.shear};
  const double part = film.shear > 0 ? film.shear / film.friction : 0.0;
  return {true, film.film_thickness, film.share, film.temperature, film.friction, part};
}

// Where the tractions are found element by element the bound is that of the asperities' pressure;
// other theories have the mean.
fluid_outcome fluid_stage::solve_strips(const hertz_contact &hertz, double temperature,
                                        const patch_problem &problem, patch_memory &memory) {
  patch_scene &scene = shared_.scene;
  const fluid_scene &fluid = *scene.fluid;
  if (follows_heat() && !std::isnan(now_)) temperature = now_;
  const strip_liquid liquid{fluid.liquid.at(temperature).value, problem.rolling_speed,
                            fluid.roughness, fluid.hardness};
  const strip_outcome found =
      strips_ ? strips_->solve(problem.g, memory.pressure.data(), hertz, problem.rolling.direction,
                               liquid, memory.fluid_pressure.data())
              : fluid_strips::of_ellipse(hertz, liquid);
  const double boundary = fluid.own_boundary ? fluid.boundary_friction : scene.friction_coefficient;
  scene.wet_friction = scene.full_on_grid() ? boundary : boundary * found.share;
  const bool known = fluid.liquid.liquid != RP_LIQUID_GIVEN;
  fluid_outcome out{
      true, found.film, found.share, known ? temperature : nan, boundary * found.share, 0};
  out.converged = found.converged;
  return out;
}

fluid_outcome fluid_stage::solve_ehl(double temperature, const patch_problem &problem,
                                     patch_memory &memory, pressure_outcome &pressure) {
  patch_scene &scene = shared_.scene;
  if (follows_heat() && !std::isnan(now_)) temperature = now_;
  const fluid_outcome found =
      ehl_->solve(problem, scene, temperature, *shared_.influence, memory, pressure);
  scene.wet_friction = scene.full_on_grid() ? ehl_->boundary() : found.friction;
  return found;
}

bool fluid_stage::follows_heat() const {
  const patch_scene &scene = shared_.scene;
  return scene.fluid && scene.heat && (scene.fluid->model == RP_FLUID_STRIP || scene.has_ehl()) &&
         scene.fluid->liquid.liquid != RP_LIQUID_GIVEN && !scene.heat->transient &&
         std::isnan(scene.supply.temperature);
}

// The mean of both surfaces, by the pressure. Secants after the first round.
double fluid_stage::follow(const grid &g, const patch_memory &memory) {
  double sum = 0, weighted = 0;
  for (size_t at = 0; at < static_cast<size_t>(g.count()); ++at) {
    const double p = memory.pressure[at];
    if (!(p > 0)) continue;
    sum += p;
    weighted += p * 0.5 * (memory.heat->temperature[0][at] + memory.heat->temperature[1][at]);
  }
  const double used = std::isnan(now_) ? shared_.scene.heat->bodies.mean_bulk() : now_;
  const double found = weighted / sum, change = found - used;
  double next = found;
  if (!std::isnan(before_) && change != change_before_) {
    const double secant = used - change * (used - before_) / (change - change_before_);
    // not farther than the surfaces are hot
    next = std::clamp(secant, std::min(used, found) - 50.0, std::max(used, found) + 50.0);
  }
  before_ = used;
  change_before_ = change;
  now_ = std::clamp(next, -50.0, 350.0);
  return std::fabs(change);
}

void fluid_stage::begin() { now_ = before_ = change_before_ = nan; }

}  // namespace railpatch
