// Which call is allowed in which state: FMI 2.0.4, section 3.2.3 for model exchange, and section
// 4.2.4 for a slave whose steps end when fmi2DoStep returns (no step in progress, none cancelled).
#pragma once

#include <cstdint>

namespace railpatch::fmu {

enum class Mode : uint32_t {
  instantiated = 1,
  initialization = 2,
  step_complete = 4,
  step_failed = 8,
  terminated = 16,
  error = 32,
  event = 64,  // model exchange
  continuous = 128
};

// Which of FMI's interfaces a call belongs to.
enum class Interface : uint32_t { both, co_simulation, model_exchange };

struct Call {
  const char *name;
  uint32_t allowed;
  Interface interface = Interface::both;
};

namespace call {

inline constexpr uint32_t instantiated = 1, initialization = 2, complete = 4, failed = 8,
                          terminated = 16, error = 32, event = 64, continuous = 128;
inline constexpr uint32_t before = instantiated | initialization;
inline constexpr uint32_t after = failed | terminated | error;
inline constexpr uint32_t running = complete | event | continuous;
inline constexpr auto slave = Interface::co_simulation, model = Interface::model_exchange;

inline constexpr Call set_debug_logging{"fmi2SetDebugLogging", before | running | after};
inline constexpr Call setup_experiment{"fmi2SetupExperiment", instantiated};
inline constexpr Call enter_initialization{"fmi2EnterInitializationMode", instantiated};
inline constexpr Call exit_initialization{"fmi2ExitInitializationMode", initialization};
inline constexpr Call terminate{"fmi2Terminate", running | failed};
inline constexpr Call reset{"fmi2Reset", before | running | after};
inline constexpr Call get_real{"fmi2GetReal", initialization | running | after};
inline constexpr Call get_integer{"fmi2GetInteger", initialization | running | after};
inline constexpr Call get_boolean{"fmi2GetBoolean", initialization | running | after};
inline constexpr Call get_string{"fmi2GetString", initialization | running | after};
inline constexpr Call set_real{"fmi2SetReal", before | running};
inline constexpr Call set_integer{"fmi2SetInteger", before | complete | event};
inline constexpr Call set_boolean{"fmi2SetBoolean", before | complete | event};
inline constexpr Call set_string{"fmi2SetString", before | complete | event};
inline constexpr Call get_state{"fmi2GetFMUstate", before | running | after};
inline constexpr Call set_state{"fmi2SetFMUstate", before | running | after};
inline constexpr Call free_state{"fmi2FreeFMUstate", before | running | after};
inline constexpr Call state_size{"fmi2SerializedFMUstateSize", before | running | after};
inline constexpr Call serialize{"fmi2SerializeFMUstate", before | running | after};
inline constexpr Call deserialize{"fmi2DeSerializeFMUstate", before | running | after};
inline constexpr Call derivative{"fmi2GetDirectionalDerivative", initialization | running | after};
inline constexpr Call input_derivatives{"fmi2SetRealInputDerivatives", before | complete, slave};
inline constexpr Call output_derivatives{"fmi2GetRealOutputDerivatives", complete | after, slave};
inline constexpr Call do_step{"fmi2DoStep", complete, slave};
inline constexpr Call cancel_step{"fmi2CancelStep", 0, slave};
inline constexpr Call get_status{"fmi2GetStatus", complete | failed | terminated, slave};
inline constexpr Call get_real_status{"fmi2GetRealStatus", complete | failed | terminated, slave};
inline constexpr Call get_integer_status{"fmi2GetIntegerStatus", complete | failed | terminated,
                                         slave};
inline constexpr Call get_boolean_status{"fmi2GetBooleanStatus", complete | failed | terminated,
                                         slave};
inline constexpr Call get_string_status{"fmi2GetStringStatus", complete | failed | terminated,
                                        slave};

inline constexpr uint32_t asked = initialization | event | continuous | terminated | error;
inline constexpr Call enter_event{"fmi2EnterEventMode", event | continuous, model};
inline constexpr Call discrete_states{"fmi2NewDiscreteStates", event, model};
inline constexpr Call enter_continuous{"fmi2EnterContinuousTimeMode", event, model};
inline constexpr Call completed{"fmi2CompletedIntegratorStep", continuous, model};
inline constexpr Call set_time{"fmi2SetTime", event | continuous, model};
inline constexpr Call set_states{"fmi2SetContinuousStates", continuous, model};
inline constexpr Call get_derivatives{"fmi2GetDerivatives", asked, model};
inline constexpr Call event_indicators{"fmi2GetEventIndicators", asked, model};
inline constexpr Call get_states{"fmi2GetContinuousStates", asked, model};
inline constexpr Call nominals{"fmi2GetNominalsOfContinuousStates", instantiated | asked, model};

}  // namespace call

inline const char *mode_text(Mode mode) {
  switch (mode) {
    case Mode::instantiated:
      return "instantiated";
    case Mode::initialization:
      return "initialization mode";
    case Mode::step_complete:
      return "step complete";
    case Mode::step_failed:
      return "step failed";
    case Mode::terminated:
      return "terminated";
    case Mode::error:
      return "error";
    case Mode::event:
      return "event mode";
    case Mode::continuous:
      return "continuous-time mode";
  }
  return "unknown";
}

}  // namespace railpatch::fmu
