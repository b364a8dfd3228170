// How every function of FMI enters: in the default floating-point environment, in a state that
// allows it, and without an exception on the way out.
#pragma once

#include <cstdio>
#include <string>

#include "floating_point.hpp"
#include "instance.hpp"

namespace railpatch::fmu {

// Runs a call where the state allows it.
template <class F>
Status run(void *component, const Call &call, F &&function) noexcept {
  auto *instance = static_cast<Instance *>(component);
  if (instance == nullptr) return Status::error;
  // a host may trap on NaN or flush to zero: nothing here, comparisons included, must feel it
  const DefaultFloatingPoint environment;
  try {
    if (!instance->allows(call)) return Status::error;
    return function(*instance);
  } catch (...) {
    char text[96];
    std::snprintf(text, sizeof text, "%s: out of memory", call.name);
    instance->log().error_without_memory(text);
    return Status::error;
  }
}

}  // namespace railpatch::fmu
