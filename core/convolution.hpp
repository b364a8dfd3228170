// Products of the influence coefficients in single precision, for what only steers an iteration:
// steps of GMRES, preconditioners, lengths of steps. Residuals are formed in double precision by
// the FFT library (influence.hpp), so that a solution knows nothing of this file's rounding.
//
// Lateral direction first, all columns at once; then along x, all lateral wave numbers at once. Two
// real fields travel as one complex one; their spectra are told apart after the lateral transform.
#pragma once

#include "batch_fft.hpp"
#include "memory.hpp"

namespace railpatch {

class convolution {
 public:
  // Greatest transform, and with it the greatest padded grid; tangential: tractions too.
  convolution(int max_nx, int max_ny, bool tangential);

  // Sets grid and transform sizes.
  void set_size(int nx, int ny, int transform_nx, int transform_ny);
  enum kernel_name { zz, zz_inverse, xx, yy, xy };
  // Takes over a kernel's spectrum as fft_plans lays it out: real, of an even kernel but for xy,
  // which is odd in both directions.
  void set_spectrum(kernel_name name, const double *spectrum);

  // u = A p with zz or its inverse, [ny][nx].
  void product(kernel_name name, const double *p, double *u);
  // (s_x, s_y) = (u(x) - u(x + direction dx))/dx of u = A (p_x, p_y)
  void rolling_product(const double *px, const double *py, int direction, double dx, double *sx,
                       double *sy);
  size_t bytes() const;

 private:
  using lines = batch_fft::lines;
  lines lateral(int i) { return {lateral_[2 * i].data(), lateral_[2 * i + 1].data()}; }
  lines along(int i) { return {along_[2 * i].data(), along_[2 * i + 1].data()}; }
  lines lateral_forward(const double *first, const double *second, int count, int second_count,
                        int pitch);
  void lateral_backward(lines z, double *first, double *second, int count, int second_count,
                        int pitch);
  void tell_apart(lines z, int count, int waves, size_t second);
  lines join(lines from, int count, int waves, size_t second);

  int nx_ = 0, ny_ = 0, big_nx_ = 1, big_ny_ = 1;
  int half_ = 1;  // lateral wave numbers kept: 0 ... big_ny/2
  bool tangential_;
  batch_fft along_x_, along_y_;
  aligned_buffer<float> lateral_[4], along_[4];
  aligned_buffer<float> spectrum_[5];        // [big_nx/2 + 1][half]
  aligned_buffer<float> turn_re_, turn_im_;  // 1 - exp(i k dx)
};

}  // namespace railpatch
