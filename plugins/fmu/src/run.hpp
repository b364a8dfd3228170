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
fmi2Status run(fmi2Component component, const Call &call, F &&function) noexcept {
  auto *instance = static_cast<Instance *>(component);
  if (instance == nullptr) return fmi2Error;
  // a host may trap on NaN or flush to zero: nothing here, comparisons included, must feel it
  const DefaultFloatingPoint environment;
  try {
    if (!instance->allows(call)) return fmi2Error;
    return function(*instance);
  } catch (...) {
    char text[96];
    std::snprintf(text, sizeof text, "%s: out of memory", call.name);
    instance->log().error_without_memory(text);
    return fmi2Error;
  }
}

}  // namespace railpatch::fmu
