#include "influence.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace railpatch {

namespace {

using std::numbers::pi;

// y ln(x + r) with the part that cancels in differences along x taken out: ln(x+r) - ln|y|.
double y_log(double x, double y) { return y * std::asinh(x / std::abs(y)); }

// primitive of ln(width/|x|)
double line_primitive(double x, double width) { return x * (1.0 + std::log(width / std::abs(x))); }

}  // namespace

elastic_constants combine(const double shear_modulus[2], const double poisson_ratio[2]) {
  const double gw = shear_modulus[0], gr = shear_modulus[1];
  const double nw = poisson_ratio[0], nr = poisson_ratio[1];
  const double g = 2.0 / (1.0 / gw + 1.0 / gr);
  return {g, 0.5 * g * (nw / gw + nr / gr),
          0.25 * g * ((1.0 - 2.0 * nw) / gw - (1.0 - 2.0 * nr) / gr)};
}

influence::influence(const scene &scene, const fft_plans &plans)
    : scene_(scene), plans_(plans), single_(plans.max_nx(), plans.max_ny(), scene.tangential) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  const size_t table = (nx / 2 + 1) * (ny / 2 + 1);
  const size_t half = (nx / 2 + 1) * ny;
  const int kernels = scene.tangential ? 4 : 1;
  stride_ = static_cast<int>(nx / 2 + 1);
  for (int k = 0; k < kernels; ++k) {
    table_[k] = aligned_buffer<double>(table);
    spectrum_[k] = aligned_buffer<double>(half);
  }
  for (auto &corner : corner_) corner = aligned_buffer<double>((nx / 2 + 2) * (ny / 2 + 2));
  padded_ = aligned_buffer<double>(nx * ny);
  for (int k = 0; k < (scene.tangential ? 2 : 1); ++k)
    transform_[k] = aligned_buffer<std::complex<double>>(half);
  if (scene.tangential) shift_ = aligned_buffer<std::complex<double>>(nx / 2 + 1);
}

bool influence::set_grid(const grid &g) {
  // one element more along x: the product is also seen from one element upstream
  const int plan = plans_.find(2 * g.nx + 1, g.ny > 1 ? 2 * g.ny - 1 : 1);
  if (plan < 0) return false;
  const bool same_elements = g.dx == grid_.dx && g.dy == grid_.dy;
  const int half_x = plans_.nx(plan) / 2, half_y = plans_.ny(plan) / 2;
  grid_ = g;
  single_.set_size(g.nx, g.ny, plans_.nx(plan), plans_.ny(plan));
  if (same_elements && plan == plan_) return true;
  if (!same_elements || half_x > half_x_ || half_y > half_y_) make_kernels(half_x, half_y);
  plan_ = plan;
  make_spectra();
  return true;
}

void influence::make_kernels(int half_x, int half_y) {
  half_x_ = half_x;
  half_y_ = half_y;
  if (scene_.line_width > 0)
    make_line_kernels();
  else
    make_half_space_kernels();
  if (!scene_.tangential) return;
  table_[1][0] += scene_.layer_flexibility;
  table_[2][0] += scene_.layer_flexibility;
}

void influence::make_half_space_kernels() {
  const int nx = half_x_ + 2, ny = half_y_ + 2;
  // primitives at the element corners, from half an element before the origin on
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = (i - 0.5) * grid_.dx, y = (j - 0.5) * grid_.dy;
      const auto at = static_cast<size_t>(j * nx + i);
      corner_[0][at] = y_log(x, y);
      corner_[1][at] = y_log(y, x);
      corner_[2][at] = -std::hypot(x, y);
    }
  const double nu = scene_.elastic.poisson_ratio;
  const double c = 1.0 / (pi * scene_.elastic.shear_modulus);
  for (int j = 0; j <= half_y_; ++j)
    for (int i = 0; i <= half_x_; ++i) {
      double sum[3];
      for (int k = 0; k < 3; ++k) {
        const double *f = corner_[k].data() + j * nx + i;
        sum[k] = (f[nx + 1] - f[nx]) - (f[1] - f[0]);
      }
      const auto at = static_cast<size_t>(j * stride_ + i);
      table_[0][at] = c * (1.0 - nu) * (sum[0] + sum[1]);
      if (!scene_.tangential) continue;
      table_[1][at] = c * (sum[0] + (1.0 - nu) * sum[1]);
      table_[2][at] = c * (sum[1] + (1.0 - nu) * sum[0]);
      table_[3][at] = c * nu * sum[2];
    }
}

