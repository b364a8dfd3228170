// Variables by value reference: type, range and the field of rp_input or Outputs behind each. The
// table itself is generated from variables.toml.
#pragma once

#include <cstddef>
#include <cstdint>

#include "outputs.hpp"

namespace railpatch::fmu {

enum class Type : uint8_t { real, integer };
enum class Role : uint8_t { input, output, parameter };

inline constexpr size_t no_field = SIZE_MAX;

// value references of the parameters, which are no fields
inline constexpr uint32_t direction = 27, friction_coefficient = 31, substeps = 32,
                          wheelset_mass = 33, wheelset_inertia = 34, wheel_profile = 39,
                          rail_profile = 40;
// and of an output that is none
inline constexpr uint32_t largest_step = 59;

struct Variable {
  uint32_t reference;
  Type type;
  Role role;
  size_t field;  // offset in rp_input or Outputs
  size_t plus;   // of a second field that is added
  double low, high;
};

// Means over a step, and how far from their references are those of what they are the means of.
inline constexpr uint32_t mean_apart = 18;
inline bool is_mean(const Variable &variable) {
  const uint32_t within = variable.reference % 1000;
  return variable.role == Role::output && within >= 61 && within <= 66;
}

// Of fixed parameters.
inline bool is_profile(const Variable &variable) {
  return variable.reference == wheel_profile || variable.reference == rail_profile;
}

// Of outputs of patches: the status.
inline bool is_status(const Variable &variable) { return variable.reference % 100 == 1; }

// Of an output of a patch that is not there.
inline double rest_of(const Outputs &outputs, const Variable &variable) {
  return variable.reference % 100 == 18 ? outputs.rest_temperature : 0;
}

// null: there is no such variable in any scene
const Variable *find_variable(uint32_t reference);

// 0 where the core has none (NaN).
double output_of(const Outputs &outputs, const Variable &variable);
void put_input(rp_input &input, const Variable &variable, double value);

}  // namespace railpatch::fmu
