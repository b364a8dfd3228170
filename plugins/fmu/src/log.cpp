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

// The logger takes a printf format in which "#" opens a value reference.
std::string escaped(const std::string &text) {
  std::string out;
  for (const char c : text) {
    out += c;
    if (c == '%' || c == '#') out += c;
  }
  return out;
}

}  // namespace

Log::Log(const char *instance_name, const fmi2CallbackFunctions *functions, bool on)
    : instance_name_(instance_name != nullptr ? instance_name : ""), categories_(on ? kAll : 0) {
  if (functions == nullptr) return;
  logger_ = functions->logger;
  environment_ = functions->componentEnvironment;
}

void Log::say(fmi2Status status, Category category, const std::string &text) {
  // logging is for debugging: why a call failed is always said
  const bool failed = status >= fmi2Discard && status != fmi2Pending;
  if (logger_ == nullptr) return;
  if (!failed && (categories_ & static_cast<uint32_t>(category)) == 0) return;
  repeats_ = text == last_ ? repeats_ + 1 : 0;
  if (repeats_ > kMostRepeats) return;
  last_ = text;
  std::string line = escaped(text);
  if (repeats_ == kMostRepeats) line += " (repeats of this message are left out from here)";
  logger_(environment_, instance_name_.c_str(), status, name_of(category), line.c_str());
}

void Log::error_without_memory(const char *text) const noexcept {
  if (logger_ != nullptr)
    logger_(environment_, instance_name_.c_str(), fmi2Error, name_of(Category::error), text);
}

bool Log::set(bool on, size_t count, const fmi2String categories[]) {
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
