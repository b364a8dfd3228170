// What the Newton methods of the tangential problem share whatever the law of friction is
// (rolling_newton.hpp, inelastic_newton.hpp): memory, size of the residual, the simplified theory's
// start, linear systems with creepages as further unknowns, line search, extragradient steps.
//
// A method inherits from row_newton<itself, its task> and gives three functions of its law,
//   residual(t, p, s, f)               F of all elements,
//   resolvent(t, p, s, length, out)    P(p - length r s); out may be p,
//   start_bound(t, element)            how far fresh material lets the traction go,
// and of the law's derivative what stands in the linear systems,
//   apply_jacobian(t, v, out)          out = dF v, of the system's unknowns,
//   precondition(t, v)                 v <- M^-1 v,
//   border(t, component, s, column, row, right)
// which fills a creepage's column from s = ds/dxi and its row, and takes from the right side what
// is known of the step already. All is bound at compile time.
//
// Line search. The longest of some halved steps that lowers |F| is taken; where none does, the
// whole step, so that the active sets move on (how often that may happen is for the method to
// bound). An |F| that is no number, as a linear system that broke down leaves it, lowers nothing:
// such a step is halved too and in the end not taken, and the traction is left to the method's
// safeguard, which solves no linear systems.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "numeric/elementary.hpp"
#include "numeric/gmres.hpp"
#include "numeric/sums.hpp"
#include "tangential/rolling_operator.hpp"

namespace railpatch {

// One solve's problem and operator, so that the steps need not pass them on.
struct row_task {
  rolling_operator &b;
  rolling_problem problem;  // bound: the greatest that the law gives
  force_constraint *force;  // null: none
  tangential_result result{};
  double flexibility[2] = {0, 0}, ramp_force = 0;
  interrupt ask{};

  // of vectors
  size_t size() const { return 2 * static_cast<size_t>(problem.count()); }
  // f(element, index of its x component, of its y component)
  template <class F>
  void for_each_element(F &&f) const {
    for_each_row_element(problem.rows, problem.row_start, f);
  }
};

template <class Law, class Task>
class row_newton {
 protected:
  // Newton steps that need not lower the best |F| to `enough` of it before it is taken up again
  static constexpr int patience = 4;
  static constexpr double enough = 0.9;
  // a start with more of zero traction's residual than this is tried against a new one
  static constexpr double far_away = 0.3;

  row_newton(int max_row, int max_rows, bool forced)
      : linear_solver_(2 * max_row * max_rows + 2, krylov_size) {
    const auto row = static_cast<size_t>(max_row), n = row * static_cast<size_t>(max_rows);
    if (forced) force_.emplace(max_row * max_rows);
    r_ = aligned_buffer<double>(n);
    for (auto *b : {&f_, &step_, &best_p_, &right_, &unknowns_, &trial_p_, &trial_s_, &trial_f_})
      *b = aligned_buffer<double>(2 * n + 2);
    for (auto &m : row_matrix_) m = aligned_buffer<double>::uninitialized(row * row);
  }
  size_t bytes() const {
    return linear_solver_.bytes() + r_.bytes() + 8 * f_.bytes() + 2 * row_matrix_[0].bytes() +
           (force_ ? force_->bytes() : 0);
  }

  // The residual of zero traction: the size against which others are measured.
  double scale(const Task &t) const;
  // |F|, with what is missing of the force
  double measure(const Task &t, const double *p, const double *s, double *f) const;
  // Sets slip and F of the present traction, or of the trial, and returns |F|.
  double evaluate(Task &t) {
    micro_slip(t, t.problem.traction, t.problem.micro_slip);
    return measure(t, t.problem.traction, t.problem.micro_slip, f_.data());
  }
  void evaluate_slip(Task &t) { micro_slip(t, t.problem.traction, t.problem.micro_slip); }
  double evaluate_trial(Task &t) {
    micro_slip(t, trial_p_.data(), trial_s_.data());
    return measure(t, trial_p_.data(), trial_s_.data(), trial_f_.data());
  }
  void take_trial(Task &t);
  // From a trial to the present traction; again, since the operator remembers what it saw last.
  double go_back(Task &t) {
    if (t.force) t.force->go_back(t.problem);
    return evaluate(t);
  }
  // The best traction so far.
  void remember(Task &t) {
    std::copy_n(t.problem.traction, t.size(), best_p_.data());
    if (t.force) t.force->remember();
  }
  double recall(Task &t) {
    std::copy_n(best_p_.data(), t.size(), t.problem.traction);
    if (t.force) t.force->recall(t.problem);
    return evaluate(t);
  }
  bool is_zero(const Task &t) const {
    const double *p = t.problem.traction;
    return std::all_of(p, p + t.size(), [](double v) { return v == 0; });
  }
  // On |p| <= bound.
  void project(const Task &t, double *p) const;

