// Derivatives of wheels by pose and velocity at once.
#include "handle/contact_derivative.hpp"
#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"
#include "wheel/jacobian_columns.hpp"

namespace railpatch {

void contact::jacobian(rp_jacobian &out) {
  rp_jacobian found{};
  found.status = derivative_->result.status;
  found.z_force = nan;
  if (derivative_->beside) {
    jacobian_by_differences(found);
  } else {
    found.kind = RP_DERIVATIVE_EXACT;
    driver_->jacobian(derivative_->input, derivative_->result, found);
  }
  out = found;
}

void contact::jacobian_by_differences(rp_jacobian &out) {
  out.kind = RP_DERIVATIVE_BY_DIFFERENCES;
  const bool forced = driver_->finds_height();
  for (int column = 0; column < jacobian_columns; ++column) {
    rp_result change = rates_of_nothing(derivative_->result);
    if (!(forced && column == z_column))
      differentiate_by_differences(unit_direction(derivative_->input, column), change);
    if (change.status == RP_NOT_CONVERGED) out.status = change.status;
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < 6 && driver_->find(side, 0); ++i)
        out.side[side][i][column] =
            forced && column == z_column ? nan : component(change.side[side], i);
    out.z[column] = change.z;
  }
  if (!forced) return;
  rp_input by_force = unit_direction(derivative_->input, z_column);
  by_force.z = 0;
  by_force.vertical_force = 1.0;
  rp_result change = rates_of_nothing(derivative_->result);
  differentiate_by_differences(by_force, change);
  out.z_force = change.z;
}

}  // namespace railpatch
