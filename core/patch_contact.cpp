#include "patch_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "conformal_coupling.hpp"

namespace railpatch {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using std::numbers::pi;

// of unlike bodies' tangential problem, after which it is given up
constexpr int most_failures = 5;

// Worse of two outcomes, for results that several stages contribute to.
void degrade(rp_patch_result &result, rp_status status) {
  if (result.status == RP_CONVERGED) result.status = status;
}

double inside_ellipse(const double semi_axes[2], double x, double y) {
  const double u = x / semi_axes[0], v = semi_axes[1] > 0 ? y / semi_axes[1] : 0.0;
  return 1.0 - u * u - v * v;
}

}  // namespace

rp_patch_result empty_patch_result() {
  rp_patch_result r{};
  for (double *v :
       {&r.normal_force,      &r.approach,          &r.creep_force[0], &r.creep_force[1],
        &r.spin_moment,       &r.max_pressure,      &r.contact_area,   &r.max_temperature,
        &r.friction_power,    &r.plastic_power,     &r.elastic_energy, &r.error_estimate[0],
        &r.error_estimate[1], &r.error_estimate[2], &r.position[0],    &r.position[1],
        &r.position[2],       &r.contact_angle,     &r.creepage[0],    &r.creepage[1],
        &r.spin_creepage,     &r.rolling_speed})
    *v = nan;
  r.share = 1;
  return r;
}

void set_unloaded(const patch_scene &scene, rp_patch_result &result) {
  result.normal_force = result.max_pressure = result.contact_area = result.elastic_energy = 0;
  result.error_estimate[2] = 0;
  if (scene.heat)
    result.max_temperature =
        std::max(scene.heat->bodies.body[0].bulk, scene.heat->bodies.body[1].bulk);
  if (scene.tangential == RP_TANGENTIAL_NONE) return;
  result.creep_force[0] = result.creep_force[1] = result.spin_moment = result.friction_power = 0;
  if (scene.yields()) result.plastic_power = 0;
  result.error_estimate[0] = result.error_estimate[1] = 0;
}

bool patch_scene::estimates_force() const {
  // of a prescribed force the creepage errs
  const bool by_temperature = heat && heat->by_temperature;
  if (spin_offset || is_forced() || law || keeps_steps() || by_temperature ||
      friction_variation.varies())
    return false;
  if (!is_fast(tangential)) return true;
  // what an ellipse in place of another shape does was not measured
  if (tangential == RP_TANGENTIAL_TABLE && normal != RP_NORMAL_HERTZ) return false;
  const polach_factors &p = fast.polach;
  const stiffness_reduction &r = fast.reduction;
  const bool reduced = p.adhesion != 1 || p.slip != 1 || r.k0 != 1 || (r.alpha != 1 && r.beta != 0);
  return fast.coefficient_factor == 1 && !reduced && fast.blending == RP_BLENDING_SLIDING &&
         fast.bound == RP_BOUND_AUTOMATIC;
}

bool patch_scene::differentiates() const {
  if (curved || (normal != RP_NORMAL_HALF_SPACE && normal != RP_NORMAL_HERTZ)) return false;
  if (tangential == RP_TANGENTIAL_NONE) return true;
  return tangential == RP_TANGENTIAL_FULL && !is_fitted() && !law && !keeps_steps() && !heat &&
         !is_forced() && !couples();
}

patch_memory::patch_memory(int max_count, int max_rows, const patch_scene &scene) {
  const auto n = static_cast<size_t>(max_count);
  undeformed_distance = aligned_buffer<double>(n);
  if (!scene.closed_form()) pressure = aligned_buffer<double>(n);
  if (scene.curved) curved.emplace(max_rows);
  if (!has_tractions(scene.tangential)) return;
  if (scene.friction_variation.varies())
    row_friction = aligned_buffer<double>(static_cast<size_t>(max_rows));
  const size_t count =
      scene.is_fitted() ? static_cast<size_t>(scene.fitted[0] * scene.fitted[1]) : n;
  for (auto *b : {&px, &py, &sx, &sy}) *b = aligned_buffer<double>(count);
  division = aligned_buffer<unsigned char>(count);
  if (scene.is_forced()) creepage = aligned_buffer<double>(2);
  history = patch_history(max_count, scene.keeps_steps(), scene.law ? &*scene.law : nullptr);
  if (scene.heat) heat.emplace(max_count / std::max(max_rows, 1), max_rows, *scene.heat);
  if (!scene.is_fitted()) return;
  node_x = aligned_buffer<double>(count);
  node_y = aligned_buffer<double>(static_cast<size_t>(scene.fitted[1]));
  node_pressure = aligned_buffer<double>(count);
}

