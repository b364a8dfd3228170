// The scene that an FMU was made from: resources/scene.txt, resolved to plain numbers. Text that
// the locale does not touch, one item a line, written by railpatch/fmu/scene.py:
//
//   railpatch-fmu-scene 1
//   guid {...}
//   set FIELD VALUE...                          a field of rp_config
//   profile wheel|rail SIDE ARRAY COUNT VALUE...
//   distance COUNT VALUE...                     the undeformed distance
//   variable REFERENCE NAME START               in the order of modelDescription.xml
//   end CRC                                     CRC-32 of all bytes before this line, hexadecimal
#pragma once

#include <string>
#include <vector>

#include "railpatch.h"
#include "variables.hpp"

namespace railpatch::fmu {

struct SceneVariable {
  const Variable *variable;
  std::string name;
  double start;
};

struct Scene {
  std::string guid;
  rp_config config;
  std::vector<SceneVariable> variables;
  std::vector<double> arrays[2][2][5];  // wheel or rail, side, arc_length y z dy dz
  std::vector<double> distance;
};

// False: problem says which line is wrong and why. The config then points into the scene's arrays,
// which must not move. Throws std::bad_alloc.
bool parse_scene(const std::string &text, Scene &scene, std::string &problem);

}  // namespace railpatch::fmu
