#include "scene.hpp"

#include <algorithm>
#include <string_view>
#include <type_traits>

#include "log.hpp"
#include "railpatch_fields.h"
#include "words.hpp"

namespace railpatch::fmu {

namespace {

constexpr std::string_view kHead = "railpatch-fmu-scene";
constexpr int kVersion = 1;
// no variable of the table has such references
constexpr uint32_t kFirstConstant = 4001, kLastConstant = 9999;

template <class T>
bool read_field(Words &words, T &field) {
  if constexpr (std::is_array_v<T>) {
    for (auto &item : field)
      if (!read_field(words, item)) return false;
    return true;
  } else if constexpr (std::is_enum_v<T>) {
    int value = 0;
    if (!words.number(value)) return false;
    field = static_cast<T>(value);
    return true;
  } else {
    if constexpr (std::is_same_v<T, double>) return words.number_or_none(field);
    return words.number(field);
  }
}

bool read_set(Words &words, Scene &scene) {
  const std::string_view name = words.next();
#define RAILPATCH_READ(type, field, ...) \
  if (name == #field) return read_field(words, scene.config.field);
#define RAILPATCH_SKIP(type, field, count)
  RP_CONFIG_FIELDS(RAILPATCH_READ, RAILPATCH_SKIP)
#undef RAILPATCH_READ
#undef RAILPATCH_SKIP
  return false;
}

bool read_profile(Words &words, Scene &scene) {
  const std::string_view body = words.next();
  int side = -1;
  if ((body != "wheel" && body != "rail") || !words.number(side) || side < 0 || side > 1)
    return false;
  const std::string_view name = words.next();
  for (size_t i = 0; i < 5; ++i)
    if (name == profile_arrays[i]) return read_values(words, scene.arrays[body == "rail"][side][i]);
  return false;
}

bool read_side(Words &words, size_t &side) { return words.number(side) && side < 2; }

bool read_section(Words &words, SectionLists &lists) {
  size_t side = 0, index = 0;
  if (!read_side(words, side) || !words.number(index)) return false;
  auto &sections = lists.sections[side];
  if (index > sections.size()) return false;
  if (index == sections.size()) sections.emplace_back();
  const std::string_view name = words.next();
  if (name == "position") return read_values(words, sections[index].position);
  if (name == "kink") return read_values(words, sections[index].kink);
  for (size_t i = 0; i < 5; ++i)
    if (name == profile_arrays[i]) return read_values(words, sections[index].arrays[i]);
  return false;
}

bool read_choice(Words &words, Scene &scene) {
  const std::string_view body = words.next();
  size_t number = 0;
  if ((body != "wheel" && body != "rail") || !words.number(number) || number < 2) return false;
  auto &choices = scene.choices[body == "rail"];
  if (number - 2 > choices.size()) return false;
  if (number - 2 == choices.size()) choices.emplace_back();
  const std::string_view name = words.next();
  for (size_t i = 0; i < 5; ++i)
    if (name == profile_arrays[i]) return read_values(words, choices[number - 2].arrays[i]);
  return false;
}

bool read_shape(Words &words, std::vector<double> (&sides)[2]) {
  size_t side = 0;
  return read_side(words, side) && read_values(words, sides[side]);
}

bool read_option(Words &words, Scene &scene) {
  const std::string_view name = words.next();
  Options &o = scene.options;
  if (name == "history") return words.number(o.history);
  if (name == "averaged") return words.number(o.averaged);
  if (name == "friction_input") return words.number(o.friction_input);
  if (name == "profile_files") return words.number(o.profile_files);
  if (name == "friction_sides") return words.number(o.friction_sides);
  if (name == "friction_left") return words.number(o.friction_scale[0]);
  if (name == "friction_right") return words.number(o.friction_scale[1]);
  if (name == "time_step") return words.number(o.time_step);
  return name == "distance" && words.number(o.distance);
}

bool read_variable(Words &words, Scene &scene) {
  uint32_t reference = 0;
  SceneVariable item{};
  if (!words.number(reference)) return false;
  item.name = words.next();
  item.variable = find_variable(reference);
  if (item.name.empty() || item.variable == nullptr || !words.number(item.start)) return false;
  scene.variables.push_back(std::move(item));
  return true;
}

bool read_constant(Words &words, Scene &scene) {
  uint32_t reference = 0;
  if (!words.number(reference) || reference < kFirstConstant || reference > kLastConstant)
    return false;
  const std::string_view kind = words.next();
  Type type = Type::real;
  if (kind == "integer")
    type = Type::integer;
  else if (kind == "boolean")
    type = Type::boolean;
  else if (kind == "text")
    type = Type::text;
  else if (kind != "real")
    return false;
  SceneVariable item{};
  item.name = words.next();
  if (item.name.empty()) return false;
  if (type == Type::text ? !read_text(words.next(), item.text) : !words.number(item.start))
    return false;
  scene.constants.push_back(std::make_unique<Variable>(
      Variable{reference, type, Role::constant, no_field, no_field, item.start, item.start, 0, 0, 0,
               Absent::zero, true, ""}));
  item.variable = scene.constants.back().get();
  scene.variables.push_back(std::move(item));
  return true;
}

bool read_held(Words &words, Scene &scene) {
  uint32_t reference = 0;
  if (!words.number(reference)) return false;
  for (SceneVariable &item : scene.variables) {
    if (item.variable->reference != reference) continue;
    item.held = item.variable->role == Role::input;
    return item.held && item.start == 0;
  }
  return false;
}

bool read_array(Words &words, Scene &scene) {
  SceneArray array{};
  if (!words.number(array.reference) || !words.number(array.size)) return false;
  scene.variable_arrays.push_back(array);
  return array.size > 1 && array.size <= 16;
}

bool read_line(std::string_view line, Scene &scene) {
  Words words(line);
  const std::string_view key = words.next();
  bool good = false;
  if (key == "guid") {
    scene.guid = words.next();
    good = !scene.guid.empty();
  } else if (key == "set") {
    good = read_set(words, scene);
  } else if (key == "profile") {
    good = read_profile(words, scene);
  } else if (key == "choice") {
    good = read_choice(words, scene);
  } else if (key == "distance") {
    good = read_values(words, scene.distance);
  } else if (key == "section") {
    good = read_section(words, scene.along);
  } else if (key == "wheel_section") {
    good = read_section(words, scene.around);
  } else if (key == "runout") {
    good = read_shape(words, scene.runout);
  } else if (key == "rail_height") {
    good = read_shape(words, scene.rail_height);
  } else if (key == "option") {
    good = read_option(words, scene);
  } else if (key == "variable") {
    good = read_variable(words, scene);
  } else if (key == "constant") {
    good = read_constant(words, scene);
  } else if (key == "held") {
    good = read_held(words, scene);
  } else if (key == "array") {
    good = read_array(words, scene);
  }
  return good && words.done();
}

bool connect_sections(SectionLists &lists, size_t side, const rp_profile *(&profiles)[2],
                      const double *(&positions)[2], const int32_t *(&kinks)[2],
                      int32_t (&counts)[2]) {
  if (lists.sections[side].empty()) return true;
  for (const Section &section : lists.sections[side]) {
    rp_profile profile = {};
    if (section.position.size() != 1 || !make_profile(section.arrays, profile)) return false;
    lists.profiles[side].push_back(profile);
    lists.positions[side].push_back(section.position[0]);
    lists.kinks[side].push_back(section.kink.empty() ? 0 : static_cast<int32_t>(section.kink[0]));
  }
  profiles[side] = lists.profiles[side].data();
  positions[side] = lists.positions[side].data();
  kinks[side] = lists.kinks[side].data();
  counts[side] = static_cast<int32_t>(lists.profiles[side].size());
  return true;
}

// The counts are fields of the config, and must be those of the lines.
bool connect_shape(const std::vector<double> &values, int32_t count, const double *&field) {
  field = values.empty() ? nullptr : values.data();
  return count >= 0 && values.size() == static_cast<size_t>(count);
}

// Lets the config point to the arrays.
bool connect(Scene &scene) {
  rp_config &config = scene.config;
  for (size_t side = 0; side < 2; ++side) {
    for (size_t body = 0; body < 2; ++body) {
      const auto &arrays = scene.arrays[body][side];
      rp_profile &profile = (body == 0 ? config.wheel : config.rail)[side];
      if (!arrays[0].empty() && !make_profile(arrays, profile)) return false;
    }
    if (!connect_sections(scene.along, side, config.rail_sections, config.section_position,
                          config.section_kink, config.section_count) ||
        !connect_sections(scene.around, side, config.wheel_sections, config.wheel_section_angle,
                          config.wheel_section_kink, config.wheel_section_count) ||
        !connect_shape(scene.runout[side], config.runout_count[side], config.runout[side]) ||
        !connect_shape(scene.rail_height[side], config.rail_height_count[side],
                       config.rail_height[side]))
      return false;
  }
  rp_profile unused = {};
  for (const auto &choices : scene.choices)
    for (const ProfileArrays &choice : choices)
      if (choice.arrays[0].empty() || !make_profile(choice.arrays, unused)) return false;
  if (scene.distance.empty()) return true;
  config.undeformed_distance = scene.distance.data();
  const auto *shape = config.distance_shape;
  return shape[0] > 0 && shape[1] > 0 &&
         scene.distance.size() == static_cast<size_t>(shape[0]) * static_cast<size_t>(shape[1]);
}

bool check_head(std::string_view line) {
  Words words(line);
  int version = 0;
  return words.next() == kHead && words.number(version) && version == kVersion;
}

}  // namespace

bool make_profile(const std::vector<double> (&arrays)[5], rp_profile &profile) {
  for (const auto &values : arrays)
    if (values.size() != arrays[0].size() || values.size() > INT32_MAX) return false;
  profile = {arrays[0].data(), arrays[1].data(), arrays[2].data(),
             arrays[3].data(), arrays[4].data(), static_cast<int32_t>(arrays[0].size())};
  return true;
}

bool parse_scene(const std::string &text, Scene &scene, std::string &problem) {
  rp_default_config(&scene.config);
  const std::string_view all(text);
  size_t number = 0;
  for (size_t begin = 0; begin < all.size();) {
    const size_t end = std::min(all.find('\n', begin), all.size());
    const std::string_view line = all.substr(begin, end - begin);
    ++number;
    if (line.substr(0, 4) == "end ") {
      if (check_end(all, begin, line) && connect(scene)) return true;
      problem = "its checksum is wrong: the file was altered";
      return false;
    }
    if (!(number == 1 ? check_head(line) : read_line(line, scene))) {
      problem = "line " + text_of_whole(number) +
                " is not understood: " + std::string(line.substr(0, 60));
      return false;
    }
    begin = end + 1;
  }
  problem = "it has no end: the file was cut off";
  return false;
}

}  // namespace railpatch::fmu
