#include "tangential/rolling_newton.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/sums.hpp"

namespace railpatch {

namespace {

constexpr int krylov_size = 40;
// of the linear systems; a step need not be better than the tolerance asks for
constexpr double inner_tolerance = 3e-2, worst_inner_tolerance = 0.3;
constexpr int max_inner_products = 200;
// Newton steps that need not lower the best |F| to `enough` of it before it is taken up again
constexpr int patience = 4;
constexpr double enough = 0.9;
constexpr int max_projections = 400;
// a start with more of zero traction's residual than this is tried against a new one
constexpr double far_away = 0.3;
// bound over |r s| up to which substitutions beat Newton steps
constexpr double fast_sliding = 0.1;

double square(double v) { return v * v; }

double norm(const double *v, size_t n) { return std::sqrt(dot(v, v, n)); }

}  // namespace

struct rolling_newton::task {
  rolling_operator &b;
  const rolling_problem &problem;
  force_constraint *force;  // null: none
  tangential_result result{};
  double flexibility[2] = {0, 0}, ramp_force = 0;

  size_t vector_size() const { return 2 * static_cast<size_t>(problem.count()); }
  // f(element, index of its x component, of its y component)
  template <class F>
  void for_each_element(F &&f) const {
    for_each_row_element(problem.rows, problem.row_start, f);
  }
};

void rolling_operator::micro_slip(const rolling_problem &problem, const double *p, double *s) {
  product(p, s);
  for (int i = 0; i < 2 * problem.count(); ++i) s[i] += problem.rigid_slip[i];
  if (!problem.force) return;
  for (int row = 0; row < problem.rows; ++row) {
    const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
    for (int k = 0; k < n; ++k) {
      s[2 * begin + k] += problem.creepage(0);
      s[2 * begin + n + k] += problem.creepage(1);
    }
  }
}

void rolling_operator::slip_of_creepage(const rolling_problem &problem, int component,
                                        double *s) const {
  for (int row = 0; row < problem.rows; ++row) {
    const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
    std::fill_n(s + 2 * begin, n, component == 0 ? 1.0 : 0.0);
    std::fill_n(s + 2 * begin + n, n, component == 1 ? 1.0 : 0.0);
  }
}

rolling_newton::rolling_newton(int max_row, int max_rows, bool forced)
    : blocks_(max_row, max_rows), linear_solver_(2 * max_row * max_rows + 2, krylov_size) {
  if (forced) force_.emplace(max_row * max_rows);
  const auto row = static_cast<size_t>(max_row), n = row * static_cast<size_t>(max_rows);
  r_ = aligned_buffer<double>(n);
  linear_ = aligned_buffer<element_linearisation>(n);
  stick_ = aligned_buffer<unsigned char>(n);
  for (auto *b :
       {&f_, &step_, &best_p_, &right_, &unknowns_, &normal_step_, &trial_p_, &trial_s_, &trial_f_})
    *b = aligned_buffer<double>(2 * n + 2);
  for (auto &m : row_matrix_) m = aligned_buffer<double>::uninitialized(row * row);
  row_slip_ = aligned_buffer<double>(2 * row);
}

size_t rolling_newton::bytes() const {
  return blocks_.bytes() + linear_solver_.bytes() + r_.bytes() + 9 * f_.bytes() +
         2 * row_matrix_[0].bytes() + row_slip_.bytes() + linear_.bytes() + stick_.bytes() +
         (force_ ? force_->bytes() : 0);
}

tangential_result rolling_newton::solve(rolling_operator &b, const rolling_problem &problem,
                                        const tangential_options &options) {
  task t{b, problem, problem.force ? &*force_ : nullptr};
  if (t.force) t.force->begin(problem, options.tolerance);
  tangential_result &result = t.result;
  double *p = problem.traction, *s = problem.micro_slip;
  for (int row = 0; row < problem.rows; ++row)
    std::fill(r_.data() + problem.row_start[row], r_.data() + problem.row_start[row + 1],
              b.projection_scale(row));
  const double size = scale(t);
  if (size > 0) {
    blocks_.start(problem.rows, problem.row_start);
    share_factors(t);
    const double goal = options.tolerance * size;
    double error = start(t, size), best = HUGE_VAL;
    if (!t.force) error = slide(t, error, goal);
    for (int strayed = 0; error > goal && result.newton_iterations < options.max_iterations &&
                          !(t.force && t.force->beyond());
         ++result.newton_iterations) {
      if (error <= enough * best) {
        best = error;
        strayed = 0;
        std::copy_n(p, t.vector_size(), best_p_.data());
        if (t.force) t.force->remember();
      } else if (!(t.force && t.force->travels()) && ++strayed > patience) {
        error = descend(t, enough * best);
        continue;
      }
      linearise(t);
      find_step(t, std::clamp(0.3 * goal / error, inner_tolerance, worst_inner_tolerance));
      error = line_search(t, error);
    }
    result.residual = error / size;
    result.converged = error <= options.tolerance * size;
    result.out_of_range = !result.converged && t.force && t.force->beyond();
  } else {
    // nothing drives a traction: no creepage, no friction or no contact
    std::fill_n(p, t.vector_size(), 0.0);
    std::copy_n(problem.rigid_slip, t.vector_size(), s);
    if (t.force) problem.force->creepage[0] = problem.force->creepage[1] = 0;
    result.residual = size;
    result.converged = size == 0;
  }
  finish(t);
  return result;
}

// Start of the iteration: the traction given, or where that says little the simplified theory's.
// Sets p, s and F and returns |F|.
double rolling_newton::start(task &t, double size) {
  double *p = t.problem.traction, *s = t.problem.micro_slip;
  if (t.force) {
    find_flexibility(t);
    t.force->set_units(t.problem, t.flexibility, t.ramp_force);
  }
  project(t, p);
  const bool cold = std::all_of(p, p + t.vector_size(), [](double v) { return v == 0; });
  double error = HUGE_VAL;
  if (!cold) {
    micro_slip(t, p, s);
    error = residual(t, p, s, f_.data());
    if (t.force && t.force->overshoots(t.problem, p, error / size))
      error = HUGE_VAL;
    else if (error <= far_away * size)
      return error;
  }
  march(t, trial_p_.data());
  micro_slip(t, trial_p_.data(), trial_s_.data());
  const double marched = residual(t, trial_p_.data(), trial_s_.data(), trial_f_.data());
  if (!(marched < error)) {
    // again, since the operator remembers the traction that it saw last
    if (t.force) t.force->go_back(t.problem);
    micro_slip(t, p, s);
    return residual(t, p, s, f_.data());
  }
  accept_trial(t);
  return marched;
}

// Substitutions p = -g s/|s| while every element slips fast enough for them to converge fast;
// returns |F|.
double rolling_newton::slide(task &t, double error, double goal) {
  double *p = t.problem.traction, *s = t.problem.micro_slip;
  while (error > goal) {
    bool fast = true;
    t.for_each_element([&](size_t k, size_t ix, size_t iy) {
      const double bound = t.problem.bound[k], slip = std::hypot(s[ix], s[iy]);
      fast = fast && bound <= fast_sliding * r_[k] * slip;
      const double factor = slip > 0 ? -bound / slip : 0.0;
      trial_p_[ix] = factor * s[ix];
      trial_p_[iy] = factor * s[iy];
    });
    if (!fast) return error;
    micro_slip(t, trial_p_.data(), trial_s_.data());
    const double slid = residual(t, trial_p_.data(), trial_s_.data(), trial_f_.data());
    if (!(slid < 0.5 * error)) {
      micro_slip(t, p, s);
      return residual(t, p, s, f_.data());
    }
    accept_trial(t);
    error = slid;
  }
  return error;
}

// Simplified theory (Kalker 1982): displacement = L p, so traction grows from the leading edge on
// with the rigid slip over L, up to the bound. Lx and Ly are those with which B gives the mean slip
// that it really gives to tractions growing evenly from the leading edge.
void rolling_newton::march(task &t, double *p) {
  if (t.force)
    t.force->guess(t.problem, t.flexibility);
  else
    find_flexibility(t);
  for (int row = 0; row < t.problem.rows; ++row) {
    const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
    double grown[2] = {0, 0};
    for (int k = 0; k < n; ++k) {
      const int at[2] = {2 * begin + k, 2 * begin + n + k};
      for (int c = 0; c < 2; ++c)
        grown[c] -= (t.problem.rigid_slip[at[c]] + t.problem.creepage(c)) *
                    t.problem.area[begin + k] / t.flexibility[c];
      const double size = std::hypot(grown[0], grown[1]), bound = t.problem.bound[begin + k];
      for (int c = 0; c < 2; ++c) {
        if (size > bound) grown[c] *= bound / size;
        p[at[c]] = grown[c];
      }
    }
  }
}

// Lx and Ly over the ramp of areas, and the ramp's force in one component.
void rolling_newton::find_flexibility(task &t) {
  // lengths of elements are only needed relative to each other; rows are equally wide, or nearly
  double *p = trial_p_.data();
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

// The residual of zero traction: the size against which others are measured.
double rolling_newton::scale(const task &t) const {
  const double *w = t.problem.rigid_slip;
  double sum = 0;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double f = std::min(t.problem.bound[k], r_[k] * std::hypot(w[ix], w[iy]));
    sum += f * f;
  });
  return t.force ? std::hypot(std::sqrt(sum), t.force->size()) : std::sqrt(sum);
}

