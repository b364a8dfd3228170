#include "handle/scene_of.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "handle/checker.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// of grids of unlike bodies, over Hertz's contact
constexpr double most_reach = 2.5;
constexpr double wet_reach = 1.6, farthest_inlet = 4.0;
constexpr double viscous_reach = 1.42;  // 2^0.5, and a little

slip_velocity_law slip_law_of(const rp_config &c) {
  slip_velocity_law law;
  law.shape = c.slip_law;
  law.kinetic = c.friction_kinetic;
  for (int i = 0; i < 2; ++i) {
    law.amplitude[i] = c.friction_amplitude[i];
    law.halving_speed[i] = c.friction_halving_speed[i];
  }
  law.memory_distance = c.friction_memory_distance;
  law.memory_speed = c.friction_memory_speed;
  return law;
}

// Where friction is more than Coulomb's, or the layer yields.
std::optional<bound_law> make_law(const rp_config &c) {
  const bool by_velocity = c.friction_law == RP_SLIP_VELOCITY;
  if (!has_physics || (!by_velocity && !(c.layer_yield_stress > 0))) return std::nullopt;
  bound_law law;
  law.by_velocity = by_velocity;
  if (by_velocity) law.slip = slip_law_of(c);
  law.by_magnitude = c.plastic_rule == RP_PLASTIC_MAGNITUDE;
  if (!(c.layer_yield_stress > 0)) return law;
  law.yield = hardening_curve::straight(c.layer_yield_stress, c.layer_hardening);
  if (c.hardening_points == 0) return law;
  law.yield.points = c.hardening_points;
  law.yield.last_slope = 0;
  std::copy_n(c.hardening_displacement, c.hardening_points, law.yield.displacement);
  std::copy_n(c.hardening_stress, c.hardening_points, law.yield.stress);
  return law;
}

// Where temperatures are asked for.
std::optional<heat_scene> make_heat(const rp_config &c) {
  if (c.temperature == 0) return std::nullopt;
  heat_scene heat;
  for (int k = 0; k < 2; ++k)
    heat.bodies.body[k] = {c.conductivity[k], c.heat_capacity[k], c.density[k],
                           c.bulk_temperature[k]};
  const bool stores = c.bulk_mass[0] > 0 || c.bulk_mass[1] > 0;
  heat.exchanges = c.heat_exchange == 1 || heat.bodies.exchanges() || stores;
  heat.by_temperature = c.friction_law == RP_TEMPERATURE;
  heat.law = {c.friction_reference, c.friction_change, c.friction_reference_temperature,
              c.friction_temperature_range};
  heat.depth = c.temperature_depth;
  heat.plastic_fraction = c.plastic_heat_fraction;
  heat.transient = c.regime == RP_TRANSIENT_ROLLING;
  return heat;
}

// Where a liquid is between the bodies.
fluid_scene fluid_of(const rp_config &c) {
  fluid_scene fluid;
  fluid.model = c.fluid_model;
  fluid.share = c.fluid_share;
  fluid.roughness = c.fluid_roughness;
  fluid.own_boundary = !std::isnan(c.fluid_boundary_friction);
  if (fluid.own_boundary) fluid.boundary_friction = c.fluid_boundary_friction;
  fluid.hardness = c.fluid_hardness;
  fluid.mean_pressure = c.fluid_mean_pressure;
  viscosity_law &liquid = fluid.liquid;
  liquid.liquid = c.fluid_liquid;
  liquid.value = c.fluid_viscosity;
  liquid.reference = c.fluid_reference_temperature;
  liquid.slope = c.fluid_roelands_slope;
  liquid.points = c.fluid_viscosity_points;
  for (int i = 0; i < liquid.points; ++i) {
    liquid.temperature[i] = c.fluid_viscosity_temperature[i];
    liquid.logarithm[i] = log(c.fluid_viscosity_value[i]);
  }
  liquid.solids = c.fluid_oxide_content * c.fluid_oxide_exponent;
  fluid.pressure_coefficient = c.fluid_pressure_coefficient;
  fluid.inlet_conductivity = c.fluid_inlet_conductivity;
  fluid.starvation = c.fluid_starvation;
  fluid.eyring_stress = c.fluid_eyring_stress;
  fluid.limiting_friction = c.fluid_limiting_friction;
  fluid.regimes = water_regimes::shipped();
  if (c.fluid_knots > 0) fluid.regimes.count = c.fluid_knots;
  for (int i = 0; i < c.fluid_knots; ++i)
    fluid.regimes.knot[i] = {c.fluid_knot_rate[i],        c.fluid_knot_k_a[i], c.fluid_knot_k_s[i],
                             c.fluid_knot_coefficient[i], c.fluid_knot_a[i],   c.fluid_knot_b[i]};
  fluid.regimes.reference_rate = c.fluid_reference_rate;
  fluid.regimes.recovery = c.fluid_recovery;
  const auto inverse = [](double value) { return value > 0 ? 1.0 / value : 0.0; };
  fluid.paste = {c.fluid_oxide_content, c.fluid_oxide_exponent, inverse(c.fluid_drying_time),
                 inverse(c.fluid_drying_work)};
  return fluid;
}

