// Stands first in the sources that an FMU carries. fmpy compiles them by the compiler's own
// default, which is C++17 for GCC up to 15; of C++20's library they need no more than this.
#pragma once

#include <type_traits>

#if __cplusplus < 202002L
namespace std {
template <class T>
struct type_identity {
  using type = T;
};
template <class T>
using type_identity_t = typename type_identity<T>::type;
namespace numbers {
inline constexpr double pi = 3.141592653589793238462643383279502884;
inline constexpr double ln2 = 0.693147180559945309417232121458176568;
inline constexpr double inv_sqrtpi = 0.564189583547756286948079451560772586;
}  // namespace numbers
}  // namespace std
#endif
