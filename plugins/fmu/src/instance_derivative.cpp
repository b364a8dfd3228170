// Derivatives of the outputs, from those of the contact. State, outputs and later steps stay as
// they are.
#include <algorithm>
#include <cmath>

#include "instance.hpp"
#include "largest_step.hpp"

namespace railpatch::fmu {

int Instance::find_input(const Call &call, Reference reference) {
  const int index = find(call, Type::real, reference);
  if (index < 0 || is_input(*variables_[static_cast<size_t>(index)].variable)) return index;
  refuse(call, variables_[static_cast<size_t>(index)].name + " is not an input");
  return -1;
}

// The coefficient of friction counts, too: the core has derivatives by it.
int Instance::find_known(const Call &call, Reference reference) {
  return reference == reference::friction_coefficient && index_of(reference) >= 0
             ? index_of(reference)
             : find_input(call, reference);
}

int Instance::find_output(const Call &call, Reference reference) {
  const int index = find(call, Type::real, reference);
  if (index < 0) return index;
  const SceneVariable &item = variables_[static_cast<size_t>(index)];
  const bool output = item.variable->role == Role::output;
  const bool alone =
      item.variable->mean_of > 0 || item.variable->reference == reference::largest_step;
  if (output && !alone) return index;
  refuse(call, item.name + (output ? " has no derivatives" : " is not an output"));
  return -1;
}

// Beside those the discrete outputs, which have steps and no slopes.
int Instance::find_unknown(const Call &call, Reference reference) {
  const int index = index_of(reference);
  if (index < 0) return find_output(call, reference);
  const Variable &variable = *variables_[static_cast<size_t>(index)].variable;
  const bool discrete = variable.type != Type::real && variable.role == Role::output;
  return discrete ? index : find_output(call, reference);
}

Status Instance::directional_derivative(const Call &call, const Reference *unknown,
                                        size_t unknown_count, const Reference *known,
                                        size_t known_count, const double *seed, double *change) {
  if (unknown_count == 0) return Status::ok;
  if (!derivatives_)
    return refuse(call,
                  "is not provided: see providesDirectionalDerivative in "
                  "modelDescription.xml");
  if (unknown == nullptr || change == nullptr)
    return refuse(call, unknown == nullptr ? "vUnknown_ref is NULL" : "dvUnknown is NULL");
  if (known_count > 0 && (known == nullptr || seed == nullptr))
    return refuse(call, known == nullptr ? "vKnown_ref is NULL" : "dvKnown is NULL");
  for (size_t i = 0; i < unknown_count; ++i)
    if (find_unknown(call, unknown[i]) < 0) return Status::error;
  std::vector<double> rates(known_);
  for (size_t i = 0; i < known_count; ++i) {
    const int index = find_known(call, known[i]);
    if (index < 0) return Status::error;
    if (!std::isfinite(seed[i]))
      return refuse(call, "dvKnown is " + text_of(seed[i]) + ", allowed a finite number");
    rates[static_cast<size_t>(index)] += seed[i];
  }
  const Status status = differentiate(call, rates);
  for (size_t i = 0; i < unknown_count && status == Status::ok; ++i)
    change[i] = rate_of(unknown[i]);
  return status;
}

Status Instance::output_derivatives(const Call &call, const Reference *references, size_t count,
                                    const int32_t *order, double *values) {
  if (count == 0) return Status::ok;
  if (!derivatives_)
    return refuse(call, "is not provided: see maxOutputDerivativeOrder in modelDescription.xml");
  if (references == nullptr || order == nullptr || values == nullptr)
    return refuse(call, references == nullptr
                            ? "vr is NULL"
                            : (order == nullptr ? "order is NULL" : "value is NULL"));
  for (size_t i = 0; i < count; ++i) {
    if (find_output(call, references[i]) < 0) return Status::error;
    if (order[i] != 1) return refuse(call, "order is " + text_of_whole(order[i]) + ", allowed 1");
  }
  const Status status = differentiate(call, rates_);
  for (size_t i = 0; i < count && status == Status::ok; ++i) values[i] = rate_of(references[i]);
  return status;
}

double Instance::rate_of(Reference reference) const {
  const Variable &variable = *variables_[static_cast<size_t>(index_of(reference))].variable;
  if (variable.type != Type::real) return 0;
  return absent(variable) ? rest_of(change_, variable) : output_of(change_, variable);
}

Status Instance::solve_again(const Call &call) {
  pending_.resize(rp_state_size(contact_.get()));
  const rp_error error = rp_save_state(contact_.get(), pending_.data(), pending_.size());
  if (error != RP_OK) return refuse(call, rp_error_text(error));
  at_ = solved_;
  return run_contact(call, time_, options_.time_step);
}

Status Instance::hold_solution(const Call &call) {
  if (changed_ && follows()) return solve(call);
  // what a restored state was made of
  if (solution_ == Solution::lost && pending_.empty()) return solve_again(call);
  if (solution_ == Solution::held) return Status::ok;
  log_.say(
      Status::discard, Category::discard,
      std::string(call.name) + ": the last solve failed: restore a state or reset, then ask again");
  return Status::discard;
}

Status Instance::differentiate(const Call &call, const std::vector<double> &rates) {
  const Status status = hold_solution(call);
  if (status != Status::ok) return status;
  // importers ask for the columns' entries one by one
  if (direction_ == rates && !rates.empty()) return Status::ok;
  direction_.clear();
  rp_input direction;
  rp_default_direction(&direction);
  for (size_t i = 0; i < known_; ++i) {
    const Variable &variable = *variables_[i].variable;
    if (variable.type != Type::real || rates[i] == 0 || variables_[i].held) continue;
    if (variable.role == Role::input) put_input(direction, variable, rates[i]);
    if (variable.reference == reference::friction_coefficient)
      direction.friction_coefficient = rates[i];
  }
  rp_message message = {};
  const rp_error error =
      rp_differentiate(contact_.get(), &direction, &change_.result, nullptr, &message);
  if (error != RP_OK)
    return refuse(call, message.text[0] != '\0' ? message.text : rp_error_text(error));
  if (change_.result.status == RP_NOT_CONVERGED) {
    log_.say(Status::discard, Category::discard,
             std::string(call.name) +
                 ": the derivative did not converge here: go on without it, or make the FMU of a "
                 "scene with a larger method.max_iterations");
    return Status::discard;
  }
  set_rest_temperature_rate(input_, direction, change_);
  direction_ = rates;
  return Status::ok;
}

Status Instance::find_largest_step(const Call &call) {
  // after a step that failed it is that of the outputs, which stay
  const bool failed = solution_ == Solution::none && !follows();
  const Status status = failed ? solve_again(call) : hold_solution(call);
  if (status != Status::ok) return status;
  rp_jacobian jacobian;
  rp_message message = {};
  const rp_error error = rp_get_jacobian(contact_.get(), &jacobian, &message);
  if (error != RP_OK)
    return refuse(call, message.text[0] != '\0' ? message.text : rp_error_text(error));
  Inertia inertia;
  const auto value = [&](uint32_t reference) -> double & {
    return values_[static_cast<size_t>(index_of(reference))];
  };
  inertia.mass = value(reference::wheelset_mass);
  for (uint32_t k = 0; k < 3; ++k) inertia.moment[k] = value(reference::wheelset_inertia + k);
  const bool good = jacobian.status != RP_NOT_CONVERGED;
  value(reference::largest_step) = good ? largest_step_of(jacobian, inertia, with_z_) : 0;
  largest_known_ = true;
  if (failed) solution_ = Solution::none;
  return Status::ok;
}

}  // namespace railpatch::fmu
