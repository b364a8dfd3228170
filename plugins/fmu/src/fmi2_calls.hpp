// FMI 2.0: which call is allowed in which state, by FMI 2.0.4, section 3.2.3 for model exchange,
// and section 4.2.4 for a slave whose steps end when fmi2DoStep returns (no step in progress, none
// cancelled).
#pragma once

#include "calls.hpp"

namespace railpatch::fmu::fmi2 {

using namespace call;

inline constexpr Making making{"fmi2Instantiate", "fmuGUID", "fmuResourceLocation", 2};

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

}  // namespace railpatch::fmu::fmi2
