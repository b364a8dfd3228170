#include "convert.hpp"

#include <nanobind/stl/string.h>

#include <cstring>
#include <string>
#include <type_traits>

#include "railpatch_fields.h"

namespace railpatch::python {

namespace {

// --- enumerations ------------------------------------------------------------------------------

struct Name {
  const char *field;
  const char *text;
  int value;
};

// field of rp_config, text of the case file, value
constexpr Name kNames[] = {
    {"kind", "patch", RP_PATCH},
    {"kind", "wheel_rail", RP_WHEEL_RAIL},
    {"kind", "wheelset", RP_WHEELSET},
    {"geometry", "semi_axes", RP_SEMI_AXES},
    {"geometry", "curvatures", RP_CURVATURES},
    {"geometry", "line_contact_radius", RP_LINE_CONTACT},
    {"geometry", "undeformed_distance", RP_UNDEFORMED_DISTANCE},
    {"load", "force", RP_FORCE},
    {"load", "position", RP_POSITION},
    {"regime", "none", RP_REGIME_NONE},
    {"regime", "steady_rolling", RP_STEADY_ROLLING},
    {"regime", "shift", RP_SHIFT},
    {"regime", "transient_rolling", RP_TRANSIENT_ROLLING},
    {"friction_law", "coulomb", RP_COULOMB},
    {"friction_law", "slip_velocity", RP_SLIP_VELOCITY},
    {"friction_law", "temperature", RP_TEMPERATURE},
    {"slip_law", "exponential", RP_SLIP_EXPONENTIAL},
    {"slip_law", "rational", RP_SLIP_RATIONAL},
    {"slip_law", "linear", RP_SLIP_LINEAR},
    {"plastic_rule", "path", RP_PLASTIC_PATH},
    {"plastic_rule", "magnitude", RP_PLASTIC_MAGNITUDE},
    {"normal", "hertz", RP_NORMAL_HERTZ},
    {"normal", "half_space", RP_NORMAL_HALF_SPACE},
    {"normal", "kik_piotrowski", RP_NORMAL_KIK_PIOTROWSKI},
    {"normal", "analyn", RP_NORMAL_ANALYN},
    {"tangential", "none", RP_TANGENTIAL_NONE},
    {"tangential", "fastsim", RP_TANGENTIAL_FASTSIM},
    {"tangential", "full", RP_TANGENTIAL_FULL},
    {"tangential", "linear", RP_TANGENTIAL_LINEAR},
    {"tangential", "polach", RP_TANGENTIAL_POLACH},
    {"tangential", "fastrip", RP_TANGENTIAL_FASTRIP},
    {"traction_bound", "parabolic", RP_BOUND_PARABOLIC},
    {"traction_bound", "elliptic", RP_BOUND_ELLIPTIC},
    {"flexibility_blending", "sliding", RP_BLENDING_SLIDING},
    {"flexibility_blending", "none", RP_BLENDING_NONE},
    {"flexibility_blending", "contact", RP_BLENDING_CONTACT},
    {"tangential", "table", RP_TANGENTIAL_TABLE},
    {"spin_offset", "none", RP_SPIN_OFFSET_NONE},
    {"spin_offset", "sixth", RP_SPIN_OFFSET_SIXTH},
    {"patch_rule", "blended", RP_PATCHES_BLENDED},
    {"patch_rule", "contact", RP_PATCHES_CONTACT},
    {"contact_frame", "track", RP_FRAME_TRACK},
    {"contact_frame", "inclined", RP_FRAME_INCLINED},
    {"reference_surface", "plane", RP_REFERENCE_PLANE},
    {"reference_surface", "curved", RP_REFERENCE_CURVED},
    {"track", "rail", RP_RAIL},
    {"track", "roller", RP_ROLLER},
    {"side", "left", RP_LEFT},
    {"side", "right", RP_RIGHT},
};

constexpr struct {
  const char *text;
  rp_field value;
} kFields[] = {
    {"x", RP_FIELD_X},
    {"y", RP_FIELD_Y},
    {"undeformed_distance", RP_FIELD_UNDEFORMED_DISTANCE},
    {"pressure", RP_FIELD_PRESSURE},
    {"traction", RP_FIELD_TRACTION},
    {"micro_slip", RP_FIELD_MICRO_SLIP},
    {"element_division", RP_FIELD_ELEMENT_DIVISION},
    {"temperature", RP_FIELD_TEMPERATURE},
    {"error_features", RP_FIELD_ERROR_FEATURES},
    {"friction", RP_FIELD_FRICTION},
    {"plastic_displacement", RP_FIELD_PLASTIC_DISPLACEMENT},
    {"plastic_path", RP_FIELD_PLASTIC_PATH},
    {"yield_stress", RP_FIELD_YIELD_STRESS},
    {"row_position", RP_FIELD_ROW_POSITION},
    {"row_angle", RP_FIELD_ROW_ANGLE},
};

// --- from Python -------------------------------------------------------------------------------

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

