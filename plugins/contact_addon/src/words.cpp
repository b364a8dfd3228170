#include "words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>

namespace contact_addon {

namespace {

constexpr size_t most_bytes = 20'000'000, most_columns = 256;

bool digit(char c) { return c >= '0' && c <= '9'; }

// A number in any Fortran form, whole.
std::optional<double> number_of(std::string text) {
  size_t at = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  size_t count = 0;
  for (; at < text.size() && digit(text[at]); ++at) ++count;
  if (at < text.size() && text[at] == '.')
    for (++at; at < text.size() && digit(text[at]); ++at) ++count;
  if (count == 0) return {};
  if (at < text.size()) {
    if (std::string("eEdD").find(text[at]) == std::string::npos) return {};
    text[at++] = 'e';
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    if (at == text.size()) return {};
    for (; at < text.size(); ++at)
      if (!digit(text[at])) return {};
  }
  double value = 0;
  const char *begin = text.c_str() + (text[0] == '+' ? 1 : 0), *stop = text.c_str() + text.size();
  const auto [used, error] = std::from_chars(begin, stop, value);
  if (error != std::errc() || used != stop || !std::isfinite(value)) return {};
  return value;
}

std::optional<double> number_of(const std::string &text, bool angle) {
  if (angle && !text.empty()) {
    const size_t unit = text.find_first_not_of("+-.0123456789");
    std::string name = unit == std::string::npos ? "" : text.substr(unit);
    for (char &c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool degrees = name == "d" || name == "deg" || name == "degrees";
    if (degrees || name == "r" || name == "rad" || name == "radians") {
      const auto value = number_of(text.substr(0, unit));
      if (!value) return {};
      return degrees ? *value * (std::numbers::pi / 180) : *value;
    }
  }
  return number_of(text);
}

}  // namespace

words::words(std::string name, const std::string &text) : name_(std::move(name)) {
  std::istringstream stream(text);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.size() > most_columns)
      throw input_error(name_ + ", line " + std::to_string(number) +
                        ": is longer than 256 characters");
    line.resize(std::min(line.find('%'), line.size()));
    std::vector<word> row;
    for (size_t at = 0; at < line.size();) {
      const std::string apart = " \t,=\f\v\r";
      if (apart.find(line[at]) != std::string::npos) {
        ++at;
        continue;
      }
      size_t end = line[at] == '\'' ? line.find('\'', at + 1) : std::string::npos;
      end =
          end != std::string::npos ? end + 1 : std::min(line.find_first_of(apart, at), line.size());
      row.push_back({line.substr(at, end - at), number});
      at = end;
    }
    if (!row.empty()) rows_.push_back(std::move(row));
  }
}

words words::of_file(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw input_error(path + ": file not found");
  std::string text;
  text.resize(most_bytes + 1);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  if (text.size() > most_bytes) throw input_error(path + ": is larger than 20 MB");
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);
  return words(path.substr(path.find_last_of("/\\") + 1), text);
}

std::string words::shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

int words::line() const {
  return rows_.empty() ? 0 : rows_[std::min(row_, rows_.size() - 1)].front().line;
}

void words::fail(const std::string &what, int line) const {
  throw input_error(name_ + ", line " + std::to_string(line > 0 ? line : this->line()) + ": " +
                    what);
}

void words::expect(const std::string &names) {
  const bool at_end = !ended() && at_ >= rows_[row_].size();
  const size_t row = std::min(row_ + (at_end ? 1 : 0), rows_.size() - 1);
  const int line = rows_.empty() ? 0 : rows_[row].front().line;
  if (now_.line < line) before_ = now_;
  now_ = {names, line};
}

std::string words::told() const {
  const bool several = now_.names.find(' ') != std::string::npos;
  std::string text = several ? ", in " + now_.names : "";
  if (before_.line > 0)
    text += "; before it line " + std::to_string(before_.line) + " was read as " + before_.names;
  return text;
}

void words::end_line() {
  if (at_ > 0) ++row_, at_ = 0;
}

const words::word &words::next(const char *what) {
  while (!ended() && at_ >= rows_[row_].size()) ++row_, at_ = 0;
  if (ended()) throw input_error(name_ + ": ends where " + what + " is needed" + told());
  return rows_[row_][at_++];
}

double words::real(const char *what, bool angle) {
  const word &found = next(what);
  const auto value = number_of(found.text, angle);
  if (!value)
    fail(std::string(what) + ": expected a number, found '" + found.text.substr(0, 40) + "'" +
             told(),
         found.line);
  return *value;
}

std::optional<double> words::optional(bool angle) {
  if (ended() || at_ >= rows_[row_].size()) return {};
  const auto value = number_of(rows_[row_][at_].text, angle);
  if (value) ++at_;
  return value;
}

int words::whole(const char *what) {
  const int line = this->line();
  const double value = real(what);
  if (value != std::floor(value) || std::fabs(value) > 2147483647.0)
    fail(std::string(what) + ": expected a whole number" + told(), line);
  return static_cast<int>(value);
}

std::string words::digits(const char *what) {
  expect(what);
  const word &found = next(what);
  if (found.text.empty() || found.text.size() > 9 ||
      !std::all_of(found.text.begin(), found.text.end(), digit))
    fail(std::string(what) + ": expected digits, found '" + found.text.substr(0, 40) + "'" + told(),
         found.line);
  return found.text;
}

std::string words::string(const char *what) {
  const word &found = next(what);
  const std::string &t = found.text;
  if (t.size() < 2 || t.front() != '\'' || t.back() != '\'' || t.find('\'', 1) != t.size() - 1)
    fail(std::string(what) + ": expected a name in '...', found '" + t.substr(0, 40) + "'" + told(),
         found.line);
  const size_t first = t.find_first_not_of(" \t", 1);
  if (first >= t.size() - 1) return {};
  return t.substr(first, t.find_last_not_of(" \t", t.size() - 2) - first + 1);
}

}  // namespace contact_addon
