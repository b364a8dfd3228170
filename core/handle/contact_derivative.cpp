#include "handle/contact_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "handle/case_fields.hpp"
#include "handle/check.hpp"
#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "patch/result_fields.hpp"
#include "patch/status.hpp"
#include "wheel/input_numbers.hpp"

namespace railpatch {

namespace {

// of the steps that differences are taken of; their length is its cube root, which makes the errors
// of rounding and of curvature alike (Press et al. 2007, "Numerical recipes", section 5.7)
constexpr double fine_tolerance = 1e-9;

}  // namespace

derivative_record::derivative_record(const rp_config &config, driver &driver) {
  if (driver.solver().scene().exact) return;
  rp_config own = config;
  own.derivatives = 0;
  own.observer = nullptr;
  own.tolerance = std::min(own.tolerance, fine_tolerance);
  beside = std::make_unique<contact>(own);
  const bool keeps = driver.solver().scene().keeps_steps() || driver.kept().matter();
  if (keeps) before = std::make_unique<contact>(own);
}

size_t derivative_record::bytes() const {
  size_t sum = sizeof *this;
  for (const auto *handle : {&beside, &before}) {
    if (!*handle) continue;
    rp_stage_info stages[RP_STAGE_COUNT];
    (*handle)->describe(stages);
    for (const auto &stage : stages) sum += stage.bytes;
  }
  return sum;
}

bool contact::has_solution() const { return derivative_ && derivative_->solved; }

void contact::begin_record() {
  derivative_->solved = false;
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
  driver_->differentiate(direction, derivative_->input, derivative_->result, out);
  change = out;
  return RP_DERIVATIVE_EXACT;
}

namespace {

// m/s: along x the wheel's surface past the rail's, where it rolls without slip none
double slip_speed(const rp_config &c, const rp_input &in) {
  const double roller = c.track == RP_ROLLER ? c.roller_radius * in.roller_pitch_rate : 0.0;
  return in.speed + c.nominal_radius * in.pitch_rate + roller;
}

// What slip changes by a good part of what matters: some thousandths of the rolling speed, and as
// much as of the lateral velocity.
constexpr double slip_range = 1e-3, slip_scale = 0.01;

double reach_of_slip(const rp_config &c, const rp_input &input, const rp_input &rates) {
  if (c.kind == RP_PATCH) return 0;
  const double turning = c.track == RP_ROLLER ? c.roller_radius * input.roller_pitch_rate : 0.0;
  const double rolling = std::max(std::fabs(input.speed), std::fabs(turning));
  return std::fabs(slip_speed(c, rates)) / std::max(slip_scale, slip_range * rolling);
}

// The length of a direction from an input, in the input's own units. Of speed and pitch rates,
// which nearly cancel, not only their own sizes count.
double reach_of(const rp_config &c, const rp_input &input, const rp_input &rates) {
  double reach = reach_of_slip(c, input, rates);
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
rp_input moved(const rp_config &config, const double bulk_temperature[2], const rp_input &input,
               const rp_input &rates, double place) {
  rp_input in = input;
  const auto given = [](double &value, double usual) {
    if (std::isnan(value)) value = usual;
  };
  given(in.water_rate, config.fluid_water_rate);
  given(in.water_temperature, config.fluid_temperature);
  given(in.oil_film, config.fluid_oil_film);
  const double *rate[input_numbers];
  int count = 0, next = 0;
  for_each_number(rates, [&](const char *, const double &v, double) { rate[count++] = &v; });
  for_each_number(in, [&](const char *, double &v, double) { v += place * *rate[next++]; });
  for (int body = 0; body < 2; ++body)
    if (std::isnan(in.bulk_temperature[body]) && rates.bulk_temperature[body] != 0)
      in.bulk_temperature[body] = bulk_temperature[body] + place * rates.bulk_temperature[body];
  return in;
}

bool moves_places_alone(const rp_input &rates) {
  bool alone = true;
  for_each_number(rates, [&](const char *name, const double &rate, double) {
    alone = alone && (rate == 0 || is_place(name));
  });
  return alone;
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
  for_each_number(rates, [](const char *, double &rate, double) {
    if (std::isnan(rate)) rate = 0;
  });
  const double reach = reach_of(config_, record.input, rates);
  if (!(reach > 0)) return;
  if (!record.before && driver_->uniform_along() && moves_places_alone(rates)) return;
  const double length = cbrt(beside.tolerance_) / reach;
  rp_result ends[2];
  double places[2] = {-length, length};
  bool failed = false;
  for (int k = 0; k < 2; ++k) {
    rp_input in = moved(config_, bulk_temperature_, record.input, rates, places[k]);
    double friction = friction_coefficient() + std::exchange(in.friction_coefficient, 0.0);
    if (check_input(config_, friction, in, nullptr) != RP_OK ||
        check_friction_coefficient(friction, nullptr) != RP_OK) {
      in = record.input;
      friction = friction_coefficient();
      places[k] = 0;
    }
    // whatever an interrupted one has left there
    if (derivative_->broken) beside.reset();
    beside.copy_state(start);
    derivative_->broken = true;
    // on the grid that the last step ended on, whatever the estimate
    if (beside.level_ != level_) beside.go_on(level_);
    beside.set_friction_coefficient(friction);
    ends[k] = beside.solve(in);
    derivative_->broken = false;
    const rp_status status = ends[k].status;
    failed = failed || status == RP_NOT_CONVERGED || status == RP_OUT_OF_RANGE;
  }
  if (places[1] > places[0]) {
    divide(ends, places[1] - places[0], out);
  } else {
    // neither side is allowed
    for_each_result_number(out, [](double &v) { v = nan; });
    failed = true;
  }
  if (!failed) return;
  fail_rates(out);
  for (int side = 0; side < 2; ++side)
    if (driver_->find(side, 0)) fail_rates_of_wheel(out.side[side]);
}

}  // namespace railpatch
