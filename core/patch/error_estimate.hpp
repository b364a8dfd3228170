// How far a solved patch's creep force, spin moment and greatest pressure are from the exact theory
// of rolling contact, told from what is known after the solution, without a second one.
//
// A model of each theory, fitted to measured errors (error_model.inc, made by
// python -m railpatch.evidence.bench.calibrate), gives the bound that 95 % or more of the errors
// stay below:
//   creep force   mu Fn s/(1 + s) exp(model), at least mu Fn min(1, s) floor; length of the vector
//   spin moment   the same times c
//   pressure      p_max exp(model)
// Creep forces from a table have the error that the table states as a further factor.
// with s the sum of scaled creepage and spin (see features), c^2 = a b. The floor is the accuracy
// of the results that the errors were measured against. The model is a network of one hidden layer,
//   model(f) = w0 + sum_k w_k g(v_k0 + v_k . f),  g(t) = t/(1 + |t|),
// with a constant for each theory of the normal problem besides.
// On grids finer than those of the fit the exact theory's estimates fall on by a power, all others
// stay. Every feature is the same for the patch's mirror images and in any units, so the estimate
// is too.
#pragma once

#include "fast/coefficients.hpp"
#include "half_space/influence.hpp"
#include "normal/hertz.hpp"
#include "numeric/nan.hpp"
#include "railpatch.h"
#include "tangential/tangential.hpp"

namespace railpatch {

// the first of them describe the contact area and the grid, the others the motion
constexpr int pressure_feature_count = 12, error_feature_count = RP_ERROR_FEATURES;

// The contact area as a grid of elements has it; zeros where it is a closed form.
struct contact_extent {
  int across[2] = {0, 0};     // elements of the bounding box of contact
  double centre[2] = {0, 0};  // m, of pressure
  double width = 0;           // m, lateral
  double box_share = 1;       // -, of the bounding box that is in contact, over that of an ellipse
  double spread[2] = {1, 1};  // -, variance of the pressure over that of an ellipse in the box
};
contact_extent extent_of(const grid &g, const double *pressure);

// What the estimate is made from besides the result.
struct estimated_patch {
  rp_normal_method normal;
  rp_tangential_method tangential;
  const hertz_contact &hertz;  // where the pressure is Hertz's
  contact_extent extent;       // else
  int tangential_grid[2];      // elements across the contact, nodes and rows; 0: closed form
  bool fitted;
  double stated[2];  // -, errors of force and moment that a table states; else 1
  double friction_coefficient;
  rolling_input rolling;
  bool states_all = false;  // those are of this kind of contact, no factor of the model's
};

// Each stays below it with 95 % or more of cases; NaN: not known.
struct error_bounds {
  double creep_force = nan, spin_moment = nan, max_pressure = nan;
};

class error_model {
 public:
  // layer_flexibility: m/Pa
  error_model(const elastic_constants &elastic, double layer_flexibility);
  // Of a patch in contact, by its result so far; fills features [error_feature_count].
  error_bounds estimate(const estimated_patch &patch, const rp_patch_result &result,
                        double *features) const;

 private:
  struct scaled_motion;
  scaled_motion scaled(const estimated_patch &patch, const double axes[2], double capacity) const;
  void describe_area(const estimated_patch &patch, const rp_patch_result &result,
                     const double axes[2], double *features) const;
  void describe_motion(const estimated_patch &patch, const rp_patch_result &result,
                       const scaled_motion &m, double force, double length, double *features) const;

  elastic_constants elastic_;
  double layer_flexibility_;
  coefficient_table table_;
};

}  // namespace railpatch