size_t patch_memory::bytes() const {
  return undeformed_distance.bytes() + pressure.bytes() + 4 * px.bytes() + division.bytes() +
         2 * node_x.bytes() + node_y.bytes() + row_friction.bytes() + creepage.bytes() +
         history.bytes() + (curved ? curved->bytes() : 0);
}

patch_contact::patch_contact(const patch_scene &scene, const fft_plans &plans, int max_nx,
                             int max_ny, rp_observer observer, void *observer_user)
    : scene_(scene),
      max_nx_(max_nx),
      max_ny_(max_ny),
      observer_(observer),
      observer_user_(observer_user),
      errors_(scene.elastic, scene.layer_flexibility) {
  const bool full = scene.tangential == RP_TANGENTIAL_FULL && !scene.is_fitted();
  const auto count = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  influence::scene elastic{scene.elastic, scene.layer_flexibility, scene.line_width, full};
  elastic.curved = scene.curved;
  if (full || scene.normal == RP_NORMAL_HALF_SPACE) influence_.emplace(elastic, plans);
  if (scene.normal == RP_NORMAL_HALF_SPACE) normal_.emplace(max_nx * max_ny);
  if (scene.normal == RP_NORMAL_KIK_PIOTROWSKI || scene.normal == RP_NORMAL_ANALYN)
    rows_.emplace(scene.normal, scene.modulus(), max_ny);
  if (full) {
    const bool rolls_on = scene.regime == motion::transient;
    tangential_.emplace(
        max_nx, max_ny,
        tangential_solver::setup{scene.is_forced(), scene.law.has_value(), scene.yields(),
                                 scene.keeps_steps(), rolls_on ? &plans : nullptr, scene.moves});
    // with a prescribed force no creepage is known to start from
    const bool plain = !scene.is_forced() && !scene.law && !scene.keeps_steps() && !scene.couples();
    if (plain && coarse_start::serves(max_nx, max_ny))
      coarse_start_.emplace(elastic, plans, max_nx, max_ny);
  }
  if (scene.couples()) {
    std::unique_ptr<coupling_operator> coupling;
    if (scene.curved)
      coupling = std::make_unique<conformal_coupling>(*influence_, max_nx * max_ny);
    else
      coupling = std::make_unique<coupling_influence>(scene.elastic, scene.line_width > 0, plans);
    coupled_.emplace(std::move(coupling), max_nx * max_ny, scene.keeps_steps());
  }
  if (is_fast(scene.tangential)) fast_.emplace(scene.elastic, scene.fast, max_nx, max_ny);
  if (scene.is_fitted()) {
    fitted_rows_.emplace(scene.fitted[0], scene.fitted[1], max_ny);
    fitted_.emplace(scene.elastic, scene.layer_flexibility, scene.line_width > 0, scene.is_forced(),
                    *fitted_rows_);
  }
  if (scene.heat) heat_.emplace(*scene.heat, max_nx, max_ny);
  if (scene.derivatives && scene.differentiates())
    derivative_.emplace(scene, plans, max_nx, max_ny, scene.stretches);
  if (scene.closed_form()) return;
  scratch_[0] = aligned_buffer<double>(count);
  scratch_[1] = aligned_buffer<double>(count);
  if (full) bound_ = aligned_buffer<double>(count);
  if (!scene.keeps_steps() || !scene.moves) return;
  for (auto &b : before_) b = aligned_buffer<double>(count);
}

size_t patch_contact::tangential_bytes() const {
  return bound_.bytes() + 2 * before_[0].bytes() + (tangential_ ? tangential_->bytes() : 0) +
         (coarse_start_ ? coarse_start_->bytes() : 0) +
         (fast_ ? sizeof(fast_solver) + fast_->bytes() : 0) +
         (fitted_ ? fitted_rows_->bytes() + fitted_->bytes() : 0);
}

void patch_contact::leave_contact(const rolling_input &step, patch_memory &memory,
                                  rp_patch_result &result) {
  memory.warm = false;
  if (!memory.history.begun) return;
  memory.history.begin(memory.g, step.upstream(), memory.px.data(), memory.py.data());
  patch_problem nothing;
  nothing.g = memory.g;
  nothing.rolling = step;
  nothing.rolling_speed = step.speed;
  leave_unloaded(nothing, memory);
  if (!heat_) return;
  begin_heat(nothing, memory);
  result.max_temperature = finish_heat(nothing, memory);
}

