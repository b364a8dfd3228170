// The fast theories of rolling contact behind one call: what they share is the ellipse (or the one
// that stands for a contact area of any shape), the creepage coefficients, the traction bound and
// the ends of the rows. Of an area of any shape the resultant theories see the creepages at its
// centre of pressure, the others at the middle of each row.
//
// Linear theory, Polach and the table give resultants only: they need no grid and no fields. The
// linear theory (Kalker 1967) knows no bound; beyond it the result counts as not in range.
#pragma once

#include <optional>

#include "fast/coefficients.hpp"
#include "fast/creep_table.hpp"
#include "fast/fastsim.hpp"
#include "fast/polach.hpp"
#include "normal/hertz.hpp"
#include "normal/row_contact.hpp"
#include "numeric/memory.hpp"
#include "railpatch.h"
#include "tangential/tangential.hpp"

namespace railpatch {

struct fast_options {
  rp_tangential_method theory = RP_TANGENTIAL_FASTSIM;
  double coefficient_factor = 1;  // of all creepage coefficients
  rp_traction_bound bound = RP_BOUND_AUTOMATIC;
  rp_flexibility_blending blending = RP_BLENDING_SLIDING;
  polach_factors polach;
  stiffness_reduction reduction;
  const void *creep_table = nullptr;  // the caller's, without defect; of theory table
};

// What a fast theory sees of a patch.
struct fast_patch {
  const grid &g;
  const double *pressure;      // Pa, [ny][nx]; null where there is no grid
  const hertz_contact &hertz;  // all zero where the contact area is not an ellipse
  const row_contact *rows;     // where the normal theory knows the ends of the rows, else null
  double normal_force;         // N
  double contact_area;         // m^2
  double friction_coefficient;
};

// Whether the theory gives tractions, not only their resultants.
constexpr bool has_tractions(rp_tangential_method theory) {
  return theory == RP_TANGENTIAL_FASTSIM || theory == RP_TANGENTIAL_FASTRIP ||
         theory == RP_TANGENTIAL_FULL;
}
constexpr bool is_fast(rp_tangential_method theory) {
  return theory != RP_TANGENTIAL_NONE && theory != RP_TANGENTIAL_FULL;
}

class fast_solver {
 public:
  fast_solver(const elastic_constants &elastic, const fast_options &options, int max_nx,
              int max_ny);

  // Fills `fields` where the theory has tractions, else `sums`. Not converged: outside the theory's
  // range, the result is there all the same.
  tangential_result solve(const fast_patch &patch, const rolling_input &rolling,
                          tangential_fields fields, creep_resultants &sums);
  // The table of creep forces, where the theory is that.
  const creep_table *table() const { return creep_table_ ? &*creep_table_ : nullptr; }
  size_t bytes() const { return bound_.bytes() + leading_.bytes() + trailing_.bytes(); }

 private:
  struct ellipse {
    double axes[2];    // m
    double centre[2];  // m
  };
  ellipse ellipse_of(const fast_patch &patch) const;
  tangential_result solve_table(const ellipse &e, double capacity, const rolling_input &at_centre,
                                creep_resultants &sums) const;
  flexibilities flexibilities_of(const ellipse &e, const creepage_coefficients &c, double capacity,
                                 const rolling_input &at_centre) const;
  creepage_coefficients coefficients(double axis_ratio) const;
  void set_bound(const fast_patch &patch);
  void find_rows(const fast_patch &patch, int direction);

  elastic_constants elastic_;
  fast_options options_;
  coefficient_table table_;
  std::optional<creep_table> creep_table_;
  aligned_buffer<double> bound_, leading_, trailing_;
};

}  // namespace railpatch
