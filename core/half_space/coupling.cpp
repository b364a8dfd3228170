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
      along_x_(plans.max_nx()),
      along_y_(plans.max_ny()) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  for (auto *s : {&here_, &there_}) {
    s->re = aligned_buffer<double>(nx * ny);
    s->im = aligned_buffer<double>(nx * ny);
  }
  corner_ = aligned_buffer<double>((nx + 1) * (ny / 2 + 2));
  padded_ = aligned_buffer<double>(nx * ny);
  transform_ = aligned_buffer<std::complex<double>>((nx / 2 + 1) * ny);
  const auto columns = static_cast<size_t>(fft::whole_packs(plans.max_nx() / 2 + 1));
  const auto waves = static_cast<size_t>(fft::whole_packs(plans.max_ny()));
  for (auto &b : lateral_) b = aligned_buffer<double>(columns * ny);
  for (auto &b : along_) b = aligned_buffer<double>(waves * nx);
}

size_t coupling_influence::bytes() const {
  return 4 * here_.re.bytes() + corner_.bytes() + padded_.bytes() + transform_.bytes() +
         4 * (lateral_[0].bytes() + along_[0].bytes()) + along_x_.bytes() + along_y_.bytes();
}

bool coupling_influence::set_grid(const grid &g) {
  // the sizes of influence::set_grid
  const int plan = plans_.find(2 * g.nx + 1, g.ny > 1 ? 2 * g.ny - 1 : 1);
  if (plan < 0) return false;
  const bool same = plan == plan_ && g.dx == grid_.dx && g.dy == grid_.dy;
  grid_ = g;
  if (same) return true;
  plan_ = plan;
  along_x_.set_length(big_nx());
  along_y_.set_length(big_ny());
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
    plans_.forward(plan_, padded_.data(), transform_.data());
    take_over(component, s);
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
      padded_[static_cast<size_t>(j * nx + column)] = value;
      // u_x is even, u_y odd in y
      if (j > 0)
        padded_[static_cast<size_t>((ny - j) * nx + column)] = component == 0 ? value : -value;
    }
}

// Adds a kernel's transform, times i for the lateral displacement, with the factor of the way back.
void coupling_influence::take_over(int component, spectrum &s) const {
  const int nx = big_nx(), ny = big_ny(), width = nx / 2 + 1;
  const double scale = 1.0 / (static_cast<double>(nx) * ny);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) {
      const bool upper = i >= width;
      const int row = upper ? (ny - j) % ny : j;
      const std::complex<double> z =
          transform_[static_cast<size_t>(row * width + (upper ? nx - i : i))];
      const double re = scale * z.real(), im = scale * (upper ? -z.imag() : z.imag());
      const auto at = static_cast<size_t>(i * ny + j);
      s.re[at] += component == 0 ? re : -im;
      s.im[at] += component == 0 ? im : re;
    }
}

// The transform of a complex field, [big_nx][waves]; im may be null.
coupling_influence::lines coupling_influence::transformed(const double *re, const double *im) {
  const int columns = fft::whole_packs(grid_.nx), waves = fft::whole_packs(big_ny());
  for (int j = 0; j < grid_.ny; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = static_cast<size_t>(j * columns + i);
      const bool inside = i < grid_.nx;
      lateral_[0][at] = inside ? re[j * grid_.nx + i] : 0.0;
      lateral_[1][at] = inside && im ? im[j * grid_.nx + i] : 0.0;
    }
  const lines z = along_y_.forward(columns, grid_.ny, {lateral_[0].data(), lateral_[1].data()},
                                   {lateral_[2].data(), lateral_[3].data()});
  for (int i = 0; i < grid_.nx; ++i)
    for (int j = 0; j < waves; ++j) {
      const auto at = static_cast<size_t>(i * waves + j);
      along_[0][at] = j < big_ny() ? z.re[j * columns + i] : 0.0;
      along_[1][at] = j < big_ny() ? z.im[j * columns + i] : 0.0;
    }
  return along_x_.forward(waves, grid_.nx, {along_[0].data(), along_[1].data()},
                          {along_[2].data(), along_[3].data()});
}

// The way back, [ny][columns].
coupling_influence::lines coupling_influence::back(lines z) {
  const int columns = fft::whole_packs(grid_.nx), waves = fft::whole_packs(big_ny());
  const lines along[2] = {{along_[0].data(), along_[1].data()},
                          {along_[2].data(), along_[3].data()}};
  const lines x = along_x_.backward(waves, grid_.nx, z, z.re == along[0].re ? along[1] : along[0]);
  for (int j = 0; j < big_ny(); ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = static_cast<size_t>(j * columns + i);
      lateral_[0][at] = i < grid_.nx ? x.re[i * waves + j] : 0.0;
      lateral_[1][at] = i < grid_.nx ? x.im[i * waves + j] : 0.0;
    }
  return along_y_.backward(columns, grid_.ny, {lateral_[0].data(), lateral_[1].data()},
                           {lateral_[2].data(), lateral_[3].data()});
}

// u_x + i u_y from the real pressure.
void coupling_influence::from_pressure(double offset, const double *p, double *ux, double *uy) {
  spectrum &s = offset == 0 ? here_ : there_;
  prepare(s, offset);
  const lines z = transformed(p, nullptr);
  const int waves = fft::whole_packs(big_ny()), columns = fft::whole_packs(grid_.nx);
  for (int i = 0; i < big_nx(); ++i)
    for (int j = 0; j < big_ny(); ++j) {
      const int at = i * waves + j;
      const auto k = static_cast<size_t>(i * big_ny() + j);
      const double re = z.re[at], im = z.im[at];
      z.re[at] = s.re[k] * re - s.im[k] * im;
      z.im[at] = s.re[k] * im + s.im[k] * re;
    }
  const lines u = back(z);
  for (int j = 0; j < grid_.ny; ++j) {
    std::copy_n(u.re + j * columns, grid_.nx, ux + j * grid_.nx);
    std::copy_n(u.im + j * columns, grid_.nx, uy + j * grid_.nx);
  }
}

// The transpose: u_n is the real part of the conjugate kernel with p_x + i p_y, mirrored.
void coupling_influence::from_traction(const double *px, const double *py, double *un) {
  prepare(here_, 0.0);
  const lines z = transformed(px, py);
  const int waves = fft::whole_packs(big_ny()), columns = fft::whole_packs(grid_.nx);
  for (int i = 0; i < big_nx(); ++i)
    for (int j = 0; j < big_ny(); ++j) {
      const int at = i * waves + j;
      const auto k = static_cast<size_t>(i * big_ny() + j);
      const double re = z.re[at], im = z.im[at];
      z.re[at] = here_.re[k] * re + here_.im[k] * im;
      z.im[at] = here_.re[k] * im - here_.im[k] * re;
    }
  const lines u = back(z);
  for (int j = 0; j < grid_.ny; ++j) std::copy_n(u.re + j * columns, grid_.nx, un + j * grid_.nx);
}

}  // namespace railpatch
