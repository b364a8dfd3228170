// The functions of FMI 2.0 but for those of model exchange alone: checks whether the state allows
// the call, and passes it on. No exception leaves this file.
#include "fmi2_run.hpp"

using namespace railpatch::fmu;
using namespace railpatch::fmu::fmi2;

namespace {

// Status of an asynchronous step, which this FMU never has.
template <class T>
fmi2Status pending(fmi2Component component, const Call &call, fmi2StatusKind kind, T *value) {
  return call_of(component, call, [&](Instance &i) {
    if (value == nullptr) return i.refuse(call, "value is NULL");
    if (kind < fmi2DoStepStatus || kind > fmi2Terminated)
      return i.refuse(call, "the kind of status is unknown");
    i.log().say(Status::discard, Category::discard,
                std::string(call.name) + ": there is no such value: no step is ever pending");
    return Status::discard;
  });
}

// The host's logger takes a printf format.
void tell(const Listener &listener, const char *instance_name, Status status, const char *category,
          const char *text) {
  reinterpret_cast<fmi2CallbackLogger>(listener.logger)(
      listener.environment, instance_name, static_cast<fmi2Status>(status), category, text);
}

Listener listener_of(const fmi2CallbackFunctions *functions) {
  Listener listener;
  if (functions == nullptr || functions->logger == nullptr) return listener;
  listener.tell = tell;
  listener.logger = reinterpret_cast<void (*)()>(functions->logger);
  listener.environment = functions->componentEnvironment;
  listener.format = listener.discards = true;
  return listener;
}

}  // namespace

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions, fmi2Boolean,
                              fmi2Boolean loggingOn) {
  const Listener listener = listener_of(functions);
  try {
    Log log(instanceName, listener, loggingOn != fmi2False);
    if (instanceName == nullptr || instanceName[0] == '\0') {
      log.error("fmi2Instantiate: instanceName is missing");
      return nullptr;
    }
    if (fmuType != fmi2CoSimulation && fmuType != fmi2ModelExchange) {
      log.error("fmi2Instantiate: fmuType is neither fmi2CoSimulation nor fmi2ModelExchange");
      return nullptr;
    }
    const Interface interface =
        fmuType == fmi2CoSimulation ? Interface::co_simulation : Interface::model_exchange;
    return Instance::create(making, interface, fmuGUID, fmuResourceLocation, std::move(log))
        .release();
  } catch (...) {
    if (listener.tell != nullptr)
      listener.tell(listener, instanceName != nullptr ? instanceName : "", Status::error,
                    "logStatusError", "fmi2Instantiate: out of memory");
    return nullptr;
  }
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Instance *>(c); }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[]) {
  const Call &call = fmi2::set_debug_logging;
  return call_of(c, call, [&](Instance &i) {
    if (nCategories > 0 && categories == nullptr) return i.refuse(call, "categories is NULL");
    if (i.log().set(loggingOn != fmi2False, nCategories, categories)) return Status::ok;
    return i.refuse(call, "a category is not one of those in modelDescription.xml");
  });
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
  const Call &call = fmi2::setup_experiment;
  return call_of(c, call, [&](Instance &i) {
    return i.setup(call, toleranceDefined != fmi2False, tolerance, startTime,
                   stopTimeDefined != fmi2False, stopTime);
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return call_of(c, fmi2::enter_initialization,
                 [](Instance &i) { return i.enter_initialization(); });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return call_of(c, fmi2::exit_initialization,
                 [](Instance &i) { return i.exit_initialization(fmi2::exit_initialization); });
}

fmi2Status fmi2Terminate(fmi2Component c) {
  return call_of(c, fmi2::terminate, [](Instance &i) { return i.terminate(fmi2::terminate); });
}

fmi2Status fmi2Reset(fmi2Component c) {
  return call_of(c, fmi2::reset, [](Instance &i) { return i.reset(); });
}

// --- values ------------------------------------------------------------------------------------

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       fmi2Real value[]) {
  const Call &call = fmi2::get_real;
  return call_of(c, call, [&](Instance &i) { return i.get(call, Type::real, vr, nvr, value); });
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Integer value[]) {
  const Call &call = fmi2::get_integer;
  return call_of(c, call, [&](Instance &i) { return i.get(call, Type::whole, vr, nvr, value); });
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Boolean value[]) {
  const Call &call = fmi2::get_boolean;
  return call_of(c, call, [&](Instance &i) { return i.get(call, Type::boolean, vr, nvr, value); });
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         fmi2String value[]) {
  const Call &call = fmi2::get_string;
  return call_of(c, call, [&](Instance &i) { return i.get_text(call, vr, nvr, value); });
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       const fmi2Real value[]) {
  const Call &call = fmi2::set_real;
  return call_of(c, call, [&](Instance &i) { return i.set(call, Type::real, vr, nvr, value); });
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Integer value[]) {
  const Call &call = fmi2::set_integer;
  return call_of(c, call, [&](Instance &i) { return i.set(call, Type::whole, vr, nvr, value); });
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Boolean value[]) {
  const Call &call = fmi2::set_boolean;
  return call_of(c, call, [&](Instance &i) { return i.set(call, Type::boolean, vr, nvr, value); });
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         const fmi2String value[]) {
  const Call &call = fmi2::set_string;
  return call_of(c, call, [&](Instance &i) { return i.set_text(call, vr, nvr, value); });
}

// --- saved states ------------------------------------------------------------------------------

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate) {
  return call_of(c, fmi2::get_state,
                 [&](Instance &i) { return i.get_state(fmi2::get_state, FMUstate); });
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate) {
  return call_of(c, fmi2::set_state,
                 [&](Instance &i) { return i.set_state(fmi2::set_state, FMUstate); });
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate) {
  return call_of(c, fmi2::free_state,
                 [&](Instance &i) { return i.free_state(fmi2::free_state, FMUstate); });
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size) {
  return call_of(c, fmi2::state_size,
                 [&](Instance &i) { return i.state_size(fmi2::state_size, FMUstate, size); });
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[],
                                 size_t size) {
  return call_of(c, fmi2::serialize, [&](Instance &i) {
    return i.serialize(fmi2::serialize, FMUstate,
                       reinterpret_cast<unsigned char *>(serializedState), size);
  });
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate) {
  return call_of(c, fmi2::deserialize, [&](Instance &i) {
    return i.deserialize(fmi2::deserialize,
                         reinterpret_cast<const unsigned char *>(serializedState), size, FMUstate);
  });
}