void rolling_newton::micro_slip(task &t, const double *p, double *s) {
  t.b.micro_slip(t.problem, p, s);
  ++t.result.products;
}

double rolling_newton::residual(const task &t, const double *p, const double *s, double *f) const {
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double bound = t.problem.bound[k];
    const double qx = p[ix] - r_[k] * s[ix], qy = p[iy] - r_[k] * s[iy];
    const double q = std::hypot(qx, qy);
    const bool stick = q <= bound;
    f[ix] = stick ? r_[k] * s[ix] : p[ix] - bound * qx / q;
    f[iy] = stick ? r_[k] * s[iy] : p[iy] - bound * qy / q;
  });
  const double size = norm(f, t.vector_size());
  return t.force ? std::hypot(size, t.force->miss(t.problem, p)) : size;
}

void rolling_newton::project(const task &t, double *p) const {
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double bound = t.problem.bound[k], size = std::hypot(p[ix], p[iy]);
    if (size <= bound) return;
    p[ix] *= bound / size;
    p[iy] *= bound / size;
  });
}

// Rows of equal elements begin with the same matrices.
void rolling_newton::share_factors(task &t) {
  const int row = t.b.common_row(t.problem);
  if (row < 0) return;
  t.b.row_matrices(row, row_matrix_[0].data(), row_matrix_[1].data());
  blocks_.share(t.problem.row_start[row + 1] - t.problem.row_start[row], row_matrix_[0].data(),
                row_matrix_[1].data());
}

