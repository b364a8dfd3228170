#include "handle/contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>

#include "handle/check.hpp"
#include "handle/contact_derivative.hpp"
#include "numeric/force_search.hpp"
#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

constexpr int max_searches = 60;
// of grids of unlike bodies: over Hertz's contact, and elements
constexpr double most_reach = 2.5;
constexpr int most_elements = 1000;
// m; below it the squares of the patch's size vanish, and with them all meaning
constexpr double least_approach = 1e-100;

// Where friction is more than Coulomb's, or the layer yields.
std::optional<bound_law> make_law(const rp_config &c) {
  const bool by_velocity = c.friction_law == RP_SLIP_VELOCITY;
  if (!has_physics || (!by_velocity && !(c.layer_yield_stress > 0))) return std::nullopt;
  bound_law law;
  law.by_velocity = by_velocity;
  if (by_velocity) {
    law.slip.kind = static_cast<slip_velocity_law::shape>(c.slip_law);
    law.slip.kinetic = c.friction_kinetic;
    for (int i = 0; i < 2; ++i) {
      law.slip.amplitude[i] = c.friction_amplitude[i];
      law.slip.halving_speed[i] = c.friction_halving_speed[i];
    }
    law.slip.memory_distance = c.friction_memory_distance;
    law.slip.memory_speed = c.friction_memory_speed;
  }
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
  if (c.temperature == 0 || c.tangential == RP_TANGENTIAL_NONE) return std::nullopt;
  heat_scene heat;
  for (int k = 0; k < 2; ++k)
    heat.bodies.body[k] = {c.conductivity[k], c.heat_capacity[k], c.density[k],
                           c.bulk_temperature[k]};
  heat.exchanges = c.heat_exchange == 1 || heat.bodies.exchanges();
  heat.by_temperature = c.friction_law == RP_TEMPERATURE;
  heat.law = {c.friction_reference, c.friction_change, c.friction_reference_temperature,
              c.friction_temperature_range};
  heat.depth = c.temperature_depth;
  heat.plastic_fraction = c.plastic_heat_fraction;
  heat.transient = c.regime == RP_TRANSIENT_ROLLING;
  return heat;
}

patch_scene make_scene(const rp_config &c) {
  patch_scene scene;
  scene.elastic = combine(c.shear_modulus, c.poisson_ratio);
  scene.friction_coefficient = c.friction_coefficient;
  if (c.friction_points > 0) scene.friction_variation = friction_factor(c);
  if (c.layer_thickness > 0) scene.layer_flexibility = c.layer_thickness / c.layer_shear_modulus;
  if (c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT) scene.line_width = c.width;
  scene.normal = c.normal;
  scene.tangential = c.regime == RP_REGIME_NONE ? RP_TANGENTIAL_NONE : c.tangential;
  scene.tolerance = scene.normal_tolerance = c.tolerance;
  // the search for z sees the force change only where each force is known better than it asks for
  if (c.kind != RP_PATCH && (c.load == RP_FORCE || rail_support::asked(c)))
    scene.normal_tolerance = std::max(0.1 * c.tolerance, 1e-12);
  if (rail_support::asked(c)) scene.tolerance = scene.normal_tolerance;
  scene.max_iterations = c.max_iterations;
  if (scene.tangential == RP_TANGENTIAL_FULL && c.fitted[0] == 0) {
    scene.law = make_law(c);
    if (c.regime == RP_SHIFT) scene.regime = motion::shift;
    if (c.regime == RP_TRANSIENT_ROLLING) scene.regime = motion::transient;
    scene.moves = c.kind != RP_PATCH;
  }
  scene.heat = make_heat(c);
  for (int k = 0; k < 2; ++k) scene.fitted[k] = c.fitted[k];
  for (int k = 0; k < 2; ++k) scene.prescribed[k] = c.force_prescribed[k] != 0;
  scene.spin_offset = c.spin_offset == RP_SPIN_OFFSET_SIXTH;
  scene.derivatives = c.derivatives != 0;
  scene.stretches = c.kind != RP_PATCH && c.elements[0] > 0;
  scene.curved = c.reference_surface == RP_REFERENCE_CURVED;
  scene.fast.theory = scene.tangential;
  if (uses_table(c)) scene.fast.creep_table = c.creep_table;
  scene.fast.coefficient_factor = 0.01 * c.percent_kalker;
  scene.fast.bound = c.traction_bound;
  scene.fast.blending = c.flexibility_blending;
  scene.fast.polach = {c.polach_k_a, c.polach_k_s};
  scene.fast.reduction = {c.fastsim_k0, c.fastsim_alpha, c.fastsim_beta};
  return scene;
}

