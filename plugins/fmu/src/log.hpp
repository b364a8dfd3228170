// Messages to the host's logger: only the declared categories. What tells of an error is said
// whatever logging is set to, with FMI 2.0 a discard too (FMI 3.0.3, 2.2.3: errors alone). Nothing
// is printed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "types.hpp"

namespace railpatch::fmu {

enum class Category : uint32_t { error = 1, discard = 2, warning = 4 };

// The host's logger, of either version.
struct Listener {
  // hands on a message; null: there is no logger
  void (*tell)(const Listener &listener, const char *instance_name, Status status,
               const char *category, const char *text) = nullptr;
  void (*logger)() = nullptr;  // as the host gave it
  void *environment = nullptr;
  bool format = false;    // the text is a printf format, in which "#" opens a value reference
  bool discards = false;  // told of them whatever logging is set to
};

class Log {
 public:
  Log(const char *instance_name, const Listener &listener, bool on);

  void say(Status status, Category category, const std::string &text);
  void error(const std::string &text) { say(Status::error, Category::error, text); }
  // The same where there is no memory left; the text as it is.
  void error_without_memory(const char *text) const noexcept;
  // count 0: all categories; false for one that is not declared, then nothing changes
  bool set(bool on, size_t count, const char *const categories[]);

 private:
  std::string instance_name_;
  Listener listener_;
  uint32_t categories_ = 0;
  std::string last_;
  int repeats_ = 0;
};

std::string text_of(double value);
// Of whole numbers. std::to_string holds a table that keeps a library of GCC's from being unloaded,
// where its symbols are not hidden: in one that an importer compiles.
std::string whole_text(long long value);
template <class T>
std::string text_of_whole(T value) {
  return whole_text(static_cast<long long>(value));
}

}  // namespace railpatch::fmu
