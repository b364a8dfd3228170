#include "patch/patch_contact.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

// of unlike bodies' tangential problem, after which it is given up
constexpr int most_failures = 5;
// of the liquid's temperature and that of the surfaces
constexpr int most_rounds = 40;

// Mean of a law of temperature on the asperities, over the whole load.
double friction_by_heat(const grid &g, const patch_memory &memory) {
  double all = 0, sum = 0;
  for (size_t at = 0; at < static_cast<size_t>(g.count()); ++at) {
    all += memory.pressure[at];
    sum += memory.heat->friction[at] * (memory.pressure[at] - memory.fluid_pressure[at]);
  }
  return all > 0 ? sum / all : 0.0;
}

}  // namespace

patch_contact::patch_contact(const patch_scene &scene, const fft_plans &plans, int max_nx,
                             int max_ny, stage_marks marks)
    : shared_(scene, marks, plans, max_nx * max_ny),
      max_nx_(max_nx),
      max_ny_(max_ny),
      normal_(shared_, max_nx, max_ny),
      tangential_(shared_, plans, max_nx, max_ny),
      heat_(shared_, max_nx, max_ny),
      fluid_(shared_, max_nx, max_ny),
      errors_(scene.elastic, scene.layer_flexibility) {
  if (scene.exact) derivative_.emplace(scene, plans, max_nx, max_ny, scene.stretches);
}

void patch_contact::begin_step(const patch_problem &problem, patch_memory &memory) {
  if (!shared_.scene.keeps_steps()) return;
  const stage_mark mark = shared_.marks.enter(RP_STAGE_HISTORY);
  if (shared_.coupled)
    shared_.coupled->remember(problem.g, memory.history.begun ? memory.pressure.data() : nullptr);
  memory.history.begin(problem.g, problem.rolling.upstream(), memory.px.data(), memory.py.data(),
                       memory.pressure.data());
}

void patch_contact::remember(patch_memory &memory) const {
  memory.history.remember(memory.g,
                          {memory.reference[0], memory.reference[1] - memory.rail[0],
                           memory.reference[2] - memory.rail[1]},
                          memory.share, memory.px.data(), memory.py.data());
  memory.history.last_rolling = memory.rolling;
  if (memory.curved)
    memory.history.remember_curve(memory.pressure.data(), memory.curved->angles().data());
}

heat_outcome patch_contact::leave_contact(const rolling_input &step, patch_memory &memory) {
  memory.warm = false;
  if (!memory.history.begun) return {};
  memory.history.begin(memory.g, step.upstream(), memory.px.data(), memory.py.data(),
                       memory.pressure.data());
  patch_problem nothing;
  nothing.g = memory.g;
  nothing.rolling = step;
  nothing.rolling_speed = step.speed;
  unload(nothing.g, memory);
  heat_.begin(nothing, memory);
  return heat_.finish(nothing, memory);
}

void patch_contact::start_from(patch_memory &memory, patch_problem &problem) {
  const grid &g = problem.g;
  const bool same_shape = memory.g.nx == g.nx && memory.g.ny == g.ny;
  problem.follows = memory.warm && same_shape && influence::close(memory.g, g);
  if (!problem.follows)
    memory.followed = 0;
  else if (!memory.counted)
    memory.followed = std::min(memory.followed + 1, kernel_book::lead);
  // a step that finds a height by many solves makes room for kept kernels once
  problem.followed = memory.counted && memory.followed < kernel_book::lead ? 0 : memory.followed;
  memory.counted = true;
  const bool same_size = memory.g.dx == g.dx && memory.g.dy == g.dy;
  if (memory.warm &&
      !(same_shape && (!same_size || (memory.g.x0 == g.x0 && memory.g.y0 == g.y0)))) {
    // nearest element of the old grid; a grid of the same shape scales with the contact instead
    const auto carry = [&](aligned_buffer<double> &field) {
      if (field.size() == 0) return;
      std::copy_n(field.data(), memory.g.count(), shared_.scratch[0].data());
      for (int j = 0; j < g.ny; ++j)
        for (int i = 0; i < g.nx; ++i) {
          const double u = std::round((g.x(i) - memory.g.x0) / memory.g.dx);
          const double v = std::round((g.y(j) - memory.g.y0) / memory.g.dy);
          const bool inside = u >= 0 && v >= 0 && u < memory.g.nx && v < memory.g.ny;
          field[static_cast<size_t>(j * g.nx + i)] =
              inside ? shared_.scratch[0][static_cast<size_t>(v * memory.g.nx + u)] : 0.0;
        }
    };
    carry(memory.pressure);
    if (memory.heat) memory.heat->forget_friction();
    if (!memory.fitted()) {
      carry(memory.px);
      carry(memory.py);
    }
  }
  memory.g = g;
  if (memory.warm) return;
  if (memory.heat) memory.heat->forget_friction();
  if (memory.pressure.size()) std::fill_n(memory.pressure.data(), g.count(), 0.0);
  if (memory.px.size() == 0) return;
  for (auto *field : {&memory.px, &memory.py})
    std::fill_n(field->data(), memory.columns() * memory.rows(), 0.0);
  if (shared_.scene.is_forced()) std::fill_n(memory.creepage.data(), 2, 0.0);
}

