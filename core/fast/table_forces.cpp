#include "fast/table_forces.hpp"

#include <algorithm>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// Part of the load below which an ellipse may lie outside the table's range: its force would have
// to err by a sixth to move the whole by 0.3 %.
constexpr double little = 0.02;

const void *ellipses_in(const void *table) {
  const bool shapes = shape_table::is_one(table, sizeof(shape_table_header));
  return shapes ? shape_table::ellipses(table).first : table;
}

// N, frictional power over the rolling speed
template <class T>
T friction_of(const table_resultants<T> &sums, const creep_motion<T> &m) {
  const T power =
      sums.force[0] * m.creepage[0] + sums.force[1] * m.creepage[1] + sums.moment * m.spin_creepage;
  return std::max(T(0.0), -power);
}

}  // namespace

table_forces::table_forces(const elastic_constants &elastic, const void *table)
    : shear_modulus_(elastic.shear_modulus),
      coefficients_(elastic.poisson_ratio),
      ellipses_(ellipses_in(table), elastic.poisson_ratio) {
  if (shape_table::is_one(table, sizeof(shape_table_header)))
    shapes_.emplace(table, elastic.poisson_ratio);
}

template <class T>
table_resultants<T> table_forces::of_ellipse(const T axes[2], const creep_motion<T> &m,
                                             const T &bound) const {
  const basic_creep_forces<T> found = ellipses_.evaluate<T>({{axes[0], axes[1]},
                                                             shear_modulus_,
                                                             bound,
                                                             {m.creepage[0], m.creepage[1]},
                                                             m.spin_creepage,
                                                             m.direction});
  return {{found.force[0], found.force[1]}, found.moment, found.friction, found.in_range};
}

// The table takes its greatest a/b for a longer ellipse: creepages that this one feels as much.
template <class T>
bool table_forces::soften_beyond(const T axes[2], creep_motion<T> &motion) const {
  const T ratio = axes[0] / axes[1];
  const double nearest = ellipses_.nearest_ratio(value_of(ratio));
  if (nearest == value_of(ratio)) return false;
  T own[4];
  coefficients_.at(ratio, own);
  const creepage_coefficients taken = coefficients_.at(nearest);
  motion.creepage[0] *= own[0] / taken.c11;
  motion.creepage[1] *= own[1] / taken.c22;
  motion.spin_creepage *= own[2] / taken.c23;
  return true;
}

// Each ellipse with the creepages at its own centre.
template <class T>
table_resultants<T> table_forces::of_pressure(const pressure_view<T> &pressure,
                                              const creep_motion<T> &motion, const T &bound,
                                              pressed_ellipses<T> &work) const {
  work.set(pressure);
  table_resultants<T> sums;
  for (int k = 0; k < work.count(); ++k) {
    const basic_pressed_ellipse<T> &e = work[k];
    creep_motion<T> at_centre = motion;
    at_centre.creepage[0] -= motion.spin_creepage * e.centre[1];
    at_centre.creepage[1] += motion.spin_creepage * e.centre[0];
    const bool softer = soften_beyond(e.axes, at_centre);
    const T part = e.load * bound;
    table_resultants<T> own = of_ellipse(e.axes, at_centre, part);
    own.moment = own.moment + e.centre[0] * own.force[1] - e.centre[1] * own.force[0];
    if (softer) own.friction = friction_of(own, motion);
    for (int n = 0; n < 2; ++n) sums.force[n] += e.share * own.force[n];
    sums.moment += e.share * own.moment;
    sums.friction += e.share * own.friction;
    // beyond the table's axis ratios a part that hardly carries anything does not count
    if (e.load > little) sums.in_range = sums.in_range && own.in_range;
  }
  if (shapes_) correct(pressure, motion, bound, sums);
  return sums;
}

// Adds what the table of shapes knows of this one, within friction's bound.
template <class T>
void table_forces::correct(const pressure_view<T> &pressure, const creep_motion<T> &m,
                           const T &bound, table_resultants<T> &sums) const {
  const auto found = shapes_->evaluate<T>(pressure, shear_modulus_, bound, m.creepage,
                                          m.spin_creepage, m.direction);
  for (int n = 0; n < 2; ++n) sums.force[n] += found.force[n];
  sums.moment += found.moment;
  const T size = hypot(sums.force[0], sums.force[1]);
  if (size > bound)
    for (T &force : sums.force) force *= bound / size;
  sums.friction = friction_of(sums, m);
  sums.in_range = found.in_range;
}

template table_resultants<directed> table_forces::of_ellipse(const directed[2],
                                                             const creep_motion<directed> &,
                                                             const directed &) const;
template table_resultants<double> table_forces::of_pressure(const pressure_view<double> &,
                                                            const creep_motion<double> &,
                                                            const double &,
                                                            pressed_ellipses<double> &) const;
template table_resultants<directed> table_forces::of_pressure(const pressure_view<directed> &,
                                                              const creep_motion<directed> &,
                                                              const directed &,
                                                              pressed_ellipses<directed> &) const;

}  // namespace railpatch
