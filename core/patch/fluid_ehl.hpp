// Elastohydrodynamic lubrication of one patch (fluid/ehl.hpp): in place of the dry pressure that of
// asperities and liquid, on the patch's grid, and the liquid's shear that is added to the bound of
// the tractions.
//
// The liquid's shear stress is Eyring's, tau = tau_E asinh(eta gamma/tau_E), not above a limit
// times its pressure, with gamma the rigid slip of the place over the film (assumed: where the
// liquid bears the load the bodies' own slip is small beside it). With a conductivity of the liquid
// eta is that of the film's mean temperature, which its own shear raises (parabola across the film
// with even heating; after Johnson and Greenwood 1980, Wear 61, not verified); the inlet, where the
// film forms, is as warm as before.
#pragma once

#include "fluid/ehl.hpp"
#include "fluid/mixed.hpp"
#include "numeric/interrupt.hpp"
#include "patch/outcomes.hpp"
#include "patch/patch_memory.hpp"
#include "patch/patch_scene.hpp"

namespace railpatch {

class fluid_ehl {
 public:
  fluid_ehl(int max_nx, int max_ny) : solver_(max_nx, max_ny) {}

  // temperature: degrees C, of the liquid. Writes the patch's pressure, what of it is the liquid's,
  // film and shear, and what the pressure stage had found of the dry contact.
  fluid_outcome solve(const patch_problem &problem, const patch_scene &scene, double temperature,
                      influence &a, patch_memory &memory, pressure_outcome &pressure);
  double boundary() const { return boundary_; }  // -, of asperities, of the last solve
  size_t bytes() const { return solver_.bytes(); }

 private:
  double entry() const;
  double take_over(const patch_problem &problem, const ehl_problem &lubricated,
                   patch_memory &memory, pressure_outcome &pressure);
  double add_shear(const patch_problem &problem, const patch_scene &scene,
                   const ehl_problem &lubricated, double temperature, patch_memory &memory) const;

  ehl_solver solver_;
  double boundary_ = 0;
};

}  // namespace railpatch
