#include "fluid/mixed.hpp"

#include <algorithm>
#include <cmath>

#include "fluid/asperities.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

double drying_paste::thicker(double water) const {
  if (water == 1) return 1;
  const double solids = content / (content + (1.0 - content) * water);
  return exp(exponent * (std::min(solids, packed) - content));
}

double drying_paste::covers(double water) const {
  if (water == 1) return 1;
  const double then = content * (1.0 - packed) / ((1.0 - content) * packed);
  return std::min(water / then, 1.0);
}

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
  // ln(film/over)
  double log_film(const film_point &flooded, double over, double &slope) const {
    if (std::isfinite(layer)) return log(film(flooded.thickness(), slope) / over);
    slope = 1;
    return flooded.over_unit + log(factor * flooded.unit / over);
  }
};

struct shared_load {
  double share, film;
  double distance = nan;  // of the mean planes, over sigma; none where all touches
};

// Share of the asperities where all touches; a pressure above the hardness flattens them.
double touching_share(double hardness, double pressure) {
  return std::max(hardness / pressure, 1.0 + 1e-12);
}

// The sides of what share_load solves, at the distance d.
struct load_balance {
  double d, tail, bell, t;  // 1 - Phi, phi, mean film over sigma
  double value;             // ln(film of the liquid's part) - ln(sigma t)
  double falls;             // -d value/du > 0, u = ln(d - d_0)
};

load_balance balance_at(const elliptic_film &film, const inlet &in, double roughness, double most,
                        double least, double way) {
  load_balance at{};
  at.d = least + way;
  at.tail = beyond(at.d);
  at.bell = density(at.d);
  at.t = at.d < -4.0 ? mean_film(at.d) : at.d * (1.0 - at.tail) + at.bell;
  const double q = std::clamp(1.0 - most * at.tail, 1e-14, 1.0);
  const film_point point = film.at(q);
  double slope;
  at.value = in.log_film(point, roughness * at.t, slope);
  at.falls = way * ((1.0 - at.tail) / at.t - slope * point.by_part * most * at.bell / q);
  return at;
}

// Root by the cubic of u over the value through two points with their slopes: from the second one
// on. Its error is as the product of the squares of both distances.
double cubic_step(const load_balance &a, double way_from_a, const load_balance &b) {
  const double y = b.value / (b.value - a.value);  // 0 at b, 1 at a
  const double rise = way_from_a, to_a = -(a.value - b.value) / a.falls,
               to_b = -(a.value - b.value) / b.falls;
  // u - u_b = y (to_b + y (c + y e)), with y from 0 at b to 1 at a
  const double c = 3.0 * rise - 2.0 * to_b - to_a, e = to_a + to_b - 2.0 * rise;
  return y * (to_b + y * (c + y * e));
}

// What the root has, a short step du on.
shared_load moved(const load_balance &at, double way, double du, double most, double roughness) {
  const double s = way * du * (1.0 + 0.5 * du * (1.0 + du / 3.0));  // of d
  const double bent = at.d * s;
  const double tail = s * (1.0 - 0.5 * bent * (1.0 - bent / 3.0) - s * s / 6.0);
  const double film = s * ((1.0 - at.tail) + at.bell * s * (0.5 - bent / 6.0));
  return {std::clamp(most * (at.tail - at.bell * tail), 0.0, 1.0), roughness * (at.t + film),
          at.d + s};
}

// Where all touches: d_0, its density, the film there (m).
struct all_touching {
  double roughness, most, distance, density, film;
};

// d - d_0 about the root. log_all: ln of the film over the touching one if the liquid bears all;
// power: of that film over the liquid's part.
double way_to_begin(const all_touching &zero, double log_all, double power) {
  const double d = zero.distance, whole = 1.0 - std::min(d, 0.0), rise = zero.most * zero.density;
  double way;
  if (log_all > 0) {  // as far as the mean planes part if the liquid bears all
    const double lifted = (exp(log_all) - 1.0) * zero.film / zero.roughness;
    way = std::max(lifted / (1.0 - exp(-lifted) / zero.most), std::min(1.0 / rise, whole));
  } else {  // and if asperities bear nearly all
    way = std::min(exp(std::max(-log_all / power, -20.0)) / rise, whole);
  }
  // Newton's step from there, both sides by few terms of their series about d_0
  const double bend = (1.0 - d * d) * way;
  const double part = rise * way * (1.0 - way * (d / 2.0 + bend / 6.0));
  const double by_way = rise * way * (1.0 - way * (d + bend / 2.0));
  if (!(part > 0 && part < 1 && by_way > 0)) return way;
  const double touch = zero.film / zero.roughness, open = 1.0 - 1.0 / zero.most;
  const double film = touch + way * (open + 0.5 * zero.density * way);
  const double value = log_all + power * log(part) - log(film / touch);
  const double falls = way * (open + zero.density * way) / film - power * by_way / part;
  return way * exp(std::clamp(value / falls, -3.0, 3.0));
}

