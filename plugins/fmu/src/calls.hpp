// Which call is allowed in which state: FMI 2.0.4, section 4.2.4, for a slave whose steps end when
// fmi2DoStep returns (no step in progress, none cancelled).
#pragma once

#include <cstdint>

namespace railpatch::fmu {

enum class Mode : uint32_t {
  instantiated = 1,
  initialization = 2,
  step_complete = 4,
  step_failed = 8,
  terminated = 16,
  error = 32
};

struct Call {
  const char *name;
  uint32_t allowed;
};

namespace call {

inline constexpr uint32_t instantiated = 1, initialization = 2, complete = 4, failed = 8,
                          terminated = 16, error = 32;
inline constexpr uint32_t before = instantiated | initialization;
inline constexpr uint32_t after = failed | terminated | error;

inline constexpr Call set_debug_logging{"fmi2SetDebugLogging", before | complete | after};
inline constexpr Call setup_experiment{"fmi2SetupExperiment", instantiated};
inline constexpr Call enter_initialization{"fmi2EnterInitializationMode", instantiated};
inline constexpr Call exit_initialization{"fmi2ExitInitializationMode", initialization};
inline constexpr Call terminate{"fmi2Terminate", complete | failed};
inline constexpr Call reset{"fmi2Reset", before | complete | after};
inline constexpr Call get_real{"fmi2GetReal", initialization | complete | after};
inline constexpr Call get_integer{"fmi2GetInteger", initialization | complete | after};
inline constexpr Call get_boolean{"fmi2GetBoolean", initialization | complete | after};
inline constexpr Call get_string{"fmi2GetString", initialization | complete | after};
inline constexpr Call set_real{"fmi2SetReal", before | complete};
inline constexpr Call set_integer{"fmi2SetInteger", before | complete};
inline constexpr Call set_boolean{"fmi2SetBoolean", before | complete};
inline constexpr Call set_string{"fmi2SetString", before | complete};
inline constexpr Call get_state{"fmi2GetFMUstate", before | complete | after};
inline constexpr Call set_state{"fmi2SetFMUstate", before | complete | after};
inline constexpr Call free_state{"fmi2FreeFMUstate", before | complete | after};
inline constexpr Call state_size{"fmi2SerializedFMUstateSize", before | complete | after};
inline constexpr Call serialize{"fmi2SerializeFMUstate", before | complete | after};
inline constexpr Call deserialize{"fmi2DeSerializeFMUstate", before | complete | after};
inline constexpr Call derivative{"fmi2GetDirectionalDerivative", initialization | complete | after};
inline constexpr Call input_derivatives{"fmi2SetRealInputDerivatives", before | complete};
inline constexpr Call output_derivatives{"fmi2GetRealOutputDerivatives", complete | after};
inline constexpr Call do_step{"fmi2DoStep", complete};
inline constexpr Call cancel_step{"fmi2CancelStep", 0};
inline constexpr Call get_status{"fmi2GetStatus", complete | failed | terminated};
inline constexpr Call get_real_status{"fmi2GetRealStatus", complete | failed | terminated};
inline constexpr Call get_integer_status{"fmi2GetIntegerStatus", complete | failed | terminated};
inline constexpr Call get_boolean_status{"fmi2GetBooleanStatus", complete | failed | terminated};
inline constexpr Call get_string_status{"fmi2GetStringStatus", complete | failed | terminated};

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
  }
  return "unknown";
}

}  // namespace railpatch::fmu
