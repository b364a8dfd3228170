// One contact patch from undeformed distance to forces: the order of the stages, their workspace,
// and what is remembered of the patch from step to step.
#pragma once

#include <array>
#include <optional>

#include "fast/fast.hpp"
#include "half_space/coupling.hpp"
#include "half_space/forces.hpp"
#include "half_space/physics.hpp"
#include "normal/hertz.hpp"
#include "normal/normal.hpp"
#include "normal/row_contact.hpp"
#include "patch/conformal_rows.hpp"
#include "patch/coupled_contact.hpp"
#include "patch/error_estimate.hpp"
#include "patch/history.hpp"
#include "patch/patch_derivative.hpp"
#include "railpatch.h"
#include "tangential/coarse_start.hpp"
#include "tangential/fitted.hpp"
#include "tangential/friction_factor.hpp"
#include "tangential/tangential.hpp"
#include "temperature/stage.hpp"

namespace railpatch {

// Constant over the life of a handle, but for the friction coefficient and its scale.
struct patch_scene {
  elastic_constants elastic;
  double friction_coefficient = 0;
  friction_factor friction_variation;
  double friction_scale = 1.0;   // of the law, in this step
  double layer_flexibility = 0;  // m/Pa
  double line_width = 0;         // m, > 0: line contact
  rp_normal_method normal = RP_NORMAL_HALF_SPACE;
  rp_tangential_method tangential = RP_TANGENTIAL_FULL;  // NONE: no tangential stage
  motion regime = motion::steady;
  bool moves = false;            // the grid moves between steps: of wheels
  std::optional<bound_law> law;  // beyond Coulomb's, or a layer that yields
  bool keeps_steps() const {
    return has_physics && tangential == RP_TANGENTIAL_FULL && regime != motion::steady;
  }
  bool yields() const { return law && law->plastic(); }
  double tolerance = 1e-5;
  double normal_tolerance = 1e-5;
  int max_iterations = 100;
  bool spin_offset = false;  // x + dq/6 in the spin term
  bool derivatives = false;  // patch_contact::differentiate is asked for
  bool stretches = false;    // grids whose dx and dy change at different rates
  bool curved = false;       // reference surface, of wheels
  int fitted[2] = {0, 0};    // nodes and strips of the tangential problem; 0: on the uniform grid
  fast_options fast;         // where the tangential theory is a fast one
  std::optional<heat_scene> heat;       // where temperatures are asked for
  bool prescribed[2] = {false, false};  // components of the creep force: their creepage is found
  double friction() const { return friction_coefficient * friction_scale; }
  bool is_forced() const { return prescribed[0] || prescribed[1]; }
  // false: beside the exact theory, by choice
  bool estimates_force() const;
  bool is_fitted() const { return tangential == RP_TANGENTIAL_FULL && fitted[0] > 0; }
  // Pressure and traction act on each other, and both are there.
  bool couples() const {
    return has_physics && tangential == RP_TANGENTIAL_FULL && (curved || is_coupled(elastic));
  }
  // No pressure and no traction on a uniform grid: all is closed form or on rows of its own.
  bool closed_form() const {
    return normal == RP_NORMAL_HERTZ &&
           (is_fitted() || (is_fast(tangential) && !has_tractions(tangential)));
  }
  // Whether the solution's derivatives come from its equations (patch_derivative.hpp).
  bool differentiates() const;
  double modulus() const { return elastic.shear_modulus / (1.0 - elastic.poisson_ratio); }
};

// Tractions of a wheel's last step, in rows of what a patch remembers, as seen from the grid of a
// problem: its element (0, 0) was at offset from that of the first row.
struct past_tractions {
  const patch_history *history;
  int first_row, rows;
  double offset[2];  // m
};

// One step's problem; the undeformed distance is in patch_memory.
struct patch_problem {
  grid g;
  bool force_given = false;
  double force = 0, approach = 0;
  double rolling_speed = 0;  // m/s; 0: standstill, no tangential traction arises
  rolling_input rolling;
  double tangential_force[2] = {0, 0};  // N, of the components prescribed
  hertz_contact hertz;                  // where the surfaces are quadratic, else all zero
  contact_parts parts;
  const past_tractions *past = nullptr;  // of wheels in transient rolling, with their number
  int past_count = 0;
};

// Fields of the last solution, [ny][nx] of the grid or, for what belongs to the tangential problem
// of fitted rows, [strip][node]; with the grid they are also the next start.
struct patch_memory {
  patch_memory() = default;
  // max_count: elements of the greatest grid.
  patch_memory(int max_count, int max_rows, const patch_scene &scene);
  bool solved = false;  // fields belong to the last step
  bool warm = false;    // pressure and traction may serve as a start
  bool beyond = false;  // the normal problem left its range: what the patch carries is not known
  grid g;
  double share = 1;                   // in the wheel's force
  double rail[2] = {0, 0};            // m, lateral and vertical offset of the rail
  double approach = 0;                // m, of the last step's normal problem on the half-space
  std::array<double, 3> reference{};  // m, contact reference, track axes of a right wheel
  aligned_buffer<double> undeformed_distance, pressure, px, py, sx, sy;
  aligned_buffer<unsigned char> division;
  aligned_buffer<double> node_x, node_y, node_pressure;  // fitted rows only
  aligned_buffer<double> row_friction;                   // factor of each grid row, where it varies
  aligned_buffer<double> creepage;                       // [2], of a prescribed creep force only
  std::array<double, error_feature_count> error_features{};
  patch_history history;
  physics_part<heat_memory> heat;
  physics_part<conformal_rows> curved;
  bool fitted() const { return node_x.size() > 0; }
  // elements of the tangential problem along rolling and lateral
  int columns() const { return fitted() ? static_cast<int>(node_x.size() / node_y.size()) : g.nx; }
  int rows() const { return fitted() ? static_cast<int>(node_y.size()) : g.ny; }
  tangential_fields fields() {
    return {px.data(), py.data(), sx.data(), sy.data(), division.data()};
  }
  fitted_fields nodes() { return {node_x.data(), node_y.data(), node_pressure.data(), fields()}; }
  size_t bytes() const;
};

class patch_contact {
 public:
  patch_contact(const patch_scene &scene, const fft_plans &plans, int max_nx, int max_ny,
                rp_observer observer, void *observer_user);

