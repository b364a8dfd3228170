// Products with kernels of any symmetry on a rectangular grid, by transforms of a complex field:
// two real ones travel as its real and imaginary part.
#pragma once

#include <algorithm>
#include <complex>

#include "numeric/batch_fft.hpp"
#include "numeric/fft.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

class plane_transform {
 public:
  using fft = batch_fft<double>;
  using lines = typename fft::lines;

  explicit plane_transform(const fft_plans &plans);
  void set_plan(int plan);
  int nx() const { return plans_.nx(plan_); }
  int ny() const { return plans_.ny(plan_); }
  size_t bytes() const;

  // A kernel's values at all offsets, [ny][nx], wrapped around: to be filled.
  double *kernel() { return padded_.data(); }
  // Its spectrum on all waves, with the factor of the way back: take(at, re, im) for each,
  // [nx][ny].
  template <class F>
  void spectrum_of_kernel(F &&take) {
    const int half = nx() / 2 + 1;
    const double scale = 1.0 / (static_cast<double>(nx()) * ny());
    plans_.forward(plan_, padded_.data(), transform_.data());
    for (int i = 0; i < nx(); ++i)
      for (int j = 0; j < ny(); ++j) {
        const bool mirrored = i >= half;
        const int from_i = mirrored ? nx() - i : i, from_j = mirrored ? (ny() - j) % ny() : j;
        const std::complex<double> z = transform_[static_cast<size_t>(from_j * half + from_i)];
        take(static_cast<size_t>(i * ny() + j), scale * z.real(),
             scale * (mirrored ? -z.imag() : z.imag()));
      }
  }
  void spectrum_of_kernel(double *re, double *im) {
    spectrum_of_kernel([=](size_t at, double real, double imaginary) {
      re[at] = real;
      im[at] = imaginary;
    });
  }

  // From fields on from[0] by from[1] elements (im may be null) to to[0] by to[1] ones, whose rows
  // are fft::whole_packs(to[0]) apart. multiply(from, to, stride) has the transform of the one and
  // gives that of the other: wave (i, j) is at i * stride + j.
  template <class F>
  lines product(const int from[2], const int to[2], const double *re, const double *im,
                F &&multiply) {
    const lines t = forward(from, re, im);
    const lines product = t.re == along_[0].data() ? lines{along_[2].data(), along_[3].data()}
                                                   : lines{along_[0].data(), along_[1].data()};
    const int stride = fft::whole_packs(ny());
    for (int i = 0; i < nx(); ++i) {
      std::fill(product.re + i * stride + ny(), product.re + (i + 1) * stride, 0.0);
      std::fill(product.im + i * stride + ny(), product.im + (i + 1) * stride, 0.0);
    }
    multiply(t, product, stride);
    return back(to, product, t);
  }

 private:
  lines forward(const int from[2], const double *re, const double *im);
  lines back(const int to[2], lines product, lines work);

  const fft_plans &plans_;
  int plan_ = -1;
  fft along_x_, along_y_;
  aligned_buffer<double> padded_;
  aligned_buffer<std::complex<double>> transform_;
  aligned_buffer<double> lateral_[4], along_[4];  // data and work, real and imaginary
};

}  // namespace railpatch
