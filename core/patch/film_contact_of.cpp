#include "patch/film_contact_of.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/ehl.hpp"
#include "numeric/elementary.hpp"
#include "patch/patch_derivative.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

constexpr double full_inlet = 20;         // gap over film
constexpr double usual_temperature = 20;  // degrees C, where nothing says it

// Moments of a pressure about the origin along x and y.
struct pressure_moments {
  double sum = 0, first[2] = {0, 0}, second[2] = {0, 0};
};

pressure_moments moments_of(const grid &g, const double *pressure) {
  pressure_moments m;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i), y = g.y(j);
      m.sum += p;
      m.first[0] += p * x;
      m.second[0] += p * x * x;
      m.first[1] += p * y;
      m.second[1] += p * y * y;
    }
  return m;
}

// a^2/5 and b^2/5 are the variances of Hertz's pressure; elements have their own.
void axes_of(const grid &g, const pressure_moments &m, double axes[2]) {
  const double size[2] = {g.dx, g.dy};
  for (int k = 0; k < 2; ++k) {
    const double centre = m.first[k] / m.sum;
    axes[k] = std::sqrt(
        5.0 * (std::max(m.second[k] / m.sum - centre * centre, 0.0) + size[k] * size[k] / 12.0));
  }
}

// The rates of the ellipse by the pressure's and by those of the places.
void rates_of_axes(const grid &g, const double *pressure, const double *rate,
                   const patch_variation &v, const double axes[2], double out[2]) {
  const pressure_moments m = moments_of(g, pressure);
  pressure_moments d = moments_of(g, rate);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i];
      const double dx = v.origin[0] + i * v.size[0], dy = v.origin[1] + j * v.size[1];
      d.first[0] += p * dx;
      d.second[0] += 2.0 * p * g.x(i) * dx;
      d.first[1] += p * dy;
      d.second[1] += 2.0 * p * g.y(j) * dy;
    }
  const double size[2] = {g.dx, g.dy};
  for (int k = 0; k < 2; ++k) {
    const double centre = m.first[k] / m.sum, mean = m.second[k] / m.sum;
    const double variance_rate =
        (d.second[k] - mean * d.sum) / m.sum - 2.0 * centre * (d.first[k] - centre * d.sum) / m.sum;
    const double counts = mean > centre * centre ? variance_rate : 0.0;
    out[k] = 2.5 * (counts + size[k] * v.size[k] / 6.0) / axes[k];
  }
}

// Of the contact that a given ellipse under a force would need: the linear map from curvatures to
// semi-axes is solved for the curvatures.
hertz_contact rate_of_given_ellipse(const hertz_contact &c, const double axes[2], double force) {
  const double none[2] = {0, 0}, first[2] = {c.curvatures[0], 0}, second[2] = {0, c.curvatures[1]};
  const hertz_contact of_force = hertz_rate_of_force(c, none, force);
  const hertz_contact by[2] = {hertz_rate_of_force(c, first, 0), hertz_rate_of_force(c, second, 0)};
  const double want[2] = {axes[0] - of_force.semi_axes[0], axes[1] - of_force.semi_axes[1]};
  const double whole =
      by[0].semi_axes[0] * by[1].semi_axes[1] - by[1].semi_axes[0] * by[0].semi_axes[1];
  const double u = (want[0] * by[1].semi_axes[1] - by[1].semi_axes[0] * want[1]) / whole;
  const double w = (by[0].semi_axes[0] * want[1] - want[0] * by[0].semi_axes[1]) / whole;
  const double curvatures[2] = {u * c.curvatures[0], w * c.curvatures[1]};
  return hertz_rate_of_force(c, curvatures, force);
}

bool is_quadratic(const patch_problem &problem) { return problem.hertz.semi_axes[0] > 0; }

// Of the whole rigid slip over the speed: exact without spin, and for pure spin of a circle, whose
// mean of |r| by Hertz's pressure is 3 pi/16 a; in between assumed.
double turning_radius(const double axes[2]) {
  return 3.0 * pi / 16.0 * std::sqrt(axes[0] * axes[1]);
}

double mean_creepage(const rolling_input &rolling, const double axes[2]) {
  const double turn = rolling.spin_creepage * turning_radius(axes);
  return hypot(hypot(rolling.creepage[0], rolling.creepage[1]), turn);
}

double rate_of_creepage(const rolling_input &rolling, const double axes[2],
                        const patch_variation &v, const double axes_rate[2]) {
  const double size = mean_creepage(rolling, axes), radius = turning_radius(axes);
  if (!(size > 0)) return hypot(v.creepage[0], v.creepage[1]);
  const double radius_rate = 0.5 * radius * (axes_rate[0] / axes[0] + axes_rate[1] / axes[1]);
  const double turn = rolling.spin_creepage * radius;
  const double turn_rate = v.spin_creepage * radius + rolling.spin_creepage * radius_rate;
  return (rolling.creepage[0] * v.creepage[0] + rolling.creepage[1] * v.creepage[1] +
          turn * turn_rate) /
         size;
}

}  // namespace