struct capacity {
  int nx, ny;
};

// Half of what a theory's grid must cover along axis k, over Hertz's semi-axis. Kik-Piotrowski
// needs its contact, an ellipse with Hertz's axis ratio and the area pi 0.55 d/sqrt(A B), and the
// interpenetration region it is stretched from; with (a b) that is s^2 times as large, its force at
// equal approach d is s times as large.
double relative_size(const rp_config &c, const hertz_contact &hertz, int k) {
  if (c.normal != RP_NORMAL_KIK_PIOTROWSKI || c.geometry == RP_UNDEFORMED_DISTANCE) return 1.0;
  const double half[2] = {
      std::sqrt(virtual_interpenetration * hertz.approach / hertz.curvatures[0]),
      std::sqrt(virtual_interpenetration * hertz.approach / hertz.curvatures[1])};
  const double size =
      std::sqrt(half[0] / hertz.semi_axes[0]) * std::sqrt(half[1] / hertz.semi_axes[1]);
  // at equal force the approach is smaller, and with it both regions
  const double load = c.load == RP_POSITION ? 1.0 : 1.0 / std::cbrt(size);
  return load * std::max(size, half[k] / hertz.semi_axes[k]);
}

// n elements across Hertz's contact and those to add on either side: tractions of unlike bodies
// shift and stretch the contact area. Full sliding is farthest, in plane strain to 1 + 2 e and by
// (1 - 4 e^2)^-1/2 with tan(pi e) = mu K/(1 - nu) (Hills, Nowell and Sackfield 1993, chapter 7).
int with_margin(const rp_config &c, int n) {
  const elastic_constants e = combine(c.shear_modulus, c.poisson_ratio);
  const bool tangential = c.regime != RP_REGIME_NONE && c.tangential == RP_TANGENTIAL_FULL;
  if (!tangential || !is_coupled(e)) return n;
  const double share = std::atan(most_friction(c, c.friction_coefficient) * std::abs(e.mismatch) /
                                 (1.0 - e.poisson_ratio)) /
                       std::numbers::pi;
  // contacts that reach beyond are reported: mu K/(1 - nu) of more than 2
  const double reach =
      std::min(most_reach, (1.0 + 2.0 * share) / std::sqrt(1.0 - 4.0 * share * share));
  const int wanted = n + 2 * static_cast<int>(std::ceil(0.5 * (reach - 1.0) * n));
  return std::max(n, std::min(wanted, most_elements));
}

// m, of wheel on rail; flats and joints touch at both ends
double overlap_size(const rp_config &c, int k) {
  const bool shaped =
      longitudinal_shape::wanted(c, RP_LEFT) || longitudinal_shape::wanted(c, RP_RIGHT);
  return k == 1 ? 0.050 : shaped ? 0.120 : 0.060;
}

