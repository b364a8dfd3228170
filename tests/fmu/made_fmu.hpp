// FMUs without an archive around them: scenes of the C++ tests written as resources, and slaves of
// them called as an importer does.
#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include "../cpp/scenes.hpp"
#include "checksum.hpp"
#include "fmi2Functions.h"
#include "railpatch_fields.h"

namespace made {

inline constexpr const char *guid = "{00000000-0000-4000-8000-000000000001}";

struct variable {
  fmi2ValueReference reference;
  std::string name;
  double start = 0;
};

struct scene {
  std::string name;
  rp_config config;
  std::vector<variable> variables;  // inputs and parameters first
  // of a scene with a history: of the solve at the start
  bool history = false;
  double time_step = 0, distance = 0;
};

inline std::string spelled(double value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

template <class T>
void spell(const T &field, std::string &text) {
  if constexpr (std::is_array_v<T>)
    for (const auto &item : field) spell(item, text);
  else if constexpr (std::is_same_v<T, double>)
    text.append(" ").append(spelled(field));
  else
    text.append(" ").append(std::to_string(static_cast<int>(field)));
}

inline void spell_profile(const char *body, int side, const rp_profile &p, std::string &text) {
  const double *const arrays[] = {p.arc_length, p.y, p.z, p.dy, p.dz};
  const char *const names[] = {"arc_length", "y", "z", "dy", "dz"};
  for (int k = 0; k < 5 && p.count > 0; ++k) {
    text.append("profile ").append(body).append(" ").append(std::to_string(side));
    text.append(" ").append(names[k]).append(" ").append(std::to_string(p.count));
    for (int i = 0; i < p.count; ++i) text.append(" ").append(spelled(arrays[k][i]));
    text += "\n";
  }
}

// Writes resources/scene.txt (plugins/fmu/src/scene.hpp); gives the folder.
// This program's own folder of temporary files: others that run beside it write scenes of the same
// names.
inline const std::filesystem::path &own_folder() {
  struct folder {
    std::filesystem::path path;
    folder() {
      std::string name = testing::TempDir() + "railpatch_XXXXXX";
      EXPECT_NE(mkdtemp(name.data()), nullptr);
      path = name;
    }
    ~folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const folder made;
  return made.path;
}

inline std::filesystem::path write(const scene &s) {
  std::string text = std::string("railpatch-fmu-scene 1\nguid ") + guid + "\n";
  const rp_config &c = s.config;
  // what is not given keeps its default
  const auto set = [&](const char *name, const auto &field) {
    std::string values;
    spell(field, values);
    if (values.find("nan") == std::string::npos) text.append("set ").append(name) += values + "\n";
  };
#define RAILPATCH_WRITE(type, field, ...) set(#field, c.field);
#define RAILPATCH_SKIP(type, field, count)
  RP_CONFIG_FIELDS(RAILPATCH_WRITE, RAILPATCH_SKIP)
#undef RAILPATCH_WRITE
#undef RAILPATCH_SKIP
  for (int side = 0; side < 2 && c.kind != RP_PATCH; ++side) {
    spell_profile("wheel", side, c.wheel[side], text);
    spell_profile("rail", side, c.rail[side], text);
  }
  if (s.history) text += "option history 1\n";
  if (s.time_step > 0) text.append("option time_step ").append(spelled(s.time_step)).append("\n");
  if (s.distance > 0) text.append("option distance ").append(spelled(s.distance)).append("\n");
  for (const variable &v : s.variables) {
    text.append("variable ").append(std::to_string(v.reference)).append(" ").append(v.name);
    text.append(" ").append(spelled(v.start)).append("\n");
  }
  char end[32];
  std::snprintf(end, sizeof end, "end %08x\n", railpatch::fmu::crc32(text.data(), text.size()));
  const auto folder = own_folder() / ("railpatch %41 # " + s.name);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "scene.txt", std::ios::binary) << text << end;
  return folder;
}

// One slave in co-simulation. Statuses are those of FMI; the last message is kept.
class slave {
 public:
  explicit slave(const std::filesystem::path &resources)
      : functions_{hear, nullptr, nullptr, nullptr, this} {
    component_ = fmi2Instantiate("slave", fmi2CoSimulation, guid, resources.string().c_str(),
                                 &functions_, fmi2False, fmi2True);
    EXPECT_NE(component_, nullptr) << message;
  }
  ~slave() { fmi2FreeInstance(component_); }
  slave(const slave &) = delete;
  slave &operator=(const slave &) = delete;

  void initialize() {
    EXPECT_EQ(fmi2SetupExperiment(component_, fmi2False, 0, 0, fmi2False, 0), fmi2OK);
    EXPECT_EQ(fmi2EnterInitializationMode(component_), fmi2OK);
    EXPECT_EQ(fmi2ExitInitializationMode(component_), fmi2OK) << message;
  }
  fmi2Status set(fmi2ValueReference reference, double value) {
    return fmi2SetReal(component_, &reference, 1, &value);
  }
  fmi2Status set_integer(fmi2ValueReference reference, int value) {
    return fmi2SetInteger(component_, &reference, 1, &value);
  }
  fmi2Status set_rate(fmi2ValueReference reference, double rate) {
    const fmi2Integer order = 1;
    return fmi2SetRealInputDerivatives(component_, &reference, 1, &order, &rate);
  }
  double get(fmi2ValueReference reference) {
    double value = NAN;
    EXPECT_EQ(fmi2GetReal(component_, &reference, 1, &value), fmi2OK) << reference << message;
    return value;
  }
  double derivative(fmi2ValueReference of, fmi2ValueReference by, double seed) {
    double value = NAN;
    EXPECT_EQ(fmi2GetDirectionalDerivative(component_, &of, 1, &by, 1, &seed, &value), fmi2OK)
        << message;
    return value;
  }
  // from where it is
  fmi2Status step(double length) {
    const fmi2Status status = fmi2DoStep(component_, time, length, fmi2True);
    if (status == fmi2OK) time += length;
    return status;
  }
  fmi2Component get() const { return component_; }

  double time = 0;
  std::string message;

 private:
  static void hear(fmi2ComponentEnvironment environment, fmi2String, fmi2Status, fmi2String,
                   fmi2String text, ...) {
    static_cast<slave *>(environment)->message = text;
  }
  fmi2CallbackFunctions functions_;
  fmi2Component component_ = nullptr;
};

// --- scenes ------------------------------------------------------------------------------------

// value references, variables.toml
inline constexpr fmi2ValueReference normal_force = 21, creepage = 23, spin = 25, speed = 26,
                                    direction = 27, friction = 31, substeps = 32, wheel_bulk = 37,
                                    rail_bulk = 38, lateral = 1, height = 2, yaw = 5;

inline std::string named(const char *what, fmi2ValueReference number) {
  return std::string(what).append(std::to_string(number));
}

inline std::vector<variable> patch_variables(bool history, bool heated) {
  std::vector<variable> all = {{normal_force, "normal_force", 1e5}, {creepage, "creepage[1]", 1e-3},
                               {creepage + 1, "creepage[2]", 0},    {spin, "spin_creepage", 0.1},
                               {speed, "rolling_speed", 20},        {direction, "direction", 1}};
  if (heated) {
    all.push_back({wheel_bulk, "temperature.wheel", 80});
    all.push_back({rail_bulk, "temperature.rail", 20});
  } else {
    all.push_back({friction, "friction.coefficient", 0.3});
  }
  if (history) all.push_back({substeps, "substeps", 1});
  for (const fmi2ValueReference k : {3, 4, 5, 6, 7, 8, 9, 10, 11})
    all.push_back({2100 + k, named("output", k)});
  if (heated) all.push_back({2118, "max_temperature"});
  return all;
}

inline std::vector<variable> wheelset_variables(bool history, rp_track track) {
  const double forward = track == RP_RAIL ? 20.0 : 0.0;
  std::vector<variable> all = {{lateral, "wheelset.y", 0},
                               {height, "wheelset.z", 2e-4},
                               {yaw, "wheelset.yaw", 0},
                               {6, "wheelset.speed", forward},
                               {7, "wheelset.vy", 0},
                               {11, "wheelset.pitch_rate", -20.0 / 0.46},
                               {friction, "friction.coefficient", 0.3}};
  if (track == RP_ROLLER) all.insert(all.end() - 1, {12, "track.roller_pitch_rate", 20.0});
  if (history) all.push_back({substeps, "substeps", 1});
  for (const fmi2ValueReference k : {42, 43, 44, 45, 46, 47, 48, 55, 56, 57})
    all.push_back({k, named("output", k)});
  for (const fmi2ValueReference side : {1000, 2000}) {
    for (const fmi2ValueReference k : {43, 44, 45, 46, 47, 48, 49})
      all.push_back({side + k, named("side", side + k)});
    for (const fmi2ValueReference k : {2, 4, 5, 6, 7, 8, 9, 10, 19})
      for (const fmi2ValueReference patch : {100, 200})
        all.push_back({side + patch + k, named("patch", side + patch + k)});
  }
  return all;
}

// Of each kind one, small; the pair must stay alive while they are written.
inline std::vector<scene> scenes_of(const ::scenes::profile_pair &pair) {
  std::vector<scene> all;
  rp_config c = ::scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 10);
  c.derivatives = 1;
  all.push_back({"patch", c, patch_variables(false, false)});
  c = ::scenes::patch(RP_NORMAL_HERTZ, RP_TANGENTIAL_FASTSIM, 8);
  all.push_back({"fast", c, patch_variables(false, false)});
  c = ::scenes::heated_patch(RP_STEADY_ROLLING, 10);
  all.push_back({"heated", c, patch_variables(true, true), true});
  c = ::scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_FULL, 10);
  c.regime = RP_TRANSIENT_ROLLING;
  all.push_back({"transient", c, patch_variables(true, false), true, 0, 1e-3});
  c.regime = RP_STEADY_ROLLING;
  c.layer_shear_modulus = 8.2e9;
  c.layer_thickness = 2e-5;
  c.layer_yield_stress = 1.5e8;
  all.push_back({"plastic", c, patch_variables(true, false), true});
  c = ::scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  c.element_size[0] = c.element_size[1] = 2e-3;
  c.load = RP_POSITION;
  c.derivatives = 1;
  all.push_back({"rail", c, wheelset_variables(false, RP_RAIL)});
  c.derivatives = 0;
  c.regime = RP_TRANSIENT_ROLLING;
  all.push_back({"rolling_on", c, wheelset_variables(true, RP_RAIL), true, 1e-4});
  c = ::scenes::wheels(RP_WHEELSET, RP_ROLLER, pair);
  c.element_size[0] = c.element_size[1] = 2e-3;
  c.load = RP_POSITION;
  all.push_back({"roller", c, wheelset_variables(false, RP_ROLLER)});
  return all;
}

}  // namespace made
