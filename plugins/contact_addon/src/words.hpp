// The words of an input file: numbers, angles, strings, over lines, with what may be left out.
// Equal to railpatch/inp/words.py, whose messages also say what a line holds and which digit asks
// for it.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace contact_addon {

// A file that is not understood: the text names file and line.
struct input_error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class words {
 public:
  // name: of the file, for errors. Raises input_error.
  words(std::string name, const std::string &text);
  // Of a file. Raises input_error.
  static words of_file(const std::string &path);
  // A number as messages show it.
  static std::string shown(double value);

  bool ended() const { return row_ >= rows_.size(); }
  // Of the next word, or the last line.
  int line() const;
  [[noreturn]] void fail(const std::string &what, int line = 0) const;
  // Says for errors what is read from here on: values by name, or what stands for them.
  void expect(const std::string &names);
  // What is left of the line is comment.
  void end_line();
  // A mandatory number; angle: degrees as 90d, radians as 1.57r.
  double real(const char *what, bool angle = false);
  // A number that stands on the line of the last one.
  std::optional<double> optional(bool angle = false);
  int whole(const char *what);
  // A control word.
  std::string digits(const char *what);
  // A text between apostrophes.
  std::string string(const char *what);

 private:
  struct word {
    std::string text;
    int line;
  };
  const word &next(const char *what);
  // Which line was expected where a word does not fit, and which was read before it.
  std::string told() const;

  std::string name_;
  std::vector<std::vector<word>> rows_;
  size_t row_ = 0, at_ = 0;
  struct expected {
    std::string names;
    int line = 0;
  };
  expected now_, before_;
};

}  // namespace contact_addon
