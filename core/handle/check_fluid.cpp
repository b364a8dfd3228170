// A liquid between wheel and rail: its own numbers, and what it is not combined with.
#include <cmath>

#include "fluid/mixed.hpp"
#include "half_space/influence.hpp"
#include "handle/checker.hpp"

namespace railpatch {

namespace {

// degrees C, below and above which water is no liquid before the contact
constexpr range of_water{0, 100, false, false};

void check_given(const char *name, double value, const range &r, checker &check) {
  if (!std::isnan(value)) check.number(name, value, r);
}

// What the strips do not read.
const char *unread_by_strip(const rp_config &c) {
  const bool supply = !std::isnan(c.fluid_water_rate) || !std::isnan(c.fluid_oil_film);
  if (supply || c.fluid_starvation != 1)
    return "fluid_water_rate, fluid_oil_film and fluid_starvation must be NaN, NaN and 1 with "
           "fluid_model = strip: it is flooded";
  if (c.fluid_inlet_conductivity > 0)
    return "fluid_inlet_conductivity must be 0 with fluid_model = strip: its inlet is as warm as "
           "it "
           "says";
  if (c.fluid_eyring_stress > 0)
    return "fluid_eyring_stress must be 0 with fluid_model = strip: its liquid has no friction";
  return nullptr;
}

// What elastohydrodynamic lubrication on the grid needs, and what it does not read.
const char *not_with_ehl(const rp_config &c) {
  if (c.kind != RP_PATCH)
    return "fluid_model = ehl needs kind = patch: liquid comes from beyond the grids of wheels";
  if (c.normal != RP_NORMAL_HALF_SPACE)
    return "fluid_model = ehl needs normal = half_space, whose pressure it finds anew";
  if (c.regime != RP_STEADY_ROLLING) return "fluid_model = ehl needs regime = steady_rolling";
  if (c.fitted[0] > 0)
    return "fitted must be 0 with fluid_model = ehl: its pressure is on the grid";
  if (c.tangential == RP_TANGENTIAL_FULL && combine(c.shear_modulus, c.poisson_ratio).mismatch != 0)
    return "fluid_model = ehl needs bodies of the same material";
  if (c.fluid_starvation != 1)
    return "fluid_starvation must be 1 with fluid_model = ehl: fluid_oil_film says what arrives";
  if (c.fluid_inlet_conductivity > 0 &&
      (c.fluid_liquid == RP_LIQUID_GIVEN || !(c.fluid_eyring_stress > 0)))
    return "fluid_inlet_conductivity must be 0 with fluid_model = ehl, but with "
           "fluid_eyring_stress and a viscosity by temperature: the film's shear heats it";
  return nullptr;
}

void check_knots(const rp_config &c, checker &check) {
  const int knots = c.fluid_knots;
  if (knots == 0) return;
  check.require(c.fluid_model == RP_FLUID_REGIMES,
                "fluid_knots must be 0 but with fluid_model = regimes");
  check.field("fluid_knots", knots, config_range::fluid_knots);
  if (check.error() != RP_OK) return;
  const auto numbers = [&](const char *name, const double *values, const range &r) {
    check.numbers(name, values, knots, r);
  };
  numbers("fluid_knot_rate", c.fluid_knot_rate, config_range::fluid_knot_rate);
  numbers("fluid_knot_k_a", c.fluid_knot_k_a, config_range::fluid_knot_k_a);
  numbers("fluid_knot_k_s", c.fluid_knot_k_s, config_range::fluid_knot_k_s);
  numbers("fluid_knot_coefficient", c.fluid_knot_coefficient, config_range::fluid_knot_coefficient);
  numbers("fluid_knot_a", c.fluid_knot_a, config_range::fluid_knot_a);
  numbers("fluid_knot_b", c.fluid_knot_b, config_range::fluid_knot_b);
  for (int i = 1; i < knots; ++i)
    check.require(c.fluid_knot_rate[i] > c.fluid_knot_rate[i - 1], "fluid_knot_rate must increase");
}

// A paste that dries is a state of wheels.
const char *not_with_drying(const rp_config &c) {
  if (c.fluid_model != RP_FLUID_FILM)
    return "fluid_drying_time and fluid_drying_work must be 0 but with fluid_model = film";
  if (c.kind == RP_PATCH)
    return "fluid_drying_time and fluid_drying_work must be 0 with kind = patch: the paste that "
           "dries is that of a wheel";
  if (!(c.fluid_oxide_content > 0 && c.fluid_oxide_content < drying_paste::packed))
    return "fluid_oxide_content must be above 0 and below 0.64, where solids are packed, with "
           "fluid_drying_time or fluid_drying_work";
  if (c.bulk_mass[0] != 0 || c.bulk_mass[1] != 0)
    return "fluid_drying_time and fluid_drying_work must be 0 with bulk_mass";
  return nullptr;
}

const char *not_combined(const rp_config &c) {
  if (!has_tangential(c)) return "fluid_model must be none without a tangential problem";
  if (c.regime == RP_SHIFT)
    return "fluid_model must be none with regime = shift: nothing rolls, and no film forms";
  const bool regimes = c.fluid_model == RP_FLUID_REGIMES;
  if (regimes && c.tangential != RP_TANGENTIAL_POLACH)
    return "fluid_model = regimes needs tangential = polach, whose parameters it has";
  if (regimes && std::isnan(c.fluid_water_rate))
    return "fluid_water_rate must be a number with fluid_model = regimes";
  if (regimes && (c.polach_k_a != 1 || c.polach_k_s != 1))
    return "polach_k_a and polach_k_s must be 1 with fluid_model = regimes, which has its own";
  if (!regimes && c.fluid_recovery > 0)
    return "fluid_recovery must be 0 but with fluid_model = regimes";
  if (c.fluid_drying_time > 0 || c.fluid_drying_work > 0) {
    if (const char *wrong = not_with_drying(c)) return wrong;
  }
  const bool strip = c.fluid_model == RP_FLUID_STRIP;
  const bool by_heat = c.friction_law == RP_TEMPERATURE && strip;
  if (c.friction_law != RP_COULOMB && !by_heat)
    return "fluid_model needs friction_law = coulomb, strip also temperature: the coefficient "
           "follows from the liquid";
  if (by_heat && !std::isnan(c.fluid_boundary_friction))
    return "fluid_boundary_friction must be NaN with friction_law = temperature, which gives it";
  if (strip) {
    if (const char *unread = unread_by_strip(c)) return unread;
  }
  if (c.fluid_model == RP_FLUID_FILM && c.fluid_share == RP_SHARE_LOAD_SHARING &&
      c.fluid_mean_pressure >= c.fluid_hardness)
    return "fluid_hardness must be above fluid_mean_pressure with fluid_share = load_sharing: "
           "asperities could not bear it";
  const bool ehl = c.fluid_model == RP_FLUID_EHL;
  if (ehl) {
    if (const char *wrong = not_with_ehl(c)) return wrong;
  }
  if (!regimes && !std::isnan(c.fluid_water_rate) && !std::isnan(c.fluid_oil_film))
    return "fluid_oil_film must be NaN with fluid_water_rate: one of them says what arrives";
  if (!regimes && c.fluid_liquid == RP_LIQUID_WATER && c.fluid_eyring_stress > 0)
    return "fluid_eyring_stress must be 0 with fluid_liquid = water, whose own friction is 0";
  if (c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT && !ehl)
    return "fluid_model must be none with a line contact: the film is that of an elliptic one";
  if (c.accuracy > 0)
    return "accuracy must be 0 with fluid_model: what the liquid's model errs by is not known";
  if (c.fluid_eyring_stress > 0 && (c.force_prescribed[0] != 0 || c.force_prescribed[1] != 0))
    return "fluid_eyring_stress must be 0 with force_prescribed: the liquid's friction follows "
           "from "
           "the creepage";
  return nullptr;
}

}  // namespace

void check_fluid(const rp_config &c, checker &check) {
  check_given("fluid_boundary_friction", c.fluid_boundary_friction,
              config_range::fluid_boundary_friction, check);
  check_given("fluid_temperature", c.fluid_temperature, config_range::fluid_temperature, check);
  check_given("fluid_water_rate", c.fluid_water_rate, config_range::fluid_water_rate, check);
  check_given("fluid_oil_film", c.fluid_oil_film, config_range::fluid_oil_film, check);
  if (c.fluid_model == RP_FLUID_NONE || check.error() != RP_OK) return;
  const bool table = c.fluid_liquid == RP_LIQUID_TABLE;
  check.require(table == (c.fluid_viscosity_points > 0),
                "fluid_viscosity_points must be 2 or more with fluid_liquid = table, else 0");
  if (table && check.error() == RP_OK) {
    const int points = c.fluid_viscosity_points;
    check.field("fluid_viscosity_points", points, config_range::fluid_viscosity_points);
    if (check.error() != RP_OK) return;
    check.numbers("fluid_viscosity_temperature", c.fluid_viscosity_temperature, points, finite);
    check.numbers("fluid_viscosity_value", c.fluid_viscosity_value, points,
                  config_range::fluid_viscosity_value);
    for (int i = 1; i < points; ++i)
      check.require(c.fluid_viscosity_temperature[i] > c.fluid_viscosity_temperature[i - 1],
                    "fluid_viscosity_temperature must increase");
  }
  if (c.fluid_model != RP_FLUID_REGIMES && c.fluid_liquid == RP_LIQUID_WATER)
    check_given("fluid_temperature", c.fluid_temperature, of_water, check);
  check_knots(c, check);
  if (check.error() != RP_OK) return;
  const char *wrong = not_combined(c);
  check.require(wrong == nullptr, wrong ? wrong : "");
}

void check_fluid(const rp_config &c, const rp_input &in, checker &check) {
  for (double work : in.rail_work) {
    if (!(work != 0)) continue;
    check.number("rail_work", work, input_range::rail_work);
    check.require(c.fluid_model != RP_FLUID_NONE && c.fluid_recovery > 0,
                  "rail_work must be 0 without fluid_recovery: nothing is cleaned");
  }
  const bool given =
      !std::isnan(in.water_rate) || !std::isnan(in.water_temperature) || !std::isnan(in.oil_film);
  if (!given) return;
  check.require(c.fluid_model != RP_FLUID_NONE,
                "water_rate, water_temperature and oil_film must be left NaN in a scene without "
                "fluid_model");
  check.require(
      c.fluid_model != RP_FLUID_STRIP || (std::isnan(in.water_rate) && std::isnan(in.oil_film)),
      "water_rate and oil_film must be left NaN with fluid_model = strip: it is flooded");
  check_given("water_rate", in.water_rate, input_range::water_rate, check);
  check_given("water_temperature", in.water_temperature, input_range::water_temperature, check);
  check_given("oil_film", in.oil_film, input_range::oil_film, check);
  const auto said = [](double now, double usual) { return !std::isnan(now) || !std::isnan(usual); };
  check.require(!said(in.water_rate, c.fluid_water_rate) || !said(in.oil_film, c.fluid_oil_film),
                "oil_film must be left NaN with water_rate: one of them says what arrives");
  if (c.fluid_liquid == RP_LIQUID_WATER)
    check_given("water_temperature", in.water_temperature, of_water, check);
}

}  // namespace railpatch
