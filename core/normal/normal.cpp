#include "normal/normal.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/sums.hpp"

namespace railpatch {

struct normal_solver::problem {
  influence &a;
  const grid &g;
  const double *h;
  normal_options options;
  contact_parts parts;
  bool force_given;
  double force;     // N, where given
  double approach;  // m, given or found
  size_t n = 0;
  double scale = 0;  // m, greatest displacement
  double worst = 0;  // m, greatest violation of the contact conditions
  double gamma = 0;  // r . z of the last step
  bool set_changed = true;
  bool exact = false;  // the displacement is a product, not followed by steps
};

normal_solver::normal_solver(int max_count) {
  const auto n = static_cast<size_t>(max_count);
  for (auto *b : {&displacement_, &error_, &residual_, &direction_, &product_, &preconditioned_,
                  &ones_, &previous_, &part_pressure_, &part_displacement_})
    *b = aligned_buffer<double>(n);
  free_ = aligned_buffer<unsigned char>(n);
}

size_t normal_solver::bytes() const { return 10 * displacement_.bytes() + free_.bytes(); }

normal_result normal_solver::with_approach(influence &a, const grid &g, const double *h,
                                           double approach, const normal_options &options,
                                           double *pressure, const contact_parts &parts) {
  problem state{a, g, h, options, parts, false, 0.0, approach};
  return solve(state, pressure);
}

normal_result normal_solver::with_force(influence &a, const grid &g, const double *h, double force,
                                        const normal_options &options, double *pressure,
                                        const contact_parts &parts) {
  problem state{a, g, h, options, parts, true, force, 0.0};
  return solve(state, pressure);
}

normal_result normal_solver::solve(problem &s, double *p) {
  s.n = static_cast<size_t>(s.g.count());
  start(s, p);
  normal_result result;
  evaluate(s, p);
  if (s.worst > s.options.tolerance * s.scale) fit_size(s, p);
  // iterate until the conditions hold on a settled contact area
  for (; result.iterations < s.options.max_iterations; ++result.iterations) {
    s.options.ask.check();
    if (s.worst <= s.options.tolerance * s.scale) {
      if (!s.exact) evaluate(s, p);
      if (s.worst <= s.options.tolerance * s.scale) break;
    }
    if (!search_direction(s, s.set_changed) && !search_direction(s, true)) break;
    if (advance(s, p)) {
      scale_to_force(s, p);
      evaluate(s, p);
    } else {
      check_conditions(s, p);
    }
  }
  if (!s.exact) evaluate(s, p);
  result.residual = s.scale > 0 ? s.worst / s.scale : 0.0;
  result.converged = s.worst <= s.options.tolerance * s.scale;
  result.scale = s.scale;
  result.approach = s.approach;
  result.normal_force = total(p, s.n) * s.g.dx * s.g.dy;
  count_contact(s.g, p, s.options.strips, result);
  return result;
}

double mean_approach(size_t n, const double *h, const double *displacement, const double *p) {
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < n; ++i)
    if (p[i] > 0) {
      sum += h[i] + displacement[i];
      ++count;
    }
  return sum / std::max(count, 1);
}

void count_contact(const grid &g, const double *p, bool strips, normal_result &result) {
  const bool bounded_x = g.nx > (strips ? 2 : 0), bounded_y = g.ny > (strips ? 2 : 1);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      if (p[j * g.nx + i] <= 0) continue;
      ++result.contact_count;
      const bool edge_x = bounded_x && (i == 0 || i == g.nx - 1);
      const bool edge_y = bounded_y && (j == 0 || j == g.ny - 1);
      result.touches_border |= edge_x || edge_y;
    }
}

void normal_solver::start(problem &s, double *p) {
  const bool warm = std::any_of(p, p + s.n, [](double v) { return v > 0; });
  if (!warm) cold_start(s, p);
  scale_to_force(s, p);
  s.set_changed = true;
  std::fill_n(free_.data(), s.n, static_cast<unsigned char>(0));
}

void normal_solver::product(problem &s, const double *p, double *u, precision digits) {
  product(s.a, s.g, s.parts, p, u, digits == precision::full);
}

void normal_solver::product(influence &a, const grid &g, const contact_parts &parts,
                            const double *p, double *u, bool exact) {
  const auto product = exact ? &influence::normal_product : &influence::normal_product_single;
  if (parts.count == 1) return (a.*product)(p, u);
  const auto n = static_cast<size_t>(g.count());
  std::fill_n(u, n, 0.0);
  const auto row_begin = [&](int part) {
    return static_cast<size_t>((part < parts.count ? parts.first_row[part] : g.ny) * g.nx);
  };
  for (int source = 0; source < parts.count; ++source) {
    std::fill_n(part_pressure_.data(), n, 0.0);
    for (size_t i = row_begin(source); i < row_begin(source + 1); ++i) part_pressure_[i] = p[i];
    (a.*product)(part_pressure_.data(), part_displacement_.data());
    for (int part = 0; part < parts.count; ++part) {
      double factor = 1;
      for (int k = std::min(source, part); k < std::max(source, part); ++k)
        factor *= parts.factor[k];
      for (size_t i = row_begin(part); i < row_begin(part + 1); ++i)
        u[i] += factor * part_displacement_[i];
    }
  }
}

