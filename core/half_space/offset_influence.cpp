#include "half_space/offset_influence.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

// A field at element (x, y) of its grid, straight between elements in both directions, 0 beyond.
double between(const grid &g, const double *field, double x, double y) {
  const double i = std::floor(x), j = std::floor(y);
  if (!(i >= -1 && j >= -1 && i < g.nx && j < g.ny)) return 0.0;
  const auto at = [&](int column, int row) {
    const bool inside = column >= 0 && row >= 0 && column < g.nx && row < g.ny;
    return inside ? field[row * g.nx + column] : 0.0;
  };
  const int k = static_cast<int>(i), l = static_cast<int>(j);
  const double u = x - i, v = y - j;
  return (1 - v) * ((1 - u) * at(k, l) + u * at(k + 1, l)) +
         v * ((1 - u) * at(k, l + 1) + u * at(k + 1, l + 1));
}

}  // namespace

offset_influence::offset_influence(const fft_plans &plans, bool moves)
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
  if (!moves) return;
  for (auto &b : corner_) b = aligned_buffer<double>((nx + 2) * (ny + 2));
}

size_t offset_influence::bytes() const {
  return along_x_.bytes() + along_y_.bytes() + padded_.bytes() + 6 * re_[0].bytes() +
         transform_.bytes() + 4 * (lateral_[0].bytes() + along_[0].bytes()) +
         3 * corner_[0].bytes();
}

void offset_influence::make_spectra(const influence &a, const grid &g) {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_);
  // the odd parts of xy have no value at the wrap-around, which no element reaches
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int oi = 2 * i <= nx ? i : i - nx, oj = 2 * j <= ny ? j : j - ny;
        double values[3];
        a.bodies_at(oi * g.dx + offset_, oj * g.dy, values);
        padded_[static_cast<size_t>(j * nx + i)] = values[k];
      }
    transform_kernel(k);
  }
}

// The spectrum of the kernel in padded_, on all waves.
void offset_influence::transform_kernel(int k) {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_), half = nx / 2 + 1;
  const double scale = 1.0 / (static_cast<double>(nx) * ny);
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

// Coefficients between all elements of both grids; no others are used.
void offset_influence::make_moved_spectra(const influence &a) {
  const int nx = plans_.nx(plan_), ny = plans_.ny(plan_);
  const int columns = from_[0] + to_[0], rows = from_[1] + to_[1];  // corners
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      double values[3];
      influence::corner_at(offset_ + (i - from_[0] + 0.5) * dx_,
                           lateral_offset_ + (j - from_[1] + 0.5) * dy_, values);
      for (int k = 0; k < 3; ++k) corner_[k][static_cast<size_t>(j * columns + i)] = values[k];
    }
  for (int k = 0; k < 3; ++k) {
    std::fill_n(padded_.data(), nx * ny, 0.0);
    for (int j = 0; j + 1 < rows; ++j)
      for (int i = 0; i + 1 < columns; ++i) {
        double sum[3], values[3];
        for (int n = 0; n < 3; ++n) {
          const double *f = corner_[n].data() + j * columns + i;
          sum[n] = (f[columns + 1] - f[columns]) - (f[1] - f[0]);
        }
        a.from_corners(sum, values);
        const int oi = i - from_[0] + 1, oj = j - from_[1] + 1;
        padded_[static_cast<size_t>((oj < 0 ? oj + ny : oj) * nx + (oi < 0 ? oi + nx : oi))] =
            values[k];
      }
    transform_kernel(k);
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
  const lines u = transfer(g, g, px, py);
  const int columns = fft::whole_packs(g.nx);
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

offset_influence::lines offset_influence::transfer(const grid &from, const grid &to,
                                                   const double *px, const double *py) {
  const int waves = fft::whole_packs(plans_.ny(plan_)), back_columns = fft::whole_packs(to.nx);
  const int columns = fft::whole_packs(from.nx);
  const lines lateral[2] = {{lateral_[0].data(), lateral_[1].data()},
                            {lateral_[2].data(), lateral_[3].data()}};
  const lines along[2] = {{along_[0].data(), along_[1].data()},
                          {along_[2].data(), along_[3].data()}};
  const auto other = [](const lines pair[2], lines l) {
    return l.re == pair[0].re ? pair[1] : pair[0];
  };
  for (int j = 0; j < from.ny; ++j) {
    double *re = lateral[0].re + j * columns, *im = lateral[0].im + j * columns;
    std::copy_n(px + j * from.nx, from.nx, re);
    std::copy_n(py + j * from.nx, from.nx, im);
    std::fill(re + from.nx, re + columns, 0.0);
    std::fill(im + from.nx, im + columns, 0.0);
  }
  const int ny = plans_.ny(plan_);
  const lines z = along_y_.forward(columns, from.ny, lateral[0], lateral[1]);
  for (int i = 0; i < from.nx; ++i)
    for (int j = 0; j < waves; ++j) {
      along[0].re[i * waves + j] = j < ny ? z.re[j * columns + i] : 0.0;
      along[0].im[i * waves + j] = j < ny ? z.im[j * columns + i] : 0.0;
    }
  const lines t = along_x_.forward(waves, from.nx, along[0], along[1]);
  const lines product = other(along, t);
  for (int i = 0; i < plans_.nx(plan_); ++i) {
    std::fill(product.re + i * waves + ny, product.re + (i + 1) * waves, 0.0);
    std::fill(product.im + i * waves + ny, product.im + (i + 1) * waves, 0.0);
  }
  multiply(t, product, waves);
  const lines back = along_x_.backward(waves, to.nx, product, t);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < back_columns; ++i) {
      lateral[0].re[j * back_columns + i] = i < to.nx ? back.re[i * waves + j] : 0.0;
      lateral[0].im[j * back_columns + i] = i < to.nx ? back.im[i * waves + j] : 0.0;
    }
  return along_y_.backward(back_columns, to.ny, lateral[0], lateral[1]);
}