// Elements of one patch's grid, with a border of one element that stays free of contact.
capacity grid_capacity(const rp_config &c) {
  if (!needs_grid(c)) return {0, 0};
  capacity size{c.max_elements[0], c.max_elements[1]};
  const bool sized = c.element_size[0] > 0;
  if (c.kind == RP_PATCH && c.geometry == RP_UNDEFORMED_DISTANCE)
    return {c.distance_shape[0], c.distance_shape[1]};
  const bool ellipse = c.kind == RP_PATCH && c.geometry == RP_SEMI_AXES;
  const hertz_contact unit = ellipse ? hertz_from_ellipse(c.semi_axes, 1.0, 1.0) : hertz_contact{};
  for (int k = 0; k < 2; ++k) {
    int &n = k == 0 ? size.nx : size.ny;
    const bool line = k == 1 && c.kind == RP_PATCH && c.geometry == RP_LINE_CONTACT;
    if (line)
      n = 1;
    else if (!sized)
      n = with_margin(c, c.elements[k]) + 2;
    else if (ellipse)
      n = with_margin(c, static_cast<int>(
                             std::min(2000.0, std::ceil(2.0 * relative_size(c, unit, k) *
                                                        c.semi_axes[k] / c.element_size[k])))) +
          3;
    else if (n == 0)
      // wheel on rail, see above; else a square of 128
      n = c.kind == RP_PATCH ? 130
                             : static_cast<int>(std::clamp(
                                   std::ceil(overlap_size(c, k) / c.element_size[k]), 16.0, 400.0));
  }
  return size;
}

// Transform sizes up to a capacity, each about a fifth larger than the one before.
std::vector<int> ladder(int smallest, int largest) {
  std::vector<int> sizes{smooth_size(smallest)};
  while (sizes.back() < largest)
    sizes.push_back(
        std::min(smooth_size(sizes.back() + sizes.back() / 5 + 1), smooth_size(largest)));
  return sizes;
}

fft_plans make_plans(const rp_config &c) {
  // closed forms need no transforms
  if (!make_scene(c).needs_influence()) return fft_plans({2}, {1});
  const capacity size = grid_capacity(c);
  const int nx = 2 * size.nx + 1, ny = size.ny > 1 ? 2 * size.ny - 1 : 1;
  const bool fixed = c.kind == RP_PATCH && !(c.geometry == RP_CURVATURES && c.element_size[0] > 0);
  const auto top = [](int n) { return n > 1 ? smooth_size(n) : 1; };
  if (fixed) return fft_plans({top(nx)}, {top(ny)});
  return fft_plans(ladder(std::min(nx, 16), nx), ladder(std::min(ny, 16), ny));
}

hertz_contact hertz_of(const rp_config &c, const patch_scene &scene, const rp_input &in) {
  const double modulus = scene.modulus();
  const bool force = c.load == RP_FORCE;
  switch (c.geometry) {
    case RP_SEMI_AXES:
      return force ? hertz_from_ellipse(c.semi_axes, modulus, in.normal_force)
                   : hertz_ellipse_from_approach(c.semi_axes, modulus, in.approach);
    case RP_CURVATURES:
      return force ? hertz_from_force(c.curvatures, modulus, in.normal_force)
                   : hertz_from_approach(c.curvatures, modulus, in.approach);
    case RP_LINE_CONTACT:
      return hertz_line(c.line_contact_radius, c.width, modulus, in.normal_force);
    case RP_UNDEFORMED_DISTANCE:
      break;
  }
  return {};
}

// Grid over the ellipse's bounding box, centred, with one free element around it.
grid hertz_grid(const rp_config &c, const hertz_contact &hertz) {
  grid g;
  if (!needs_grid(c)) return g;
  const bool line = c.geometry == RP_LINE_CONTACT;
  const auto cells = [&](int k, double &size) {
    const double length = 2.0 * relative_size(c, hertz, k) * hertz.semi_axes[k];
    if (c.element_size[0] > 0) {
      size = c.element_size[k];
      const int n = static_cast<int>(std::clamp(std::ceil(length / size - 1e-9), 1.0, 1e6));
      // a grid of given capacity holds what fits
      const int most = k == 0 ? grid_capacity(c).nx : grid_capacity(c).ny;
      return std::max(n + 2, std::min(with_margin(c, n) + 2, most));
    }
    size = length / c.elements[k];
    return with_margin(c, c.elements[k]) + 2;
  };
  g.nx = cells(0, g.dx);
  g.ny = line ? 1 : cells(1, g.dy);
  if (line) g.dy = c.width;
  g.x0 = -0.5 * (g.nx - 1) * g.dx;
  g.y0 = -0.5 * (g.ny - 1) * g.dy;
  return g;
}

}  // namespace

