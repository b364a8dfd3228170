#include "patch/result_sums.hpp"

#include <cmath>

#include "patch/patch_scene.hpp"

namespace railpatch {

namespace {

// Whether b takes the place of a; what is no number stays visible.
bool exceeds(double b, double a) { return !std::isnan(a) && !(b <= a); }

template <class T>
void add(T &sum, const T &part) {
  sum += part;
}
template <class T, size_t n>
void add(T (&sum)[n], const T (&part)[n]) {
  for (size_t k = 0; k < n; ++k) sum[k] += part[k];
}

int count_of(const rp_side_result &side) { return side.patch_count + side.alternative_count; }

// templates, so that members that only some structs have are looked up where they are

#define RP_NONE(type, name, count)
#define RP_UNSUMMED(type, name, count, role, mirror, unloaded, sum, ...)                        \
  if constexpr (field_sum::sum == field_sum::by_share || field_sum::sum == field_sum::greatest) \
    side.name = none.name;

template <class Side>
void take_unloaded(const rp_patch_result &none,
                   Side &side){RP_PATCH_RESULT_FIELDS(RP_UNSUMMED, RP_NONE)}
#define RP_SUM_PATCHES(type, name, count, role, mirror, unloaded, sum, ...)                  \
  if constexpr (field_sum::sum == field_sum::by_share) {                                     \
    side.name = 0;                                                                           \
    for (int i = 0; i < patches; ++i) side.name += side.patch[i].share * side.patch[i].name; \
  }                                                                                          \
  if constexpr (field_sum::sum == field_sum::greatest) {                                     \
    side.name = side.patch[0].name;                                                          \
    for (int i = 1; i < patches; ++i)                                                        \
      if (exceeds(side.patch[i].name, side.name)) side.name = side.patch[i].name;            \
  }

template <class Side>
void sum_loaded(Side &side) {
  const int patches = count_of(side);
  RP_PATCH_RESULT_FIELDS(RP_SUM_PATCHES, RP_NONE)
}

#define RP_SUM_RATES(type, name, count, role, mirror, unloaded, sum, ...)                        \
  if constexpr (field_sum::sum == field_sum::by_share) {                                         \
    rate.name = 0;                                                                               \
    for (int i = 0; i < patches; ++i)                                                            \
      rate.name +=                                                                               \
          rate.patch[i].share * value.patch[i].name + value.patch[i].share * rate.patch[i].name; \
  }                                                                                              \
  if constexpr (field_sum::sum == field_sum::greatest) {                                         \
    int most = 0;                                                                                \
    for (int i = 1; i < patches; ++i)                                                            \
      if (exceeds(value.patch[i].name, value.patch[most].name)) most = i;                        \
    rate.name = rate.patch[most].name;                                                           \
  }

template <class Side>
void sum_rates(const Side &value, Side &rate) {
  const int patches = count_of(value);
  RP_PATCH_RESULT_FIELDS(RP_SUM_RATES, RP_NONE)
}

#define RP_SUM_SIDES(type, name, count, role, mirror, unloaded, sum, ...)                          \
  if constexpr (field_sum::sum == field_sum::added) {                                              \
    for_each_in(out.name, [](auto &v) { v = 0; });                                                 \
    for (int s = 0; s < 2; ++s)                                                                    \
      if (there[s]) add(out.name, out.side[s].name);                                               \
  }                                                                                                \
  if constexpr (field_sum::sum == field_sum::greatest) {                                           \
    const bool right = !there[0] || (there[1] && exceeds(value.side[1].name, value.side[0].name)); \
    out.name = out.side[right].name;                                                               \
  }

template <class Result>
void sum_wheels(const bool (&there)[2], const Result &value, Result &out) {
  RP_SIDE_RESULT_FIELDS(RP_SUM_SIDES, RP_NONE)
}

}  // namespace

void sum_patches(const patch_scene &scene, rp_side_result &side) {
  if (scene.heat) {
    side.wheel_temperature = scene.heat->bodies.body[0].bulk;
    side.rail_temperature = scene.heat->bodies.body[1].bulk;
  }
  if (count_of(side) > 0) return sum_loaded(side);
  rp_patch_result none = empty_patch_result();
  set_unloaded(scene, none);
  take_unloaded(none, side);
}

void sum_patch_rates(const rp_side_result &value, rp_side_result &rate) {
  if (count_of(value) > 0) sum_rates(value, rate);
}

void sum_sides(const bool (&there)[2], const rp_result &value, rp_result &sum) {
  sum_wheels(there, value, sum);
}

}  // namespace railpatch
