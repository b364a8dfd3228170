#include "patch/tangential_stage.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

// m, along x: of the ellipse whose pressure has the same variance. It moves without jumps.
double contact_length(const grid &g, const double *pressure) {
  double sum = 0, first = 0, second = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i);
      sum += p;
      first += p * x;
      second += p * x * x;
    }
  if (!(sum > 0)) return 0.0;
  const double centre = first / sum, variance = second / sum - centre * centre;
  // elements have their own
  return std::sqrt(20.0 * (std::max(variance, 0.0) + g.dx * g.dx / 12.0));
}

}  // namespace

tangential_stage::tangential_stage(patch_workspace &shared, const fft_plans &plans, int max_nx,
                                   int max_ny)
    : shared_(shared) {
  const patch_scene &scene = shared.scene;
  const auto count = static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny);
  if (scene.full_on_grid()) {
    const bool rolls_on = scene.changes || scene.regime == motion::transient;
    // with a prescribed force no creepage is known to start from
    const bool plain = !scene.is_forced() && !scene.law && !scene.keeps_steps() &&
                       !scene.couples() && !scene.slip_by_element && !scene.is_viscous() &&
                       !scene.has_own_influence();
    // of grids as wide as the bodies' overlap the contact takes two thirds either way
    influence::medium bodies = scene.medium();
    bodies.follows = scene.stretches;
    const bool boxed = plain && scene.stretches && !scene.heat && !scene.fluid && !scene.curved;
    tangential_.emplace(
        max_nx, max_ny,
        tangential_solver::setup{scene.is_forced(), scene.law.has_value(), scene.yields(),
                                 scene.keeps_steps(), rolls_on ? &plans : nullptr, scene.moves,
                                 boxed ? &bodies : nullptr, &plans});
    if (plain && coarse_start::serves(max_nx, max_ny))
      coarse_start_.emplace(scene.medium(), plans, max_nx, max_ny);
    bound_ = aligned_buffer<double>(count);
  }
  if (is_fast(scene.tangential)) fast_.emplace(scene.elastic, scene.fast, max_nx, max_ny);
  if (scene.is_fitted()) {
    fitted_rows_.emplace(scene.fitted[0], scene.fitted[1], max_ny);
    fitted_.emplace(scene.elastic, scene.layer_flexibility, scene.line_width > 0, scene.is_forced(),
                    *fitted_rows_);
  }
  if (scene.closed_form() || !scene.keeps_steps() || !scene.moves) return;
  for (auto &b : before_) b = aligned_buffer<double>(count);
  if (!scene.curved) return;
  for (auto *b : {&before_pressed_[0], &before_pressed_[1], &before_gap_})
    *b = aligned_buffer<double>(count);
  for (auto &b : last_rows_) b = aligned_buffer<double>(static_cast<size_t>(max_ny));
}

size_t tangential_stage::bytes() const {
  return bound_.bytes() + 2 * before_[0].bytes() + 3 * before_gap_.bytes() +
         2 * last_rows_[0].bytes() + (tangential_ ? tangential_->bytes() : 0) +
         (coarse_start_ ? coarse_start_->bytes() : 0) +
         (fast_ ? sizeof(fast_solver) + fast_->bytes() : 0) +
         (fitted_ ? fitted_rows_->bytes() + fitted_->bytes() : 0);
}

