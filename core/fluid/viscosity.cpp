#include "fluid/viscosity.hpp"

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr double zero_celsius = 273.15;

viscosity of_water(double celsius) {
  const double above = celsius + zero_celsius - 149.3, exponent = 507.88 / above;
  const double fall = exponent / above;
  return {0.02939e-3 * exp(exponent), fall, -2.0 * fall / above};
}

viscosity of_oil(const viscosity_law &law, double celsius) {
  const double above = celsius + zero_celsius - 138.0;
  const double reference = law.reference + zero_celsius - 138.0;
  const double scale = log(law.value) + 9.67;
  const double part = pow(above / reference, -law.slope);
  const double fall = scale * part * law.slope / above;
  return {law.value * exp(scale * (part - 1.0)), fall, -(law.slope + 1.0) * fall / above};
}

viscosity of_table(const viscosity_law &law, double celsius) {
  const double *t = law.temperature, *l = law.logarithm;
  if (celsius <= t[0]) return {exp(l[0]), 0, 0};
  const int last = law.points - 1;
  if (celsius >= t[last]) return {exp(l[last]), 0, 0};
  int i = 1;
  while (celsius > t[i]) ++i;
  const double slope = (l[i] - l[i - 1]) / (t[i] - t[i - 1]);
  return {exp(l[i - 1] + slope * (celsius - t[i - 1])), -slope, 0};
}

}  // namespace

viscosity viscosity_law::at(double celsius) const {
  viscosity found{value, 0, 0};
  if (liquid == RP_LIQUID_WATER) found = of_water(celsius);
  if (liquid == RP_LIQUID_OIL) found = of_oil(*this, celsius);
  if (liquid == RP_LIQUID_TABLE) found = of_table(*this, celsius);
  if (solids > 0) found.value *= exp(solids);
  return found;
}

}  // namespace railpatch
