#include "outcome.hpp"

#include "convert.hpp"

namespace railpatch::python {

namespace {

const rp_side_result &side_of(const Outcome &from, int side) {
  if (side != RP_LEFT && side != RP_RIGHT) throw nb::index_error("side");
  return from.values.side[side];
}

}  // namespace

void bind_outcome(nb::module_ &m) {
  nb::class_<Outcome>(m, "Outcome", "rp_result of a step.")
      .def(
          "whole", [](const Outcome &from) { return result_dict(from.values); },
          "All of it, as Contact.step() gives it.")
      .def(
          "quantity",
          [](const Outcome &from, const char *name) { return quantity_of(from.values, name); },
          nb::arg("name"), "One field of rp_result. Raises KeyError.")
      .def(
          "of_side",
          [](const Outcome &from, int side, const char *name) {
            return quantity_of(side_of(from, side), name);
          },
          nb::arg("side"), nb::arg("name"), "One field of rp_side_result. Raises KeyError.")
      .def(
          "of_patch",
          [](const Outcome &from, int side, int patch, const char *name) {
            if (patch < 0 || patch >= RP_MAX_PATCHES) throw nb::index_error("patch");
            return quantity_of(side_of(from, side).patch[patch], name);
          },
          nb::arg("side"), nb::arg("patch"), nb::arg("name"),
          "One field of rp_patch_result. Raises KeyError.");
}

}  // namespace railpatch::python