fast_options fast_of(const rp_config &c, rp_tangential_method theory) {
  fast_options fast;
  fast.theory = theory;
  if (uses_table(c)) fast.creep_table = c.creep_table;
  fast.coefficient_factor = 0.01 * c.percent_kalker;
  fast.bound = c.traction_bound;
  fast.blending = c.flexibility_blending;
  fast.polach = {c.polach_k_a, c.polach_k_s};
  fast.reduction = {c.fastsim_k0, c.fastsim_alpha, c.fastsim_beta};
  if (has_physics && c.friction_law == RP_SLIP_VELOCITY) fast.law.emplace(slip_law_of(c));
  return fast;
}

// Of the way of a step. Of the bodies' own flexibility a quarter errs least (as in vortex
// lattices, where slip is collocated three quarters of an element behind the edge), of a layer's
// none: measured, see docs/physics.md.
double usual_spin_offset(const rp_config &c, const patch_scene &scene) {
  const bool quarter = scene.full_on_grid() && (scene.changes || scene.regime != motion::shift);
  return quarter && !(c.layer_thickness > 0) ? 0.25 : 0.0;
}

double spin_offset_of(const rp_config &c, const patch_scene &scene, bool steady) {
  switch (c.spin_offset) {
    case RP_SPIN_OFFSET_NONE:
      return 0.0;
    case RP_SPIN_OFFSET_SIXTH:
      return 1.0 / 6.0;
    case RP_SPIN_OFFSET_QUARTER:
      return 0.25;
    case RP_SPIN_OFFSET_CONTACT:
      return steady ? 1.0 / 6.0 : 0.0;
    default:
      return usual_spin_offset(c, scene);
  }
}

patch_scene patch_scene_of(const rp_config &c) {
  patch_scene scene;
  scene.elastic = combine(c.shear_modulus, c.poisson_ratio);
  scene.viscous = viscous_bodies_of(c);
  if (c.own_influence != 0)
    scene.own = {c.influence_coefficients, c.distance_shape[0] + 1, c.distance_shape[1]};
  scene.friction_coefficient = c.friction_coefficient;
  if (c.friction_points > 0)
    scene.friction_variation =
        friction_factor(c.friction_points, c.friction_position, c.friction_factor);
  if (c.layer_thickness > 0) scene.layer_flexibility = c.layer_thickness / c.layer_shear_modulus;
  if (c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT) scene.line_width = c.width;
  scene.normal = c.normal;
  scene.tangential = c.regime == RP_REGIME_NONE ? RP_TANGENTIAL_NONE : c.tangential;
  scene.tolerance = scene.normal_tolerance = c.tolerance;
  // the search for z sees the force change only where each force is known better than it asks for
  if (c.kind != RP_PATCH && (c.load == RP_FORCE || has_support(c) || is_balanced(c)))
    scene.normal_tolerance = std::max(0.1 * c.tolerance, 1e-12);
  if (has_support(c) || is_balanced(c)) scene.tolerance = scene.normal_tolerance;
  // with neither nothing is left out, and the method says so
  scene.has_regime = c.regime != RP_REGIME_NONE || c.tangential == RP_TANGENTIAL_NONE;
  scene.max_iterations = c.max_iterations;
  scene.strips = has_strips(c);
  if (scene.tangential == RP_TANGENTIAL_FULL && c.fitted[0] == 0) {
    scene.law = make_law(c);
    scene.changes = c.regime_changes == 1;
    scene.slip_by_element = c.slip_by_element == 1;
    if (c.regime == RP_SHIFT) scene.regime = motion::shift;
    if (c.regime == RP_TRANSIENT_ROLLING) scene.regime = motion::transient;
    scene.moves = c.kind != RP_PATCH;
  }
  scene.heat = make_heat(c);
  if (c.fluid_model != RP_FLUID_NONE && scene.tangential != RP_TANGENTIAL_NONE)
    scene.fluid.emplace(fluid_of(c));
  for (int k = 0; k < 2; ++k) scene.fitted[k] = c.fitted[k];
  for (int k = 0; k < 2; ++k) scene.prescribed[k] = c.force_prescribed[k] != 0;
  scene.spin_offset = spin_offset_of(c, scene, true);
  scene.step_spin_offset = spin_offset_of(c, scene, false);
  scene.usual_spin = scene.spin_offset == usual_spin_offset(c, scene);
  scene.derivatives = c.derivatives != 0;
  scene.stretches = c.kind != RP_PATCH && c.elements[0] > 0;
  scene.curved = c.reference_surface == RP_REFERENCE_CURVED;
  scene.local_normals = c.kind != RP_PATCH && c.patch_rule == RP_PATCHES_BLENDED;
  scene.slopes_along_rows =
      c.track == RP_ROLLER || c.rail_height_count[0] + c.rail_height_count[1] > 0;
  scene.fast = fast_of(c, scene.tangential);
  scene.ask = {c.interrupt, c.interrupt_user};
  scene.exact = (scene.derivatives || is_balanced(c)) && scene.differentiates();
  // by the time of a step the exact ones know nothing
  if (scene.derivatives && scene.fluid && scene.fluid->paste.dries()) scene.exact = false;
  return scene;
}