void influence::make_line_kernels() {
  const double nu = scene_.elastic.poisson_ratio;
  const double c = 2.0 / (pi * scene_.elastic.shear_modulus);
  for (int i = 0; i <= half_x_; ++i) {
    const double lower = (i - 0.5) * grid_.dx, upper = (i + 0.5) * grid_.dx;
    const double value =
        line_primitive(upper, scene_.line_width) - line_primitive(lower, scene_.line_width);
    const auto at = static_cast<size_t>(i);
    table_[0][at] = c * (1.0 - nu) * value;
    if (!scene_.tangential) continue;
    table_[1][at] = c * (1.0 - nu) * value;
    table_[2][at] = c * value;
    table_[3][at] = 0.0;
  }
}

double influence::coefficient(kernel k, int i, int j) const {
  const auto at = static_cast<size_t>(std::abs(j) * stride_ + std::abs(i));
  const double value = table_[static_cast<int>(k)][at];
  if (k != kernel::xy) return value;
  return i == 0 || j == 0 ? 0.0 : ((i < 0) == (j < 0) ? value : -value);
}

void influence::transform_kernel(kernel k, double *spectrum) {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int oi = 2 * i <= nx ? i : i - nx, oj = 2 * j <= ny ? j : j - ny;
      // an odd kernel has no value at the wrap-around, where both signs meet
      const bool wrap = k == kernel::xy && (2 * i == nx || 2 * j == ny);
      padded_[static_cast<size_t>(j * nx + i)] = wrap ? 0.0 : coefficient(k, oi, oj);
    }
  plans_.forward(plan_, padded_.data(), transform_[0].data());
  const int half = (nx / 2 + 1) * ny;
  for (int i = 0; i < half; ++i) spectrum[i] = transform_[0][static_cast<size_t>(i)].real();
}

void influence::make_spectra() {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_), half = (nx / 2 + 1) * ny;
  constexpr convolution::kernel_name names[] = {convolution::zz, convolution::xx, convolution::yy,
                                                convolution::xy};
  for (int k = 0; k < (scene_.tangential ? 4 : 1); ++k) {
    transform_kernel(static_cast<kernel>(k), spectrum_[k].data());
    single_.set_spectrum(names[k], spectrum_[k].data());
  }
  // truncation can make small entries negative; a floor keeps the preconditioner positive
  const double top = *std::max_element(spectrum_[0].data(), spectrum_[0].data() + half);
  for (int i = 0; i < half; ++i) {
    const auto at = static_cast<size_t>(i);
    padded_[at] = 1.0 / std::max(spectrum_[0][at], 1e-6 * top);
  }
  single_.set_spectrum(convolution::zz_inverse, padded_.data());
  if (!scene_.tangential) return;
  for (int i = 0; i <= nx / 2; ++i)
    shift_[static_cast<size_t>(i)] = (1.0 - std::polar(1.0, 2.0 * pi * i / nx)) / grid_.dx;
}

void influence::pad(const double *values) {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_);
  const auto row = static_cast<size_t>(grid_.nx) * sizeof(double);
  const auto rest = static_cast<size_t>(nx - grid_.nx) * sizeof(double);
  for (int j = 0; j < grid_.ny; ++j) {
    std::memcpy(padded_.data() + j * nx, values + j * grid_.nx, row);
    std::memset(padded_.data() + j * nx + grid_.nx, 0, rest);
  }
  std::memset(padded_.data() + grid_.ny * nx, 0,
              static_cast<size_t>((ny - grid_.ny) * nx) * sizeof(double));
}

