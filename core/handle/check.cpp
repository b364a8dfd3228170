#include "handle/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "fast/fast.hpp"
#include "fast/shape_table.hpp"
#include "half_space/coupling.hpp"
#include "half_space/physics.hpp"
#include "handle/case_fields.hpp"
#include "handle/checker.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

#define RP_NO_FIELD(type, name, count)
// A choice is one of its words in every case: whoever reads all members reads it too.
#define RP_IS_CHECKED(role, where) \
  ((case_role::role == case_role::choice ? case_part::always : case_part::where) == part)
#define RP_CHECK_CONFIG(type, name, count, role, where, ...) \
  if (RP_IS_CHECKED(role, where)) check.field(#name, c.name, config_range::name);
#define RP_CHECK_INPUT(type, name, count, role, where, ...) \
  if (case_part::where == part) check.field(#name, in.name, input_range::name);

// The listed ranges of what belongs to a part.
void check_ranges(const rp_config &c, case_part part, checker &check) {
  RP_CONFIG_FIELDS(RP_CHECK_CONFIG, RP_NO_FIELD)
}
void check_ranges(const rp_input &in, case_part part, checker &check) {
  RP_INPUT_FIELDS(RP_CHECK_INPUT, RP_NO_FIELD)
}

// A place of the spin term that is asked for, where no steps from element to element read it.
void check_spin_offset(const rp_config &c, checker &check) {
  if (c.spin_offset == RP_SPIN_OFFSET_AUTOMATIC || c.spin_offset == RP_SPIN_OFFSET_NONE) return;
  const char *wrong = nullptr;
  if (c.fitted[0] > 0 || c.fitted[1] > 0)
    wrong = "spin_offset must be automatic or none with fitted: it belongs to the uniform grid";
  else if (!has_tangential(c))
    wrong = "spin_offset must be automatic or none without a tangential problem";
  else if (is_fast(c.tangential) && !has_tractions(c.tangential))
    wrong =
        "spin_offset must be automatic or none where tangential gives no tractions: it belongs to "
        "steps from element to element";
  else if (c.regime == RP_SHIFT && c.regime_changes == 0)
    wrong = "spin_offset must be automatic or none with regime = shift: nothing rolls";
  check.require(wrong == nullptr, wrong ? wrong : "");
}

void check_fitted(const rp_config &c, checker &check) {
  if (c.fitted[0] == 0 && c.fitted[1] == 0) return;
  const bool line = c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
  check.field("fitted[0]", c.fitted[0], config_range::fitted);
  check.field("fitted[1]", c.fitted[1], line ? only_one : config_range::fitted);
  if (check.error() == RP_OK)
    check.integer("fitted[0] * fitted[1]", c.fitted[0] * c.fitted[1], 3, max_fitted_nodes);
  // they may be left out for a while, or come after a table
  const bool full = c.tangential == RP_TANGENTIAL_FULL || c.tangential == RP_TANGENTIAL_NONE;
  check.require(full || (c.tangential == RP_TANGENTIAL_TABLE && c.finer_grids > 0),
                "fitted needs tangential = full, or table with finer_grids");
}

// Pairs of a table: increasing places, values in a range.
void check_points(const char *points, int count, const char *place, const double *places,
                  const char *value, const double *values, const range &r, checker &check) {
  if (count == 0) return;
  check.integer(points, count, 2, RP_MAX_POINTS);
  if (check.error() != RP_OK) return;
  check.numbers(place, places, count, finite);
  check.numbers(value, values, count, r);
  char text[RP_MESSAGE_SIZE];
  for (int i = 1; i < count; ++i) {
    std::snprintf(text, sizeof text, "%s[%d] is %g, allowed is more than %s[%d] = %g", place, i,
                  places[i], place, i - 1, places[i - 1]);
    check.require(places[i] > places[i - 1], text);
  }
}

// Friction laws beside Coulomb's; unused numbers are checked all the same.
void check_friction(const rp_config &c, checker &check) {
  check.number("friction_reference + friction_change", c.friction_reference + c.friction_change,
               friction);
  check_points("friction_points", c.friction_points, "friction_position", c.friction_position,
               "friction_factor", c.friction_factor, config_range::friction_factor, check);
  check_points("friction_along_points", c.friction_along_points, "friction_along_position",
               c.friction_along_position, "friction_along_factor", c.friction_along_factor,
               config_range::friction_along_factor, check);
  check.require(c.friction_along_points == 0 || c.kind != RP_PATCH,
                "friction_along_points must be 0 for kind = patch: it has no place along a track");
  check.require(c.friction_memory_distance > 0 ||
                    c.friction_memory_speed == config_start::friction_memory_speed,
                "friction_memory_speed must be 0.001 with friction_memory_distance = 0: nothing is "
                "remembered");
  if (check.error() != RP_OK || !has_tangential(c)) return;
  double least = c.friction_kinetic;
  for (double amplitude : c.friction_amplitude) least += std::min(amplitude, 0.0);
  check.require(least >= 0,
                "friction_kinetic with negative friction_amplitude: the law falls below 0");
  const bool grid = c.tangential == RP_TANGENTIAL_FULL && c.fitted[0] == 0;
  check_law_of_theory(c, grid, check);
  check.require(c.friction_points == 0 || grid,
                "friction_points must be 0 but with tangential = full and no fitted rows");
  check.require(c.friction_law != RP_TEMPERATURE || c.friction_memory_distance == 0,
                "friction_memory_distance must be 0 with friction_law = temperature");
  check.require(c.friction_law != RP_COULOMB || c.friction_memory_distance == 0,
                "friction_memory_distance must be 0 with friction_law = coulomb");
  check.require(c.friction_law != RP_TEMPERATURE || c.temperature == 1,
                "friction_law = temperature needs temperature = 1");
  check.require(c.friction_law == RP_COULOMB || c.regime != RP_SHIFT,
                "friction_law must be coulomb with regime = shift: it has no speed");
}

void check_plastic(const rp_config &c, checker &check) {
  check_points("hardening_points", c.hardening_points, "hardening_displacement",
               c.hardening_displacement, "hardening_stress", c.hardening_stress,
               config_range::hardening_stress, check);
  if (c.hardening_points > 0 && check.error() == RP_OK) {
    check.number("hardening_displacement[0]", c.hardening_displacement[0], {0, 0, false, false});
    check.require(c.layer_yield_stress == c.hardening_stress[0],
                  "layer_yield_stress must equal hardening_stress[0]");
  }
  if (!has_tangential(c) || !(c.layer_yield_stress > 0)) return;
  check.require(c.tangential == RP_TANGENTIAL_FULL && c.fitted[0] == 0,
                "layer_yield_stress must be 0 but with tangential = full and no fitted rows");
}

void check_temperature(const rp_config &c, checker &check) {
  if (c.temperature == 0 || check.error() != RP_OK) return;
  check.require(c.regime == RP_STEADY_ROLLING || c.regime == RP_TRANSIENT_ROLLING,
                "temperature needs regime = steady_rolling or transient_rolling");
  check.require(c.tangential == RP_TANGENTIAL_FULL && c.fitted[0] == 0,
                "temperature needs tangential = full and no fitted rows");
}

// What a build without further physics cannot solve.
void check_build(const rp_config &c, checker &check) {
  if (has_physics || !has_tangential(c) || check.error() != RP_OK) return;
  const auto without = [&](bool asked, const char *text) { check.require(!asked, text); };
  without(
      c.regime != RP_STEADY_ROLLING || c.regime_changes != 0,
      "regime must be none or steady_rolling: this build has no shift and no transient rolling");
  without(c.friction_law != RP_COULOMB,
          "friction_law must be coulomb: this build has no other friction laws");
  without(c.layer_yield_stress > 0,
          "layer_yield_stress must be 0: this build has no plastic layers");
  without(c.temperature != 0, "temperature must be 0: this build has no surface temperature");
  without(c.fluid_model != RP_FLUID_NONE, "fluid_model must be none: this build has no liquids");
  without(is_coupled(combine(c.shear_modulus, c.poisson_ratio)),
          "shear_modulus and poisson_ratio: (1-2nu)/G must be equal, this build has no coupling of "
          "normal and tangential directions");
}

void check_prescribed(const rp_config &c, checker &check) {
  if (c.force_prescribed[0] == 0 && c.force_prescribed[1] == 0) return;
  check.require(c.kind == RP_PATCH, "force_prescribed must be 0, 0 but for kind = patch");
  check.require(has_tangential(c) && c.tangential == RP_TANGENTIAL_FULL,
                "force_prescribed needs a regime of motion and tangential = full");
}

// Where creep forces come from a table.
void check_table(const rp_config &c, checker &check) {
  if (!uses_table(c)) return;
  const bool line = c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
  check.require(!line, "a creep table has no line contact: use tangential = full");
  check.require(!(c.layer_thickness > 0),
                "a creep table has no third-body layer: use tangential = full");
  if (check.error() != RP_OK) return;
  const char *defect = creep_table_defect(c.creep_table, c.creep_table_size);
  if (!defect) return;
  char text[RP_MESSAGE_SIZE];
  std::snprintf(text, sizeof text, "creep_table %s", defect);
  check.require(false, text);
}

// Results that are to be as accurate as asked for, by estimates and finer grids.
void check_accuracy(const rp_config &c, checker &check) {
  check.require(c.finer_grids == 0 || c.accuracy > 0,
                "finer_grids must be 0 without accuracy: nothing goes on to them");
  if (!(c.accuracy > 0) || !has_tangential(c)) return;
  check.require(c.regime == RP_STEADY_ROLLING,
                "accuracy must be 0 but in steady rolling: other steps keep their grid");
  if (c.finer_grids == 0) return;
  check.require(c.tangential != RP_TANGENTIAL_TABLE || c.fitted[0] > 0,
                "finer_grids with a creep table need fitted: the full theory's nodes and rows");
  check.require(!needs_grid(c) || c.element_size[0] == 0,
                "finer_grids need elements in place of element_size: grids of any number");
}

void check_grid(const rp_config &c, checker &check) {
  check_fitted(c, check);
  if (!needs_grid(c)) return;
  const bool counted = c.elements[0] != 0 || c.elements[1] != 0;
  const bool sized = c.element_size[0] != 0 || c.element_size[1] != 0;
  const bool shaped = c.kind == RP_PATCH && c.geometry == RP_UNDEFORMED_DISTANCE;
  check.require(counted != sized, "exactly one of elements and element_size must be given");
  check.require(!shaped || sized, "undeformed_distance needs element_size");
  check.require(!shaped || (c.max_elements[0] == 0 && c.max_elements[1] == 0),
                "max_elements must be 0 with undeformed_distance: distance_shape is the grid");
  for (int k = 0; k < 2; ++k) {
    const bool line = k == 1 && c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
    if (counted)
      check.field(k == 0 ? "elements[0]" : "elements[1]", c.elements[k],
                  line ? only_one : config_range::elements);
    if (sized && !line)
      check.field(k == 0 ? "element_size[0]" : "element_size[1]", c.element_size[k],
                  config_range::element_size);
    check.field(k == 0 ? "max_elements[0]" : "max_elements[1]", c.max_elements[k],
                config_range::max_elements);
  }
  // theories that take the shape of rows by parabolas need three elements either way, which grids
  // of other sizes always have
  const bool by_parabolas = takes_rows(c.normal);
  for (int k = 0; k < 2; ++k)
    check.require(!by_parabolas || c.max_elements[k] == 0 || c.max_elements[k] > 2,
                  "max_elements must be 0 or at least 3 with normal = kik_piotrowski, "
                  "kik_piotrowski_corrected and analyn");
  check.require(!counted || (c.max_elements[0] == 0 && c.max_elements[1] == 0),
                "max_elements must be 0 with elements: it is a capacity for element_size");
}

// Grids of one or two elements either way have no shape across by which other theories go.
void check_strips(const rp_config &c, checker &check) {
  if (!has_strips(c)) return;
  const char *wrong = nullptr;
  if (c.normal != RP_NORMAL_HALF_SPACE)
    wrong =
        "distance_shape, of undeformed_distance, must be at least 3 either way "
        "but with normal = half_space";
  else if (has_tangential(c) && (c.tangential != RP_TANGENTIAL_FULL || c.fitted[0] > 0))
    wrong =
        "distance_shape, of undeformed_distance, must be at least 3 either way but with "
        "tangential = full and no fitted rows";
  else if (c.fluid_model != RP_FLUID_NONE)
    wrong =
        "distance_shape, of undeformed_distance, must be at least 3 either way "
        "with fluid_model";
  else if (c.accuracy > 0)
    wrong =
        "distance_shape, of undeformed_distance, must be at least 3 either way with accuracy: "
        "there is no error estimate";
  else if (c.derivatives != 0)
    wrong =
        "distance_shape, of undeformed_distance, must be at least 3 either way "
        "with derivatives";
  check.require(wrong == nullptr, wrong ? wrong : "");
}

void check_patch(const rp_config &c, checker &check) {
  if (c.geometry == RP_SEMI_AXES) check.field("semi_axes", c.semi_axes, config_range::semi_axes);
  if (c.geometry == RP_CURVATURES)
    check.field("curvatures", c.curvatures, config_range::curvatures);
  if (c.geometry == RP_LINE_CONTACT) {
    check.field("line_contact_radius", c.line_contact_radius, config_range::line_contact_radius);
    check.field("width", c.width, config_range::width);
    check.require(c.load == RP_FORCE, "a line contact has no approach: give normal_force");
    check.require(c.normal == RP_NORMAL_HERTZ || c.normal == RP_NORMAL_HALF_SPACE,
                  "a line contact needs normal = hertz or half_space");
  }
  if (c.geometry != RP_UNDEFORMED_DISTANCE) return;
  check.require(c.undeformed_distance != nullptr, "undeformed_distance is null");
  check.require(c.normal != RP_NORMAL_HERTZ,
                "undeformed_distance needs normal = half_space, kik_piotrowski, "
                "kik_piotrowski_corrected or analyn: Hertz takes quadratic shapes only");
  check.field("distance_shape", c.distance_shape, config_range::distance_shape);
  if (check.error() == RP_OK)
    check.numbers("undeformed_distance", c.undeformed_distance,
                  c.distance_shape[0] * c.distance_shape[1], {-1, 1, false, false});
  if (check.error() == RP_OK) check_strips(c, check);
}

// Temperatures of a step; NaN stands for the config's.
void check_bulk(const rp_config &c, const rp_input &in, checker &check) {
  double step[2];
  for (int k = 0; k < 2; ++k) {
    const bool given = !std::isnan(in.bulk_temperature[k]);
    step[k] = given ? in.bulk_temperature[k] : c.bulk_temperature[k];
    check.require(!given || c.temperature == 1,
                  "bulk_temperature must be left NaN in a scene without temperature");
    check.require(!given || c.bulk_mass[k] == 0,
                  "bulk_temperature must be left NaN of a body with bulk_mass");
  }
  check.field("bulk_temperature", step, input_range::bulk_temperature);
  const bool stores = c.bulk_mass[0] > 0 || c.bulk_mass[1] > 0;
  const bool exchanges =
      c.heat_exchange == 1 || stores || c.bulk_temperature[0] != c.bulk_temperature[1];
  check.require(exchanges || step[0] == step[1],
                "bulk_temperature (temperature.wheel, temperature.rail) must be equal in a scene "
                "where both are, unless heat flows between the bodies (temperature.exchange)");
}

// Where the normal force follows from the approach, only the solve can tell what friction carries.
void check_force(const rp_config &c, double friction, const rp_input &in, checker &check) {
  for (int k = 0; k < 2; ++k) {
    const range none{0, 0, false, false};
    if (c.force_prescribed[k])
      check.number(k == 0 ? "creepage[0], found from tangential_force,"
                          : "creepage[1], found from tangential_force,",
                   in.creepage[k], none);
    else
      check.number(k == 0 ? "tangential_force[0], not in force_prescribed,"
                          : "tangential_force[1], not in force_prescribed,",
                   in.tangential_force[k], none);
  }
  if (c.force_prescribed[0] == 0 && c.force_prescribed[1] == 0) return;
  check.number("rolling_speed, with a prescribed tangential_force,", in.rolling_speed, positive);
  if (c.load == RP_FORCE)
    check.number("tangential_force, by the friction coefficient times normal_force, in magnitude",
                 hypot(in.tangential_force[0], in.tangential_force[1]),
                 {0, most_friction(c, friction) * in.normal_force * (1.0 + 1e-12), false, false});
}

// Bodies whose pressure and traction act on each other.
void check_coupled(const rp_config &c, checker &check) {
  if (!is_coupled(combine(c.shear_modulus, c.poisson_ratio))) return;
  check.require(
      c.normal == RP_NORMAL_HALF_SPACE && c.tangential == RP_TANGENTIAL_FULL && c.fitted[0] == 0,
      "shear_modulus and poisson_ratio: bodies with (1-2nu)/G not equal couple normal and "
      "tangential directions, which needs normal = half_space, tangential = full and no fitted "
      "rows");
  // what heats the material before depends on a contact area that is only being found
  check.require(c.friction_law != RP_TEMPERATURE || c.regime == RP_STEADY_ROLLING,
                "friction_law = temperature with bodies with (1-2nu)/G not equal needs regime = "
                "steady_rolling");
}

}  // namespace

bool needs_grid(const rp_config &c) {
  if (c.kind != RP_PATCH || c.normal != RP_NORMAL_HERTZ || c.regime == RP_REGIME_NONE) return true;
  if (c.tangential == RP_TANGENTIAL_FULL) return c.fitted[0] == 0;
  return !is_fast(c.tangential) || has_tractions(c.tangential);
}

bool uses_table(const rp_config &c) {
  return c.regime != RP_REGIME_NONE && c.tangential == RP_TANGENTIAL_TABLE;
}

bool has_shape(const rp_config &c) {
  const auto any = [](const int32_t count[2]) { return count[0] > 0 || count[1] > 0; };
  return any(c.runout_count) || any(c.rail_height_count);
}

void set_message(rp_message *message, const char *format, ...) {
  if (!message) return;
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message->text, sizeof message->text, format, arguments);
  va_end(arguments);
}

