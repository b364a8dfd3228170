// Variables by value reference: type, range and the field of rp_input or Outputs behind each. The
// table itself and the references by name are generated from variables.toml.
#pragma once

#include <cstddef>
#include <cstdint>

#include "outputs.hpp"

namespace railpatch::fmu {

// bits, so that several may be asked for: FMI 2.0 reads enumerations as integers
enum class Type : uint8_t {
  real = 1,
  integer = 2,
  enumeration = 4,
  text = 8,
  boolean = 16,
  whole = 2 | 4,
  number = 1 | 2 | 4
};

constexpr bool among(Type type, Type asked) {
  return (static_cast<unsigned>(type) & static_cast<unsigned>(asked)) != 0;
}

enum class Role : uint8_t { input, output, parameter, independent, constant };

inline constexpr size_t no_field = SIZE_MAX;

// Value references of variables that belong to no side, of a vector that of its first component.
namespace reference {
enum : uint32_t {
#include "references.inc"
};
}  // namespace reference

// What an output of a patch is where the patch is not.
enum class Absent : uint8_t { zero, no_contact, warmer_bulk };

struct Variable {
  uint32_t reference;
  Type type;
  Role role;
  size_t field;  // offset in rp_input or Outputs
  size_t plus;   // of a second field that is added
  double low, high;
  uint8_t side, patch;  // their numbers from 1; 0: of none
  uint32_t mean_of;     // of a mean over a step: reference of what it is the mean of; 0: no mean
  Absent absent;
  bool fixed;        // a parameter that keeps its value after initialization: a profile
  const char *unit;  // of the range, for messages; "" without dimension
};

// null: there is no such variable in any scene
const Variable *find_variable(uint32_t reference);

// What an output of a patch that is not there is.
double rest_of(const Outputs &outputs, const Variable &variable);
// 0 where the core has none (NaN).
double output_of(const Outputs &outputs, const Variable &variable);
void put_input(rp_input &input, const Variable &variable, double value);

}  // namespace railpatch::fmu
