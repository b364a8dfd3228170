#include "patch/patch_contact.hpp"

#include <algorithm>
#include <cmath>

#include "half_space/conformal_coupling.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

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
  begin_solve(problem, memory);
  if (!find_pressure(problem, memory, result)) {
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
  sum_forces(problem, memory, result, wrench);
  estimate_error(problem, memory, result);
  observe(RP_STAGE_FORCES, false);
}

// What depends on the grid and on the last step.
void patch_contact::begin_solve(const patch_problem &problem, patch_memory &memory) {
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
}

// The normal problem at the step's begin. Returns whether the bodies touch.
bool patch_contact::find_pressure(const patch_problem &problem, patch_memory &memory,
                                  rp_patch_result &result) {
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
  return loaded;
}

void patch_contact::sum_forces(const patch_problem &problem, patch_memory &memory,
                               rp_patch_result &result, patch_wrench &wrench) {
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
  if (scene_.tangential == RP_TANGENTIAL_NONE) return;
  result.creep_force[0] = wrench.force[0];
  result.creep_force[1] = wrench.force[1];
  result.spin_moment = wrench.moment[2];
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

}  // namespace railpatch
