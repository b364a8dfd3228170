// The functions of FMI 3.0 but for values and for those of model exchange alone: checks whether the
// state allows the call, and passes it on. No exception leaves this file.
#include "fmi3_run.hpp"

using namespace railpatch::fmu;
using namespace railpatch::fmu::fmi3;

namespace {

constexpr const char *kNoClock = "is not allowed: there is no clock";

void tell(const Listener &listener, const char *, Status status, const char *category,
          const char *text) {
  reinterpret_cast<fmi3LogMessageCallback>(listener.logger)(
      listener.environment, static_cast<fmi3Status>(status), category, text);
}

Listener listener_of(fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
  Listener listener;
  if (logger == nullptr) return listener;
  listener.tell = tell;
  listener.logger = reinterpret_cast<void (*)()>(logger);
  listener.environment = environment;
  return listener;
}

// why: what is wrong with the arguments; null: nothing
fmi3Instance make(const Making &making, Interface interface, const char *name, const char *token,
                  const char *location, bool on, const Listener &listener,
                  const char *why) noexcept {
  try {
    Log log(name, listener, on);
    if (name == nullptr || name[0] == '\0') why = "instanceName is missing";
    if (why != nullptr) {
      log.error(std::string(making.call) + ": " + why);
      return nullptr;
    }
    return Instance::create(making, interface, token, location, std::move(log)).release();
  } catch (...) {
    if (listener.tell != nullptr)
      listener.tell(listener, "", Status::error, "logStatusError", "no memory for an instance");
    return nullptr;
  }
}

}  // namespace

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath, fmi3Boolean,
    fmi3Boolean loggingOn, fmi3Boolean eventModeUsed, fmi3Boolean, const fmi3ValueReference[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback) {
  const char *why = nullptr;
  if (eventModeUsed) why = "eventModeUsed is fmi3True, but hasEventMode is false";
  if (nRequiredIntermediateVariables > 0)
    why = "nRequiredIntermediateVariables is above 0, but providesIntermediateUpdate is false";
  return make(making_slave, Interface::co_simulation, instanceName, instantiationToken,
              resourcePath, loggingOn, listener_of(instanceEnvironment, logMessage), why);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean,
                                          fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage) {
  return make(making_model, Interface::model_exchange, instanceName, instantiationToken,
              resourcePath, loggingOn, listener_of(instanceEnvironment, logMessage), nullptr);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String, fmi3String, fmi3String, fmi3Boolean,
                                               fmi3Boolean,
                                               fmi3InstanceEnvironment instanceEnvironment,
                                               fmi3LogMessageCallback logMessage,
                                               fmi3ClockUpdateCallback, fmi3LockPreemptionCallback,
                                               fmi3UnlockPreemptionCallback) {
  const Listener listener = listener_of(instanceEnvironment, logMessage);
  if (listener.tell != nullptr)
    listener.tell(listener, "", Status::error, "logStatusError",
                  "fmi3InstantiateScheduledExecution: this FMU has no scheduled execution");
  return nullptr;
}

void fmi3FreeInstance(fmi3Instance instance) { delete static_cast<Instance *>(instance); }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[]) {
  const Call &call = set_debug_logging;
  return call_of(instance, call, [&](Instance &i) {
    if (nCategories > 0 && categories == nullptr) return i.refuse(call, "categories is NULL");
    if (i.log().set(loggingOn, nCategories, categories)) return Status::ok;
    return i.refuse(call, "a category is not one of those in modelDescription.xml");
  });
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined,
                                       fmi3Float64 tolerance, fmi3Float64 startTime,
                                       fmi3Boolean stopTimeDefined, fmi3Float64 stopTime) {
  const Call &call = enter_initialization;
  return call_of(instance, call, [&](Instance &i) {
    const Status status =
        i.setup(call, toleranceDefined, tolerance, startTime, stopTimeDefined, stopTime);
    return status == Status::ok ? i.enter_initialization() : status;
  });
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
  const Call &call = exit_initialization;
  return call_of(instance, call, [&](Instance &i) { return i.exit_initialization(call); });
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
  const Call &call = fmi3::terminate;
  return call_of(instance, call, [&](Instance &i) { return i.terminate(call); });
}

fmi3Status fmi3Reset(fmi3Instance instance) {
  return call_of(instance, reset, [](Instance &i) { return i.reset(); });
}

// --- saved states ------------------------------------------------------------------------------

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState) {
  return call_of(instance, get_state,
                 [&](Instance &i) { return i.get_state(get_state, FMUState); });
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState) {
  return call_of(instance, set_state,
                 [&](Instance &i) { return i.set_state(set_state, FMUState); });
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState) {
  return call_of(instance, free_state,
                 [&](Instance &i) { return i.free_state(free_state, FMUState); });
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size) {
  return call_of(instance, state_size,
                 [&](Instance &i) { return i.state_size(state_size, FMUState, size); });
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState,
                                 fmi3Byte serializedState[], size_t size) {
  return call_of(instance, serialize, [&](Instance &i) {
    return i.serialize(serialize, FMUState, serializedState, size);
  });
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[],
                                   size_t size, fmi3FMUState *FMUState) {
  return call_of(instance, deserialize, [&](Instance &i) {
    return i.deserialize(deserialize, serializedState, size, FMUState);
  });
}

