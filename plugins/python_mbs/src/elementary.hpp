// The core's elementary functions for arrays of Python.
#pragma once

#include <nanobind/nanobind.h>

namespace railpatch::python {

void bind_elementary(nanobind::module_ &m);

}  // namespace railpatch::python
