#include "numeric/convolution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

// one row along x of the transforms of two fields: x field, then y field, each `half` numbers
template <class T>
struct tangential_row {
  int half;
  T turn_re, turn_im;
  T xy_sign;
  const T *xx, *yy, *xy;
  T *re, *im;
};

template <class T>
RAILPATCH_INLINE void multiply_row(const tangential_row<T> &f) {
  const auto half = static_cast<size_t>(f.half);
  T *__restrict re = f.re, *__restrict im = f.im;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < half; ++i) {
    const T xy = f.xy_sign * f.xy[i];
    const T xr = f.xx[i] * re[i] + xy * re[half + i];
    const T xi = f.xx[i] * im[i] + xy * im[half + i];
    const T yr = xy * re[i] + f.yy[i] * re[half + i];
    const T yi = xy * im[i] + f.yy[i] * im[half + i];
    re[i] = f.turn_re * xr - f.turn_im * xi;
    im[i] = f.turn_re * xi + f.turn_im * xr;
    re[half + i] = f.turn_re * yr - f.turn_im * yi;
    im[half + i] = f.turn_re * yi + f.turn_im * yr;
  }
}

// Adds what a row's waves give p . A p, wave by wave.
RAILPATCH_DISPATCH
void add_squares(const tangential_row<double> &f, double *to) {
  const auto half = static_cast<size_t>(f.half);
  const double *__restrict re = f.re, *__restrict im = f.im;
  double *__restrict sum = to;
  const double twice = 2 * f.xy_sign;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < half; ++i)
    sum[i] += (f.xx[i] * (re[i] * re[i] + im[i] * im[i]) +
               f.yy[i] * (re[half + i] * re[half + i] + im[half + i] * im[half + i])) +
              twice * f.xy[i] * (re[i] * re[half + i] + im[i] * im[half + i]);
}

template <class T>
RAILPATCH_INLINE void multiply_row(const T *__restrict a, int half, T *__restrict re,
                                   T *__restrict im) {
  for (int i = 0; i < half; ++i) {
    re[i] *= a[i];
    im[i] *= a[i];
  }
}

// dispatch does not go with templates
RAILPATCH_DISPATCH
void multiply(const tangential_row<float> &f) { multiply_row(f); }
RAILPATCH_DISPATCH
void multiply(const tangential_row<double> &f) { multiply_row(f); }
RAILPATCH_DISPATCH
void multiply(const float *a, int half, float *re, float *im) { multiply_row(a, half, re, im); }
RAILPATCH_DISPATCH
void multiply(const double *a, int half, double *re, double *im) { multiply_row(a, half, re, im); }

}  // namespace

template <class T>
convolution<T>::convolution(int max_nx, int max_ny, bool tangential)
    : tangential_(tangential), along_x_(max_nx), along_y_(max_ny) {
  const auto nx = static_cast<size_t>(max_nx), ny = static_cast<size_t>(max_ny);
  const int half = max_ny / 2 + 1;
  const auto columns = static_cast<size_t>(fft::whole_packs(max_nx / 2 + 1));
  const auto waves = static_cast<size_t>(fft::whole_packs((tangential ? 2 : 1) * half));
  for (auto &b : lateral_) b = aligned_buffer<T>(columns * ny);
  for (auto &b : along_) b = aligned_buffer<T>(waves * nx);
  for (int k = 0; k < (tangential ? 5 : 2); ++k)
    spectrum_[k] = aligned_buffer<T>((nx / 2 + 1) * static_cast<size_t>(half));
  turn_re_ = aligned_buffer<T>(nx);
  turn_im_ = aligned_buffer<T>(nx);
  if (tangential && exact) square_ = aligned_buffer<double>(static_cast<size_t>(half));
}

template <class T>
size_t convolution<T>::bytes() const {
  return along_x_.bytes() + along_y_.bytes() + 4 * (lateral_[0].bytes() + along_[0].bytes()) +
         (tangential_ ? 5 : 2) * spectrum_[0].bytes() + 2 * turn_re_.bytes() + square_.bytes();
}

