// What the stages of a patch share: the scene, the observer and what more than one of them uses.
#pragma once

#include <optional>

#include "half_space/influence.hpp"
#include "numeric/memory.hpp"
#include "patch/coupled_contact.hpp"
#include "patch/patch_scene.hpp"
#include "patch/stage_marks.hpp"

namespace railpatch {

struct patch_workspace {
  // max_count: elements of the greatest grid
  patch_workspace(const patch_scene &scene, stage_marks marks, const fft_plans &plans,
                  int max_count);
  // the stages know where it is
  patch_workspace(const patch_workspace &) = delete;
  patch_workspace &operator=(const patch_workspace &) = delete;

  patch_scene scene;
  stage_marks marks;
  std::optional<railpatch::influence> influence;
  physics_part<viscous_influence> viscous;  // of viscoelastic bodies, in place of the elastic one
  physics_part<coupled_contact> coupled;
  aligned_buffer<double> scratch[2];
  // where friction's work is asked for element by element: N/m^2 over the way of the step, and what
  // it is found from
  aligned_buffer<double> friction, mean[2], moved[2];
  double plastic_work = 0;  // N, of plastic displacement over the way of the last solve
  size_t friction_bytes() const { return 5 * friction.bytes(); }
};

}  // namespace railpatch