contact::contact(const rp_config &config)
    : config_(config),
      plans_(make_plans(config)),
      solver_(make_scene(config), plans_, grid_capacity(config).nx, grid_capacity(config).ny,
              {config.observer, config.observer_user}) {
  const capacity size = grid_capacity(config);
  if (config.kind == RP_PATCH) {
    memory_.emplace_back(size.nx * size.ny, size.ny, solver_.scene());
    if (config.geometry == RP_UNDEFORMED_DISTANCE) {
      shape_ = aligned_buffer<double>(static_cast<size_t>(size.nx * size.ny));
      std::copy_n(config.undeformed_distance, shape_.size(), shape_.data());
    }
  } else {
    for (int side = 0; side < 2; ++side) {
      if (!has_side(side)) continue;
      wheels_.emplace_back(config, side);
      for (int i = 0; i < config.max_patches; ++i)
        memory_.emplace_back(size.nx * size.ny, size.ny, solver_.scene());
    }
  }
  if (rail_support::asked(config))
    support_ = std::make_unique<rail_support>(config, static_cast<int>(wheels_.size()),
                                              solver_.scene().modulus());
  if (config.kind != RP_PATCH && config.friction_along_points > 0)
    friction_along_ = friction_factor(config.friction_along_points, config.friction_along_position,
                                      config.friction_along_factor);
  scene_ = fingerprint(config, shape_);
  if (config.derivatives != 0) {
    const bool exact = std::all_of(wheels_.begin(), wheels_.end(), [](const wheel_contact &wheel) {
      return wheel.differentiates();
    });
    derivative_ =
        std::make_unique<derivative_record>(config, solver_.scene(), exact, size.nx, size.ny);
  }
  // nothing else of the caller's memory is kept than the creep table
  config_.undeformed_distance = nullptr;
  for (auto *p : {&config_.wheel[0], &config_.wheel[1], &config_.rail[0], &config_.rail[1]})
    *p = rp_profile{};
  for (int side = 0; side < 2; ++side)
    config_.rail_sections[side] = nullptr, config_.section_position[side] = nullptr;
  for (int side = 0; side < 2; ++side) config_.runout[side] = config_.rail_height[side] = nullptr;
}

contact::~contact() = default;

bool contact::has_side(int side) const {
  if (config_.kind == RP_PATCH) return side == RP_RIGHT;
  return config_.kind == RP_WHEELSET || side == config_.side;
}

// Memory of a patch; the sides in use follow each other.
patch_memory &contact::memory(int side, int patch) {
  const int before = side == RP_RIGHT && config_.kind == RP_WHEELSET ? config_.max_patches : 0;
  return memory_[static_cast<size_t>(before + patch)];
}
const patch_memory &contact::memory(int side, int patch) const {
  return const_cast<contact *>(this)->memory(side, patch);
}

void contact::step(const rp_input &input, rp_result &result) {
  if (derivative_) begin_record();
  rp_result out = empty_result();
  for (auto &m : memory_) m.solved = false;
  for (int k = 0; k < 2; ++k) {
    const double bulk = std::isnan(input.bulk_temperature[k]) ? config_.bulk_temperature[k]
                                                              : input.bulk_temperature[k];
    solver_.set_bulk_temperature(k, bulk);
  }
  config_.kind == RP_PATCH ? step_patch(input, out) : step_wheels(input, out);
  result = out;
  if (derivative_) end_record(input, out);
}

rolling_input contact::step_of(const rp_input &in) const {
  rolling_input step{
      {in.creepage[0], in.creepage[1]}, in.spin_creepage, in.direction, 0.0, nullptr};
  step.regime = solver_.scene().regime;
  step.speed = in.rolling_speed;
  if (step.regime != motion::transient) return step;
  // what stands still does not roll on: tractions stay, as in a shift by nothing
  if (in.rolling_speed > 0)
    step.distance = in.distance;
  else
    step.regime = motion::shift;
  return step;
}