traction_outcome tangential_stage::solve(const patch_problem &problem,
                                         const pressure_outcome &pressure, patch_memory &memory,
                                         heat_stage &heat) {
  const patch_scene &scene = shared_.scene;
  traction_outcome found;
  prescribed_force force;
  const rolling_input rolling = rolling_of(problem, memory, force);
  const tangential_result t = solve_by_theory(problem, pressure, rolling, memory, heat, found);
  for (int c = 0; c < 2; ++c) {
    if (!scene.prescribed[c]) continue;
    found.creepage[c] = memory.creepage[static_cast<size_t>(c)] = force.creepage[c];
  }
  if (has_physics && problem.slip_field && !scene.goes_on(rolling))
    found.supplied = rigid_work(problem, rolling, force, memory);
  found.stick = t.stick;
  found.slip = t.slip;
  found.exterior =
      fitted_ ? memory.columns() * memory.rows() - t.stick - t.slip : pressure.exterior;
  found.newton_iterations = t.newton_iterations;
  found.inner_iterations = t.products;
  found.residual = t.residual;
  const double rate = problem.shifts ? 1.0 : problem.rolling_speed;
  found.friction_power = rate * t.friction;
  found.supplied *= rate;
  if (scene.yields()) found.plastic_power *= rate;
  found.converged = t.converged;
  found.max_traction = greatest_traction(memory);
  if (!fast_) found.capacity = capacity(problem, pressure, memory, heat);
  if (!t.converged) explain(problem, pressure, t, found);
  // what shift and transient rolling know already
  if (scene.tangential == RP_TANGENTIAL_FULL && !scene.goes_on(rolling))
    found.elastic_energy = fitted_ ? fitted_->elastic_energy(*fitted_rows_)
                           : std::isnan(t.stored) || memory.history.energy.size() > 0
                               ? elastic_energy(problem, memory)
                               : 0.5 * t.stored * problem.g.dx * problem.g.dy;
  return found;
}

// Pa; nan: the theory has no tractions.
double tangential_stage::greatest_traction(const patch_memory &memory) const {
  if (fast_ && !has_tractions(shared_.scene.tangential)) return nan;
  double square = 0;
  const auto count = static_cast<size_t>(memory.columns() * memory.rows());
  for (size_t i = 0; i < count; ++i)
    square = std::max(square, memory.px[i] * memory.px[i] + memory.py[i] * memory.py[i]);
  return std::sqrt(square);
}

// N, by each element's friction coefficient, of the full theory.
double tangential_stage::capacity(const patch_problem &problem, const pressure_outcome &pressure,
                                  const patch_memory &memory, const heat_stage &heat) const {
  const patch_scene &scene = shared_.scene;
  const bool by_velocity = scene.law && scene.law->by_velocity;
  const bool uneven = by_velocity || scene.friction_variation.varies() || heat.feeds_back() ||
                      (has_physics && memory.fluid_pressure.size() > 0);
  if (fitted_ || !uneven) return scene.friction() * pressure.normal_force;
  double sum = 0;
  for (size_t i = 0; i < static_cast<size_t>(problem.g.count()); ++i)
    sum += by_velocity ? memory.history.friction[i] * memory.pressure[i] : bound_[i];
  return sum * problem.g.dx * problem.g.dy;
}

// Why there is no solution. A fast theory that gives none is outside its range.
void tangential_stage::explain(const patch_problem &problem, const pressure_outcome &pressure,
                               const tangential_result &t, traction_outcome &found) const {
  const patch_scene &scene = shared_.scene;
  const double *axes = problem.hertz.semi_axes;
  if (scene.tangential == RP_TANGENTIAL_LINEAR)
    degrade(found, RP_OUT_OF_RANGE, RP_REASON_LINEAR,
            hypot(found.force[0], found.force[1]) / (scene.friction() * pressure.normal_force));
  else if (scene.tangential != RP_TANGENTIAL_FULL)
    degrade(found, RP_OUT_OF_RANGE, RP_REASON_THEORY, axes[1] > 0 ? axes[0] / axes[1] : nan);
  else if (scene.is_forced())
    degrade(found, t.out_of_range ? RP_OUT_OF_RANGE : RP_NOT_CONVERGED, RP_REASON_PRESCRIBED_FORCE);
  else if (t.of_heat)
    degrade(found, RP_NOT_CONVERGED, RP_REASON_HEAT_LOOP, t.residual);
  else
    degrade(found, RP_NOT_CONVERGED, RP_REASON_TRACTION_ITERATIONS, t.residual);
}

