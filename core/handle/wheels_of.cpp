// The wheels' part of a scene.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "handle/scene_of.hpp"

namespace railpatch {

namespace {

profile_view checked_view(const rp_profile &p, const char *field) {
  if (!p.arc_length || !p.y || !p.z || !p.dy || !p.dz) throw profile_error{field, "is not given"};
  const profile_view view{p.arc_length, p.y, p.z, p.dy, p.dz, p.count};
  if (const profile_fault fault = validate(view); fault != profile_fault::none)
    throw profile_error{field, text(fault)};
  return view;
}

// Profiles of a rail along the track or of a wheel round it; none where it has one profile.
std::vector<profile_view> sections_of(const rp_profile *given, const double *places, int count,
                                      bool by_knot, const char *field) {
  std::vector<profile_view> views;
  if (count == 0) return views;
  if (!given || !places) throw profile_error{field, "are null"};
  const char *apart = by_knot ? "must have as many knots"
                              : "must have as many knots at the same shares of the arc length";
  for (int k = 0; k < count; ++k) {
    views.push_back(checked_view(given[k], field));
    if (!profile_sections::belong_together(views.front(), views.back(), by_knot))
      throw profile_error{field, apart};
  }
  return views;
}

// Of several sections one that a profile is made for: the first, or where lengths differ the
// longest.
profile_view largest(const std::vector<profile_view> &sections, bool by_knot) {
  const auto shorter = [](const profile_view &a, const profile_view &b) {
    return a.s[a.n - 1] - a.s[0] < b.s[b.n - 1] - b.s[0];
  };
  return by_knot ? *std::max_element(sections.begin(), sections.end(), shorter) : sections.front();
}

// Both rails lean inwards by the same cant; a right-hand curve is a left-hand one in the mirror.
track_config track_of(const rp_config &c, int side) {
  const bool placed = !std::isnan(c.rail_origin_y[side]);
  const double y = placed ? c.rail_origin_y[side] : 0.0;
  return {c.track == RP_ROLLER ? track_kind::roller : track_kind::rail,
          c.gauge + c.gauge_widening,
          c.gauge_height,
          c.cant,
          side == RP_LEFT ? -c.curvature : c.curvature,
          c.roller_radius,
          placed,
          side == RP_LEFT ? -y : y,
          placed ? c.rail_origin_z[side] : 0.0};
}

wheel_setup wheel_of(const rp_config &c, int side) {
  wheel_setup setup;
  setup.side = side;
  const bool left = side == RP_LEFT;
  const bool by_knot = c.section_match == RP_SECTIONS_BY_KNOT;
  const bool cubic = c.section_blend == RP_SECTIONS_CUBIC;
  setup.along = {by_knot, cubic, 0, c.section_kink[side]};
  setup.around = {by_knot, cubic, 2 * std::numbers::pi, c.wheel_section_kink[side]};
  setup.sections =
      sections_of(c.rail_sections[side], c.section_position[side], c.section_count[side], by_knot,
                  left ? "rail_sections[0]" : "rail_sections[1]");
  setup.wheel_sections =
      sections_of(c.wheel_sections[side], c.wheel_section_angle[side], c.wheel_section_count[side],
                  by_knot, left ? "wheel_sections[0]" : "wheel_sections[1]");
  setup.section_position = c.section_position[side];
  setup.wheel_section_angle = c.wheel_section_angle[side];
  setup.wheel = !setup.wheel_sections.empty()
                    ? largest(setup.wheel_sections, by_knot)
                    : checked_view(c.wheel[side], left ? "wheel_left" : "wheel_right");
  setup.rail = !setup.sections.empty()
                   ? largest(setup.sections, by_knot)
                   : checked_view(c.rail[side], left ? "rail_left" : "rail_right");
  setup.shape = {c.runout[side],      c.runout_count[side],
                 c.rail_height[side], c.rail_height_count[side],
                 c.rail_height_start, c.rail_height_spacing};
  setup.sizes = {c.nominal_radius, c.flange_back_distance, c.flange_back_position,
                 c.standstill_speed, c.patch_rule == RP_PATCHES_BLENDED};
  setup.track = track_of(c, side);
  setup.rules.blended = c.patch_rule == RP_PATCHES_BLENDED;
  setup.rules.inclined = c.contact_frame == RP_FRAME_INCLINED;
  setup.max_patches = c.max_patches;
  setup.round_and_rigid = setup.sections.empty() && setup.wheel_sections.empty() &&
                          !setup.shape.given() && c.reference_surface == RP_REFERENCE_PLANE &&
                          !has_support(c);
  return setup;
}

}  // namespace

bool has_support(const rp_config &c) {
  return c.kind != RP_PATCH && (c.rail_stiffness[0] > 0 || c.rail_stiffness[1] > 0);
}

bool is_balanced(const rp_config &c) { return c.roll_balanced != 0 || finds_pitch_rate(c); }

bool finds_pitch_rate(const rp_config &c) {
  return c.axle_free != 0 || c.longitudinal_prescribed != 0;
}

wheels_setup wheels_of(const rp_config &c, const patch_scene &scene) {
  wheels_setup setup;
  for (int side = 0; side < 2; ++side)
    if (c.kind == RP_WHEELSET || side == c.side) setup.wheel.push_back(wheel_of(c, side));
  setup.max_patches = c.max_patches;
  setup.force_given = c.load == RP_FORCE;
  setup.tolerance = c.tolerance;
  setup.most_work = c.max_work;
  setup.nominal_radius = c.nominal_radius;
  setup.whole_forces = c.patch_rule != RP_PATCHES_CONTACT || c.contact_frame == RP_FRAME_INCLINED;
  if (is_balanced(c))
    setup.balance = balance_setup{c.roll_balanced != 0,
                                  finds_pitch_rate(c),
                                  c.longitudinal_prescribed != 0,
                                  0.5 * c.gauge,
                                  c.track == RP_ROLLER ? c.roller_radius : 0.0,
                                  std::max(c.standstill_speed, 1e-3)};
  if (c.friction_along_points > 0)
    setup.friction_along = friction_factor(c.friction_along_points, c.friction_along_position,
                                           c.friction_along_factor);
  if (has_support(c))
    setup.support = support_setup{static_cast<int>(setup.wheel.size()),
                                  {c.rail_stiffness[0], c.rail_stiffness[1]},
                                  {c.rail_damping[0], c.rail_damping[1]},
                                  c.tolerance,
                                  scene.modulus(),
                                  0.5 * c.nominal_radius};
  if (c.bulk_mass[0] > 0 || c.bulk_mass[1] > 0) {
    bulk_setup &bulk = setup.bulk.emplace();
    for (int k = 0; k < 2; ++k) {
      bulk.capacity[k] = c.bulk_mass[k] * c.heat_capacity[k];
      bulk.conductance[k] = c.air_conductance[k];
      bulk.start[k] = c.bulk_temperature[k];
    }
    bulk.air = c.air_temperature;
  }
  return setup;
}

}  // namespace railpatch