rp_error check_config(const rp_config &c, rp_message *message) {
  if (c.cookie != config_cookie) {
    set_message(message, "the config was never filled by rp_default_config");
    return RP_ERROR_NOT_DEFAULTED;
  }
  checker check(message);
  check_ranges(c, case_part::always, check);
  if (check.error() != RP_OK) return check.error();
  check_ranges(c, c.kind == RP_PATCH ? case_part::patch : case_part::wheels, check);
  if (check.error() != RP_OK) return check.error();
  check_grid(c, check);
  check_spin_offset(c, check);
  check_prescribed(c, check);
  check_table(c, check);
  check_friction(c, check);
  check_plastic(c, check);
  check_temperature(c, check);
  check_stored_heat(c, check);
  check_regime(c, check);
  check_accuracy(c, check);
  check_fluid(c, check);
  check_balance(c, check);
  check_max_work(c, check);
  check_viscous(c, check);
  check_own_influence(c, check);
  check_build(c, check);
  if (c.layer_thickness > 0)
    check.field("layer_shear_modulus", c.layer_shear_modulus, config_range::layer_shear_modulus);
  const bool rolling = has_tangential(c);
  const bool fast = is_fast(c.tangential);
  check_fast(c, check);
  const bool line = c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
  check.require(!(rolling && fast && line),
                "a fast theory has no line contact: use tangential = full");
  check.require(!(rolling && fast && c.layer_thickness > 0),
                "a fast theory has no third-body layer: use tangential = full");
  if (rolling && check.error() == RP_OK) check_coupled(c, check);
  if (check.error() == RP_OK) check_reference(c, check);
  c.kind == RP_PATCH ? check_patch(c, check) : check_wheels(c, check);
  return check.error();
}