// The root of ln(film of the liquid's part) = ln(sigma t(d)) within a bracket, in u = ln(d - d_0),
// d_0 where asperities bear all: with it the liquid's part of the load falls to 0 as e^u, and both
// sides are nearly straight lines over u, near d_0 and far from it. The left side falls with u, the
// right one rises. Newton's step first, then those of a cubic through the last two points.
shared_load share_load(const elliptic_film &film, const inlet &in, double roughness,
                       double hardness, double pressure) {
  const double most = touching_share(hardness, pressure);
  const double least = distance_of(1.0 / most), bell = density(least);
  const double touching =
      roughness * (least < -4.0 ? mean_film(least) : least * (1.0 - 1.0 / most) + bell);
  if (!(in.layer > touching)) return {1.0, in.layer};
  double slope;
  const film_point flooded = film.at(1.0);
  const double log_all = in.log_film(flooded, touching, slope);
  const double power = std::min(slope * flooded.by_part, -1e-3);
  double u = log(way_to_begin({roughness, most, least, bell, touching}, log_all, power));
  double before_u = nan;
  double low = -HUGE_VAL, high = HUGE_VAL, width = HUGE_VAL;
  shared_load found{1.0, touching};
  load_balance before{};
  for (int k = 0; k < 100; ++k) {
    const double way = exp(u);
    const load_balance at = balance_at(film, in, roughness, most, least, way);
    (at.value > 0 ? low : high) = u;
    const double newton = at.value / at.falls, last = u - before_u;
    const double cubic = k > 0 ? cubic_step(before, -last, at) : nan;
    const double step = cubic / newton > 0.5 && cubic / newton < 2.0 ? cubic : newton;
    if (std::fabs(newton) < 1e-7 || std::fabs(newton * last) < 1e-7)
      return moved(at, way, step, most, roughness);
    found = {std::min(most * at.tail, 1.0), roughness * at.t, at.d};
    if (u < -40.0 || high - low < 1e-15 * std::fabs(u)) break;
    before = at;
    before_u = u;
    const double next = u + step, bracket = high - low;
    const bool slow = k % 4 == 3 && !(bracket < 0.5 * width);
    if (k % 4 == 3) width = bracket;
    if (next > low && next < high && !(slow && std::isfinite(bracket)))
      u = next;
    else  // half of the bracket, or a step on
      u = low == -HUGE_VAL ? u - 2.0 : high == HUGE_VAL ? u + 2.0 : 0.5 * (low + high);
  }
  return found;
}

inlet inlet_of(const fluid_scene &scene, const fluid_supply &supply, const wet_contact &c,
               const viscosity &liquid) {
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
  return in;
}

double nominal_pressure(const fluid_scene &scene, const wet_contact &c) {
  return scene.mean_pressure > 0 ? scene.mean_pressure : c.mean_pressure;
}

double shear_friction(const fluid_scene &scene, const wet_contact &c, double film) {
  if (!(scene.eyring_stress > 0) || !(c.slip_speed > 0) || !(film > 0)) return 0;
  const double exponent = std::min(c.film.pressure_coefficient * c.mean_pressure, 300.0);
  const double rate = c.film.viscosity * exp(exponent) * (c.slip_speed / film);
  const double stress = scene.eyring_stress * asinh(rate / scene.eyring_stress);
  return std::min(stress / c.mean_pressure, scene.limiting_friction);
}

viscosity viscosity_of(const fluid_scene &scene, const fluid_supply &supply) {
  viscosity found = scene.liquid.at(supply.temperature);
  found.value *= scene.paste.thicker(supply.oxide_water);
  return found;
}

