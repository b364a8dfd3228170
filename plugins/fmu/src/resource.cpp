#include "resource.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#endif

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

#ifdef _WIN32
bool has_drive(const std::string &path, size_t at) {
  return at + 1 < path.size() && path[at + 1] == ':' && (path[at] | 0x20) >= 'a' &&
         (path[at] | 0x20) <= 'z';
}

// "C:/..." without slashes in front of it, "//host/share" with two; no slash at the end.
std::string tidy(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  const size_t first = path.find_first_not_of('/');
  if (first == std::string::npos) return path;
  if (first > 0 && has_drive(path, first))
    path.erase(0, first);
  else if (first > 2)
    path.erase(0, first - 2);
  while (path.back() == '/') path.pop_back();
  return path;
}
#else
// One leading slash instead of several; no slash at the end.
std::string tidy(std::string path) {
  const size_t first = path.find_first_not_of('/');
  if (first == std::string::npos) return path.empty() ? path : "/";
  if (first > 1) path.erase(0, first - 1);
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}
#endif

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

#ifdef _WIN32
// fopen would read the path in the code page of the user.
std::FILE *open_file(const std::string &path) {
  const int length = static_cast<int>(path.size()) + 1;
  std::vector<wchar_t> wide(path.size() + 1);
  if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path.c_str(), length, wide.data(),
                          length) == 0)
    return nullptr;
  return _wfopen(wide.data(), L"rb");
}
#else
std::FILE *open_file(const std::string &path) { return std::fopen(path.c_str(), "rb"); }
#endif

bool read_file(const std::string &path, std::string &content) {
  const std::unique_ptr<std::FILE, Close> file(open_file(path));
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
  if (slash != std::string::npos && (host.empty() || host == "localhost")) {
    add_both(paths, rest.substr(slash));
    return paths;
  }
#ifdef _WIN32
  // a share, or a drive in the host's place
  add_both(paths, rest);
#else
  // "file://" in front of a path without a slash: the host is its first folder
  add_both(paths, rest.substr(1));
#endif
  return paths;
}

bool read_path(const std::string &path, std::string &content, std::string &tried) {
  std::vector<std::string> paths{path};
  if (has_scheme(path)) paths = resource_folders(path);
  tried.clear();
  for (const std::string &one : paths) {
    if (read_file(one, content)) return true;
    tried += (tried.empty() ? "" : ", ") + one;
  }
  return false;
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
