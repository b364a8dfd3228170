// The fast theories of rolling contact behind one call: what they share is the ellipse (or the one
// that stands for a contact area of any shape), the creepage coefficients, the traction bound and
// the ends of the rows. Of an area of any shape the resultant theories see the creepages at its
// centre of pressure, the others at the middle of each row. The table of creep forces, which is as
// good as the full theory on an ellipse, takes others in its place: table_forces.hpp.
//
// Theories that give resultants only need no grid and no fields.
//
// Where friction follows the speed of slip, it is that of the rigid slip, V |w|: of each element,
// and for resultants of the creepage at the centre of pressure (Polach 2005, Wear 258; Spiryagin,
// Polach and Cole 2013). Without spin that is V times the creepage everywhere. Rigid slip knows
// nothing of where the material began to slip, so there is no memory.
#pragma once

#include <memory>

#include "fast/coefficients.hpp"
#include "fast/table_forces.hpp"
#include "fast/theories.hpp"
#include "normal/hertz.hpp"
#include "normal/row_contact.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

// What a fast theory sees of a patch.
struct fast_patch {
  const grid &g;
  const double *pressure;      // Pa, [ny][nx]; null where there is no grid
  const hertz_contact &hertz;  // all zero where the contact area is not an ellipse
  const row_contact *rows;     // where the normal theory knows the ends of the rows, else null
  double normal_force;         // N
  double contact_area;         // m^2
  double friction_coefficient;
  double friction_scale = 1;  // of a law of slip velocity
};

class fast_solver {
 public:
  fast_solver(const elastic_constants &elastic, const fast_options &options, int max_nx,
              int max_ny);

  // Fills `fields` where the theory has tractions, else `sums`. Not converged: outside the theory's
  // range, the result is there all the same.
  tangential_result solve(const fast_patch &patch, const rolling_input &rolling,
                          tangential_fields fields, creep_resultants &sums);
  // Of Polach's theory, for the solutions that follow: its factors, and friction by the slip's
  // speed.
  void set_polach(const polach_factors &factors, const slip_velocity_law &law) {
    options_.polach = factors;
    options_.law.emplace(law);
  }
  // Where the theory is that.
  const table_forces *tables() const { return tables_.get(); }
  // The table of creep forces, where the theory is that, and of shapes, where there is one.
  const creep_table *table() const { return tables_ ? &tables_->ellipses() : nullptr; }
  const shape_table *shapes() const { return tables_ ? tables_->shapes() : nullptr; }
  size_t bytes() const {
    return bound_.bytes() + leading_.bytes() + trailing_.bytes() + ellipses_.bytes() +
           (tables_ ? sizeof *tables_ : 0);
  }

 private:
  struct ellipse {
    double axes[2];    // m
    double centre[2];  // m
  };
  ellipse ellipse_of(const fast_patch &patch) const;
  tangential_result solve_by_ellipses(const fast_patch &patch, const rolling_input &rolling,
                                      creep_resultants &sums);
  flexibilities flexibilities_of(const fast_problem &problem) const;
  creepage_coefficients coefficients(double axis_ratio) const;
  void set_bound(const fast_patch &patch);
  double friction_at(const fast_patch &patch, double speed) const;
  double follow_slip(const fast_patch &patch, const rolling_input &rolling);
  void find_rows(const fast_patch &patch, int direction);

  elastic_constants elastic_;
  fast_options options_;
  const fast_theory &theory_;
  coefficient_table table_;
  std::unique_ptr<table_forces> tables_;  // those theories alone pay for its memory that have it
  pressed_ellipses<double> ellipses_;     // of the tables
  aligned_buffer<double> bound_, leading_, trailing_;
};

}  // namespace railpatch