// Prepares dF at the present p and s and factors its row blocks.
void rolling_newton::linearise(task &t) {
  const double *p = t.problem.traction, *s = t.problem.micro_slip;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double bound = t.problem.bound[k], r = r_[k];
    const double qx = p[ix] - r * s[ix], qy = p[iy] - r * s[iy];
    const double q = std::hypot(qx, qy);
    if (q <= bound) {
      linear_[k] = {{1.0, 0.0}, 0.0, r, true};
    } else {
      const double theta = bound / q;
      linear_[k] = {{-qy / q, qx / q}, 1.0 - theta, r * theta, false};
    }
  });
  t.b.linearise();
  for (int row = 0; row < t.problem.rows; ++row) {
    const element_linearisation *elements = linear_.data() + t.problem.row_start[row];
    if (blocks_.serves(row, elements) || blocks_.set_row(row, elements)) continue;
    t.b.row_matrices(row, row_matrix_[0].data(), row_matrix_[1].data());
    blocks_.set_row(row, row_matrix_[0].data(), row_matrix_[1].data(), elements);
  }
}

// The vectors of the linear system hold z and z_y (numeric/row_blocks.hpp); f(element, index of z,
// index of z_y, indices of the element's components in vectors of traction). Returns the system's
// size.
template <class F>
size_t rolling_newton::for_each_unknown(const task &t, F &&f) const {
  return for_each_row_unknown(t.problem.rows, t.problem.row_start, linear_.data(), f);
}

// dp of the unknowns
void rolling_newton::expand(const task &t, const double *z, double *dp) const {
  for_each_unknown(t,
                   [&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
                     dp[ix] = e.c[0] * z[i];
                     dp[iy] = e.stick ? z[j] : e.c[1] * z[i];
                   });
}

void rolling_newton::apply_jacobian(task &t, const double *z, double *out) {
  expand(t, z, trial_p_.data());
  t.b.product_single(trial_p_.data(), trial_s_.data());
  ++t.result.products;
  const double *s = trial_s_.data();
  for_each_unknown(t,
                   [&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
                     out[i] = e.keep * z[i] + e.stiff * (e.c[0] * s[ix] + e.c[1] * s[iy]);
                     if (e.stick) out[j] = e.stiff * s[iy];
                   });
}