void contact::step_patch(const rp_input &in, rp_result &out) {
  rp_side_result &side = out.side[RP_RIGHT];
  rp_patch_result &result = side.patch[0];
  side.patch_count = 1;
  for (double *v : {&out.force[0], &out.force[1], &out.force[2], &out.moment[0], &out.moment[1],
                    &out.moment[2]})
    *v = nan;
  patch_memory &m = memory(RP_RIGHT, 0);
  patch_problem problem;
  problem.place.rolling_speed = in.rolling_speed;
  if (config_.load == RP_POSITION && config_.geometry != RP_UNDEFORMED_DISTANCE &&
      in.approach < least_approach) {
    const heat_outcome h = solver_.leave_contact(step_of(in), m);
    report_apart(solver_.scene(), problem.place, in.approach, h, result);
  } else if (!pose(in, m, problem)) {
    report_beyond(problem.place, result);
  } else {
    solver_.begin_step(problem, m);
    solver_.start_from(m, problem.g);
    set_distance(problem, m);
    patch_wrench wrench;
    solver_.solve(problem, m, result, wrench);
    if (derivative_) derivative_->problem = problem;
  }
  out.status = side.status = result.status;
}

// The problem of a patch's step but for its distance. Returns whether there is a grid for it.
bool contact::pose(const rp_input &in, const patch_memory &m, patch_problem &problem) const {
  const patch_scene &scene = solver_.scene();
  problem.hertz = hertz_of(config_, scene, in);
  if (!set_grid(m, problem) || !solver_.fits(problem.g)) return false;
  problem.force_given = config_.load == RP_FORCE;
  problem.force = in.normal_force;
  problem.approach = in.approach;
  if (scene.tangential == RP_TANGENTIAL_NONE) return true;
  problem.place.direction = in.rolling_speed > 0 ? in.direction : 0;
  problem.rolling_speed = in.rolling_speed;
  problem.rolling = step_of(in);
  for (int k = 0; k < 2; ++k) problem.tangential_force[k] = in.tangential_force[k];
  return true;
}

// The grid of a patch's step. Returns whether it covers what is drawn on it.
bool contact::set_grid(const patch_memory &m, patch_problem &problem) const {
  grid &g = problem.g;
  const auto centre = [&] {
    g.x0 = -0.5 * (g.nx - 1) * g.dx;
    g.y0 = -0.5 * (g.ny - 1) * g.dy;
  };
  if (config_.geometry == RP_UNDEFORMED_DISTANCE) {
    g.nx = config_.distance_shape[0];
    g.ny = config_.distance_shape[1];
    g.dx = config_.element_size[0];
    g.dy = config_.element_size[1];
    centre();
  } else if (!solver_.scene().closed_form()) {
    g = hertz_grid(config_, problem.hertz);
  }
  if (!solver_.scene().keeps_steps()) return true;
  // shift and transient rolling stay on the grid of their first step
  if (m.history.begun) {
    g = m.g;
  } else if (config_.max_elements[0] > 0 && config_.geometry != RP_UNDEFORMED_DISTANCE) {
    g.nx = config_.max_elements[0];
    if (config_.geometry != RP_LINE_CONTACT) g.ny = config_.max_elements[1];
    centre();
  }
  // Hertz's ellipse is drawn on the grid and not found on it
  return config_.normal != RP_NORMAL_HERTZ || (2.0 * problem.hertz.semi_axes[0] <= g.nx * g.dx &&
                                               2.0 * problem.hertz.semi_axes[1] <= g.ny * g.dy);
}

// The undeformed distance of a patch's elements and the friction of its rows.
void contact::set_distance(const patch_problem &problem, patch_memory &m) const {
  const stage_mark mark = solver_.marks().enter(RP_STAGE_GEOMETRY);
  const grid &g = problem.g;
  const hertz_contact &hertz = problem.hertz;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      const double x = g.x(i), y = g.y(j);
      m.undeformed_distance[at] =
          shape_.size() ? shape_[at] : hertz.curvatures[0] * x * x + hertz.curvatures[1] * y * y;
    }
  for (size_t j = 0; j < m.row_friction.size() && j < static_cast<size_t>(g.ny); ++j)
    m.row_friction[j] = solver_.scene().friction_variation.at(g.y(static_cast<int>(j)));
}

