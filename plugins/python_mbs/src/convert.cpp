#include "convert.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>

#include "railpatch_fields.h"
#include "watching.hpp"
#include "words.hpp"

namespace railpatch::python {

namespace {

// --- from Python -------------------------------------------------------------------------------

// words of the lists
enum class Role { choice, side, number, place, integer, points, unmarked };

// reads the keys of a dictionary and counts them, so that a misspelt key is found at the end
class Reader {
 public:
  explicit Reader(const nb::dict &from) : from_(from) {}

  bool has(const char *key) {
    const bool found = from_.contains(key);
    read_ += found;
    return found;
  }

  nb::object at(const char *key) const { return nb::object(from_[key]); }

  template <Role role, typename T>
  void read(const char *key, T &to) {
    if constexpr (role == Role::choice) {
      word<T>(key, to);
    } else if constexpr (role == Role::side) {
      word<rp_side>(key, to);
    } else {
      if (has(key)) fill(at(key), key, to);
    }
  }

  template <typename Choice, typename T>
  void word(const char *key, T &to) {
    if (!has(key)) return;
    const auto text = nb::cast<std::string>(at(key));
    const auto &words = Words<Choice>::all;
    const auto *found = std::find(std::begin(words), std::end(words), text);
    if (found == std::end(words))
      throw nb::value_error((std::string(key) + ": no such choice: " + text).c_str());
    to = static_cast<T>(found - words);
  }

  // raises KeyError with a key that was not read
  void finish() const {
    if (read_ != nb::len(from_)) throw nb::key_error("a key is no field of the struct");
  }

 private:
  template <typename T>
  static void fill(const nb::object &from, const char *key, T &to) {
    if constexpr (std::is_array_v<T>) {
      const auto values = nb::cast<nb::list>(from);
      if (nb::len(values) != std::extent_v<T>) throw nb::value_error(key);
      for (size_t i = 0; i < std::extent_v<T>; ++i) fill(nb::object(values[i]), key, to[i]);
    } else {
      to = nb::cast<T>(from);
    }
  }