film_outcome solve_wet(const fluid_scene &scene, const fluid_supply &supply, wet_contact c) {
  const viscosity liquid = viscosity_of(scene, supply);
  c.film.viscosity = liquid.value;
  c.film.pressure_coefficient = scene.pressure_coefficient;
  const double v = c.film.speed;
  const inlet in = inlet_of(scene, supply, c, liquid);
  film_outcome found;
  found.temperature = scene.liquid.liquid == RP_LIQUID_GIVEN ? nan : supply.temperature;
  const double boundary = scene.own_boundary ? scene.boundary_friction : c.dry_friction;
  const double asperity = asperity_friction(boundary, c.dry_friction, in.layer, scene.roughness);
  found.friction = asperity;
  if (!(v > 0) || !(c.film.force > 0) || !(in.layer > 0)) return found;
  const elliptic_film film(c.film);
  if (scene.share == RP_SHARE_LOAD_SHARING) {
    const shared_load both =
        share_load(film, in, scene.roughness, scene.hardness, nominal_pressure(scene, c));
    found.share = both.share;
    found.film_thickness = both.film;
  } else {
    double slope;
    found.film_thickness = in.film(film.at().thickness(), slope);
    found.share = exp(-1.8 * pow(found.film_thickness / scene.roughness, 1.2));
  }
  const double shear = shear_friction(scene, c, found.film_thickness);
  found.shear = shear * (1.0 - found.share);
  found.friction = asperity * found.share + found.shear;
  return found;
}

}  // namespace

double asperity_friction(double boundary, double dry, double layer, double roughness) {
  return std::isfinite(layer) ? boundary + (dry - boundary) * exp(-layer / roughness) : boundary;
}

film_outcome solve_film(const fluid_scene &scene, const fluid_supply &supply, wet_contact c) {
  film_outcome found = solve_wet(scene, supply, c);
  const double covered = scene.paste.covers(supply.oxide_water);
  if (covered == 1) return found;
  found.friction = covered * found.friction + (1.0 - covered) * c.dry_friction;
  found.shear *= covered;
  return found;
}

