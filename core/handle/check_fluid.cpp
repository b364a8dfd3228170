// A liquid between wheel and rail: its own numbers, and what it is not combined with.
#include <cmath>

#include "handle/checker.hpp"

namespace railpatch {

namespace {

void check_given(const char *name, double value, const range &r, checker &check) {
  if (!std::isnan(value)) check.number(name, value, r);
}

const char *not_combined(const rp_config &c) {
  if (!has_tangential(c)) return "fluid_model must be none without a tangential problem";
  if (c.regime == RP_SHIFT)
    return "fluid_model must be none with regime = shift: nothing rolls, and no film forms";
  if (c.friction_law != RP_COULOMB)
    return "fluid_model must be none but with friction_law = coulomb: the coefficient follows from "
           "the liquid";
  if (c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT)
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
  const char *wrong = not_combined(c);
  check.require(wrong == nullptr, wrong ? wrong : "");
}

void check_fluid(const rp_config &c, const rp_input &in, checker &check) {
  const bool given =
      !std::isnan(in.water_rate) || !std::isnan(in.water_temperature) || !std::isnan(in.oil_film);
  if (!given) return;
  check.require(c.fluid_model != RP_FLUID_NONE,
                "water_rate, water_temperature and oil_film must be left NaN in a scene without "
                "fluid_model");
  check_given("water_rate", in.water_rate, input_range::water_rate, check);
  check_given("water_temperature", in.water_temperature, input_range::water_temperature, check);
  check_given("oil_film", in.oil_film, input_range::oil_film, check);
}

}  // namespace railpatch