void patch_contact::start_from(patch_memory &memory, const grid &g) {
  const bool same_shape = memory.g.nx == g.nx && memory.g.ny == g.ny;
  const bool same_size = memory.g.dx == g.dx && memory.g.dy == g.dy;
  if (memory.warm &&
      !(same_shape && (!same_size || (memory.g.x0 == g.x0 && memory.g.y0 == g.y0)))) {
    // nearest element of the old grid; a grid of the same shape scales with the contact instead
    const auto carry = [&](aligned_buffer<double> &field) {
      if (field.size() == 0) return;
      std::copy_n(field.data(), memory.g.count(), scratch_[0].data());
      for (int j = 0; j < g.ny; ++j)
        for (int i = 0; i < g.nx; ++i) {
          const double u = std::round((g.x(i) - memory.g.x0) / memory.g.dx);
          const double v = std::round((g.y(j) - memory.g.y0) / memory.g.dy);
          const bool inside = u >= 0 && v >= 0 && u < memory.g.nx && v < memory.g.ny;
          field[static_cast<size_t>(j * g.nx + i)] =
              inside ? scratch_[0][static_cast<size_t>(v * memory.g.nx + u)] : 0.0;
        }
    };
    carry(memory.pressure);
    if (memory.heat) memory.heat->forget_friction();
    if (!memory.fitted()) {
      carry(memory.px);
      carry(memory.py);
    }
  }
  memory.g = g;
  if (memory.warm) return;
  if (memory.heat) memory.heat->forget_friction();
  if (memory.pressure.size()) std::fill_n(memory.pressure.data(), g.count(), 0.0);
  if (memory.px.size() == 0) return;
  for (auto *field : {&memory.px, &memory.py})
    std::fill_n(field->data(), memory.columns() * memory.rows(), 0.0);
  if (scene_.is_forced()) std::fill_n(memory.creepage.data(), 2, 0.0);
}

void patch_contact::solve(const patch_problem &problem, patch_memory &memory,
                          rp_patch_result &result, patch_wrench &wrench) {
  result.status = RP_CONVERGED;
  describe_grid(problem, result);
  result.residual = 0;
  memory.solved = true;
  if (influence_) {
    observe(RP_STAGE_INFLUENCE, true);
    influence_->set_grid(problem.g);
    if (memory.curved) influence_->set_rows(memory.curved->cosine(), memory.curved->sine());
    observe(RP_STAGE_INFLUENCE, false);
  }
  if (coupled_) {
    observe(RP_STAGE_COUPLING, true);
    coupled_->begin(problem.g, memory.undeformed_distance.data(), memory.px.data(),
                    memory.py.data());
    observe(RP_STAGE_COUPLING, false);
  }
  observe(RP_STAGE_NORMAL, true);
  bool loaded = solve_normal(problem, memory, result);
  if (!loaded && coupled_ && coupled_->forget()) {
    // the last step's tractions held the bodies apart
    result.status = RP_CONVERGED;
    loaded = solve_normal(problem, memory, result);
  }
  observe(RP_STAGE_NORMAL, false);
  memory.approach = result.approach;
  memory.beyond = result.status == RP_OUT_OF_RANGE;
  memory.warm =
      loaded && result.status == RP_CONVERGED && memory.pressure.size() + memory.px.size() > 0;
  if (!loaded) {
    set_unloaded(scene_, result);
    leave_unloaded(problem, memory);
    if (heat_) begin_heat(problem, memory);
    if (heat_) result.max_temperature = finish_heat(problem, memory);
    wrench = {};
    return;
  }
  // the contact area of unlike bodies is known only after the tractions
  const bool late = coupled_ && heat_ && !heat_->feeds_back();
  if (heat_ && !late) begin_heat(problem, memory);
  if (scene_.tangential != RP_TANGENTIAL_NONE) {
    observe(RP_STAGE_TANGENTIAL, true);
    const bool solved = coupled_ ? solve_in_turn(problem, memory, result)
                                 : solve_tangential(problem, memory, result);
    memory.warm = solved && (memory.warm || coupled_);
    observe(RP_STAGE_TANGENTIAL, false);
  }
  if (late) begin_heat(problem, memory);
  if (heat_) result.max_temperature = finish_heat(problem, memory);
  observe(RP_STAGE_FORCES, true);
  if (scene_.closed_form()) {
    // the ellipse's pressure is symmetric about the reference
    wrench = {};
    wrench.force[2] = -result.normal_force;
  } else {
    const bool on_grid = memory.px.size() && !fitted_;
    const double *px = on_grid ? memory.px.data() : nullptr;
    if (memory.curved) {
      wrench =
          memory.curved->sum_tractions(problem.g, memory.pressure.data(), px, memory.py.data());
      result.normal_force = -wrench.force[2];
    } else {
      wrench = sum_tractions(problem.g, memory.pressure.data(), px, memory.py.data());
    }
  }
  if (fitted_ || (fast_ && !has_tractions(scene_.tangential))) {
    const patch_wrench creep =
        fitted_ ? fitted_->creep_wrench(*fitted_rows_, memory.nodes())
                : patch_wrench{{sums_.force[0], sums_.force[1], 0.0}, {0.0, 0.0, sums_.moment}};
    wrench.force[0] = creep.force[0];
    wrench.force[1] = creep.force[1];
    wrench.moment[2] = creep.moment[2];
  }
  if (scene_.tangential != RP_TANGENTIAL_NONE) {
    result.creep_force[0] = wrench.force[0];
    result.creep_force[1] = wrench.force[1];
    result.spin_moment = wrench.moment[2];
  }
  estimate_error(problem, memory, result);
  observe(RP_STAGE_FORCES, false);
}

