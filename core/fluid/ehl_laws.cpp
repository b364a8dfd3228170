#include "fluid/ehl_laws.hpp"

#include <algorithm>
#include <cmath>

#include "fluid/asperities.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// K of Wilson and Marsault over t = h_T/sigma.
with_slope flow_of_film(double t) {
  constexpr double threshold = 0.27774, square = 0.37739, cubic = 1.00190;
  const double above = t - threshold;
  if (above <= 0) return {0, 0};
  return {above * above * (square + cubic * above), above * (2 * square + 3 * cubic * above)};
}

// exponents beyond it would leave the numbers
constexpr double greatest_exponent = 200.0;

}  // namespace

with_slope viscosity_ratio(const ehl_liquid &liquid, double p) {
  if (liquid.law == ehl_viscosity::constant || liquid.pressure_coefficient == 0) return {1, 0};
  if (liquid.law == ehl_viscosity::barus) {
    const double exponent = liquid.pressure_coefficient * p;
    if (exponent > greatest_exponent) return {exp(greatest_exponent), 0};
    const double value = exp(exponent);
    return {value, liquid.pressure_coefficient * value};
  }
  constexpr double reference = 1.96e8;  // Pa
  const double height = log(liquid.viscosity) + 9.67;
  const double z = liquid.pressure_coefficient * reference / height;
  const double s = 1 + std::max(p, -0.5 * reference) / reference;
  const double power = pow(s, z);
  const double exponent = height * (power - 1);
  if (exponent > greatest_exponent) return {exp(greatest_exponent), 0};
  const double value = exp(exponent);
  return {value, value * height * z * power / (s * reference)};
}

with_slope density_ratio(const ehl_liquid &liquid, double p) {
  if (!liquid.compressible || p <= 0) return {1, 0};
  const double below = 1 + 1.7e-9 * p;
  return {1 + 0.6e-9 * p / below, 0.6e-9 / (below * below)};
}

film_of_gap film_of(const ehl_roughness &roughness, double h) {
  const double sigma = roughness.height;
  if (sigma == 0) return {{h, 1}, {h * h * h, 3 * h * h}, {0, 0}};
  const double d = h / sigma;
  if (d > 37) {  // the peaks' share is below what a number can hold
    const with_slope flow = flow_of_film(d);
    film_of_gap plain{{h, 1}, {sigma * sigma * sigma * flow.value, sigma * sigma * flow.slope}, {}};
    if (roughness.flow == ehl_flow::patir_cheng) plain.cube = {h * h * h, 3 * h * h};
    return plain;
  }
  const double below = beyond(-d), t = mean_film(d);
  film_of_gap film;
  film.film = {sigma * t, below};
  film.asperity = {roughness.hardness * beyond(d), -roughness.hardness * density(d) / sigma};
  if (roughness.flow == ehl_flow::patir_cheng) {
    const double e = d > 0 ? exp(-0.56 * d) : 1.0;
    const double at = std::max(d, 0.0);
    film.cube = {h > 0 ? h * h * h * (1 - 0.9 * e) : 0.0,
                 sigma * sigma * (3 * at * at * (1 - 0.9 * e) + at * at * at * 0.504 * e)};
  } else {
    const with_slope flow = flow_of_film(t);
    film.cube = {sigma * sigma * sigma * flow.value, sigma * sigma * flow.slope * below};
  }
  return film;
}

}  // namespace railpatch
