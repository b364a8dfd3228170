// The core's elementary functions for arrays: what Python prepares is the same on every computer.

#include "elementary.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <string>

#include "numeric/elementary.hpp"

namespace railpatch::python {

namespace nb = nanobind;

namespace {

using Values = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

constexpr struct {
  const char *name;
  double (*function)(double);
} kFunctions[] = {
    {"sin", &railpatch::sin},   {"cos", &railpatch::cos},   {"tan", &railpatch::tan},
    {"asin", &railpatch::asin}, {"acos", &railpatch::acos}, {"atan", &railpatch::atan},
};

void apply(const std::string &name, Values x) {
  for (const auto &known : kFunctions) {
    if (name != known.name) continue;
    for (size_t i = 0; i < x.size(); ++i) x.data()[i] = known.function(x.data()[i]);
    return;
  }
  throw nb::value_error(("no function " + name).c_str());
}

void apply_hypot(Values x, Values y) {
  if (x.size() != y.size()) throw nb::value_error("arrays of different sizes");
  for (size_t i = 0; i < x.size(); ++i) x.data()[i] = hypot(x.data()[i], y.data()[i]);
}

}  // namespace

void bind_elementary(nb::module_ &m) {
  m.def("apply", &apply, nb::arg("name"), nb::arg("x"),
        "Replaces each number of an array by that function of it.");
  m.def("apply_hypot", &apply_hypot, nb::arg("x"), nb::arg("y"),
        "Replaces each number of the first array by the length of its pair.");
}

}  // namespace railpatch::python
