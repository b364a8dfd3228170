#include "fluid/mixed.hpp"

#include <algorithm>
#include <cmath>

#include "fluid/asperities.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// The film that the inlet leaves of the flooded one: thinner by a factor, and with a given layer
// not thicker than that.
struct inlet {
  double factor = 1;
  double layer = HUGE_VAL;  // m
  // slope: d ln of it/d ln h
  double film(double flooded, double &slope) const {
    const double h = factor * flooded;
    slope = 1;
    if (!std::isfinite(layer)) return h;
    const double r = layer / h, square = 1.0 + r * r;
    slope = r * r / square;
    return h * r / std::sqrt(square);
  }
};

struct shared_load {
  double share, film;
};

// The root of ln(film of the liquid's part) = ln(sigma t(d)) by Newton's method within a bracket,
// in u = ln(d - d_0), d_0 where asperities bear all: with it the liquid's part of the load falls to
// 0 as e^u, and both sides are nearly straight lines over u, near d_0 and far from it. The left
// side falls with u, the right one rises.
shared_load share_load(const elliptic_film &film, const inlet &in, double roughness,
                       double hardness, double pressure) {
  // share of the asperities where all touches; a pressure above the hardness flattens them
  const double most = std::max(hardness / pressure, 1.0 + 1e-12);
  const double least = distance_of(1.0 / most);
  const double touching = roughness * mean_film(least);
  if (!(in.layer > touching)) return {1.0, in.layer};
  double slope;
  const film_point flooded = film.at(1.0);
  const double all = in.film(flooded.thickness, slope);
  // how far the mean planes part if the liquid bears all, and if asperities bear nearly all
  const double lifted = std::max((all - touching) / roughness, 0.0);
  const double apart = lifted / (1.0 - exp(-lifted) / most);
  const double power = std::min(slope * flooded.by_part, -1e-3);
  const double part = exp(std::clamp(log(touching / all) / power, -20.0, 0.0));
  const double close = std::min(part / (most * density(least)), 1.0 - std::min(least, 0.0));
  double u = log(std::max(apart, close));
  double low = -HUGE_VAL, high = HUGE_VAL, width = HUGE_VAL;
  shared_load found{1.0, touching};
  for (int k = 0; k < 100; ++k) {
    const double way = exp(u), d = least + way, tail = beyond(d), bell = density(d);
    const double q = std::clamp(1.0 - most * tail, 1e-14, 1.0);
    const film_point point = film.at(q);
    const double h = in.film(point.thickness, slope);
    const double t = d < -4.0 ? mean_film(d) : d * (1.0 - tail) + bell;
    const double value = log(h / (roughness * t));
    (value > 0 ? low : high) = u;
    const double falls = way * (slope * point.by_part * most * bell / q - (1.0 - tail) / t);
    const double newton = -value / falls;
    // the error of what is found is the square of the last step
    if (std::fabs(newton) < 1e-6) {
      found.share = std::clamp(most * (tail - bell * way * newton), 0.0, 1.0);
      found.film = roughness * (t + (1.0 - tail) * way * newton);
      break;
    }
    found = {std::min(most * tail, 1.0), roughness * t};
    if (u < -40.0 || high - low < 1e-15 * std::fabs(u)) break;
    const double next = u + newton, bracket = high - low;
    const bool slow = k % 4 == 3 && !(bracket < 0.5 * width);
    if (k % 4 == 3) width = bracket;
    if (next > low && next < high && !(slow && std::isfinite(bracket)))
      u = next;
    else  // half of the bracket, or a step on
      u = low == -HUGE_VAL ? u - 2.0 : high == HUGE_VAL ? u + 2.0 : 0.5 * (low + high);
  }
  return found;
}

double shear_friction(const fluid_scene &scene, const wet_contact &c, double film) {
  if (!(scene.eyring_stress > 0) || !(c.slip_speed > 0) || !(film > 0)) return 0;
  const double exponent = std::min(c.film.pressure_coefficient * c.mean_pressure, 300.0);
  const double rate = c.film.viscosity * exp(exponent) * (c.slip_speed / film);
  const double stress = scene.eyring_stress * asinh(rate / scene.eyring_stress);
  return std::min(stress / c.mean_pressure, scene.limiting_friction);
}

}  // namespace

film_outcome solve_film(const fluid_scene &scene, const fluid_supply &supply, wet_contact c) {
  const viscosity liquid = scene.liquid.at(supply.temperature);
  c.film.viscosity = liquid.value;
  c.film.pressure_coefficient = scene.pressure_coefficient;
  inlet in;
  in.factor = scene.starvation;
  const double v = c.film.speed;
  if (scene.inlet_conductivity > 0) {
    const double heating = liquid.value * liquid.fall * v * v / scene.inlet_conductivity;
    if (heating > 0) in.factor /= 1.0 + 0.1 * pow(heating, 0.64);
  }
  if (supply.layer >= 0) in.layer = supply.layer;
  if (supply.water_rate >= 0 && v > 0)
    in.layer = std::min(in.layer, supply.water_rate / (v * 2.0 * c.half_width));
  film_outcome found;
  found.temperature = scene.liquid.liquid == RP_LIQUID_GIVEN ? nan : supply.temperature;
  const double boundary = scene.own_boundary ? scene.boundary_friction : c.dry_friction;
  double asperity = boundary;
  if (std::isfinite(in.layer))
    asperity += (c.dry_friction - boundary) * exp(-in.layer / scene.roughness);
  found.friction = asperity;
  if (!(v > 0) || !(c.film.force > 0) || !(in.layer > 0)) return found;
  const elliptic_film film(c.film);
  if (scene.share == RP_SHARE_LOAD_SHARING) {
    const double pressure = scene.mean_pressure > 0 ? scene.mean_pressure : c.mean_pressure;
    const shared_load both = share_load(film, in, scene.roughness, scene.hardness, pressure);
    found.share = both.share;
    found.film_thickness = both.film;
  } else {
    double slope;
    found.film_thickness = in.film(film.at().thickness, slope);
    found.share = exp(-1.8 * pow(found.film_thickness / scene.roughness, 1.2));
  }
  const double shear = shear_friction(scene, c, found.film_thickness);
  found.friction = asperity * found.share + shear * (1.0 - found.share);
  return found;
}

}  // namespace railpatch
