#include "lists.hpp"

#include <nanobind/stl/string.h>

#include <cstddef>
#include <string>
#include <type_traits>

#include "railpatch_fields.h"
#include "words.hpp"

namespace railpatch::python {

namespace {

// extents of an array, none of a single number
template <typename T>
nb::tuple shape_of() {
  if constexpr (std::rank_v<T> == 2) {
    return nb::make_tuple(std::extent_v<T, 0>, std::extent_v<T, 1>);
  } else if constexpr (std::rank_v<T> == 1) {
    return nb::make_tuple(std::extent_v<T>);
  } else {
    return nb::make_tuple();
  }
}

// of a result
template <typename T>
nb::dict quantity(const char *type, const char *role, const char *mirror, const char *sum,
                  const char *unit, const char *text) {
  nb::dict to;
  to["type"] = type;
  to["shape"] = shape_of<T>();
  to["role"] = role;
  to["mirror"] = mirror;
  to["sum"] = sum;
  to["unit"] = unit;
  to["text"] = text;
  return to;
}

// of a config or an input
template <typename T>
nb::dict field(const char *type, const char *role, const char *where,
               std::remove_all_extents_t<T> start, const char *bounds, double low, double high,
               const char *unit, const char *text) {
  nb::dict to;
  to["type"] = type;
  to["shape"] = shape_of<T>();
  to["role"] = role;
  to["where"] = where;
  if constexpr (std::is_enum_v<std::remove_all_extents_t<T>>) {
    to["start"] = Words<std::remove_all_extents_t<T>>::all[start];
  } else {
    to["start"] = start;
  }
  to["bounds"] = bounds;
  to["low"] = low;
  to["high"] = high;
  to["unit"] = unit;
  to["text"] = text;
  return to;
}

}  // namespace

#define RAILPATCH_SKIP(type, name, count)
#define RAILPATCH_QUANTITY(type, name, count, role, mirror, unloaded, sum, start, unit, text) \
  to[#name] = quantity<decltype(whole::name)>(#type, #role, #mirror, #sum, unit, text);
#define RAILPATCH_FIELD(type, name, count, role, where, start, bounds, low, high, unit, text) \
  to[#name] =                                                                                 \
      field<decltype(whole::name)>(#type, #role, #where, start, bounds, low, high, unit, text);
#define RAILPATCH_INPUT(type, name, count, role, where, start, bounds, low, high, scale, unit, \
                        text)                                                                  \
  RAILPATCH_FIELD(type, name, count, role, where, start, bounds, low, high, unit, text)

nb::dict listed_quantities() {
  nb::dict all;
  {
    using whole = rp_patch_result;
    nb::dict to;
    RP_PATCH_RESULT_FIELDS(RAILPATCH_QUANTITY, RAILPATCH_SKIP)
    all["patch"] = to;
  }
  {
    using whole = rp_side_result;
    nb::dict to;
    RP_SIDE_RESULT_FIELDS(RAILPATCH_QUANTITY, RAILPATCH_SKIP)
    all["side"] = to;
  }
  using whole = rp_result;
  nb::dict to;
  RP_RESULT_FIELDS(RAILPATCH_QUANTITY, RAILPATCH_SKIP)
  all["result"] = to;
  return all;
}

// a type's name without rp_ -> its words
nb::dict listed_choices() {
  nb::dict to;
#define RAILPATCH_CHOICE(type, LIST)                              \
  {                                                               \
    nb::list words;                                               \
    for (const char *word : Words<type>::all) words.append(word); \
    to[#type + 3] = nb::tuple(words);                             \
  }
  RP_CHOICES(RAILPATCH_CHOICE)
  return to;
}

nb::dict listed_config() {
  using whole = rp_config;
  nb::dict to;
  RP_CONFIG_FIELDS(RAILPATCH_FIELD, RAILPATCH_SKIP)
  return to;
}

nb::dict listed_ranges() {
  nb::dict to;
#define RAILPATCH_RANGE(name, low, high) to[#name] = nb::make_tuple(low, high);
  RP_PLAUSIBLE_RANGES(RAILPATCH_RANGE)
  return to;
}

nb::dict listed_input() {
  using whole = rp_input;
  nb::dict to;
  RP_INPUT_FIELDS(RAILPATCH_INPUT, RAILPATCH_SKIP)
  return to;
}

namespace {

// as numpy writes it
template <typename T>
const char *format_of() {
  using number = std::remove_all_extents_t<T>;
  if constexpr (std::is_same_v<number, double>) {
    return "<f8";
  } else {
    static_assert(sizeof(number) == 4);
    return std::is_same_v<number, uint32_t> ? "<u4" : "<i4";
  }
}

}  // namespace

#define RAILPATCH_MEMBER(type, name, ...)                                               \
  to[#name] = nb::make_tuple(offsetof(whole, name), format_of<decltype(whole::name)>(), \
                             shape_of<decltype(whole::name)>());
#define RAILPATCH_INNER(type, name, count) \
  to[#name] = nb::make_tuple(offsetof(whole, name), nb::str(#name), nb::make_tuple(int{count}));
#define RAILPATCH_LAYOUT(type, key, LIST, OTHER) \
  {                                              \
    using whole = type;                          \
    nb::dict to, layout;                         \
    LIST(RAILPATCH_MEMBER, OTHER)                \
    layout["size"] = sizeof(whole);              \
    layout["members"] = to;                      \
    all[key] = layout;                           \
  }

nb::dict layouts() {
  nb::dict all;
  RAILPATCH_LAYOUT(rp_input, "input", RP_INPUT_FIELDS, RAILPATCH_SKIP)
  RAILPATCH_LAYOUT(rp_patch_result, "patch", RP_PATCH_RESULT_FIELDS, RAILPATCH_SKIP)
  RAILPATCH_LAYOUT(rp_side_result, "side", RP_SIDE_RESULT_FIELDS, RAILPATCH_INNER)
  RAILPATCH_LAYOUT(rp_result, "result", RP_RESULT_FIELDS, RAILPATCH_INNER)
  return all;
}

}  // namespace railpatch::python
