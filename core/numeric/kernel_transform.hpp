// Spectra of kernels on a periodic grid that are even in both directions, or odd in both, from
// their values in one quarter.
//
// An even sequence of even length n is told by f_0 ... f_(n/2); its spectrum is twice the real part
// of that of f_0/2, f_1 ... f_(n/2 - 1), with f_(n/2) added, wave by wave with the other sign. An
// odd one's is twice the imaginary part, times i, and its value in the middle is 0.
#pragma once

#include "numeric/batch_fft.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

class kernel_transform {
 public:
  kernel_transform(int max_nx, int max_ny);
  // Lengths of the transform: even, or 1 laterally, without prime factors above 5.
  void set_size(int nx, int ny);
  // values: at offsets 0 ... nx/2 along x and 0 ... ny/2 laterally, a row of x every `stride`.
  // Writes the real spectrum, [ny][nx/2 + 1], as fft_plans lays it out.
  void make(bool odd, const double *values, int stride, double *spectrum);
  size_t bytes() const { return along_x_.bytes() + along_y_.bytes() + 4 * buffer_[0].bytes(); }

 private:
  using fft = batch_fft<double>;
  using lines = fft::lines;
  lines laterally(bool odd, const double *values, int stride);

  int nx_ = 0, ny_ = 0;
  fft along_x_, along_y_;
  aligned_buffer<double> buffer_[4];
};

}  // namespace railpatch
