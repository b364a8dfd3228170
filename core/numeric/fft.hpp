// Seam over the FFT library: real two-dimensional transforms of a fixed list of sizes. Exactly one
// of fft_fftw.cpp and fft_eigen.cpp is built (RAILPATCH_FFT).
//
// Layout: real arrays are [ny][nx] with x fastest; spectra are [ny][nx/2 + 1], x halved.
// Normalisation: no factor. Sign: exp(-i k x). Products go the way there and back by batch_fft.hpp;
// this serves the kernels' spectra, once for each size of element.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "numeric/memory.hpp"

namespace railpatch {

class fft_plans {
 public:
  // Plans every combination of the given sizes (ascending); the only place that allocates.
  fft_plans(std::vector<int> sizes_x, std::vector<int> sizes_y);
  ~fft_plans();
  fft_plans(const fft_plans &) = delete;
  fft_plans &operator=(const fft_plans &) = delete;

  // Index of the smallest plan with at least the given sizes, -1 where there is none.
  int find(int min_nx, int min_ny) const;
  int nx(int plan) const { return sizes_x_[static_cast<size_t>(plan) / sizes_y_.size()]; }
  int ny(int plan) const { return sizes_y_[static_cast<size_t>(plan) % sizes_y_.size()]; }
  int max_nx() const { return sizes_x_.back(); }
  int max_ny() const { return sizes_y_.back(); }
  size_t bytes() const;
  // Plans for grids of half as many elements, rounded up.
  fft_plans halved() const;

  // Arrays must come from aligned_buffer (memory.hpp); the input is kept.
  void forward(int plan, const double *values, std::complex<double> *spectrum) const;

  static const char *backend();

 private:
  struct library;
  std::vector<int> sizes_x_, sizes_y_;
  std::unique_ptr<library> library_;
};

// Smallest suitable even number >= n whose only prime factors are 2, 3 and 5.
int smooth_size(int n);

}  // namespace railpatch
