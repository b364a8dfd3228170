#include "tangential/force_constraint.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/sums.hpp"
#include "tangential/rolling_operator.hpp"

namespace railpatch {

namespace {

constexpr double least_slope = 1e-6;    // delta over the creep curve's initial slope
constexpr double most_creepage = 1e3;   // in units
constexpr double nearly_sliding = 0.9;  // share of friction that the first guess aims at
constexpr int guesses = 12;
// a start is on the flat of the creep curve: creepage in units, force over friction's most
constexpr double flat_from = 3.0, noticeable = 1e-4, far_from_solution = 0.02;

// Creep force of the simplified theory and its derivative: row_newton::march with
// derivatives, and without keeping the traction.
struct simplified_force {
  double force[2] = {0, 0}, slope[2][2] = {};

  simplified_force(const rolling_problem &problem, const double flexibility[2]) {
    for (int row = 0; row < problem.rows; ++row) {
      const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
      double p[2] = {0, 0}, dp[2][2] = {};
      for (int k = 0; k < n; ++k) {
        const double area = problem.area[begin + k], bound = problem.bound[begin + k];
        for (int c = 0; c < 2; ++c) {
          const double w = problem.rigid_slip[2 * begin + c * n + k] + problem.creepage(c);
          p[c] -= w * area / flexibility[c];
          dp[c][c] -= area / flexibility[c];
        }
        if (const double size = hypot(p[0], p[1]); size > bound) slide(bound, size, p, dp);
        for (int c = 0; c < 2; ++c) {
          force[c] += area * p[c];
          for (int d = 0; d < 2; ++d) slope[c][d] += area * dp[c][d];
        }
      }
    }
  }

