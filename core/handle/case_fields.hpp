// What follows for every member of rp_config and rp_input from its line in railpatch_fields.h: its
// range, and its default.
#pragma once

#include "railpatch_fields.h"
#include "wheel/input_numbers.hpp"

namespace railpatch {

// words of the lists
enum class case_part { always, patch, wheels, own };

struct range {
  double low, high;
  bool open_low, open_high;
};
constexpr range range_of(const char *bounds, double low, double high) {
  const bool bounded = bounds[0] != '\0';
  return {low, high, !bounded || bounds[0] == '(', !bounded || bounds[1] == ')'};
}

#define RP_NO_FIELD(type, name, count)
#define RP_RANGE(type, name, count, role, where, start, bounds, low, high, ...) \
  inline constexpr range name = range_of(bounds, low, high);
namespace config_range {
RP_CONFIG_FIELDS(RP_RANGE, RP_NO_FIELD)
}
namespace input_range {
RP_INPUT_FIELDS(RP_RANGE, RP_NO_FIELD)
}
#undef RP_RANGE

// what rp_default_config gives, of those that other checks compare with
#define RP_START(type, name, count, role, where, start, ...) \
  inline constexpr double name = static_cast<double>(start);
namespace config_start {
RP_CONFIG_FIELDS(RP_START, RP_NO_FIELD)
}
#undef RP_START

// How many choices an enumeration has; their values count from 0.
template <class E>
inline constexpr int choice_count = 0;
#define RP_ONE(name, value, word) +1
#define RP_COUNT_CHOICES(type, LIST) \
  template <>                        \
  inline constexpr int choice_count<type> = 0 LIST(RP_ONE);
RP_CHOICES(RP_COUNT_CHOICES)
#undef RP_COUNT_CHOICES
#undef RP_ONE

#undef RP_NO_FIELD

}  // namespace railpatch
