// From a configuration to the scene: everything that a handle is made of, resolved once. Beside the
// checks nothing else of the core reads a configuration.
#pragma once

#include <optional>
#include <vector>

#include "patch/single_patch.hpp"
#include "patch/stage_marks.hpp"
#include "railpatch.h"
#include "wheel/wheels.hpp"

namespace railpatch {

struct scene {
  patch_scene patch;
  std::vector<int> transforms[2];  // sizes along rolling and lateral, ascending
  grid_size largest;               // of a patch
  stage_marks marks;
  double tolerance = 0;                 // as asked for
  double bulk_temperature[2] = {0, 0};  // degrees C, where a step says nothing else
  // one of both
  std::optional<single_patch_setup> single;
  std::optional<wheels_setup> wheels;
};

// The config has been checked, and its arrays stay while the scene is used to make a handle. Throws
// profile_error or std::bad_alloc.
scene scene_of(const rp_config &config);

// Of a checked config, or one that is being checked.
viscous_bodies viscous_bodies_of(const rp_config &config);

struct profile_error {
  const char *field;  // "wheel_left", ...
  const char *reason;
};

// The parts of a scene that are files of their own: wheels, but for the greatest grid.
wheels_setup wheels_of(const rp_config &config, const patch_scene &scene);
bool has_support(const rp_config &config);
// Whether a wheelset's roll angle or pitch rate is found.
bool is_balanced(const rp_config &config);
bool finds_pitch_rate(const rp_config &config);

}  // namespace railpatch
