// What both versions of FMI mean by other names: statuses, value references, handles of states.
#pragma once

#include <cstdint>

namespace railpatch::fmu {

// with the numbers that fmi2Status and fmi3Status have
enum class Status : int { ok, warning, discard, error };

using Reference = uint32_t;
using StateHandle = void *;

}  // namespace railpatch::fmu