// Solves all wheels at z; returns their vertical force on the rails.
double contact::evaluate_wheels(double z, rp_result &out) {
  double vertical = 0;
  rp_status status = RP_NO_CONTACT;
  for (auto &wheel : wheels_) {
    rp_side_result &side = out.side[wheel.side()];
    wheel.move_to(z);
    wheel.evaluate(solver_, &memory(wheel.side(), 0), side);
    vertical -= side.force[2];
    status = combine_status(status, side.status);
  }
  ++out.evaluations;
  out.status = status;
  return vertical;
}

void contact::step_wheels(const rp_input &in, rp_result &out) {
  if (friction_along_.varies()) solver_.set_friction_scale(friction_along_.at(in.x));
  const auto evaluate = [&](double z) { return evaluate_wheels(z, out); };
  if (solver_.scene().keeps_steps())
    for (auto &m : memory_) solver_.remember(m);
  {
    const stage_mark mark = solver_.marks().enter(RP_STAGE_GEOMETRY);
    for (auto &wheel : wheels_) wheel.place(in);
  }
  if (support_) {
    solve_supported(in, out);
  } else if (config_.load == RP_POSITION) {
    out.z = in.z;
    evaluate(in.z);
  } else {
    find_z(in.vertical_force, evaluate, out);
  }
  for (auto &wheel : wheels_)
    for (int k = 0; k < 3; ++k) {
      out.force[k] += out.side[wheel.side()].force[k];
      out.moment[k] += out.side[wheel.side()].moment[k];
    }
}

// Finds z for a prescribed vertical force; `evaluate(z)` solves all wheels and returns their force.
template <class Evaluate>
void contact::find_z(double target, Evaluate &&evaluate, rp_result &out) {
  double touch = HUGE_VAL;
  for (const auto &wheel : wheels_) {
    double z = 0;
    if (wheel.first_touch(z)) touch = std::min(touch, z);
  }
  if (touch == HUGE_VAL) {
    evaluate(0.0);
    out.z = nan;
    out.status = RP_OUT_OF_RANGE;
    return;
  }
  double depth = depth_;
  if (!(depth > 0)) {
    // a ball on a plane with the load of one wheel and a typical combined radius
    const double load = target / static_cast<double>(wheels_.size());
    const double modulus = solver_.scene().modulus(), radius = 0.5 * config_.nominal_radius;
    depth = std::cbrt(9.0 * load * load / (16.0 * modulus * modulus * radius));
  }
  force_search search(target, depth, config_.tolerance);
  for (int i = 0; i < max_searches; ++i) {
    depth = search.depth();
    const double force = evaluate(touch + depth);
    // a creep force outside its theory's range is a force all the same
    const bool beyond = std::any_of(wheels_.begin(), wheels_.end(),
                                    [](const wheel_contact &wheel) { return wheel.beyond(); });
    search.report(force, beyond);
    if (search.converged() || search.exhausted()) break;
  }
  out.z = touch + depth;
  report_search(search.converged(), search.too_deep() ? RP_OUT_OF_RANGE : RP_NOT_CONVERGED,
                search.residual(), out);
  depth_ = search.converged() ? depth : 0.0;
}

// What does not carry the force asked for is no solution of the case, wheel by wheel.
void contact::report_search(bool converged, rp_status otherwise, double residual,
                            rp_result &out) const {
  const rp_status found = converged ? RP_CONVERGED : otherwise;
  for (auto &side : out.side) {
    degrade(side.status, found);
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i)
      railpatch::report_search(found, residual, side.patch[i]);
  }
  if (found != RP_CONVERGED && out.status != RP_OUT_OF_RANGE) out.status = found;
}

void contact::set_friction_coefficient(double value) {
  // derivatives are those of the coefficient that the last step was solved with
  if (derivative_ && value != friction_coefficient()) derivative_->solved = false;
  solver_.set_friction_coefficient(value);
}

void contact::reset() {
  for (auto &m : memory_) {
    m.warm = m.solved = false;
    m.history.clear();
    if (m.heat) m.heat->clear();
  }
  depth_ = 0;
  if (derivative_) derivative_->solved = false;
  if (support_) support_->reset();
}

}  // namespace railpatch