void influence::extract(double *values) const {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_);
  const double scale = 1.0 / (static_cast<double>(nx) * ny);
  for (int j = 0; j < grid_.ny; ++j)
    for (int i = 0; i < grid_.nx; ++i)
      values[j * grid_.nx + i] = scale * padded_[static_cast<size_t>(j * nx + i)];
}

void influence::normal_product(const double *pressure, double *displacement) {
  pad(pressure);
  plans_.forward(plan_, padded_.data(), transform_[0].data());
  const int half = (plans_.nx(plan_) / 2 + 1) * plans_.ny(plan_);
  for (int i = 0; i < half; ++i)
    transform_[0][static_cast<size_t>(i)] *= spectrum_[0][static_cast<size_t>(i)];
  plans_.backward(plan_, transform_[0].data(), padded_.data());
  extract(displacement);
}

void influence::normal_product_single(const double *pressure, double *displacement) {
  single_.product(convolution::zz, pressure, displacement);
}

void influence::normal_inverse(const double *displacement, double *pressure) {
  single_.product(convolution::zz_inverse, displacement, pressure);
}

void influence::tangential_product(const double *px, const double *py, double *ux, double *uy) {
  product(px, py, 0, ux, uy);
}

void influence::rolling_product(const double *px, const double *py, int direction, double *sx,
                                double *sy) {
  product(px, py, direction, sx, sy);
}

void influence::rolling_product_single(const double *px, const double *py, int direction,
                                       double *sx, double *sy) {
  single_.rolling_product(px, py, direction, grid_.dx, sx, sy);
}

void influence::product(const double *px, const double *py, int shift, double *ux, double *uy) {
  pad(px);
  plans_.forward(plan_, padded_.data(), transform_[0].data());
  pad(py);
  plans_.forward(plan_, padded_.data(), transform_[1].data());
  const int half_x = plans_.nx(plan_) / 2 + 1, ny = plans_.ny(plan_);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < half_x; ++i) {
      const auto at = static_cast<size_t>(j * half_x + i);
      const std::complex<double> tx = transform_[0][at], ty = transform_[1][at];
      // written out: the library's complex product checks for infinities
      double xr = spectrum_[1][at] * tx.real() + spectrum_[3][at] * ty.real();
      double xi = spectrum_[1][at] * tx.imag() + spectrum_[3][at] * ty.imag();
      double yr = spectrum_[3][at] * tx.real() + spectrum_[2][at] * ty.real();
      double yi = spectrum_[3][at] * tx.imag() + spectrum_[2][at] * ty.imag();
      if (shift != 0) {
        const double cr = shift_[static_cast<size_t>(i)].real();
        const double ci = shift * shift_[static_cast<size_t>(i)].imag();
        const double vr = cr * xr - ci * xi, wr = cr * yr - ci * yi;
        xi = cr * xi + ci * xr;
        yi = cr * yi + ci * yr;
        xr = vr;
        yr = wr;
      }
      transform_[0][at] = {xr, xi};
      transform_[1][at] = {yr, yi};
    }
  plans_.backward(plan_, transform_[0].data(), padded_.data());
  extract(ux);
  plans_.backward(plan_, transform_[1].data(), padded_.data());
  extract(uy);
}

size_t influence::bytes() const {
  size_t sum = single_.bytes() + shift_.bytes() + padded_.bytes() + plans_.bytes();
  for (const auto &b : table_) sum += b.bytes();
  for (const auto &b : corner_) sum += b.bytes();
  for (const auto &b : spectrum_) sum += b.bytes();
  for (const auto &b : transform_) sum += b.bytes();
  return sum;
}

}  // namespace railpatch
