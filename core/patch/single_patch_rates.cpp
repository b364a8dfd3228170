// Rates of a patch given directly, by the load, the motion and the friction.
#include <algorithm>
#include <cmath>

#include "numeric/nan.hpp"
#include "patch/creep_power.hpp"
#include "patch/report.hpp"
#include "patch/result_sums.hpp"
#include "patch/single_patch.hpp"
#include "patch/status.hpp"

namespace railpatch {

size_t single_patch::derivative_bytes() const {
  return solver_.derivative_bytes() +
         (rates_ ? rates_->distance.bytes() + rates_->row_friction.bytes() : 0);
}

// Of ellipse, curvatures and line contact with the load's rate.
hertz_contact single_patch::hertz_rate(const hertz_contact &hertz, const rp_input &d) const {
  const double none[2] = {0, 0};
  const bool force = setup_.force_given;
  switch (setup_.geometry) {
    case RP_SEMI_AXES:
      return hertz_rate_of_ellipse(
          hertz, force ? d.normal_force : hertz.normal_force * d.approach / hertz.approach);
    case RP_CURVATURES:
      return force ? hertz_rate_of_force(hertz, none, d.normal_force)
                   : hertz_rate_of_approach(hertz, none, d.approach);
    case RP_LINE_CONTACT:
      return hertz_rate_of_line(hertz, d.normal_force);
    case RP_UNDEFORMED_DISTANCE:
      break;
  }
  return {};
}

// How the grid, its distance and the friction of its rows follow Hertz's contact.
void single_patch::vary_shape(const rp_input &d, patch_variation &v) {
  rates &record = *rates_;
  const grid &g = record.problem.g;
  const hertz_contact &hertz = record.problem.hertz;
  v.hertz = hertz_rate(hertz, d);
  // a grid of given elements is as large as the contact
  const int axes = setup_.grid.sized ? 0 : setup_.geometry == RP_LINE_CONTACT ? 1 : 2;
  const double step[2] = {g.dx, g.dy};
  const int count[2] = {g.nx, g.ny};
  for (int k = 0; k < axes; ++k) {
    v.size[k] = step[k] * v.hertz.semi_axes[k] / hertz.semi_axes[k];
    v.origin[k] = -0.5 * (count[k] - 1) * v.size[k];
  }
  bool moves = false;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double x = g.x(i), y = g.y(j);
      const double dx = v.origin[0] + i * v.size[0], dy = v.origin[1] + j * v.size[1];
      const double rate = v.hertz.curvatures[0] * x * x + v.hertz.curvatures[1] * y * y +
                          2.0 * (hertz.curvatures[0] * x * dx + hertz.curvatures[1] * y * dy);
      record.distance[static_cast<size_t>(j * g.nx + i)] = rate;
      moves = moves || rate != 0;
    }
  if (moves) v.distance = record.distance.data();
  if (record.row_friction.size() == 0 || v.size[1] == 0) return;
  for (int j = 0; j < g.ny; ++j)
    record.row_friction[static_cast<size_t>(j)] =
        solver_.scene().friction_variation.slope(g.y(j)) * (v.origin[1] + j * v.size[1]);
  v.row_friction = record.row_friction.data();
}

void single_patch::differentiate(const rp_input &d, const rp_input &, const rp_result &result,
                                 rp_result &out) {
  const patch_problem &problem = rates_->problem;
  const patch_memory &m = memory();
  rp_side_result &side = out.side[RP_RIGHT];
  rp_patch_result &change = side.patch[0];
  const rp_patch_result value = result.side[RP_RIGHT].patch[0];
  const auto set = [](double value_of, double &rate, double v) {
    if (!std::isnan(value_of)) rate = v;
  };
  for (int k = 0; k < 2; ++k) set(value.creepage[k], change.creepage[k], d.creepage[k]);
  set(value.spin_creepage, change.spin_creepage, d.spin_creepage);
  set(value.rolling_speed, change.rolling_speed, d.rolling_speed);
  if (!setup_.force_given) set(value.approach, change.approach, d.approach);
  if (!m.solved || (problem.g.count() == 0 && !solver_.scene().closed_form())) return;
  patch_variation v;
  v.normal_force = d.normal_force;
  v.approach = d.approach;
  std::copy_n(d.creepage, 2, v.creepage);
  v.spin_creepage = d.spin_creepage;
  v.rolling_speed = d.rolling_speed;
  v.friction = {d.friction_coefficient, d.friction_scale[RP_RIGHT], d.water_rate,
                d.water_temperature, d.oil_film};
  if (setup_.geometry != RP_UNDEFORMED_DISTANCE) vary_shape(d, v);
  patch_change found;
  const derivative_outcome outcome = solver_.differentiate(problem, m, &v, 1, {}, &found);
  if (!outcome.converged) {
    fail_rates(out);
    fail_rates_of_wheel(side);
  }
  report_rates(value, found, change);
  set(value.approach, change.approach, found.approach);
  for (int k = 0; k < 2; ++k) {
    set(value.element_size[k], change.element_size[k], v.size[k]);
    set(value.grid_origin[k], change.grid_origin[k], v.origin[k]);
  }
  set(value.creep_power, change.creep_power, creep_power_rate(value, change));
  set(value.wear_number, change.wear_number, wear_number_rate(value, change));
  sum_patch_rates(result.side[RP_RIGHT], side);
  sum_up(result, out);
}

}  // namespace railpatch