 private:
  static void slide(double bound, double size, double p[2], double dp[2][2]) {
    const double n[2] = {p[0] / size, p[1] / size}, ratio = bound / size;
    for (int d = 0; d < 2; ++d) {
      const double along = n[0] * dp[0][d] + n[1] * dp[1][d];
      for (int c = 0; c < 2; ++c) dp[c][d] = ratio * (dp[c][d] - n[c] * along);
    }
    for (int c = 0; c < 2; ++c) p[c] *= ratio;
  }
};

}  // namespace

force_constraint::force_constraint(int max_elements) {
  const auto n = 2 * static_cast<size_t>(max_elements);
  for (int m = 0; m < 2; ++m)
    for (auto *b : {&column_[m], &reduced_[m], &row_[m]}) *b = aligned_buffer<double>(n);
}

void force_constraint::begin(const rolling_problem &problem, double tolerance) {
  const prescribed_force &force = *problem.force;
  unknowns_ = 0;
  target_size_ = 0;
  shortened_ = false;
  travelled_ = 0;
  for (int c = 0; c < 2; ++c)
    if (force.component[c]) {
      target_size_ = hypot(target_size_, force.force[c]);
      target_[unknowns_] = force.force[c];
      component_[unknowns_++] = c;
    }
  double squares = 0;
  capacity_ = 0;
  for (int k = 0; k < problem.count(); ++k) {
    capacity_ += problem.area[k] * problem.bound[k];
    squares += problem.bound[k] * problem.bound[k];
  }
  weight_ = capacity_ > 0 ? std::sqrt(squares) / capacity_ : 1.0;
  beyond_ = !(target_size_ <= (1.0 + tolerance) * capacity_);
  keep(problem);
}

// R p of one unknown's component, N
double force_constraint::carried(int m, const rolling_problem &problem, const double *p) const {
  double sum = 0;
  for (int row = 0; row < problem.rows; ++row) {
    const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
    sum += dot(problem.area + begin, p + 2 * begin + component_[m] * n, static_cast<size_t>(n));
  }
  return sum;
}

double force_constraint::remainder(int m, const rolling_problem &problem) const {
  return weight_ * (target_[m] - carried(m, problem, problem.traction));
}

double force_constraint::miss(const rolling_problem &problem, const double *p) const {
  double sum = 0;
  for (int m = 0; m < unknowns_; ++m) sum = hypot(sum, target_[m] - carried(m, problem, p));
  return weight_ * sum;
}

void force_constraint::keep(const rolling_problem &problem) {
  for (int m = 0; m < unknowns_; ++m) kept_[m] = problem.force->creepage[component_[m]];
}

bool force_constraint::overshoots(const rolling_problem &problem, const double *p,
                                  double residual) const {
  double far = 0, excess = 0;
  for (int m = 0; m < unknowns_; ++m) {
    const double force = carried(m, problem, p);
    far = hypot(far, kept_[m] / unit_[m]);
    excess += force * (force - target_[m]);
  }
  return far > flat_from &&
         (excess > noticeable * capacity_ * capacity_ || residual > far_from_solution);
}

void force_constraint::remember() {
  for (int m = 0; m < unknowns_; ++m) best_[m] = kept_[m];
}

void force_constraint::recall(const rolling_problem &problem) {
  for (int m = 0; m < unknowns_; ++m) problem.force->creepage[component_[m]] = best_[m];
  keep(problem);
}

void force_constraint::pull(const rolling_problem &problem, const double *p, const double *trial_p,
                            double length, double *moved, double *turned) const {
  for (int m = 0; m < unknowns_; ++m) {
    const double sigma = capacity_ > 0 ? unit_[m] / capacity_ : 0.0;
    const double now = carried(m, problem, p), then = carried(m, problem, trial_p);
    const double step = -length * sigma * (target_[m] - now);
    problem.force->creepage[component_[m]] = kept_[m] + step;
    if (sigma > 0) *moved += step * step / sigma;
    *turned += sigma * length * length * (then - now) * (then - now);
  }
}

void force_constraint::pull_again(const rolling_problem &problem, const double *trial_p,
                                  double length) {
  for (int m = 0; m < unknowns_; ++m) {
    const double sigma = capacity_ > 0 ? unit_[m] / capacity_ : 0.0;
    problem.force->creepage[component_[m]] =
        kept_[m] - length * sigma * (target_[m] - carried(m, problem, trial_p));
  }
  keep(problem);
}

void force_constraint::move(const rolling_problem &problem, double length) const {
  for (int m = 0; m < unknowns_; ++m)
    problem.force->creepage[component_[m]] = kept_[m] + length * step_[m];
}

// Shortens a step from the present creepages; returns whether it leads outwards to the very end.
bool force_constraint::bounded(const double *creepage, double *step) const {
  double now = 0, length = 0, there = 0;
  for (int m = 0; m < unknowns_; ++m) {
    now = hypot(now, creepage[m] / unit_[m]);
    length = hypot(length, step[m] / unit_[m]);
  }
  const double longest = 0.5 + 0.5 * now;
  for (int m = 0; m < unknowns_; ++m) {
    if (!(length <= longest)) step[m] = std::isfinite(length) ? step[m] * (longest / length) : 0.0;
    there = hypot(there, (creepage[m] + step[m]) / unit_[m]);
  }
  return there > most_creepage && there > now;
}

void force_constraint::set_units(const rolling_problem &problem, const double flexibility[2],
                                 double ramp_force) {
  double given = 0;
  for (int i = 0; i < 2 * problem.count(); ++i)
    given = std::max(given, std::abs(problem.rigid_slip[i]));
  // without friction any unit will do
  for (int m = 0; m < unknowns_; ++m)
    unit_[m] =
        capacity_ > 0 ? capacity_ * std::abs(flexibility[component_[m]]) / ramp_force + given : 1.0;
}

void force_constraint::guess(const rolling_problem &problem, const double flexibility[2]) {
  if (!(capacity_ > 0)) return;
  // a little less than what is asked for near full sliding: the curve is concave
  const double most = nearly_sliding * capacity_;
  const double share = target_size_ > most ? most / target_size_ : 1.0;
  double creepage[2] = {0, 0}, step[2];
  for (int i = 0; i < guesses; ++i) {
    for (int m = 0; m < unknowns_; ++m) problem.force->creepage[component_[m]] = creepage[m];
    const simplified_force now(problem, flexibility);
    double slope[2][2] = {}, miss = 0;
    for (int m = 0; m < unknowns_; ++m) {
      step[m] = now.force[component_[m]] - share * target_[m];
      miss = hypot(miss, step[m]);
      for (int k = 0; k < unknowns_; ++k)
        slope[m][k] = -now.slope[component_[m]][component_[k]] +
                      (m == k ? least_slope * capacity_ / unit_[m] : 0.0);
    }
    if (miss <= 1e-3 * share * target_size_) break;
    solve_schur(slope, step);
    bounded(creepage, step);
    for (int m = 0; m < unknowns_; ++m) creepage[m] += step[m];
  }
}

// b <- s^-1 b; by the diagonal alone where s is not well away from singular.
void force_constraint::solve_schur(const double s[2][2], double *b) const {
  if (unknowns_ == 1) {
    b[0] /= s[0][0];
    return;
  }
  const double product = s[0][0] * s[1][1], determinant = product - s[0][1] * s[1][0];
  if (!(determinant > 1e-9 * std::abs(product))) {
    for (int m = 0; m < 2; ++m) b[m] /= s[m][m];
    return;
  }
  const double first = (s[1][1] * b[0] - s[0][1] * b[1]) / determinant;
  b[1] = (s[0][0] * b[1] - s[1][0] * b[0]) / determinant;
  b[0] = first;
}

void force_constraint::factor(size_t n) {
  // far out, where spin or creepage across bend the slip a little, the curve is 1 - constant/xi^2
  double far = 1.0;
  for (int m = 0; m < unknowns_; ++m) far += std::abs(kept_[m]) / unit_[m];
  for (int m = 0; m < unknowns_; ++m) {
    delta_[m] = least_slope * weight_ * capacity_ / (unit_[m] * far * far * far);
    for (int k = 0; k < unknowns_; ++k)
      schur_[m][k] = dot(row_[m].data(), reduced_[k].data(), n) + (m == k ? delta_[m] : 0.0);
    // M is not J: the sign of the curve's slope must not be lost
    schur_[m][m] = std::max(schur_[m][m], delta_[m]);
  }
}

void force_constraint::apply(size_t n, const double *v, double *out) const {
  for (int m = 0; m < unknowns_; ++m) {
    const double xi = v[n + static_cast<size_t>(m)], *c = column_[m].data();
    for (size_t i = 0; i < n; ++i) out[i] += c[i] * xi;
    out[n + static_cast<size_t>(m)] = dot(row_[m].data(), v, n) - delta_[m] * xi;
  }
}

void force_constraint::precondition(size_t n, double *v) const {
  double xi[2];
  for (int m = 0; m < unknowns_; ++m)
    xi[m] = dot(row_[m].data(), v, n) - v[n + static_cast<size_t>(m)];
  solve_schur(schur_, xi);
  for (int m = 0; m < unknowns_; ++m) {
    v[n + static_cast<size_t>(m)] = xi[m];
    const double *z = reduced_[m].data();
    for (size_t i = 0; i < n; ++i) v[i] -= z[i] * xi[m];
  }
}

void force_constraint::bound_step(size_t n, double *v) {
  double *full = v + n;
  for (int m = 0; m < unknowns_; ++m) step_[m] = full[m];
  beyond_ = bounded(kept_, step_);
  shortened_ = false;
  for (int m = 0; m < unknowns_; ++m) shortened_ = shortened_ || step_[m] != full[m];
  travelled_ += shortened_;
  for (int m = 0; m < unknowns_; ++m) {
    const double *z = reduced_[m].data(), less = full[m] - step_[m];
    if (less != 0)
      for (size_t i = 0; i < n; ++i) v[i] += z[i] * less;
  }
}

}  // namespace railpatch