  // The memory's distance must be filled for problem.g, its other fields hold the last solution on
  // problem.g (see start_from). Fills everything of result that belongs to the patch itself.
  void solve(const patch_problem &problem, patch_memory &memory, rp_patch_result &result,
             patch_wrench &wrench);
  // Begins a step on the grid of the last one, in shift and transient rolling; before start_from.
  void begin_step(const patch_problem &problem, patch_memory &memory) {
    if (!scene_.keeps_steps()) return;
    observe(RP_STAGE_HISTORY, true);
    if (coupled_)
      coupled_->remember(problem.g, memory.history.begun ? memory.pressure.data() : nullptr);
    memory.history.begin(problem.g, problem.rolling.upstream(), memory.px.data(), memory.py.data());
    observe(RP_STAGE_HISTORY, false);
  }
  // The same for patches of wheels, whose grids move.
  void remember(patch_memory &memory) const {
    memory.history.remember(memory.g,
                            {memory.reference[0], memory.reference[1] - memory.rail[0],
                             memory.reference[2] - memory.rail[1]},
                            memory.share, memory.px.data(), memory.py.data());
  }
  // A step without contact: the material moves on and bears no traction.
  void leave_contact(const rolling_input &step, patch_memory &memory, rp_patch_result &result);
  // Carries the memory's solution over to another grid, or clears it.
  void start_from(patch_memory &memory, const grid &g);

  // Derivatives of the last step's solution, which `memory` holds, in `count` directions; for
  // scenes with derivatives, which differentiate. The memory and later steps stay as they are.
  bool differentiates() const { return derivative_.has_value(); }
  derivative_outcome differentiate(const patch_problem &problem, const patch_memory &memory,
                                   const patch_variation *in, int count,
                                   const derivative_options &options, patch_change *out);
  bool fits(const grid &g) const { return g.nx <= max_nx_ && g.ny <= max_ny_; }
  const patch_scene &scene() const { return scene_; }
  void set_friction_coefficient(double value) { scene_.friction_coefficient = value; }
  void set_friction_scale(double value) { scene_.friction_scale = value; }
  // degrees C, of body k: wheel, rail
  void set_bulk_temperature(int k, double value) {
    if (!heat_) return;
    scene_.heat->bodies.body[k].bulk = value;
    heat_->set_bulk(k, value);
  }
  size_t influence_bytes() const { return influence_ ? influence_->bytes() : 0; }
  size_t coupling_bytes() const { return coupled_ ? coupled_->bytes() : 0; }
  size_t history_bytes() const { return tangential_ ? tangential_->history_bytes() : 0; }
  size_t plastic_bytes() const { return tangential_ ? tangential_->plastic_bytes() : 0; }
  size_t normal_bytes() const {
    return (normal_ ? normal_->bytes() : 0) + (rows_ ? rows_->bytes() : 0);
  }
  // with the last two
  size_t tangential_bytes() const;
  size_t derivative_bytes() const { return derivative_ ? derivative_->bytes() : 0; }
  size_t heat_bytes() const { return heat_ ? heat_->bytes() : 0; }
  void observe(rp_stage stage, bool entering) const {
    if (observer_) observer_(observer_user_, stage, entering);
  }

