// FMI 3.0: which call is allowed in which state, by FMI 3.0.2, sections 2.3 (common), 3.2 (model
// exchange) and 4.2 (co-simulation). There is no event mode in co-simulation, no clock, no
// structural parameter and no intermediate update. A step that is discarded leaves the state as
// before (2.2.3).
#pragma once

#include "calls.hpp"

namespace railpatch::fmu::fmi3 {

using namespace call;

inline constexpr Making making_slave{"fmi3InstantiateCoSimulation", "instantiationToken",
                                     "resourcePath", 3};
inline constexpr Making making_model{"fmi3InstantiateModelExchange", "instantiationToken",
                                     "resourcePath", 3};

inline constexpr uint32_t any = before | running | terminated | error;
inline constexpr uint32_t read = any;  // start values before initialization
inline constexpr uint32_t whole = before | complete | event;

inline constexpr Call set_debug_logging{"fmi3SetDebugLogging", any};
inline constexpr Call enter_initialization{"fmi3EnterInitializationMode", instantiated};
inline constexpr Call exit_initialization{"fmi3ExitInitializationMode", initialization};
inline constexpr Call enter_event{"fmi3EnterEventMode", continuous, model};
inline constexpr Call terminate{"fmi3Terminate", running};
inline constexpr Call reset{"fmi3Reset", any};
inline constexpr Call get_float64{"fmi3GetFloat64", read};
inline constexpr Call get_int32{"fmi3GetInt32", read};
inline constexpr Call get_int64{"fmi3GetInt64", read};
inline constexpr Call get_boolean{"fmi3GetBoolean", read};
inline constexpr Call set_boolean{"fmi3SetBoolean", whole};
inline constexpr Call get_string{"fmi3GetString", read};
inline constexpr Call set_float64{"fmi3SetFloat64", before | running};
inline constexpr Call set_int32{"fmi3SetInt32", whole};
inline constexpr Call set_int64{"fmi3SetInt64", whole};
inline constexpr Call set_string{"fmi3SetString", whole};
inline constexpr Call get_state{"fmi3GetFMUState", any};
inline constexpr Call set_state{"fmi3SetFMUState", any};
inline constexpr Call free_state{"fmi3FreeFMUState", any};
inline constexpr Call state_size{"fmi3SerializedFMUStateSize", any};
inline constexpr Call serialize{"fmi3SerializeFMUState", any};
inline constexpr Call deserialize{"fmi3DeserializeFMUState", any};
inline constexpr uint32_t derived = initialization | running | terminated | error;
inline constexpr Call directional{"fmi3GetDirectionalDerivative", derived};
inline constexpr Call adjoint{"fmi3GetAdjointDerivative", derived};
inline constexpr Call do_step{"fmi3DoStep", complete, slave};

inline constexpr Call enter_continuous{"fmi3EnterContinuousTimeMode", event, model};
inline constexpr Call discrete_states{"fmi3UpdateDiscreteStates", event, model};
inline constexpr Call completed{"fmi3CompletedIntegratorStep", continuous, model};
inline constexpr Call set_time{"fmi3SetTime", continuous, model};
inline constexpr Call set_states{"fmi3SetContinuousStates", continuous, model};
inline constexpr uint32_t asked = initialization | event | continuous | terminated | error;
inline constexpr Call get_derivatives{"fmi3GetContinuousStateDerivatives", asked, model};
inline constexpr Call event_indicators{"fmi3GetEventIndicators", asked, model};
inline constexpr Call get_states{"fmi3GetContinuousStates", asked, model};
inline constexpr Call nominals{"fmi3GetNominalsOfContinuousStates", instantiated | asked, model};
inline constexpr Call indicator_count{"fmi3GetNumberOfEventIndicators", any, model};
inline constexpr Call state_count{"fmi3GetNumberOfContinuousStates", any, model};

}  // namespace railpatch::fmu::fmi3
