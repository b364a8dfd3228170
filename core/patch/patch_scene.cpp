#include "patch/patch_scene.hpp"

namespace railpatch {

influence::medium patch_scene::medium() const {
  influence::medium m{elastic, layer_flexibility, line_width, full_on_grid()};
  m.curved = curved;
  if (has_own_influence()) {
    m.own = own.values;
    m.own_columns = own.columns;
    m.own_rows = own.rows;
  }
  return m;
}

bool patch_scene::estimates_force() const {
  // of a prescribed force the creepage errs
  const bool by_temperature = heat && heat->by_temperature;
  if (fluid || !usual_spin || is_forced() || law || keeps_steps() || by_temperature ||
      friction_variation.varies())
    return false;
  if (!is_fast(tangential)) return true;
  if (fast.law) return false;
  // what an ellipse in place of another shape does is known of a table of shapes alone
  if (tangential == RP_TANGENTIAL_TABLE && normal != RP_NORMAL_HERTZ)
    return shape_table::is_one(fast.creep_table, sizeof(shape_table_header));
  const polach_factors &p = fast.polach;
  const stiffness_reduction &r = fast.reduction;
  const bool reduced = p.adhesion != 1 || p.slip != 1 || r.k0 != 1 || (r.alpha != 1 && r.beta != 0);
  return fast.coefficient_factor == 1 && !reduced && fast.blending == RP_BLENDING_SLIDING &&
         fast.bound == RP_BOUND_AUTOMATIC;
}

bool patch_scene::differentiates() const {
  if (curved || (normal != RP_NORMAL_HALF_SPACE && normal != RP_NORMAL_HERTZ)) return false;
  if (tangential == RP_TANGENTIAL_NONE) return true;
  // tables by their own interpolation (fast/table_forces.hpp)
  if (tangential == RP_TANGENTIAL_TABLE)
    return !law && !keeps_steps() && !heat && !fluid && !is_forced() &&
           !friction_variation.varies() && !(line_width > 0);
  return tangential == RP_TANGENTIAL_FULL && !is_fitted() && !law && !keeps_steps() && !heat &&
         (!fluid || fluid->model == RP_FLUID_FILM) && !is_forced() && !couples();
}

}  // namespace railpatch
