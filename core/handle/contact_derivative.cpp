#include "handle/contact_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

// of the steps that differences are taken of; their length is its cube root, which makes the errors
// of rounding and of curvature alike (Press et al. 2007, "Numerical recipes", section 5.7)
constexpr double fine_tolerance = 1e-9;

// Of ellipse, curvatures and line contact with the load's rate.
hertz_contact hertz_rate(const rp_config &c, const hertz_contact &hertz, const rp_input &d) {
  const double none[2] = {0, 0};
  const bool force = c.load == RP_FORCE;
  switch (c.geometry) {
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

}  // namespace

derivative_record::derivative_record(const rp_config &config, const patch_scene &scene, bool exact,
                                     int max_nx, int max_ny) {
  const auto count = static_cast<size_t>(max_nx * max_ny);
  if (scene.differentiates() && exact && config.kind != RP_PATCH) {
    wheels = std::make_unique<wheel_derivative>(scene, max_nx * max_ny, max_ny);
    changes.resize(2 * static_cast<size_t>(wheel_derivative::most_directions));
    return;
  }
  if (scene.differentiates() && config.kind == RP_PATCH) {
    distance = aligned_buffer<double>(count);
    if (scene.friction_variation.varies()) row_friction = aligned_buffer<double>(count);
    return;
  }
  rp_config own = config;
  own.derivatives = 0;
  own.observer = nullptr;
  own.tolerance = std::min(own.tolerance, fine_tolerance);
  beside = std::make_unique<contact>(own);
  if (scene.keeps_steps() || rail_support::asked(config)) before = std::make_unique<contact>(own);
}

size_t derivative_record::bytes() const {
  size_t sum = sizeof *this + distance.bytes() + row_friction.bytes() +
               (wheels ? wheels->bytes() : 0) + changes.size() * sizeof(rp_side_result);
  for (const auto *handle : {&beside, &before}) {
    if (!*handle) continue;
    rp_stage_info stages[RP_STAGE_COUNT];
    (*handle)->describe(stages);
    for (const auto &stage : stages) sum += stage.bytes;
  }
  return sum;
}

size_t contact::derivative_bytes() const {
  return solver_.derivative_bytes() + (derivative_ ? derivative_->bytes() : 0);
}

bool contact::has_solution() const { return derivative_ && derivative_->solved; }

void contact::begin_record() {
  derivative_->solved = false;
  derivative_->problem = {};
  if (derivative_->before) derivative_->before->copy_state(*this);
}

void contact::end_record(const rp_input &input, const rp_result &result) {
  derivative_->input = input;
  derivative_->result = result;
  derivative_->solved = true;
}

rp_derivative_kind contact::differentiate(const rp_input &direction, rp_result &change) {
  rp_result out = rates_of_nothing(derivative_->result);
  if (derivative_->beside) {
    differentiate_by_differences(direction, out);
    change = out;
    return RP_DERIVATIVE_BY_DIFFERENCES;
  }
  config_.kind == RP_PATCH ? differentiate_patch(direction, out)
                           : differentiate_wheels(direction, out);
  change = out;
  return RP_DERIVATIVE_EXACT;
}

// How the grid, its distance and the friction of its rows follow Hertz's contact.
void contact::vary_shape(const rp_input &d, patch_variation &v) {
  derivative_record &record = *derivative_;
  const grid &g = record.problem.g;
  const hertz_contact &hertz = record.problem.hertz;
  v.hertz = hertz_rate(config_, hertz, d);
  // a grid of given elements is as large as the contact
  const int axes = config_.element_size[0] > 0 ? 0 : config_.geometry == RP_LINE_CONTACT ? 1 : 2;
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

void contact::differentiate_patch(const rp_input &d, rp_result &out) {
  derivative_record &record = *derivative_;
  const patch_problem &problem = record.problem;
  const patch_memory &m = memory(RP_RIGHT, 0);
  rp_side_result &side = out.side[RP_RIGHT];
  rp_patch_result &change = side.patch[0];
  const rp_patch_result value = record.result.side[RP_RIGHT].patch[0];
  const auto set = [](double value_of, double &rate, double v) {
    if (!std::isnan(value_of)) rate = v;
  };
  for (int k = 0; k < 2; ++k) set(value.creepage[k], change.creepage[k], d.creepage[k]);
  set(value.spin_creepage, change.spin_creepage, d.spin_creepage);
  set(value.rolling_speed, change.rolling_speed, d.rolling_speed);
  if (config_.load == RP_POSITION) set(value.approach, change.approach, d.approach);
  if (!m.solved || problem.g.count() == 0) return;
  patch_variation v;
  v.normal_force = d.normal_force;
  v.approach = d.approach;
  std::copy_n(d.creepage, 2, v.creepage);
  v.spin_creepage = d.spin_creepage;
  v.rolling_speed = d.rolling_speed;
  v.friction_coefficient = friction_rate(d);
  if (config_.geometry != RP_UNDEFORMED_DISTANCE) vary_shape(d, v);
  patch_change found;
  const derivative_outcome outcome = solver_.differentiate(problem, m, &v, 1, {}, &found);
  if (!outcome.converged) {
    for (rp_status *status : {&out.status, &side.status, &change.status})
      if (*status == RP_CONVERGED) *status = RP_NOT_CONVERGED;
  }
  set(value.normal_force, change.normal_force, found.normal_force);
  set(value.approach, change.approach, found.approach);
  for (int k = 0; k < 2; ++k) {
    set(value.creep_force[k], change.creep_force[k], found.creep_force[k]);
    set(value.element_size[k], change.element_size[k], v.size[k]);
    set(value.grid_origin[k], change.grid_origin[k], v.origin[k]);
  }
  set(value.spin_moment, change.spin_moment, found.spin_moment);
  set(value.max_pressure, change.max_pressure, found.max_pressure);
  set(value.contact_area, change.contact_area, found.contact_area);
  set(value.friction_power, change.friction_power, found.friction_power);
  set(value.elastic_energy, change.elastic_energy, found.elastic_energy);
}

namespace {

// The length of a direction from an input, in the input's own units.
double reach_of(const rp_input &input, const rp_input &rates) {
  double reach = 0;
  const double *values[input_numbers];
  int numbers = 0;
  for_each_number(input, [&](const char *, const double &v, double) { values[numbers++] = &v; });
  int at = 0;
  for_each_number(rates, [&](const char *name, const double &rate, double scale) {
    const double v = *values[at++];
    // how far along the track, or round the wheel, says nothing about the scale there
    const double size = is_place(name) || std::isnan(v) ? scale : std::max(scale, std::fabs(v));
    if (rate != 0) reach = std::max(reach, std::fabs(rate) / (size > 0 ? size : 1.0));
  });
  return reach;
}

// The input at a place along a direction from another.
rp_input moved(const rp_config &config, const rp_input &input, const rp_input &rates,
               double place) {
  rp_input in = input;
  const double *rate[input_numbers];
  int count = 0, next = 0;
  for_each_number(rates, [&](const char *, const double &v, double) { rate[count++] = &v; });
  for_each_number(in, [&](const char *, double &v, double) { v += place * *rate[next++]; });
  for (int body = 0; body < 2; ++body)
    if (std::isnan(in.bulk_temperature[body]) && rates.bulk_temperature[body] != 0)
      in.bulk_temperature[body] =
          config.bulk_temperature[body] + place * rates.bulk_temperature[body];
  return in;
}

// out: rates of all its numbers from two results, a distance apart along the direction.
void divide(const rp_result (&ends)[2], double distance, rp_result &out) {
  double *to[result_numbers];
  int count = 0, next = 0;
  for_each_result_number(out, [&](double &v) { to[count++] = &v; });
  const double *low[result_numbers];
  for_each_result_number(ends[0], [&](const double &v) { low[next++] = &v; });
  next = 0;
  for_each_result_number(ends[1], [&](const double &v) {
    double &rate = *to[next];
    if (!std::isnan(rate)) rate = (v - *low[next]) / distance;
    ++next;
  });
}

}  // namespace

// Central differences of steps beside the last one, each from the same start; one-sided where the
// input on one side is not allowed.
void contact::differentiate_by_differences(const rp_input &d, rp_result &out) {
  derivative_record &record = *derivative_;
  contact &beside = *record.beside;
  const contact &start = record.before ? *record.before : *this;
  rp_input rates = d;
  for (double &rate : rates.bulk_temperature)
    if (std::isnan(rate)) rate = 0;
  const double reach = reach_of(record.input, rates);
  if (!(reach > 0)) return;
  const double length = std::cbrt(beside.config().tolerance) / reach;
  rp_result ends[2];
  double places[2] = {-length, length};
  rp_status worst = RP_CONVERGED;
  for (int k = 0; k < 2; ++k) {
    rp_input in = moved(config_, record.input, rates, places[k]);
    double friction = friction_coefficient() + std::exchange(in.friction_coefficient, 0.0);
    if (check_input(config_, friction, in, nullptr) != RP_OK ||
        check_friction_coefficient(friction, nullptr) != RP_OK) {
      in = record.input;
      friction = friction_coefficient();
      places[k] = 0;
    }
    beside.copy_state(start);
    beside.set_friction_coefficient(friction);
    beside.step(in, ends[k]);
    if (ends[k].status == RP_NOT_CONVERGED || ends[k].status == RP_OUT_OF_RANGE)
      worst = RP_NOT_CONVERGED;
  }
  if (places[1] > places[0]) {
    divide(ends, places[1] - places[0], out);
  } else {
    // neither side is allowed
    for_each_result_number(out, [](double &v) { v = nan; });
    worst = RP_NOT_CONVERGED;
  }
  if (worst == RP_CONVERGED) return;
  const auto is_good = [](rp_status s) { return s == RP_CONVERGED || s == RP_NO_CONTACT; };
  if (is_good(out.status)) out.status = worst;
  for (auto &side : out.side)
    if (is_good(side.status)) side.status = worst;
}

}  // namespace railpatch
