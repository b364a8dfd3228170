#include "half_space/coupling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

// y ln r + x atan(y/x); lengths over a typical one, which the alternating sum takes out again
double primitive(double x, double y, double length) {
  const double r = hypot(x, y);
  const double first = r > 0 ? y * log(r / length) : 0.0;
  return first + (x != 0 ? x * atan(y / x) : 0.0);
}

// int sign(x - s) ds over a strip of width dx around the origin
double strip_sign(double x, double dx) { return std::abs(x + 0.5 * dx) - std::abs(x - 0.5 * dx); }

}  // namespace

coupling_influence::coupling_influence(const elastic_constants &elastic, bool line,
                                       const fft_plans &plans)
    : factor_(-elastic.mismatch / (pi * elastic.shear_modulus)),
      line_(line),
      plans_(plans),
      plane_(plans) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  for (auto *s : {&here_, &there_}) {
    s->re = aligned_buffer<double>(nx * ny);
    s->im = aligned_buffer<double>(nx * ny);
  }
  corner_ = aligned_buffer<double>((nx + 1) * (ny / 2 + 2));
}

size_t coupling_influence::bytes() const {
  return 4 * here_.re.bytes() + corner_.bytes() + plane_.bytes();
}

bool coupling_influence::set_grid(const grid &g) {
  // the sizes of influence::set_grid
  const int plan = plans_.find(2 * g.nx + 1, g.ny > 1 ? 2 * g.ny - 1 : 1);
  if (plan < 0) return false;
  const bool same = plan == plan_ && g.dx == grid_.dx && g.dy == grid_.dy;
  grid_ = g;
  if (same) return true;
  plan_ = plan;
  plane_.set_plan(plan);
  here_.made = there_.made = false;
  return true;
}

void coupling_influence::prepare(spectrum &s, double offset) {
  if (s.made && s.offset == offset) return;
  const auto n = static_cast<size_t>(big_nx() * big_ny());
  std::fill_n(s.re.data(), n, 0.0);
  std::fill_n(s.im.data(), n, 0.0);
  for (int component = 0; component < (line_ ? 1 : 2); ++component) {
    fill_kernel(component, offset);
    // times i for the lateral displacement
    plane_.spectrum_of_kernel([&](size_t at, double re, double im) {
      s.re[at] += component == 0 ? re : -im;
      s.im[at] += component == 0 ? im : re;
    });
  }
  s.made = true;
  s.offset = offset;
}

// Primitives at the element corners: along x from one end of the transform to the other, lateral
// from half an element before the origin on.
void coupling_influence::fill_corners(int component, double offset) {
  const int nx = big_nx(), half_x = nx / 2, ny = big_ny() / 2 + 2;
  const double length = std::max(grid_.dx, grid_.dy);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const double x = (i - half_x - 0.5) * grid_.dx + offset, y = (j - 0.5) * grid_.dy;
      corner_[static_cast<size_t>(j * (nx + 1) + i)] =
          component == 0 ? primitive(x, y, length) : primitive(y, x, length);
    }
}

void coupling_influence::fill_kernel(int component, double offset) {
  const int nx = big_nx(), ny = big_ny(), half_x = nx / 2;
  if (!line_) fill_corners(component, offset);
  for (int j = 0; j <= ny / 2; ++j)
    for (int i = 0; i < nx; ++i) {
      // offsets from -half_x on; the first one, where both ends meet, is not asked for
      const int column = (i + half_x) % nx;
      double value = 0;
      if (i > 0 && line_) {
        value = factor_ * pi * strip_sign((i - half_x) * grid_.dx + offset, grid_.dx);
      } else if (i > 0 && (ny == 1 || 2 * j < ny)) {
        const double *f = corner_.data() + j * (nx + 1) + i;
        value = factor_ * ((f[nx + 2] - f[nx + 1]) - (f[1] - f[0]));
      }
      plane_.kernel()[j * nx + column] = value;
      // u_x is even, u_y odd in y
      if (j > 0) plane_.kernel()[(ny - j) * nx + column] = component == 0 ? value : -value;
    }
}

// Of a complex field on the grid, im may be null: times(k, re, im) gives the product's wave k.
template <class F>
coupling_influence::lines coupling_influence::product(const double *re, const double *im,
                                                      F &&times) {
  const int sizes[2] = {grid_.nx, grid_.ny};
  return plane_.product(sizes, sizes, re, im, [&](lines from, lines to, int stride) {
    for (int i = 0; i < big_nx(); ++i)
      for (int j = 0; j < big_ny(); ++j) {
        const int at = i * stride + j;
        const wave w = times(static_cast<size_t>(i * big_ny() + j), from.re[at], from.im[at]);
        to.re[at] = w.re;
        to.im[at] = w.im;
      }
  });
}

// u_x + i u_y from the real pressure.
void coupling_influence::from_pressure(double offset, const double *p, double *ux, double *uy) {
  spectrum &s = offset == 0 ? here_ : there_;
  prepare(s, offset);
  const lines u = product(p, nullptr, [&](size_t k, double re, double im) {
    return wave{s.re[k] * re - s.im[k] * im, s.re[k] * im + s.im[k] * re};
  });
  const int columns = fft::whole_packs(grid_.nx);
  for (int j = 0; j < grid_.ny; ++j) {
    std::copy_n(u.re + j * columns, grid_.nx, ux + j * grid_.nx);
    std::copy_n(u.im + j * columns, grid_.nx, uy + j * grid_.nx);
  }
}

// The transpose: u_n is the real part of the conjugate kernel with p_x + i p_y, mirrored.
void coupling_influence::from_traction(const double *px, const double *py, double *un) {
  prepare(here_, 0.0);
  const lines u = product(px, py, [&](size_t k, double re, double im) {
    return wave{here_.re[k] * re + here_.im[k] * im, here_.re[k] * im - here_.im[k] * re};
  });
  const int columns = fft::whole_packs(grid_.nx);
  for (int j = 0; j < grid_.ny; ++j) std::copy_n(u.re + j * columns, grid_.nx, un + j * grid_.nx);
}

}  // namespace railpatch