// --- derivatives -------------------------------------------------------------------------------

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                        size_t nUnknowns, const fmi3ValueReference knowns[],
                                        size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
                                        fmi3Float64 sensitivity[], size_t nSensitivity) {
  const Call &call = directional;
  return call_of(instance, call, [&](Instance &i) {
    Reference const *const lists[] = {unknowns, knowns};
    const size_t counts[] = {nUnknowns, nKnowns}, values[] = {nSensitivity, nSeed};
    std::vector<Reference> flat[2];
    const Status status = i.flatten_both(call, lists, counts, values, flat);
    if (status != Status::ok) return status;
    return i.directional_derivative(call, flat[0].data(), flat[0].size(), flat[1].data(),
                                    flat[1].size(), seed, sensitivity);
  });
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                    size_t nUnknowns, const fmi3ValueReference knowns[],
                                    size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
                                    fmi3Float64 sensitivity[], size_t nSensitivity) {
  const Call &call = adjoint;
  return call_of(instance, call, [&](Instance &i) {
    Reference const *const lists[] = {unknowns, knowns};
    const size_t counts[] = {nUnknowns, nKnowns}, values[] = {nSeed, nSensitivity};
    std::vector<Reference> flat[2];
    const Status status = i.flatten_both(call, lists, counts, values, flat);
    if (status != Status::ok) return status;
    return i.adjoint_derivative(call, flat[0], flat[1], seed, sensitivity);
  });
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference,
                                               size_t *) {
  return never(instance, "fmi3GetNumberOfVariableDependencies",
               "is not provided: see providesPerElementDependencies in modelDescription.xml");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference, size_t[],
                                       fmi3ValueReference[], size_t[], fmi3DependencyKind[],
                                       size_t) {
  return never(instance, "fmi3GetVariableDependencies",
               "is not provided: see providesPerElementDependencies in modelDescription.xml");
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                    const fmi3Int32[], fmi3Float64[], size_t) {
  return never(instance, "fmi3GetOutputDerivatives",
               "is not provided: see maxOutputDerivativeOrder in modelDescription.xml");
}

// --- steps -------------------------------------------------------------------------------------

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
                      fmi3Float64 communicationStepSize, fmi3Boolean,
                      fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
                      fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime) {
  return call_of(instance, do_step, [&](Instance &i) {
    for (fmi3Boolean *flag : {eventHandlingNeeded, terminateSimulation, earlyReturn})
      if (flag != nullptr) *flag = fmi3False;
    const Status status = i.step(do_step, currentCommunicationPoint, communicationStepSize);
    if (lastSuccessfulTime != nullptr) *lastSuccessfulTime = i.time();
    return status;
  });
}

// --- what a scene does not have ----------------------------------------------------------------

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) {
  return never(instance, "fmi3EnterConfigurationMode",
               "is not allowed: there is no structural parameter");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) {
  return never(instance, "fmi3ExitConfigurationMode",
               "is not allowed: there is no structural parameter");
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
  return never(instance, "fmi3EnterStepMode", "is not allowed: hasEventMode is false");
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
  return never(instance, "fmi3EvaluateDiscreteStates",
               "is not provided: see providesEvaluateDiscreteStates in modelDescription.xml");
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                  fmi3Float64[], fmi3IntervalQualifier[]) {
  return never(instance, "fmi3GetIntervalDecimal", kNoClock);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                   fmi3UInt64[], fmi3UInt64[], fmi3IntervalQualifier[]) {
  return never(instance, "fmi3GetIntervalFraction", kNoClock);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference[], size_t,
                               fmi3Float64[]) {
  return never(instance, "fmi3GetShiftDecimal", kNoClock);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                fmi3UInt64[], fmi3UInt64[]) {
  return never(instance, "fmi3GetShiftFraction", kNoClock);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                  const fmi3Float64[]) {
  return never(instance, "fmi3SetIntervalDecimal", kNoClock);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                   const fmi3UInt64[], const fmi3UInt64[]) {
  return never(instance, "fmi3SetIntervalFraction", kNoClock);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference[], size_t,
                               const fmi3Float64[]) {
  return never(instance, "fmi3SetShiftDecimal", kNoClock);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference[], size_t,
                                const fmi3UInt64[], const fmi3UInt64[]) {
  return never(instance, "fmi3SetShiftFraction", kNoClock);
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference, fmi3Float64) {
  return never(instance, "fmi3ActivateModelPartition", kNoClock);
}