void normal_solver::cold_start(problem &s, double *p) {
  // about half the rigid overlap survives as contact: an elliptic pressure over that region
  // (virtual penetration, Kik and Piotrowski 1996), its size then set by least squares
  const double lowest = *std::min_element(s.h, s.h + s.n);
  double depth = s.approach - lowest;
  if (s.force_given) {
    const double highest = *std::max_element(s.h, s.h + s.n);
    depth = 0.5 * (highest - lowest);
  }
  if (depth <= 0 && !s.force_given) return;
  for (size_t i = 0; i < s.n; ++i)
    p[i] = std::sqrt(std::max(0.0, 0.55 * depth - (s.h[i] - lowest)));
  if (s.force_given) {
    if (total(p, s.n) <= 0) std::fill_n(p, s.n, 1.0);
    return;
  }
  product(s, p, displacement_.data(), precision::single);
  const double size = dot(p, displacement_.data(), s.n);
  double work = 0;
  for (size_t i = 0; i < s.n; ++i) work += p[i] * (s.approach - s.h[i]);
  for (size_t i = 0; i < s.n; ++i) p[i] *= std::max(0.0, work / size);
}

void normal_solver::scale_to_force(problem &s, double *p) {
  if (!s.force_given) return;
  const double sum = total(p, s.n) * s.g.dx * s.g.dy;
  if (sum <= 0) return;
  for (size_t i = 0; i < s.n; ++i) p[i] *= s.force / sum;
}

// A start of the right shape has the right size at once, as the displacement goes with it: by least
// energy, so that nothing is lost where the shape is wrong.
void normal_solver::fit_size(problem &s, double *p) {
  if (s.force_given || !s.options.grows) return;
  double work = 0;
  for (size_t i = 0; i < s.n; ++i) work += p[i] * (s.approach - s.h[i]);
  const double size = dot(p, displacement_.data(), s.n);
  if (!(work > 0 && size > 0)) return;
  const double factor = work / size;
  for (size_t i = 0; i < s.n; ++i) {
    p[i] *= factor;
    displacement_[i] *= factor;
  }
  check_conditions(s, p);
}

void normal_solver::evaluate(problem &s, const double *p) {
  product(s, p, displacement_.data(), precision::full);
  s.exact = true;
  check_conditions(s, p);
}

// Sets the error, its size and the free elements from the displacement.
void normal_solver::check_conditions(problem &s, const double *p) {
  s.scale = *std::max_element(displacement_.data(), displacement_.data() + s.n);
  if (s.force_given) {
    s.approach = mean_approach(s.n, s.h, displacement_.data(), p);
  } else if (s.scale <= 0) {
    s.scale = std::max(0.0, s.approach - *std::min_element(s.h, s.h + s.n));
  }
  s.worst = 0;
  s.set_changed = false;
  for (size_t i = 0; i < s.n; ++i) {
    error_[i] = s.h[i] + displacement_[i] - s.approach;
    const unsigned char is_free = p[i] > 0 || error_[i] < 0;
    s.set_changed |= is_free != free_[i];
    free_[i] = is_free;
    if (is_free) s.worst = std::max(s.worst, std::abs(error_[i]));
  }
}

bool normal_solver::search_direction(problem &s, bool restart) {
  for (size_t i = 0; i < s.n; ++i) residual_[i] = free_[i] ? -error_[i] : 0.0;
  s.a.normal_inverse(residual_.data(), preconditioned_.data());
  for (size_t i = 0; i < s.n; ++i)
    if (!free_[i]) preconditioned_[i] = 0.0;
  if (s.force_given) {
    // keep the force: project along the preconditioned ones (Gould, Hribar and Nocedal 2001)
    if (restart) {
      for (size_t i = 0; i < s.n; ++i) direction_[i] = free_[i];
      s.a.normal_inverse(direction_.data(), ones_.data());
      for (size_t i = 0; i < s.n; ++i)
        if (!free_[i]) ones_[i] = 0.0;
    }
    const double excess = total(preconditioned_.data(), s.n) / total(ones_.data(), s.n);
    for (size_t i = 0; i < s.n; ++i) preconditioned_[i] -= excess * ones_[i];
  }
  // Polak-Ribiere: forgets the past by itself when the preconditioner misleads
  const double size = dot(residual_.data(), preconditioned_.data(), s.n);
  double beta = 0;
  if (!restart && s.gamma > 0)
    beta = std::max(0.0, (size - dot(previous_.data(), preconditioned_.data(), s.n)) / s.gamma);
  s.gamma = size;
  for (size_t i = 0; i < s.n; ++i) {
    direction_[i] = preconditioned_[i] + beta * (restart ? 0.0 : direction_[i]);
    if (!free_[i]) direction_[i] = 0.0;
    previous_[i] = residual_[i];
  }
  return dot(residual_.data(), direction_.data(), s.n) > 0;
}

// One step along the direction, exact on the free elements; true where an element lost contact.
// Else the displacement follows by the product of the step, to single precision of what the step
// changes.
bool normal_solver::advance(problem &s, double *p) {
  product(s, direction_.data(), product_.data(), precision::single);
  const double slope = dot(residual_.data(), direction_.data(), s.n);
  const double curvature = dot(direction_.data(), product_.data(), s.n);
  const double step = curvature > 0 ? slope / curvature : 0.0;
  bool clipped = false;
  for (size_t i = 0; i < s.n; ++i) {
    if (!free_[i]) continue;
    p[i] += step * direction_[i];
    if (p[i] < 0) {
      p[i] = 0;
      clipped = true;
    }
  }
  if (clipped) return true;
  for (size_t i = 0; i < s.n; ++i) displacement_[i] += step * product_[i];
  s.exact = false;
  return false;
}

}  // namespace railpatch
