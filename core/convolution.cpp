#include "convolution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simd.hpp"

namespace railpatch {

namespace {

// the two real fields' shares of one row along x, of which p is the transform
struct rolling_row {
  int half;
  float turn_re, turn_im;  // 1/m, (1 - exp(i k dx))/dx
  float xy_sign;
  const float *xx, *yy, *xy;
  float *re, *im;  // x field, then y field
};

RAILPATCH_DISPATCH
void multiply_rolling(const rolling_row &f) {
  const auto half = static_cast<size_t>(f.half);
  float *__restrict re = f.re, *__restrict im = f.im;
  RAILPATCH_INDEPENDENT
  for (size_t i = 0; i < half; ++i) {
    const float xy = f.xy_sign * f.xy[i];
    const float xr = f.xx[i] * re[i] + xy * re[half + i];
    const float xi = f.xx[i] * im[i] + xy * im[half + i];
    const float yr = xy * re[i] + f.yy[i] * re[half + i];
    const float yi = xy * im[i] + f.yy[i] * im[half + i];
    re[i] = f.turn_re * xr - f.turn_im * xi;
    im[i] = f.turn_re * xi + f.turn_im * xr;
    re[half + i] = f.turn_re * yr - f.turn_im * yi;
    im[half + i] = f.turn_re * yi + f.turn_im * yr;
  }
}

RAILPATCH_DISPATCH
void multiply(const float *__restrict a, int half, float *__restrict re, float *__restrict im) {
  for (int i = 0; i < half; ++i) {
    re[i] *= a[i];
    im[i] *= a[i];
  }
}

// doubles to single precision and back, `rest` zeros behind
RAILPATCH_DISPATCH
void load(const double *__restrict from, int count, int rest, float *__restrict to) {
  for (int i = 0; i < count; ++i) to[i] = static_cast<float>(from[i]);
  for (int i = count; i < count + rest; ++i) to[i] = 0.0f;
}

RAILPATCH_DISPATCH
void store(const float *__restrict from, int count, double *__restrict to) {
  for (int i = 0; i < count; ++i) to[i] = static_cast<double>(from[i]);
}

}  // namespace

convolution::convolution(int max_nx, int max_ny, bool tangential)
    : tangential_(tangential), along_x_(max_nx), along_y_(max_ny) {
  const int half = max_ny / 2 + 1;
  const int columns = batch_fft::whole_packs(max_nx / 2 + 1);
  const int waves = batch_fft::whole_packs((tangential ? 2 : 1) * half);
  for (auto &b : lateral_)
    b = aligned_buffer<float>(static_cast<size_t>(columns) * static_cast<size_t>(max_ny));
  for (auto &b : along_)
    b = aligned_buffer<float>(static_cast<size_t>(waves) * static_cast<size_t>(max_nx));
  for (int k = 0; k < (tangential ? 5 : 2); ++k)
    spectrum_[k] =
        aligned_buffer<float>(static_cast<size_t>(max_nx / 2 + 1) * static_cast<size_t>(half));
  turn_re_ = aligned_buffer<float>(static_cast<size_t>(max_nx));
  turn_im_ = aligned_buffer<float>(static_cast<size_t>(max_nx));
}

size_t convolution::bytes() const {
  return along_x_.bytes() + along_y_.bytes() + 4 * (lateral_[0].bytes() + along_[0].bytes()) +
         (tangential_ ? 5 : 2) * spectrum_[0].bytes() + 2 * turn_re_.bytes();
}

void convolution::set_size(int nx, int ny, int transform_nx, int transform_ny) {
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
    const double sine = std::sin(0.5 * angle);
    turn_re_[static_cast<size_t>(k)] = static_cast<float>(2.0 * sine * sine);
    turn_im_[static_cast<size_t>(k)] = static_cast<float>(-std::sin(angle));
  }
}

void convolution::set_spectrum(kernel_name name, const double *spectrum) {
  // half: each field is half the sum or difference of two wave numbers; the rest: normalisation
  const double scale = 0.5 / (static_cast<double>(big_nx_) * big_ny_);
  const int width = big_nx_ / 2 + 1;
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < half_; ++j)
      spectrum_[name][static_cast<size_t>(i * half_ + j)] =
          static_cast<float>(scale * spectrum[j * width + i]);
}

// Two fields of `count` columns each, row by row `pitch` apart, as one complex field; transformed.
convolution::lines convolution::lateral_forward(const double *first, const double *second,
                                                int count, int second_count, int pitch) {
  const int columns = batch_fft::whole_packs(count);
  const lines z = lateral(0);
  for (int j = 0; j < ny_; ++j) {
    load(first + j * pitch, count, columns - count, z.re + j * columns);
    load(second + j * pitch, second_count, columns - second_count, z.im + j * columns);
  }
  std::fill(z.re + ny_ * columns, z.re + big_ny_ * columns, 0.0f);
  std::fill(z.im + ny_ * columns, z.im + big_ny_ * columns, 0.0f);
  return along_y_.transform(columns, z, lateral(1));
}

