#include "handle/contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "handle/check.hpp"
#include "handle/contact_derivative.hpp"
#include "handle/warnings.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

// Excess below which the next step begins on a coarser grid, whose estimate is some 1.8 times as
// great: two thirds of what is allowed, so that it does not come back at once; and below which a
// table takes over again.
constexpr double sure_of_coarser = 0.37, sure_of_closed = 0.67;

std::unique_ptr<driver> make_driver(const scene &made, const fft_plans &plans) {
  if (made.single)
    return std::make_unique<single_patch>(*made.single, made.patch, plans, made.marks);
  return std::make_unique<wheels>(*made.wheels, made.patch, plans, made.marks);
}

}  // namespace

contact::grid_level::grid_level(const scene &made)
    : plans(made.transforms[0], made.transforms[1]), solver(make_driver(made, plans)) {}

contact::contact(const rp_config &config)
    : config_(config), warnings_(warnings_of_case(config)), fingerprint_(fingerprint(config)) {
  const std::vector<rp_config> configs = configs_of_levels(config);
  for (const rp_config &c : configs) {
    const scene made = scene_of(c);
    levels_.push_back(std::make_unique<grid_level>(made));
    tolerance_ = made.tolerance;
    largest_ = {std::max(largest_.nx, made.largest.nx), std::max(largest_.ny, made.largest.ny)};
    std::copy_n(made.bulk_temperature, 2, bulk_temperature_);
  }
  select(0);
  noted_.resize(driver_->kept().all_bytes());
  if (config.derivatives != 0) derivative_ = std::make_unique<derivative_record>(config, *driver_);
  // nothing else of the caller's memory is kept than the creep table
  config_.undeformed_distance = config_.influence_coefficients = nullptr;
  for (auto *p : {&config_.wheel[0], &config_.wheel[1], &config_.rail[0], &config_.rail[1]})
    *p = rp_profile{};
  for (int side = 0; side < 2; ++side) {
    config_.rail_sections[side] = nullptr;
    config_.section_position[side] = nullptr;
    config_.wheel_sections[side] = nullptr;
    config_.wheel_section_angle[side] = nullptr;
    config_.section_kink[side] = config_.wheel_section_kink[side] = nullptr;
    config_.runout[side] = config_.rail_height[side] = nullptr;
  }
}

contact::~contact() = default;

const patch_memory *contact::solution(int side, int patch) const {
  const patch_memory *found = driver_->find(side, patch);
  return found && found->solved ? found : nullptr;
}

void contact::step(const rp_input &input, rp_result &result) {
  if (derivative_) begin_record();
  rp_result out = config_.accuracy > 0 ? solve_to_accuracy(input) : solve(input);
  report_warnings(config_, warnings_ | warnings_of_film(config_, solution(RP_RIGHT, 0), out), input,
                  friction_coefficient(), out);
  result = out;
  if (derivative_) end_record(input, out);
}

// On the present grid.
rp_result contact::solve(const rp_input &input) {
  rp_result out = empty_result();
  for (auto &m : driver_->memories()) m.solved = m.counted = false;
  for (int k = 0; k < 2; ++k) {
    const double given = input.bulk_temperature[k];
    driver_->solver().set_bulk_temperature(k, std::isnan(given) ? bulk_temperature_[k] : given);
  }
  if (config_.fluid_model != RP_FLUID_NONE) {
    const auto now = [](double given, double usual) { return std::isnan(given) ? usual : given; };
    driver_->solver().set_fluid_supply({now(input.water_rate, config_.fluid_water_rate),
                                        now(input.water_temperature, config_.fluid_temperature),
                                        now(input.oil_film, config_.fluid_oil_film),
                                        input.rail_work[RP_RIGHT]});
  }
  driver_->step(input, out);
  return out;
}

// From the last step's grid to finer ones until the estimate is small enough.
rp_result contact::solve_to_accuracy(const rp_input &input) {
  rp_result out;
  if (solve_closed(input, out)) return out;
  const size_t coarsest = uses_table(config_) ? 1 : 0;
  if (level_ > coarsest && excess_ < sure_of_coarser) go_on(level_ - 1);
  note_kept();
  out = solve(input);
  excess_ = excess(out);
  while (excess_ > 1 && std::isfinite(excess_) && level_ + 1 < levels_.size()) {
    go_on(level_ + 1);
    take_noted();
    const rp_result finer = solve(input);
    if (finer.status == RP_NOT_CONVERGED || finer.status == RP_OUT_OF_RANGE) {
      // a solution that is not as accurate is worth more than none
      select(level_ - 1);
      break;
    }
    out = finer;
    excess_ = excess(out);
  }
  if (excess_ > 1) report_inaccurate(friction_of_sides(), config_.accuracy, out);
  return out;
}

// A table costs nothing beside a grid and is asked first. Once it was not good enough it has to be
// so by some margin, lest a smooth run alternates. Returns whether that is all.
bool contact::solve_closed(const rp_input &input, rp_result &out) {
  if (level_ == 0 || !uses_table(config_)) return false;
  const size_t last = level_;
  carry_kept(*levels_[last]->solver, *levels_[0]->solver);
  select(0);
  out = solve(input);
  const double found = excess(out);
  if (out.status != RP_NOT_CONVERGED && out.status != RP_OUT_OF_RANGE && found < sure_of_closed) {
    excess_ = found;
    return true;
  }
  select(last);
  return false;
}

double contact::excess(const rp_result &result) const {
  return excess_of(result, friction_of_sides(), config_.accuracy);
}

std::array<double, 2> contact::friction_of_sides() const {
  const double coefficient = patch().coefficient();
  return {coefficient * driver_->friction_scale(RP_LEFT),
          coefficient * driver_->friction_scale(RP_RIGHT)};
}

void contact::select(size_t level) {
  level_ = level;
  driver_ = levels_[level]->solver.get();
}

// With what the present level found as a start.
void contact::go_on(size_t level) {
  carry_over(*driver_, *levels_[level]->solver);
  select(level);
}

void contact::set_friction_coefficient(double value) {
  // derivatives are those of the coefficient that the last step was solved with
  if (derivative_ && value != friction_coefficient()) derivative_->solved = false;
  for (auto &level : levels_) level->solver->solver().set_friction_coefficient(value);
}

void contact::reset() {
  for (auto &level : levels_) {
    for (auto &m : level->solver->memories()) {
      m.warm = m.solved = false;
      m.history.clear();
      if (m.heat) m.heat->clear();
    }
    level->solver->reset();
  }
  select(0);
  excess_ = 0;
  if (derivative_) derivative_->solved = false;
}

void contact::note_kept() {
  const driver::kept_numbers kept = driver_->kept();
  if (kept.bytes) std::memcpy(noted_.data(), kept.more, kept.bytes);
  if (kept.heat_bytes) std::memcpy(noted_.data() + kept.bytes, kept.heat, kept.heat_bytes);
}

void contact::take_noted() {
  const driver::kept_numbers kept = driver_->kept();
  if (kept.bytes) std::memcpy(kept.more, noted_.data(), kept.bytes);
  if (kept.heat_bytes) std::memcpy(kept.heat, noted_.data() + kept.bytes, kept.heat_bytes);
}

}  // namespace railpatch
