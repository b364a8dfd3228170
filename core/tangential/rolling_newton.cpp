#include "tangential/rolling_newton.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// of the linear systems; a step need not be better than the tolerance asks for
constexpr double inner_tolerance = 3e-2, worst_inner_tolerance = 0.3;
constexpr int max_projections = 400;
// bound over |r s| up to which substitutions beat Newton steps
constexpr double fast_sliding = 0.1;

double square(double v) { return v * v; }

}  // namespace

rolling_newton::rolling_newton(int max_row, int max_rows, bool forced)
    : row_newton(max_row, max_rows, forced), blocks_(max_row, max_rows) {
  const auto row = static_cast<size_t>(max_row), n = row * static_cast<size_t>(max_rows);
  linear_ = aligned_buffer<element_linearisation>(n);
  stick_ = aligned_buffer<unsigned char>(n);
  normal_step_ = aligned_buffer<double>(2 * n + 2);
  row_slip_ = aligned_buffer<double>(2 * row);
}

size_t rolling_newton::bytes() const {
  return row_newton::bytes() + blocks_.bytes() + normal_step_.bytes() + row_slip_.bytes() +
         linear_.bytes() + stick_.bytes();
}

tangential_result rolling_newton::solve(rolling_operator &b, const rolling_problem &problem,
                                        const tangential_options &options) {
  task t{b, problem, problem.force ? &*force_ : nullptr};
  t.ask = options.ask;
  if (t.force) t.force->begin(problem, options.tolerance);
  for (int row = 0; row < problem.rows; ++row)
    std::fill(r_.data() + problem.row_start[row], r_.data() + problem.row_start[row + 1],
              b.projection_scale(row));
  const double size = scale(t);
  if (size > 0) {
    blocks_.start(problem.rows, problem.row_start);
    share_factors(t);
    iterate(t, start(t, size), size, options);
  } else {
    leave_unloaded(t, size);
  }
  finish(t);
  return t.result;
}

// Newton's steps and their safeguard.
void rolling_newton::iterate(task &t, double error, double size,
                             const tangential_options &options) {
  const double goal = options.tolerance * size;
  double best = HUGE_VAL;
  if (!t.force) error = slide(t, error, goal);
  for (int strayed = 0; error > goal && t.result.newton_iterations < options.max_iterations &&
                        !(t.force && t.force->beyond());
       ++t.result.newton_iterations) {
    if (error <= enough * best) {
      best = error;
      strayed = 0;
      remember(t);
    } else if (!(t.force && t.force->travels()) && ++strayed > patience) {
      error = descend(t, enough * best);
      continue;
    }
    linearise(t);
    find_step(t, std::clamp(0.3 * goal / error, inner_tolerance, worst_inner_tolerance));
    error = line_search(t, error);
  }
  conclude(t, error, size, options.tolerance);
}

// Start of the iteration: the traction given, or where that says little the simplified theory's.
// Sets p, s and F and returns |F|.
double rolling_newton::start(task &t, double size) {
  double *p = t.problem.traction;
  prepare_start(t);
  double error = HUGE_VAL;
  if (!is_zero(t)) {
    error = evaluate(t);
    if (t.force && t.force->overshoots(t.problem, p, error / size))
      error = HUGE_VAL;
    else if (error <= far_away * size)
      return error;
  }
  march(t);
  const double marched = evaluate_trial(t);
  if (!(marched < error)) return go_back(t);
  take_trial(t);
  return marched;
}

// Substitutions p = -g s/|s| while every element slips fast enough for them to converge fast;
// returns |F|.
double rolling_newton::slide(task &t, double error, double goal) {
  const double *s = t.problem.micro_slip;
  while (error > goal) {
    bool fast = true;
    t.for_each_element([&](size_t k, size_t ix, size_t iy) {
      const double bound = t.problem.bound[k], slip = hypot(s[ix], s[iy]);
      fast = fast && bound <= fast_sliding * r_[k] * slip;
      const double factor = slip > 0 ? -bound / slip : 0.0;
      trial_p_[ix] = factor * s[ix];
      trial_p_[iy] = factor * s[iy];
    });
    if (!fast) return error;
    const double slid = evaluate_trial(t);
    if (!(slid < 0.5 * error)) return evaluate(t);
    take_trial(t);
    error = slid;
  }
  return error;
}

void rolling_newton::residual(const task &t, const double *p, const double *s, double *f) const {
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const double bound = t.problem.bound[k];
    const double qx = p[ix] - r_[k] * s[ix], qy = p[iy] - r_[k] * s[iy];
    const double q = hypot(qx, qy);
    const bool stick = q <= bound;
    f[ix] = stick ? r_[k] * s[ix] : p[ix] - bound * qx / q;
    f[iy] = stick ? r_[k] * s[iy] : p[iy] - bound * qy / q;
  });
}

void rolling_newton::resolvent(const task &t, const double *p, const double *s, double length,
                               double *out) const {
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    out[ix] = p[ix] - length * r_[k] * s[ix];
    out[iy] = p[iy] - length * r_[k] * s[iy];
  });
  project(t, out);
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
    const double q = hypot(qx, qy);
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
    if (blocks_.serves(row, elements)) continue;
    t.ask.check();
    if (blocks_.set_row(row, elements)) continue;
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
  solve_linear(t, size, tolerance);
  expand(t, unknowns_.data(), step_.data());
  for (size_t i = 0; i < t.size(); ++i) step_[i] += normal_step_[i];
}

void rolling_newton::border(const task &t, int component, const double *s, double *column,
                            double *row, double &right) {
  for_each_unknown(t,
                   [&](const element_linearisation &e, size_t i, size_t j, size_t ix, size_t iy) {
                     const double area = t.force->weight() * t.problem.area[&e - linear_.data()];
                     column[i] = e.stiff * (e.c[0] * s[ix] + e.c[1] * s[iy]);
                     row[i] = area * e.c[component];
                     if (e.stick) {
                       column[j] = e.stiff * s[iy];
                       row[j] = component == 1 ? area : 0.0;
                     }
                     right -= area * normal_step_[component == 0 ? ix : iy];
                   });
}

// Projected steps from the best traction so far until |F| is down at `goal`; returns |F|. Why this
// ends: see rolling_newton.hpp.
double rolling_newton::descend(task &t, double goal) {
  double error = recall(t), length = 1;
  for (int k = 0; k < max_projections && error > goal; ++k) {
    extragradient(t, length);
    error = evaluate(t);
  }
  // where the goal is not met, the next iteration goes on from here
  remember(t);
  return error;
}

// Divides the elements into stick and slip and sums the friction.
void rolling_newton::finish(task &t) {
  const rolling_problem &problem = t.problem;
  const double *p = problem.traction, *w = problem.rigid_slip;
  double *s = problem.micro_slip;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    const bool stick = hypot(p[ix] - r_[k] * s[ix], p[iy] - r_[k] * s[iy]) <= problem.bound[k];
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