hertz_contact wet_ellipse(const patch_scene &scene, const patch_problem &problem,
                          const double *pressure, double force) {
  hertz_contact hertz = problem.hertz;
  hertz.normal_force = force;
  if (is_quadratic(problem)) return hertz;
  double axes[2];
  axes_of(problem.g, moments_of(problem.g, pressure), axes);
  return hertz_from_ellipse(axes, scene.modulus(), force);
}

double inlet_reach(const patch_scene &scene, const hertz_contact &hertz, double speed) {
  const double a = hertz.semi_axes[0];
  if (!(speed > 0) || !(hertz.normal_force > 0) || !(a > 0)) return 1;
  const fluid_scene &fluid = *scene.fluid;
  const double viscosity = fluid.liquid.at(supplied_temperature(scene)).value;
  const double along = 0.5 / hertz.curvatures[0], modulus = 2.0 * scene.modulus();
  double film;
  if (hertz.curvatures[1] > 0) {
    const film_contact contact{
        {along, 0.5 / hertz.curvatures[1]}, modulus, hertz.normal_force, speed, viscosity,
        fluid.pressure_coefficient};
    film = elliptic_film(contact).at().thickness();
  } else {
    const ehl_liquid liquid{viscosity, fluid.pressure_coefficient, ehl_viscosity::roelands, false};
    film = line_film(liquid, scene.modulus(), a, hertz.max_pressure, speed);
  }
  const double width = hertz.semi_axes[1] > 0 ? 2.0 * hertz.semi_axes[1] : scene.line_width;
  if (scene.supply.layer >= 0) film = std::min(film, scene.supply.layer);
  if (scene.supply.water_rate >= 0)
    film = std::min(film, scene.supply.water_rate / (speed * width));
  // of a cylinder, over a^2/R: (m sqrt(m^2 - 1) - acosh m)/2, which rises from m = 1 on
  const double gap = full_inlet * film * along / (a * a);
  double low = 1, high = 2.0 + std::sqrt(2.0 * gap);
  for (int k = 0; k < 40; ++k) {
    const double m = 0.5 * (low + high), root = std::sqrt(m * m - 1.0);
    (0.5 * (m * root - log(m + root)) < gap ? low : high) = m;
  }
  return high;
}

double supplied_temperature(const patch_scene &scene) {
  if (!std::isnan(scene.supply.temperature)) return scene.supply.temperature;
  return scene.heat ? scene.heat->bodies.mean_bulk() : usual_temperature;
}

wet_contact film_contact_of(const patch_scene &scene, const patch_problem &problem,
                            const hertz_contact &hertz) {
  wet_contact contact{};
  for (int k = 0; k < 2; ++k) contact.film.radius[k] = 0.5 / hertz.curvatures[k];
  contact.film.modulus = 2.0 * scene.modulus();
  contact.film.force = hertz.normal_force;
  contact.film.speed = problem.rolling_speed;
  contact.half_width = hertz.semi_axes[1];
  contact.mean_pressure = hertz.normal_force / (pi * hertz.semi_axes[0] * hertz.semi_axes[1]);
  contact.slip_speed = problem.rolling_speed * mean_creepage(problem.rolling, hertz.semi_axes);
  contact.dry_friction = scene.friction_coefficient;
  return contact;
}

film_outcome film_rates_of(const patch_scene &scene, const patch_problem &problem,
                           const patch_memory &memory, const patch_variation &v,
                           const double *pressure, double force) {
  const hertz_contact &hertz = memory.wet.ellipse;
  hertz_contact d = v.hertz;
  d.normal_force = force;
  if (!is_quadratic(problem)) {
    double axes[2];
    rates_of_axes(problem.g, memory.pressure.data(), pressure, v, hertz.semi_axes, axes);
    d = rate_of_given_ellipse(hertz, axes, force);
  }
  const wet_contact contact = film_contact_of(scene, problem, hertz);
  wet_contact rate{};
  for (int k = 0; k < 2; ++k)
    rate.film.radius[k] = -contact.film.radius[k] * d.curvatures[k] / hertz.curvatures[k];
  rate.film.force = force;
  rate.film.speed = v.rolling_speed;
  rate.half_width = d.semi_axes[1];
  const double growth = d.semi_axes[0] / hertz.semi_axes[0] + d.semi_axes[1] / hertz.semi_axes[1];
  rate.mean_pressure = contact.mean_pressure * (force / hertz.normal_force - growth);
  rate.slip_speed =
      v.rolling_speed * mean_creepage(problem.rolling, hertz.semi_axes) +
      problem.rolling_speed * rate_of_creepage(problem.rolling, hertz.semi_axes, v, d.semi_axes);
  rate.dry_friction = v.friction.coefficient;
  fluid_supply supply = scene.supply;
  supply.temperature = supplied_temperature(scene);
  const auto known = [](double given, double of) {
    return std::isnan(given) || std::isnan(of) ? 0.0 : of;
  };
  const fluid_supply supply_rate{known(supply.water_rate, v.friction.water_rate),
                                 known(scene.supply.temperature, v.friction.water_temperature),
                                 known(supply.layer, v.friction.oil_film), 0};
  return film_rates(*scene.fluid, supply, contact, rate, supply_rate);
}

}  // namespace railpatch
