// A walk over all numbers of rp_input, from their lines in railpatch_fields.h.
#pragma once

#include <string_view>

#include "patch/result_fields.hpp"
#include "railpatch_fields.h"

namespace railpatch {

// words of the lists
enum class case_role { choice, number, integer, side, points, unmarked, place };

#define RP_NO_FIELD(type, name, count)

// f(name, number, scale) for every double of an input, in order. scale is what changes it by a good
// part of what matters, of numbers that are zero at rest; 0: the number itself is its scale.
template <class Input, class F>
void for_each_number(Input &in, F &&f) {
#define RP_VISIT(type, name, count, role, where, start, bounds, low, high, scale, ...) \
  if constexpr (case_role::role != case_role::integer)                                 \
    for_each_in(in.name, [&](auto &v) { f(#name, v, double(scale)); });
  RP_INPUT_FIELDS(RP_VISIT, RP_NO_FIELD)
#undef RP_VISIT
}

// Whether the size of an input says nothing about how fast things change there.
constexpr bool is_place(std::string_view input) {
#define RP_PLACE(type, name, count, role, ...) \
  if (case_role::role == case_role::place && input == #name) return true;
  RP_INPUT_FIELDS(RP_PLACE, RP_NO_FIELD)
#undef RP_PLACE
  return false;
}

#define RP_COUNT(type, name, count, role, ...) \
  +(case_role::role != case_role::integer ? (count) : 0)
inline constexpr int input_numbers = 0 RP_INPUT_FIELDS(RP_COUNT, RP_NO_FIELD);
#undef RP_COUNT

#undef RP_NO_FIELD

}  // namespace railpatch
