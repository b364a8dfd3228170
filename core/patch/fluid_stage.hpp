// The liquid in one patch, before its tangential problem: film, share of the asperities, and the
// friction coefficient that the theories take. Without liquid in the scene it does nothing.
#pragma once

#include "patch/outcomes.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_workspace.hpp"

namespace railpatch {

class fluid_stage {
 public:
  explicit fluid_stage(patch_workspace &shared) : shared_(shared) {}

  // Sets the scene's friction coefficient of this patch and step.
  fluid_outcome solve(const patch_problem &problem, const pressure_outcome &pressure,
                      const patch_memory &memory);

 private:
  patch_workspace &shared_;
};

}  // namespace railpatch