derivative_outcome patch_contact::differentiate(const patch_problem &problem,
                                                const patch_memory &memory,
                                                const patch_variation *in, int count,
                                                const derivative_options &options,
                                                patch_change *out) {
  observe(RP_STAGE_DERIVATIVES, true);
  const patch_derivative::solved solved{scene_,
                                        problem,
                                        memory,
                                        influence_ ? &*influence_ : nullptr,
                                        normal_ ? &*normal_ : nullptr,
                                        tangential_ ? tangential_->blocks() : nullptr};
  const derivative_outcome outcome = derivative_->solve(solved, in, count, options, out);
  observe(RP_STAGE_DERIVATIVES, false);
  return outcome;
}

void patch_contact::estimate_error(const patch_problem &problem, patch_memory &memory,
                                   rp_patch_result &result) const {
  // linear theory beyond its bound is what it is; other results are no solutions
  const bool linear = scene_.tangential == RP_TANGENTIAL_LINEAR;
  if (result.status != RP_CONVERGED && !(linear && result.status == RP_OUT_OF_RANGE)) return;
  if (scene_.line_width > 0 || coupled_ || scene_.curved) return;
  solved_patch patch{scene_.normal,  scene_.tangential,  problem.hertz, {},
                     {0, 0},         scene_.is_fitted(), {1, 1},        scene_.friction(),
                     problem.rolling};
  if (fast_ && fast_->table()) {
    patch.stated[0] = fast_->table()->force_error();
    patch.stated[1] = fast_->table()->moment_error();
  }
  if (!scene_.estimates_force()) patch.tangential = RP_TANGENTIAL_NONE;
  if (!(problem.rolling_speed > 0)) patch.rolling = rolling_input{};
  if (memory.pressure.size()) patch.extent = extent_of(problem.g, memory.pressure.data());
  if (rows_) patch.extent.width = rows_->width();
  for (int k = 0; k < 2 && has_tractions(scene_.tangential); ++k)
    patch.tangential_grid[k] = scene_.is_fitted() ? scene_.fitted[k] : patch.extent.across[k];
  if (scene_.normal == RP_NORMAL_HERTZ) patch.extent = {};
  errors_.estimate(patch, result, memory.error_features.data());
}

// Fitted rows have elements of many sizes: their places are in the fields.
void patch_contact::describe_grid(const patch_problem &problem, rp_patch_result &result) const {
  const grid &g = problem.g;
  const bool fitted = scene_.is_fitted();
  result.grid[0] = fitted ? scene_.fitted[0] : g.nx;
  result.grid[1] = fitted ? scene_.fitted[1] : g.ny;
  result.grid_origin[0] = fitted ? 0.0 : g.x0;
  result.grid_origin[1] = fitted ? 0.0 : g.y0;
  result.element_size[0] = fitted ? 0.0 : g.dx;
  result.element_size[1] = fitted ? 0.0 : g.dy;
}

// No contact: nothing is transferred, and every element is exterior.
void patch_contact::leave_unloaded(const patch_problem &problem, patch_memory &memory) {
  if (memory.pressure.size()) std::fill_n(memory.pressure.data(), problem.g.count(), 0.0);
  const int n = memory.columns() * memory.rows();
  for (auto *field : {&memory.px, &memory.py, &memory.sx, &memory.sy, &memory.node_pressure})
    if (field->size()) std::fill_n(field->data(), n, 0.0);
  if (memory.division.size())
    std::fill_n(memory.division.data(), n, static_cast<unsigned char>(RP_EXTERIOR));
  if (memory.history.has_law()) memory.history.start_from_before(problem.g, *scene_.law);
}

