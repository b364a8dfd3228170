// Communication steps: inputs by their derivatives, sub-steps, means over a step.
#include <algorithm>
#include <cmath>

#include "instance.hpp"

namespace railpatch::fmu {

fmi2Status Instance::step(double time, double step) {
  const Call &call = call::do_step;
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
  const fmi2Status status = march(time, step);
  if (status == fmi2OK) time_ = end;
  if (status == fmi2Discard) mode_ = Mode::step_failed;
  if (status == fmi2Error) mode_ = Mode::error;
  return status;
}

int Instance::step_count(bool moving) const {
  // without history only the end counts, but for means
  const int index = index_of(reference::substeps);
  if (index < 0 || !(options_.history != 0 || moving)) return 1;
  return static_cast<int>(values_[static_cast<size_t>(index)]);
}

// Means are those of the trapezoidal rule where inputs move, which then do not jump; of inputs that
// are held from the step's start on, means of the sub-steps' ends.
fmi2Status Instance::march(double time, double step) {
  const Call &call = call::do_step;
  const bool moving = std::any_of(input_derivatives_.begin(), input_derivatives_.end(),
                                  [](double d) { return d != 0; });
  const int count = step_count(moving);
  std::vector<double> means(means_.size());
  for (size_t i = 0; moving && i < means.size(); ++i) means[i] = 0.5 * values_[means_[i].second];
  for (int k = 1; k <= count; ++k) {
    const double past = k == count ? step : step * k / count;
    fmi2Status status = extrapolate(call, time + past, past);
    if (status == fmi2OK) status = advance(call, time + past, step / count);
    if (status != fmi2OK) return status;
    const double weight = moving && k == count ? 0.5 : 1.0;
    for (size_t i = 0; i < means.size(); ++i)
      means[i] += weight * output_of(outputs_, *variables_[means_[i].second].variable);
  }
  publish();
  for (size_t i = 0; i < means.size(); ++i) values_[means_[i].first] = means[i] / count;
  end_inputs(moving, step);
  return fmi2OK;
}

// Fills at_ with the values a time after the step's start.
fmi2Status Instance::extrapolate(const Call &call, double time, double past) {
  for (size_t i = 0; i < known_; ++i) {
    const double *d = input_derivatives_.data() + orders * i;
    const double value = values_[i] + past * (d[0] + past * (d[1] / 2 + past * d[2] / 6));
    // what is held keeps its bits
    at_[i] = d[0] == 0 && d[1] == 0 && d[2] == 0 ? values_[i] : value;
    const Variable &variable = *variables_[i].variable;
    if (at_[i] >= variable.low && at_[i] <= variable.high) continue;
    solution_ = Solution::none;
    log_.say(fmi2Discard, Category::discard,
             std::string(call.name) + ": " + variables_[i].name + " by its derivatives is " +
                 text_of(value) + " at time " + text_of(time) + ", allowed " +
                 text_of(variable.low) + " ... " + text_of(variable.high) +
                 ": take a smaller step or smaller derivatives");
    return fmi2Discard;
  }
  return fmi2OK;
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

fmi2Status Instance::set_input_derivatives(const fmi2ValueReference *references, size_t count,
                                           const fmi2Integer *order, const double *values) {
  const Call &call = call::input_derivatives;
  if (count == 0) return fmi2OK;
  if (references == nullptr || order == nullptr || values == nullptr)
    return refuse(call, references == nullptr
                            ? "vr is NULL"
                            : (order == nullptr ? "order is NULL" : "value is NULL"));
  for (size_t i = 0; i < count; ++i) {
    if (find_input(call, references[i]) < 0) return fmi2Error;
    if (order[i] < 1 || order[i] > static_cast<fmi2Integer>(orders))
      return refuse(
          call, "order is " + text_of_whole(order[i]) + ", allowed 1 ... " + text_of_whole(orders));
    if (!std::isfinite(values[i]))
      return refuse(call, "value is " + text_of(values[i]) + ", allowed a finite number");
  }
  for (size_t i = 0; i < count; ++i)
    input_derivatives_[orders * static_cast<size_t>(index_of(references[i])) +
                       static_cast<size_t>(order[i] - 1)] = values[i];
  return fmi2OK;
}

}  // namespace railpatch::fmu