// The step as the tangential theories take it; `force` holds what is prescribed of it. First what
// the last step left and what drives the patch, then what the pressure adds. Coupling sets its slip
// anew, by the regime and the distance rolled; the slip of curved rows is added to that, with the
// spin's offset, and takes the place of the creepages, which nothing may read after it.
rolling_input tangential_stage::rolling_of(const patch_problem &problem, const patch_memory &memory,
                                           prescribed_force &force) {
  const patch_scene &scene = shared_.scene;
  rolling_input rolling = problem.rolling;
  if (problem.past) {
    find_before(problem, memory, rolling);
  } else if (scene.goes_on(rolling)) {
    rolling.px = memory.history.last_px.data();
    rolling.py = memory.history.last_py.data();
  }
  if (!(problem.rolling_speed > 0) && !problem.shifts) {
    // standstill: creepage is not defined and no micro-slip has happened, so all sticks unloaded
    rolling.creepage[0] = rolling.creepage[1] = rolling.spin_creepage = 0;
  }
  if (scene.is_forced()) prescribe(problem, memory, rolling, force);
  if (auto &coupled = shared_.coupled;
      coupled && (problem.rolling_speed > 0 || rolling.regime != motion::steady)) {
    const stage_mark mark = shared_.marks.enter(RP_STAGE_COUPLING);
    coupled->set_slip(memory.pressure.data(), rolling);
    for (int c = 0; c < 2; ++c) rolling.coupled[c] = coupled->slip(c);
  }
  if (problem.slip_field && (problem.rolling_speed > 0 || problem.shifts))
    add_slip_field(problem, rolling);
  const grid &g = problem.g;
  const bool offset = scene.spin_offset != 0 || scene.step_spin_offset != 0;
  if (offset && !problem.shifts) rolling.spin_offset = spin_offset_of(problem, memory, rolling);
  if (memory.curved && problem.rolling_speed > 0) add_slip_of_rows(g, *memory.curved, rolling);
  return rolling;
}

// What the step prescribes of each element, added to what the pressure causes.
void tangential_stage::add_slip_field(const patch_problem &problem, rolling_input &rolling) {
  const int count = problem.g.count();
  for (int c = 0; c < 2; ++c) {
    const double *field = problem.slip_field + c * count;
    if (rolling.coupled[c]) {
      double *slip = shared_.coupled->slip(c);
      for (int i = 0; i < count; ++i) slip[i] += field[i];
    } else {
      rolling.coupled[c] = field;
    }
  }
}

// A part of the way that material has come in contact: of the step's, but no more than its length.
double tangential_stage::spin_offset_of(const patch_problem &problem, const patch_memory &memory,
                                        const rolling_input &rolling) const {
  if (rolling.regime == motion::steady)
    return shared_.scene.spin_offset * rolling.direction * problem.g.dx;
  const double part = shared_.scene.step_spin_offset;
  if (rolling.regime == motion::shift) return part * rolling.direction * problem.g.dx;
  const double length = contact_length(problem.g, memory.pressure.data());
  const double way = problem.past ? problem.rolled : rolling.upstream();
  return part * std::clamp(way, -length, length);
}

// Of the components of a prescribed force the creepage is what the last step, or round, found.
void tangential_stage::prescribe(const patch_problem &problem, const patch_memory &memory,
                                 rolling_input &rolling, prescribed_force &force) const {
  for (int c = 0; c < 2; ++c) {
    if (!shared_.scene.prescribed[c]) continue;
    force.component[c] = true;
    force.force[c] = problem.tangential_force[c];
    force.creepage[c] = memory.creepage[static_cast<size_t>(c)];
    rolling.creepage[c] = 0;
  }
  rolling.force = &force;
}

tangential_result tangential_stage::solve_by_theory(const patch_problem &problem,
                                                    const pressure_outcome &pressure,
                                                    const rolling_input &rolling,
                                                    patch_memory &memory, heat_stage &heat,
                                                    traction_outcome &found) {
  if (fitted_) return solve_fitted(problem, rolling, memory);
  if (!fast_)
    return heat.feeds_back() ? solve_with_heat(problem, rolling, memory, heat, found)
                             : solve_on_grid(problem, rolling, memory, nullptr, found);
  const fast_patch patch{problem.g,
                         memory.pressure.size() ? memory.pressure.data() : nullptr,
                         problem.hertz,
                         pressure.rows,
                         pressure.normal_force,
                         pressure.contact_area,
                         shared_.scene.friction(),
                         shared_.scene.friction_scale};
  creep_resultants sums;
  const bool regimes =
      has_physics && shared_.scene.fluid && shared_.scene.fluid->model == RP_FLUID_REGIMES;
  const tangential_result t = regimes ? solve_regimes(patch, rolling, sums)
                                      : fast_->solve(patch, rolling, memory.fields(), sums);
  std::copy_n(sums.force, 2, found.force);
  found.moment = sums.moment;
  found.capacity = sums.capacity;
  return t;
}

