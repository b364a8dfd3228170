#include "normal/active_set.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/sums.hpp"

namespace railpatch {

namespace {

// of the linear systems: no better than the tolerance asks for
constexpr double inner_tolerance = 1e-3, worst_inner_tolerance = 3e-2;
// rounds in which the greatest error may stay above nine tenths of the least so far
constexpr int patience = 6;
constexpr double shortest = 1.0 / 8;  // of a step

}  // namespace

struct active_set_solver::problem {
  viscous_influence &a;
  const grid &g;
  const double *h;
  normal_options options;
  bool force_given;
  double force;      // N, where given
  double approach;   // m, given or found
  size_t n = 0;      // elements
  size_t size = 0;   // of the contact area
  double scale = 0;  // m, greatest displacement
  double worst = 0;  // m, greatest violation of the contact conditions
  double least = HUGE_VAL;
  int strayed = 0;
  int settled = 0;    // rounds with the area as it is
  double length = 1;  // of a step
  double ones = 0;    // sum of the preconditioned ones
  int products = 0;
};

active_set_solver::active_set_solver(int max_count) : linear_solver_(max_count + 1, krylov_size) {
  const auto n = static_cast<size_t>(max_count) + 1;
  for (auto *b : {&displacement_, &error_, &field_, &image_, &right_, &step_, &ones_})
    *b = aligned_buffer<double>(n);
  area_ = aligned_buffer<int>(n);
  inside_ = aligned_buffer<unsigned char>(n);
}

size_t active_set_solver::bytes() const {
  return 7 * field_.bytes() + area_.bytes() + inside_.bytes() + linear_solver_.bytes();
}

normal_result active_set_solver::with_approach(viscous_influence &a, const grid &g, const double *h,
                                               double approach, const normal_options &options,
                                               double *pressure) {
  problem s{a, g, h, options, false, 0.0, approach};
  return solve(s, pressure);
}

normal_result active_set_solver::with_force(viscous_influence &a, const grid &g, const double *h,
                                            double force, const normal_options &options,
                                            double *pressure) {
  problem s{a, g, h, options, true, force, 0.0};
  return solve(s, pressure);
}

normal_result active_set_solver::solve(problem &s, double *p) {
  s.n = static_cast<size_t>(s.g.count());
  start(s, p);
  evaluate(s, p);
  for (int round = 0; round < s.options.max_iterations; ++round) {
    s.options.ask.check();
    if (s.worst <= s.options.tolerance * s.scale) break;
    find_step(s, p);
    advance(s, p);
    evaluate(s, p);
  }
  normal_result result;
  result.iterations = s.products;
  result.residual = s.scale > 0 ? s.worst / s.scale : 0.0;
  result.converged = s.worst <= s.options.tolerance * s.scale;
  result.scale = s.scale;
  result.approach = s.approach;
  result.normal_force = total(p, s.n) * s.g.dx * s.g.dy;
  count_contact(s.g, p, s.options.strips, result);
  return result;
}

// Half of the rigid overlap, as in normal.cpp; without pressure where the force is not given: the
// first round's area is the overlap.
void active_set_solver::start(problem &s, double *p) {
  const bool warm = std::any_of(p, p + s.n, [](double v) { return v > 0; });
  if (!warm && s.force_given) {
    const auto [lowest, highest] = std::minmax_element(s.h, s.h + s.n);
    const double depth = 0.5 * (*highest - *lowest);
    for (size_t i = 0; i < s.n; ++i)
      p[i] = std::sqrt(std::max(0.0, 0.55 * depth - (s.h[i] - *lowest)));
    if (total(p, s.n) <= 0) std::fill_n(p, s.n, 1.0);
  }
  scale_to_force(s, p);
}

void active_set_solver::scale_to_force(const problem &s, double *p) const {
  if (!s.force_given) return;
  const double sum = total(p, s.n) * s.g.dx * s.g.dy;
  if (sum <= 0) return;
  for (size_t i = 0; i < s.n; ++i) p[i] *= s.force / sum;
}

// Displacement, approach where it is found, errors and contact area of a pressure.
void active_set_solver::evaluate(problem &s, const double *p) {
  s.a.normal_product(p, displacement_.data());
  ++s.products;
  const auto [least, greatest] =
      std::minmax_element(displacement_.data(), displacement_.data() + s.n);
  // a line contact's displacements are known but for a constant
  s.scale = s.a.is_line() ? *greatest - *least : *greatest;
  if (s.force_given) s.approach = mean_approach(s.n, s.h, displacement_.data(), p);
  if (!(s.scale > 0)) s.scale = std::max(0.0, s.approach - *std::min_element(s.h, s.h + s.n));
  find_area(s, p);
  if (s.worst <= 0.9 * s.least) {
    s.least = s.worst;
    s.strayed = 0;
  } else if (++s.strayed > patience) {
    s.length = std::max(0.5 * s.length, shortest);
    s.strayed = 0;
  }
}

void active_set_solver::find_area(problem &s, const double *p) {
  s.worst = 0;
  s.size = 0;
  ++s.settled;
  for (size_t i = 0; i < s.n; ++i) {
    error_[i] = s.h[i] + displacement_[i] - s.approach;
    const bool before = inside_[i];
    inside_[i] = p[i] > 0 || error_[i] < 0;
    if (inside_[i] != before) s.settled = 0;
    if (!inside_[i]) continue;
    area_[s.size++] = static_cast<int>(i);
    s.worst = std::max(s.worst, std::abs(error_[i]));
  }
}

void active_set_solver::spread(const problem &s, const double *v) {
  std::fill_n(field_.data(), s.n, 0.0);
  for (size_t k = 0; k < s.size; ++k) field_[static_cast<size_t>(area_[k])] = v[k];
}

void active_set_solver::gather(const problem &s, const double *field, double *v) const {
  for (size_t k = 0; k < s.size; ++k) v[k] = field[area_[k]];
}

// The approach is one more unknown where the force is given, and is taken out by blocks.
void active_set_solver::precondition(problem &s, double *v) {
  spread(s, v);
  s.a.normal_inverse(inside_.data(), field_.data(), image_.data());
  gather(s, image_.data(), v);
  if (!s.force_given) return;
  const double more = (v[s.size] - total(v, s.size)) / s.ones;
  for (size_t k = 0; k < s.size; ++k) v[k] += more * ones_[k];
  v[s.size] = more;
}

void active_set_solver::find_step(problem &s, const double *p) {
  gather(s, error_.data(), right_.data());
  for (size_t k = 0; k < s.size; ++k) right_[k] = -right_[k];
  size_t unknowns = s.size;
  if (s.force_given) {
    // A dp - approach = -e, sum of dp = what the force lacks, which is nothing
    s.ones = 0;
    std::fill_n(ones_.data(), s.size, 1.0);
    spread(s, ones_.data());
    s.a.normal_inverse(inside_.data(), field_.data(), image_.data());
    gather(s, image_.data(), ones_.data());
    s.ones = total(ones_.data(), s.size);
    right_[unknowns++] = s.force / (s.g.dx * s.g.dy) - total(p, s.n);
  }
  const double goal = s.options.tolerance * s.scale;
  const double tolerance = std::clamp(0.1 * goal / s.worst, inner_tolerance, worst_inner_tolerance);
  const auto apply = [&](const double *v, double *out) {
    s.options.ask.check();
    spread(s, v);
    s.a.normal_product(field_.data(), image_.data());
    gather(s, image_.data(), out);
    if (!s.force_given) return;
    for (size_t k = 0; k < s.size; ++k) out[k] -= v[s.size];
    out[s.size] = total(v, s.size);
  };
  const auto outcome =
      linear_solver_.solve(unknowns, right_.data(), step_.data(), tolerance, max_products, apply,
                           [&](double *v) { precondition(s, v); });
  s.products += outcome.products;
}

void active_set_solver::advance(problem &s, double *p) {
  // of an area that stays, a whole step leaves no error
  const double length = s.settled > 1 ? 1.0 : s.length;
  for (size_t k = 0; k < s.size; ++k) {
    double &value = p[area_[k]];
    value = std::max(0.0, value + length * step_[k]);
  }
  scale_to_force(s, p);
}

}  // namespace railpatch
