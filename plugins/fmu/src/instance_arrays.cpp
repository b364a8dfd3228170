// FMI 3.0: arrays of variables as the components that they are made of, and derivatives backwards.
#include <algorithm>
#include <cmath>

#include "instance.hpp"

namespace railpatch::fmu {

bool Instance::index_arrays(const std::vector<SceneArray> &arrays) {
  extent_.assign(variables_.size(), 1);
  for (const SceneArray &array : arrays)
    for (uint32_t k = 0; k < array.size; ++k) {
      const int index = index_of(array.reference + k);
      if (index < 0 || variables_[static_cast<size_t>(index)].variable->type != Type::real)
        return false;
      extent_[static_cast<size_t>(index)] = k == 0 ? array.size : 0;
    }
  return true;
}

Status Instance::append(const Call &call, Type type, const Reference *references, size_t count,
                        size_t value_count, std::vector<Reference> &flat) {
  flat.clear();
  for (size_t i = 0; i < count; ++i) {
    const int index = find(call, type, references[i]);
    if (index < 0) return Status::error;
    const uint32_t size = extent_[static_cast<size_t>(index)];
    if (size == 0)
      return refuse(call,
                    "there is no variable with value reference " + text_of_whole(references[i]));
    for (uint32_t k = 0; k < size; ++k) flat.push_back(references[i] + k);
  }
  if (flat.size() == value_count) return Status::ok;
  return refuse(call, "the number of values is " + text_of_whole(value_count) +
                          ", but the variables have " + text_of_whole(flat.size()));
}

Status Instance::flatten(const Call &call, Type type, const Reference *references, size_t count,
                         size_t value_count) {
  return append(call, type, references, count, value_count, flat_);
}

Status Instance::flatten_both(const Call &call, const Reference *const (&lists)[2],
                              const size_t (&counts)[2], const size_t (&values)[2],
                              std::vector<Reference> (&flat)[2]) {
  constexpr const char *names[] = {"unknowns is NULL", "knowns is NULL"};
  // discrete outputs may be unknown, as in find_unknown
  constexpr Type types[] = {Type::number, Type::real};
  for (size_t k = 0; k < 2; ++k) {
    if (counts[k] > 0 && lists[k] == nullptr) return refuse(call, names[k]);
    const Status status = append(call, types[k], lists[k], counts[k], values[k], flat[k]);
    if (status != Status::ok) return status;
  }
  return Status::ok;
}

Status Instance::adjoint_derivative(const Call &call, const std::vector<Reference> &unknown,
                                    const std::vector<Reference> &known, const double *seed,
                                    double *sensitivity) {
  if (unknown.empty() && known.empty()) return Status::ok;
  if (seed == nullptr || sensitivity == nullptr)
    return refuse(call, seed == nullptr ? "seed is NULL" : "sensitivity is NULL");
  for (size_t i = 0; i < unknown.size(); ++i)
    if (!std::isfinite(seed[i]))
      return refuse(call, "seed is " + text_of(seed[i]) + ", allowed a finite number");
  const double one = 1;
  std::vector<double> change(unknown.size()), found(known.size());
  for (size_t k = 0; k < known.size(); ++k) {
    const Status status = directional_derivative(call, unknown.data(), unknown.size(), &known[k], 1,
                                                 &one, change.data());
    if (status != Status::ok) return status;
    for (size_t i = 0; i < unknown.size(); ++i) found[k] += seed[i] * change[i];
  }
  std::copy(found.begin(), found.end(), sensitivity);
  return Status::ok;
}

}  // namespace railpatch::fmu
