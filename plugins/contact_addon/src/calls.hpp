// What the files of calls share.
#pragma once

#include <cstdio>
#include <string>

#include "contact_addon.h"
#include "log.hpp"
#include "registry.hpp"

namespace contact_addon {

// A string of an interface without end marks; blank: empty.
inline std::string text_of(const char *text, const int *length) {
  if (text == nullptr || length == nullptr || *length <= 0) return {};
  std::string out(text, static_cast<size_t>(*length < 256 ? *length : 256));
  if (const size_t end = out.find('\0'); end != std::string::npos) out.resize(end);
  const size_t first = out.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return out.substr(first, out.find_last_not_of(' ') - first + 1);
}

inline std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

inline bool any_null() { return false; }
template <class... Rest>
bool any_null(const void *first, Rest... rest) {
  return first == nullptr || any_null(rest...);
}

// Says that a pointer is missing, and ends the call; of setters, which have no error argument.
#define CONTACT_ADDON_NEEDS(call, ...)                  \
  if (contact_addon::any_null(__VA_ARGS__)) {           \
    contact_addon::say(call, "an argument is missing"); \
    return;                                             \
  }

// Whether a list has the number of values that it should; else that is said and nothing changed.
inline bool counted(const char *call, int count, int wanted) {
  if (count == wanted) return true;
  say(call, "has " + std::to_string(count) + " values, needs " + std::to_string(wanted) +
                ": nothing is changed");
  return false;
}

// Whether all values are numbers; else that is said.
inline bool finite(const char *call, const double *values, int count) {
  for (int i = 0; i < count; ++i)
    if (!(values[i] - values[i] == 0)) {
      say(call, "value " + std::to_string(i + 1) + " is not finite: nothing is changed");
      return false;
    }
  return true;
}

// A count that is given as a real number.
inline int count_of(double value) {
  return value >= 1 && value <= 100000 ? static_cast<int>(value + 0.5) : 0;
}

// A name below a folder, unless it is an absolute one.
std::string below_folder(const std::string &folder, const std::string &path);
// A profile's file, by the lists of cntc_setprofileinputfname; what goes wrong is told by
// cntc_calculate.
int set_profile(const char *call, problem &p, const std::string &path, int nints, const int *ints,
                int nreals, const double *reals);

// Sets a member of the configuration; notes where that is a change.
template <class T>
void put(problem &p, T &member, const T &value) {
  if (member == value) return;
  member = value;
  p.changed = true;
}

}  // namespace contact_addon
