// Whether this build holds more than steady rolling of like bodies with Coulomb friction: laws
// beyond Coulomb's, layers that yield, shift and transient rolling, temperature, unlike and
// viscoelastic bodies (build option RAILPATCH_PHYSICS). The build without them serves to show that
// scenes that do not use them do not pay for them.
#pragma once

#include <optional>
#include <type_traits>

namespace railpatch {

#ifdef RAILPATCH_WITHOUT_PHYSICS
constexpr bool has_physics = false;
#else
constexpr bool has_physics = true;
#endif

// Stands where a part is left out of the build: as an empty optional, known to be so when it is
// compiled, so that all that asks for the part goes too.
template <class T>
struct left_out {
  constexpr explicit operator bool() const { return false; }
  template <class... Arguments>
  void emplace(Arguments &&...) {}
  T &operator*() const { __builtin_unreachable(); }
  T *operator->() const { __builtin_unreachable(); }
};

// A part that a scene may do without.
template <class T>
using physics_part = std::conditional_t<has_physics, std::optional<T>, left_out<T>>;

}  // namespace railpatch