// Block Gauss-Seidel over the rows where their coupling comes at half the price of a product, else
// block Jacobi.
void rolling_newton::precondition(task &t, double *z) {
  double *dp = trial_p_.data(), *s = row_slip_.data();
  for (int row = 0; row < t.problem.rows; ++row) {
    const auto begin = static_cast<size_t>(t.problem.row_start[row]);
    const size_t n = static_cast<size_t>(t.problem.row_start[row + 1]) - begin;
    const element_linearisation *e = linear_.data() + begin;
    if (row > 0 && t.b.product_of_rows_before(row, dp, s))
      for (size_t k = 0, second = n; k < n; ++k) {
        z[k] -= e[k].stiff * (e[k].c[0] * s[k] + e[k].c[1] * s[n + k]);
        if (e[k].stick) z[second++] -= e[k].stiff * s[n + k];
      }
    blocks_.solve(row, z);
    for (size_t k = 0, second = n; k < n; ++k) {
      dp[2 * begin + k] = e[k].c[0] * z[k];
      dp[2 * begin + n + k] = e[k].stick ? z[second++] : e[k].c[1] * z[k];
    }
    z += blocks_.size(row);
  }
}

// The Newton step, to the inner tolerance.
void rolling_newton::find_step(task &t, double tolerance) {
  // in slip F = p - g n fixes the step along n: what it leaves of F is at once taken as the step
  // there, and its share of the other equations taken to the right side where it counts
  const double *f = f_.data();
  double along = 0, whole = 0;
  const size_t size = for_each_unknown(
      t, [&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
        if (e.stick) {
          right_[i] = -f[ix];
          right_[j] = -f[iy];
          normal_step_[ix] = normal_step_[iy] = 0;
        } else {
          const double fn = f[ix] * e.c[1] - f[iy] * e.c[0];
          right_[i] = -(f[ix] * e.c[0] + f[iy] * e.c[1]);
          normal_step_[ix] = -fn * e.c[1];
          normal_step_[iy] = fn * e.c[0];
          along += fn * fn;
        }
        whole += f[ix] * f[ix] + f[iy] * f[iy];
      });
  if (along > square(0.1 * tolerance) * whole) {
    t.b.product_single(normal_step_.data(), trial_s_.data());
    ++t.result.products;
    const double *s = trial_s_.data();
    for_each_unknown(t,
                     [&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
                       right_[i] -= e.stiff * (e.c[0] * s[ix] + e.c[1] * s[iy]);
                       if (e.stick) right_[j] -= e.stiff * s[iy];
                     });
  }
  if (t.force)
    solve_bordered(t, size, tolerance);
  else
    linear_solver_.solve(
        size, right_.data(), unknowns_.data(), tolerance, max_inner_products,
        [&](const double *v, double *out) { apply_jacobian(t, v, out); },
        [&](double *v) { precondition(t, v); });
  expand(t, unknowns_.data(), step_.data());
  for (size_t i = 0; i < t.vector_size(); ++i) step_[i] += normal_step_[i];
}

// The same with the creepages as further unknowns (force_constraint.hpp).
void rolling_newton::solve_bordered(task &t, size_t size, double tolerance) {
  force_constraint &force = *t.force;
  for (int m = 0; m < force.unknowns(); ++m) {
    const int component = force.component(m);
    t.b.slip_of_creepage(t.problem, component, trial_s_.data());
    const double *s = trial_s_.data();
    double *column = force.column(m), *row = force.row(m);
    double right = force.remainder(m, t.problem);
    for_each_unknown(t,
                     [&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
                       const double area = force.weight() * t.problem.area[&e - linear_.data()];
                       column[i] = e.stiff * (e.c[0] * s[ix] + e.c[1] * s[iy]);
                       row[i] = area * e.c[component];
                       if (e.stick) {
                         column[j] = e.stiff * s[iy];
                         row[j] = component == 1 ? area : 0.0;
                       }
                       right -= area * normal_step_[component == 0 ? ix : iy];
                     });
    right_[size + static_cast<size_t>(m)] = right;
  }
  force.solve(
      linear_solver_, size, right_.data(), unknowns_.data(), tolerance, max_inner_products,
      [&](const double *v, double *out) { apply_jacobian(t, v, out); },
      [&](double *v) { precondition(t, v); });
}

