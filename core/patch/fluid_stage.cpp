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

fluid_outcome fluid_stage::solve(const patch_problem &problem, const pressure_outcome &pressure,
                                 const patch_memory &memory) {
  patch_scene &scene = shared_.scene;
  if (!scene.fluid) return {};
  const stage_mark mark = shared_.marks.enter(RP_STAGE_FLUID);
  wet_contact contact{};
  hertz_contact hertz = problem.hertz;
  if (!(hertz.semi_axes[0] > 0)) {
    double axes[2];
    ellipse_of(problem.g, memory.pressure.data(), axes);
    hertz = hertz_from_ellipse(axes, scene.modulus(), pressure.normal_force);
  }
  for (int k = 0; k < 2; ++k) contact.film.radius[k] = 0.5 / hertz.curvatures[k];
  contact.film.modulus = 2.0 * scene.modulus();
  contact.film.force = pressure.normal_force;
  contact.film.speed = problem.rolling_speed;
  contact.half_width = hertz.semi_axes[1];
  contact.mean_pressure = pressure.normal_force / (pi * hertz.semi_axes[0] * hertz.semi_axes[1]);
  contact.slip_speed = problem.rolling_speed * mean_creepage(problem.rolling, hertz.semi_axes);
  contact.dry_friction = scene.friction_coefficient;
  fluid_supply supply = scene.supply;
  if (std::isnan(supply.temperature))
    supply.temperature = scene.heat ? scene.heat->bodies.mean_bulk() : usual_temperature;
  const film_outcome film = solve_film(*scene.fluid, supply, contact);
  scene.wet_friction = film.friction;
  return {true, film.film_thickness, film.share, film.temperature, film.friction};
}

}  // namespace railpatch
