// The linear systems of Newton's steps (inelastic_newton.hpp): derivative of the law, row blocks as
// preconditioner, creepages of a prescribed force as further unknowns.
#include <algorithm>
#include <cmath>

#include "tangential/inelastic_task.hpp"

namespace railpatch {

namespace {

// factors serve as long as the laws' derivatives have changed less
constexpr double greatest_change = 0.1;

}  // namespace

void inelastic_newton::linearise(task &t) {
  apply_law(t, t.problem.traction, t.problem.micro_slip, 1.0, [&](const inelastic_element &at) {
    linearisation &l = linear_[at.k];
    l = {};
    if (at.stick) {
      l.m[0][0] = l.m[1][1] = 1.0;
      if (t.carried())
        for (int i = 0; i < 3; ++i) std::copy_n(at.point.state_by_state[i], 3, l.a[i]);
      return;
    }
    const bound_point b =
        t.carried() ? at.point : t.law.evaluate(t.friction[at.k], *at.before, at.e, at.m);
    const double *e = at.e, across[2] = {-e[1], e[0]};
    // dm = (g . dq - b_U dU)/sum
    const double sum = at.stiffness + b.by_slip, share = at.stiffness / sum;
    const double theta = at.bound() / at.size;
    double g[2];
    for (int c = 0; c < 2; ++c) g[c] = e[c] - b.by_angle / at.size * across[c];
    for (int c = 0; c < 2; ++c)
      for (int d = 0; d < 2; ++d)
        l.m[c][d] = e[c] * (e[d] - share * g[d]) + theta * across[c] * across[d];
    if (!t.carried()) return;
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < 2; ++c) {
        l.h[c][i] = e[c] * share * b.by_state[i];
        l.e[i][c] = b.state_by_slip[i] / sum * g[c] + b.state_by_angle[i] / at.size * across[c];
      }
      for (int j = 0; j < 3; ++j)
        l.a[i][j] = b.state_by_state[i][j] - b.state_by_slip[i] * b.by_state[j] / sum;
    }
  });
  t.b.linearise();
  for (int row = 0; row < t.problem.rows; ++row) fill_block(t, row);
}

// out = dP of a row where its tractions change by dp and its micro-slip by ds, both x and then y
void inelastic_newton::derivative(const task &t, int row, const double *dp, const double *ds,
                                  double *out) const {
  const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
  const linearisation *l = linear_.data() + begin;
  const double *r = r_.data() + begin;
  if (!t.carried()) {
    for (int k = 0; k < n; ++k) {
      const double qx = dp[k] - r[k] * ds[k], qy = dp[n + k] - r[k] * ds[n + k];
      out[k] = l[k].m[0][0] * qx + l[k].m[0][1] * qy;
      out[n + k] = l[k].m[1][0] * qx + l[k].m[1][1] * qy;
    }
    return;
  }
  double u[3] = {0, 0, 0};
  for (int k = 0; k < n; ++k) {
    const linearisation &at = l[k];
    const double q[2] = {dp[k] - r[k] * ds[k], dp[n + k] - r[k] * ds[n + k]};
    for (int c = 0; c < 2; ++c)
      out[c * n + k] = at.m[c][0] * q[0] + at.m[c][1] * q[1] +
                       (at.h[c][0] * u[0] + at.h[c][1] * u[1] + at.h[c][2] * u[2]);
    double next[3];
    for (int i = 0; i < 3; ++i)
      next[i] = at.e[i][0] * q[0] + at.e[i][1] * q[1] +
                (at.a[i][0] * u[0] + at.a[i][1] * u[1] + at.a[i][2] * u[2]);
    std::copy_n(next, 3, u);
  }
}

void inelastic_newton::fill_block(const task &t, int row) {
  const int begin = t.problem.row_start[row], n = t.problem.row_start[row + 1] - begin;
  const auto first = static_cast<size_t>(begin), count = static_cast<size_t>(n);
  const linearisation *now = linear_.data() + first;
  linearisation *before = factored_.data() + first;
  unsigned char &has_factors = has_factors_[static_cast<size_t>(row)];
  const auto near = [](const linearisation &a, const linearisation &b) {
    double change = 0;
    for (int c = 0; c < 2; ++c)
      for (int d = 0; d < 2; ++d) change = std::max(change, std::abs(a.m[c][d] - b.m[c][d]));
    return change <= greatest_change;
  };
  if (has_factors && std::equal(now, now + count, before, near)) return;
  t.ask.check();
  has_factors = 1;
  std::copy_n(now, count, before);
  t.b.row_matrices(row, row_matrix_[0].data(), row_matrix_[1].data());
  float *matrix = blocks_.matrix(row);
  // a unit traction in one component of one element
  double *dp = trial_p_.data(), *ds = trial_s_.data(), *out = trial_f_.data();
  std::fill_n(dp, 2 * count, 0.0);
  for (int component = 0; component < 2; ++component)
    for (int source = 0; source < n; ++source) {
      const int column = component * n + source;
      std::fill_n(ds, 2 * count, 0.0);
      std::copy_n(row_matrix_[component].data() + source * n, n, ds + component * n);
      dp[column] = 1.0;
      derivative(t, row, dp, ds, out);
      out[column] -= 1.0;
      dp[column] = 0.0;
      for (int i = 0; i < 2 * n; ++i) matrix[column * 2 * n + i] = static_cast<float>(-out[i]);
    }
  blocks_.factor(row, n);
}

void inelastic_newton::apply_jacobian(task &t, const double *v, double *out) {
  t.b.product_single(v, trial_s_.data());
  ++t.result.products;
  for (int row = 0; row < t.problem.rows; ++row) {
    const int at = 2 * t.problem.row_start[row], n = 2 * t.problem.row_start[row + 1] - at;
    derivative(t, row, v + at, trial_s_.data() + at, out + at);
    for (int i = at; i < at + n; ++i) out[i] = v[i] - out[i];
  }
}

void inelastic_newton::precondition(const task &t, double *v) {
  for (int row = 0; row < t.problem.rows; ++row) {
    const int begin = t.problem.row_start[row];
    blocks_.solve(row, t.problem.row_start[row + 1] - begin, v + 2 * begin);
  }
}

void inelastic_newton::find_step(task &t, double tolerance) {
  for (size_t i = 0; i < t.size(); ++i) right_[i] = -f_[i];
  solve_linear(t, t.size(), tolerance);
  std::copy_n(unknowns_.data(), t.size(), step_.data());
}

void inelastic_newton::border(const task &t, int component, const double *s, double *column,
                              double *row, double &) {
  std::fill_n(trial_p_.data(), t.size(), 0.0);
  for (int r = 0; r < t.problem.rows; ++r) {
    const int at = 2 * t.problem.row_start[r];
    derivative(t, r, trial_p_.data() + at, s + at, column + at);
  }
  for (size_t i = 0; i < t.size(); ++i) column[i] = -column[i];
  std::fill_n(row, t.size(), 0.0);
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    row[component == 0 ? ix : iy] = t.force->weight() * t.problem.area[k];
  });
}

}  // namespace railpatch
