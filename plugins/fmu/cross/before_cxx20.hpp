// Stands first in the sources that an FMU carries, which importers compile by their own options.
// They are C++17 there, so that parts of std::string stay in the system's C++ library and this one
// can be unloaded; of C++20's library they need no more than this. None hides what is not FMI's:
// what follows this file is hidden, so all headers of the system that sources and Eigen's
// transforms use stand here.
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cfenv>
#include <charconv>
#include <climits>
#include <cmath>
#include <complex>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>
#ifdef __linux__
#include <sys/mman.h>
#endif
#if __cplusplus >= 202002L
#include <numbers>
#include <span>
#endif

#if __cplusplus < 202002L
namespace std {
template <class T>
struct type_identity {
  using type = T;
};
template <class T>
using type_identity_t = typename type_identity<T>::type;
template <class T>
class span {
 public:
  template <class U>
  constexpr span(U &&from) : begin_(std::data(from)), size_(std::size(from)) {}
  constexpr T *begin() const { return begin_; }
  constexpr T *end() const { return begin_ + size_; }
  constexpr size_t size() const { return size_; }
  constexpr T &operator[](size_t index) const { return begin_[index]; }

 private:
  T *begin_;
  size_t size_;
};
namespace numbers {
inline constexpr double pi = 3.141592653589793238462643383279502884;
inline constexpr double ln2 = 0.693147180559945309417232121458176568;
inline constexpr double sqrt2 = 1.414213562373095048801688724209698079;
inline constexpr double inv_sqrtpi = 0.564189583547756286948079451560772586;
}  // namespace numbers
}  // namespace std
#endif

#define RP_INSIDE
#if defined(__ELF__) || defined(__APPLE__)
#pragma GCC visibility push(hidden)
#endif