// The way through a patch. The contact area of unlike bodies is known only after the tractions, and
// where friction does not depend on heat, heat waits for it.
void patch_contact::solve(const patch_problem &problem, patch_memory &memory,
                          rp_patch_result &result, patch_wrench &wrench) {
  const patch_scene &scene = shared_.scene;
  memory.solved = true;
  memory.estimated = false;
  memory.turning = {};
  begin_solve(problem, memory);
  pressure_outcome n = find_pressure(problem, memory);
  if (!n.loaded) {
    unload(problem.g, memory);
    heat_.begin(problem, memory);
    wrench = {};
    return report_unloaded(scene, problem, n, heat_.finish(problem, memory), result);
  }
  const bool late = heat_.begins_late();
  if (!late) heat_.begin(problem, memory);
  fluid_.begin();
  fluid_outcome f = fluid_.solve(problem, n, memory);
  traction_outcome t = find_tractions(problem, n, memory);
  if (late) heat_.begin(problem, memory);
  heat_outcome h = heat_.finish(problem, memory);
  if (fluid_.follows_heat()) warm_liquid(problem, memory, n, f, t, h);
  const stage_mark mark = shared_.marks.enter(RP_STAGE_FORCES);
  wrench = sum_forces(problem, n, t, memory);
  if (memory.curved && memory.px.size())
    t.own = sum_tractions(problem.g, memory.pressure.data(), memory.px.data(), memory.py.data());
  report(scene, problem, n, t, h, wrench, result);
  if (shared_.viscous) describe_viscous(problem, n, t, wrench, result);
  if (f.found) describe_fluid(f, t.fluid_power, scene.friction_scale, result);
  if (f.found && scene.fluid->model == RP_FLUID_REGIMES)
    result.effective_friction = scene.wet_friction * scene.friction_scale;
  if (f.found && scene.has_strips() && scene.heat && scene.heat->by_temperature)
    result.effective_friction = friction_by_heat(problem.g, memory) * scene.friction_scale;
  if (!f.converged) degrade(result, RP_NOT_CONVERGED, RP_REASON_FLUID);
  complete(problem, memory, wrench);
  estimate_error(problem, n, memory, result);
}

// The liquid as warm as the surfaces, which rub the more the thinner it is: rounds until both
// agree.
void patch_contact::warm_liquid(const patch_problem &problem, patch_memory &memory,
                                pressure_outcome &n, fluid_outcome &f, traction_outcome &t,
                                heat_outcome &h) {
  // K: of the liquid's temperature, which is some tenths of a per cent of its viscosity
  const double allowed = 100.0 * std::max(shared_.scene.tolerance, 1e-10);
  int newton = t.newton_iterations, products = t.inner_iterations, outer = t.outer_iterations;
  for (int round = 1; t.converged; ++round) {
    const double change = fluid_.follow(problem.g, memory);
    ++outer;
    if (!(change > allowed)) break;
    if (round > most_rounds) {
      degrade(t, RP_NOT_CONVERGED, RP_REASON_HEAT_LOOP, change);
      break;
    }
    f = fluid_.solve(problem, n, memory);
    heat_.begin(problem, memory);
    t = find_tractions(problem, n, memory);
    newton += t.newton_iterations;
    products += t.inner_iterations;
    outer += t.outer_iterations;
    h = heat_.finish(problem, memory);
  }
  t.newton_iterations = newton;
  t.inner_iterations = products;
  t.outer_iterations = outer;
}