double most_friction(const rp_config &c, double coefficient) {
  double most = coefficient;
  if (c.friction_law == RP_TEMPERATURE)
    most = std::max(c.friction_reference, c.friction_reference + c.friction_change);
  if (c.friction_law == RP_SLIP_VELOCITY) {
    most = c.friction_kinetic;
    for (double amplitude : c.friction_amplitude) most += std::max(amplitude, 0.0);
  }
  if (c.fluid_model != RP_FLUID_NONE) {
    if (!std::isnan(c.fluid_boundary_friction)) most = std::max(most, c.fluid_boundary_friction);
    if (c.fluid_eyring_stress > 0) most = std::max(most, c.fluid_limiting_friction);
  }
  const auto greatest = [](const double *factor, int points) {
    return points == 0 ? 1.0 : *std::max_element(factor, factor + points);
  };
  return most * greatest(c.friction_factor, c.friction_points) *
         greatest(c.friction_along_factor, c.friction_along_points);
}

rp_error check_friction_coefficient(double value, rp_message *message) {
  checker check(message);
  check.number("friction_coefficient", value, friction);
  return check.error();
}

rp_error check_input(const rp_config &c, double friction_coefficient, const rp_input &in,
                     rp_message *message) {
  if (in.cookie != input_cookie) {
    set_message(message, "the input was never filled by rp_default_input");
    return RP_ERROR_NOT_DEFAULTED;
  }
  checker check(message);
  check_bulk(c, in, check);
  check_fluid(c, in, check);
  for (const double scale : in.friction_scale) {
    check.number("friction_scale", scale, input_range::friction_scale);
    check.require(has_tangential(c) || scale == 1,
                  "friction_scale must be 1 in a scene without a tangential problem");
  }
  check_slip_field(c, in, check);
  check.require(in.friction_coefficient == 0,
                "friction_coefficient must be 0 in a step: rp_set_friction_coefficient sets it");
  if (c.kind == RP_PATCH) {
    if (c.load == RP_FORCE)
      check.field("normal_force", in.normal_force, input_range::normal_force);
    else
      check.field("approach", in.approach, input_range::approach);
    check_ranges(in, case_part::patch, check);
    check_step_regime(c, in, check);
    if (regime_of(c, in) == RP_TRANSIENT_ROLLING)
      check.field("distance", in.distance, input_range::distance);
    check.require(in.direction == 1 || in.direction == -1, "direction must be 1 or -1");
    check_force(c, friction_coefficient * in.friction_scale[RP_RIGHT], in, check);
    return check.error();
  }
  if (c.load == RP_FORCE)
    check.field("vertical_force", in.vertical_force, input_range::vertical_force);
  else
    check.field("z", in.z, input_range::z);
  check_ranges(in, case_part::wheels, check);
  check_step_regime(c, in, check);
  check.require(c.axle_free == 1 || in.axle_torque == 0,
                "axle_torque must be 0 with axle_free = 0");
  check.require(c.longitudinal_prescribed == 1 || in.longitudinal_force == 0,
                "longitudinal_force must be 0 with longitudinal_prescribed = 0");
  const bool finds_rate = c.axle_free == 1 || c.longitudinal_prescribed == 1;
  const bool turns = c.track == RP_ROLLER && in.roller_pitch_rate != 0;
  check.require(!finds_rate || in.speed != 0 || turns,
                c.track == RP_ROLLER
                    ? "speed or roller_pitch_rate must not be 0 where pitch_rate is free or found: "
                      "nothing rolls"
                    : "speed must not be 0 where pitch_rate is free or found: nothing rolls");
  const bool rolls_on = regime_of(c, in) == RP_TRANSIENT_ROLLING && has_tangential(c);
  check.number("time_step", in.time_step, rolls_on ? positive : input_range::time_step);
  for (const auto &rotation : in.rail_rotation)
    check.require(rotation[1] == 0 && rotation[2] == 0,
                  "rail_rotation about y and z must be 0: this version turns rails and rollers "
                  "about x only");
  return check.error();
}

rp_error check_direction(const rp_input &d, rp_message *message) {
  if (d.cookie != input_cookie) {
    set_message(message, "the direction was never filled by rp_default_direction");
    return RP_ERROR_NOT_DEFAULTED;
  }
  checker check(message);
  rp_input usual;
  rp_default_input(&usual);
  bool without[input_numbers];  // a number in the config instead
  int count = 0, next = 0;
  for_each_number(usual,
                  [&](const char *, const double &v, double) { without[count++] = std::isnan(v); });
  for_each_number(d, [&](const char *name, const double &value, double) {
    if (!(without[next++] && std::isnan(value))) check.number(name, value, finite);
  });
  return check.error();
}

}  // namespace railpatch
