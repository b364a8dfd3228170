// Communication steps: inputs by their derivatives, sub-steps, means over a step.
#include <algorithm>
#include <cmath>

#include "instance.hpp"

namespace railpatch::fmu {

Status Instance::step(const Call &call, double time, double step) {
  if (!(step > 0) || !std::isfinite(step))
    return refuse(call, "communicationStepSize is " + text_of(step) + ", allowed > 0");
  // masters add up time in their own way
  const double slack = 1e-6 * step + 1e-9 * std::abs(time_);
  if (!(std::abs(time - time_) <= slack))
    return refuse(call, "currentCommunicationPoint is " + text_of(time) + ", but the time is " +
                            text_of(time_));
  const double end = time + step;
  if (stop_defined_ && end > stop_ + slack)
    return refuse(call, "the step ends at " + text_of(end) + ", after stopTime " + text_of(stop_));
  // what FMI 3.0 discards never was
  const bool kept = version_ == 3;
  const Solution solution = solution_;
  Status status = kept ? keep_state(call) : Status::ok;
  if (status == Status::ok) status = march(call, time, step);
  if (status == Status::ok) time_ = end;
  if (status == Status::discard && kept)
    status = take_back(call, solution);
  else if (status == Status::discard)
    mode_ = Mode::step_failed;
  if (status == Status::error) mode_ = Mode::error;
  return status;
}

Status Instance::keep_state(const Call &call) {
  before_ = pending_;
  if (!before_.empty()) return Status::ok;
  before_.resize(rp_state_size(contact_.get()));
  const rp_error error = rp_save_state(contact_.get(), before_.data(), before_.size());
  return error == RP_OK ? Status::ok : refuse(call, rp_error_text(error));
}

// The contact as before the step; its solution is found again where derivatives ask for it.
Status Instance::take_back(const Call &call, Solution solution) {
  pending_.clear();
  const rp_error error = rp_restore_state(contact_.get(), before_.data(), before_.size());
  if (error != RP_OK) return refuse(call, rp_error_text(error));
  solution_ = solution == Solution::none ? Solution::none : Solution::lost;
  return Status::discard;
}

int Instance::step_count(bool moving) const {
  // without history only the end counts, but for means
  const int index = index_of(reference::substeps);
  if (index < 0 || !(options_.history != 0 || moving)) return 1;
  return static_cast<int>(values_[static_cast<size_t>(index)]);
}

// Means are those of the trapezoidal rule where inputs move, which then do not jump; of inputs that
// are held from the step's start on, means of the sub-steps' ends.
Status Instance::march(const Call &call, double time, double step) {
  const bool moving = std::any_of(input_derivatives_.begin(), input_derivatives_.end(),
                                  [](double d) { return d != 0; });
  const int count = step_count(moving);
  std::vector<double> means(means_.size());
  for (size_t i = 0; moving && i < means.size(); ++i) means[i] = 0.5 * values_[means_[i].second];
  for (int k = 1; k <= count; ++k) {
    const double past = k == count ? step : step * k / count;
    Status status = extrapolate(call, time + past, past);
    if (status == Status::ok) status = advance(call, time + past, step / count);
    if (status != Status::ok) return status;
    const double weight = moving && k == count ? 0.5 : 1.0;
    for (size_t i = 0; i < means.size(); ++i)
      means[i] += weight * output_of(outputs_, *variables_[means_[i].second].variable);
  }
  publish();
  for (size_t i = 0; i < means.size(); ++i) values_[means_[i].first] = means[i] / count;
  end_inputs(moving, step);
  return Status::ok;
}

// Fills at_ with the values a time after the step's start.
Status Instance::extrapolate(const Call &call, double time, double past) {
  for (size_t i = 0; i < known_; ++i) {
    const double *d = input_derivatives_.data() + orders * i;
    const double value = values_[i] + past * (d[0] + past * (d[1] / 2 + past * d[2] / 6));
    // what is held keeps its bits
    at_[i] = d[0] == 0 && d[1] == 0 && d[2] == 0 ? values_[i] : value;
    const Variable &variable = *variables_[i].variable;
    if (at_[i] >= variable.low && at_[i] <= variable.high) continue;
    solution_ = Solution::none;
    log_.say(Status::discard, Category::discard,
             std::string(call.name) + ": " + variables_[i].name + " by its derivatives is " +
                 text_of(value) + " at time " + text_of(time) + ", allowed " +
                 text_of(variable.low) + " ... " + text_of(variable.high) +
                 ": take a smaller step or smaller derivatives");
    return Status::discard;
  }
  return Status::ok;
}

// Inputs go on from where they came to, and are held unless new derivatives are set.
void Instance::end_inputs(bool moving, double step) {
  std::fill(rates_.begin(), rates_.end(), 0.0);
  if (!moving) return;
  for (size_t i = 0; i < known_; ++i) {
    const double *d = input_derivatives_.data() + orders * i;
    rates_[i] = d[0] + step * (d[1] + step * d[2] / 2);
    values_[i] = at_[i];
  }
  std::fill(input_derivatives_.begin(), input_derivatives_.end(), 0.0);
}

Status Instance::set_input_derivatives(const Call &call, const Reference *references, size_t count,
                                       const int32_t *order, const double *values) {
  if (count == 0) return Status::ok;
  if (references == nullptr || order == nullptr || values == nullptr)
    return refuse(call, references == nullptr
                            ? "vr is NULL"
                            : (order == nullptr ? "order is NULL" : "value is NULL"));
  for (size_t i = 0; i < count; ++i) {
    if (find_input(call, references[i]) < 0) return Status::error;
    if (order[i] < 1 || order[i] > static_cast<int32_t>(orders))
      return refuse(
          call, "order is " + text_of_whole(order[i]) + ", allowed 1 ... " + text_of_whole(orders));
    if (!std::isfinite(values[i]))
      return refuse(call, "value is " + text_of(values[i]) + ", allowed a finite number");
  }
  for (size_t i = 0; i < count; ++i)
    input_derivatives_[orders * static_cast<size_t>(index_of(references[i])) +
                       static_cast<size_t>(order[i] - 1)] = values[i];
  return Status::ok;
}

}  // namespace railpatch::fmu
