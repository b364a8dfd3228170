// What stands for a number that there is not.
#pragma once

#include <limits>

namespace railpatch {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace railpatch
