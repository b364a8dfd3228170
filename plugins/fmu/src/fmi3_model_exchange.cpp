// The functions of FMI 3.0 for model exchange alone: a scene without history has no states and no
// events of its own, so that its outputs follow its inputs at any time.
#include "fmi3_run.hpp"

using namespace railpatch::fmu;
using namespace railpatch::fmu::fmi3;

namespace {

// There is nothing to set or give.
fmi3Status nothing(fmi3Instance instance, const Call &call, const char *what, size_t count) {
  return call_of(instance, call, [&](Instance &i) {
    if (count == 0) return Status::ok;
    return i.refuse(call, std::string(what) + " is " + text_of_whole(count) + ", allowed 0");
  });
}

fmi3Status none_of(fmi3Instance instance, const Call &call, const char *what, size_t *count) {
  return call_of(instance, call, [&](Instance &i) {
    if (count == nullptr) return i.refuse(call, std::string(what) + " is NULL");
    *count = 0;
    return Status::ok;
  });
}

}  // namespace

fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
  return call_of(instance, enter_event, [](Instance &i) { return i.go_to(Mode::event); });
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation,
                                    fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged,
                                    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime) {
  const Call &call = discrete_states;
  return call_of(instance, call, [&](Instance &i) {
    fmi3Boolean *const flags[] = {discreteStatesNeedUpdate, terminateSimulation,
                                  nominalsOfContinuousStatesChanged,
                                  valuesOfContinuousStatesChanged, nextEventTimeDefined};
    for (const fmi3Boolean *flag : flags)
      if (flag == nullptr) return i.refuse(call, "one of the results is NULL");
    if (nextEventTime == nullptr) return i.refuse(call, "nextEventTime is NULL");
    for (fmi3Boolean *flag : flags) *flag = fmi3False;
    *nextEventTime = 0;
    return Status::ok;
  });
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
  return call_of(instance, enter_continuous, [](Instance &i) { return i.go_to(Mode::continuous); });
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean,
                                       fmi3Boolean *enterEventMode,
                                       fmi3Boolean *terminateSimulation) {
  const Call &call = completed;
  return call_of(instance, call, [&](Instance &i) {
    if (enterEventMode == nullptr || terminateSimulation == nullptr)
      return i.refuse(call, enterEventMode == nullptr ? "enterEventMode is NULL"
                                                      : "terminateSimulation is NULL");
    *enterEventMode = *terminateSimulation = fmi3False;
    return Status::ok;
  });
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
  return call_of(instance, fmi3::set_time,
                 [&](Instance &i) { return i.set_time(fmi3::set_time, time); });
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64[],
                                   size_t nContinuousStates) {
  return nothing(instance, set_states, "nContinuousStates", nContinuousStates);
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64[],
                                             size_t nContinuousStates) {
  return nothing(instance, get_derivatives, "nContinuousStates", nContinuousStates);
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64[], size_t nEventIndicators) {
  return nothing(instance, event_indicators, "nEventIndicators", nEventIndicators);
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64[], size_t nContinuousStates) {
  return nothing(instance, get_states, "nContinuousStates", nContinuousStates);
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64[],
                                             size_t nContinuousStates) {
  return nothing(instance, nominals, "nContinuousStates", nContinuousStates);
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *nEventIndicators) {
  return none_of(instance, indicator_count, "nEventIndicators", nEventIndicators);
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *nContinuousStates) {
  return none_of(instance, state_count, "nContinuousStates", nContinuousStates);
}
