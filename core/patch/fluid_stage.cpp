#include "patch/fluid_stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

constexpr double usual_temperature = 20;  // degrees C, where nothing says it

// The ellipse with the pressure's variances, a^2/5 and b^2/5 of Hertz's; elements have their own.
void ellipse_of(const grid &g, const double *pressure, double axes[2]) {
  double sum = 0, x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i), y = g.y(j);
      sum += p;
      x1 += p * x;
      x2 += p * x * x;
      y1 += p * y;
      y2 += p * y * y;
    }
  const auto axis = [&](double first, double second, double size) {
    const double centre = first / sum;
    return std::sqrt(5.0 * (std::max(second / sum - centre * centre, 0.0) + size * size / 12.0));
  };
  axes[0] = axis(x1, x2, g.dx);
  axes[1] = axis(y1, y2, g.dy);
}

// Of the whole rigid slip over the speed: exact without spin, and for pure spin of a circle, whose
// mean of |r| by Hertz's pressure is 3 pi/16 a; in between assumed.
double mean_creepage(const rolling_input &rolling, const double axes[2]) {
  const double turn = 3.0 * pi / 16.0 * rolling.spin_creepage * std::sqrt(axes[0] * axes[1]);
  return hypot(hypot(rolling.creepage[0], rolling.creepage[1]), turn);
}

}  // namespace

fluid_stage::fluid_stage(patch_workspace &shared, int max_nx, int max_ny) : shared_(shared) {
  if (shared.scene.has_ehl()) ehl_.emplace(max_nx, max_ny);
  if (shared.scene.has_strips()) strips_.emplace(shared.scene.normal == RP_NORMAL_HERTZ);
}

fluid_outcome fluid_stage::solve(const patch_problem &problem, pressure_outcome &pressure,
                                 patch_memory &memory) {
  patch_scene &scene = shared_.scene;
  if (!scene.fluid) return {};
  const stage_mark mark = shared_.marks.enter(RP_STAGE_FLUID);
  // the tangential problem has them
  if (scene.fluid->model == RP_FLUID_REGIMES) return {true, nan, nan, nan, nan};
  hertz_contact hertz = problem.hertz;
  hertz.normal_force = pressure.normal_force;
  const bool strips = scene.fluid->model == RP_FLUID_STRIP;
  if (!strips && !ehl_ && !(hertz.semi_axes[0] > 0)) {
    double axes[2];
    ellipse_of(problem.g, memory.pressure.data(), axes);
    hertz = hertz_from_ellipse(axes, scene.modulus(), pressure.normal_force);
  }
  double temperature = scene.supply.temperature;
  if (std::isnan(temperature))
    temperature = scene.heat ? scene.heat->bodies.mean_bulk() : usual_temperature;
  if (ehl_) return solve_ehl(temperature, problem, memory, pressure);
  return strips ? solve_strips(hertz, temperature, problem, memory)
                : solve_film(hertz, temperature, problem);
}

fluid_outcome fluid_stage::solve_film(const hertz_contact &hertz, double temperature,
                                      const patch_problem &problem) {
  patch_scene &scene = shared_.scene;
  wet_contact contact{};
  for (int k = 0; k < 2; ++k) contact.film.radius[k] = 0.5 / hertz.curvatures[k];
  contact.film.modulus = 2.0 * scene.modulus();
  contact.film.force = hertz.normal_force;
  contact.film.speed = problem.rolling_speed;
  contact.half_width = hertz.semi_axes[1];
  contact.mean_pressure = hertz.normal_force / (pi * hertz.semi_axes[0] * hertz.semi_axes[1]);
  contact.slip_speed = problem.rolling_speed * mean_creepage(problem.rolling, hertz.semi_axes);
  contact.dry_friction = scene.friction_coefficient;
  fluid_supply supply = scene.supply;
  supply.temperature = temperature;
  const film_outcome film = railpatch::solve_film(*scene.fluid, supply, contact);
  scene.wet_friction = film.friction;
  return {true, film.film_thickness, film.share, film.temperature, film.friction};
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
  fluid_outcome out{true, found.film, found.share, known ? temperature : nan,
                    boundary * found.share};
  out.converged = found.converged;
  return out;
}

fluid_outcome fluid_stage::solve_ehl(double temperature, const patch_problem &problem,
                                     patch_memory &memory, pressure_outcome &pressure) {
  patch_scene &scene = shared_.scene;
  if (follows_heat() && !std::isnan(now_)) temperature = now_;
  const fluid_outcome found =
      ehl_->solve(problem, scene, temperature, *shared_.influence, memory, pressure);
  const double boundary =
      scene.fluid->own_boundary ? scene.fluid->boundary_friction : scene.friction_coefficient;
  scene.wet_friction = scene.full_on_grid() ? boundary : found.friction;
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
