// The functions of FMI 3.0 by the calls of either version.
#pragma once

#include "fmi3Functions.h"
#include "fmi3_calls.hpp"
#include "run.hpp"

namespace railpatch::fmu::fmi3 {

// Runs a call where the state allows it.
template <class F>
fmi3Status call_of(fmi3Instance instance, const Call &call, F &&function) noexcept {
  return static_cast<fmi3Status>(run(instance, call, function));
}

// A call that this FMU never allows, and why.
inline fmi3Status never(fmi3Instance instance, const char *name, const char *why) noexcept {
  const Call call{name, any};
  return call_of(instance, call, [&](Instance &i) { return i.refuse(call, why); });
}

}  // namespace railpatch::fmu::fmi3
