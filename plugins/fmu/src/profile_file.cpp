#include "profile_file.hpp"

#include <cstdint>
#include <cstring>
#include <initializer_list>

#include "checksum.hpp"
#include "log.hpp"
#include "words.hpp"

namespace railpatch::fmu {

namespace {

constexpr std::string_view kHead = "railpatch-profile 1";

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text.append(part);
  return text;
}

// A word of a file, not more of it than a message bears.
std::string_view cut(std::string_view word) { return word.substr(0, 30); }

// What is wrong with "KEY COUNT VALUE...", whose values could not be read; rest: after KEY.
std::string problem_of_values(std::string_view key, std::string_view rest) {
  Words words(rest);
  size_t announced = 0;
  if (!words.number(announced))
    return joined({"'", key, "' says no count, expected a whole number after it"});
  size_t read = 0;
  for (double value = 0; !words.done(); ++read) {
    Words next = words;
    const std::string_view word = next.next();
    if (words.number(value)) continue;
    return joined({"'", key, "' has '", cut(word), "' as value ", text_of_whole(read + 1),
                   ", expected a finite number"});
  }
  return joined({"'", key, "' announces ", text_of_whole(announced), " values and has ",
                 text_of_whole(read)});
}

// Empty: the line is understood.
std::string problem_of_line(std::string_view line, ProfileFile &file) {
  Words words(line);
  const std::string_view key = words.next();
  if (key == "body") {
    const std::string_view body = words.next();
    file.rail = body == "rail";
    if ((file.rail || body == "wheel") && words.done()) return {};
    return joined({"'body' is '", cut(body), "', expected wheel or rail"});
  }
  std::string name;
  if (key == "name") {
    if (read_text(words.next(), name) && words.done()) return {};
    return joined({"'name' is not one word, expected %20 in place of a blank"});
  }
  for (size_t i = 0; i < 5; ++i) {
    if (key != profile_arrays[i]) continue;
    if (read_values(words, file.arrays[i]) && words.done()) return {};
    return problem_of_values(key, line.substr(line.find(key) + key.size()));
  }
  return joined(
      {"begins with '", cut(key), "', expected body, name, arc_length, y, z, dy, dz or end"});
}

// Empty: all arrays are there, of one length.
std::string problem_of_arrays(const ProfileFile &file) {
  const size_t count = file.arrays[0].size();
  for (size_t i = 0; i < 5; ++i) {
    const size_t has = file.arrays[i].size();
    const std::string_view name = profile_arrays[i];
    if (has == 0) return joined({"its array '", name, "' is missing"});
    if (has < 2) return joined({"its array '", name, "' has 1 value, expected 2 or more"});
    if (has != count)
      return joined({"its arrays differ in length: 'arc_length' has ", text_of_whole(count),
                     " values, '", name, "' has ", text_of_whole(has)});
  }
  return {};
}

// Of a file that ends before its end: how far it goes, and what is wrong with its last line.
std::string problem_of_end(size_t lines, const std::string &last) {
  if (lines == 0) return joined({"it has no end: it was cut off: it is empty"});
  return joined({"it has no end: it was cut off in line ", text_of_whole(lines),
                 last.empty() ? "" : ", where ", last,
                 "; expected a last line 'end' with its checksum"});
}

}  // namespace

bool parse_profile(const std::string &path, const std::string &content, bool rail,
                   ProfileFile &file, std::string &problem) {
  file = {};
  const std::string_view all(content);
  size_t number = 0;
  std::string wrong;
  for (size_t begin = 0; begin < all.size();) {
    const size_t end = std::min(all.find('\n', begin), all.size());
    const std::string_view line = all.substr(begin, end - begin);
    ++number;
    if (number == 1 && line != kHead) {
      problem = "it is no prepared profile, which `railpatch profile FILE -o NAME.profile` makes";
      return false;
    }
    if (line.substr(0, 4) == "end ") {
      if (!check_end(all, begin, line)) {
        if (all.back() != '\n') break;
        problem = "its checksum is wrong: it was altered";
        return false;
      }
      problem = problem_of_arrays(file);
      if (!problem.empty()) return false;
      if (file.rail != rail) {
        problem = rail ? "it is the profile of a wheel" : "it is the profile of a rail";
        return false;
      }
      file.path = path;
      file.content = content;
      file.number = 1.0 + crc32(content.data(), content.size());
      return true;
    }
    if (number > 1) wrong = problem_of_line(line, file);
    if (!wrong.empty()) {
      if (all.find("\nend ") == all.npos) break;
      problem = joined({"line ", text_of_whole(number), " is not understood: ", wrong});
      return false;
    }
    begin = end + 1;
  }
  problem = problem_of_end(number, wrong);
  return false;
}

std::vector<unsigned char> bytes_of(const ProfileFiles &files) {
  std::vector<unsigned char> bytes;
  for (const auto &file : files) {
    for (const std::string *text : {&file.path, &file.content}) {
      const uint64_t size = text->size();
      const auto *from = reinterpret_cast<const unsigned char *>(&size);
      bytes.insert(bytes.end(), from, from + sizeof size);
      bytes.insert(bytes.end(), text->begin(), text->end());
    }
  }
  return bytes;
}

bool files_of(const unsigned char *bytes, size_t size, ProfileFiles &files) {
  size_t at = 0;
  const auto next = [&](std::string &text) {
    uint64_t length = 0;
    if (size - at < sizeof length) return false;
    std::memcpy(&length, bytes + at, sizeof length);
    at += sizeof length;
    if (size - at < length) return false;
    text.assign(reinterpret_cast<const char *>(bytes) + at, static_cast<size_t>(length));
    at += static_cast<size_t>(length);
    return true;
  };
  for (size_t i = 0; i < files.size(); ++i) {
    std::string path, content, problem;
    if (!next(path) || !next(content)) return false;
    files[i] = {};
    if (!content.empty() && !parse_profile(path, content, i >= 2, files[i], problem)) return false;
  }
  return at == size;
}

}  // namespace railpatch::fmu
