// The heat of one patch: friction by temperature, and the temperature that a step leaves. Without
// temperatures in the scene it does nothing.
#pragma once

#include "patch/outcomes.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_workspace.hpp"
#include "temperature/stage.hpp"

namespace railpatch {

class heat_stage {
 public:
  heat_stage(patch_workspace &shared, int max_nx, int max_ny);

  // degrees C, of body k: wheel, rail
  void set_bulk(int k, double value);
  // Whether friction depends on what is found.
  bool feeds_back() const { return stage_ && stage_->feeds_back(); }
  // Whether the material's memory of heat waits for the contact area that the tractions leave.
  bool begins_late() const { return shared_.coupled && stage_ && !stage_->feeds_back(); }
  void begin(const patch_problem &problem, patch_memory &memory);
  // Finds tractions and friction by temperature in turn. `pass(mu)` solves for the tractions and
  // tells whether it could; each pass starts from those of the last one.
  template <class Pass>
  temperature_loop_result solve(const patch_problem &problem, patch_memory &memory, Pass &&pass) {
    const stage_mark mark = shared_.marks.enter(RP_STAGE_TEMPERATURE);
    const patch_scene &scene = shared_.scene;
    const auto heated = [&](const double *mu, double *q) {
      const bool solved = pass(mu);
      set_flux(problem, memory, q);
      return solved;
    };
    return stage_->solve(memory.pressure.data(), {scene.tolerance, scene.max_iterations},
                         *memory.heat, heated);
  }
  heat_outcome finish(const patch_problem &problem, patch_memory &memory);
  size_t bytes() const { return stage_ ? stage_->bytes() : 0; }

 private:
  // W/m^2, of the tractions in memory
  void set_flux(const patch_problem &problem, const patch_memory &memory, double *q);

  patch_workspace &shared_;
  physics_part<temperature_stage> stage_;
};

}  // namespace railpatch
