// Holds the lists of railpatch_fields.h to the structs of railpatch.h: a struct made from each list
// has every member at the same place, with the same type, and no member is left over. Nothing here
// becomes code.
#include <cstddef>
#include <type_traits>
#include <utility>

#include "railpatch_fields.h"

namespace railpatch {

namespace {

// stands for a value of any type, to count what initialises a struct
struct anything {
  template <class T>
  operator T() const;
};

template <class T, size_t... Index>
constexpr auto takes(std::index_sequence<Index...>)
    -> decltype(T{(static_cast<void>(Index), anything{})...}, true) {
  return true;
}
template <class T>
constexpr bool takes(...) {
  return false;
}
// Whether a struct has so many numbers, pointers and structs in it, those of arrays counted one by
// one. Places alone do not tell: a short member may lie where there was padding.
template <class T, size_t count>
constexpr bool holds() {
  return takes<T>(std::make_index_sequence<count>{}) &&
         !takes<T>(std::make_index_sequence<count + 1>{});
}

#define RP_DECLARE(type, name, count, ...) type name[count];
#define RP_ADD(type, name, count, ...) +(count)
#define RP_TIE(type, name, count, ...)                                                  \
  static_assert(offsetof(listed, name) == offsetof(whole, name),                        \
                "the list forgets a member before " #name ", or its order is another"); \
  static_assert(std::is_same_v<std::remove_all_extents_t<decltype(whole::name)>, type>, \
                "the type of " #name " is another in the list");                        \
  static_assert(sizeof(listed::name) == sizeof(whole::name),                            \
                "the count of " #name " is another in the list");

#define RP_TIE_STRUCT(LIST, struct_name)                                    \
  namespace struct_name##_list {                                            \
    using whole = struct_name;                                              \
    struct listed {                                                         \
      LIST(RP_DECLARE, RP_DECLARE)                                          \
    };                                                                      \
    LIST(RP_TIE, RP_TIE)                                                    \
    static_assert(sizeof(listed) == sizeof(whole),                          \
                  "the list of " #struct_name " forgets its last members"); \
    static_assert(holds<whole, 0 LIST(RP_ADD, RP_ADD)>(),                   \
                  "the list of " #struct_name " forgets a member");         \
  }

RP_TIE_STRUCT(RP_PATCH_RESULT_FIELDS, rp_patch_result)
RP_TIE_STRUCT(RP_SIDE_RESULT_FIELDS, rp_side_result)
RP_TIE_STRUCT(RP_RESULT_FIELDS, rp_result)
RP_TIE_STRUCT(RP_CONFIG_FIELDS, rp_config)
RP_TIE_STRUCT(RP_INPUT_FIELDS, rp_input)

// values of choices count from 0 in the order of their lists
#define RP_PLACE(name, value, word) name##_place,
#define RP_TIE_PLACE(name, value, word)                  \
  static_assert(static_cast<int>(name##_place) == value, \
                "the value of " #name " is not its place in its list");
#define RP_TIE_CHOICES(type, LIST)    \
  enum type##_places{LIST(RP_PLACE)}; \
  LIST(RP_TIE_PLACE)
RP_CHOICES(RP_TIE_CHOICES)

}  // namespace

}  // namespace railpatch
