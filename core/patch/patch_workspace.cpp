#include "patch/patch_workspace.hpp"

#include <memory>
#include <utility>

#include "half_space/conformal_coupling.hpp"

namespace railpatch {

patch_workspace::patch_workspace(const patch_scene &of, stage_marks at, const fft_plans &plans,
                                 int max_count)
    : scene(of), marks(at) {
  railpatch::influence::medium bodies = scene.medium();
  bodies.follows = scene.stretches;
  if (scene.needs_influence()) influence.emplace(bodies, plans);
  if (scene.is_viscous()) viscous.emplace(scene.viscous, *influence, plans);
  if (scene.couples()) {
    std::unique_ptr<coupling_operator> coupling;
    if (scene.curved)
      coupling = std::make_unique<conformal_coupling>(*influence, max_count);
    else
      coupling = std::make_unique<coupling_influence>(scene.elastic, scene.line_width > 0, plans);
    coupled.emplace(std::move(coupling), max_count, scene.keeps_steps());
  }
  if (scene.closed_form()) return;
  for (auto &b : scratch) b = aligned_buffer<double>(static_cast<size_t>(max_count));
  const bool sheared = scene.has_ehl() && scene.full_on_grid() && scene.fluid->eyring_stress > 0;
  const bool shifts = !scene.moves && (scene.changes || scene.regime == motion::shift);
  const bool steps = scene.keeps_steps() && (scene.couples() || scene.slip_by_element || shifts);
  if (!scene.heat && !steps && !sheared) return;
  for (auto *b : {&friction, &mean[0], &mean[1], &moved[0], &moved[1]})
    *b = aligned_buffer<double>(static_cast<size_t>(max_count));
}

}  // namespace railpatch
