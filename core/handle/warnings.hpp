// What can hardly be meant, though it can be solved: bits 1 << RP_WARNING_...
#pragma once

#include <cstdint>

#include "patch/patch_memory.hpp"
#include "railpatch.h"

namespace railpatch {

// Of a case as it was given, with its profiles.
uint32_t warnings_of_case(const rp_config &config);
// Of a step's elastohydrodynamic film on its grid; none where there is no solution.
uint32_t warnings_of_film(const rp_config &config, const patch_memory *solution,
                          const rp_result &result);
// Of a step, with those of its case; the config needs no profiles any more. coefficient: Coulomb's,
// as it was set last.
void report_warnings(const rp_config &config, uint32_t of_case, const rp_input &input,
                     double coefficient, rp_result &result);

}  // namespace railpatch