template <class T>
void convolution<T>::set_size(int nx, int ny, int transform_nx, int transform_ny) {
  nx_ = nx;
  ny_ = ny;
  if (transform_nx == big_nx_ && transform_ny == big_ny_) return;
  big_nx_ = transform_nx;
  big_ny_ = transform_ny;
  half_ = transform_ny / 2 + 1;
  along_x_.set_length(transform_nx);
  along_y_.set_length(transform_ny);
  for (int k = 0; k < transform_nx; ++k) {
    // 1 - exp(i angle), without the difference of nearly equal numbers
    const double angle = 2.0 * std::numbers::pi * k / transform_nx;
    const double sine = sin(0.5 * angle);
    turn_re_[static_cast<size_t>(k)] = static_cast<T>(2.0 * sine * sine);
    turn_im_[static_cast<size_t>(k)] = static_cast<T>(-sin(angle));
  }
}

template <class T>
void convolution<T>::set_spectrum(kernel_name name, const double *spectrum) {
  // half: each field is half the sum or difference of two wave numbers; the rest: normalisation
  const double scale = 0.5 / (static_cast<double>(big_nx_) * big_ny_);
  const int width = big_nx_ / 2 + 1;
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < half_; ++j)
      spectrum_[name][static_cast<size_t>(i * half_ + j)] =
          static_cast<T>(scale * spectrum[j * width + i]);
}

// The fields as real and imaginary part of one.
template <class T>
void convolution<T>::load_lateral(const two_fields &f, const double *const in[2]) {
  const int columns = fft::whole_packs(f.columns[0]);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < ny_; ++j) {
      T *to = lateral_[k].data() + j * columns;
      for (int i = 0; i < f.columns[k]; ++i) to[i] = static_cast<T>(in[k][j * nx_ + i]);
      std::fill(to + f.columns[k], to + columns, T(0));
    }
}

template <class T>
void convolution<T>::store_lateral(const two_fields &f, lines z, double *const out[2]) const {
  const int columns = fft::whole_packs(f.columns[0]);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < ny_; ++j) {
      const T *from = (k == 0 ? z.re : z.im) + j * columns;
      for (int i = 0; i < f.columns[k]; ++i) out[k][j * nx_ + i] = static_cast<double>(from[i]);
    }
}

// From [lateral wave][column] to [x][lateral wave], the fields told apart.
template <class T>
void convolution<T>::tell_apart(const two_fields &f, lines z) {
  const int columns = fft::whole_packs(f.columns[0]);
  const int used = f.second < static_cast<size_t>(f.waves) ? 2 * half_ : half_;
  for (int i = 0; i < f.columns[0]; ++i) {
    T *re = along_[0].data() + i * f.waves, *im = along_[1].data() + i * f.waves;
    T *re_2 = re + f.second, *im_2 = im + f.second;
    for (int j = 0; j < half_; ++j) {
      const int at = j * columns + i, mirror = (j > 0 ? big_ny_ - j : 0) * columns + i;
      re[j] = z.re[at] + z.re[mirror];
      im[j] = z.im[at] - z.im[mirror];
      re_2[j] = z.im[at] + z.im[mirror];
      im_2[j] = z.re[mirror] - z.re[at];
    }
    // nothing of other sizes is left in the lines that only fill a pack
    std::fill(re + used, re + f.waves, T(0));
    std::fill(im + used, im + f.waves, T(0));
    if (used > half_) continue;
    std::fill(re_2 + used, re_2 + f.waves, T(0));
    std::fill(im_2 + used, im_2 + f.waves, T(0));
  }
}

// The way back.
template <class T>
void convolution<T>::join(const two_fields &f, lines from) {
  const int columns = fft::whole_packs(f.columns[0]);
  T *z_re = lateral_[0].data(), *z_im = lateral_[1].data();
  for (int i = 0; i < f.columns[0]; ++i) {
    const T *re = from.re + i * f.waves, *im = from.im + i * f.waves;
    const T *re_2 = re + f.second, *im_2 = im + f.second;
    for (int j = 0; j < half_; ++j) {
      const int at = j * columns + i, mirror = (j > 0 ? big_ny_ - j : 0) * columns + i;
      z_re[mirror] = re[j] + im_2[j];
      z_im[mirror] = re_2[j] - im[j];
      z_re[at] = re[j] - im_2[j];
      z_im[at] = im[j] + re_2[j];
    }
  }
}

