#include "resource.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace railpatch::fmu {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decoded(const std::string &text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low >= 0 && high + low > 0) {
      out += static_cast<char>(16 * high + low);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

bool has_scheme(const std::string &text) {
  static const char scheme[] = "file:";
  for (size_t i = 0; i < sizeof scheme - 1; ++i)
    if (i >= text.size() || (text[i] | 0x20) != (scheme[i] | 0x20)) return false;
  return true;
}

// One leading slash instead of several; no slash at the end.
std::string tidy(std::string path) {
  const size_t first = path.find_first_not_of('/');
  if (first == std::string::npos) return path.empty() ? path : "/";
  if (first > 1) path.erase(0, first - 1);
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

void add(std::vector<std::string> &paths, const std::string &path) {
  if (path.empty() || std::find(paths.begin(), paths.end(), path) != paths.end()) return;
  paths.push_back(path);
}

void add_both(std::vector<std::string> &paths, const std::string &path) {
  add(paths, tidy(decoded(path)));
  add(paths, tidy(path));
}

struct Close {
  void operator()(std::FILE *file) const { std::fclose(file); }
};

bool read_file(const std::string &path, std::string &content) {
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) return false;
  content.clear();
  char buffer[65536];
  size_t count;
  while ((count = std::fread(buffer, 1, sizeof buffer, file.get())) > 0)
    content.append(buffer, count);
  return std::ferror(file.get()) == 0;
}

}  // namespace

std::vector<std::string> resource_folders(const std::string &location) {
  std::vector<std::string> paths;
  if (!has_scheme(location)) {
    add(paths, tidy(location));
    add(paths, tidy(decoded(location)));
    return paths;
  }
  const std::string rest = location.substr(5);
  if (rest.compare(0, 2, "//") != 0) {
    add_both(paths, rest);
    return paths;
  }
  const size_t slash = rest.find('/', 2);
  const std::string host = rest.substr(2, slash == std::string::npos ? slash : slash - 2);
  if (slash != std::string::npos && (host.empty() || host == "localhost"))
    add_both(paths, rest.substr(slash));
  else
    // "file://" in front of a path without a slash: the host is its first folder
    add_both(paths, rest.substr(1));
  return paths;
}

bool read_resource(const std::string &location, const char *name, std::string &content,
                   std::string &tried) {
  tried.clear();
  for (const std::string &folder : resource_folders(location)) {
    const std::string path = folder + "/" + name;
    if (read_file(path, content)) return true;
    tried += (tried.empty() ? "" : ", ") + path;
  }
  return false;
}

}  // namespace railpatch::fmu