// --- derivatives -------------------------------------------------------------------------------

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[],
                                        size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[]) {
  return call_of(c, fmi2::derivative, [&](Instance &i) {
    return i.directional_derivative(fmi2::derivative, vUnknown_ref, nUnknown, vKnown_ref, nKnown,
                                    dvKnown, dvUnknown);
  });
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
  return call_of(c, fmi2::input_derivatives, [&](Instance &i) {
    return i.set_input_derivatives(fmi2::input_derivatives, vr, nvr, order, value);
  });
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[]) {
  return call_of(c, fmi2::output_derivatives, [&](Instance &i) {
    return i.output_derivatives(fmi2::output_derivatives, vr, nvr, order, value);
  });
}

// --- steps -------------------------------------------------------------------------------------

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize, fmi2Boolean) {
  return call_of(c, fmi2::do_step, [&](Instance &i) {
    return i.step(fmi2::do_step, currentCommunicationPoint, communicationStepSize);
  });
}

fmi2Status fmi2CancelStep(fmi2Component c) {
  return call_of(c, fmi2::cancel_step, [](Instance &) { return Status::ok; });
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value) {
  const Call &call = fmi2::get_status;
  if (s != fmi2DoStepStatus) return pending(c, call, s, value);
  return call_of(c, call, [&](Instance &i) {
    if (value == nullptr) return i.refuse(call, "value is NULL");
    *value = static_cast<fmi2Status>(i.last_step());
    return Status::ok;
  });
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value) {
  const Call &call = fmi2::get_real_status;
  if (s != fmi2LastSuccessfulTime) return pending(c, call, s, value);
  return call_of(c, call, [&](Instance &i) {
    if (value == nullptr) return i.refuse(call, "value is NULL");
    *value = i.time();
    return Status::ok;
  });
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value) {
  return pending(c, fmi2::get_integer_status, s, value);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value) {
  const Call &call = fmi2::get_boolean_status;
  if (s != fmi2Terminated) return pending(c, call, s, value);
  return call_of(c, call, [&](Instance &i) {
    if (value == nullptr) return i.refuse(call, "value is NULL");
    *value = fmi2False;
    return Status::ok;
  });
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value) {
  return pending(c, fmi2::get_string_status, s, value);
}
