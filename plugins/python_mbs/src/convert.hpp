// Python dictionaries <-> the structs of railpatch.h. Names of the keys are the names of the
// fields; enumerations are given as the texts of the case file. Checks of values are the core's.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <vector>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Bytes = nb::ndarray<const uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Grid = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

using Cube = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

// profiles along the track or round a wheel, and where
struct Sections {
  std::vector<rp_profile> profiles;
  std::vector<double> places;
  std::vector<int32_t> kinks;  // none, or one each
};

// a config and the arrays that its pointers look into
struct Config {
  rp_config values;
  std::vector<Values> profiles;
  Sections rail_sections[2], wheel_sections[2];
  Grid gap;
  Cube own_influence;
  Bytes table;
};

// starts from rp_default_config; raises KeyError for a key that is no field
void fill_config(const nb::dict &from, Config &to);
// keys that are left out keep their value
void fill_input(const nb::dict &from, rp_input &to);

// the rigid slip of each element that inputs point to, as long as they do
class SlipField {
 public:
  void of(const rp_config &config) {
    for (int k = 0; k < 2; ++k) shape_[k] = config.distance_shape[k];
  }
  // raises CaseError for an array of another shape than the grid's
  void fill(const nb::dict &from, rp_input &to);

 private:
  nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu> values_;
  int32_t shape_[2] = {0, 0};
};

// every plain field as a list of numbers, defaults filled in, enumerations as their values
nb::dict config_dict(const rp_config &config);
nb::dict result_dict(const rp_result &result);
// one field of the same, as it is there; raises KeyError
nb::object quantity_of(const rp_result &from, const char *name);
nb::object quantity_of(const rp_side_result &from, const char *name);
nb::object quantity_of(const rp_patch_result &from, const char *name);
// texts of bits 1 << RP_WARNING_...
nb::list warnings_of(uint32_t bits);
// None where all is well
nb::object reason_text(rp_reason reason, double value);
nb::dict jacobian_dict(const rp_jacobian &found);
nb::list stage_list(const rp_stage_info *info, const double *seconds);

// the field's name in the JSON result; raises KeyError
rp_field field_of(const char *name);

}  // namespace railpatch::python
