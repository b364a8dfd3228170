#include "variables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

namespace railpatch::fmu {

namespace {

// sorted by reference
constexpr Variable kVariables[] = {
#include "variables.inc"
};

double read_field(const Outputs &outputs, Type type, size_t field) {
  const unsigned char *from = reinterpret_cast<const unsigned char *>(&outputs) + field;
  if (type != Type::real) {
    int32_t value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
  double value;
  std::memcpy(&value, from, sizeof value);
  return std::isfinite(value) ? value : 0.0;
}

}  // namespace

static_assert(sizeof(rp_status) == sizeof(int32_t));

const Variable *find_variable(uint32_t reference) {
  const auto before = [](const Variable &v, uint32_t wanted) { return v.reference < wanted; };
  const auto *found =
      std::lower_bound(std::begin(kVariables), std::end(kVariables), reference, before);
  return found != std::end(kVariables) && found->reference == reference ? found : nullptr;
}

double rest_of(const Outputs &outputs, const Variable &variable) {
  if (variable.absent == Absent::no_contact) return RP_NO_CONTACT;
  return variable.absent == Absent::warmer_bulk ? outputs.rest_temperature : 0;
}

double output_of(const Outputs &outputs, const Variable &variable) {
  if (variable.field == no_field) return 0;
  const double value = read_field(outputs, variable.type, variable.field);
  if (variable.plus == no_field) return value;
  return value + read_field(outputs, variable.type, variable.plus);
}

void put_input(rp_input &input, const Variable &variable, double value) {
  if (variable.field == no_field) return;
  unsigned char *to = reinterpret_cast<unsigned char *>(&input) + variable.field;
  if (variable.type != Type::real) {
    const auto whole = static_cast<int32_t>(value);
    std::memcpy(to, &whole, sizeof whole);
  } else {
    std::memcpy(to, &value, sizeof value);
  }
}

}  // namespace railpatch::fmu
