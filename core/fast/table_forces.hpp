// What tables tell of a contact's creep forces: the table of ellipses of an elliptic contact, of
// others the sum over the ellipses of pressed_ellipses.hpp and what a table of shapes adds. Their
// rates come from the same interpolation, in numbers that carry them.
//
// T: double, or directed, which tells how they change along a direction.
#pragma once

#include <optional>

#include "fast/coefficients.hpp"
#include "fast/creep_table.hpp"
#include "fast/pressed_ellipses.hpp"
#include "fast/shape_table.hpp"

namespace railpatch {

// At the origin of a patch's grid.
template <class T>
struct creep_motion {
  T creepage[2], spin_creepage;
  int direction;
};

template <class T>
struct table_resultants {
  T force[2] = {0, 0};  // N on the wheel
  T moment = 0;         // N m on the wheel, about the origin
  T friction = 0;       // N, frictional power over the rolling speed
  bool in_range = true;
};

class table_forces {
 public:
  // The table is the caller's, without defect, and used in place.
  table_forces(const elastic_constants &elastic, const void *table);

  const creep_table &ellipses() const { return ellipses_; }
  const shape_table *shapes() const { return shapes_ ? &*shapes_ : nullptr; }

  // Of an ellipse about the origin. bound: N, friction coefficient times normal force.
  template <class T>
  table_resultants<T> of_ellipse(const T axes[2], const creep_motion<T> &motion,
                                 const T &bound) const;
  // Of a pressure that is somewhere above 0. work: its ellipses are found there.
  template <class T>
  table_resultants<T> of_pressure(const pressure_view<T> &pressure, const creep_motion<T> &motion,
                                  const T &bound, pressed_ellipses<T> &work) const;

 private:
  template <class T>
  bool soften_beyond(const T axes[2], creep_motion<T> &motion) const;
  template <class T>
  void correct(const pressure_view<T> &pressure, const creep_motion<T> &motion, const T &bound,
               table_resultants<T> &sums) const;

  double shear_modulus_;
  coefficient_table coefficients_;
  creep_table ellipses_;
  std::optional<shape_table> shapes_;
};

}  // namespace railpatch