// What depends on the grid and on the last step.
void patch_contact::begin_solve(const patch_problem &problem, patch_memory &memory) {
  if (shared_.influence) {
    const stage_mark mark = shared_.marks.enter(RP_STAGE_INFLUENCE);
    shared_.influence->set_grid(problem.g, problem.followed);
    if (memory.curved) shared_.influence->set_rows(memory.curved->cosine(), memory.curved->sine());
    if (shared_.viscous)
      shared_.viscous->set(problem.g, problem.rolling.direction, problem.rolling_speed);
  }
  if (problem.past && memory.history.has_law()) {
    const stage_mark mark = shared_.marks.enter(RP_STAGE_HISTORY);
    memory.history.begin_states(problem.g);
    for (int k = 0; k < problem.past_count; ++k)
      memory.history.add_states(problem.g, problem.past[k]);
  }
  if (shared_.coupled) {
    const stage_mark mark = shared_.marks.enter(RP_STAGE_COUPLING);
    shared_.coupled->begin(problem.g, memory.undeformed_distance.data(), memory.px.data(),
                           memory.py.data());
  }
}

// The normal problem at the step's begin.
pressure_outcome patch_contact::find_pressure(const patch_problem &problem, patch_memory &memory) {
  const stage_mark mark = shared_.marks.enter(RP_STAGE_NORMAL);
  pressure_outcome n = normal_.solve(problem, memory);
  // where the last step's tractions held the bodies apart
  if (!n.loaded && shared_.coupled && shared_.coupled->forget()) n = normal_.solve(problem, memory);
  memory.approach = n.approach;
  memory.beyond = n.status == RP_OUT_OF_RANGE;
  memory.warm =
      n.loaded && n.status == RP_CONVERGED && memory.pressure.size() + memory.px.size() > 0;
  return n;
}

// The tractions of a loaded patch; what they change of the pressure is in n.
traction_outcome patch_contact::find_tractions(const patch_problem &problem, pressure_outcome &n,
                                               patch_memory &memory) {
  if (shared_.scene.tangential == RP_TANGENTIAL_NONE) return {};
  const stage_mark mark = shared_.marks.enter(RP_STAGE_TANGENTIAL);
  if (!shared_.coupled) {
    const traction_outcome t = tangential_.solve(problem, n, memory, heat_);
    memory.warm = t.converged && memory.warm;
    return t;
  }
  const traction_outcome t = solve_in_turn(problem, n, memory);
  memory.warm = t.converged && n.status == RP_CONVERGED && t.status == RP_CONVERGED;
  return t;
}

// The tangential problem of unlike bodies, and the normal one again until both agree.
traction_outcome patch_contact::solve_in_turn(const patch_problem &problem, pressure_outcome &n,
                                              patch_memory &memory) {
  const double *pressure = memory.pressure.data();
  auto &coupled = shared_.coupled;
  int normal = n.iterations, newton = 0, products = 0, outer = 0, failures = 0;
  for (int round = 1;; ++round) {
    traction_outcome t = tangential_.solve(problem, n, memory, heat_);
    // the gap's error is that of the normal problem and of the tractions' part
    double gap_error = n.residual;
    {
      const stage_mark mark = shared_.marks.enter(RP_STAGE_COUPLING);
      gap_error +=
          coupled->error(pressure, memory.px.data(), memory.py.data(), problem.force_given);
    }
    const bool agreed = gap_error <= shared_.scene.normal_tolerance;
    n.iterations = normal;
    t.newton_iterations = newton += t.newton_iterations;
    t.inner_iterations = products += t.inner_iterations;
    // with those of friction and temperature
    t.outer_iterations = outer += t.outer_iterations + 1;
    t.coupling_energy = coupled->energy(pressure);
    if (!(gap_error <= t.residual)) t.residual = gap_error;
    failures += !t.converged;
    if (agreed || failures == most_failures || round >= shared_.scene.max_iterations) {
      if (!agreed) degrade(t, RP_NOT_CONVERGED, RP_REASON_COUPLING, gap_error);
      return t;
    }
    {
      const stage_mark mark = shared_.marks.enter(RP_STAGE_COUPLING);
      coupled->advance();
    }
    {
      const stage_mark mark = shared_.marks.enter(RP_STAGE_NORMAL);
      n = normal_.solve(problem, memory);
    }
    // tractions too great in between, which part the bodies, are none
    if (!n.loaded) unload(problem.g, memory);
    // in steady rolling it begins as often as one likes; others do not feed back:
    // see handle/check.cpp
    if (heat_.feeds_back()) heat_.begin(problem, memory);
    memory.beyond = n.status == RP_OUT_OF_RANGE;
    normal += n.iterations;
  }
}