// Of the contact area of unlike bodies, over Hertz's: tractions shift and stretch it. Full sliding
// is farthest, in plane strain to 1 + 2 e and by (1 - 4 e^2)^-1/2 with tan(pi e) = mu K/(1 - nu)
// (Hills, Nowell and Sackfield 1993, chapter 7).
double reach_of(const rp_config &c, const patch_scene &scene) {
  // the liquid's inlet, sides and outlet
  if (scene.has_ehl()) return wet_reach;
  // with the approach given, hard material touches ahead as far as the bodies overlap
  if (scene.is_viscous()) return c.load == RP_POSITION ? viscous_reach : 1.0;
  const elastic_constants &e = scene.elastic;
  if (scene.tangential != RP_TANGENTIAL_FULL || !is_coupled(e)) return 1.0;
  const double share = atan(most_friction(c, c.friction_coefficient) * std::abs(e.mismatch) /
                            (1.0 - e.poisson_ratio)) /
                       std::numbers::pi;
  // contacts that reach beyond are reported: mu K/(1 - nu) of more than 2
  return std::min(most_reach, (1.0 + 2.0 * share) / std::sqrt(1.0 - 4.0 * share * share));
}

grid_rules grid_rules_of(const rp_config &c, const patch_scene &scene) {
  grid_rules rules;
  rules.sized = c.element_size[0] > 0;
  for (int k = 0; k < 2; ++k) {
    rules.element_size[k] = c.element_size[k];
    rules.elements[k] = c.elements[k];
    rules.most[k] = c.max_elements[k];
  }
  rules.reach = reach_of(c, scene);
  if (scene.has_ehl()) rules.farthest = farthest_inlet;
  rules.corrected = c.normal == RP_NORMAL_KIK_PIOTROWSKI_CORRECTED;
  rules.interpenetrates = (rules.corrected || c.normal == RP_NORMAL_KIK_PIOTROWSKI) &&
                          c.geometry != RP_UNDEFORMED_DISTANCE;
  rules.force_given = c.load == RP_FORCE;
  return rules;
}

// Elements of one patch's grid, with a border of one element that stays free of contact: of a patch
// given directly,
grid_size largest_of_patch(const rp_config &c, const patch_scene &scene, const grid_rules &rules) {
  if (!needs_grid(c)) return {};
  if (c.geometry == RP_UNDEFORMED_DISTANCE) return {c.distance_shape[0], c.distance_shape[1]};
  const bool ellipse = c.geometry == RP_SEMI_AXES;
  const hertz_contact unit = ellipse ? hertz_from_ellipse(c.semi_axes, 1.0, 1.0) : hertz_contact{};
  const auto cells = [&](int k) {
    if (k == 1 && c.geometry == RP_LINE_CONTACT) return 1;
    const auto ahead = [&](int n) { return k == 0 ? rules.ahead_of(n, rules.farthest) : 0; };
    if (!rules.sized) return rules.with_margin(c.elements[k]) + 2 + ahead(c.elements[k]);
    // where nothing says more a square of 128; one row is no burden, and as long as may be asked
    const bool line = c.geometry == RP_LINE_CONTACT;
    int needed = line ? static_cast<int>(config_range::max_elements.high) : 130;
    if (ellipse) {
      const double across = 2.0 * rules.relative_size(unit, k) * c.semi_axes[k];
      const double wanted = std::min(2000.0, std::ceil(across / c.element_size[k]));
      const int n = static_cast<int>(wanted);
      needed = rules.with_margin(n) + 3 + ahead(n);
    }
    if (rules.most[k] == 0) return needed;
    // of an ellipse that stays as it is, but steps that remember have the whole grid
    return ellipse && !scene.keeps_steps() ? std::min(rules.most[k], needed) : rules.most[k];
  };
  return {cells(0), cells(1)};
}