bool patch_contact::solve_normal(const patch_problem &problem, patch_memory &memory,
                                 rp_patch_result &result) {
  const grid &g = problem.g;
  if (rows_)
    solve_rows(problem, memory, result);
  else if (normal_)
    solve_half_space(problem, memory, result);
  else
    solve_hertz(problem, memory, result);
  if (memory.pressure.size() == 0) {
    if (result.normal_force > 0) return true;
    degrade(result, RP_NO_CONTACT);
    return false;
  }
  const int touching = static_cast<int>(std::count_if(
      memory.pressure.data(), memory.pressure.data() + g.count(), [](double p) { return p > 0; }));
  result.elements[RP_EXTERIOR] = g.count() - touching;
  if (touching > 0) return true;
  degrade(result, RP_NO_CONTACT);
  return false;
}

void patch_contact::solve_half_space(const patch_problem &problem, patch_memory &memory,
                                     rp_patch_result &result) {
  const grid &g = problem.g;
  double tolerance = scene_.normal_tolerance;
  if (coupled_) tolerance = coupled_->tolerance(tolerance);
  const normal_options options{tolerance, scene_.max_iterations};
  double *p = memory.pressure.data();
  const double *h = coupled_ ? coupled_->distance() : memory.undeformed_distance.data();
  const normal_result n =
      problem.force_given
          ? normal_->with_force(*influence_, g, h, problem.force, options, p, problem.parts)
          : normal_->with_approach(*influence_, g, h, problem.approach, options, p, problem.parts);
  if (!n.converged) degrade(result, RP_NOT_CONVERGED);
  if (coupled_) coupled_->set_scale(n.scale);
  if (n.touches_border) degrade(result, RP_OUT_OF_RANGE);
  result.normal_force = n.normal_force;
  result.approach = n.approach;
  result.normal_iterations = n.iterations;
  result.residual = n.residual;
  result.max_pressure = *std::max_element(p, p + g.count());
  result.contact_area = n.contact_count * g.dx * g.dy;
  // at the solution the elastic displacement is approach minus distance wherever p > 0
  double energy = 0;
  for (int i = 0; i < g.count(); ++i) energy += p[i] * (n.approach - h[i]);
  result.elastic_energy = 0.5 * energy * g.dx * g.dy;
}

// The fast theories for contact areas of any shape.
void patch_contact::solve_rows(const patch_problem &problem, patch_memory &memory,
                               rp_patch_result &result) {
  const row_contact_result n =
      rows_->solve(problem.g, memory.undeformed_distance.data(),
                   {problem.force_given, problem.force, problem.approach, problem.hertz.approach},
                   problem.parts, memory.pressure.data());
  if (!n.converged) degrade(result, RP_NOT_CONVERGED);
  if (n.touches_border) degrade(result, RP_OUT_OF_RANGE);
  result.normal_force = n.normal_force;
  result.approach = n.approach;
  result.normal_iterations = n.iterations;
  result.residual = n.residual;
  result.max_pressure = n.max_pressure;
  result.contact_area = n.contact_area;
  result.elastic_energy = n.elastic_energy;
}

void patch_contact::solve_hertz(const patch_problem &problem, patch_memory &memory,
                                rp_patch_result &result) {
  const grid &g = problem.g;
  const hertz_contact &hertz = problem.hertz;
  double sum = 0;
  for (int j = 0; j < g.ny && memory.pressure.size(); ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double level = inside_ellipse(hertz.semi_axes, g.x(i), g.y(j));
      const double p = level > 0 ? hertz.max_pressure * std::sqrt(level) : 0.0;
      memory.pressure[static_cast<size_t>(j * g.nx + i)] = p;
      sum += p * g.dx * g.dy;
    }
  // the sampled pressure carries exactly the closed form's force
  for (int i = 0; i < g.count() && sum > 0; ++i)
    memory.pressure[static_cast<size_t>(i)] *= hertz.normal_force / sum;
  result.normal_force = hertz.normal_force;
  result.approach = hertz.approach;
  result.max_pressure = hertz.max_pressure;
  const bool line = scene_.line_width > 0;
  result.contact_area = line ? 2.0 * hertz.semi_axes[0] * scene_.line_width
                             : pi * hertz.semi_axes[0] * hertz.semi_axes[1];
  // 1/2 int p u dA of the elliptic pressure (Johnson 1985, section 3.3)
  result.elastic_energy = 0.4 * hertz.normal_force * hertz.approach;
  if (line) result.approach = result.elastic_energy = nan;
}