// Kernels between two grids, where they are not those of the last call.
void offset_influence::place(const influence &a, const grid &from, const grid &to,
                             const double offset[2]) {
  const int nx = std::max(from.nx, to.nx), ny = std::max(from.ny, to.ny);
  const int plan = plans_.find(2 * nx + 1, ny > 1 ? 2 * ny - 1 : 1);
  const bool same = plan == plan_ && offset[0] == offset_ && offset[1] == lateral_offset_ &&
                    to.dx == dx_ && to.dy == dy_ && from.nx == from_[0] && from.ny == from_[1] &&
                    to.nx == to_[0] && to.ny == to_[1];
  if (same) return;
  plan_ = plan;
  offset_ = offset[0], lateral_offset_ = offset[1], dx_ = to.dx, dy_ = to.dy;
  from_[0] = from.nx, from_[1] = from.ny, to_[0] = to.nx, to_[1] = to.ny;
  along_x_.set_length(plans_.nx(plan));
  along_y_.set_length(plans_.ny(plan));
  make_moved_spectra(a);
}

// The layer's part, of elements at their own.
void offset_influence::add_layer(const influence &a, const grid &from, const grid &to,
                                 const double offset[2], double share, const double *px,
                                 const double *py, double *ux, double *uy) const {
  const double flexibility = share * a.bodies().layer_flexibility;
  if (!(flexibility > 0)) return;
  for (int j = 0; j < to.ny; ++j)
    for (int i = 0; i < to.nx; ++i) {
      const double x = (offset[0] / to.dx) + i, y = (offset[1] / to.dy) + j;
      ux[j * to.nx + i] += flexibility * between(from, px, x, y);
      uy[j * to.nx + i] += flexibility * between(from, py, x, y);
    }
}

void offset_influence::add_moved(const influence &a, const grid &from, const grid &to,
                                 const double offset[2], double share, const double *px,
                                 const double *py, double *ux, double *uy) {
  place(a, from, to, offset);
  const lines u = transfer(from, to, px, py);
  const int columns = fft::whole_packs(to.nx);
  for (int j = 0; j < to.ny; ++j)
    for (int i = 0; i < to.nx; ++i) {
      ux[j * to.nx + i] += share * u.re[j * columns + i];
      uy[j * to.nx + i] += share * u.im[j * columns + i];
    }
  add_layer(a, from, to, offset, share, px, py, ux, uy);
}

// By A_xx, A_xs, A_ss of one traction at a time: A_nn = (1 - nu)/(2 - nu) (A_xx + A_ss). The signs
// are those of conformal_influence.hpp.
void offset_influence::add_curved(const influence &a, const grid &from, const grid &to,
                                  const double offset[2], double share, const curved_past &past,
                                  const curved_sums &sums) {
  place(a, from, to, offset);
  const double nu = a.bodies().elastic.poisson_ratio, normal = (1.0 - nu) / (2.0 - nu);
  const int columns = fft::whole_packs(to.nx);
  double *scaled = padded_.data(), *none = scaled + from.count();
  std::fill_n(none, from.count(), 0.0);
  // adds factor (row) times a component of what a field causes, itself scaled by rows (null: 1)
  const auto each = [&](const double *field, const double *by_source, bool along, auto &&add) {
    for (int j = 0; j < from.ny; ++j)
      for (int i = 0; i < from.nx; ++i)
        scaled[j * from.nx + i] = (by_source ? by_source[j] : 1.0) * field[j * from.nx + i];
    const lines u = transfer(from, to, along ? scaled : none, along ? none : scaled);
    for (int j = 0; j < to.ny; ++j)
      for (int i = 0; i < to.nx; ++i)
        add(j, j * to.nx + i, share * u.re[j * columns + i], share * u.im[j * columns + i]);
  };
  double *const *t = sums.from_traction, *const *p = sums.from_pressure;
  // what no inclination changes
  each(past.px, nullptr, true, [&](int, int at, double x, double s) {
    t[0][at] += x;
    t[1][at] += 0.5 * s;
  });
  each(past.py, nullptr, false, [&](int, int at, double x, double) { t[0][at] += 0.5 * x; });
  for (int k = 0; k < 2; ++k) {
    const double *source = k == 0 ? past.cosine[0] : past.sine[0];
    const double *same = k == 0 ? past.cosine[1] : past.sine[1];
    const double *other = k == 0 ? past.sine[1] : past.cosine[1];
    // half of sin d, of the gap; of what pressure moves the other sign
    const double half = k == 0 ? 0.5 : -0.5;
    each(past.px, source, true, [&](int j, int at, double, double s) {
      t[1][at] += 0.5 * same[j] * s;
      sums.gap[at] += half * other[j] * s;
    });
    each(past.py, source, false, [&](int j, int at, double x, double s) {
      t[0][at] += 0.5 * same[j] * x;
      t[1][at] += same[j] * s;
      sums.gap[at] += half * other[j] * (1.0 + normal) * s;
    });
    each(past.py, source, true,
         [&](int j, int at, double x, double) { sums.gap[at] += half * other[j] * normal * x; });
    each(past.pressure, source, false, [&](int j, int at, double x, double s) {
      p[0][at] -= half * other[j] * x;
      p[1][at] -= half * other[j] * (1.0 + normal) * s;
    });
    each(past.pressure, source, true,
         [&](int j, int at, double x, double) { p[1][at] -= half * other[j] * normal * x; });
  }
  add_layer(a, from, to, offset, share, past.px, past.py, t[0], t[1]);
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
