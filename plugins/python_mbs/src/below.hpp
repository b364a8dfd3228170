// The class railpatch._core.Below: stresses below the patches of a contact's last step.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <mutex>
#include <vector>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

class Below {
 public:
  // Of a contact that lives longer, with its mutex.
  Below(const rp_contact *contact, std::mutex &mutex, std::vector<double> depths,
        bool displacements, double dang_van);

  // Raises LookupError where the last step has no such patch.
  void solve(int side, int patch, int body);
  nb::ndarray<nb::numpy, double> field(const char *name);
  nb::ndarray<nb::numpy, double> at(
      int side, int patch, int body,
      const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu> &points);

 private:
  struct Destroy {
    void operator()(rp_subsurface *below) const { rp_destroy_subsurface(below); }
  };
  const rp_contact *contact_;
  std::mutex &mutex_;
  std::vector<double> depths_;
  std::unique_ptr<rp_subsurface, Destroy> below_;
};

void bind_below(nb::module_ &m);

}  // namespace railpatch::python