bool patch_contact::solve_tangential(const patch_problem &problem, patch_memory &memory,
                                     rp_patch_result &result) {
  const grid &g = problem.g;
  const tangential_fields fields = memory.fields();
  rolling_input rolling = problem.rolling;
  if (problem.past) {
    find_before(problem, rolling);
  } else if (scene_.keeps_steps()) {
    rolling.px = memory.history.last_px.data();
    rolling.py = memory.history.last_py.data();
  }
  if (!(problem.rolling_speed > 0) && scene_.regime != motion::shift) {
    // standstill: creepage is not defined and no micro-slip has happened, so all sticks unloaded
    rolling.creepage[0] = rolling.creepage[1] = rolling.spin_creepage = 0;
  }
  prescribed_force force;
  if (scene_.is_forced()) {
    for (int c = 0; c < 2; ++c) {
      if (!scene_.prescribed[c]) continue;
      force.component[c] = true;
      force.force[c] = problem.tangential_force[c];
      force.creepage[c] = memory.creepage[static_cast<size_t>(c)];
      rolling.creepage[c] = 0;
    }
    rolling.force = &force;
  }
  if (coupled_ && (problem.rolling_speed > 0 || rolling.regime != motion::steady)) {
    observe(RP_STAGE_COUPLING, true);
    coupled_->set_slip(memory.pressure.data(), rolling);
    observe(RP_STAGE_COUPLING, false);
    for (int c = 0; c < 2; ++c) rolling.coupled[c] = coupled_->slip(c);
  }
  if (scene_.spin_offset) rolling.spin_offset = rolling.direction * g.dx / 6.0;
  if (memory.curved && problem.rolling_speed > 0) add_slip_of_rows(g, *memory.curved, rolling);
  tangential_result t;
  if (fast_) {
    const fast_patch patch{g,
                           memory.pressure.size() ? memory.pressure.data() : nullptr,
                           problem.hertz,
                           rows_ ? &*rows_ : nullptr,
                           result.normal_force,
                           result.contact_area,
                           scene_.friction()};
    t = fast_->solve(patch, rolling, fields, sums_);
  } else if (fitted_) {
    t = solve_fitted(problem, rolling, memory);
  } else {
    t = heat_ && heat_->feeds_back() ? solve_with_heat(problem, rolling, memory, result)
                                     : solve_on_grid(problem, rolling, memory, result, nullptr);
  }
  for (int c = 0; c < 2; ++c) {
    if (!scene_.prescribed[c]) continue;
    result.creepage[c] = memory.creepage[static_cast<size_t>(c)] = force.creepage[c];
  }
  result.elements[RP_STICK] = t.stick;
  result.elements[RP_SLIP] = t.slip;
  if (fitted_) result.elements[RP_EXTERIOR] = memory.columns() * memory.rows() - t.stick - t.slip;
  result.newton_iterations = t.newton_iterations;
  result.inner_iterations = t.products;
  // written so that a residual that is no number stays visible
  if (!(t.residual <= result.residual)) result.residual = t.residual;
  const double rate = scene_.regime == motion::shift ? 1.0 : problem.rolling_speed;
  result.friction_power = rate * t.friction;
  if (scene_.yields()) result.plastic_power *= rate;
  if (!t.converged)
    degrade(result, scene_.tangential != RP_TANGENTIAL_FULL || t.out_of_range ? RP_OUT_OF_RANGE
                                                                              : RP_NOT_CONVERGED);
  if (scene_.tangential == RP_TANGENTIAL_FULL)
    result.elastic_energy +=
        fitted_ ? fitted_->elastic_energy(*fitted_rows_) : tangential_energy(problem, memory);
  return t.converged;
}

// On a curved reference surface every row has a rigid slip of its own.
void patch_contact::add_slip_of_rows(const grid &g, const conformal_rows &rows,
                                     rolling_input &rolling) {
  rolling.creepage[0] = rolling.creepage[1] = rolling.spin_creepage = 0;
  for (int c = 0; c < 2; ++c) {
    double *slip = coupled_->slip(c);
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        slip[j * g.nx + i] += rows.slip(c, j, g.x(i) + rolling.spin_offset);
  }
}

// The displacement by the last step's tractions where each element's material was then.
void patch_contact::find_before(const patch_problem &problem, rolling_input &rolling) {
  observe(RP_STAGE_HISTORY, true);
  for (int c = 0; c < 2; ++c) {
    std::fill_n(before_[c].data(), problem.g.count(), 0.0);
    rolling.before[c] = before_[c].data();
  }
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    grid from = past.history->last_grid;
    const auto first = static_cast<ptrdiff_t>(past.first_row) * from.nx;
    from.ny = past.rows;
    tangential_->add_moved(*influence_, from, problem.g, past.offset, past.history->last_share,
                           past.history->last_px.data() + first,
                           past.history->last_py.data() + first, before_[0].data(),
                           before_[1].data());
  }
  observe(RP_STAGE_HISTORY, false);
}