// One trial along the Newton step: p, s and F of the trial, and |F|.
double rolling_newton::try_step(task &t, double length) {
  const double *p = t.problem.traction;
  for (size_t i = 0; i < t.vector_size(); ++i) trial_p_[i] = p[i] + length * step_[i];
  if (t.force) t.force->move(t.problem, length);
  project(t, trial_p_.data());
  micro_slip(t, trial_p_.data(), trial_s_.data());
  return residual(t, trial_p_.data(), trial_s_.data(), trial_f_.data());
}

// Takes the longest of the halved Newton steps that lowers |F|; where none does, the whole step, so
// that the active sets move on (how often that may happen is bounded in solve). Updates p, s and F
// and returns |F|.
double rolling_newton::line_search(task &t, double current) {
  // where all slips, the length of a step back in creepage says nothing
  const int halvings = t.force ? 12 : 4;
  double length = 1.0, error = try_step(t, length);
  for (int trial = 0; trial < halvings && error > (1.0 - 1e-3 * length) * current; ++trial) {
    length *= 0.5;
    error = try_step(t, length);
  }
  if (error > (1.0 - 1e-3 * length) * current) error = try_step(t, 1.0);
  accept_trial(t);
  return error;
}

// Projected steps from the best traction so far until |F| is down at `goal`; returns |F|. Why this
// ends: see rolling_newton.hpp.
double rolling_newton::descend(task &t, double goal) {
  double *p = t.problem.traction, *s = t.problem.micro_slip;
  std::copy_n(best_p_.data(), t.vector_size(), p);
  if (t.force) t.force->recall(t.problem);
  micro_slip(t, p, s);
  double error = residual(t, p, s, f_.data());
  double length = 1;
  for (int k = 0; k < max_projections && error > goal; ++k) {
    // the slip must not turn more over a step than the step is long
    for (bool short_enough = false; !short_enough; length *= short_enough ? 1.0 : 0.5) {
      projected_step(t, s, length, trial_p_.data());
      double moved = 0, turned = 0;
      if (t.force) t.force->pull(t.problem, p, trial_p_.data(), length, &moved, &turned);
      micro_slip(t, trial_p_.data(), trial_s_.data());
      t.for_each_element([&](size_t e, size_t ix, size_t iy) {
        const double weight = t.problem.area[e] / r_[e];
        moved += weight * (square(trial_p_[ix] - p[ix]) + square(trial_p_[iy] - p[iy]));
        turned += weight * square(r_[e] * length) *
                  (square(trial_s_[ix] - s[ix]) + square(trial_s_[iy] - s[iy]));
      });
      short_enough = turned <= 0.5 * moved || !(moved > 0);
    }
    projected_step(t, trial_s_.data(), length, p);
    if (t.force) t.force->pull_again(t.problem, trial_p_.data(), length);
    micro_slip(t, p, s);
    error = residual(t, p, s, f_.data());
    length = std::min(1.0, 1.5 * length);
  }
  // where the goal is not met, the next iteration goes on from here
  std::copy_n(p, t.vector_size(), best_p_.data());
  if (t.force) t.force->remember();
  return error;
}

// out = projection of p - length r s
void rolling_newton::projected_step(const task &t, const double *s, double length,
                                    double *out) const {
  const double *p = t.problem.traction;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    out[ix] = p[ix] - length * r_[k] * s[ix];
    out[iy] = p[iy] - length * r_[k] * s[iy];
  });
  project(t, out);
}

void rolling_newton::accept_trial(task &t) {
  std::copy_n(trial_p_.data(), t.vector_size(), t.problem.traction);
  std::copy_n(trial_s_.data(), t.vector_size(), t.problem.micro_slip);
  std::copy_n(trial_f_.data(), t.vector_size(), f_.data());
  if (t.force) t.force->keep(t.problem);
}

// Divides the elements into stick and slip and sums the friction.
void rolling_newton::finish(task &t) {
  const rolling_problem &problem = t.problem;
  const double *p = problem.traction, *w = problem.rigid_slip;
  double *s = problem.micro_slip;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const bool stick = std::hypot(p[ix] - r_[k] * s[ix], p[iy] - r_[k] * s[iy]) <= problem.bound[k];
    // in stick the micro-slip is the solver's residual: zero by definition
    if (stick) s[ix] = s[iy] = 0.0;
    stick_[k] = stick;
    ++(stick ? t.result.stick : t.result.slip);
    t.result.friction -=
        (p[ix] * (w[ix] + problem.creepage(0)) + p[iy] * (w[iy] + problem.creepage(1))) *
        problem.area[k];
  });
}

}  // namespace railpatch
