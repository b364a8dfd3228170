#include "handle/contact_derivative.hpp"

// Which stages a scene has, and why.

namespace railpatch {

namespace {

#define RP_STAGE_NAME(name, value, word) word,
constexpr const char *stage_names[] = {RP_STAGES(RP_STAGE_NAME)};
#undef RP_STAGE_NAME

const char *normal_reason(const patch_scene &scene) {
  if (scene.is_viscous()) return "viscoelastic bodies: Newton's method on the contact area";
  switch (scene.normal) {
    case RP_NORMAL_HERTZ:
      return "normal = hertz: closed form";
    case RP_NORMAL_KIK_PIOTROWSKI:
      return "normal = kik_piotrowski: virtual interpenetration, row by row";
    case RP_NORMAL_KIK_PIOTROWSKI_CORRECTED:
      return "normal = kik_piotrowski_corrected: virtual interpenetration by Hertz, row by row";
    case RP_NORMAL_ANALYN:
      return "normal = analyn: assumed deformation, row by row";
    case RP_NORMAL_HALF_SPACE:
      break;
  }
  return "normal = half_space: conjugate gradients";
}

const char *full_reason(const patch_scene &scene) {
  if (scene.law)
    return !scene.law->plastic() ? "tangential = full: semi-smooth Newton, slip-velocity law"
           : scene.law->by_velocity
               ? "tangential = full: semi-smooth Newton, slip-velocity law and plastic layer"
               : "tangential = full: semi-smooth Newton, plastic layer";
  if (scene.is_forced())
    return scene.is_fitted()
               ? "tangential = full: semi-smooth Newton on fitted rows, creepage from the force"
               : "tangential = full: semi-smooth Newton, creepage from the force";
  return scene.is_fitted() ? "tangential = full: semi-smooth Newton on fitted rows"
                           : "tangential = full: semi-smooth Newton on the grid";
}

const char *tangential_reason(const patch_scene &scene) {
  if (const fast_theory *theory = theory_of(scene.tangential)) return theory->reason;
  return scene.tangential == RP_TANGENTIAL_NONE ? "tangential = none" : full_reason(scene);
}

const char *temperature_reason(const patch_scene &scene) {
  if (!scene.heat) return "no surface temperature in the scene";
  if (scene.heat->by_temperature)
    return scene.heat->transient
               ? "friction depends on temperature: columns with memory, outer loop"
               : "friction depends on temperature: outer loop";
  return scene.heat->transient ? "temperature is asked for: columns with memory"
                               : "temperature is asked for: steady rolling";
}

const char *influence_reason(const patch_scene &scene) {
  const bool on_grid = scene.full_on_grid();
  if (scene.has_own_influence())
    return on_grid ? "own influence coefficients, of pressure and tractions"
                   : "own influence coefficients, of pressure";
  if (scene.is_viscous())
    return on_grid ? "viscoelastic bodies: normal = half_space and tangential = full need it"
                   : "viscoelastic bodies: normal = half_space needs it";
  if (scene.normal == RP_NORMAL_HALF_SPACE)
    return on_grid ? "normal = half_space and tangential = full need it"
                   : "normal = half_space needs it";
  return on_grid ? "tangential = full needs it" : "neither normal nor tangential method needs it";
}

const char *coupling_reason(const patch_scene &scene) {
  if (scene.couples())
    return scene.curved ? "reference_surface = curved: outer loop"
                        : "unlike bodies, (1 - 2 nu)/G differs: outer loop";
  return is_coupled(scene.elastic) ? "unlike bodies, but no tangential problem"
                                   : "(1 - 2 nu)/G of both bodies is the same";
}

const char *history_reason(const patch_scene &scene) {
  if (scene.tangential == RP_TANGENTIAL_NONE) return "no tangential problem";
  if (!scene.keeps_steps()) return "steady rolling does not depend on the last step";
  if (scene.changes) return "regime_changes: tractions of the last step";
  return scene.regime == motion::shift ? "regime = shift: tractions of the last step"
                                       : "regime = transient_rolling: tractions of the last step";
}

const char *plasticity_reason(const patch_scene &scene) {
  if (scene.tangential == RP_TANGENTIAL_NONE) return "no tangential problem";
  if (scene.yields()) return "the third-body layer has a yield stress";
  return scene.layer_flexibility > 0 ? "the third-body layer has no yield stress"
                                     : "no third-body layer";
}

const char *fluid_reason(const patch_scene &scene) {
  if (!scene.fluid) return "no liquid in the scene";
  if (scene.fluid->model == RP_FLUID_REGIMES)
    return "fluid_model = regimes: Polach's theory at knots of the water rate";
  if (scene.fluid->model == RP_FLUID_STRIP)
    return "fluid_model = strip: pressure of the liquid along each row";
  if (scene.has_ehl()) return "fluid_model = ehl: liquid, asperities and deformation on the grid";
  return scene.fluid->share == RP_SHARE_LOAD_SHARING
             ? "fluid_model = film: elliptic contact, load shared with asperities"
             : "fluid_model = film: elliptic contact, asperities by film over roughness";
}

const char *derivative_reason(const patch_scene &scene) {
  if (!scene.derivatives && scene.exact) return "the wheelset's balance is found by them";
  if (!scene.derivatives) return "derivatives are not asked for";
  return scene.exact ? "derivatives are asked for: from the solved conditions"
                     : "derivatives are asked for: by differences of further steps";
}

// Of one grid's driver.
void describe_driver(const driver &of, rp_stage_info *info) {
  const patch_contact &solver = of.solver();
  const patch_scene &scene = solver.scene();
  const bool tangential = scene.tangential != RP_TANGENTIAL_NONE;
  size_t distance = of.geometry_bytes(), normal = 0, traction = 0, heat = 0;
  size_t history = solver.history_bytes(), plastic = solver.plastic_bytes();
  for (const auto &m : of.memories()) {
    distance += m.undeformed_distance.bytes();
    normal += m.pressure.bytes();
    traction += m.bytes() - m.undeformed_distance.bytes() - m.pressure.bytes() -
                m.history.step_bytes() - m.history.plastic_bytes();
    history += m.history.step_bytes();
    plastic += m.history.plastic_bytes();
    if (m.heat) heat += m.heat->bytes();
    if (m.curved) {
      distance += m.curved->bytes();
      traction -= m.curved->bytes();
    }
  }
  if (tangential)
    traction += solver.tangential_bytes() - solver.history_bytes() - solver.plastic_bytes();
  size_t fluid = solver.fluid_bytes();
  for (const auto &m : of.memories()) {
    fluid += m.fluid_pressure.bytes() + m.fluid_film.bytes() + m.fluid_shear.bytes();
    traction -= m.fluid_pressure.bytes() + m.fluid_film.bytes() + m.fluid_shear.bytes();
  }
  const size_t support = of.support_bytes();
  const size_t influence = solver.influence_bytes();
  const auto set = [&](rp_stage stage, bool present, const char *reason, size_t bytes) {
    info[stage] = {stage_names[stage], present, reason, bytes};
  };
  set(RP_STAGE_GEOMETRY, true, of.geometry_reason(), distance);
  set(RP_STAGE_INFLUENCE, influence > 0, influence_reason(scene), influence);
  set(RP_STAGE_NORMAL, true, normal_reason(scene), normal + solver.normal_bytes());
  set(RP_STAGE_TANGENTIAL, tangential,
      scene.has_regime ? tangential_reason(scene) : "regime = none", traction);
  set(RP_STAGE_TEMPERATURE, scene.heat.has_value(), temperature_reason(scene),
      heat + solver.heat_bytes());
  set(RP_STAGE_FORCES, true, "resultants of pressure and traction", solver.scratch_bytes());
  set(RP_STAGE_COUPLING, scene.couples(), coupling_reason(scene), solver.coupling_bytes());
  set(RP_STAGE_HISTORY, scene.keeps_steps(), history_reason(scene), history);
  set(RP_STAGE_SUPPORT, support > 0,
      support > 0 ? "rails have a stiffness: deflections by Newton's method"
                  : "the rails are rigid",
      support);
  set(RP_STAGE_PLASTICITY, scene.yields(), plasticity_reason(scene), plastic);
  set(RP_STAGE_FLUID, static_cast<bool>(scene.fluid), fluid_reason(scene), fluid);
  set(RP_STAGE_DERIVATIVES, scene.derivatives || scene.exact, derivative_reason(scene),
      of.derivative_bytes());
}

}  // namespace

// Of finer grids what they hold besides, and the stages that the first one has not.
void contact::describe(rp_stage_info *info) const {
  describe_driver(*levels_[0]->solver, info);
  for (size_t k = 1; k < levels_.size(); ++k) {
    rp_stage_info finer[RP_STAGE_COUNT];
    describe_driver(*levels_[k]->solver, finer);
    for (int stage = 0; stage < RP_STAGE_COUNT; ++stage) {
      finer[stage].bytes += info[stage].bytes;
      if (finer[stage].present && !info[stage].present) info[stage] = finer[stage];
      info[stage].bytes = finer[stage].bytes;
    }
  }
  if (derivative_) info[RP_STAGE_DERIVATIVES].bytes += derivative_->bytes();
}

}  // namespace railpatch