tangential_result patch_contact::solve_on_grid(const patch_problem &problem,
                                               const rolling_input &rolling, patch_memory &memory,
                                               rp_patch_result &result, const double *mu) {
  const grid &g = problem.g;
  const bool varies = scene_.friction_variation.varies();
  // where the law says mu, what it is multiplied by
  const bool by_velocity = scene_.law && scene_.law->by_velocity;
  const double friction = by_velocity ? 1.0 : scene_.friction_coefficient;
  for (int j = 0; j < g.ny; ++j) {
    const double factor =
        (varies ? memory.row_friction[static_cast<size_t>(j)] : 1.0) * scene_.friction_scale;
    for (auto i = static_cast<size_t>(j * g.nx); i < static_cast<size_t>((j + 1) * g.nx); ++i)
      bound_[i] = (mu ? mu[i] : friction) * factor * memory.pressure[i];
  }
  // the outer loops see the tractions' errors as changes of the heat and of the gap
  const double tolerance = mu ? std::max(0.1 * scene_.tolerance, 1e-12) : scene_.tolerance;
  tangential_options options{tolerance, scene_.max_iterations};
  if (coupled_) options.tolerance = coupled_->tolerance(options.tolerance);
  const auto zero = [&](const double *p) {
    return std::all_of(p, p + g.count(), [](double v) { return v == 0; });
  };
  if (coarse_start_ && rolling.drives() && coarse_start::serves(g.nx, g.ny) &&
      zero(memory.px.data()) && zero(memory.py.data()))
    coarse_start_->find(g, memory.pressure.data(), bound_.data(), rolling, options,
                        memory.fields());
  if (!has_physics || !scene_.law)
    return tangential_->solve(*influence_, g, memory.pressure.data(), bound_.data(), rolling,
                              options, memory.fields());
  memory.history.start_from_before(g, *scene_.law);
  const inelastic_fields fields = memory.history.fields(*scene_.law);
  inelastic_sums sums;
  const tangential_result t =
      tangential_->solve(*influence_, g, memory.pressure.data(), bound_.data(), rolling, options,
                         memory.fields(), &fields, &sums);
  for (size_t i = 0; i < static_cast<size_t>(g.count()); ++i)
    if (memory.pressure[i] > 0) memory.history.friction[i] /= memory.pressure[i];
  result.elements[RP_PLASTIC] = sums.plastic;
  result.ambiguous_elements = sums.ambiguous;
  if (scene_.law->plastic()) result.plastic_power = sums.plastic_work;
  return t;
}

// Each pass of the outer loop starts from the tractions of the last one.
tangential_result patch_contact::solve_with_heat(const patch_problem &problem,
                                                 const rolling_input &rolling, patch_memory &memory,
                                                 rp_patch_result &result) {
  tangential_result last{};
  int newton = 0, products = 0;
  const auto pass = [&](const double *mu, double *q) {
    observe(RP_STAGE_TANGENTIAL, true);
    last = solve_on_grid(problem, rolling, memory, result, mu);
    observe(RP_STAGE_TANGENTIAL, false);
    newton += last.newton_iterations;
    products += last.products;
    flux_of(problem, memory, q);
    return last.converged;
  };
  observe(RP_STAGE_TEMPERATURE, true);
  const temperature_loop_result loop = heat_->solve(
      memory.pressure.data(), {scene_.tolerance, scene_.max_iterations}, *memory.heat, pass);
  observe(RP_STAGE_TEMPERATURE, false);
  result.outer_iterations += loop.iterations;
  last.newton_iterations = newton;
  last.products = products;
  last.converged = last.converged && loop.converged;
  if (!(loop.residual <= last.residual)) last.residual = loop.residual;
  return last;
}

void patch_contact::begin_heat(const patch_problem &problem, patch_memory &memory) {
  const grid &g = problem.g;
  const rolling_input &rolling = problem.rolling;
  observe(RP_STAGE_TEMPERATURE, true);
  heat_->begin({g.nx, g.ny, g.dx, rolling.direction, problem.rolling_speed},
               rolling.regime == motion::transient ? rolling.distance : 0.0, memory.pressure.data(),
               *memory.heat);
  observe(RP_STAGE_TEMPERATURE, false);
}

double patch_contact::finish_heat(const patch_problem &problem, patch_memory &memory) {
  observe(RP_STAGE_TEMPERATURE, true);
  flux_of(problem, memory, heat_->flux());
  const double greatest = heat_->finish(memory.pressure.data(), *memory.heat);
  observe(RP_STAGE_TEMPERATURE, false);
  return greatest;
}

