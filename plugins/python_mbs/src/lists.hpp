// The lists of railpatch_fields.h for Python: what each member is, by struct and name.
#pragma once

#include <nanobind/nanobind.h>

namespace railpatch::python {

namespace nb = nanobind;

// name -> dict of "type", "shape", "role", "mirror", "sum", "unit", "text"; for the structs
// "patch", "side" and "result"
nb::dict listed_quantities();
// name of an enumeration, without rp_ -> tuple of its words
nb::dict listed_choices();
// name -> dict of "type", "shape", "role", "where", "start", "bounds", "low", "high", "unit",
// "text"
nb::dict listed_config();
nb::dict listed_input();
// of the structs "input", "result", "side" and "patch": "size" in bytes and "members", name ->
// (offset in bytes, type of a number or name of a struct, shape)
nb::dict layouts();
// low and high of what is plausible, by field
nb::dict listed_ranges();

}  // namespace railpatch::python
