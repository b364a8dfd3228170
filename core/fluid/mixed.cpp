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

// The root of ln(film of the liquid's part) = ln(sigma t(d)) by Newton's method within a bracket;
// the left side falls with d, the right one rises.
shared_load share_load(const elliptic_film &film, const inlet &in, double roughness,
                       double hardness, double pressure) {
  // share of the asperities where all touches; a pressure above the hardness flattens them
  const double most = std::max(hardness / pressure, 1.0 + 1e-12);
  const double low_end = distance_of(1.0 / most);
  const double touching = roughness * mean_film(low_end);
  if (!(in.layer > touching)) return {1.0, in.layer};
  double low = low_end, high = HUGE_VAL, slope;
  double d = std::max(low + 1e-3, in.film(film.at(1.0).thickness, slope) / roughness - 0.4);
  shared_load found{1.0, touching};
  for (int k = 0; k < 100; ++k) {
    const double f = std::min(most * beyond(d), 1.0), q = std::max(1.0 - f, 1e-14);
    const film_point point = film.at(q);
    const double h = in.film(point.thickness, slope), t = mean_film(d);
    found = {f, roughness * t};
    const double value = log(h / (roughness * t));
    if (value > 0)
      low = d;
    else
      high = d;
    const double falls = slope * point.by_part * most * density(d) / q - (1.0 - beyond(d)) / t;
    double next = d - value / falls;
    // a third way into the bracket where Newton's step leaves it
    if (!(next > low && next < high))
      next = std::isfinite(high) ? 0.5 * (low + high) : low + 2.0 * (d - low) + 1.0;
    const double step = std::fabs(next - d);
    d = next;
    if (!(step > 1e-13 * (1.0 + std::fabs(d))) || value == 0) break;
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
