#include "half_space/physics.hpp"
#include "half_space/viscous_influence.hpp"
#include "handle/checker.hpp"
#include "handle/scene_of.hpp"

namespace railpatch {

namespace {

// What viscoelastic bodies are not solved with; null: nothing.
const char *unsolved(const rp_config &c) {
  if (!has_physics) return "viscoelastic_ratio must be 0: this build has no viscoelastic bodies";
  if (c.kind != RP_PATCH)
    return "viscoelastic_ratio must be 0 but with kind = patch: profiles and sections have no "
           "viscoelastic bodies";
  if (c.geometry == RP_SEMI_AXES)
    return "viscoelastic_ratio needs curvatures, a line contact or undeformed_distance: semi_axes "
           "are those of elastic bodies";
  if (c.regime != RP_STEADY_ROLLING || c.regime_changes != 0)
    return "viscoelastic_ratio needs regime = steady_rolling and regime_changes = 0: the history "
           "is the line ahead";
  if (c.normal != RP_NORMAL_HALF_SPACE) return "viscoelastic_ratio needs normal = half_space";
  if ((c.tangential != RP_TANGENTIAL_FULL && c.tangential != RP_TANGENTIAL_NONE) || c.fitted[0] > 0)
    return "viscoelastic_ratio needs tangential = full or none and no fitted rows";
  if (c.layer_thickness > 0) return "layer_thickness must be 0 with viscoelastic_ratio";
  if (c.friction_law != RP_COULOMB) return "friction_law must be coulomb with viscoelastic_ratio";
  if (c.temperature != 0) return "temperature must be 0 with viscoelastic_ratio";
  if (c.fluid_model != RP_FLUID_NONE) return "fluid_model must be none with viscoelastic_ratio";
  if (c.slip_by_element != 0) return "slip_by_element must be 0 with viscoelastic_ratio";
  if (c.accuracy > 0)
    return "accuracy must be 0 with viscoelastic_ratio: there is no error estimate";
  if (c.derivatives != 0) return "derivatives must be 0 with viscoelastic_ratio";
  const viscous_bodies bodies = viscous_bodies_of(c);
  if (c.tangential == RP_TANGENTIAL_FULL &&
      (is_coupled(combine(c.shear_modulus, c.poisson_ratio)) || bodies.couples()))
    return "viscoelastic_ratio with tangential = full needs bodies with equal (1-2nu)/G, and of "
           "equal viscoelastic_ratio and relaxation_time but where poisson_ratio is 0.5: no others "
           "keep normal and tangential directions apart";
  return nullptr;
}

}  // namespace

void check_viscous(const rp_config &c, checker &check) {
  for (int k = 0; k < 2; ++k) {
    check.require(!(c.viscoelastic_ratio[k] > 0) || c.relaxation_time[k] > 0,
                  k == 0 ? "relaxation_time[0] must be > 0 with viscoelastic_ratio[0] > 0"
                         : "relaxation_time[1] must be > 0 with viscoelastic_ratio[1] > 0");
    check.require(c.viscoelastic_ratio[k] > 0 || c.relaxation_time[k] == 0,
                  k == 0 ? "relaxation_time[0] must be 0 with viscoelastic_ratio[0] = 0: an "
                           "elastic body"
                         : "relaxation_time[1] must be 0 with viscoelastic_ratio[1] = 0: an "
                           "elastic body");
  }
  if (check.error() != RP_OK || !viscous_bodies_of(c).any()) return;
  const char *wrong = unsolved(c);
  check.require(wrong == nullptr, wrong ? wrong : "");
}

}  // namespace railpatch
