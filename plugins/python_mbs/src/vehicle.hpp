// What a vehicle does between contact solves, compiled: forces of its suspension, its way along the
// track, means of its wheels' forces. Formulas and frames: wheelset_demo/vehicle, whose modules
// prepare the arrays. No contacts here.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>

namespace railpatch::python {

namespace nb = nanobind;

using Indices = nb::ndarray<const int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IndexGrid = nb::ndarray<const int64_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Cube = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

void bind_suspension(nb::module_ &m);
void bind_course(nb::module_ &m);
void bind_means(nb::module_ &m);

}  // namespace railpatch::python