// and of wheel on rail.
grid_size largest_of_wheels(const rp_config &c, const grid_rules &rules) {
  // m; flats and joints touch at both ends
  const double overlap[2] = {has_shape(c) ? 0.120 : 0.060, 0.050};
  const auto cells = [&](int k) {
    if (!rules.sized) return rules.with_margin(c.elements[k]) + 2;
    if (rules.most[k] > 0) return rules.most[k];
    return static_cast<int>(std::clamp(std::ceil(overlap[k] / c.element_size[k]), 16.0, 400.0));
  };
  return {cells(0), cells(1)};
}

// Transform sizes up to a capacity, each about a fifth larger than the one before.
std::vector<int> ladder(int smallest, int largest) {
  std::vector<int> sizes{smooth_size(smallest)};
  while (sizes.back() < largest)
    sizes.push_back(
        std::min(smooth_size(sizes.back() + sizes.back() / 5 + 1), smooth_size(largest)));
  return sizes;
}

// What transforms the convolutions need; closed forms need none.
void set_transforms(const rp_config &c, grid_size largest, scene &made) {
  made.transforms[0] = {2};
  made.transforms[1] = {1};
  if (!made.patch.needs_influence()) return;
  const int n[2] = {2 * largest.nx + 1, largest.ny > 1 ? 2 * largest.ny - 1 : 1};
  const bool by_load = c.geometry == RP_CURVATURES || c.geometry == RP_LINE_CONTACT;
  const bool fixed = made.single && !(by_load && c.element_size[0] > 0) && !made.patch.has_ehl();
  for (int k = 0; k < 2; ++k)
    made.transforms[k] = !fixed     ? ladder(std::min(n[k], 16), n[k])
                         : n[k] > 1 ? std::vector<int>{smooth_size(n[k])}
                                    : std::vector<int>{1};
}

bool all_differentiate(const wheels_setup &wheels) {
  return std::all_of(wheels.wheel.begin(), wheels.wheel.end(),
                     [](const wheel_setup &wheel) { return wheel.differentiates(); });
}

single_patch_setup single_patch_of(const rp_config &c, const patch_scene &scene) {
  single_patch_setup setup;
  setup.geometry = c.geometry;
  setup.force_given = c.load == RP_FORCE;
  std::copy_n(c.semi_axes, 2, setup.semi_axes);
  std::copy_n(c.curvatures, 2, setup.curvatures);
  setup.line_contact_radius = c.line_contact_radius;
  setup.width = c.width;
  setup.has_grid = needs_grid(c);
  setup.grid = grid_rules_of(c, scene);
  setup.largest = largest_of_patch(c, scene, setup.grid);
  if (c.geometry == RP_UNDEFORMED_DISTANCE) setup.distance = c.undeformed_distance;
  return setup;
}

}  // namespace

viscous_bodies viscous_bodies_of(const rp_config &c) {
  viscous_bodies bodies;
  for (int k = 0; k < 2; ++k) {
    bodies.shear_modulus[k] = c.shear_modulus[k];
    bodies.poisson_ratio[k] = c.poisson_ratio[k];
    bodies.ratio[k] = c.viscoelastic_ratio[k];
    bodies.relaxation_time[k] = c.relaxation_time[k];
  }
  return bodies;
}

scene scene_of(const rp_config &c) {
  scene made;
  made.patch = patch_scene_of(c);
  made.marks = {c.observer, c.observer_user};
  made.tolerance = c.tolerance;
  std::copy_n(c.bulk_temperature, 2, made.bulk_temperature);
  grid_size largest;
  if (c.kind == RP_PATCH) {
    largest = made.single.emplace(single_patch_of(c, made.patch)).largest;
  } else {
    const grid_rules rules = grid_rules_of(c, made.patch);
    wheels_setup &wheels = made.wheels.emplace(wheels_of(c, made.patch));
    for (auto &wheel : wheels.wheel) wheel.grid = rules;
    made.patch.exact = made.patch.exact && all_differentiate(wheels);
    for (auto &wheel : wheels.wheel) wheel.keeps_solutions = made.patch.exact;
    wheels.largest = largest = largest_of_wheels(c, rules);
  }
  made.largest = largest;
  set_transforms(c, largest, made);
  return made;
}

}  // namespace railpatch
