#include "handle/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/ehl.hpp"
#include "handle/checker.hpp"
#include "railpatch_fields.h"

namespace railpatch {

namespace {

// the texts of RP_WARNINGS name them; NAME_range of RP_PLAUSIBLE_RANGES
#define RAILPATCH_RANGE(name, low, high) constexpr double name##_range[2] = {low, high};
RP_PLAUSIBLE_RANGES(RAILPATCH_RANGE)
constexpr double steel_range[2] = {6e10, 1e11};   // Pa, shear moduli of steels are 7.5e10 to 8.5e10
constexpr double pressure_range[2] = {1e7, 5e9};  // Pa
constexpr double water_range[2] = {0, 100};       // degrees C, where water is a liquid
constexpr double thick_film = 1e-4;               // m, of a liquid between the bodies
constexpr double slippery = 1e-3;                 // -, friction of what a liquid wets
constexpr double doubtful_size = 0.06;            // m, diameter of the circle of a contact's area
constexpr double play_range[2] = {0.04, 0.12};    // m, gauge minus flange back distance
constexpr double least_flange = 0.015;            // m, height of a profile that has one
constexpr double least_way = 0.01;                // m/s, below which nothing is said of turning
constexpr double radius_range[2] = {1, 8};        // of wheels, over the width of their profiles
constexpr double longest_shift = 1e-3;            // m
constexpr double longest_step = 0.1;              // m, of transient rolling
constexpr double greatest_speed = 200;            // m/s
constexpr double body_range[2] = {0.002, 20};     // m, radii of bodies that touch
constexpr double hardening_range[2] = {1e7, 1e17};  // Pa/m, either way
constexpr double longest_hardening = 0.1;           // m, of plastic displacement in a table
constexpr int least_elements = 8;
constexpr double coarse_rise = 0.1;  // of a film's pressure in an element: docs/ehl.md
constexpr double least_entry = 10;   // gap where the liquid enters over the film: docs/ehl.md

uint32_t bit(rp_warning warning, bool given) {
  return given ? uint32_t{1} << warning : uint32_t{0};
}

// NaN is within: it says that there is no such number
bool outside(double value, const double (&range)[2]) {
  return value < range[0] || value > range[1];
}

// A patch is that of the right side.
bool in_use(const rp_config &config, int side) {
  return config.kind == RP_WHEELSET || side == (config.kind == RP_PATCH ? RP_RIGHT : config.side);
}

bool moves(const rp_config &config) {
  if (config.tangential == RP_TANGENTIAL_NONE) return false;
  return config.kind != RP_PATCH || (config.regime != RP_REGIME_NONE && config.regime != RP_SHIFT);
}

// Whether a wheel on its way does not turn, or the other way round.
bool turns_wrongly(const rp_config &config, const rp_input &in, double pitch_rate, int side) {
  double way = in.speed;
  if (config.track == RP_ROLLER) way += in.roller_pitch_rate * config.roller_radius;
  const double rate = pitch_rate + in.wheel_angular_velocity[side][1];
  return std::fabs(way) > least_way && !(-rate * way > 0);
}

// Of a step: motions in another unit. A patch's speed and distance are given, wheels' follow.
uint32_t warnings_of_motion(const rp_config &config, const rp_input &in) {
  const bool alone = config.kind == RP_PATCH;
  const int regime =
      config.tangential == RP_TANGENTIAL_NONE ? RP_REGIME_NONE : regime_of(config, in);
  const double turning =
      config.track == RP_ROLLER ? in.roller_pitch_rate * config.roller_radius : 0;
  const double speed = alone ? in.rolling_speed : in.speed + turning;
  const double way = alone ? in.distance : std::fabs(speed) * in.time_step;
  const double shift = std::max(std::fabs(in.creepage[0]), std::fabs(in.creepage[1]));
  return bit(RP_WARNING_SHIFT, alone && regime == RP_SHIFT && shift > longest_shift) |
         bit(RP_WARNING_DISTANCE, regime == RP_TRANSIENT_ROLLING && way > longest_step) |
         bit(RP_WARNING_SPEED, std::fabs(speed) > greatest_speed);
}

// Of radii in mm, or given in place of curvatures.
bool doubtful_bodies(const rp_config &config) {
  if (config.kind != RP_PATCH) return false;
  if (config.geometry == RP_LINE_CONTACT) return outside(config.line_contact_radius, body_range);
  if (config.geometry != RP_CURVATURES) return false;
  return outside(1 / std::max(config.curvatures[0], config.curvatures[1]), body_range);
}

bool doubtful_layer(const rp_config &config) {
  const double slope = std::fabs(config.layer_hardening);
  bool doubtful = config.layer_yield_stress > 0 &&
                  (outside(config.layer_yield_stress, layer_yield_stress_range) ||
                   (slope > 0 && outside(slope, hardening_range)));
  for (int i = 0; i < config.hardening_points; ++i)
    doubtful = doubtful || outside(config.hardening_stress[i], layer_yield_stress_range) ||
               config.hardening_displacement[i] > longest_hardening;
  return doubtful;
}

// Of what a case gives for all steps: K in place of degrees C. Of a table the first point counts.
bool doubtful_temperatures(const rp_config &config) {
  bool doubtful = false;
  if (config.temperature) {
    for (int body = 0; body < 2; ++body)
      doubtful = doubtful || outside(config.bulk_temperature[body], bulk_temperature_range) ||
                 (config.air_conductance[body] > 0 &&
                  outside(config.air_temperature, air_temperature_range));
  }
  if (config.fluid_model == RP_FLUID_NONE) return doubtful;
  return doubtful || outside(config.fluid_temperature, fluid_temperature_range) ||
         (config.fluid_liquid == RP_LIQUID_OIL &&
          outside(config.fluid_reference_temperature, fluid_reference_temperature_range)) ||
         (config.fluid_liquid == RP_LIQUID_TABLE &&
          outside(config.fluid_viscosity_temperature[0], fluid_temperature_range));
}

bool doubtful_slip_law(const rp_config &config) {
  if (config.friction_law != RP_SLIP_VELOCITY) return false;
  bool doubtful = outside(config.friction_memory_distance, friction_memory_distance_range);
  for (int term = 0; term < 2; ++term)
    doubtful =
        doubtful || (config.friction_amplitude[term] != 0 &&
                     outside(config.friction_halving_speed[term], friction_halving_speed_range));
  return doubtful;
}

bool doubtful_supply(double rate, double film) {
  return outside(rate, fluid_water_rate_range) || outside(film, fluid_oil_film_range);
}

bool doubtful_liquid(const rp_config &config) {
  if (config.fluid_model == RP_FLUID_NONE || config.fluid_model == RP_FLUID_REGIMES) return false;
  bool doubtful = outside(config.fluid_roughness, fluid_roughness_range) ||
                  outside(config.fluid_viscosity, fluid_viscosity_range) ||
                  outside(config.fluid_hardness, fluid_hardness_range) ||
                  (config.fluid_mean_pressure > 0 &&  // 0: the contact's own
                   outside(config.fluid_mean_pressure, pressure_range));
  for (int k = 0; k < config.fluid_viscosity_points; ++k)
    doubtful = doubtful || outside(config.fluid_viscosity_value[k], fluid_viscosity_range);
  doubtful = doubtful || config.fluid_boundary_friction > config.friction_coefficient;
  const double stress = config.fluid_eyring_stress;
  return doubtful || (stress > 0 && outside(stress, fluid_eyring_stress_range));
}

// Of what a step gives in place of the case.
uint32_t warnings_of_physics(const rp_config &config, const rp_input &in) {
  const bool fluid = config.fluid_model != RP_FLUID_NONE;
  bool hot = fluid && outside(in.water_temperature, fluid_temperature_range);
  for (double temperature : in.bulk_temperature)
    hot = hot || (config.temperature && outside(temperature, bulk_temperature_range));
  return bit(RP_WARNING_TEMPERATURE, hot) |
         bit(RP_WARNING_SUPPLY, fluid && doubtful_supply(in.water_rate, in.oil_film));
}

// friction: of the dry contact
uint32_t warnings_of_patch(const rp_config &config, double friction, const rp_patch_result &patch) {
  bool hard = config.own_influence == 0;
  for (double modulus : config.shear_modulus) hard = hard && !outside(modulus, steel_range);
  uint32_t found = bit(RP_WARNING_HIGH_PRESSURE, patch.max_pressure > pressure_range[1]) |
                   bit(RP_WARNING_LOW_PRESSURE,
                       hard && patch.max_pressure < pressure_range[0] && patch.max_pressure > 0);
  if (moves(config) && patch.direction != 0)
    found |= bit(RP_WARNING_CREEPAGE, outside(patch.creepage[0], creepage_range) ||
                                          outside(patch.creepage[1], creepage_range)) |
             bit(RP_WARNING_SPIN, outside(patch.spin_creepage, spin_creepage_range));
  const double width = 2 * std::sqrt(patch.contact_area / std::numbers::pi);
  const bool is_slippery = friction > 0 && friction < slippery;  // without a liquid
  const bool line = config.kind == RP_PATCH && config.geometry == RP_LINE_CONTACT;
  const double widest = std::max(doubtful_size, 2 * config.line_contact_radius);
  found |= bit(RP_WARNING_LAYER, !line && config.layer_thickness > width && width > 0) |
           bit(RP_WARNING_SIZE, line ? patch.contact_size[0] > widest : width > doubtful_size);
  found |= bit(RP_WARNING_WATER, config.fluid_model != RP_FLUID_NONE &&
                                     config.fluid_liquid == RP_LIQUID_WATER &&
                                     outside(patch.fluid_temperature, water_range)) |
           bit(RP_WARNING_THICK_FILM, patch.central_film_thickness > thick_film) |
           bit(RP_WARNING_SLIPPERY, config.fluid_model != RP_FLUID_NONE && !is_slippery &&
                                        patch.effective_friction < slippery);
  bool coarse = false;
  for (int k = 0; k < (line ? 1 : 2); ++k) {
    // a grid of the case's own number has a border around it
    const int count = config.elements[k] > 0 ? config.elements[k] : patch.grid[k];
    // strips of one or two rows are meant: there is nothing to refine across
    const bool strip = has_strips(config) && count < 3;
    coarse = coarse || (patch.grid[k] > 0 && count < least_elements && !strip);
  }
  return found | bit(RP_WARNING_COARSE, coarse && config.fitted[0] == 0);
}

// coefficient: Coulomb's, as set last. pitch_rate: given or found
uint32_t warnings_of_side(const rp_config &config, const rp_input &input, double coefficient,
                          double pitch_rate, int side, const rp_side_result &wheel) {
  const double friction = coefficient * input.friction_scale[side];
  uint32_t found = bit(RP_WARNING_FRICTION, config.tangential != RP_TANGENTIAL_NONE &&
                                                friction > friction_coefficient_range[1]);
  double load = 0;
  for (int i = 0; i < wheel.patch_count + wheel.alternative_count; ++i) {
    const rp_patch_result &patch = wheel.patch[i];
    if (patch.status == RP_NO_CONTACT) continue;
    load += patch.share * patch.normal_force;
    found |= warnings_of_patch(config, friction, patch);
  }
  found |= bit(RP_WARNING_LOAD, load != 0 && outside(load, normal_force_range));
  if (config.kind == RP_PATCH) return found;
  return found |
         bit(RP_WARNING_TURNING, moves(config) && turns_wrongly(config, input, pitch_rate, side)) |
         bit(RP_WARNING_FLANGE, outside(input.y, y_range));
}

double extent(const double *values, int count) {
  const auto [low, high] = std::minmax_element(values, values + count);
  return *high - *low;
}

}  // namespace

uint32_t warnings_of_case(const rp_config &config) {
  bool soft = false, odd = false, wide = false;
  // viscoelastic ones are rubber as a rule
  for (int body = 0; body < 2; ++body)
    soft = soft || (!(config.viscoelastic_ratio[body] > 0) &&
                    outside(config.shear_modulus[body], shear_modulus_range));
  const double play = config.gauge + config.gauge_widening - config.flange_back_distance;
  for (int side = 0; side < 2; ++side) {
    const rp_profile &profile = config.wheel[side];
    if (config.kind == RP_PATCH || !in_use(config, side) || !profile.y || profile.count < 2)
      continue;
    odd = odd || outside(config.nominal_radius / extent(profile.y, profile.count), radius_range);
    const bool flange = extent(profile.z, profile.count) > least_flange;
    wide = wide || (flange && outside(play, play_range));
  }
  const bool layer =
      config.layer_thickness > 0 && outside(config.layer_shear_modulus, layer_shear_modulus_range);
  return bit(RP_WARNING_STIFFNESS, soft) | bit(RP_WARNING_RADIUS, odd) |
         bit(RP_WARNING_CURVATURES, doubtful_bodies(config)) |
         bit(RP_WARNING_LAYER_STIFFNESS, layer) | bit(RP_WARNING_GAUGE, wide) |
         bit(RP_WARNING_YIELD, doubtful_layer(config)) |
         bit(RP_WARNING_TEMPERATURE, doubtful_temperatures(config)) |
         bit(RP_WARNING_SUPPLY,
             config.fluid_model != RP_FLUID_NONE &&
                 doubtful_supply(config.fluid_water_rate, config.fluid_oil_film)) |
         bit(RP_WARNING_SLIP_LAW, doubtful_slip_law(config)) |
         bit(RP_WARNING_LIQUID, doubtful_liquid(config));
}

uint32_t warnings_of_film(const rp_config &config, const patch_memory *solution,
                          const rp_result &result) {
  if (config.fluid_model != RP_FLUID_EHL || !solution) return 0;
  const double rise =
      greatest_rise(solution->g, result.side[RP_RIGHT].patch[0].direction,
                    config.fluid_pressure_coefficient, solution->fluid_pressure.data());
  return bit(RP_WARNING_FILM_GRID, rise > coarse_rise) |
         bit(RP_WARNING_FILM_REACH, solution->film_entry < least_entry);
}

void report_warnings(const rp_config &config, uint32_t of_case, const rp_input &input,
                     double coefficient, rp_result &result) {
  const uint32_t of_step = warnings_of_motion(config, input) | warnings_of_physics(config, input);
  int touching = 0;
  for (int side = 0; side < 2; ++side) {
    if (!in_use(config, side)) continue;
    rp_side_result &wheel = result.side[side];
    // those of the search for the height are there already
    wheel.warnings |= of_case | of_step |
                      warnings_of_side(config, input, coefficient, result.pitch_rate, side, wheel);
    touching += wheel.patch_count > 0;
  }
  // said of the wheel in the air
  if (config.kind == RP_WHEELSET && touching == 1)
    for (auto &wheel : result.side)
      if (wheel.patch_count == 0) wheel.warnings |= bit(RP_WARNING_ONE_WHEEL, true);
  result.warnings = result.side[0].warnings | result.side[1].warnings;
}

}  // namespace railpatch
