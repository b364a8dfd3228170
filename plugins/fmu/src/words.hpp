// Text as scene.txt and profile files have it: words, numbers and lists of them, that the locale
// does not touch, and a checksum at the end.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace railpatch::fmu {

// the arrays of a profile, in the order of rp_profile
inline constexpr std::string_view profile_arrays[] = {"arc_length", "y", "z", "dy", "dz"};

// The words of one line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view next() {
    const size_t start = rest_.find_first_not_of(' ');
    if (start == std::string_view::npos) return rest_ = {};
    rest_.remove_prefix(start);
    const std::string_view word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(word.size());
    return word;
  }

  // A whole number, as doubles hold it: see text_of_whole.
  template <class T>
  bool number(T &value) {
    double read = 0;
    constexpr auto low = static_cast<double>(std::numeric_limits<T>::min());
    const double high = std::min(static_cast<double>(std::numeric_limits<T>::max()), 0x1p53);
    if (!number(read) || read != std::floor(read) || read < low || read > high) return false;
    value = static_cast<T>(read);
    return true;
  }

  bool number(double &value) { return number_of(next(), value); }
  // "-" stands for NaN: what is left out.
  bool number_or_none(double &value) {
    const std::string_view word = next();
    if (word != "-") return number_of(word, value);
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }

  bool done() { return rest_.find_first_not_of(' ') == std::string_view::npos; }
  size_t left() const { return rest_.size(); }

 private:
  static bool number_of(std::string_view word, double &value) {
    const char *end = word.data() + word.size();
    if (word.empty()) return false;
    const auto read = std::from_chars(word.data(), end, value);
    return read.ec == std::errc() && read.ptr == end && std::isfinite(value);
  }

  std::string_view rest_;
};

// COUNT VALUE...
bool read_values(Words &words, std::vector<double> &values);
// %xx stands for a byte, %00 for nothing. False where a code is cut off.
bool read_text(std::string_view word, std::string &text);
// Whether the line "end CRC" has the checksum of all that stands before it.
bool check_end(std::string_view text, size_t begin, std::string_view line);

}  // namespace railpatch::fmu