  // by role
  template <typename T>
  void choice(const char *key, T &to) {
    name(key, to);
  }
  template <typename T>
  void side(const char *key, T &to) {
    name(key, to);
  }
  template <typename T>
  void number(const char *key, T &to) {
    numbers(key, to);
  }
  template <typename T>
  void place(const char *key, T &to) {
    numbers(key, to);
  }
  template <typename T>
  void integer(const char *key, T &to) {
    numbers(key, to);
  }
  template <typename T>
  void points(const char *key, T &to) {
    numbers(key, to);
  }
  template <typename T>
  void unmarked(const char *key, T &to) {
    numbers(key, to);
  }

  template <typename T>
  void numbers(const char *key, T &to) {
    if (has(key)) fill(at(key), key, to);
  }

  template <typename T>
  void name(const char *key, T &to) {
    if (!has(key)) return;
    const auto text = nb::cast<std::string>(at(key));
    for (const Name &entry : kNames) {
      if (std::strcmp(entry.field, key) == 0 && text == entry.text) {
        to = static_cast<T>(entry.value);
        return;
      }
    }
    throw nb::value_error((std::string(key) + ": no such choice: " + text).c_str());
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
void fill_sections(Reader &reader, Config &to) {
  if (!reader.has("rail_sections") || !reader.has("section_position")) return;
  const auto sides = nb::cast<nb::list>(reader.at("rail_sections"));
  const auto places = nb::cast<nb::list>(reader.at("section_position"));
  for (size_t side = 0; side < 2; ++side) {
    const auto profiles = nb::cast<nb::list>(nb::object(sides[side]));
    const auto positions = nb::cast<nb::list>(nb::object(places[side]));
    if (nb::len(profiles) != nb::len(positions)) throw nb::value_error("section_position");
    for (size_t k = 0; k < nb::len(profiles); ++k) {
      to.sections[side].emplace_back();
      fill_profile(nb::object(profiles[k]), to.sections[side].back(), to.profiles);
      to.section_position[side].push_back(nb::cast<double>(positions[k]));
    }
    to.values.rail_sections[side] = to.sections[side].data();
    to.values.section_position[side] = to.section_position[side].data();
    to.values.section_count[side] = static_cast<int32_t>(to.sections[side].size());
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

nb::dict patch_dict(const rp_patch_result &patch) {
  nb::dict to;
  to["status"] = rp_status_text(patch.status);
  to["normal_force"] = patch.normal_force;
  to["approach"] = patch.approach;
  to["creep_force"] = list_of(patch.creep_force);
  to["spin_moment"] = patch.spin_moment;
  to["max_pressure"] = patch.max_pressure;
  to["contact_area"] = patch.contact_area;
  to["elements"] = list_of(patch.elements);
  to["max_temperature"] = patch.max_temperature;
  to["friction_power"] = patch.friction_power;
  to["plastic_power"] = patch.plastic_power;
  to["elastic_energy"] = patch.elastic_energy;
  to["normal_iterations"] = patch.normal_iterations;
  to["newton_iterations"] = patch.newton_iterations;
  to["inner_iterations"] = patch.inner_iterations;
  to["outer_iterations"] = patch.outer_iterations;
  to["ambiguous_elements"] = patch.ambiguous_elements;
  to["residual"] = patch.residual;
  nb::dict errors;
  errors["creep_force"] = patch.error_estimate[0];
  errors["spin_moment"] = patch.error_estimate[1];
  errors["max_pressure"] = patch.error_estimate[2];
  to["error_estimate"] = errors;
  to["share"] = patch.share;
  to["position"] = list_of(patch.position);
  to["contact_angle"] = patch.contact_angle;
  to["creepage"] = list_of(patch.creepage);
  to["spin_creepage"] = patch.spin_creepage;
  to["rolling_speed"] = patch.rolling_speed;
  to["direction"] = patch.direction;
  to["grid"] = list_of(patch.grid);
  to["grid_origin"] = list_of(patch.grid_origin);
  to["element_size"] = list_of(patch.element_size);
  return to;
}

nb::dict side_dict(const rp_side_result &side) {
  nb::list patches, alternatives;
  for (int i = 0; i < side.patch_count; ++i) patches.append(patch_dict(side.patch[i]));
  for (int i = 0; i < side.alternative_count; ++i)
    alternatives.append(patch_dict(side.patch[side.patch_count + i]));
  nb::dict to;
  to["status"] = rp_status_text(side.status);
  to["force"] = list_of(side.force);
  to["moment"] = list_of(side.moment);
  to["rolling_radius"] = side.rolling_radius;
  to["rail_deflection"] = list_of(side.rail_deflection);
  to["rail_deflection_rate"] = list_of(side.rail_deflection_rate);
  to["patches"] = patches;
  to["alternatives"] = alternatives;
  return to;
}

}  // namespace

#define RAILPATCH_READ(type, field, count, role, ...) reader.role(#field, c.field);
#define RAILPATCH_SKIP(type, field, count)

void fill_config(const nb::dict &from, Config &to) {
  rp_config &c = to.values;
  rp_default_config(&c);
  Reader reader(from);
  RP_CONFIG_FIELDS(RAILPATCH_READ, RAILPATCH_SKIP)
  fill_gap(reader, to);
  if (reader.has("creep_table")) {
    to.table = nb::cast<Bytes>(reader.at("creep_table"));
    c.creep_table = to.table.data();
    c.creep_table_size = to.table.size();
  }
  fill_values(reader, "runout", c.runout, c.runout_count, to.profiles);
  fill_values(reader, "rail_height", c.rail_height, c.rail_height_count, to.profiles);
  fill_profiles(reader, "wheel", c.wheel, to.profiles);
  fill_profiles(reader, "rail", c.rail, to.profiles);
  fill_sections(reader, to);
  reader.finish();
}

void fill_input(const nb::dict &from, rp_input &c) {
  Reader reader(from);
  RP_INPUT_FIELDS(RAILPATCH_READ, RAILPATCH_SKIP)
  reader.finish();
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
  to["kind"] = found.kind == RP_DERIVATIVE_EXACT ? "exact" : "differences";
  to["status"] = rp_status_text(found.status);
  return to;
}

nb::dict result_dict(const rp_result &result) {
  nb::dict to;
  to["status"] = rp_status_text(result.status);
  to["z"] = result.z;
  to["force"] = list_of(result.force);
  to["moment"] = list_of(result.moment);
  to["evaluations"] = result.evaluations;
  to["left"] = side_dict(result.side[RP_LEFT]);
  to["right"] = side_dict(result.side[RP_RIGHT]);
  return to;
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
  for (const auto &entry : kFields) {
    if (std::strcmp(entry.text, name) == 0) return entry.value;
  }
  throw nb::key_error(name);
}

}  // namespace railpatch::python
