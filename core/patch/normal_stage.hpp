// The normal problem of one patch by the scene's theory: pressure and approach.
#pragma once

#include <optional>

#include "normal/active_set.hpp"
#include "normal/normal.hpp"
#include "normal/row_contact.hpp"
#include "patch/outcomes.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_workspace.hpp"

namespace railpatch {

class normal_stage {
 public:
  normal_stage(patch_workspace &shared, int max_nx, int max_ny);

  // The pressure in the memory is the start, and the solution.
  pressure_outcome solve(const patch_problem &problem, patch_memory &memory);
  normal_solver *solver() { return normal_ ? &*normal_ : nullptr; }
  size_t bytes() const {
    return (normal_ ? normal_->bytes() : 0) + (viscous_ ? viscous_->bytes() : 0) +
           (rows_ ? rows_->bytes() : 0);
  }

 private:
  pressure_outcome solve_half_space(const patch_problem &problem, patch_memory &memory);
  normal_result solve_viscous(const patch_problem &problem, const normal_options &options,
                              const double *h, double *pressure);
  pressure_outcome solve_rows(const patch_problem &problem, patch_memory &memory);
  pressure_outcome solve_hertz(const patch_problem &problem, patch_memory &memory) const;

  patch_workspace &shared_;
  std::optional<normal_solver> normal_;
  physics_part<active_set_solver> viscous_;  // of viscoelastic bodies, in its place
  std::optional<row_contact> rows_;
};

}  // namespace railpatch
