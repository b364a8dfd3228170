#include "log.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>

namespace railpatch::fmu {

namespace {

constexpr uint32_t kAll = 7;
// of the same line one after the other
constexpr int kMostRepeats = 100;

constexpr struct {
  const char *name;
  uint32_t mask;
} kCategories[] = {
    {"logStatusError", static_cast<uint32_t>(Category::error)},
    {"logStatusDiscard", static_cast<uint32_t>(Category::discard)},
    {"logStatusWarning", static_cast<uint32_t>(Category::warning)},
    {"logAll", kAll},
};

const char *name_of(Category category) {
  for (const auto &known : kCategories)
    if (known.mask == static_cast<uint32_t>(category)) return known.name;
  return kCategories[0].name;
}

std::string escaped(const std::string &text) {
  std::string out;
  for (const char c : text) {
    out += c;
    if (c == '%' || c == '#') out += c;
  }
  return out;
}

}  // namespace

Log::Log(const char *instance_name, const Listener &listener, bool on)
    : instance_name_(instance_name != nullptr ? instance_name : ""),
      listener_(listener),
      categories_(on ? kAll : 0) {}

void Log::say(Status status, Category category, const std::string &text) {
  // logging is for debugging: why a call failed is said
  const bool failed = status == Status::error || (status == Status::discard && listener_.discards);
  if (listener_.tell == nullptr) return;
  if (!failed && (categories_ & static_cast<uint32_t>(category)) == 0) return;
  repeats_ = text == last_ ? repeats_ + 1 : 0;
  if (repeats_ > kMostRepeats) return;
  last_ = text;
  std::string line = listener_.format ? escaped(text) : text;
  if (repeats_ == kMostRepeats) line += " (repeats of this message are left out from here)";
  listener_.tell(listener_, instance_name_.c_str(), status, name_of(category), line.c_str());
}

void Log::error_without_memory(const char *text) const noexcept {
  if (listener_.tell != nullptr)
    listener_.tell(listener_, instance_name_.c_str(), Status::error, name_of(Category::error),
                   text);
}

bool Log::set(bool on, size_t count, const char *const categories[]) {
  uint32_t mask = count == 0 ? kAll : 0;
  for (size_t i = 0; i < count; ++i) {
    uint32_t found = 0;
    for (const auto &known : kCategories)
      if (categories[i] != nullptr && std::strcmp(categories[i], known.name) == 0)
        found = known.mask;
    if (found == 0) return false;
    mask |= found;
  }
  categories_ = on ? mask : categories_ & ~mask;
  return true;
}

std::string text_of(double value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

std::string whole_text(long long value) {
  char buffer[24];
  std::snprintf(buffer, sizeof buffer, "%lld", value);
  return buffer;
}

}  // namespace railpatch::fmu
