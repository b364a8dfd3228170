// Checks of regimes: what goes with steps that begin with the last one's tractions.
#include "half_space/coupling.hpp"
#include "handle/checker.hpp"

namespace railpatch {

namespace {

// Wheels roll on from tractions and friction, and nothing else that the material would carry along.
const char *wheels_cannot_roll(const rp_config &c) {
  if (c.regime == RP_SHIFT)
    return "regime must be none, steady_rolling or transient_rolling for wheels";
  if (!(c.element_size[0] > 0))
    return "regime = transient_rolling of wheels needs element_size in place of elements";
  if (c.friction_law == RP_TEMPERATURE)
    return "regime = transient_rolling of wheels needs friction_law = coulomb or slip_velocity in "
           "this version";
  if (c.layer_yield_stress > 0)
    return "layer_yield_stress must be 0 with regime = transient_rolling of wheels in this version";
  if (c.temperature != 0)
    return "temperature must be 0 with regime = transient_rolling of wheels in this version";
  if (is_coupled(combine(c.shear_modulus, c.poisson_ratio)))
    return "regime = transient_rolling of wheels needs equal (1-2nu)/G of both bodies in this "
           "version";
  return nullptr;
}

// Of regimes that may change from step to step.
void check_changes(const rp_config &c, checker &check) {
  const char *wrong = nullptr;
  if (!has_tangential(c))
    wrong = "regime_changes must be 0 without a tangential problem";
  else if (c.temperature != 0)
    wrong = "temperature must be 0 with regime_changes";
  else if (c.fluid_model != RP_FLUID_NONE)
    wrong = "fluid_model must be none with regime_changes";
  else if (c.accuracy > 0)
    wrong = "accuracy must be 0 with regime_changes: steps keep their grid";
  check.require(wrong == nullptr, wrong ? wrong : "");
}

// Of a rigid slip of each element, on a grid that is given.
void check_slip_field(const rp_config &c, checker &check) {
  if (c.slip_by_element == 0) return;
  const char *wrong = nullptr;
  if (c.kind != RP_PATCH || c.geometry != RP_UNDEFORMED_DISTANCE)
    wrong =
        "slip_by_element needs kind = patch and geometry = undeformed_distance: a grid that is "
        "given";
  else if (!has_tangential(c) || c.tangential != RP_TANGENTIAL_FULL || c.fitted[0] > 0)
    wrong = "slip_by_element needs a regime of motion, tangential = full and no fitted rows";
  else if (c.fluid_model != RP_FLUID_NONE)
    wrong = "fluid_model must be none with slip_by_element";
  else if (c.accuracy > 0)
    wrong = "accuracy must be 0 with slip_by_element: there is no error estimate";
  else if (c.derivatives != 0)
    wrong = "derivatives must be 0 with slip_by_element";
  check.require(wrong == nullptr, wrong ? wrong : "");
}

}  // namespace

void check_slip_field(const rp_config &c, const rp_input &in, checker &check) {
  check.require(c.slip_by_element == 1 || in.slip_field == nullptr,
                "slip_field must be null with slip_by_element = 0");
  if (in.slip_field && check.error() == RP_OK)
    check.numbers("slip_field", in.slip_field, 2 * c.distance_shape[0] * c.distance_shape[1],
                  finite);
}

int regime_of(const rp_config &c, const rp_input &in) {
  return in.step_regime < 0 ? static_cast<int>(c.regime) : in.step_regime;
}

void check_step_regime(const rp_config &c, const rp_input &in, checker &check) {
  if (in.step_regime == -1) return;
  check.require(c.regime_changes == 1, "step_regime must be -1 with regime_changes = 0");
  const bool wheels = c.kind != RP_PATCH;
  const bool rolls = in.step_regime == RP_STEADY_ROLLING || in.step_regime == RP_TRANSIENT_ROLLING;
  check.require(rolls || (!wheels && in.step_regime == RP_SHIFT),
                wheels ? "step_regime must be -1, steady_rolling or transient_rolling for wheels"
                       : "step_regime must be -1, steady_rolling, shift or transient_rolling");
  check.require(in.step_regime != RP_SHIFT || c.friction_law == RP_COULOMB,
                "step_regime must not be shift but with friction_law = coulomb: it has no speed");
}

// Shift and transient rolling keep their grid in the frame of the contact.
void check_regime(const rp_config &c, checker &check) {
  const bool changes = c.regime_changes == 1;
  check_slip_field(c, check);
  if (changes) check_changes(c, check);
  if (!has_tangential(c) || (c.regime == RP_STEADY_ROLLING && !changes)) return;
  const char *wrong = nullptr;
  if (c.tangential != RP_TANGENTIAL_FULL || c.fitted[0] > 0)
    wrong = changes
                ? "regime_changes needs tangential = full and no fitted rows"
                : "regime = shift and transient_rolling need tangential = full and no fitted rows";
  else if (c.kind != RP_PATCH)
    wrong = wheels_cannot_roll(c);
  else if (c.geometry == RP_CURVATURES &&
           !(c.element_size[0] > 0 && c.max_elements[0] > 0 && c.max_elements[1] > 0))
    wrong =
        "regime = shift and transient_rolling with curvatures need element_size and "
        "max_elements: their grid is fixed";
  check.require(wrong == nullptr, wrong ? wrong : "");
}

}  // namespace railpatch
