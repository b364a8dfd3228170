// The liquid in one patch, before its tangential problem: film, share of the asperities, and the
// friction coefficient that the theories take. Without liquid in the scene it does nothing.
#pragma once

#include <optional>

#include "patch/fluid_ehl.hpp"
#include "patch/fluid_strips.hpp"
#include "patch/outcomes.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_workspace.hpp"

namespace railpatch {

class fluid_stage {
 public:
  fluid_stage(patch_workspace &shared, int max_nx, int max_ny);

  // Sets the scene's friction coefficient of this patch and step; elastohydrodynamic lubrication
  // changes the pressure too.
  fluid_outcome solve(const patch_problem &problem, pressure_outcome &pressure,
                      patch_memory &memory);
  void begin();  // a step: the liquid is as warm as before the contact
  // Whether the liquid's viscosity follows the surfaces' temperature in the contact, which the
  // friction with it heats: an outer loop.
  bool follows_heat() const;
  // Takes the temperature of the surfaces that the last round left, for the next one. Returns the
  // change (K), of a scale of 1 K.
  double follow(const grid &g, const patch_memory &memory);
  size_t bytes() const {
    return (strips_ ? sizeof(fluid_strips) + strips_->bytes() : 0) + (ehl_ ? ehl_->bytes() : 0);
  }

 private:
  fluid_outcome solve_film(double temperature, const patch_problem &problem, double force,
                           patch_memory &memory);
  fluid_outcome solve_ehl(double temperature, const patch_problem &problem, patch_memory &memory,
                          pressure_outcome &pressure);
  fluid_outcome solve_strips(const hertz_contact &hertz, double temperature,
                             const patch_problem &problem, patch_memory &memory);

  patch_workspace &shared_;
  std::optional<fluid_strips> strips_;
  std::optional<fluid_ehl> ehl_;
  double now_ = nan, before_ = nan, change_before_ = nan;  // degrees C, K: of follow
};

}  // namespace railpatch
