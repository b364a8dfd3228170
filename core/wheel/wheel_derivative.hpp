// Exact derivatives of one wheel's solution by what moves: those of its geometry
// (geometry/rates.hpp) and of its patches (patch/patch_derivative.hpp) put together.
//
// Everything here is a right-hand wheel. Derivatives are those of the solution's choices: parts
// that touch, intervals solved as a patch, elements in contact, in stick and in slip stay so; where
// a greatest or least value passes from one place to the next they are those of the place it has.
#pragma once

#include <vector>

#include "geometry/patch.hpp"
#include "geometry/rates.hpp"
#include "patch/patch_contact.hpp"
#include "railpatch.h"

namespace railpatch {

// What was solved on one patch of a wheel, beside what patch_memory keeps.
struct patch_solution {
  bool solved = false;
  patch_problem problem;
  patch_wrench wrench;  // before the share
  double depth = 0;     // m, greatest interpenetration
};

// The last solution of a wheel.
struct wheel_solution {
  const side_geometry &geometry;
  const patch_rules &rules;
  const part_set &parts;
  const patch_region *regions;
  const patch_solution *patches;
  const patch_memory *memory;
  int count;            // of patches
  const int *elements;  // across the bounds, along rolling and lateral; null: of fixed size
};

class wheel_derivative {
 public:
  // in one call; those that change more than velocities must be among the first rate_directions
  static constexpr int most_directions = 2 * rate_directions;

  wheel_derivative(const patch_scene &scene, int max_count, int max_rows);

  // The rules of geometry/patch.hpp whose shares are smooth, and all else this differentiates.
  static bool covers(const patch_rules &rules) { return rules.blended && !rules.inclined; }

  // friction: of the directions. result: as the wheel's side reports it, for a left
  // wheel the mirror image, of which only what the mirror leaves as it is may be read. changes[k]:
  // rates of the right-hand wheel's doubles; statuses and counts are not set, but the grid's that
  // of the result.
  derivative_outcome solve(const wheel_solution &wheel, patch_contact &solver,
                           const side_motion *directions, const friction_rates *friction, int count,
                           const derivative_options &o, const rp_side_result &result,
                           rp_side_result *changes);
  size_t bytes() const;

 private:
  struct step;
  void solve_patch(step &s, int index);
  void set_shape(step &s, int index, patch_variation *in);
  static void set_depth(const step &s, const moving_geometry &geometry, const grid &g, int deepest,
                        double *const *rates);
  void set_slopes(step &s, int index, patch_variation *in);
  void set_friction(step &s, int index, const lattice_rates *lattice, patch_variation *in);
  void set_motion(step &s, int index, patch_variation *in);
  void set_hertz(step &s, int index, patch_variation *in);
  void add_forces(step &s, int index, int block, const patch_change *changes);
  void add_turning_force(step &s, int index, int block, const patch_change *changes);
  void report(step &s, int index, int block, int direction, const patch_change &change);

  int max_count_, max_rows_;
  aligned_buffer<double> distance_, row_friction_, slope_fields_;  // rates by direction
  surface_slopes slopes_[rate_directions];
};

}  // namespace railpatch
