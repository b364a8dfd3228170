// Variables by value reference: type, range and the field of rp_input or rp_result behind each. The
// table itself is generated from variables.toml.
#pragma once

#include <cstddef>
#include <cstdint>

#include "railpatch.h"

namespace railpatch::fmu {

enum class Type : uint8_t { real, integer };
enum class Role : uint8_t { input, output, parameter };

inline constexpr size_t no_field = SIZE_MAX;

struct Variable {
  uint32_t reference;
  Type type;
  Role role;
  size_t field;  // offset in rp_input or rp_result
  size_t plus;   // of a second field that is added
  double low, high;
};

// null: there is no such variable in any scene
const Variable *find_variable(uint32_t reference);

// A value of rp_result; 0 where the core has none (NaN).
double output_of(const rp_result &result, const Variable &variable);
void put_input(rp_input &input, const Variable &variable, double value);

}  // namespace railpatch::fmu
