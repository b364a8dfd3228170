#include "profile_file.hpp"

#include <cstdint>
#include <cstring>

#include "checksum.hpp"
#include "log.hpp"
#include "words.hpp"

namespace railpatch::fmu {

namespace {

constexpr std::string_view kHead = "railpatch-profile 1";

bool read_line(std::string_view line, ProfileFile &file) {
  Words words(line);
  const std::string_view key = words.next();
  if (key == "body") {
    const std::string_view body = words.next();
    file.rail = body == "rail";
    return (file.rail || body == "wheel") && words.done();
  }
  std::string name;
  if (key == "name") return read_text(words.next(), name) && words.done();
  for (size_t i = 0; i < 5; ++i)
    if (key == profile_arrays[i]) return read_values(words, file.arrays[i]) && words.done();
  return false;
}

bool complete(const ProfileFile &file) {
  for (const auto &array : file.arrays)
    if (array.size() != file.arrays[0].size() || array.size() < 2) return false;
  return true;
}

}  // namespace

bool parse_profile(const std::string &path, const std::string &content, bool rail,
                   ProfileFile &file, std::string &problem) {
  file = {};
  const std::string_view all(content);
  size_t number = 0;
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
      if (!complete(file)) {
        problem = "its arrays are not there or differ in length";
        return false;
      }
      if (file.rail != rail) {
        problem = rail ? "it is the profile of a wheel" : "it is the profile of a rail";
        return false;
      }
      file.path = path;
      file.content = content;
      file.number = 1.0 + crc32(content.data(), content.size());
      return true;
    }
    if (number > 1 && !read_line(line, file)) {
      if (all.find("\nend ") == all.npos) break;
      problem = "line " + text_of_whole(number) + " is not understood";
      return false;
    }
    begin = end + 1;
  }
  problem = "it has no end: it was cut off";
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
