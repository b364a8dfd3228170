#include "words.hpp"

#include <cstdio>

#include "checksum.hpp"

namespace railpatch::fmu {

namespace {

int hex_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

bool read_values(Words &words, std::vector<double> &values) {
  size_t count = 0;
  // a value takes two characters at least
  if (!words.number(count) || count > words.left()) return false;
  values.resize(count);
  for (double &value : values)
    if (!words.number(value)) return false;
  return true;
}

bool read_text(std::string_view word, std::string &text) {
  for (size_t i = 0; i < word.size(); ++i) {
    if (word[i] != '%') {
      text += word[i];
      continue;
    }
    const int high = i + 2 < word.size() ? hex_of(word[i + 1]) : -1;
    const int low = high >= 0 ? hex_of(word[i + 2]) : -1;
    if (low < 0) return false;
    if (high + low > 0) text += static_cast<char>(16 * high + low);
    i += 2;
  }
  return !word.empty();
}

bool check_end(std::string_view text, size_t begin, std::string_view line) {
  Words words(line.substr(3));
  const std::string_view word = words.next();
  char found[16];
  std::snprintf(found, sizeof found, "%08x", static_cast<unsigned>(crc32(text.data(), begin)));
  return word == found;
}

}  // namespace railpatch::fmu
