// Checks of wheels on rails and rollers.
#include <cmath>
#include <numbers>

#include "geometry/longitudinal_shape.hpp"
#include "half_space/coupling.hpp"
#include "half_space/physics.hpp"
#include "handle/checker.hpp"
#include "handle/scene_of.hpp"

namespace railpatch {

namespace {

// Profiles' places along the track or round a wheel; the profiles themselves are looked at where
// they are read.
void check_places(const char *name, const double *place, int count, const range &allowed,
                  checker &check) {
  for (int k = 0; k < count; ++k) {
    check.number(name, place[k], allowed);
    if (k > 0) check.number(name, place[k], {place[k - 1], inf, true, true});
  }
}

void check_sections(const rp_config &c, checker &check) {
  for (int side = 0; side < 2; ++side) {
    const bool left = side == RP_LEFT;
    if (c.kind == RP_WHEEL_RAIL && side != c.side) continue;
    if (const int count = c.section_count[side]; count > 0 && check.error() == RP_OK) {
      const double *place = c.section_position[side];
      check.require(
          c.rail_sections[side] != nullptr && place != nullptr,
          "rail_sections and section_position must be given where section_count is not 0");
      if (check.error() != RP_OK) return;
      check_places(left ? "section_position[0]" : "section_position[1]", place, count, finite,
                   check);
    }
    if (const int count = c.wheel_section_count[side]; count > 0 && check.error() == RP_OK) {
      const double *angle = c.wheel_section_angle[side];
      check.require(c.wheel_sections[side] != nullptr && angle != nullptr,
                    "wheel_sections and wheel_section_angle must be given where "
                    "wheel_section_count is not 0");
      if (check.error() != RP_OK) return;
      check_places(left ? "wheel_section_angle[0]" : "wheel_section_angle[1]", angle, count,
                   {0, 2 * std::numbers::pi, false, true}, check);
    }
  }
}

// A rail by the place of its profile's origin.
void check_origin(const rp_config &c, checker &check) {
  for (int side = 0; side < 2; ++side) {
    const bool y = !std::isnan(c.rail_origin_y[side]), z = !std::isnan(c.rail_origin_z[side]);
    check.require(y == z, "rail_origin_y and rail_origin_z must both be given, or neither");
    if (!y) continue;
    check.require(c.track == RP_RAIL, "rail_origin_y must be left out on rollers");
    check.field(side == RP_LEFT ? "rail_origin_y[0]" : "rail_origin_y[1]", c.rail_origin_y[side],
                config_range::rail_origin_y);
    check.field(side == RP_LEFT ? "rail_origin_z[0]" : "rail_origin_z[1]", c.rail_origin_z[side],
                config_range::rail_origin_z);
  }
}

}  // namespace

void check_reference(const rp_config &c, checker &check) {
  if (c.reference_surface == RP_REFERENCE_PLANE) return;
  const char *wrong = nullptr;
  if (c.kind == RP_PATCH)
    wrong = "reference_surface must be plane with kind = patch: its shape has no normals";
  else if (c.normal != RP_NORMAL_HALF_SPACE)
    wrong = "reference_surface = curved needs normal = half_space";
  else if (has_tangential(c) && c.tangential != RP_TANGENTIAL_FULL)
    wrong = "reference_surface = curved needs tangential = full or none";
  else if (c.fitted[0] > 0)
    wrong = "reference_surface = curved needs fitted = 0, 0";
  else if (has_tangential(c) && is_coupled(combine(c.shear_modulus, c.poisson_ratio)))
    wrong = "reference_surface = curved needs bodies with equal (1-2nu)/G";
  else if (has_shape(c))
    wrong = "reference_surface = curved needs wheels without runout and rails without rail_height";
  else if (!has_physics)
    wrong = "reference_surface must be plane: this build has no curved ones";
  check.require(wrong == nullptr, wrong ? wrong : "");
}

namespace {

// Out-of-round wheels and running surfaces that are not level.
void check_longitudinal(const rp_config &c, checker &check) {
  const auto values = [&](const char *name, int side, const double *v, int32_t count,
                          const range &counts) {
    char label[40];
    std::snprintf(label, sizeof label, "%s_count[%d]", name, side);
    if (count != 0) check.field(label, count, counts);
    std::snprintf(label, sizeof label, "%s[%d]", name, side);
    if (count == 0 || check.error() != RP_OK) return;
    char text[80];
    std::snprintf(text, sizeof text, "%s is null", label);
    check.require(v != nullptr, text);
    if (check.error() == RP_OK) check.numbers(label, v, count, {-0.1, 0.1, false, false});
  };
  bool shaped = false, heights = false;
  for (int side = 0; side < 2; ++side) {
    values("runout", side, c.runout[side], c.runout_count[side], config_range::runout_count);
    values("rail_height", side, c.rail_height[side], c.rail_height_count[side],
           config_range::rail_height_count);
    heights |= c.rail_height_count[side] > 0;
    shaped |= c.runout_count[side] > 0 || heights;
  }
  check.require(!heights || c.track == RP_RAIL, "rail_height_count must be 0 on rollers");
  check.require(!shaped || c.reference_surface == RP_REFERENCE_PLANE,
                "runout and rail_height need reference_surface = plane in this version");
  check.require(!shaped || c.normal == RP_NORMAL_HALF_SPACE,
                "runout and rail_height need normal = half_space: the shape is not quadratic");
}

}  // namespace

void check_stored_heat(const rp_config &c, checker &check) {
  if (check.error() != RP_OK) return;
  for (int k = 0; k < 2; ++k)
    check.require(c.air_conductance[k] == 0 || c.bulk_mass[k] > 0,
                  "air_conductance must be 0 of a body with bulk_mass = 0");
  if (c.bulk_mass[0] == 0 && c.bulk_mass[1] == 0) return;
  check.require(c.temperature == 1, "bulk_mass needs temperature = 1");
  check.require(c.kind != RP_PATCH,
                "bulk_mass needs kind = wheel_rail or wheelset: a patch has no time");
  check.require(c.regime == RP_STEADY_ROLLING, "bulk_mass needs regime = steady_rolling");
}

void check_balance(const rp_config &c, checker &check) {
  const bool wheelset = c.kind == RP_WHEELSET;
  check.require(c.roll_balanced == 0 || wheelset,
                "roll_balanced needs kind = wheelset: one wheel alone has a roll moment");
  check.require(c.axle_free == 0 || c.kind != RP_PATCH,
                "axle_free needs kind = wheel_rail or wheelset");
  check.require(c.longitudinal_prescribed == 0 || c.kind != RP_PATCH,
                "longitudinal_prescribed needs kind = wheel_rail or wheelset");
  check.require(
      c.longitudinal_prescribed == 0 || c.axle_free == 0,
      "longitudinal_prescribed must be 0 with axle_free: one of them says the pitch rate");
  check.require(
      c.axle_free == 0 || has_tangential(c),
      "axle_free needs a tangential problem: without creep forces nothing turns the axle");
  check.require(c.longitudinal_prescribed == 0 || has_tangential(c),
                "longitudinal_prescribed needs a tangential problem: without it there is no force");
}

void check_max_work(const rp_config &c, checker &check) {
  if (c.max_work == 0) return;
  check.require(c.kind != RP_PATCH && c.load == RP_FORCE,
                "max_work must be 0 but with wheels under a vertical force: no height is searched");
  check.require(!has_support(c),
                "max_work must be 0 with rail_stiffness: the rails' place is part of the search");
  check.require(!is_balanced(c),
                "max_work must be 0 with roll_balanced, axle_free and longitudinal_prescribed");
  check.require(!(c.accuracy > 0), "max_work must be 0 with accuracy: finer grids cost more");
}

void check_wheels(const rp_config &c, checker &check) {
  if (c.track == RP_ROLLER) {
    check.field("roller_radius", c.roller_radius, config_range::roller_radius);
    check.require(c.cant == 0, "cant must be 0 on rollers");
    check.require(c.curvature == 0, "curvature must be 0 on rollers");
  }
  check.require(c.contact_frame == RP_FRAME_TRACK || c.track == RP_ROLLER,
                "contact_frame must be track on rails");
  check.require(c.contact_frame == RP_FRAME_TRACK || c.reference_surface == RP_REFERENCE_PLANE,
                "contact_frame must be track with reference_surface = curved");
  check_sections(c, check);
  check_origin(c, check);
  for (int k = 0; k < 2; ++k) {
    check.require(c.rail_damping[k] == 0 || c.rail_stiffness[k] > 0,
                  "rail_damping must be 0 in a direction whose rail_stiffness is 0: there the rail "
                  "is rigid");
    check.require(c.rail_stiffness[k] == 0 || c.rail_stiffness[k] >= 1,
                  "rail_stiffness must be 0 or at least 1 N/m");
  }
  check_longitudinal(c, check);
}

}  // namespace railpatch
