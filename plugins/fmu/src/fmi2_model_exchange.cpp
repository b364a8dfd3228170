// The functions of FMI 2.0 for model exchange alone: a scene without history has no states and no
// events of its own, so that its outputs follow its inputs at any time.
#include "fmi2_run.hpp"

using namespace railpatch::fmu;
using namespace railpatch::fmu::fmi2;

namespace {

// There is nothing to set or give.
fmi2Status nothing(fmi2Component component, const Call &call, const char *what, size_t count) {
  return call_of(component, call, [&](Instance &i) {
    if (count == 0) return Status::ok;
    return i.refuse(call, std::string(what) + " is " + text_of_whole(count) + ", allowed 0");
  });
}

}  // namespace

fmi2Status fmi2EnterEventMode(fmi2Component c) {
  return call_of(c, fmi2::enter_event, [](Instance &i) { return i.go_to(Mode::event); });
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
  const Call &call = fmi2::discrete_states;
  return call_of(c, call, [&](Instance &i) {
    if (info == nullptr) return i.refuse(call, "fmi2eventInfo is NULL");
    *info = {};
    return Status::ok;
  });
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
  return call_of(c, fmi2::enter_continuous, [](Instance &i) { return i.go_to(Mode::continuous); });
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean, fmi2Boolean *enterEventMode,
                                       fmi2Boolean *terminateSimulation) {
  const Call &call = fmi2::completed;
  return call_of(c, call, [&](Instance &i) {
    if (enterEventMode == nullptr || terminateSimulation == nullptr)
      return i.refuse(call, enterEventMode == nullptr ? "enterEventMode is NULL"
                                                      : "terminateSimulation is NULL");
    *enterEventMode = *terminateSimulation = fmi2False;
    return Status::ok;
  });
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
  return call_of(c, fmi2::set_time, [&](Instance &i) { return i.set_time(fmi2::set_time, time); });
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real[], size_t nx) {
  return nothing(c, fmi2::set_states, "nx", nx);
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real[], size_t nx) {
  return nothing(c, fmi2::get_derivatives, "nx", nx);
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real[], size_t ni) {
  return nothing(c, fmi2::event_indicators, "ni", ni);
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real[], size_t nx) {
  return nothing(c, fmi2::get_states, "nx", nx);
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real[], size_t nx) {
  return nothing(c, fmi2::nominals, "nx", nx);
}
