// Run times without those of Python: the clock stands here, the core has none.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <vector>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

// A list of inputs, stepped through as often as asked for.
class timed_steps {
 public:
  // raises ValueError where the lists differ in length or repeat < 1
  timed_steps(const nb::list &inputs, const nb::list &reset, int repeat, bool processor_time);

  // needs no interpreter; stops at the first step that the library refuses
  rp_error run(rp_contact *contact, rp_message &message);
  // seconds [repeat, n] and the results of the last pass
  nb::tuple outcome();

 private:
  std::vector<rp_input> inputs_;
  std::vector<char> reset_;
  size_t repeat_;
  bool processor_time_;
  std::vector<rp_result> results_;
  std::unique_ptr<double[]> seconds_;
};

// seconds of each real forward transform of size x size numbers by the core's FFT
nb::ndarray<nb::numpy, double, nb::ndim<1>> time_fft(int size, int repeat);

}  // namespace railpatch::python