void convolution::lateral_backward(lines z, double *first, double *second, int count,
                                   int second_count, int pitch) {
  const int columns = batch_fft::whole_packs(count);
  const lines other = z.re == lateral(0).re ? lateral(1) : lateral(0);
  const lines u = along_y_.transform(columns, {z.im, z.re}, {other.im, other.re});
  for (int j = 0; j < ny_; ++j) {
    store(u.im + j * columns, count, first + j * pitch);
    store(u.re + j * columns, second_count, second + j * pitch);
  }
}

// From [lateral wave][column] to [x][lateral wave], the fields told apart: the second begins
// `second` numbers behind the first.
void convolution::tell_apart(lines z, int count, int waves, size_t second) {
  const int columns = batch_fft::whole_packs(count);
  const lines to = along(0);
  for (int i = 0; i < count; ++i) {
    float *re = to.re + i * waves, *im = to.im + i * waves;
    for (int j = 0; j < half_; ++j) {
      const int at = j * columns + i, mirror = (j > 0 ? big_ny_ - j : 0) * columns + i;
      re[j] = z.re[at] + z.re[mirror];
      im[j] = z.im[at] - z.im[mirror];
      re[second + static_cast<size_t>(j)] = z.im[at] + z.im[mirror];
      im[second + static_cast<size_t>(j)] = z.re[mirror] - z.re[at];
    }
    // nothing of other sizes is left in the lines that only fill a pack
    const int used = second < static_cast<size_t>(waves) ? 2 * half_ : half_;
    std::fill(re + used, re + waves, 0.0f);
    std::fill(im + used, im + waves, 0.0f);
  }
}

// The way back.
convolution::lines convolution::join(lines from, int count, int waves, size_t second) {
  const int columns = batch_fft::whole_packs(count);
  const lines z = lateral(0);
  for (int i = 0; i < count; ++i) {
    const float *re = from.re + i * waves, *im = from.im + i * waves;
    for (int j = 0; j < half_; ++j) {
      const size_t k = second + static_cast<size_t>(j);
      const int at = j * columns + i, mirror = (j > 0 ? big_ny_ - j : 0) * columns + i;
      z.re[mirror] = re[j] + im[k];
      z.im[mirror] = re[k] - im[j];
      z.re[at] = re[j] - im[k];
      z.im[at] = im[j] + re[k];
    }
  }
  return z;
}

void convolution::product(kernel_name name, const double *p, double *u) {
  // the two halves of the grid along x are the two fields
  const int count = (nx_ + 1) / 2, rest = nx_ - count, waves = batch_fft::whole_packs(half_);
  const auto second = static_cast<size_t>(count * waves);
  tell_apart(lateral_forward(p, p + count, count, rest, nx_), count, waves, second);
  const lines data = along(0);
  std::fill(data.re + nx_ * waves, data.re + big_nx_ * waves, 0.0f);
  std::fill(data.im + nx_ * waves, data.im + big_nx_ * waves, 0.0f);
  const lines t = along_x_.transform(waves, data, along(1));
  for (int i = 0; i < big_nx_; ++i)
    multiply(spectrum_[name].data() + std::min(i, big_nx_ - i) * half_, half_, t.re + i * waves,
             t.im + i * waves);
  const lines other = t.re == along(0).re ? along(1) : along(0);
  const lines back = along_x_.transform(waves, {t.im, t.re}, {other.im, other.re});
  lateral_backward(join({back.im, back.re}, count, waves, second), u, u + count, count, rest, nx_);
}

void convolution::rolling_product(const double *px, const double *py, int direction, double dx,
                                  double *sx, double *sy) {
  const int waves = batch_fft::whole_packs(2 * half_);
  const auto second = static_cast<size_t>(half_);
  tell_apart(lateral_forward(px, py, nx_, nx_, nx_), nx_, waves, second);
  const lines data = along(0);
  std::fill(data.re + nx_ * waves, data.re + big_nx_ * waves, 0.0f);
  std::fill(data.im + nx_ * waves, data.im + big_nx_ * waves, 0.0f);
  const lines t = along_x_.transform(waves, data, along(1));
  const auto per_length = static_cast<float>(1.0 / dx);
  for (int i = 0; i < big_nx_; ++i) {
    const bool upper = 2 * i > big_nx_;
    const int row = (upper ? big_nx_ - i : i) * half_;
    const auto at = static_cast<size_t>(i);
    multiply_rolling({half_, per_length * turn_re_[at],
                      per_length * static_cast<float>(direction) * turn_im_[at],
                      upper ? -1.0f : 1.0f, spectrum_[xx].data() + row, spectrum_[yy].data() + row,
                      spectrum_[xy].data() + row, t.re + i * waves, t.im + i * waves});
  }
  const lines other = t.re == along(0).re ? along(1) : along(0);
  const lines back = along_x_.transform(waves, {t.im, t.re}, {other.im, other.re});
  lateral_backward(join({back.im, back.re}, nx_, waves, second), sx, sy, nx_, nx_, nx_);
}

}  // namespace railpatch
