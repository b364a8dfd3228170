// The permissive backend: one-dimensional transforms of Eigen's own FFT, rows and then columns.
#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "numeric/elementary.hpp"

// the library makes its tables by these: from functions that are the same on every computer
namespace Eigen {
namespace numext {
template <>
inline double sin(const double &x) {
  return railpatch::sin(x);
}
template <>
inline double cos(const double &x) {
  return railpatch::cos(x);
}
}  // namespace numext
namespace internal {
inline std::complex<double> exp(const std::complex<double> &z) {
  const double size = railpatch::exp(z.real());
  return {size * railpatch::cos(z.imag()), size * railpatch::sin(z.imag())};
}
}  // namespace internal
}  // namespace Eigen

#include <unsupported/Eigen/FFT>

#include "numeric/fft.hpp"

namespace railpatch {

struct fft_plans::library {
  Eigen::FFT<double> fft;
  aligned_buffer<std::complex<double>> column, image;
};

fft_plans::fft_plans(std::vector<int> sizes_x, std::vector<int> sizes_y)
    : sizes_x_(std::move(sizes_x)),
      sizes_y_(std::move(sizes_y)),
      library_(std::make_unique<library>()) {
  library_->fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  library_->fft.SetFlag(Eigen::FFT<double>::Unscaled);
  library_->column = aligned_buffer<std::complex<double>>(static_cast<size_t>(max_ny()));
  library_->image = aligned_buffer<std::complex<double>>(static_cast<size_t>(max_ny()));
  // the library makes its tables when it first meets a size: that is now, not in a step
  const auto count = static_cast<size_t>(max_nx()) * static_cast<size_t>(max_ny());
  aligned_buffer<double> values(count);
  values[0] = 1;
  aligned_buffer<std::complex<double>> spectrum(static_cast<size_t>(max_nx() / 2 + 1) *
                                                static_cast<size_t>(max_ny()));
  const auto columns = static_cast<int>(sizes_y_.size());
  for (int i = 0; i < static_cast<int>(sizes_x_.size()); ++i)
    for (int j = 0; j < columns; j += i == 0 ? 1 : columns)
      forward(i * columns + j, values.data(), spectrum.data());
}

fft_plans::~fft_plans() = default;

size_t fft_plans::bytes() const { return 2 * library_->column.bytes(); }

void fft_plans::forward(int plan, const double *values, std::complex<double> *spectrum) const {
  const int width = nx(plan), height = ny(plan), half = width / 2 + 1;
  library &l = *library_;
  for (int j = 0; j < height; ++j) {
    const double *row = values + j * width;
    // half of a padded array is zero, and so is its transform
    if (std::all_of(row, row + width, [](double v) { return v == 0; }))
      std::fill_n(spectrum + j * half, half, 0.0);
    else
      l.fft.fwd(spectrum + j * half, row, width);
  }
  if (height == 1) return;
  for (int i = 0; i < half; ++i) {
    for (int j = 0; j < height; ++j) l.column[static_cast<size_t>(j)] = spectrum[j * half + i];
    l.fft.fwd(l.image.data(), l.column.data(), height);
    for (int j = 0; j < height; ++j) spectrum[j * half + i] = l.image[static_cast<size_t>(j)];
  }
}

const char *fft_plans::backend() { return "eigen"; }

}  // namespace railpatch
