// What follows for every number of a result from its line in railpatch_fields.h: its value before
// anything is solved, where nothing touches, in the mirror, and its place in a walk over all of
// them.
#pragma once

#include <type_traits>

#include "railpatch_fields.h"

namespace railpatch {

struct patch_scene;

// words of the lists, in the order of their columns
enum class field_role { status, number, count, label, estimate };
enum class field_mirror { even, odd, vector, axial, origin };
enum class field_unloaded { kept, zero, zero_rolling, zero_plastic, own };
enum class field_sum { alone, by_share, added, greatest };

// Every number of a member, which may be an array of arrays.
template <class T, class F>
constexpr void for_each_in(T &field, F &&f) {
  if constexpr (std::is_array_v<T>) {
    for (auto &part : field) for_each_in(part, f);
  } else {
    f(field);
  }
}

#define RP_NO_NUMBER(type, name, count)
#define RP_VISIT_NUMBER(type, name, count, role, ...) \
  if constexpr (field_role::role == field_role::number) for_each_in(result.name, f);

template <class Result, class F>
void for_each_patch_number(Result &result, F &&f) {
  RP_PATCH_RESULT_FIELDS(RP_VISIT_NUMBER, RP_NO_NUMBER)
}

template <class Result, class F>
void for_each_side_number(Result &result, F &&f) {
  RP_SIDE_RESULT_FIELDS(RP_VISIT_NUMBER, RP_NO_NUMBER)
  for (auto &patch : result.patch) for_each_patch_number(patch, f);
}

// All but residuals and error estimates.
template <class Result, class F>
void for_each_result_number(Result &result, F &&f) {
  RP_RESULT_FIELDS(RP_VISIT_NUMBER, RP_NO_NUMBER)
  for (auto &side : result.side) for_each_side_number(side, f);
}

#undef RP_VISIT_NUMBER

#define RP_COUNT_NUMBERS(type, name, count, role, ...) \
  +(field_role::role == field_role::number ? (count) : 0)
inline constexpr int patch_numbers = 0 RP_PATCH_RESULT_FIELDS(RP_COUNT_NUMBERS, RP_NO_NUMBER);
inline constexpr int side_numbers =
    RP_MAX_PATCHES * patch_numbers RP_SIDE_RESULT_FIELDS(RP_COUNT_NUMBERS, RP_NO_NUMBER);
inline constexpr int result_numbers =
    2 * side_numbers RP_RESULT_FIELDS(RP_COUNT_NUMBERS, RP_NO_NUMBER);
#undef RP_COUNT_NUMBERS
#undef RP_NO_NUMBER

// Results before anything is solved: numbers that are not known are NaN, counts zero.
rp_patch_result empty_patch_result();
rp_side_result empty_side_result();
rp_result empty_result();

// Sets what the scene's stages give where nothing touches: zeros.
void set_unloaded(const patch_scene &scene, rp_patch_result &result);

// The result of a left wheel from that of its mirror image, and the other way round.
void mirror(rp_side_result &result);

// The result with rates of nothing: NaN where it has NaN, else zero.
rp_result rates_of_nothing(const rp_result &result);

}  // namespace railpatch
