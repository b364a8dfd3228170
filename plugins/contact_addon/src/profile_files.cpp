#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "angles.hpp"
#include "profile.hpp"

namespace contact_addon {

namespace {

// of a file, as those of railpatch.profiles.read
constexpr size_t most_bytes = 20'000'000;

std::string trimmed(const std::string &text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string lower(std::string text) {
  for (char &c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool ends_with(const std::string &text, const std::string &end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

[[noreturn]] void fail(const std::string &path, size_t line, const std::string &what) {
  throw profile_error(path + (line ? ", line " + std::to_string(line) : "") + ": " + what);
}

std::vector<double> numbers(const std::string &path, size_t line, const std::string &text,
                            size_t least) {
  std::vector<double> found;
  size_t at = 0;
  const auto apart = [](char c) {
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
  };
  while (at < text.size()) {
    if (apart(text[at])) {
      ++at;
      continue;
    }
    size_t end = at;
    while (end < text.size() && !apart(text[end])) ++end;
    std::string word = text.substr(at, end - at);
    at = end;
    for (char &c : word)
      if (c == 'd' || c == 'D') c = 'e';
    double value = 0;
    const char *begin = word.c_str() + (word[0] == '+' ? 1 : 0), *stop = word.c_str() + word.size();
    const auto [used, error] = std::from_chars(begin, stop, value);
    if (error != std::errc() || used != stop || !std::isfinite(value))
      fail(path, line, "expected numbers, found '" + trimmed(text).substr(0, 60) + "'");
    found.push_back(value);
  }
  if (found.size() < least)
    fail(path, line,
         "expected " + std::to_string(least) + " numbers, found '" + trimmed(text).substr(0, 60) +
             "'");
  return found;
}

std::vector<std::string> lines_of(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, 0, "file not found");
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (text.size() > most_bytes) fail(path, 0, "is larger than 20 MB");
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void append(profile_points &p, const std::string &path, size_t line, double y, double z, double w) {
  if (w < 0) fail(path, line, "a weight is negative");
  if (w == 0) return;
  p.y.push_back(y);
  p.z.push_back(z);
  p.weight.push_back(w);
}

struct simpack_file {
  std::map<std::string, std::pair<size_t, std::string>> keys;
  profile_points points;

  double number(const std::string &path, const std::string &key, double start,
                bool positive = false) const {
    const auto found = keys.find(key);
    if (found == keys.end()) return start;
    const auto &[line, text] = found->second;
    const double value = numbers(path, line, text, 1)[0];
    if (positive && !(value > 0)) fail(path, line, key + " must be > 0");
    return value;
  }
};

simpack_file split(const std::string &path, const std::vector<std::string> &lines) {
  simpack_file file;
  std::string block;
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::string words = trimmed(lines[i].substr(0, lines[i].find('!')));
    if (words.empty()) continue;
    if (ends_with(words, ".begin")) {
      block = words.substr(0, words.size() - 6);
    } else if (ends_with(words, ".end")) {
      block = block == "point" ? "spline" : "";
    } else if (block == "point") {
      const auto values = numbers(path, i + 1, words, 2);
      file.points.y.push_back(values[0]);
      file.points.z.push_back(values[1]);
      file.points.weight.push_back(values.size() > 2 ? values[2] : 1.0);
    } else if (const size_t equals = words.find('='); equals != std::string::npos) {
      std::string value = trimmed(words.substr(equals + 1));
      std::erase(value, '\'');
      file.keys[block + "." + trimmed(words.substr(0, equals))] = {i + 1, value};
    } else {
      fail(path, i + 1, "expected 'key = value', found '" + words.substr(0, 60) + "'");
    }
  }
  if (!block.empty()) fail(path, 0, "is cut off: '" + block + ".end' is missing");
  return file;
}

// Whether a point is within the bounds of one axis; a lower bound above the upper one: none.
bool within(const simpack_file &file, const std::string &path, const std::string &axis,
            double value) {
  const double low = file.number(path, "spline.bound." + axis + ".min", 1.0);
  const double high = file.number(path, "spline.bound." + axis + ".max", 0.0);
  return !(low < high) || (value >= low && value <= high);
}

// Keys count in SIMPACK's order: shift, rotation, bounds, mirror, inversion, unit.
profile_points read_simpack(const std::string &path, const std::vector<std::string> &lines,
                            const profile_options &options) {
  const simpack_file file = split(path, lines);
  if (file.points.y.empty()) fail(path, 0, "holds no points");
  const double type = file.number(path, "header.type", -1.0);
  if (type >= 0 && (type == 0) != (options.role == profile_role::rail))
    fail(path, 0, "is a profile of the other body by its header");
  if (file.number(path, "header.version", 1.0) != 1.0) fail(path, 0, "allowed version is 1");
  const double shift_y = file.number(path, "spline.shift.y", 0.0);
  const double shift_z = file.number(path, "spline.shift.z", 0.0);
  const double angle =
      file.number(path, "spline.rotate", 0.0) / file.number(path, "spline.units.ang.f", 1.0, true);
  const double c = contact_addon::cos(angle), s = contact_addon::sin(angle);
  const double apart = file.number(path, "spline.point.dist.min", 0.0);
  const double side_y = file.number(path, "spline.mirror.y", 0.0) != 0 ? -1.0 : 1.0;
  const double side_z = file.number(path, "spline.mirror.z", 0.0) != 0 ? -1.0 : 1.0;
  const double unit = file.keys.contains("spline.units.len.f")
                          ? 1.0 / file.number(path, "spline.units.len.f", 1.0, true)
                          : 1e-3 * options.scale;
  profile_points out;
  double last_y = 0, last_z = 0;
  for (size_t i = 0; i < file.points.y.size(); ++i) {
    const double y0 = file.points.y[i] + shift_y, z0 = file.points.z[i] + shift_z;
    const double y = y0 * c - z0 * s, z = y0 * s + z0 * c;
    const bool close =
        i > 0 && std::sqrt((y - last_y) * (y - last_y) + (z - last_z) * (z - last_z)) < apart;
    if (!close) last_y = y, last_z = z;
    if (close || !within(file, path, "y", y) || !within(file, path, "z", z)) continue;
    append(out, path, 0, side_y * y * unit, side_z * z * unit, file.points.weight[i]);
  }
  if (file.number(path, "spline.inversion", 0.0) != 0)
    for (auto *v : {&out.y, &out.z, &out.weight}) std::reverse(v->begin(), v->end());
  return out;
}

profile_points read_miniprof(const std::string &path, const std::vector<std::string> &lines,
                             const profile_options &options) {
  std::string columns = "x,y";
  size_t said = 0;
  profile_points out;
  bool began = false;
  size_t ix = 0, iy = 1, found = 0;
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::string row = trimmed(lines[i]);
    if (row.empty()) continue;
    const size_t equals = row.find('=');
    if (equals != std::string::npos && std::isalpha(static_cast<unsigned char>(row[0]))) {
      if (began) fail(path, i + 1, "a header line among the points");
      const std::string key = lower(trimmed(row.substr(0, equals)));
      if (key == "columndef") columns = lower(trimmed(row.substr(equals + 1)));
      if (key == "xypoints")
        said = static_cast<size_t>(numbers(path, i + 1, row.substr(equals + 1), 1)[0]);
      continue;
    }
    if (!began) {
      began = true;
      std::istringstream names(columns);
      std::vector<std::string> list;
      for (std::string name; std::getline(names, name, ',');) list.push_back(trimmed(name));
      const auto x = std::find(list.begin(), list.end(), "x"),
                 y = std::find(list.begin(), list.end(), "y");
      if (x == list.end() || y == list.end()) fail(path, 0, "ColumnDef names no columns X and Y");
      ix = static_cast<size_t>(x - list.begin());
      iy = static_cast<size_t>(y - list.begin());
    }
    const auto values = numbers(path, i + 1, row, std::max(ix, iy) + 1);
    append(out, path, i + 1, values[ix] * 1e-3 * options.scale, values[iy] * 1e-3 * options.scale,
           1.0);
    ++found;
  }
  if (said > 0 && said != found)
    fail(path, 0,
         "holds " + std::to_string(found) + " points, its header says " + std::to_string(said));
  return out;
}

profile_points read_columns(const std::string &path, const std::vector<std::string> &lines,
                            const profile_options &options) {
  profile_points out;
  bool titled = false;
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::string row = trimmed(lines[i]);
    if (row.empty() || std::string("!#%").find(row[0]) != std::string::npos ||
        row.starts_with("//"))
      continue;
    if (out.y.empty() && !titled && std::isalpha(static_cast<unsigned char>(row[0])) &&
        row.find_first_of("0123456789") == std::string::npos) {
      titled = true;
      continue;
    }
    const auto values = numbers(path, i + 1, row, 2);
    const double unit = 1e-3 * options.scale;
    append(out, path, i + 1, values[0] * unit, values[1] * unit,
           values.size() > 2 ? values[2] : 1.0);
  }
  return out;
}

}  // namespace

profile_points read_points(const std::string &path, const profile_options &options) {
  const std::string name = lower(path);
  const std::vector<std::string> lines = lines_of(path);
  bool simpack = false, headed = false;
  for (const std::string &line : lines) {
    const std::string row = trimmed(line);
    for (const char *begin : {"header.begin", "spline.begin", "point.begin"})
      simpack |= row.starts_with(begin);
    headed |= !row.empty() && std::isalpha(static_cast<unsigned char>(row[0])) &&
              row.find('=') != std::string::npos;
  }
  if (simpack) return read_simpack(path, lines, options);
  if (ends_with(name, ".prr") || ends_with(name, ".prw"))
    fail(path, 0, "is no SIMPACK profile: 'point.begin' is missing");
  return headed ? read_miniprof(path, lines, options) : read_columns(path, lines, options);
}

}  // namespace contact_addon
