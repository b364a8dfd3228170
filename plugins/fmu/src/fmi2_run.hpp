// The functions of FMI 2.0 by the calls of either version.
#pragma once

#include "fmi2Functions.h"
#include "fmi2_calls.hpp"
#include "run.hpp"

namespace railpatch::fmu::fmi2 {

// Runs a call where the state allows it.
template <class F>
fmi2Status call_of(fmi2Component component, const Call &call, F &&function) noexcept {
  return static_cast<fmi2Status>(run(component, call, function));
}

}  // namespace railpatch::fmu::fmi2
