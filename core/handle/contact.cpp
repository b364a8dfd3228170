#include "handle/contact.hpp"

#include <algorithm>
#include <cmath>

#include "handle/contact_derivative.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

std::unique_ptr<driver> make_driver(const scene &made, const fft_plans &plans) {
  if (made.single)
    return std::make_unique<single_patch>(*made.single, made.patch, plans, made.marks);
  return std::make_unique<wheels>(*made.wheels, made.patch, plans, made.marks);
}

}  // namespace

contact::contact(const rp_config &config, const scene &made)
    : config_(config),
      fingerprint_(fingerprint(config)),
      plans_(made.transforms[0], made.transforms[1]),
      driver_(make_driver(made, plans_)),
      tolerance_(made.tolerance),
      bulk_temperature_{made.bulk_temperature[0], made.bulk_temperature[1]} {
  if (config.derivatives != 0) derivative_ = std::make_unique<derivative_record>(config, *driver_);
  // nothing else of the caller's memory is kept than the creep table
  config_.undeformed_distance = nullptr;
  for (auto *p : {&config_.wheel[0], &config_.wheel[1], &config_.rail[0], &config_.rail[1]})
    *p = rp_profile{};
  for (int side = 0; side < 2; ++side) {
    config_.rail_sections[side] = nullptr;
    config_.section_position[side] = nullptr;
    config_.runout[side] = config_.rail_height[side] = nullptr;
  }
}

contact::~contact() = default;

void contact::step(const rp_input &input, rp_result &result) {
  if (derivative_) begin_record();
  rp_result out = empty_result();
  for (auto &m : driver_->memories()) m.solved = false;
  for (int k = 0; k < 2; ++k) {
    const double given = input.bulk_temperature[k];
    driver_->solver().set_bulk_temperature(k, std::isnan(given) ? bulk_temperature_[k] : given);
  }
  driver_->step(input, out);
  result = out;
  if (derivative_) end_record(input, out);
}

void contact::set_friction_coefficient(double value) {
  // derivatives are those of the coefficient that the last step was solved with
  if (derivative_ && value != friction_coefficient()) derivative_->solved = false;
  driver_->solver().set_friction_coefficient(value);
}

void contact::reset() {
  for (auto &m : driver_->memories()) {
    m.warm = m.solved = false;
    m.history.clear();
    if (m.heat) m.heat->clear();
  }
  driver_->reset();
  if (derivative_) derivative_->solved = false;
}

}  // namespace railpatch
