// One wheel on its rail or roller: from placement to the forces about the wheelset's centre.
//
// Everything inside is a right-hand wheel; the inputs of a left one are mirrored on the way in and
// its results on the way out, so left and right agree to the last bit.
#pragma once

#include <array>
#include <memory>

#include "geometry/geometry.hpp"
#include "geometry/joining.hpp"
#include "geometry/longitudinal_shape.hpp"
#include "geometry/patch.hpp"
#include "geometry/profile_sections.hpp"
#include "patch/patch_contact.hpp"
#include "patch/patch_grid.hpp"
#include "railpatch.h"
#include "wheel/wheel_derivative.hpp"

namespace railpatch {

// What a wheel is made from; profiles are usable, and copied.
struct wheel_setup {
  int side = RP_RIGHT;
  profile_view wheel{}, rail{};
  // of the rail along the track and of the wheel by its pitch; empty: it has one profile
  std::vector<profile_view> sections, wheel_sections;
  const double *section_position = nullptr, *wheel_section_angle = nullptr;
  section_rules along, around;
  longitudinal_values shape;
  wheel_config sizes;
  track_config track;
  patch_rules rules;
  grid_rules grid;
  int max_patches = 1;
  bool keeps_solutions = false;  // for exact derivatives
  // neither shape nor rail varies, gives way or is seen as curved: derivatives of these are not
  // known
  bool round_and_rigid = true;
  // Whether the geometry's derivatives are known.
  bool differentiates() const { return round_and_rigid && wheel_derivative::covers(rules); }
};

// Moves the memories so that each patch finds the one of the last solution that lay nearest to it
// and was most alike in extent; patches appear, vanish, join and part beside it. Ties go to the
// first, so the order is a function of the last solution only.
void match_memory(const patch_region *regions, int count, patch_memory *memory, int slots);

// Vertical forces on the rail (N) that a wheel has if two neighbouring parts are patches of their
// own, and if they are one.
struct division_forces {
  double apart = 0, joined = 0;
  bool apart_known = false, joined_known = false;
};

class wheel_contact {
 public:
  explicit wheel_contact(const wheel_setup &setup);

  int side() const { return side_; }
  bool uniform_along() const { return !sections_ && !wheel_sections_ && !shape_; }
  bool varies(body which) const { return geometry_->varies(which); }
  void place(const rp_input &input, bool at_height = false);
  void move_to(double z) { geometry_->move_to(z); }
  // z at which wheel and rail first touch; false where they have no lateral position in common.
  bool first_touch(double &z) const;
  // Heights of the wheelset between two at which parts of contact appear; how many were written.
  int appearances(double low, double high, appearance *out, int most) const {
    return find_appearances(*geometry_, rules_, low, high, out, most);
  }
  // The parts of the last state that are partly one patch, those that are most evenly both; -1: no
  // such, or not by the blended rule.
  int joining_gap() const;
  joining joining_at(int gap) const { return {*geometry_, parts_, gap}; }
  joining joining_at(const appearance &found) const { return {*geometry_, rules_.blend, found}; }
  double joined(const joining &pair, double z) const { return pair.joined(rules_.blend, z); }
  // Of the last state, as far as its patches tell them; the pair learns of its parts.
  division_forces forces_of(joining &pair) const;
  // N, on the rail.
  double vertical_force() const;
  // Solves the contact at the placed position. memory: of this side's patches, max_patches.
  void evaluate(patch_contact &solver, patch_memory *memory, rp_side_result &result);
  // Derivatives of that solution by rates of the inputs and of the friction coefficient: changes[k]
  // those of its numbers in direction k, of which only the first rate_directions may be more than
  // velocities.
  derivative_outcome differentiate(patch_contact &solver, const patch_memory *memory,
                                   wheel_derivative &work, const rp_input *directions,
                                   const friction_rates *friction, int count,
                                   const derivative_options &options, const rp_side_result &result,
                                   rp_side_result *changes) const;
  // The last state is out of range for its geometry or normal problem, so its force is not known.
  bool beyond() const { return beyond_; }
  size_t bytes() const;

 private:
  static void fail(rp_reason reason, double value, rp_side_result &out);
  void solve_patch(patch_contact &solver, patch_region &region, int index, patch_memory *memories,
                   rp_side_result &result);
  search_result find_regions(const patch_contact &solver);
  void place_patch(const patch_contact &solver, patch_region &region, patch_memory &memory,
                   patch_problem &problem) const;
  double place_grid(const patch_contact &solver, patch_region &region, const grid &g,
                    patch_memory &memory) const;
  static hertz_contact hertz_of(const patch_region &region, double depth, double modulus);
  void add_force(const patch_region &region, double depth, patch_wrench wrench, double normal_force,
                 rp_side_result &out) const;
  void add_turning_force(const patch_region &region, double turning, rp_side_result &out) const;
  void add_section_force(const patch_scene &scene, const patch_region &region,
                         const patch_problem &problem, const patch_memory &memory,
                         rp_side_result &out) const;
  // Sets what the last step left behind for the patch of a region; past: of max_patches.
  void set_past(const patch_memory *memory, int index, const patch_region &region,
                patch_problem &problem, past_tractions *past) const;
  std::array<double, 5> rolling_of(const patch_problem &problem) const;
  double set_rolling(patch_problem &problem) const;
  void set_friction(const patch_contact &solver, const contact_frame &frame,
                    patch_memory &memory) const;
  grid choose_grid(const patch_region &region) const;
  side_motion motion_of(const rp_input &input) const;

  int side_, max_patches_;
  double nominal_radius_, standstill_speed_;
  grid_rules grid_;
  bool beyond_ = false;
  // where the rail's profile varies along the track, the wheel's round it
  std::unique_ptr<profile_sections> sections_, wheel_sections_;
  std::unique_ptr<profile> wheel_, rail_;
  std::unique_ptr<longitudinal_shape> shape_;  // null: round wheel, level rail
  std::unique_ptr<side_geometry> geometry_;
  patch_rules rules_;
  part_set parts_;
  std::array<patch_region, RP_MAX_PATCHES> regions_;
  std::array<double, RP_MAX_PATCHES> vertical_{};  // N on the rail, of a patch that counts fully
  int patches_ = 0;                                // of the last state
  std::vector<patch_solution> solutions_;          // of these; only for exact derivatives
  double time_step_ = 0;                           // s
  int step_regime_ = -1;                           // of an input; -1: the scene's
};

}  // namespace railpatch
