// The scene that an FMU was made from: resources/scene.txt, resolved to plain numbers. Text that
// the locale does not touch, one item a line, written by railpatch/fmu/scene.py:
//
//   railpatch-fmu-scene 1
//   guid {...}
//   set FIELD VALUE...                          a field of rp_config; "-" of one side: left out
//   profile wheel|rail SIDE ARRAY COUNT VALUE...
//   section SIDE INDEX ARRAY COUNT VALUE...     a rail's profile along the track, indices from 0;
//                                               ARRAY may be position or kink: one value
//   wheel_section SIDE INDEX ARRAY ...          the same of a wheel round it
//   choice wheel|rail NUMBER ARRAY COUNT VALUE...
//                                               a further profile for both sides, which a parameter
//                                               chooses; numbers from 2, 1 is that of profile
//   runout|rail_height SIDE COUNT VALUE...      shapes along rolling
//   distance COUNT VALUE...                     the undeformed distance
//   option NAME VALUE                           one of Options
//   variable REFERENCE NAME START               in the order of modelDescription.xml: what is not
//                                               an output first
//   constant REFERENCE real|integer|boolean|text NAME VALUE
//                                               a key of the scene that is fixed; of a text with
//                                               %xx in place of what is no letter or number
//   held REFERENCE                              an input before that is always 0: a component of a
//                                               vector that is without effect
//   array REFERENCE SIZE                        FMI 3.0: this variable and those that follow it in
//                                               number are one array
//   end CRC                                     CRC-32 of all bytes before this line, hexadecimal
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "railpatch.h"
#include "variables.hpp"

namespace railpatch::fmu {

struct SceneVariable {
  const Variable *variable;
  std::string name;
  double start;
  bool held = false;
  std::string text = {};  // of a constant that is one
};

struct SceneArray {
  uint32_t reference, size;
};

struct Options {
  int32_t history =
      0;  // 1: later steps depend on earlier ones, not only through the solver's start
  int32_t averaged = 0;               // 1: means over a step are asked for
  int32_t friction_input = 0;         // 1: the coefficient of friction is an input
  int32_t friction_sides = 0;         // 1: that of each wheel is one, by rp_input.friction_scale
  double friction_scale[2] = {1, 1};  // of the law on each wheel, where it is no input
  int32_t profile_files = 0;          // 1: profiles may be read at run time
  double time_step = 0;               // s, of the solve at the start, where there is no step yet
  double distance = 0;  // m, of that solve: distance rolled of a patch in transient rolling
};

struct ProfileArrays {
  std::vector<double> arrays[5];  // arc_length y z dy dz
};

struct Section {
  std::vector<double> arrays[5], position, kink;
};

struct SectionLists {
  std::vector<Section> sections[2];
  // what the config points to
  std::vector<rp_profile> profiles[2];
  std::vector<double> positions[2];
  std::vector<int32_t> kinks[2];
};

struct Scene {
  std::string guid;
  rp_config config;
  Options options;
  std::vector<SceneVariable> variables;
  std::vector<SceneArray> variable_arrays;
  std::vector<std::unique_ptr<Variable>> constants;  // which no table knows
  std::vector<double> arrays[2][2][5];               // wheel or rail, side, arc_length y z dy dz
  std::vector<double> distance;
  SectionLists along, around;  // rails, wheels
  std::vector<double> runout[2], rail_height[2];
  std::vector<ProfileArrays> choices[2];  // wheel or rail: from number 2 on
};

// False: problem says which line is wrong and why. The config then points into the scene's arrays,
// which must not move. Throws std::bad_alloc.
bool parse_scene(const std::string &text, Scene &scene, std::string &problem);

// False where the arrays differ in length. The profile points into them.
bool make_profile(const std::vector<double> (&arrays)[5], rp_profile &profile);

}  // namespace railpatch::fmu
