#include "half_space/conformal_influence.hpp"

#include <algorithm>

namespace railpatch {

conformal_influence::conformal_influence(const fft_plans &plans, bool tangential,
                                         double layer_flexibility)
    : tangential_(tangential),
      layer_flexibility_(layer_flexibility),
      full_{{tangential ? plans.max_nx() : 2, tangential ? plans.max_ny() : 1, tangential},
            {tangential ? plans.max_nx() : 2, tangential ? plans.max_ny() : 1, tangential}},
      single_{{tangential ? plans.max_nx() : 2, tangential ? plans.max_ny() : 1, tangential},
              {tangential ? plans.max_nx() : 2, tangential ? plans.max_ny() : 1, tangential}},
      crossed_(tangential ? plans.max_nx() : 2, tangential ? plans.max_ny() : 1, tangential) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  // of the greatest grid that the transforms hold
  const size_t count = (nx / 2 + 1) * (ny / 2 + 1);
  for (int k = 0; k < (tangential ? 4 : 2); ++k) work_[k] = aligned_buffer<double>(count);
  if (!tangential) return;
  scaled_ = aligned_buffer<double>((nx / 2 + 1) * ny);
  mean_ = aligned_buffer<double>((nx / 2 + 1) * ny);
}

size_t conformal_influence::bytes() const {
  size_t sum = full_.plain.bytes() + full_.turned.bytes() + single_.plain.bytes() +
               single_.turned.bytes() + crossed_.bytes() + scaled_.bytes() + mean_.bytes();
  for (const auto &b : work_) sum += b.bytes();
  return sum;
}

void conformal_influence::set_size(int nx, int ny, int transform_nx, int transform_ny) {
  nx_ = nx;
  ny_ = ny;
  if (!tangential_) return;
  for (auto *c : {&full_.plain, &full_.turned, &crossed_})
    c->set_size(nx, ny, transform_nx, transform_ny);
  for (auto *c : {&single_.plain, &single_.turned}) c->set_size(nx, ny, transform_nx, transform_ny);
}

void conformal_influence::set_rows(const double *cosine, const double *sine) {
  row_[0] = cosine;
  row_[1] = sine;
}

const double *conformal_influence::scaled(const double *spectrum, size_t count, double factor) {
  for (size_t i = 0; i < count; ++i) scaled_[i] = factor * spectrum[i];
  return scaled_.data();
}

void conformal_influence::take_xx(const double *spectrum, size_t) {
  full_.plain.set_spectrum(convolution<double>::xx, spectrum);
  single_.plain.set_spectrum(convolution<float>::xx, spectrum);
}

void conformal_influence::take_yy(const double *spectrum, size_t count) {
  full_.turned.set_spectrum(convolution<double>::yy, spectrum);
  single_.turned.set_spectrum(convolution<float>::yy, spectrum);
  for (size_t i = 0; i < count; ++i) mean_[i] = 0.5 * (spectrum[i] - layer_flexibility_);
}

void conformal_influence::take_xy(const double *spectrum, size_t count) {
  const double *half = scaled(spectrum, count, 0.5);
  for (auto *c : {&full_.plain, &full_.turned, &crossed_})
    c->set_spectrum(convolution<double>::xy, half);
  for (auto *c : {&single_.plain, &single_.turned}) c->set_spectrum(convolution<float>::xy, half);
}

void conformal_influence::take_zz(const double *spectrum, size_t count) {
  if (!tangential_) return;
  for (size_t i = 0; i < count; ++i) mean_[i] += 0.5 * spectrum[i];
  crossed_.set_spectrum(convolution<double>::yy, mean_.data());
}

void conformal_influence::scale_rows(int k, const double *in, double *out) const {
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) out[j * nx_ + i] = row_[k][j] * in[j * nx_ + i];
}

void conformal_influence::add_rows(int k, double sign, const double *in, double *out,
                                   bool first) const {
  for (int j = 0; j < ny_; ++j) {
    const double factor = sign * row_[k][j];
    for (int i = 0; i < nx_; ++i) {
      const int at = j * nx_ + i;
      out[at] = (first ? 0.0 : out[at]) + factor * in[at];
    }
  }
}

// product(convolution, in, in, out, out)
template <class T, class Product>
void conformal_influence::tangential_parts(parts<T> &c, const double *px, const double *py,
                                           double *ux, double *uy, Product &&product) {
  product(c.plain, px, py, ux, uy);
  for (int k = 0; k < 2; ++k) {
    scale_rows(k, px, work_[0].data());
    scale_rows(k, py, work_[1].data());
    product(c.turned, work_[0].data(), work_[1].data(), work_[2].data(), work_[3].data());
    add_rows(k, 1.0, work_[2].data(), ux, false);
    add_rows(k, 1.0, work_[3].data(), uy, false);
  }
}

void conformal_influence::tangential(const double *px, const double *py, double *ux, double *uy) {
  tangential_parts(full_, px, py, ux, uy,
                   [](convolution<double> &c, const double *a, const double *b, double *u,
                      double *v) { c.tangential_product(a, b, u, v); });
}

void conformal_influence::tangential_single(const double *px, const double *py, double *ux,
                                            double *uy) {
  tangential_parts(single_, px, py, ux, uy,
                   [](convolution<float> &c, const double *a, const double *b, double *u,
                      double *v) { c.tangential_product(a, b, u, v); });
}

void conformal_influence::rolling(const double *px, const double *py, int direction, double dx,
                                  double *sx, double *sy) {
  tangential_parts(full_, px, py, sx, sy,
                   [=](convolution<double> &c, const double *a, const double *b, double *u,
                       double *v) { c.rolling_product(a, b, direction, dx, u, v); });
}

void conformal_influence::rolling_single(const double *px, const double *py, int direction,
                                         double dx, double *sx, double *sy) {
  tangential_parts(single_, px, py, sx, sy,
                   [=](convolution<float> &c, const double *a, const double *b, double *u,
                       double *v) { c.rolling_product(a, b, direction, dx, u, v); });
}

// -sin d = cos a_i sin a_j - sin a_i cos a_j
void conformal_influence::from_pressure(const double *p, int direction, double dx, double *ux,
                                        double *uy) {
  std::fill_n(work_[0].data(), nx_ * ny_, 0.0);
  for (int k = 0; k < 2; ++k) {
    scale_rows(k, p, work_[1].data());
    if (direction == 0)
      crossed_.tangential_product(work_[0].data(), work_[1].data(), work_[2].data(),
                                  work_[3].data());
    else
      crossed_.rolling_product(work_[0].data(), work_[1].data(), direction, dx, work_[2].data(),
                               work_[3].data());
    const double sign = k == 0 ? -1.0 : 1.0;
    add_rows(1 - k, sign, work_[2].data(), ux, k == 0);
    add_rows(1 - k, sign, work_[3].data(), uy, k == 0);
  }
}

void conformal_influence::from_traction(const double *px, const double *py, double *gap) {
  for (int k = 0; k < 2; ++k) {
    scale_rows(k, px, work_[0].data());
    scale_rows(k, py, work_[1].data());
    crossed_.tangential_product(work_[0].data(), work_[1].data(), work_[2].data(), work_[3].data());
    add_rows(1 - k, k == 0 ? 1.0 : -1.0, work_[3].data(), gap, k == 0);
  }
}

}  // namespace railpatch
