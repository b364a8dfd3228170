#include "offset_influence.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

offset_influence::offset_influence(const fft_plans &plans)
    : plans_(plans), along_x_(plans.max_nx()), along_y_(plans.max_ny()) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  padded_ = aligned_buffer<double>(nx * ny);
  transform_ = aligned_buffer<std::complex<double>>((nx / 2 + 1) * ny);
  for (int k = 0; k < 3; ++k)
    for (auto *b : {&re_[k], &im_[k]}) *b = aligned_buffer<double>(nx * ny);
  const auto columns = static_cast<size_t>(fft::whole_packs(plans.max_nx() / 2 + 1));
  const auto waves = static_cast<size_t>(fft::whole_packs(plans.max_ny()));
  for (auto &b : lateral_) b = aligned_buffer<double>(columns * ny);
  for (auto &b : along_) b = aligned_buffer<double>(waves * nx);
}

size_t offset_influence::bytes() const {
  return along_x_.bytes() + along_y_.bytes() + padded_.bytes() + 6 * re_[0].bytes() +
         transform_.bytes() + 4 * (lateral_[0].bytes() + along_[0].bytes());
}

void offset_influence::make_spectra(const influence &a, const grid &g) {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_), half = nx / 2 + 1;
  const double scale = 1.0 / (static_cast<double>(nx) * ny);
  // the odd parts of xy have no value at the wrap-around, which no element reaches
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int oi = 2 * i <= nx ? i : i - nx, oj = 2 * j <= ny ? j : j - ny;
        double values[3];
        a.bodies_at(oi * g.dx + offset_, oj * g.dy, values);
        padded_[static_cast<size_t>(j * nx + i)] = values[k];
      }
    plans_.forward(plan_, padded_.data(), transform_.data());
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j) {
        const bool mirrored = i >= half;
        const int from_i = mirrored ? nx - i : i, from_j = mirrored ? (ny - j) % ny : j;
        const std::complex<double> z = transform_[static_cast<size_t>(from_j * half + from_i)];
        const auto at = static_cast<size_t>(i * ny + j);
        re_[k][at] = scale * z.real();
        im_[k][at] = scale * (mirrored ? -z.imag() : z.imag());
      }
  }
}

// Both tractions travel as one complex field: their transforms are told apart by symmetry.
void offset_influence::multiply(lines from, lines to, int stride) const {
  using complex = std::complex<double>;
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) {
      const int here = i * stride + j, there = (nx - i) % nx * stride + (ny - j) % ny;
      const complex z(from.re[here], from.im[here]), m(from.re[there], -from.im[there]);
      const complex px = 0.5 * (z + m), py = complex(0, -0.5) * (z - m);
      const auto at = static_cast<size_t>(i * ny + j);
      const complex xx(re_[0][at], im_[0][at]), yy(re_[1][at], im_[1][at]),
          xy(re_[2][at], im_[2][at]);
      const complex u = (xx * px + xy * py) + complex(0, 1) * (xy * px + yy * py);
      to.re[here] = u.real();
      to.im[here] = u.imag();
    }
}

void offset_influence::product(const influence &a, const grid &g, double offset, const double *px,
                               const double *py, double *ux, double *uy) {
  const int plan = plans_.find(2 * g.nx + 1, g.ny > 1 ? 2 * g.ny - 1 : 1);
  if (plan != plan_ || offset != offset_ || g.dx != dx_ || g.dy != dy_) {
    plan_ = plan;
    offset_ = offset, dx_ = g.dx, dy_ = g.dy;
    along_x_.set_length(plans_.nx(plan));
    along_y_.set_length(plans_.ny(plan));
    make_spectra(a, g);
  }
  const int columns = fft::whole_packs(g.nx), waves = fft::whole_packs(plans_.ny(plan_));
  const lines lateral[2] = {{lateral_[0].data(), lateral_[1].data()},
                            {lateral_[2].data(), lateral_[3].data()}};
  const lines along[2] = {{along_[0].data(), along_[1].data()},
                          {along_[2].data(), along_[3].data()}};
  const auto other = [](const lines pair[2], lines l) {
    return l.re == pair[0].re ? pair[1] : pair[0];
  };
  for (int j = 0; j < g.ny; ++j) {
    double *re = lateral[0].re + j * columns, *im = lateral[0].im + j * columns;
    std::copy_n(px + j * g.nx, g.nx, re);
    std::copy_n(py + j * g.nx, g.nx, im);
    std::fill(re + g.nx, re + columns, 0.0);
    std::fill(im + g.nx, im + columns, 0.0);
  }
  const int ny = plans_.ny(plan_);
  const lines z = along_y_.forward(columns, g.ny, lateral[0], lateral[1]);
  for (int i = 0; i < g.nx; ++i)
    for (int j = 0; j < waves; ++j) {
      along[0].re[i * waves + j] = j < ny ? z.re[j * columns + i] : 0.0;
      along[0].im[i * waves + j] = j < ny ? z.im[j * columns + i] : 0.0;
    }
  const lines t = along_x_.forward(waves, g.nx, along[0], along[1]);
  const lines product = other(along, t);
  for (int i = 0; i < plans_.nx(plan_); ++i) {
    std::fill(product.re + i * waves + ny, product.re + (i + 1) * waves, 0.0);
    std::fill(product.im + i * waves + ny, product.im + (i + 1) * waves, 0.0);
  }
  multiply(t, product, waves);
  const lines back = along_x_.backward(waves, g.nx, product, t);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < columns; ++i) {
      lateral[0].re[j * columns + i] = i < g.nx ? back.re[i * waves + j] : 0.0;
      lateral[0].im[j * columns + i] = i < g.nx ? back.im[i * waves + j] : 0.0;
    }
  const lines u = along_y_.backward(columns, g.ny, lateral[0], lateral[1]);
  for (int j = 0; j < g.ny; ++j) {
    std::copy_n(u.re + j * columns, g.nx, ux + j * g.nx);
    std::copy_n(u.im + j * columns, g.nx, uy + j * g.nx);
  }
  if (!(a.bodies().layer_flexibility > 0)) return;
  const double flexibility = a.bodies().layer_flexibility;
  const double *from[2] = {px, py};
  double *to[2] = {ux, uy};
  for (int c = 0; c < 2; ++c) {
    shift_field(g, offset, 0.0, from[c], padded_.data());
    for (int i = 0; i < g.count(); ++i) to[c][i] += flexibility * padded_[static_cast<size_t>(i)];
  }
}

void shift_field(const grid &g, double offset, double outside, const double *from, double *to) {
  const double elements = offset / g.dx, whole = std::floor(elements), share = elements - whole;
  // far beyond the grid all is outside
  const int step = static_cast<int>(std::clamp(whole, -1.0 - g.nx, 1.0 + g.nx));
  for (int j = 0; j < g.ny; ++j) {
    const double *row = from + j * g.nx;
    const auto value = [&](int i) { return i >= 0 && i < g.nx ? row[i] : outside; };
    for (int i = 0; i < g.nx; ++i)
      to[j * g.nx + i] = (1.0 - share) * value(i + step) + share * value(i + step + 1);
  }
}

}  // namespace railpatch
