// What can hardly be meant, though it can be solved: bits 1 << RP_WARNING_...
#pragma once

#include <cstdint>

#include "railpatch.h"

namespace railpatch {

// Of a case as it was given, with its profiles.
uint32_t warnings_of_case(const rp_config &config);
// Of a step, with those of its case; the config needs no profiles any more.
void report_warnings(const rp_config &config, uint32_t of_case, const rp_input &input,
                     rp_result &result);

}  // namespace railpatch
