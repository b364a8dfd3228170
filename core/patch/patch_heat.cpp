// The heat of one patch: friction by temperature, and the temperature that a step leaves.
#include "patch/patch_contact.hpp"

namespace railpatch {

// Each pass of the outer loop starts from the tractions of the last one.
tangential_result patch_contact::solve_with_heat(const patch_problem &problem,
                                                 const rolling_input &rolling, patch_memory &memory,
                                                 rp_patch_result &result) {
  tangential_result last{};
  int newton = 0, products = 0;
  const auto pass = [&](const double *mu, double *q) {
    observe(RP_STAGE_TANGENTIAL, true);
    last = solve_on_grid(problem, rolling, memory, result, mu);
    observe(RP_STAGE_TANGENTIAL, false);
    newton += last.newton_iterations;
    products += last.products;
    flux_of(problem, memory, q);
    return last.converged;
  };
  observe(RP_STAGE_TEMPERATURE, true);
  const temperature_loop_result loop = heat_->solve(
      memory.pressure.data(), {scene_.tolerance, scene_.max_iterations}, *memory.heat, pass);
  observe(RP_STAGE_TEMPERATURE, false);
  result.outer_iterations += loop.iterations;
  last.newton_iterations = newton;
  last.products = products;
  last.converged = last.converged && loop.converged;
  if (!(loop.residual <= last.residual)) last.residual = loop.residual;
  return last;
}

void patch_contact::begin_heat(const patch_problem &problem, patch_memory &memory) {
  const grid &g = problem.g;
  const rolling_input &rolling = problem.rolling;
  observe(RP_STAGE_TEMPERATURE, true);
  heat_->begin({g.nx, g.ny, g.dx, rolling.direction, problem.rolling_speed},
               rolling.regime == motion::transient ? rolling.distance : 0.0, memory.pressure.data(),
               *memory.heat);
  observe(RP_STAGE_TEMPERATURE, false);
}

double patch_contact::finish_heat(const patch_problem &problem, patch_memory &memory) {
  observe(RP_STAGE_TEMPERATURE, true);
  flux_of(problem, memory, heat_->flux());
  const double greatest = heat_->finish(memory.pressure.data(), *memory.heat);
  observe(RP_STAGE_TEMPERATURE, false);
  return greatest;
}

void patch_contact::flux_of(const patch_problem &problem, const patch_memory &memory, double *q) {
  const double *plastic = nullptr;
  if (scene_.yields()) {
    const bool steps = problem.rolling.regime == motion::transient;
    memory.history.plastic_work(problem.g, problem.rolling.direction, memory.px.data(),
                                memory.py.data(), scratch_[0].data());
    const double rate = problem.rolling_speed / (steps ? problem.rolling.distance : problem.g.dx);
    for (int i = 0; i < problem.g.count(); ++i) scratch_[0][static_cast<size_t>(i)] *= rate;
    plastic = scratch_[0].data();
  }
  heat_->heat(memory.px.data(), memory.py.data(), memory.sx.data(), memory.sy.data(), plastic, q);
}

}  // namespace railpatch