  const nb::dict &from_;
  size_t read_ = 0;
};

void fill_profile(nb::handle from, rp_profile &to, std::vector<Values> &keep) {
  if (from.is_none()) return;
  const auto values = nb::cast<nb::dict>(from);
  const auto take = [&](const char *key) {
    keep.push_back(nb::cast<Values>(nb::object(values[key])));
    return keep.back().data();
  };
  to.arc_length = take("arc_length");
  to.count = static_cast<int32_t>(keep.back().shape(0));
  to.y = take("y");
  to.z = take("z");
  to.dy = take("dy");
  to.dz = take("dz");
  for (size_t i = keep.size() - 5; i < keep.size(); ++i) {
    if (keep[i].shape(0) != static_cast<size_t>(to.count)) throw nb::value_error("profile");
  }
}

// [left, right]
void fill_profiles(Reader &reader, const char *key, rp_profile (&to)[2],
                   std::vector<Values> &keep) {
  if (!reader.has(key)) return;
  const auto sides = nb::cast<nb::list>(reader.at(key));
  for (size_t side = 0; side < 2; ++side) fill_profile(nb::object(sides[side]), to[side], keep);
}

// of each side a list of profiles and of their positions
void fill_sections(Reader &reader, const char *key, const char *place, Sections (&to)[2],
                   std::vector<Values> &keep) {
  if (!reader.has(key) || !reader.has(place)) return;
  const auto sides = nb::cast<nb::list>(reader.at(key));
  const auto places = nb::cast<nb::list>(reader.at(place));
  for (size_t side = 0; side < 2; ++side) {
    const auto profiles = nb::cast<nb::list>(nb::object(sides[side]));
    const auto positions = nb::cast<nb::list>(nb::object(places[side]));
    if (nb::len(profiles) != nb::len(positions)) throw nb::value_error(place);
    for (size_t k = 0; k < nb::len(profiles); ++k) {
      to[side].profiles.emplace_back();
      fill_profile(nb::object(profiles[k]), to[side].profiles.back(), keep);
      to[side].places.push_back(nb::cast<double>(positions[k]));
    }
  }
}

// of each side 1 or 0 for each section
void fill_kinks(Reader &reader, const char *key, Sections (&to)[2]) {
  if (!reader.has(key)) return;
  const auto sides = nb::cast<nb::list>(reader.at(key));
  for (size_t side = 0; side < 2; ++side) {
    for (const nb::handle kink : nb::cast<nb::list>(nb::object(sides[side])))
      to[side].kinks.push_back(nb::cast<int32_t>(kink));
    if (to[side].kinks.size() != to[side].profiles.size()) throw nb::value_error(key);
  }
}

void connect_sections(Config &to) {
  rp_config &c = to.values;
  for (size_t side = 0; side < 2; ++side) {
    const Sections &rail = to.rail_sections[side], &wheel = to.wheel_sections[side];
    c.rail_sections[side] = rail.profiles.data();
    c.section_position[side] = rail.places.data();
    c.section_count[side] = static_cast<int32_t>(rail.profiles.size());
    c.section_kink[side] = rail.kinks.empty() ? nullptr : rail.kinks.data();
    c.wheel_section_kink[side] = wheel.kinks.empty() ? nullptr : wheel.kinks.data();
    c.wheel_sections[side] = wheel.profiles.data();
    c.wheel_section_angle[side] = wheel.places.data();
    c.wheel_section_count[side] = static_cast<int32_t>(wheel.profiles.size());
  }
}

// [left, right], None where there is none
void fill_values(Reader &reader, const char *key, const double *(&to)[2], int32_t (&count)[2],
                 std::vector<Values> &keep) {
  if (!reader.has(key)) return;
  const auto sides = nb::cast<nb::list>(reader.at(key));
  for (size_t side = 0; side < 2; ++side) {
    const nb::object values(sides[side]);
    if (values.is_none()) continue;
    keep.push_back(nb::cast<Values>(values));
    to[side] = keep.back().data();
    count[side] = static_cast<int32_t>(keep.back().shape(0));
  }
}

void fill_gap(Reader &reader, Config &to) {
  if (!reader.has("undeformed_distance")) return;
  to.gap = nb::cast<Grid>(reader.at("undeformed_distance"));
  to.values.undeformed_distance = to.gap.data();
  to.values.distance_shape[0] = static_cast<int32_t>(to.gap.shape(1));
  to.values.distance_shape[1] = static_cast<int32_t>(to.gap.shape(0));
}

// after the gap: [4 or 1][rows][elements of a row and one]
void fill_own_influence(Reader &reader, Config &to) {
  if (!reader.has("influence_coefficients")) return;
  const Cube own = nb::cast<Cube>(reader.at("influence_coefficients"));
  const auto *shape = to.values.distance_shape;
  if (own.shape(0) < 1 || own.shape(1) != static_cast<size_t>(shape[1]) ||
      own.shape(2) != static_cast<size_t>(shape[0]) + 1)
    throw nb::value_error("influence_coefficients");
  to.own_influence = own;
  to.values.influence_coefficients = own.data();
}

// --- to Python ---------------------------------------------------------------------------------

template <typename T, size_t N>
nb::list list_of(const T (&values)[N]) {
  nb::list list;
  for (const T value : values) list.append(value);
  return list;
}

template <typename T>
nb::list numbers_of(const T &field) {
  if constexpr (std::is_array_v<T>) {
    return list_of(field);
  } else {
    nb::list list;
    if constexpr (std::is_enum_v<T>)
      list.append(static_cast<int>(field));
    else
      list.append(field);
    return list;
  }
}

// None where all is well
template <typename Result>
nb::object reason_of(const Result &from) {
  return reason_text(from.reason, from.reason_value);
}

template <typename T>
nb::object value_of(const T &field) {
  if constexpr (std::is_array_v<T>) {
    return list_of(field);
  } else if constexpr (std::is_same_v<T, rp_status>) {
    return nb::cast(rp_status_text(field));
  } else if constexpr (std::is_same_v<T, rp_reason>) {
    return nb::none();  // with its value: reason_of
  } else if constexpr (std::is_same_v<T, uint32_t>) {
    return warnings_of(field);
  } else {
    return nb::cast(field);
  }
}

#define RAILPATCH_SKIP(type, field, count)
#define RAILPATCH_VALUE(type, field, ...) to[#field] = value_of(from.field);

nb::dict patch_dict(const rp_patch_result &from) {
  nb::dict to;
  RP_PATCH_RESULT_FIELDS(RAILPATCH_VALUE, RAILPATCH_SKIP)
  nb::dict errors;
  errors["creep_force"] = from.error_estimate[0];
  errors["spin_moment"] = from.error_estimate[1];
  errors["max_pressure"] = from.error_estimate[2];
  to["error_estimate"] = errors;
  to["reason"] = reason_of(from);
  return to;
}

nb::dict side_dict(const rp_side_result &from) {
  nb::dict to;
  RP_SIDE_RESULT_FIELDS(RAILPATCH_VALUE, RAILPATCH_SKIP)
  nb::list patches, alternatives;
  for (int i = 0; i < from.patch_count; ++i) patches.append(patch_dict(from.patch[i]));
  for (int i = 0; i < from.alternative_count; ++i)
    alternatives.append(patch_dict(from.patch[from.patch_count + i]));
  to["patches"] = patches;
  to["alternatives"] = alternatives;
  to["reason"] = reason_of(from);
  return to;
}

// as the field is: estimates are no dictionary here
#define RAILPATCH_FIND(type, field, ...) \
  if (wanted == #field) return found_of(from, from.field);

template <typename Result, typename T>
nb::object found_of(const Result &from, const T &field) {
  if constexpr (std::is_same_v<T, rp_reason>) {
    return reason_of(from);
  } else {
    return value_of(field);
  }
}

}  // namespace

nb::object quantity_of(const rp_result &from, const char *name) {
  const std::string_view wanted(name);
  RP_RESULT_FIELDS(RAILPATCH_FIND, RAILPATCH_SKIP)
  throw nb::key_error(name);
}

nb::object quantity_of(const rp_side_result &from, const char *name) {
  const std::string_view wanted(name);
  RP_SIDE_RESULT_FIELDS(RAILPATCH_FIND, RAILPATCH_SKIP)
  throw nb::key_error(name);
}

nb::object quantity_of(const rp_patch_result &from, const char *name) {
  const std::string_view wanted(name);
  RP_PATCH_RESULT_FIELDS(RAILPATCH_FIND, RAILPATCH_SKIP)
  throw nb::key_error(name);
}

#define RAILPATCH_READ(type, field, count, role, ...) reader.read<Role::role>(#field, c.field);

void fill_config(const nb::dict &from, Config &to) {
  rp_config &c = to.values;
  rp_default_config(&c);
  Reader reader(from);
  RP_CONFIG_FIELDS(RAILPATCH_READ, RAILPATCH_SKIP)
  fill_gap(reader, to);
  fill_own_influence(reader, to);
  if (reader.has("creep_table")) {
    to.table = nb::cast<Bytes>(reader.at("creep_table"));
    c.creep_table = to.table.data();
    c.creep_table_size = to.table.size();
  }
  fill_values(reader, "runout", c.runout, c.runout_count, to.profiles);
  fill_values(reader, "rail_height", c.rail_height, c.rail_height_count, to.profiles);
  fill_profiles(reader, "wheel", c.wheel, to.profiles);
  fill_profiles(reader, "rail", c.rail, to.profiles);
  fill_sections(reader, "rail_sections", "section_position", to.rail_sections, to.profiles);
  fill_sections(reader, "wheel_sections", "wheel_section_angle", to.wheel_sections, to.profiles);
  fill_kinks(reader, "section_kink", to.rail_sections);
  fill_kinks(reader, "wheel_section_kink", to.wheel_sections);
  connect_sections(to);
  reader.finish();
}

void fill_input(const nb::dict &from, rp_input &c) {
  Reader reader(from);
  RP_INPUT_FIELDS(RAILPATCH_READ, RAILPATCH_SKIP)
  reader.has("slip_field");  // of who keeps it: SlipField
  reader.finish();
}

void SlipField::fill(const nb::dict &from, rp_input &to) {
  if (!from.contains("slip_field")) return;
  decltype(values_) values;
  if (!nb::try_cast(nb::object(from["slip_field"]), values)) throw nb::value_error("slip_field");
  const auto ny = static_cast<size_t>(shape_[1]), nx = static_cast<size_t>(shape_[0]);
  if (values.shape(0) != 2 || values.shape(1) != ny || values.shape(2) != nx) {
    rp_message message = {};
    std::snprintf(
        message.text, sizeof message.text,
        "motion.slip_field: value is of another shape, allowed twice %d rows of %d numbers",
        shape_[1], shape_[0]);
    check(RP_ERROR_VALUE, &message);
  }
  values_ = values;
  to.slip_field = values_.data();
}

nb::dict config_dict(const rp_config &config) {
  nb::dict to;
#define RAILPATCH_PUT(type, field, ...) to[#field] = numbers_of(config.field);
  RP_CONFIG_FIELDS(RAILPATCH_PUT, RAILPATCH_SKIP)
  return to;
}

nb::dict jacobian_dict(const rp_jacobian &found) {
  nb::dict to;
  const char *const names[] = {"left", "right"};
  for (int side = 0; side < 2; ++side) {
    nb::list numbers;
    for (const auto &row : found.side[side])
      for (double v : row) numbers.append(v);
    to[names[side]] = numbers;
  }
  nb::list z;
  for (double v : found.z) z.append(v);
  to["z"] = z;
  to["z_force"] = found.z_force;
  to["kind"] = Words<rp_derivative_kind>::all[found.kind];
  to["status"] = rp_status_text(found.status);
  return to;
}

nb::dict result_dict(const rp_result &from) {
  nb::dict to;
  RP_RESULT_FIELDS(RAILPATCH_VALUE, RAILPATCH_SKIP)
  to["left"] = side_dict(from.side[RP_LEFT]);
  to["right"] = side_dict(from.side[RP_RIGHT]);
  to["reason"] = reason_of(from);
  return to;
}

nb::object reason_text(rp_reason reason, double value) {
  if (reason == RP_REASON_NONE) return nb::none();
  std::string text = rp_reason_text(reason);
  if (!std::isnan(value)) {
    char number[32];
    std::snprintf(number, sizeof number, " (%.4g)", value);
    text += number;
  }
  return nb::cast(text);
}

nb::list warnings_of(uint32_t bits) {
  nb::list texts;
#define RAILPATCH_WARNING(name, value, text) \
  if (bits & (uint32_t{1} << (value))) texts.append(text);
  RP_WARNINGS(RAILPATCH_WARNING)
  return texts;
}

nb::list stage_list(const rp_stage_info *info, const double *seconds) {
  nb::list stages;
  for (int i = 0; i < RP_STAGE_COUNT; ++i) {
    nb::dict stage;
    stage["name"] = info[i].name;
    stage["present"] = info[i].present != 0;
    stage["reason"] = info[i].reason;
    stage["bytes"] = info[i].bytes;
    stage["seconds"] = seconds[i];
    stages.append(stage);
  }
  return stages;
}

rp_field field_of(const char *name) {
  const auto &words = Words<rp_field>::all;
  const auto *found = std::find(std::begin(words), std::end(words), std::string_view(name));
  if (found == std::end(words)) throw nb::key_error(name);
  return static_cast<rp_field>(found - words);
}

}  // namespace railpatch::python
