// FASTSIM, the simplified theory of rolling contact (Kalker 1982, Vehicle System Dynamics 11), with
// three flexibilities L1, L2, L3 from Kalker's creepage coefficients, marched along the rows of the
// uniform grid from the leading edge.
#pragma once

#include "tangential.hpp"

namespace railpatch {

// Kalker's coefficients C11, C22, C23 (Kalker 1990, table E3), interpolated in ln(a/b) and
// Poisson's ratio. in_range is false where a/b is outside the table, 0.1 ... 10.
struct kalker_coefficients {
  double c11, c22, c23;
  bool in_range;
};
kalker_coefficients interpolate_kalker(double axis_ratio, double poisson_ratio);

// leading: x of the contact's leading edge in each row (m), [ny]; see tangential.hpp for the rest.
// semi_axes: of the ellipse (or the equivalent one) that sets the flexibilities.
tangential_result fastsim(const elastic_constants &elastic, const grid &g, const double *pressure,
                          const double *bound, const double *leading, const double semi_axes[2],
                          const rolling_input &input, tangential_fields fields);

}  // namespace railpatch
