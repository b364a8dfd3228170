// What pressure and traction do to each other: the seam between the outer loop of normal and
// tangential problem (patch/coupled_contact.hpp) and the reasons for it.
#pragma once

#include "half_space/influence.hpp"

namespace railpatch {

class coupling_operator {
 public:
  virtual ~coupling_operator() = default;
  // false where the grid exceeds the plans.
  virtual bool set_grid(const grid &g) = 0;
  // Tangential displacement (m) from pressure, seen from `offset` (m) further along x.
  virtual void from_pressure(double offset, const double *p, double *ux, double *uy) = 0;
  // Normal displacement (m) from traction, > 0 parts the bodies.
  virtual void from_traction(const double *px, const double *py, double *un) = 0;
  virtual size_t bytes() const = 0;
};

}  // namespace railpatch
