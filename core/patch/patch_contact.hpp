// One contact patch from undeformed distance to forces: the order of the stages.
#pragma once

#include <optional>

#include "half_space/forces.hpp"
#include "patch/error_estimate.hpp"
#include "patch/fluid_stage.hpp"
#include "patch/heat_stage.hpp"
#include "patch/normal_stage.hpp"
#include "patch/outcomes.hpp"
#include "patch/patch_derivative.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_workspace.hpp"
#include "patch/report.hpp"
#include "patch/tangential_stage.hpp"
#include "railpatch.h"

namespace railpatch {

class patch_contact {
 public:
  patch_contact(const patch_scene &scene, const fft_plans &plans, int max_nx, int max_ny,
                stage_marks marks);

  // The memory's distance must be filled for problem.g, its other fields hold the last solution on
  // problem.g (see start_from). Fills everything of result that belongs to the patch itself.
  void solve(const patch_problem &problem, patch_memory &memory, rp_patch_result &result,
             patch_wrench &wrench);
  // Begins a step on the grid of the last one, in shift and transient rolling; before start_from.
  void begin_step(const patch_problem &problem, patch_memory &memory);
  // The same for patches of wheels, whose grids move.
  void remember(patch_memory &memory) const;
  // A step without contact: the material moves on and bears no traction.
  heat_outcome leave_contact(const rolling_input &step, patch_memory &memory);
  // Carries the memory's solution over to the problem's grid, or clears it, and tells the problem
  // whether that goes on from one nearly like it.
  void start_from(patch_memory &memory, patch_problem &problem);

  // Derivatives of the last step's solution, which `memory` holds, in `count` directions; for
  // scenes with exact ones. The memory and later steps stay as they are.
  derivative_outcome differentiate(const patch_problem &problem, const patch_memory &memory,
                                   const patch_variation *in, int count,
                                   const derivative_options &options, patch_change *out);
  bool fits(const grid &g) const { return g.nx <= max_nx_ && g.ny <= max_ny_; }
  const patch_scene &scene() const { return shared_.scene; }
  const stage_marks &marks() const { return shared_.marks; }
  void set_friction_coefficient(double value) { shared_.scene.friction_coefficient = value; }
  void set_friction_scale(double value) { shared_.scene.friction_scale = value; }
  void set_bulk_temperature(int k, double value) { heat_.set_bulk(k, value); }
  void set_fluid_supply(const fluid_supply &supply) { shared_.scene.supply = supply; }
  void set_cleaning_work(double value) { shared_.scene.supply.work = value; }
  void set_oxide_water(double value) { shared_.scene.supply.oxide_water = value; }
  size_t influence_bytes() const {
    return (shared_.influence ? shared_.influence->bytes() : 0) +
           (shared_.viscous ? shared_.viscous->bytes() : 0);
  }
  size_t coupling_bytes() const { return shared_.coupled ? shared_.coupled->bytes() : 0; }
  size_t history_bytes() const {
    return tangential_.history_bytes() + (shared_.scene.keeps_steps() ? work_bytes() : 0);
  }
  size_t plastic_bytes() const { return tangential_.plastic_bytes(); }
  size_t fluid_bytes() const { return fluid_.bytes(); }
  size_t normal_bytes() const { return normal_.bytes(); }
  // with those of history and plasticity
  size_t tangential_bytes() const { return tangential_.bytes() + work_bytes(); }
  size_t derivative_bytes() const { return derivative_ ? derivative_->bytes() : 0; }
  size_t heat_bytes() const {
    return heat_.bytes() + (shared_.scene.heat ? shared_.friction_bytes() : 0);
  }
  // of what the stages pass on to each other
  size_t scratch_bytes() const { return 2 * shared_.scratch[0].bytes(); }

 private:
  // of friction's work, where it is not the heat's
  size_t work_bytes() const { return shared_.scene.heat ? 0 : shared_.friction_bytes(); }
  void warm_liquid(const patch_problem &problem, patch_memory &memory, pressure_outcome &n,
                   fluid_outcome &f, traction_outcome &t, heat_outcome &h);
  void begin_solve(const patch_problem &problem, patch_memory &memory);
  pressure_outcome find_pressure(const patch_problem &problem, patch_memory &memory);
  traction_outcome find_tractions(const patch_problem &problem, pressure_outcome &n,
                                  patch_memory &memory);
  traction_outcome solve_in_turn(const patch_problem &problem, pressure_outcome &n,
                                 patch_memory &memory);
  patch_wrench sum_forces(const patch_problem &problem, const pressure_outcome &n,
                          const traction_outcome &t, patch_memory &memory) const;
  void complete(const patch_problem &problem, patch_memory &memory, patch_wrench &wrench) const;
  void estimate_error(const patch_problem &problem, const pressure_outcome &n, patch_memory &memory,
                      rp_patch_result &result) const;
  void unload(const grid &g, patch_memory &memory);

  patch_workspace shared_;
  int max_nx_, max_ny_;
  normal_stage normal_;
  tangential_stage tangential_;
  heat_stage heat_;
  fluid_stage fluid_;
  std::optional<patch_derivative> derivative_;
  error_model errors_;
};

}  // namespace railpatch
