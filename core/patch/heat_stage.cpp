#include "patch/heat_stage.hpp"

#include <algorithm>

#include "numeric/sums.hpp"

namespace railpatch {

heat_stage::heat_stage(patch_workspace &shared, int max_nx, int max_ny) : shared_(shared) {
  if (shared.scene.heat) stage_.emplace(*shared.scene.heat, max_nx, max_ny);
}

void heat_stage::set_bulk(int k, double value) {
  if (!stage_) return;
  shared_.scene.heat->bodies.body[k].bulk = value;
  stage_->set_bulk(k, value);
}

void heat_stage::begin(const patch_problem &problem, patch_memory &memory) {
  if (!stage_) return;
  const stage_mark mark = shared_.marks.enter(RP_STAGE_TEMPERATURE);
  const grid &g = problem.g;
  const rolling_input &rolling = problem.rolling;
  const bool steps = rolling.regime == motion::transient;
  // work of a step is that of its way, half of which lies upstream; longer ones than an element are
  // no finer in place
  const double way = steps ? std::min(rolling.distance / g.dx, 1.0) : 1.0;
  stage_->begin({g.nx, g.ny, g.dx, rolling.direction, problem.rolling_speed, 0.5 * way},
                steps ? rolling.distance : 0.0, memory.pressure.data(), *memory.heat);
}

heat_outcome heat_stage::finish(const patch_problem &problem, patch_memory &memory) {
  if (!stage_) return {};
  const stage_mark mark = shared_.marks.enter(RP_STAGE_TEMPERATURE);
  set_flux(problem, memory, stage_->flux());
  heat_outcome found{true, stage_->finish(memory.pressure.data(), *memory.heat), {0, 0}};
  for (int k = 0; k < 2; ++k) found.heat[k] = stage_->heat_into(k, problem.g.dy);
  memory.heat->conductance = stage_->exchange_conductance(problem.g.dy);
  return found;
}

void heat_stage::set_flux(const patch_problem &problem, const patch_memory &memory, double *q) {
  const double *plastic = nullptr;
  aligned_buffer<double> &work = shared_.scratch[0];
  if (shared_.scene.yields()) {
    const bool steps = problem.rolling.regime == motion::transient;
    memory.history.plastic_work(problem.g, problem.rolling.direction, memory.px.data(),
                                memory.py.data(), work.data());
    const grid &g = problem.g;
    const auto count = static_cast<size_t>(g.count());
    double rate = problem.rolling_speed / (steps ? problem.rolling.distance : g.dx);
    // all that the layer takes becomes its share of heat, as with friction
    const double sum = rate * total(work.data(), count) * g.dx * g.dy;
    if (sum > 0) rate *= problem.rolling_speed * shared_.plastic_work / sum;
    for (size_t i = 0; i < count; ++i) work[i] *= rate;
    plastic = work.data();
  }
  stage_->heat(shared_.friction.data(), plastic, q);
}

}  // namespace railpatch