void patch_contact::flux_of(const patch_problem &problem, const patch_memory &memory, double *q) {
  const double *plastic = nullptr;
  if (scene_.yields()) {
    const bool steps = problem.rolling.regime == motion::transient;
    memory.history.plastic_work(problem.g, problem.rolling.direction, memory.px.data(),
                                memory.py.data(), scratch_[0].data());
    const double rate = problem.rolling_speed / (steps ? problem.rolling.distance : problem.g.dx);
    for (int i = 0; i < problem.g.count(); ++i) scratch_[0][static_cast<size_t>(i)] *= rate;
    plastic = scratch_[0].data();
  }
  heat_->heat(memory.px.data(), memory.py.data(), memory.sx.data(), memory.sy.data(), plastic, q);
}

// The tangential problem of unlike bodies, and the normal one again until both agree.
bool patch_contact::solve_in_turn(const patch_problem &problem, patch_memory &memory,
                                  rp_patch_result &result) {
  const double *pressure = memory.pressure.data();
  int normal = result.normal_iterations, newton = 0, products = 0, outer = 0, failures = 0;
  // the gap's error is that of the normal problem and of the tractions' part
  for (int round = 1;; ++round) {
    const double gap_error = result.residual;
    result.outer_iterations = 0;
    const bool solved = solve_tangential(problem, memory, result);
    observe(RP_STAGE_COUPLING, true);
    const double disagreement =
        coupled_->error(pressure, memory.px.data(), memory.py.data(), problem.force_given);
    observe(RP_STAGE_COUPLING, false);
    const bool agreed = gap_error + disagreement <= scene_.normal_tolerance;
    result.normal_iterations = normal;
    result.newton_iterations = newton += result.newton_iterations;
    result.inner_iterations = products += result.inner_iterations;
    // with those of friction and temperature
    result.outer_iterations = outer += result.outer_iterations + 1;
    result.elastic_energy += coupled_->energy(pressure);
    if (!(gap_error + disagreement <= result.residual)) result.residual = gap_error + disagreement;
    failures += !solved;
    if (agreed || failures == most_failures || round >= scene_.max_iterations) {
      if (!agreed) degrade(result, RP_NOT_CONVERGED);
      return solved && result.status == RP_CONVERGED;
    }
    result.status = RP_CONVERGED;
    observe(RP_STAGE_COUPLING, true);
    coupled_->advance();
    observe(RP_STAGE_COUPLING, false);
    observe(RP_STAGE_NORMAL, true);
    const bool loaded = solve_normal(problem, memory, result);
    observe(RP_STAGE_NORMAL, false);
    // tractions too great in between, which part the bodies, are none
    if (!loaded) leave_unloaded(problem, memory);
    // in steady rolling it begins as often as one likes; others do not feed back, see check.cpp
    if (heat_ && heat_->feeds_back()) begin_heat(problem, memory);
    memory.beyond = result.status == RP_OUT_OF_RANGE;
    normal += result.normal_iterations;
  }
}

tangential_result patch_contact::solve_fitted(const patch_problem &problem,
                                              const rolling_input &rolling, patch_memory &memory) {
  const hertz_contact &hertz = problem.hertz;
  if (scene_.normal != RP_NORMAL_HERTZ)
    fitted_rows_->set_pressure(problem.g, memory.pressure.data());
  else if (scene_.line_width > 0)
    fitted_rows_->set_line(hertz.semi_axes[0], scene_.line_width, hertz.normal_force);
  else
    fitted_rows_->set_ellipse(hertz.semi_axes, hertz.normal_force);
  return fitted_->solve(*fitted_rows_, scene_.friction(), rolling,
                        {scene_.tolerance, scene_.max_iterations}, memory.nodes());
}

double patch_contact::tangential_energy(const patch_problem &problem, const patch_memory &memory) {
  const grid &g = problem.g;
  const auto loaded = [&](const aligned_buffer<double> &p) {
    return std::any_of(p.data(), p.data() + g.count(), [](double v) { return v != 0; });
  };
  if (!loaded(memory.px) && !loaded(memory.py)) return 0.0;
  influence_->tangential_product(memory.px.data(), memory.py.data(), scratch_[0].data(),
                                 scratch_[1].data());
  double sum = 0;
  for (int i = 0; i < g.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    sum += memory.px[at] * scratch_[0][at] + memory.py[at] * scratch_[1][at];
  }
  return 0.5 * sum * g.dx * g.dy;
}

}  // namespace railpatch