// Each pass of the outer loop starts from the tractions of the last one.
tangential_result tangential_stage::solve_with_heat(const patch_problem &problem,
                                                    const rolling_input &rolling,
                                                    patch_memory &memory, heat_stage &heat,
                                                    traction_outcome &found) {
  tangential_result last{};
  int newton = 0, products = 0;
  const auto pass = [&](const double *mu) {
    const stage_mark mark = shared_.marks.enter(RP_STAGE_TANGENTIAL);
    last = solve_on_grid(problem, rolling, memory, mu, found);
    newton += last.newton_iterations;
    products += last.products;
    return last.converged;
  };
  const temperature_loop_result loop = heat.solve(problem, memory, pass);
  found.outer_iterations = loop.iterations;
  last.newton_iterations = newton;
  last.products = products;
  last.of_heat = last.converged && !loop.converged;
  last.converged = last.converged && loop.converged;
  if (!(loop.residual <= last.residual)) last.residual = loop.residual;
  return last;
}

// On a curved reference surface every row has a rigid slip of its own.
void tangential_stage::add_slip_of_rows(const grid &g, const conformal_rows &rows,
                                        rolling_input &rolling) {
  rolling.creepage[0] = rolling.creepage[1] = rolling.spin_creepage = 0;
  rolling.row_spin = rows.spin();
  for (int c = 0; c < 2; ++c) {
    double *slip = shared_.coupled->slip(c);
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        slip[j * g.nx + i] += rows.slip(c, j, g.x(i) + rolling.spin_offset);
  }
}

// The displacement by the last step's tractions where each element's material was then.
void tangential_stage::find_before(const patch_problem &problem, const patch_memory &memory,
                                   rolling_input &rolling) {
  const stage_mark mark = shared_.marks.enter(RP_STAGE_HISTORY);
  if (memory.curved) return find_curved_before(problem, *memory.curved, rolling);
  for (int c = 0; c < 2; ++c) {
    std::fill_n(before_[c].data(), problem.g.count(), 0.0);
    rolling.before[c] = before_[c].data();
  }
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    grid from = past.history->last_grid;
    const auto first = static_cast<ptrdiff_t>(past.first_row) * from.nx;
    from.ny = past.rows;
    tangential_->add_moved(*shared_.influence, from, problem.g, past.offset,
                           past.history->last_share, past.history->last_px.data() + first,
                           past.history->last_py.data() + first, before_[0].data(),
                           before_[1].data());
  }
}

// The same from rows of one curve to those of another, once for all rounds of a solution.
void tangential_stage::find_curved_before(const patch_problem &problem, const conformal_rows &rows,
                                          rolling_input &rolling) {
  for (int c = 0; c < 2; ++c) rolling.before[c] = before_[c].data();
  if (!shared_.coupled->begins()) return;
  const grid &g = problem.g;
  const curved_sums sums{{before_[0].data(), before_[1].data()},
                         {before_pressed_[0].data(), before_pressed_[1].data()},
                         before_gap_.data()};
  for (double *field : {sums.from_traction[0], sums.from_traction[1], sums.from_pressure[0],
                        sums.from_pressure[1], sums.gap})
    std::fill_n(field, g.count(), 0.0);
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    const patch_history &last = *past.history;
    grid from = last.last_grid;
    const auto first = static_cast<ptrdiff_t>(past.first_row) * from.nx;
    from.ny = past.rows;
    for (int j = 0; j < from.ny; ++j) {
      const double angle = rows.turned(last.last_angle[static_cast<size_t>(past.first_row + j)]);
      last_rows_[0][static_cast<size_t>(j)] = cos(angle);
      last_rows_[1][static_cast<size_t>(j)] = sin(angle);
    }
    const curved_past source{last.last_px.data() + first,
                             last.last_py.data() + first,
                             last.last_pressure.data() + first,
                             {last_rows_[0].data(), rows.cosine()},
                             {last_rows_[1].data(), rows.sine()}};
    tangential_->add_curved(*shared_.influence, from, g, past.offset, last.last_share, source,
                            sums);
  }
  for (int c = 0; c < 2; ++c)
    for (int i = 0; i < g.count(); ++i)
      before_[c][static_cast<size_t>(i)] += before_pressed_[c][static_cast<size_t>(i)];
}

