// The result of one step, of which Python reads what it asks for.
#pragma once

#include <nanobind/nanobind.h>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

struct Outcome {
  rp_result values;
};

void bind_outcome(nb::module_ &m);

}  // namespace railpatch::python
