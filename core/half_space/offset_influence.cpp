#include "half_space/offset_influence.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

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
    : plans_(plans), plane_(plans) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  for (int k = 0; k < 3; ++k)
    for (auto *b : {&re_[k], &im_[k]}) *b = aligned_buffer<double>(nx * ny);
  if (!moves) return;
  for (auto &b : corner_) b = aligned_buffer<double>((nx + 2) * (ny + 2));
}

size_t offset_influence::bytes() const {
  return plane_.bytes() + 6 * re_[0].bytes() + 3 * corner_[0].bytes();
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
        plane_.kernel()[j * nx + i] = values[k];
      }
    transform_kernel(k);
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
    std::fill_n(plane_.kernel(), nx * ny, 0.0);
    for (int j = 0; j + 1 < rows; ++j)
      for (int i = 0; i + 1 < columns; ++i) {
        double sum[3], values[3];
        for (int n = 0; n < 3; ++n) {
          const double *f = corner_[n].data() + j * columns + i;
          sum[n] = (f[columns + 1] - f[columns]) - (f[1] - f[0]);
        }
        a.from_corners(sum, values);
        const int oi = i - from_[0] + 1, oj = j - from_[1] + 1;
        plane_.kernel()[(oj < 0 ? oj + ny : oj) * nx + (oi < 0 ? oi + nx : oi)] = values[k];
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
    plane_.set_plan(plan);
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
    shift_field(g, offset, 0.0, from[c], plane_.kernel());
    for (int i = 0; i < g.count(); ++i) to[c][i] += flexibility * plane_.kernel()[i];
  }
}

offset_influence::lines offset_influence::transfer(const grid &from, const grid &to,
                                                   const double *px, const double *py) {
  const int sizes[2][2] = {{from.nx, from.ny}, {to.nx, to.ny}};
  return plane_.product(sizes[0], sizes[1], px, py,
                        [&](lines t, lines u, int stride) { multiply(t, u, stride); });
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
  plane_.set_plan(plan);
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
  double *scaled = plane_.kernel(), *none = scaled + from.count();
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
