// Messages to the host's logger: only the declared categories, never with an open "%" or "#". What
// tells of an error or a discard is said whatever logging is set to. Nothing is printed.
#pragma once

#include <cstdint>
#include <string>

#include "fmi2FunctionTypes.h"

namespace railpatch::fmu {

enum class Category : uint32_t { error = 1, discard = 2, warning = 4 };

class Log {
 public:
  // functions may be null
  Log(const char *instance_name, const fmi2CallbackFunctions *functions, bool on);

  void say(fmi2Status status, Category category, const std::string &text);
  void error(const std::string &text) { say(fmi2Error, Category::error, text); }
  // The same where there is no memory left; the text as it is.
  void error_without_memory(const char *text) const noexcept;
  // count 0: all categories; false for one that is not declared, then nothing changes
  bool set(bool on, size_t count, const fmi2String categories[]);

 private:
  std::string instance_name_;
  fmi2CallbackLogger logger_ = nullptr;
  fmi2ComponentEnvironment environment_ = nullptr;
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