  // What a start needs: the force's units, and tractions within their bounds.
  void prepare_start(Task &t);
  void march(Task &t);
  double line_search(Task &t, double current);
  // The linear system of a step over n unknowns of the elements, and the creepages if they are.
  void solve_linear(Task &t, size_t n, double tolerance);
  void extragradient(Task &t, double &length);

  // Results of a solve that ended, and of one that nothing drives: no creepage, no friction or no
  // contact.
  void conclude(Task &t, double error, double size, double tolerance) const;
  void leave_unloaded(Task &t, double size) const;

  aligned_buffer<double> r_;  // per element
  aligned_buffer<double> f_, step_, best_p_, right_, unknowns_, trial_p_, trial_s_, trial_f_;
  aligned_buffer<double> row_matrix_[2];
  std::optional<force_constraint> force_;

 private:
  static constexpr int krylov_size = 40, max_inner_products = 200;

  Law &law() { return static_cast<Law &>(*this); }
  const Law &law() const { return static_cast<const Law &>(*this); }
  void micro_slip(Task &t, const double *p, double *s) const {
    t.b.micro_slip(t.problem, p, s);
    ++t.result.products;
  }
  void find_flexibility(Task &t);
  double try_step(Task &t, double length);
  void set_borders(Task &t, size_t n);

  gmres linear_solver_;
};

template <class Law, class Task>
double row_newton<Law, Task>::scale(const Task &t) const {
  const double *w = t.problem.rigid_slip;
  double sum = 0;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double f = std::min(t.problem.bound[k], r_[k] * hypot(w[ix], w[iy]));
    sum += f * f;
  });
  return t.force ? hypot(std::sqrt(sum), t.force->size()) : std::sqrt(sum);
}

template <class Law, class Task>
double row_newton<Law, Task>::measure(const Task &t, const double *p, const double *s,
                                      double *f) const {
  law().residual(t, p, s, f);
  const double size = std::sqrt(dot(f, f, t.size()));
  return t.force ? hypot(size, t.force->miss(t.problem, p)) : size;
}

template <class Law, class Task>
void row_newton<Law, Task>::take_trial(Task &t) {
  std::copy_n(trial_p_.data(), t.size(), t.problem.traction);
  std::copy_n(trial_s_.data(), t.size(), t.problem.micro_slip);
  std::copy_n(trial_f_.data(), t.size(), f_.data());
  if (t.force) t.force->keep(t.problem);
}

template <class Law, class Task>
void row_newton<Law, Task>::project(const Task &t, double *p) const {
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double bound = t.problem.bound[k], size = hypot(p[ix], p[iy]);
    if (size <= bound) return;
    p[ix] *= bound / size;
    p[iy] *= bound / size;
  });
}

template <class Law, class Task>
void row_newton<Law, Task>::prepare_start(Task &t) {
  if (t.force) {
    find_flexibility(t);
    t.force->set_units(t.problem, t.flexibility, t.ramp_force);
  }
  project(t, t.problem.traction);
}

// Simplified theory (Kalker 1982), as a trial: displacement = L p, so traction grows from the
// leading edge on with the rigid slip over L, up to the bound. Lx and Ly are those with which B
// gives the mean slip that it really gives to tractions growing evenly from the leading edge.
template <class Law, class Task>
void row_newton<Law, Task>::march(Task &t) {
  if (t.force)
    t.force->guess(t.problem, t.flexibility);
  else
    find_flexibility(t);
  double *p = trial_p_.data();
  for (int row = 0; row < t.problem.rows; ++row) {
    const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
    double grown[2] = {0, 0};
    for (int k = 0; k < n; ++k) {
      const int at[2] = {2 * begin + k, 2 * begin + n + k};
      for (int c = 0; c < 2; ++c)
        grown[c] -= (t.problem.rigid_slip[at[c]] + t.problem.creepage(c)) *
                    t.problem.area[begin + k] / t.flexibility[c];
      const double size = hypot(grown[0], grown[1]);
      const double bound = law().start_bound(t, static_cast<size_t>(begin + k));
      for (int c = 0; c < 2; ++c) {
        if (size > bound) grown[c] *= bound / size;
        p[at[c]] = grown[c];
      }
    }
  }
}

// Lx and Ly over the ramp of areas, and the ramp's force in one component.
template <class Law, class Task>
void row_newton<Law, Task>::find_flexibility(Task &t) {
  // lengths of elements are only needed relative to each other; rows are equally wide, or nearly
  double *p = trial_p_.data();
  t.ramp_force = 0;
  for (int row = 0; row < t.problem.rows; ++row) {
    const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
    double ramp = 0;
    for (int k = 0; k < n; ++k) {
      ramp += t.problem.area[begin + k];
      p[2 * begin + k] = p[2 * begin + n + k] = ramp;
      t.ramp_force += ramp * t.problem.area[begin + k];
    }
  }
  t.b.product_single(p, trial_s_.data());
  ++t.result.products;
  t.for_each_element([&](size_t, size_t ix, size_t iy) {
    t.flexibility[0] += trial_s_[ix] / t.problem.count();
    t.flexibility[1] += trial_s_[iy] / t.problem.count();
  });
}

