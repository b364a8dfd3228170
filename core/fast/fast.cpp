#include "fast/fast.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fast/fastsim.hpp"
#include "fast/polach.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::pi;

fast_solver::fast_solver(const elastic_constants &elastic, const fast_options &options, int max_nx,
                         int max_ny)
    : elastic_(elastic),
      options_(options),
      theory_(*theory_of(options.theory)),
      table_(elastic.poisson_ratio) {
  if (options.theory == RP_TANGENTIAL_TABLE) {
    tables_ = std::make_unique<table_forces>(elastic, options.creep_table);
    ellipses_ = pressed_ellipses<double>(max_ny);
  }
  if (!theory_.tractions) return;
  bound_ = aligned_buffer<double>(static_cast<size_t>(max_nx) * static_cast<size_t>(max_ny));
  leading_ = aligned_buffer<double>(static_cast<size_t>(max_ny));
  trailing_ = aligned_buffer<double>(static_cast<size_t>(max_ny));
}

// The ellipse with the same width, area and centre of pressure stands for a contact area of any
// shape.
fast_solver::ellipse fast_solver::ellipse_of(const fast_patch &patch) const {
  if (patch.hertz.semi_axes[0] > 0 && !patch.rows)
    return {{patch.hertz.semi_axes[0], patch.hertz.semi_axes[1]}, {0, 0}};
  const grid &g = patch.g;
  int first = g.ny, last = -1;
  double sum = 0, sum_x = 0, sum_y = 0;
  for (int j = 0; j < g.ny; ++j) {
    double row = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double p = patch.pressure[j * g.nx + i];
      row += p;
      sum_x += p * g.x(i);
    }
    if (!(row > 0)) continue;
    sum += row;
    sum_y += row * g.y(j);
    first = std::min(first, j);
    last = j;
  }
  const double half_width = 0.5 * (patch.rows ? patch.rows->width() : (last - first + 1) * g.dy);
  return {{patch.contact_area / (pi * half_width), half_width}, {sum_x / sum, sum_y / sum}};
}

creepage_coefficients fast_solver::coefficients(double axis_ratio) const {
  creepage_coefficients c = options_.blending == RP_BLENDING_CONTACT
                                ? published_coefficients(axis_ratio, elastic_.poisson_ratio)
                                : table_.at(axis_ratio);
  for (double *v : {&c.c11, &c.c22, &c.c23, &c.c33}) *v *= options_.coefficient_factor;
  return c;
}

// Elliptic bound: mu times the pressure. Parabolic bound: of its square, so that of Hertz's
// pressure it is the paraboloid of the simplified theory; scaled so that full sliding gives exactly
// mu times the force.
void fast_solver::set_bound(const fast_patch &patch) {
  const grid &g = patch.g;
  const double mu = options_.law ? 1.0 : patch.friction_coefficient, *p = patch.pressure;
  const double *axes = patch.hertz.semi_axes;
  const bool ellipse = axes[0] > 0 && !patch.rows;
  const bool automatic = options_.bound == RP_BOUND_AUTOMATIC;
  const bool as_contact = options_.blending == RP_BLENDING_CONTACT;
  const bool parabolic = (theory_.reads & reads_bound) != 0 &&
                         (automatic ? ellipse && as_contact : options_.bound == RP_BOUND_PARABOLIC);
  if (ellipse && as_contact) {
    // as it is at the elements' centres, not scaled
    const double peak = (parabolic ? 4.0 / 3.0 : 1.0) * mu * patch.hertz.max_pressure;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const double level = std::max(0.0, inside_ellipse(axes, g.x(i), g.y(j)));
        bound_[static_cast<size_t>(j * g.nx + i)] = peak * (parabolic ? level : std::sqrt(level));
      }
    return;
  }
  double squares = 0;
  for (int i = 0; parabolic && i < g.count(); ++i) squares += p[i] * p[i];
  const double scale =
      parabolic && squares > 0 ? patch.normal_force / (squares * g.dx * g.dy) : 1.0;
  for (int i = 0; i < g.count(); ++i)
    bound_[static_cast<size_t>(i)] = mu * scale * (parabolic ? p[i] * p[i] : p[i]);
}

double fast_solver::friction_at(const fast_patch &patch, double speed) const {
  if (!options_.law) return patch.friction_coefficient;
  double slope;
  return patch.friction_scale * options_.law->coefficient(speed, slope);
}

// Multiplies the bound by each element's friction coefficient; returns their mean by pressure.
double fast_solver::follow_slip(const fast_patch &patch, const rolling_input &rolling) {
  const grid &g = patch.g;
  double sum = 0, load = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      const double p = patch.pressure[at];
      if (!(p > 0)) continue;
      const double slip = hypot(rolling.slip(0, g.x(i), g.y(j)), rolling.slip(1, g.x(i), g.y(j)));
      const double mu = friction_at(patch, rolling.speed * slip);
      bound_[static_cast<size_t>(at)] *= mu;
      sum += mu * p;
      load += p;
    }
  return load > 0 ? sum / load : 0.0;
}