namespace {

// Rates of the inlet: of the layer (m), and of the factor's logarithm.
struct inlet_rate {
  double log_factor = 0, layer = 0;
};

inlet_rate rate_of(const fluid_scene &scene, const fluid_supply &supply, const wet_contact &c,
                   const viscosity &liquid, const wet_contact &d, const fluid_supply &ds) {
  inlet_rate out;
  const double v = c.film.speed, speed = d.film.speed / v;
  const double heating = scene.inlet_conductivity > 0
                             ? liquid.value * liquid.fall * v * v / scene.inlet_conductivity
                             : 0.0;
  if (heating > 0) {
    const double thinner = 0.1 * pow(heating, 0.64);
    const double by_temperature = liquid.bend / liquid.fall - liquid.fall;
    out.log_factor =
        -0.64 * thinner / (1.0 + thinner) * (by_temperature * ds.temperature + 2.0 * speed);
  }
  const double width = v * 2.0 * c.half_width, spread = supply.water_rate / width;
  if (supply.layer >= 0) out.layer = ds.layer;
  if (supply.water_rate >= 0 && !(supply.layer <= spread))
    out.layer = ds.water_rate / width - spread * (speed + d.half_width / c.half_width);
  return out;
}

double shear_rate(const fluid_scene &scene, const wet_contact &c, const wet_contact &d, double film,
                  double film_rate, double log_viscosity) {
  const double friction = shear_friction(scene, c, film);
  if (!(friction > 0) || friction >= scene.limiting_friction) return 0;
  const double exponent = c.film.pressure_coefficient * c.mean_pressure;
  const double eyring = scene.eyring_stress, p = c.mean_pressure;
  const double rate = c.film.viscosity * exp(std::min(exponent, 300.0)) * (c.slip_speed / film);
  const double piezo = exponent < 300.0 ? c.film.pressure_coefficient * d.mean_pressure : 0.0;
  const double log_rate = log_viscosity + piezo + d.slip_speed / c.slip_speed - film_rate / film;
  const double ratio = rate / eyring;
  return (rate / std::sqrt(1.0 + ratio * ratio) * log_rate - friction * d.mean_pressure) / p;
}

film_outcome wet_rates(const fluid_scene &scene, const fluid_supply &supply,
                       const wet_contact &contact, const wet_contact &d, const fluid_supply &ds) {
  wet_contact c = contact;
  const viscosity liquid = viscosity_of(scene, supply);
  c.film.viscosity = liquid.value;
  c.film.pressure_coefficient = scene.pressure_coefficient;
  const bool given = scene.liquid.liquid == RP_LIQUID_GIVEN;
  film_outcome out{0, 0, given ? nan : ds.temperature, 0};
  const inlet in = inlet_of(scene, supply, c, liquid);
  const double v = c.film.speed, sigma = scene.roughness;
  const double boundary = scene.own_boundary ? scene.boundary_friction : c.dry_friction;
  const double boundary_rate = scene.own_boundary ? 0.0 : d.dry_friction;
  const inlet_rate supplied = v > 0 ? rate_of(scene, supply, c, liquid, d, ds)
                                    : inlet_rate{0, supply.layer >= 0 ? ds.layer : 0.0};
  double asperity = boundary, asperity_rate = boundary_rate;
  if (std::isfinite(in.layer)) {
    const double dry = exp(-in.layer / sigma), more = (c.dry_friction - boundary) * dry;
    asperity += more;
    asperity_rate += (d.dry_friction - boundary_rate) * dry - more * supplied.layer / sigma;
  }
  out.friction = asperity_rate;
  if (!(v > 0) || !(c.film.force > 0) || !(in.layer > 0)) return out;
  const elliptic_film film(c.film);
  const double log_viscosity = -liquid.fall * ds.temperature;
  // of the logarithm of what the inlet leaves, where the liquid's part of the load stays
  double slope;
  const auto log_film = [&](const film_point &point) {
    in.film(point.thickness(), slope);
    const double flooded = point.by_load * d.film.force / c.film.force +
                           point.by_speed * (d.film.speed / v + log_viscosity) +
                           point.by_radius_along() * d.film.radius[0] / c.film.radius[0] +
                           point.by_radius_across() * d.film.radius[1] / c.film.radius[1] +
                           supplied.log_factor;
    return slope * flooded +
           (std::isfinite(in.layer) ? (1.0 - slope) * supplied.layer / in.layer : 0.0);
  };
  double share, thickness;
  if (scene.share == RP_SHARE_LOAD_SHARING) {
    const double p = nominal_pressure(scene, c);
    const shared_load both = share_load(film, in, sigma, scene.hardness, p);
    share = both.share;
    thickness = both.film;
    if (std::isnan(both.distance)) {
      out.film_thickness = supplied.layer;
    } else {
      const double distance = both.distance, tail = beyond(distance), bell = density(distance);
      const double most = touching_share(scene.hardness, p), q = std::max(1.0 - share, 1e-14);
      const bool follows = !(scene.mean_pressure > 0) && scene.hardness / p > 1.0 + 1e-12;
      const double most_rate = follows ? -most * d.mean_pressure / p : 0.0;
      const film_point point = film.at(q);
      const double still = log_film(point) - slope * point.by_part * most_rate * tail / q;
      const double falls =
          slope * point.by_part * most * bell / q - (1.0 - tail) / mean_film(distance);
      const double parts = -still / falls;
      out.film_thickness = sigma * (1.0 - tail) * parts;
      out.share = most_rate * tail - most * bell * parts;
    }
  } else {
    const film_point point = film.at();
    thickness = in.film(point.thickness(), slope);
    const double log_rate = log_film(point), exponent = 1.8 * pow(thickness / sigma, 1.2);
    share = exp(-exponent);
    out.film_thickness = thickness * log_rate;
    out.share = -1.2 * exponent * share * log_rate;
  }
  const double shear = shear_friction(scene, c, thickness);
  const double by_shear =
      shear_rate(scene, c, d, thickness, out.film_thickness, log_viscosity) * (1.0 - share);
  out.friction = asperity_rate * share + (asperity - shear) * out.share + by_shear;
  out.shear = by_shear - shear * out.share;
  return out;
}

}  // namespace

film_outcome film_rates(const fluid_scene &scene, const fluid_supply &supply,
                        const wet_contact &contact, const wet_contact &d, const fluid_supply &ds) {
  film_outcome out = wet_rates(scene, supply, contact, d, ds);
  const double covered = scene.paste.covers(supply.oxide_water);
  if (covered == 1) return out;
  out.friction = covered * out.friction + (1.0 - covered) * d.dry_friction;
  out.shear *= covered;
  return out;
}

}  // namespace railpatch
