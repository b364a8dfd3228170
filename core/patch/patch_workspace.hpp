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
  physics_part<coupled_contact> coupled;
  aligned_buffer<double> scratch[2];
};

}  // namespace railpatch
