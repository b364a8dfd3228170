// Kalker's linear theory (1967): creep forces by the creepage coefficients alone. It knows no
// bound; beyond it the result counts as not in range.
#pragma once

#include "fast/fast_problem.hpp"

namespace railpatch {

tangential_result solve_linear(const fast_problem &problem, tangential_fields fields,
                               creep_resultants &sums);

}  // namespace railpatch
