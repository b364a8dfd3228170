// Which calls there are, and in which state each is allowed: the tables are in fmi2_calls.hpp and
// fmi3_calls.hpp.
#pragma once

#include <cstdint>

namespace railpatch::fmu {

// a slave's steps end when the call of one returns: none is ever in progress
enum class Mode : uint32_t {
  instantiated = 1,
  initialization = 2,
  step_complete = 4,  // step mode of FMI 3.0
  step_failed = 8,    // FMI 2.0
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

// What making an instance is called in a version of FMI.
struct Making {
  const char *call, *token, *location;
  int version;  // 2 or 3
};

namespace call {

inline constexpr uint32_t instantiated = 1, initialization = 2, complete = 4, failed = 8,
                          terminated = 16, error = 32, event = 64, continuous = 128;
inline constexpr uint32_t before = instantiated | initialization;
inline constexpr uint32_t after = failed | terminated | error;
inline constexpr uint32_t running = complete | event | continuous;
inline constexpr auto slave = Interface::co_simulation, model = Interface::model_exchange;

}  // namespace call

inline const char *mode_text(Mode mode, int version) {
  switch (mode) {
    case Mode::instantiated:
      return "instantiated";
    case Mode::initialization:
      return "initialization mode";
    case Mode::step_complete:
      return version == 2 ? "step complete" : "step mode";
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