void tangential_stage::set_bound(const grid &g, const patch_memory &memory, const double *mu) {
  const bool varies = shared_.scene.friction_variation.varies();
  // where the law says mu, what it is multiplied by
  const bool by_velocity = shared_.scene.law && shared_.scene.law->by_velocity;
  const double friction = by_velocity ? 1.0 : shared_.scene.coefficient();
  for (int j = 0; j < g.ny; ++j) {
    const double factor =
        (varies ? memory.row_friction[static_cast<size_t>(j)] : 1.0) * shared_.scene.friction_scale;
    for (auto i = static_cast<size_t>(j * g.nx); i < static_cast<size_t>((j + 1) * g.nx); ++i)
      bound_[i] = (mu ? mu[i] : friction) * factor * memory.pressure[i];
    if (!has_physics || memory.fluid_pressure.size() == 0) continue;
    // what the liquid bears has no friction
    for (auto i = static_cast<size_t>(j * g.nx); i < static_cast<size_t>((j + 1) * g.nx); ++i)
      bound_[i] =
          (mu ? mu[i] : friction) * factor * (memory.pressure[i] - memory.fluid_pressure[i]);
    if (memory.fluid_shear.size() == 0) continue;
    // but its shear
    for (auto i = static_cast<size_t>(j * g.nx); i < static_cast<size_t>((j + 1) * g.nx); ++i)
      bound_[i] += factor * memory.fluid_shear[i];
  }
}

tangential_result tangential_stage::solve_on_grid(const patch_problem &problem,
                                                  const rolling_input &rolling,
                                                  patch_memory &memory, const double *mu,
                                                  traction_outcome &found) {
  const grid &g = problem.g;
  set_bound(g, memory, mu);
  // the outer loops see the tractions' errors as changes of the heat and of the gap
  const double tolerance =
      mu ? std::max(0.1 * shared_.scene.tolerance, 1e-12) : shared_.scene.tolerance;
  tangential_options options{tolerance, shared_.scene.max_iterations, shared_.scene.ask};
  if (shared_.coupled) options.tolerance = shared_.coupled->tolerance(options.tolerance);
  const auto zero = [&](const double *p) {
    return std::all_of(p, p + g.count(), [](double v) { return v == 0; });
  };
  if (coarse_start_ && rolling.drives() && coarse_start::serves(g.nx, g.ny) &&
      zero(memory.px.data()) && zero(memory.py.data()))
    coarse_start_->find(g, memory.pressure.data(), bound_.data(), rolling, options,
                        memory.fields());
  tangential_result t = solve_by_law(problem, rolling, memory, options, found);
  if (shared_.scene.goes_on(rolling))
    close_step(problem, rolling, memory, t, found);
  else if (shared_.coupled && rolling.coupled[0])
    close_steady(problem, rolling, memory, t, found);
  if (shared_.scene.yields()) shared_.plastic_work = found.plastic_power;
  const bool sheared = memory.fluid_shear.size() > 0;
  if (has_physics && (shared_.scene.heat || sheared))
    find_friction_heat(problem, rolling, memory, t.friction);
  if (has_physics && sheared)
    found.fluid_power = problem.rolling_speed * fluid_work(g, rolling.direction, memory);
  return t;
}

tangential_result tangential_stage::solve_by_law(const patch_problem &problem,
                                                 const rolling_input &rolling, patch_memory &memory,
                                                 const tangential_options &options,
                                                 traction_outcome &found) {
  const grid &g = problem.g;
  if (has_physics && shared_.viscous)
    return solve_viscous(problem, rolling, memory, options, found);
  if (!has_physics || !shared_.scene.law)
    return tangential_->solve({*shared_.influence, g, memory.pressure.data(), bound_.data(),
                               rolling, options, memory.fields(), problem.followed});
  const bool goes_on = shared_.scene.goes_on(rolling);
  memory.history.start_from_before(g, *shared_.scene.law, goes_on);
  const inelastic_fields fields = memory.history.fields(*shared_.scene.law, goes_on);
  inelastic_sums sums;
  const tangential_result t =
      tangential_->solve({*shared_.influence, g, memory.pressure.data(), bound_.data(), rolling,
                          options, memory.fields(), problem.followed, &fields, &sums});
  for (size_t i = 0; i < static_cast<size_t>(g.count()); ++i)
    if (memory.pressure[i] > 0) memory.history.friction[i] /= memory.pressure[i];
  found.plastic = sums.plastic;
  found.ambiguous = sums.ambiguous;
  if (shared_.scene.law->plastic()) found.plastic_power = sums.plastic_work;
  return t;
}