// multiply(number of the row along x, its lateral wave numbers)
template <class T>
template <class Multiply>
void convolution<T>::convolve(const two_fields &f, const double *const in[2], double *const out[2],
                              Multiply &&multiply) {
  const int columns = fft::whole_packs(f.columns[0]);
  const lines lateral[2] = {{lateral_[0].data(), lateral_[1].data()},
                            {lateral_[2].data(), lateral_[3].data()}};
  const lines along[2] = {{along_[0].data(), along_[1].data()},
                          {along_[2].data(), along_[3].data()}};
  load_lateral(f, in);
  tell_apart(f, along_y_.forward(columns, ny_, lateral[0], lateral[1]));
  const lines t = along_x_.forward(f.waves, nx_, along[0], along[1]);
  for (int i = 0; i < big_nx_; ++i) multiply(i, lines{t.re + i * f.waves, t.im + i * f.waves});
  // columns of the second half-field lie behind those of the first: one more where nx is odd
  const int used = f.second < static_cast<size_t>(f.waves) ? nx_ : 2 * f.columns[0];
  join(f, along_x_.backward(f.waves, used, t, t.re == along[0].re ? along[1] : along[0]));
  store_lateral(f, along_y_.backward(columns, ny_, lateral[0], lateral[1]), out);
}

template <class T>
void convolution<T>::product(kernel_name name, const double *p, double *u) {
  // the two halves of the grid along x are the two fields
  const int left = (nx_ + 1) / 2, waves = fft::whole_packs(half_);
  const two_fields f{{left, nx_ - left}, waves, static_cast<size_t>(left * waves)};
  const double *const in[2] = {p, p + left};
  double *const out[2] = {u, u + left};
  convolve(f, in, out, [&](int i, lines row) {
    multiply(spectrum_[name].data() + std::min(i, big_nx_ - i) * half_, half_, row.re, row.im);
  });
}

// turn(number of the row along x, factor's real and imaginary part)
template <class T>
template <bool squares, class Turn>
void convolution<T>::two_products(const double *const in[2], double *const out[2], Turn &&turn) {
  const two_fields f{{nx_, nx_}, fft::whole_packs(2 * half_), static_cast<size_t>(half_)};
  convolve(f, in, out, [&](int i, lines row) {
    const bool upper = 2 * i > big_nx_;
    const int at = (upper ? big_nx_ - i : i) * half_;
    T re, im;
    turn(static_cast<size_t>(i), re, im);
    const tangential_row<T> waves{half_,
                                  re,
                                  im,
                                  upper ? T(-1) : T(1),
                                  spectrum_[xx].data() + at,
                                  spectrum_[yy].data() + at,
                                  spectrum_[xy].data() + at,
                                  row.re,
                                  row.im};
    if constexpr (squares) add_squares(waves, square_.data());
    multiply(waves);
  });
}

template <class T>
void convolution<T>::tangential_product(const double *px, const double *py, double *ux,
                                        double *uy) {
  const double *const in[2] = {px, py};
  double *const out[2] = {ux, uy};
  two_products<false>(in, out, [](size_t, T &re, T &im) { re = 1, im = 0; });
}

template <class T>
double convolution<T>::rolling_product(const double *px, const double *py, int direction, double dx,
                                       double *sx, double *sy) {
  const double *const in[2] = {px, py};
  double *const out[2] = {sx, sy};
  const auto factor = static_cast<T>(1.0 / dx);
  std::fill_n(square_.data(), square_.size(), 0.0);
  two_products<exact>(in, out, [&](size_t i, T &re, T &im) {
    re = factor * turn_re_[i];
    im = factor * static_cast<T>(direction) * turn_im_[i];
  });
  if (!exact) return nan;
  // waves other than the first and the middle one stand for two; fields are twice themselves, and
  // spectra half of theirs
  double sum = 0;
  for (int j = 0; j < half_; ++j)
    sum += (j == 0 || 2 * j == big_ny_ ? 0.5 : 1.0) * square_[static_cast<size_t>(j)];
  return sum;
}

template class convolution<float>;
template class convolution<double>;

}  // namespace railpatch