// One trial along the Newton step: p, s and F of the trial, and |F|.
template <class Law, class Task>
double row_newton<Law, Task>::try_step(Task &t, double length) {
  const double *p = t.problem.traction;
  for (size_t i = 0; i < t.size(); ++i) trial_p_[i] = p[i] + length * step_[i];
  if (t.force) t.force->move(t.problem, length);
  project(t, trial_p_.data());
  return evaluate_trial(t);
}

// Updates p, s and F and returns |F|.
template <class Law, class Task>
double row_newton<Law, Task>::line_search(Task &t, double current) {
  // where all slips, the length of a step back in creepage says nothing
  const int halvings = t.force ? 12 : 4;
  double length = 1.0, error = try_step(t, length);
  const auto lowers = [&] { return error <= (1.0 - 1e-3 * length) * current; };
  for (int trial = 0; trial < halvings && !lowers(); ++trial) {
    length *= 0.5;
    error = try_step(t, length);
  }
  if (!lowers()) error = try_step(t, 1.0);
  if (std::isnan(error)) return go_back(t);
  take_trial(t);
  return error;
}

template <class Law, class Task>
void row_newton<Law, Task>::solve_linear(Task &t, size_t n, double tolerance) {
  const auto apply = [&](const double *v, double *out) {
    t.ask.check();
    law().apply_jacobian(t, v, out);
  };
  const auto precondition = [&](double *v) { law().precondition(t, v); };
  double *right = right_.data(), *z = unknowns_.data();
  if (!t.force) {
    linear_solver_.solve(n, right, z, tolerance, max_inner_products, apply, precondition);
    return;
  }
  set_borders(t, n);
  t.force->solve(linear_solver_, n, right, z, tolerance, max_inner_products, apply, precondition);
}

// The creepages' columns, rows and right sides (force_constraint.hpp).
template <class Law, class Task>
void row_newton<Law, Task>::set_borders(Task &t, size_t n) {
  force_constraint &force = *t.force;
  for (int m = 0; m < force.unknowns(); ++m) {
    const int component = force.component(m);
    t.b.slip_of_creepage(t.problem, component, trial_s_.data());
    double right = force.remainder(m, t.problem);
    law().border(t, component, trial_s_.data(), force.column(m), force.row(m), right);
    right_[n + static_cast<size_t>(m)] = right;
  }
}

// One extragradient step with the law's resolvent as projection, at most of the length, which it
// adapts; sets p.
template <class Law, class Task>
void row_newton<Law, Task>::extragradient(Task &t, double &length) {
  const auto square = [](double v) { return v * v; };
  double *p = t.problem.traction, *s = t.problem.micro_slip;
  // the slip must not turn more over a step than the step is long
  for (bool short_enough = false; !short_enough; length *= short_enough ? 1.0 : 0.5) {
    law().resolvent(t, p, s, length, trial_p_.data());
    double moved = 0, turned = 0;
    if (t.force) t.force->pull(t.problem, p, trial_p_.data(), length, &moved, &turned);
    micro_slip(t, trial_p_.data(), trial_s_.data());
    t.for_each_element([&](size_t e, size_t ix, size_t iy) {
      const double weight = t.problem.area[e] / r_[e];
      moved += weight * (square(trial_p_[ix] - p[ix]) + square(trial_p_[iy] - p[iy]));
      turned += weight * square(r_[e] * length) *
                (square(trial_s_[ix] - s[ix]) + square(trial_s_[iy] - s[iy]));
    });
    short_enough = turned <= 0.5 * moved || !(moved > 0) || length < Law::shortest_step;
  }
  // from p, and not the trial, with the slip at the trial
  law().resolvent(t, p, trial_s_.data(), length, p);
  if (t.force) t.force->pull_again(t.problem, trial_p_.data(), length);
  length = std::min(1.0, 1.5 * length);
}

template <class Law, class Task>
void row_newton<Law, Task>::conclude(Task &t, double error, double size, double tolerance) const {
  t.result.residual = error / size;
  t.result.converged = error <= tolerance * size;
  t.result.out_of_range = !t.result.converged && t.force && t.force->beyond();
}

template <class Law, class Task>
void row_newton<Law, Task>::leave_unloaded(Task &t, double size) const {
  std::fill_n(t.problem.traction, t.size(), 0.0);
  std::copy_n(t.problem.rigid_slip, t.size(), t.problem.micro_slip);
  if (t.force) t.problem.force->creepage[0] = t.problem.force->creepage[1] = 0;
  t.result.residual = size;
  t.result.converged = size == 0;
}

}  // namespace railpatch
