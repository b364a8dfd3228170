// The tangential problem of one patch: which theory, what drives it, unlike bodies' turns.
#include <algorithm>

#include "patch/patch_contact.hpp"

namespace railpatch {

namespace {

// of unlike bodies' tangential problem, after which it is given up
constexpr int most_failures = 5;

}  // namespace

bool patch_contact::solve_tangential(const patch_problem &problem, patch_memory &memory,
                                     rp_patch_result &result) {
  prescribed_force force;
  const rolling_input rolling = rolling_of(problem, memory, force);
  const tangential_result t = solve_by_theory(problem, rolling, memory, result);
  for (int c = 0; c < 2; ++c) {
    if (!scene_.prescribed[c]) continue;
    result.creepage[c] = memory.creepage[static_cast<size_t>(c)] = force.creepage[c];
  }
  result.elements[RP_STICK] = t.stick;
  result.elements[RP_SLIP] = t.slip;
  if (fitted_) result.elements[RP_EXTERIOR] = memory.columns() * memory.rows() - t.stick - t.slip;
  result.newton_iterations = t.newton_iterations;
  result.inner_iterations = t.products;
  // written so that a residual that is no number stays visible
  if (!(t.residual <= result.residual)) result.residual = t.residual;
  const double rate = scene_.regime == motion::shift ? 1.0 : problem.rolling_speed;
  result.friction_power = rate * t.friction;
  if (scene_.yields()) result.plastic_power *= rate;
  if (!t.converged)
    degrade(result, scene_.tangential != RP_TANGENTIAL_FULL || t.out_of_range ? RP_OUT_OF_RANGE
                                                                              : RP_NOT_CONVERGED);
  if (scene_.tangential == RP_TANGENTIAL_FULL)
    result.elastic_energy +=
        fitted_ ? fitted_->elastic_energy(*fitted_rows_) : tangential_energy(problem, memory);
  return t.converged;
}

// The step as the tangential theories take it; `force` holds what is prescribed of it.
rolling_input patch_contact::rolling_of(const patch_problem &problem, patch_memory &memory,
                                        prescribed_force &force) {
  rolling_input rolling = problem.rolling;
  if (problem.past) {
    find_before(problem, rolling);
  } else if (scene_.keeps_steps()) {
    rolling.px = memory.history.last_px.data();
    rolling.py = memory.history.last_py.data();
  }
  if (!(problem.rolling_speed > 0) && scene_.regime != motion::shift) {
    // standstill: creepage is not defined and no micro-slip has happened, so all sticks unloaded
    rolling.creepage[0] = rolling.creepage[1] = rolling.spin_creepage = 0;
  }
  if (scene_.is_forced()) {
    for (int c = 0; c < 2; ++c) {
      if (!scene_.prescribed[c]) continue;
      force.component[c] = true;
      force.force[c] = problem.tangential_force[c];
      force.creepage[c] = memory.creepage[static_cast<size_t>(c)];
      rolling.creepage[c] = 0;
    }
    rolling.force = &force;
  }
  if (coupled_ && (problem.rolling_speed > 0 || rolling.regime != motion::steady)) {
    observe(RP_STAGE_COUPLING, true);
    coupled_->set_slip(memory.pressure.data(), rolling);
    observe(RP_STAGE_COUPLING, false);
    for (int c = 0; c < 2; ++c) rolling.coupled[c] = coupled_->slip(c);
  }
  const grid &g = problem.g;
  if (scene_.spin_offset) rolling.spin_offset = rolling.direction * g.dx / 6.0;
  if (memory.curved && problem.rolling_speed > 0) add_slip_of_rows(g, *memory.curved, rolling);
  return rolling;
}

tangential_result patch_contact::solve_by_theory(const patch_problem &problem,
                                                 const rolling_input &rolling, patch_memory &memory,
                                                 rp_patch_result &result) {
  if (fitted_) return solve_fitted(problem, rolling, memory);
  if (!fast_)
    return heat_ && heat_->feeds_back() ? solve_with_heat(problem, rolling, memory, result)
                                        : solve_on_grid(problem, rolling, memory, result, nullptr);
  const fast_patch patch{
      problem.g,           memory.pressure.size() ? memory.pressure.data() : nullptr,
      problem.hertz,       rows_ ? &*rows_ : nullptr,
      result.normal_force, result.contact_area,
      scene_.friction()};
  return fast_->solve(patch, rolling, memory.fields(), sums_);
}

// On a curved reference surface every row has a rigid slip of its own.
void patch_contact::add_slip_of_rows(const grid &g, const conformal_rows &rows,
                                     rolling_input &rolling) {
  rolling.creepage[0] = rolling.creepage[1] = rolling.spin_creepage = 0;
  for (int c = 0; c < 2; ++c) {
    double *slip = coupled_->slip(c);
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        slip[j * g.nx + i] += rows.slip(c, j, g.x(i) + rolling.spin_offset);
  }
}

// The displacement by the last step's tractions where each element's material was then.
void patch_contact::find_before(const patch_problem &problem, rolling_input &rolling) {
  observe(RP_STAGE_HISTORY, true);
  for (int c = 0; c < 2; ++c) {
    std::fill_n(before_[c].data(), problem.g.count(), 0.0);
    rolling.before[c] = before_[c].data();
  }
  for (int k = 0; k < problem.past_count; ++k) {
    const past_tractions &past = problem.past[k];
    grid from = past.history->last_grid;
    const auto first = static_cast<ptrdiff_t>(past.first_row) * from.nx;
    from.ny = past.rows;
    tangential_->add_moved(*influence_, from, problem.g, past.offset, past.history->last_share,
                           past.history->last_px.data() + first,
                           past.history->last_py.data() + first, before_[0].data(),
                           before_[1].data());
  }
  observe(RP_STAGE_HISTORY, false);
}

void patch_contact::set_bound(const grid &g, const patch_memory &memory, const double *mu) {
  const bool varies = scene_.friction_variation.varies();
  // where the law says mu, what it is multiplied by
  const bool by_velocity = scene_.law && scene_.law->by_velocity;
  const double friction = by_velocity ? 1.0 : scene_.friction_coefficient;
  for (int j = 0; j < g.ny; ++j) {
    const double factor =
        (varies ? memory.row_friction[static_cast<size_t>(j)] : 1.0) * scene_.friction_scale;
    for (auto i = static_cast<size_t>(j * g.nx); i < static_cast<size_t>((j + 1) * g.nx); ++i)
      bound_[i] = (mu ? mu[i] : friction) * factor * memory.pressure[i];
  }
}

tangential_result patch_contact::solve_on_grid(const patch_problem &problem,
                                               const rolling_input &rolling, patch_memory &memory,
                                               rp_patch_result &result, const double *mu) {
  const grid &g = problem.g;
  set_bound(g, memory, mu);
  // the outer loops see the tractions' errors as changes of the heat and of the gap
  const double tolerance = mu ? std::max(0.1 * scene_.tolerance, 1e-12) : scene_.tolerance;
  tangential_options options{tolerance, scene_.max_iterations};
  if (coupled_) options.tolerance = coupled_->tolerance(options.tolerance);
  const auto zero = [&](const double *p) {
    return std::all_of(p, p + g.count(), [](double v) { return v == 0; });
  };
  if (coarse_start_ && rolling.drives() && coarse_start::serves(g.nx, g.ny) &&
      zero(memory.px.data()) && zero(memory.py.data()))
    coarse_start_->find(g, memory.pressure.data(), bound_.data(), rolling, options,
                        memory.fields());
  if (!has_physics || !scene_.law)
    return tangential_->solve(*influence_, g, memory.pressure.data(), bound_.data(), rolling,
                              options, memory.fields());
  memory.history.start_from_before(g, *scene_.law);
  const inelastic_fields fields = memory.history.fields(*scene_.law);
  inelastic_sums sums;
  const tangential_result t =
      tangential_->solve(*influence_, g, memory.pressure.data(), bound_.data(), rolling, options,
                         memory.fields(), &fields, &sums);
  for (size_t i = 0; i < static_cast<size_t>(g.count()); ++i)
    if (memory.pressure[i] > 0) memory.history.friction[i] /= memory.pressure[i];
  result.elements[RP_PLASTIC] = sums.plastic;
  result.ambiguous_elements = sums.ambiguous;
  if (scene_.law->plastic()) result.plastic_power = sums.plastic_work;
  return t;
}

// The tangential problem of unlike bodies, and the normal one again until both agree.
bool patch_contact::solve_in_turn(const patch_problem &problem, patch_memory &memory,
                                  rp_patch_result &result) {
  const double *pressure = memory.pressure.data();
  int normal = result.normal_iterations, newton = 0, products = 0, outer = 0, failures = 0;
  // the gap's error is that of the normal problem and of the tractions' part
  for (int round = 1;; ++round) {
    const double gap_error = result.residual;
    result.outer_iterations = 0;
    const bool solved = solve_tangential(problem, memory, result);
    observe(RP_STAGE_COUPLING, true);
    const double disagreement =
        coupled_->error(pressure, memory.px.data(), memory.py.data(), problem.force_given);
    observe(RP_STAGE_COUPLING, false);
    const bool agreed = gap_error + disagreement <= scene_.normal_tolerance;
    result.normal_iterations = normal;
    result.newton_iterations = newton += result.newton_iterations;
    result.inner_iterations = products += result.inner_iterations;
    // with those of friction and temperature
    result.outer_iterations = outer += result.outer_iterations + 1;
    result.elastic_energy += coupled_->energy(pressure);
    if (!(gap_error + disagreement <= result.residual)) result.residual = gap_error + disagreement;
    failures += !solved;
    if (agreed || failures == most_failures || round >= scene_.max_iterations) {
      if (!agreed) degrade(result, RP_NOT_CONVERGED);
      return solved && result.status == RP_CONVERGED;
    }
    result.status = RP_CONVERGED;
    observe(RP_STAGE_COUPLING, true);
    coupled_->advance();
    observe(RP_STAGE_COUPLING, false);
    observe(RP_STAGE_NORMAL, true);
    const bool loaded = solve_normal(problem, memory, result);
    observe(RP_STAGE_NORMAL, false);
    // tractions too great in between, which part the bodies, are none
    if (!loaded) leave_unloaded(problem, memory);
    // in steady rolling it begins as often as one likes; others do not feed back:
    // see handle/check.cpp
    if (heat_ && heat_->feeds_back()) begin_heat(problem, memory);
    memory.beyond = result.status == RP_OUT_OF_RANGE;
    normal += result.normal_iterations;
  }
}

tangential_result patch_contact::solve_fitted(const patch_problem &problem,
                                              const rolling_input &rolling, patch_memory &memory) {
  const hertz_contact &hertz = problem.hertz;
  if (scene_.normal != RP_NORMAL_HERTZ)
    fitted_rows_->set_pressure(problem.g, memory.pressure.data());
  else if (scene_.line_width > 0)
    fitted_rows_->set_line(hertz.semi_axes[0], scene_.line_width, hertz.normal_force);
  else
    fitted_rows_->set_ellipse(hertz.semi_axes, hertz.normal_force);
  return fitted_->solve(*fitted_rows_, scene_.friction(), rolling,
                        {scene_.tolerance, scene_.max_iterations}, memory.nodes());
}

double patch_contact::tangential_energy(const patch_problem &problem, const patch_memory &memory) {
  const grid &g = problem.g;
  const auto loaded = [&](const aligned_buffer<double> &p) {
    return std::any_of(p.data(), p.data() + g.count(), [](double v) { return v != 0; });
  };
  if (!loaded(memory.px) && !loaded(memory.py)) return 0.0;
  influence_->tangential_product(memory.px.data(), memory.py.data(), scratch_[0].data(),
                                 scratch_[1].data());
  double sum = 0;
  for (int i = 0; i < g.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    sum += memory.px[at] * scratch_[0][at] + memory.py[at] * scratch_[1][at];
  }
  return 0.5 * sum * g.dx * g.dy;
}

}  // namespace railpatch