// x of the contact's ends in each row.
void fast_solver::find_rows(const fast_patch &patch, int direction) {
  const grid &g = patch.g;
  const double *axes = patch.hertz.semi_axes;
  for (int j = 0; j < g.ny; ++j) {
    const double *p = patch.pressure + j * g.nx;
    int low = 0, high = g.nx - 1;
    while (low < g.nx && !(p[low] > 0)) ++low;
    while (high >= low && !(p[high] > 0)) --high;
    double ends[2] = {0, 0};
    if (low <= high) {
      const double level = axes[0] > 0 && !patch.rows ? inside_ellipse(axes, 0.0, g.y(j)) : 0.0;
      const double half = level > 0 ? axes[0] * std::sqrt(level) : 0.0;
      ends[0] = level > 0 ? -half : g.x(low) - 0.5 * g.dx;
      ends[1] = level > 0 ? half : g.x(high) + 0.5 * g.dx;
      // the chord's ends, unless the row is too narrow for an element's middle
      if (patch.rows && patch.rows->leading_edge(j, -1) < g.x(low))
        ends[0] = patch.rows->leading_edge(j, -1);
      if (patch.rows && patch.rows->leading_edge(j, 1) > g.x(high))
        ends[1] = patch.rows->leading_edge(j, 1);
    }
    leading_[static_cast<size_t>(j)] = ends[direction > 0 ? 1 : 0];
    trailing_[static_cast<size_t>(j)] = ends[direction > 0 ? 0 : 1];
  }
}

// Creep forces of the tables on a contact of any shape.
tangential_result fast_solver::solve_by_ellipses(const fast_patch &patch,
                                                 const rolling_input &rolling,
                                                 creep_resultants &sums) {
  const double bound = patch.friction_coefficient * patch.normal_force;
  const table_resultants<double> found = tables_->of_pressure<double>(
      {patch.g, patch.pressure},
      {{rolling.creepage[0], rolling.creepage[1]}, rolling.spin_creepage, rolling.direction}, bound,
      ellipses_);
  sums = {{found.force[0], found.force[1]}, found.moment, found.friction, bound};
  tangential_result result;
  result.friction = sums.friction;
  result.converged = found.in_range && std::isfinite(result.friction);
  return result;
}

tangential_result fast_solver::solve(const fast_patch &patch, const rolling_input &rolling,
                                     tangential_fields fields, creep_resultants &sums) {
  if (table() && !(patch.hertz.semi_axes[0] > 0 && !patch.rows))
    return solve_by_ellipses(patch, rolling, sums);
  const ellipse e = ellipse_of(patch);
  fast_problem problem{elastic_,
                       options_,
                       table(),
                       e.axes,
                       e.centre,
                       0.0,
                       {},
                       rolling,
                       patch.g,
                       patch.pressure,
                       bound_.data(),
                       {leading_.data(), trailing_.data(), e.centre[1]},
                       {},
                       rolling};
  problem.at_centre.creepage[0] -= rolling.spin_creepage * e.centre[1];
  problem.at_centre.creepage[1] += rolling.spin_creepage * e.centre[0];
  if (theory_.reads & reads_percent) problem.coefficients = coefficients(e.axes[0] / e.axes[1]);
  const double *creepage = problem.at_centre.creepage;
  double mu = friction_at(patch, rolling.speed * hypot(creepage[0], creepage[1]));
  if (theory_.tractions) {
    set_bound(patch);
    if (options_.law) mu = follow_slip(patch, rolling);
  }
  problem.capacity = mu * patch.normal_force;
  if (theory_.tractions) {
    find_rows(patch, rolling.direction);
    problem.l = flexibilities_of(problem);
  }
  tangential_result result = theory_.solve(problem, fields, sums);
  sums.capacity = problem.capacity;
  // beyond what floating-point numbers hold there is no result
  result.converged =
      result.converged && problem.coefficients.in_range && std::isfinite(result.friction);
  return result;
}

flexibilities fast_solver::flexibilities_of(const fast_problem &p) const {
  const double g = elastic_.shear_modulus;
  const creepage_coefficients &c = p.coefficients;
  flexibilities l = kalker_flexibilities(c, g, p.axes);
  if (options_.blending != RP_BLENDING_NONE) l = blend(l, c, g, p.axes, p.capacity, p.at_centre);
  // without friction there is no gradient, and no traction either
  if (!(p.capacity > 0)) return l;
  const stiffness_reduction &reduction = options_.reduction;
  double gradient = resultant_of(c, g, p.axes, p.capacity, p.at_centre).gradient;
  if (options_.blending == RP_BLENDING_CONTACT) gradient *= reduction.k0;
  const double k = reduction.at(gradient);
  return {l.l1 / k, l.l2 / k, l.l3 / k};
}

}  // namespace railpatch
