#include "numeric/elementary.hpp"
#include "tangential/inelastic_task.hpp"

#include <algorithm>
#include <cmath>

#include "railpatch.h"

namespace railpatch {

namespace {

constexpr double inner_tolerance = 1e-2, worst_inner_tolerance = 0.3;
// of one descent, and of all in a solve: Newton steps go on without
constexpr int max_projections = 100, max_sweeps = 20, all_projections = 400;
// times that elements are taken off unstable branches
constexpr int max_returns = 5;
// times that the size of the solution may turn out less
constexpr int max_settlings = 5;
// r over the steepest fall of b: 1 would do for uniqueness
constexpr double steepness_margin = 2.0;

double square(double v) { return v * v; }

}  // namespace

inelastic_newton::inelastic_newton(int max_row, int max_rows, bool forced)
    : row_newton(max_row, max_rows, forced), blocks_(max_row, max_rows) {
  const auto n = static_cast<size_t>(max_row) * static_cast<size_t>(max_rows);
  most_ = aligned_buffer<double>(n);
  for (auto *b : {&started_, &kept_, &first_}) *b = aligned_buffer<double>(2 * n + 2);
  for (auto *l : {&linear_, &factored_}) *l = aligned_buffer<linearisation>(n);
  has_factors_ = aligned_buffer<unsigned char>(static_cast<size_t>(max_rows));
}

size_t inelastic_newton::bytes() const {
  return row_newton::bytes() + blocks_.bytes() + most_.bytes() + 3 * started_.bytes() +
         2 * linear_.bytes() + has_factors_.bytes();
}

inelastic_result inelastic_newton::solve(rolling_operator &b, const rolling_problem &problem,
                                         const inelastic_problem &inelastic,
                                         const tangential_options &options) {
  task t{
      {b, problem, problem.force ? &*force_ : nullptr}, inelastic, *inelastic.law, problem.bound};
  t.ask = options.ask;
  bool undone = false;
  for (int k = 0; k < problem.count(); ++k) {
    most_[static_cast<size_t>(k)] = t.law.greatest(problem.bound[k]);
    const double fall = t.law.fall_of_each(problem.bound[k]);
    t.falls = t.falls || fall > 0;
    undone = undone || fall > t.law.fall_ahead(problem.bound[k]);
  }
  t.problem.bound = most_.data();
  set_stiffness(t, false);
  if (t.force) t.force->begin(t.problem, options.tolerance);
  if (const double size = scale(t); size > 0) {
    const bool twice = undone && !t.force;
    const int most = options.max_iterations;
    outcome found = attempt(t, options.tolerance, twice ? std::max(most / 2, 1) : most);
    if (twice && !found.within(options.tolerance)) found = attempt_steeply(t, found, options);
    conclude(t, found.error, found.size, options.tolerance);
  } else {
    leave_unloaded(t, size);
  }
  finish(t);
  t.sums.tangential = t.result;
  return t.sums;
}

// r of all elements. undone: plastic displacement may be.
void inelastic_newton::set_stiffness(const task &t, bool undone) {
  for (int row = 0; row < t.problem.rows; ++row) {
    const double typical = t.b.projection_scale(row);
    for (int k = t.problem.row_start[row]; k < t.problem.row_start[row + 1]; ++k) {
      const double friction = t.friction[k];
      const double fall = undone ? t.law.fall_of_each(friction) : t.law.fall_ahead(friction);
      r_[static_cast<size_t>(k)] = std::max(typical, steepness_margin * t.law.step * fall);
    }
  }
}

// From the tractions given to the best found.
inelastic_newton::outcome inelastic_newton::attempt(task &t, double tolerance, int max_iterations) {
  outcome found{0, scale(t)};
  std::fill_n(has_factors_.data(), t.problem.rows, static_cast<unsigned char>(0));
  const double goal = tolerance * found.size;
  double error = start(t);
  if (t.falls) std::copy_n(t.problem.traction, t.size(), started_.data());
  error = iterate(t, error, goal, max_iterations);
  if (t.falls && !t.force) error = choose_branch(t, error, goal, max_iterations);
  found.error = error;
  settle(t, found, tolerance, max_iterations);
  return found;
}

// Again from the start, with r for plastic displacement undone; the better one where both fail.
inelastic_newton::outcome inelastic_newton::attempt_steeply(task &t, const outcome &before,
                                                            const tangential_options &options) {
  double *p = t.problem.traction;
  std::copy_n(p, t.size(), first_.data());
  std::copy_n(started_.data(), t.size(), p);
  t.projections = 0;
  set_stiffness(t, true);
  const outcome found = attempt(t, options.tolerance, options.max_iterations);
  if (found.within(options.tolerance)) return found;
  set_stiffness(t, false);
  const double error = evaluate(t);
  if (error <= before.error) return {error, before.size};
  std::copy_n(first_.data(), t.size(), p);
  return {evaluate(t), before.size};
}

// Where the laws leave far less traction than their greatest bounds, the solution itself says to
// which size its error is small: goes on until it is. Returns the size, sets |F|.
void inelastic_newton::settle(task &t, outcome &found, double tolerance, int max_iterations) {
  for (int k = 0; k < max_settlings && found.within(tolerance); ++k) {
    const double own = std::min(found.size, scale_of_solution(t));
    if (!(own > 0)) return;
    found.size = own;
    if (found.within(tolerance)) return;
    found.error = iterate(t, found.error, tolerance * own, max_iterations);
  }
}

// Newton's steps and their safeguard; returns the best |F|, which the traction then has.
double inelastic_newton::iterate(task &t, double error, double goal, int max_iterations) {
  int &iterations = t.result.newton_iterations;
  double best = HUGE_VAL, least = HUGE_VAL;
  for (int strayed = 0;
       error > goal && iterations < max_iterations && !(t.force && t.force->beyond());
       ++iterations) {
    const bool lower = error <= enough * best;
    if (error < least || lower) {
      least = error;
      remember(t);
    }
    if (lower) {
      best = error;
      strayed = 0;
    } else if (!(t.force && t.force->travels()) && ++strayed > patience) {
      error = descend(t, enough * best);
      best = std::min(best, error);
      strayed = 0;
      continue;
    }
    linearise(t);
    find_step(t, std::clamp(0.3 * goal / error, inner_tolerance, worst_inner_tolerance));
    error = line_search(t, error);
  }
  return error <= least || least == HUGE_VAL ? error : recall(t);
}

// Pa/m, of an element along e with all others held; elements are asked for row by row.
double inelastic_newton::own_stiffness(task &t, int row, size_t element, const double e[2]) {
  if (row != t.row) t.b.row_matrices(row, row_matrix_[0].data(), row_matrix_[1].data());
  t.row = row;
  const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
  const auto at = (element - static_cast<size_t>(begin)) * static_cast<size_t>(n + 1);
  const double own = row_matrix_[0][at] * e[0] * e[0] + row_matrix_[1][at] * e[1] * e[1];
  return 1.0 / (own * t.law.step);
}

// Of several solutions the one next to the last step's; returns |F|.
double inelastic_newton::choose_branch(task &t, double error, double goal, int max_iterations) {
  double *p = t.problem.traction;
  for (int k = 0; k < max_returns && error <= goal; ++k) {
    std::copy_n(p, t.size(), kept_.data());
    if (!go_to_branch(t)) break;
    const double other = iterate(t, evaluate(t), goal, max_iterations);
    if (other <= goal) {
      error = other;
      continue;
    }
    std::copy_n(kept_.data(), t.size(), p);
    return evaluate(t);
  }
  return error;
}

// An element between stick and slip, where friction falls faster than elasticity can follow, is at
// no rest: it goes to the side of the start. One that slips, but can stick and did so more nearly,
// sticks. Returns whether there was one.
bool inelastic_newton::go_to_branch(task &t) {
  double *p = t.problem.traction;
  bool any = false;
  t.row = -1;
  std::copy_n(p, t.size(), trial_p_.data());
  apply_law(t, trial_p_.data(), t.problem.micro_slip, 1.0, [&](const inelastic_element &at) {
    if (at.stick) return;
    const bound_point b =
        t.carried() ? at.point : t.law.evaluate(t.friction[at.k], *at.before, at.e, at.m);
    if (b.by_slip >= 0) return;
    const double stiffness = own_stiffness(t, at.row, at.k, at.e);
    const double size = b.bound + stiffness * at.m;
    const double rest = t.law.at_rest(t.friction[at.k], *at.before);
    const double before = hypot(started_[at.ix], started_[at.iy]);
    const bool unstable = stiffness + b.by_slip < 0;
    const bool sticks =
        unstable ? before >= b.bound : size <= rest && size - before < before - b.bound;
    if (!sticks && !unstable) return;
    any = true;
    const double bound =
        sticks ? std::min(size, rest)
               : size - stiffness * t.law.resolve(t.friction[at.k], *at.before, at.e, size,
                                                  stiffness, at.m * (1.0 + 1e-6));
    p[at.ix] = bound * at.e[0];
    p[at.iy] = bound * at.e[1];
  });
  return any;
}

void inelastic_newton::residual(const task &t, const double *p, const double *s, double *f) const {
  apply_law(t, p, s, 1.0, [&](const inelastic_element &at) {
    const double r = r_[at.k], bound = at.bound();
    f[at.ix] = at.stick ? r * s[at.ix] : p[at.ix] - bound * at.e[0];
    f[at.iy] = at.stick ? r * s[at.iy] : p[at.iy] - bound * at.e[1];
  });
}

void inelastic_newton::resolvent(const task &t, const double *p, const double *s, double length,
                                 double *out) const {
  apply_law(t, p, s, length, [&](const inelastic_element &at) {
    out[at.ix] = at.bound() * at.e[0];
    out[at.iy] = at.bound() * at.e[1];
  });
}

double inelastic_newton::start_bound(const task &t, size_t k) const {
  return t.law.at_rest(t.friction[k], carried_state{{0, 0, 0}});
}

// Start: the traction given, or where rows begin at their leading edge and that says little the
// simplified theory's.
double inelastic_newton::start(task &t) {
  prepare_start(t);
  double error = evaluate(t);
  if (t.carried() && error > far_away * scale(t)) try_march(t, error);
  return error;
}

// Takes the simplified theory's traction where it is better.
void inelastic_newton::try_march(task &t, double &error) {
  const bool cold = is_zero(t);
  march(t);
  const double marched = evaluate_trial(t);
  if (marched < error || (cold && t.force)) {
    take_trial(t);
    error = marched;
    return;
  }
  if (t.force) t.force->go_back(t.problem);
}

// As `scale` with the bounds of the tractions found, and the stiffness of a single element.
double inelastic_newton::scale_of_solution(const task &t) const {
  const double *w = t.problem.rigid_slip;
  double sum = 0;
  apply_law(t, t.problem.traction, t.problem.micro_slip, 1.0, [&](const inelastic_element &at) {
    const double bound =
        at.stick ? t.law.at_rest(t.friction[at.k], *at.before) : std::min(at.bound(), most_[at.k]);
    const double asked = t.b.projection_scale(at.row) *
                         hypot(w[at.ix] + t.problem.creepage(0), w[at.iy] + t.problem.creepage(1));
    sum += square(std::min(bound, asked));
  });
  return t.force ? hypot(std::sqrt(sum), t.force->size()) : std::sqrt(sum);
}

// Slow but sure steps from the best traction until |F| is down at `goal`, or as long as there are
// steps; ends at the best of them.
double inelastic_newton::descend(task &t, double goal) {
  double error = recall(t), least = error, length = 1;
  // where the law falls each has its cases: turn about
  const bool monotone = t.force || !(t.carried() || t.falls) || t.descents++ % 2 == 1;
  const int most = monotone ? max_projections : max_sweeps;
  for (int k = 0; k < most && t.projections < all_projections && error > goal;
       ++k, ++t.projections) {
    if (monotone)
      extragradient(t, length);
    else
      sweep(t);
    error = evaluate(t);
    if (!(error < least)) continue;
    least = error;
    remember(t);
  }
  return error <= least ? error : recall(t);
}

// Solves one element after another, along each row; in steady rolling rows feel each other's
// changes afterwards, in a step of transient rolling, where they are coupled far more strongly, at
// once.
void inelastic_newton::sweep(task &t) {
  double *p = t.problem.traction, *s = t.problem.micro_slip;
  for (int row = 0; row < t.problem.rows; ++row) {
    const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
    t.b.row_matrices(row, row_matrix_[0].data(), row_matrix_[1].data());
    carried_state upstream{{0, 0, 0}};
    for (int k = 0; k < n; ++k) {
      const auto at = static_cast<size_t>(begin + k);
      const carried_state &before = t.carried() ? upstream : t.inelastic.before[at];
      double *traction[2] = {p + 2 * begin + k, p + 2 * begin + n + k};
      const double *slip[2] = {s + 2 * begin + k, s + 2 * begin + n + k};
      const double own = 0.5 * (row_matrix_[0][static_cast<size_t>(k * n + k)] +
                                row_matrix_[1][static_cast<size_t>(k * n + k)]);
      double q[2], e[2] = {1, 0};
      for (int c = 0; c < 2; ++c) q[c] = *traction[c] - *slip[c] / own;
      const double size = hypot(q[0], q[1]), stiffness = 1.0 / (own * t.law.step);
      double bound = size, m = 0;
      if (size > 0)
        for (int c = 0; c < 2; ++c) e[c] = q[c] / size;
      if (size > t.law.at_rest(t.friction[at], before)) {
        m = t.law.resolve(t.friction[at], before, e, size, stiffness);
        bound = std::min(size - stiffness * m, most_[at]);
      }
      if (t.carried()) upstream = t.law.evaluate(t.friction[at], before, e, m).state;
      for (int c = 0; c < 2; ++c) {
        const double change = bound * e[c] - *traction[c];
        *traction[c] += change;
        const double *column = row_matrix_[c].data() + k * n;
        double *target = s + 2 * begin + c * n;
        for (int i = 0; i < n; ++i) target[i] += change * column[i];
      }
    }
    if (!t.carried() && row + 1 < t.problem.rows) evaluate_slip(t);
  }
}

// Puts the tractions exactly on the law, so that bound, slip and states belong together, and
// divides the elements.
void inelastic_newton::finish(task &t) {
  const rolling_problem &problem = t.problem;
  const inelastic_problem &out = t.inelastic;
  double *p = problem.traction, *s = problem.micro_slip;
  tangential_result &sum = t.result;
  double slipped = 0, plastic = 0, supplied = 0;
  t.row = -1;
  // the traction moves by F: s, known at the traction before, decides
  std::copy_n(p, t.size(), trial_p_.data());
  std::copy_n(s, t.size(), trial_s_.data());
  apply_law(t, trial_p_.data(), trial_s_.data(), 1.0, [&](const inelastic_element &at) {
    const bound_point b =
        t.carried() ? at.point : t.law.evaluate(t.friction[at.k], *at.before, at.e, at.m);
    const int ix = static_cast<int>(at.ix), iy = static_cast<int>(at.iy);
    // a sticking element keeps its traction: r s, below the tolerance where it slides, can be much
    // greater than the traction itself where r is that of a steep law
    const double traction = hypot(p[ix], p[iy]);
    const double bound = at.stick ? std::min(traction, b.bound) : b.bound;
    const double slip = (at.m - b.plastic) / t.law.step;
    if (!at.stick) {
      p[ix] = bound * at.e[0];
      p[iy] = bound * at.e[1];
    } else if (traction > bound) {
      p[ix] *= bound / traction;
      p[iy] *= bound / traction;
    }
    s[ix] = at.stick ? 0.0 : -slip * at.e[0];
    s[iy] = at.stick ? 0.0 : -slip * at.e[1];
    const bool yields = !at.stick && b.plastic > 0;
    const rp_element state = at.stick ? RP_STICK : yields ? RP_PLASTIC : RP_SLIP;
    out.state[at.k] = static_cast<unsigned char>(state);
    out.after[at.k] = b.state;
    if (out.plastic_slip) {
      out.plastic_slip[at.k] = b.plastic;
      out.yield_stress[at.k] = b.yield_stress;
    }
    out.friction[at.k] = b.friction;
    ++(at.stick ? sum.stick : yields ? t.sums.plastic : sum.slip);
    const double area = problem.area[at.k];
    slipped += bound * slip * area;
    plastic += bound * b.plastic / t.law.step * area;
    supplied -= (p[ix] * (problem.rigid_slip[ix] + problem.creepage(0)) +
                 p[iy] * (problem.rigid_slip[iy] + problem.creepage(1))) *
                area;
    if (!t.falls) return;
    const double stiffness = own_stiffness(t, at.row, at.k, at.e);
    t.sums.ambiguous +=
        t.law.ambiguous(t.friction[at.k], *at.before, at.e, bound + stiffness * at.m, stiffness);
  });
  // in steady rolling the rigid motion's supply is all dissipated (rolling_newton.hpp): in the
  // proportion of the two sums, which lose part of it on coarse grids
  const double spent = slipped + plastic;
  const double whole = t.carried() && spent > 0 ? std::max(0.0, supplied) / spent : 1.0;
  // where all sticks as friction's, like with Coulomb's law
  sum.friction = t.carried() && !(spent > 0) ? std::max(0.0, supplied) : whole * slipped;
  t.sums.plastic_work = whole * plastic;
}

}  // namespace railpatch
