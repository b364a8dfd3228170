// What a patch is solved by: bodies, friction, theories and limits, as the handle has made them.
#pragma once

#include <optional>

#include "fast/fast.hpp"
#include "fluid/mixed.hpp"
#include "half_space/coupling.hpp"
#include "half_space/physics.hpp"
#include "half_space/viscous_influence.hpp"
#include "numeric/interrupt.hpp"
#include "railpatch.h"
#include "tangential/friction_factor.hpp"
#include "tangential/tangential.hpp"
#include "temperature/stage.hpp"

namespace railpatch {

// Constant over the life of a handle, but for the friction coefficient and its scale.
struct patch_scene {
  elastic_constants elastic;
  viscous_bodies viscous;  // of patches in steady rolling
  // influence coefficients in place of the half-space's; values: the caller's, while the handle is
  // made
  struct own_coefficients {
    const double *values = nullptr;
    int columns = 0, rows = 0;
  };
  own_coefficients own;
  double friction_coefficient = 0;  // of Coulomb's law, or of dry surfaces
  friction_factor friction_variation;
  double friction_scale = 1.0;   // of the law, in this step
  double layer_flexibility = 0;  // m/Pa
  double line_width = 0;         // m, > 0: line contact
  rp_normal_method normal = RP_NORMAL_HALF_SPACE;
  rp_tangential_method tangential = RP_TANGENTIAL_FULL;  // NONE: no tangential stage
  bool has_regime = true;  // false: the motion asks for none, whatever the method
  motion regime = motion::steady;
  bool changes = false;          // of regime, between steps
  bool moves = false;            // the grid moves between steps: of wheels
  std::optional<bound_law> law;  // beyond Coulomb's, or a layer that yields
  bool keeps_steps() const {
    return has_physics && tangential == RP_TANGENTIAL_FULL && (changes || regime != motion::steady);
  }
  // A step begins with the last one's tractions: those of steady rolling are their own.
  bool goes_on(const rolling_input &step) const {
    return keeps_steps() && step.regime != motion::steady;
  }
  bool yields() const { return law && law->plastic(); }
  double tolerance = 1e-5;
  double normal_tolerance = 1e-5;
  int max_iterations = 100;
  double spin_offset = 0;        // of a step's way, added to x in the spin term
  double step_spin_offset = 0;   // the same of transient rolling
  bool slip_by_element = false;  // steps have a rigid slip of each element
  bool strips = false;           // the grid given has only one or two elements either way
  bool usual_spin = true;        // that is the one by default
  bool derivatives = false;      // rates of results are asked for
  interrupt ask{};               // of the caller, between iterations
  bool exact = false;            // and come from the solved equations, of the whole scene
  bool stretches = false;        // grids whose dx and dy change at different rates
  bool curved = false;           // reference surface, of wheels
  // pressure acts along those of the rail's surface, of wheels, which differ along rows too
  bool local_normals = false, slopes_along_rows = false;
  int fitted[2] = {0, 0};  // nodes and strips of the tangential problem; 0: on the uniform grid
  fast_options fast;       // where the tangential theory is a fast one
  std::optional<heat_scene> heat;       // where temperatures are asked for
  physics_part<fluid_scene> fluid;      // where a liquid is between the bodies
  fluid_supply supply;                  // of it, in this step
  double wet_friction = 0;              // the coefficient with it, of the patch being solved
  bool prescribed[2] = {false, false};  // components of the creep force: their creepage is found
  double coefficient() const { return fluid ? wet_friction : friction_coefficient; }
  double friction() const { return coefficient() * friction_scale; }
  // The liquid's pressure is found element by element.
  bool has_ehl() const { return fluid && fluid->model == RP_FLUID_EHL; }
  bool has_strips() const { return fluid && fluid->model == RP_FLUID_STRIP && !closed_form(); }
  bool is_forced() const { return prescribed[0] || prescribed[1]; }
  // false: beside the exact theory, by choice
  bool estimates_force() const;
  bool is_fitted() const { return tangential == RP_TANGENTIAL_FULL && fitted[0] > 0; }
  // The exact theory of traction on the uniform grid.
  bool full_on_grid() const { return tangential == RP_TANGENTIAL_FULL && !is_fitted(); }
  bool needs_influence() const { return normal == RP_NORMAL_HALF_SPACE || full_on_grid(); }
  // What the influence coefficients are made of.
  influence::medium medium() const;
  // Pressure and traction act on each other, and both are there.
  bool couples() const {
    return has_physics && tangential == RP_TANGENTIAL_FULL && (curved || is_coupled(elastic));
  }
  // The pressure is that of a plane half-space, whose energy turns with the frame (docs/power.md).
  bool turns() const { return local_normals && normal == RP_NORMAL_HALF_SPACE && !curved; }
  // No pressure and no traction on a uniform grid: all is closed form or on rows of its own.
  bool closed_form() const {
    return normal == RP_NORMAL_HERTZ &&
           (is_fitted() || (is_fast(tangential) && !has_tractions(tangential)));
  }
  // Whether a patch's derivatives can come from its equations (patch_derivative.hpp).
  bool differentiates() const;
  bool is_viscous() const { return has_physics && viscous.any(); }
  bool has_own_influence() const { return has_physics && own.columns > 0; }
  // Viscoelastic bodies' contact is bounded by the one after all time.
  double modulus() const {
    const elastic_constants e = is_viscous() ? viscous.relaxed() : elastic;
    return e.shear_modulus / (1.0 - e.poisson_ratio);
  }
};

}  // namespace railpatch