patch_wrench patch_contact::sum_forces(const patch_problem &problem, const pressure_outcome &n,
                                       const traction_outcome &t, patch_memory &memory) const {
  patch_wrench wrench{};
  if (shared_.scene.closed_form()) {
    // the ellipse's pressure is symmetric about the reference
    wrench.force[2] = -n.normal_force;
  } else {
    const bool on_grid = memory.px.size() && tangential_.on_grid();
    const double *px = on_grid ? memory.px.data() : nullptr;
    wrench = memory.curved ? memory.curved->sum_tractions(problem.g, memory.pressure.data(), px,
                                                          memory.py.data())
                           : sum_tractions(problem.g, memory.pressure.data(), px, memory.py.data());
  }
  tangential_.set_resultants(t, memory, wrench);
  return wrench;
}

// Creep forces act at their depth, and pressure along the normals of the surface; a curved
// reference surface has both in its sums.
void patch_contact::complete(const patch_problem &problem, patch_memory &memory,
                             patch_wrench &wrench) const {
  if (memory.slope_fields.size() == 0 || memory.curved) return;
  const grid &g = problem.g;
  add_depth(problem.place.contact_depth, wrench.force[0], wrench.force[1], wrench);
  if (shared_.scene.closed_form())
    add_inclined_ellipse(problem.hertz.semi_axes[1], problem.hertz.normal_force, g, memory.slopes,
                         wrench);
  else
    add_inclined(g, memory.pressure.data(), memory.slopes, wrench);
  if (!shared_.scene.turns()) return;
  memory.turning = energy_of_turning(g, memory.pressure.data(), memory.undeformed_distance.data(),
                                     memory.slopes);
  add_turning(memory.turning, problem.place.depth_part(), wrench);
}

derivative_outcome patch_contact::differentiate(const patch_problem &problem,
                                                const patch_memory &memory,
                                                const patch_variation *in, int count,
                                                const derivative_options &options,
                                                patch_change *out) {
  const stage_mark mark = shared_.marks.enter(RP_STAGE_DERIVATIVES);
  const patch_derivative::solution found{shared_.scene,
                                         problem,
                                         memory,
                                         shared_.influence ? &*shared_.influence : nullptr,
                                         normal_.solver(),
                                         tangential_.blocks(),
                                         tangential_.tables()};
  return derivative_->solve(found, in, count, options, out);
}

void patch_contact::estimate_error(const patch_problem &problem, const pressure_outcome &n,
                                   patch_memory &memory, rp_patch_result &result) const {
  const patch_scene &scene = shared_.scene;
  // linear theory beyond its bound is what it is; other results are no solutions
  const bool linear = scene.tangential == RP_TANGENTIAL_LINEAR;
  if (result.status != RP_CONVERGED && !(linear && result.status == RP_OUT_OF_RANGE)) return;
  if (scene.line_width > 0 || shared_.coupled || scene.curved || scene.fluid) return;
  if (scene.slip_by_element || scene.strips || scene.is_viscous()) return;
  if (scene.has_own_influence()) return;
  // no model is fitted to it
  if (scene.normal == RP_NORMAL_KIK_PIOTROWSKI_CORRECTED) return;
  estimated_patch patch{scene.normal, scene.tangential, problem.hertz,
                        {},           {0, 0},           scene.is_fitted(),
                        {1, 1},       scene.friction(), problem.rolling};
  if (const creep_table *table = tangential_.table()) {
    patch.stated[0] = table->force_error();
    patch.stated[1] = table->moment_error();
  }
  // the table of shapes counts where no ellipse is given
  const bool ellipse = problem.hertz.semi_axes[0] > 0 && !n.rows;
  if (const shape_table *shapes = ellipse ? nullptr : tangential_.shapes()) {
    patch.stated[0] = shapes->force_error();
    patch.stated[1] = shapes->moment_error();
    patch.states_all = true;
  }
  if (!scene.estimates_force()) patch.tangential = RP_TANGENTIAL_NONE;
  if (!(problem.rolling_speed > 0)) patch.rolling = rolling_input{};
  if (memory.pressure.size()) patch.extent = extent_of(problem.g, memory.pressure.data());
  if (n.rows) patch.extent.width = n.rows->width();
  for (int k = 0; k < 2 && has_tractions(scene.tangential); ++k)
    patch.tangential_grid[k] = scene.is_fitted() ? scene.fitted[k] : patch.extent.across[k];
  if (scene.normal == RP_NORMAL_HERTZ) patch.extent = {};
  memory.estimated = true;
  report_errors(errors_.estimate(patch, result, memory.error_features.data()), result);
}

void patch_contact::unload(const grid &g, patch_memory &memory) {
  if (shared_.friction.size()) std::fill_n(shared_.friction.data(), g.count(), 0.0);
  const auto &law = shared_.scene.law;
  memory.unload(g, law ? &*law : nullptr);
}

}  // namespace railpatch