// What the bodies take up by the tractions is none of friction's.
tangential_result tangential_stage::solve_viscous(const patch_problem &problem,
                                                  const rolling_input &rolling,
                                                  patch_memory &memory,
                                                  const tangential_options &options,
                                                  traction_outcome &found) {
  viscous_influence &viscous = *shared_.viscous;
  tangential_result t = tangential_->solve({*shared_.influence, problem.g, memory.pressure.data(),
                                            bound_.data(), rolling, options, memory.fields(),
                                            problem.followed, nullptr, nullptr, &viscous});
  const double loss = viscous.tangential_loss(memory.px.data(), memory.py.data());
  t.friction -= loss;
  found.viscous_power = problem.rolling_speed * loss;
  return t;
}

tangential_result tangential_stage::solve_fitted(const patch_problem &problem,
                                                 const rolling_input &rolling,
                                                 patch_memory &memory) {
  const hertz_contact &hertz = problem.hertz;
  if (shared_.scene.normal != RP_NORMAL_HERTZ)
    fitted_rows_->set_pressure(problem.g, memory.pressure.data());
  else if (shared_.scene.line_width > 0)
    fitted_rows_->set_line(hertz.semi_axes[0], shared_.scene.line_width, hertz.normal_force);
  else
    fitted_rows_->set_ellipse(hertz.semi_axes, hertz.normal_force);
  return fitted_->solve(*fitted_rows_, shared_.scene.friction(), rolling,
                        {shared_.scene.tolerance, shared_.scene.max_iterations, shared_.scene.ask},
                        memory.nodes());
}

// Of the tractions; where steps go on from it, its density is kept.
double tangential_stage::elastic_energy(const patch_problem &problem, patch_memory &memory) {
  const grid &g = problem.g;
  double *density = memory.history.energy.size() ? memory.history.energy.data() : nullptr;
  if (density) std::fill_n(density, g.count(), 0.0);
  const auto loaded = [&](const aligned_buffer<double> &p) {
    return std::any_of(p.data(), p.data() + g.count(), [](double v) { return v != 0; });
  };
  if (!loaded(memory.px) && !loaded(memory.py)) {
    for (auto &u : shared_.scratch) std::fill_n(u.data(), g.count(), 0.0);
    return 0.0;
  }
  double *u[2] = {shared_.scratch[0].data(), shared_.scratch[1].data()};
  if (shared_.viscous)
    shared_.viscous->tangential_product(memory.px.data(), memory.py.data(), u[0], u[1]);
  else
    shared_.influence->tangential_product(memory.px.data(), memory.py.data(), u[0], u[1]);
  double sum = 0;
  for (int i = 0; i < g.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const double twice =
        memory.px[at] * shared_.scratch[0][at] + memory.py[at] * shared_.scratch[1][at];
    sum += twice;
    if (density) density[i] = 0.5 * twice;
  }
  return 0.5 * sum * g.dx * g.dy;
}

void tangential_stage::set_resultants(const traction_outcome &found, patch_memory &memory,
                                      patch_wrench &wrench) const {
  if (!fitted_ && (!fast_ || has_tractions(shared_.scene.tangential))) return;
  const patch_wrench creep =
      fitted_ ? fitted_->creep_wrench(*fitted_rows_, memory.nodes())
              : patch_wrench{{found.force[0], found.force[1], 0.0}, {0.0, 0.0, found.moment}};
  wrench.force[0] = creep.force[0];
  wrench.force[1] = creep.force[1];
  wrench.moment[2] = creep.moment[2];
}

}  // namespace railpatch
