// The tangential problem of one patch: which theory, and what drives it.
#pragma once

#include <optional>

#include "fast/fast.hpp"
#include "half_space/forces.hpp"
#include "patch/heat_stage.hpp"
#include "patch/outcomes.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_workspace.hpp"
#include "tangential/coarse_start.hpp"
#include "tangential/fitted.hpp"
#include "tangential/tangential.hpp"

namespace railpatch {

// N, of plastic displacement over the way of a step, by the mean traction of both ends and by the
// mean yield stress of both.
struct plastic_sums {
  double by_mean = 0, by_yield = 0;
};

class tangential_stage {
 public:
  tangential_stage(patch_workspace &shared, const fft_plans &plans, int max_nx, int max_ny);

  // The tractions in the memory are the start, and the solution.
  traction_outcome solve(const patch_problem &problem, const pressure_outcome &pressure,
                         patch_memory &memory, heat_stage &heat);
  // The resultants of theories whose tractions are not on the patch's grid.
  void set_resultants(const traction_outcome &found, patch_memory &memory,
                      patch_wrench &wrench) const;
  bool on_grid() const { return !fitted_; }
  const table_forces *tables() const { return fast_ ? fast_->tables() : nullptr; }
  const creep_table *table() const { return fast_ ? fast_->table() : nullptr; }
  const shape_table *shapes() const { return fast_ ? fast_->shapes() : nullptr; }
  row_blocks *blocks() { return tangential_ ? tangential_->blocks() : nullptr; }
  size_t history_bytes() const { return tangential_ ? tangential_->history_bytes() : 0; }
  size_t plastic_bytes() const { return tangential_ ? tangential_->plastic_bytes() : 0; }
  // with the last two
  size_t bytes() const;

 private:
  rolling_input rolling_of(const patch_problem &problem, const patch_memory &memory,
                           prescribed_force &force);
  double spin_offset_of(const patch_problem &problem, const patch_memory &memory,
                        const rolling_input &rolling) const;
  void prescribe(const patch_problem &problem, const patch_memory &memory, rolling_input &rolling,
                 prescribed_force &force) const;
  void find_before(const patch_problem &problem, const patch_memory &memory,
                   rolling_input &rolling);
  void find_curved_before(const patch_problem &problem, const conformal_rows &rows,
                          rolling_input &rolling);
  void add_slip_of_rows(const grid &g, const conformal_rows &rows, rolling_input &rolling);
  void explain(const patch_problem &problem, const pressure_outcome &pressure,
               const tangential_result &t, traction_outcome &found) const;
  tangential_result solve_by_theory(const patch_problem &problem, const pressure_outcome &pressure,
                                    const rolling_input &rolling, patch_memory &memory,
                                    heat_stage &heat, traction_outcome &found);
  tangential_result solve_regimes(const fast_patch &patch, const rolling_input &rolling,
                                  creep_resultants &sums);
  tangential_result solve_with_heat(const patch_problem &problem, const rolling_input &rolling,
                                    patch_memory &memory, heat_stage &heat,
                                    traction_outcome &found);
  tangential_result solve_fitted(const patch_problem &problem, const rolling_input &rolling,
                                 patch_memory &memory);
  // mu: of each element, null: as in the scene
  tangential_result solve_on_grid(const patch_problem &problem, const rolling_input &rolling,
                                  patch_memory &memory, const double *mu, traction_outcome &found);
  tangential_result solve_by_law(const patch_problem &problem, const rolling_input &rolling,
                                 patch_memory &memory, const tangential_options &options,
                                 traction_outcome &found);
  tangential_result solve_viscous(const patch_problem &problem, const rolling_input &rolling,
                                  patch_memory &memory, const tangential_options &options,
                                  traction_outcome &found);
  void set_bound(const grid &g, const patch_memory &memory, const double *mu);
  double elastic_energy(const patch_problem &problem, patch_memory &memory);
  double greatest_traction(const patch_memory &memory) const;
  double capacity(const patch_problem &problem, const pressure_outcome &pressure,
                  const patch_memory &memory, const heat_stage &heat) const;
  // of friction_work.cpp
  void close_step(const patch_problem &problem, const rolling_input &rolling, patch_memory &memory,
                  tangential_result &t, traction_outcome &found);
  void close_coupled(const patch_problem &problem, const rolling_input &rolling,
                     const patch_memory &memory, tangential_result &t, traction_outcome &found);
  void close_steady(const patch_problem &problem, const rolling_input &rolling,
                    const patch_memory &memory, tangential_result &t, traction_outcome &found);
  // of shift_work.cpp
  void close_shift(const patch_problem &problem, const rolling_input &rolling,
                   const patch_memory &memory, double grown, tangential_result &t,
                   traction_outcome &found);
  plastic_sums plastic_works(const patch_problem &problem, const rolling_input &rolling,
                             const patch_memory &memory) const;
  void close_curved(const patch_problem &problem, const rolling_input &rolling,
                    patch_memory &memory, tangential_result &t, traction_outcome &found);
  double supplied_to_rows(const patch_problem &problem, const patch_memory &memory) const;
  void add_slip_field(const patch_problem &problem, rolling_input &rolling);
  double field_work(const patch_problem &problem, const rolling_input &rolling,
                    const patch_memory &memory);
  double rigid_work(const patch_problem &problem, const rolling_input &rolling,
                    const prescribed_force &force, const patch_memory &memory) const;
  void find_friction(const patch_problem &problem, const rolling_input &rolling,
                     const patch_memory &memory);
  void find_friction_heat(const patch_problem &problem, const rolling_input &rolling,
                          const patch_memory &memory, double taken);
  double fluid_work(const grid &g, int direction, const patch_memory &memory) const;

  patch_workspace &shared_;
  std::optional<tangential_solver> tangential_;
  std::optional<coarse_start> coarse_start_;  // of fine grids
  std::optional<contact_rows> fitted_rows_;
  std::optional<fitted_solver> fitted_;
  std::optional<fast_solver> fast_;
  aligned_buffer<double> bound_, before_[2];
  // of a curved reference surface: what of it the pressure did, the gap by the last step's
  // tractions, cosine and sine of its rows
  aligned_buffer<double> before_pressed_[2], before_gap_, last_rows_[2];
};

}  // namespace railpatch
