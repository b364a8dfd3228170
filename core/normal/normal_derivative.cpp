#include "normal/normal_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/sums.hpp"

namespace railpatch {

namespace {

// of products in single precision, relative
constexpr double single_rounding = 3e-7;
// directions of search kept, and made at most
constexpr int kept = 64, most = 400;

}  // namespace

normal_derivative::normal_derivative(int max_count, int directions)
    : directions_(directions), systems_(max_count, kept, directions + 1) {
  const auto n = static_cast<size_t>(max_count), m = static_cast<size_t>(directions) + 1;
  at_ = aligned_buffer<int>(n);
  right_ = aligned_buffer<double>::uninitialized(m * n);
  solution_ = aligned_buffer<double>::uninitialized(m * n);
  for (auto *b : {&grid_in_, &grid_out_, &term_[0], &term_[1]}) *b = aligned_buffer<double>(n);
}

size_t normal_derivative::bytes() const {
  return at_.bytes() + 2 * right_.bytes() + 4 * grid_in_.bytes() + systems_.bytes();
}

void normal_derivative::collect(const normal_point &point) {
  count_ = 0;
  for (int i = 0; i < point.g.count(); ++i)
    if (point.pressure[i] > 0) at_[static_cast<size_t>(count_++)] = i;
  terms_ = false;
}

double normal_derivative::solve(const normal_point &point, const normal_variation *in, int count,
                                double tolerance, double *pressure, double *approach) {
  const grid &g = point.g;
  collect(point);
  products_ = 0;
  const auto n = static_cast<size_t>(count_), all = static_cast<size_t>(g.count());
  std::fill_n(pressure, all * static_cast<size_t>(count), 0.0);
  // where the approach changes, the last right side is that of an approach of one
  int sides = 0, side_of[64];
  bool loaded = false, rises = false;
  for (int k = 0; k < count; ++k) {
    const normal_variation &v = in[k];
    approach[k] = 0;
    side_of[k] = -1;
    if (v.still(point.force_given)) continue;
    loaded = true;
    rises = rises || point.force_given || v.approach != 0;
    bool zero = true;
    double *right = right_.data() + static_cast<size_t>(sides) * n;
    for (size_t i = 0; i < n; ++i) right[i] = v.distance ? -v.distance[at_[i]] : 0.0;
    if (v.size[0] != 0 || v.size[1] != 0) size_term(point, v, right);
    factor_term(point, v, right);
    for (size_t i = 0; i < n; ++i) zero = zero && right[i] == 0;
    side_of[k] = zero ? -2 : sides++;
  }
  if (!loaded || n == 0) return 0.0;
  if (rises) std::fill_n(right_.data() + static_cast<size_t>(sides) * n, n, 1.0);
  std::fill_n(grid_in_.data(), all, 0.0);
  const auto apply = [&](const double *v, double *out, bool exact, int) {
    for (size_t i = 0; i < n; ++i) grid_in_[static_cast<size_t>(at_[i])] = v[i];
    point.solver.product(point.a, g, point.parts, grid_in_.data(), grid_out_.data(), exact);
    for (size_t i = 0; i < n; ++i) out[i] = grid_out_[static_cast<size_t>(at_[i])];
  };
  const auto precondition = [&](double *v) {
    for (size_t i = 0; i < n; ++i) grid_in_[static_cast<size_t>(at_[i])] = v[i];
    point.a.normal_inverse(grid_in_.data(), grid_out_.data());
    for (size_t i = 0; i < n; ++i) v[i] = grid_out_[static_cast<size_t>(at_[i])];
  };
  const auto outcome =
      systems_.solve(n, sides + rises, n, right_.data(), solution_.data(),
                     {tolerance, single_rounding, most, false}, apply, precondition);
  products_ = outcome.exact + outcome.inexact;
  const double *ones = rises ? solution_.data() + static_cast<size_t>(sides) * n : nullptr;
  const double area = g.dx * g.dy, load = total(point.pressure, all);
  for (int k = 0; k < count; ++k) {
    if (side_of[k] == -1) continue;
    const normal_variation &v = in[k];
    const double *own =
        side_of[k] >= 0 ? solution_.data() + static_cast<size_t>(side_of[k]) * n : nullptr;
    double rise = v.approach;
    if (point.force_given) {
      // sum of dp dA + p d(dA) = dF
      const double growth = v.size[0] / g.dx + v.size[1] / g.dy;
      rise = (v.force / area - load * growth - (own ? total(own, n) : 0.0)) / total(ones, n);
    }
    approach[k] = rise;
    double *out = pressure + static_cast<size_t>(k) * all;
    for (size_t i = 0; i < n; ++i)
      out[at_[i]] = (ones ? rise * ones[i] : 0.0) + (own ? own[i] : 0.0);
  }
  return outcome.residual;
}

void normal_derivative::size_term(const normal_point &point, const normal_variation &v,
                                  double *right) {
  const grid &g = point.g;
  const bool line = point.a.bodies().line_width > 0;
  if (!terms_) {
    point.solver.product(point.a, g, point.parts, point.pressure, term_[0].data(), true);
    if (point.by_length)
      point.solver.product(*point.by_length, g, point.parts, point.pressure, term_[1].data(), true);
    terms_ = true;
  }
  const double scale = line ? v.size[0] / g.dx : v.size[1] / g.dy;
  const double stretch = line ? 0.0 : v.size[0] - g.dx * scale;
  double constant = 0;
  if (line) {
    const elastic_constants &e = point.a.bodies().elastic;
    const double c = 2.0 * (1.0 - e.poisson_ratio) / (std::numbers::pi * e.shear_modulus);
    constant = c * v.size[0] * total(point.pressure, static_cast<size_t>(g.count()));
  }
  for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
    const auto at = static_cast<size_t>(at_[i]);
    right[i] += constant - scale * term_[0][at];
    if (point.by_length) right[i] -= stretch * term_[1][at];
  }
}

// The product is linear in each factor: its derivative by one of them is what the product with that
// factor at one adds to that with it at zero.
void normal_derivative::factor_term(const normal_point &point, const normal_variation &v,
                                    double *right) {
  for (int k = 0; k + 1 < point.parts.count; ++k) {
    if (v.factor[k] == 0) continue;
    for (double at : {1.0, 0.0}) {
      contact_parts parts = point.parts;
      parts.factor[k] = at;
      point.solver.product(point.a, point.g, parts, point.pressure, grid_out_.data(), true);
      const double sign = at > 0 ? -v.factor[k] : v.factor[k];
      for (size_t i = 0; i < static_cast<size_t>(count_); ++i)
        right[i] += sign * grid_out_[static_cast<size_t>(at_[i])];
    }
  }
}

}  // namespace railpatch