 private:
  void describe_grid(const patch_problem &problem, rp_patch_result &result) const;
  void begin_solve(const patch_problem &problem, patch_memory &memory);
  bool find_pressure(const patch_problem &problem, patch_memory &memory, rp_patch_result &result);
  void sum_forces(const patch_problem &problem, patch_memory &memory, rp_patch_result &result,
                  patch_wrench &wrench);
  bool solve_normal(const patch_problem &problem, patch_memory &memory, rp_patch_result &result);
  void solve_half_space(const patch_problem &problem, patch_memory &memory,
                        rp_patch_result &result);
  void solve_rows(const patch_problem &problem, patch_memory &memory, rp_patch_result &result);
  void solve_hertz(const patch_problem &problem, patch_memory &memory, rp_patch_result &result);
  bool solve_tangential(const patch_problem &problem, patch_memory &memory,
                        rp_patch_result &result);
  rolling_input rolling_of(const patch_problem &problem, patch_memory &memory,
                           prescribed_force &force);
  tangential_result solve_by_theory(const patch_problem &problem, const rolling_input &rolling,
                                    patch_memory &memory, rp_patch_result &result);
  bool solve_in_turn(const patch_problem &problem, patch_memory &memory, rp_patch_result &result);
  void leave_unloaded(const patch_problem &problem, patch_memory &memory);
  void add_slip_of_rows(const grid &g, const conformal_rows &rows, rolling_input &rolling);
  tangential_result solve_fitted(const patch_problem &problem, const rolling_input &rolling,
                                 patch_memory &memory);
  // mu: of each element, null: as in the scene
  void set_bound(const grid &g, const patch_memory &memory, const double *mu);
  tangential_result solve_on_grid(const patch_problem &problem, const rolling_input &rolling,
                                  patch_memory &memory, rp_patch_result &result, const double *mu);
  void begin_heat(const patch_problem &problem, patch_memory &memory);
  void find_before(const patch_problem &problem, rolling_input &rolling);
  double finish_heat(const patch_problem &problem, patch_memory &memory);
  // W/m^2, of the tractions in memory
  void flux_of(const patch_problem &problem, const patch_memory &memory, double *q);
  tangential_result solve_with_heat(const patch_problem &problem, const rolling_input &rolling,
                                    patch_memory &memory, rp_patch_result &result);
  double tangential_energy(const patch_problem &problem, const patch_memory &memory);
  void estimate_error(const patch_problem &problem, patch_memory &memory,
                      rp_patch_result &result) const;

  patch_scene scene_;
  int max_nx_, max_ny_;
  rp_observer observer_;
  void *observer_user_;
  std::optional<influence> influence_;
  std::optional<normal_solver> normal_;
  std::optional<row_contact> rows_;
  std::optional<tangential_solver> tangential_;
  std::optional<coarse_start> coarse_start_;  // of fine grids
  std::optional<contact_rows> fitted_rows_;
  std::optional<fitted_solver> fitted_;
  std::optional<fast_solver> fast_;
  physics_part<temperature_stage> heat_;
  physics_part<coupled_contact> coupled_;
  std::optional<patch_derivative> derivative_;
  error_model errors_;
  creep_resultants sums_;  // of the last step, where the theory has no tractions
  aligned_buffer<double> bound_, scratch_[2], before_[2];
};

// Worse of two outcomes, for results that several stages contribute to.
inline void degrade(rp_patch_result &result, rp_status status) {
  if (result.status == RP_CONVERGED) result.status = status;
}

}  // namespace railpatch
