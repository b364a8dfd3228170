#include "half_space/viscous_influence.hpp"

#include <cmath>
#include <numbers>

#include "half_space/coupling.hpp"
#include "numeric/elementary.hpp"
#include "numeric/gauss_legendre.hpp"
#include "numeric/sums.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

// of L, where exp(-s/L) is nothing
constexpr double end_of_memory = 40.0;
// halvings of panels towards an edge
constexpr int halvings = 20;
// of the elastic part, that bodies yield along a grid which they cross as good as elastic ones
constexpr double little = 2.0;

}  // namespace

elastic_constants viscous_bodies::relaxed() const {
  const double g[2] = {shear_modulus[0] / (1.0 + ratio[0]), shear_modulus[1] / (1.0 + ratio[1])};
  return combine(g, poisson_ratio);
}

bool viscous_bodies::couples() const {
  // (1 - 2 nu) f/G of the bodies, which cancel where their times are the same
  double part[2];
  for (int k = 0; k < 2; ++k)
    part[k] = (1.0 - 2.0 * poisson_ratio[k]) * ratio[k] / shear_modulus[k];
  const double size = 1e-12 * (1.0 / shear_modulus[0] + 1.0 / shear_modulus[1]);
  if (relaxation_time[0] == relaxation_time[1]) return std::abs(part[0] - part[1]) > size;
  return part[0] > size || part[1] > size;
}

viscous_influence::viscous_influence(const viscous_bodies &of, influence &elastic,
                                     const fft_plans &plans)
    : bodies_(of), elastic_(elastic), plans_(plans), plane_(plans) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  for (int k = 0; k < kernels(); ++k) {
    for (auto *b : {&table_[k], &part_[k]}) *b = aligned_buffer<double>((nx + 2) * (ny / 2 + 1));
    for (auto *b : {&re_[k], &im_[k]}) *b = aligned_buffer<double>(nx * ny);
  }
  for (auto &b : corner_) b = aligned_buffer<double>((nx + 3) * (ny / 2 + 2));
  for (auto &b : shift_) b = aligned_buffer<double>(nx);
  for (auto &b : taken_) b = aligned_buffer<double>((nx / 2 + 1) * (ny / 2 + 1));
}

size_t viscous_influence::bytes() const {
  size_t sum = plane_.bytes();
  for (int k = 0; k < 4; ++k) sum += 2 * (table_[k].bytes() + re_[k].bytes());
  for (const auto &b : corner_) sum += b.bytes();
  return sum + 2 * (shift_[0].bytes() + taken_[0].bytes());
}

void viscous_influence::set(const grid &g, int direction, double speed) {
  const int plan = plans_.find(2 * g.nx + 1, g.ny > 1 ? 2 * g.ny - 1 : 1);
  const bool same = plan == plan_ && g.dx == grid_.dx && g.dy == grid_.dy &&
                    direction == direction_ && speed == speed_;
  grid_ = g;
  if (same) return;
  plan_ = plan;
  direction_ = direction;
  speed_ = speed;
  plane_.set_plan(plan);
  make_tables();
  make_spectra();
  set_inverse();
  for (int i = 0; i < plane_.nx(); ++i) {
    const double angle = 2.0 * pi * i / plane_.nx();
    shift_[0][static_cast<size_t>(i)] = (1.0 - cos(angle)) / g.dx;
    shift_[1][static_cast<size_t>(i)] = -direction * sin(angle) / g.dx;
  }
}

void viscous_influence::make_tables() {
  for (int k = 0; k < kernels(); ++k)
    for (int j = 0; j < lines_across(); ++j)
      for (int i = 0; i < columns(); ++i)
        table_[k][static_cast<size_t>(j * columns() + i)] =
            elastic_.coefficient(static_cast<kernel>(k), i - half(), j);
  springs parts[2];
  for (int k = 0; k < 2; ++k) {
    parts[k].flexibility = bodies_.ratio[k] / (2.0 * pi * bodies_.shear_modulus[k]);
    parts[k].by_poisson = parts[k].flexibility * bodies_.poisson_ratio[k];
    parts[k].length = speed_ * bodies_.relaxation_time[k];
  }
  if (parts[0].length == parts[1].length) {
    parts[0].flexibility += parts[1].flexibility;
    parts[0].by_poisson += parts[1].by_poisson;
    parts[1].flexibility = 0;
  }
  for (const springs &b : parts)
    if (b.flexibility > 0) add_springs(b);
}

// Adds K of the springs to the tables.
void viscous_influence::add_springs(const springs &b) {
  const int count = columns() * lines_across(), n = half();
  for (int k = 0; k < kernels(); ++k) std::fill_n(part_[k].data(), count, 0.0);
  const double dx = grid_.dx;
  if (b.length == 0) {
    add_node(b, {-n, 2 * n + 1}, 0.0, 1.0);
  } else {
    // what is ahead of the last place, then from each place to the next
    add_panels(b, {n, 1}, 0.0, HUGE_VAL, (n - 0.5) * dx);
    if (n > 1) {
      add_panels(b, {-n, n - 1}, 0.0, dx, 0.5 * dx);
      add_panels(b, {1, n - 1}, 0.0, dx, 0.5 * dx);
    }
    add_towards(b, {-1, 2}, 0.0, 0.5 * dx);
    add_towards(b, {-1, 2}, dx, 0.5 * dx);
  }
  const double decay = b.length > 0 ? exp(-dx / b.length) : 0.0;
  for (int k = 0; k < kernels(); ++k)
    for (int j = 0; j < lines_across(); ++j) {
      double *row = part_[k].data() + j * columns(), *to = table_[k].data() + j * columns();
      for (int i = columns() - 2; i >= 0; --i) row[i] += decay * row[i + 1];
      for (int i = 0; i < columns(); ++i) to[i] += row[i];
    }
}

// The integral over s from begin to end; apart: m, from begin to the nearest edge of the load,
// behind it.
void viscous_influence::add_panels(const springs &b, places at, double begin, double end,
                                   double apart) {
  for (double s = begin; s < end && s < end_of_memory * b.length;) {
    double next = s + std::min(std::max(2.0 * b.length, s), 2.0 * (s - begin + apart));
    // a panel's shorter rest joins it
    if (next + 0.5 * (next - s) > end) next = end;
    gauss_legendre::each(s, next, [&](double place, double weight) {
      add_node(b, at, place, weight * exp(-place / b.length) / b.length);
    });
    s = next;
  }
}

// The same up to the edge of a load at end, or down to it, on panels that halve towards it; the
// last with an integrand that the edge's logarithm does not disturb.
void viscous_influence::add_towards(const springs &b, places at, double begin, double edge) {
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (begin + edge);
    add_panels(b, at, std::min(begin, middle), std::max(begin, middle), std::abs(edge - begin));
    begin = middle;
  }
  const double length = begin - edge;
  if (edge > end_of_memory * b.length) return;
  gauss_legendre::each(0.0, 1.0, [&](double t, double weight) {
    const double s = edge + length * t * t * t;
    add_node(b, at, s, 3.0 * t * t * std::abs(length) * weight * exp(-s / b.length) / b.length);
  });
}

// Primitives at the elements' corners, s further ahead than the places: those of influence.hpp.
void viscous_influence::make_corners(places at, double s) {
  const int nx = at.count + 1, ny = lines_across() + 1, count = nx * ny;
  const auto each = [&](auto &&take) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        take((at.first + i - 0.5) * grid_.dx + s, (j - 0.5) * grid_.dy,
             static_cast<size_t>(j * nx + i));
  };
  each([&](double x, double y, size_t k) {
    corner_[0][k] = x / std::abs(y);
    corner_[1][k] = y / std::abs(x);
  });
  for (int k = 0; k < 2; ++k) asinh_of(corner_[k].data(), count);
  each([&](double x, double y, size_t k) {
    corner_[0][k] *= y;
    corner_[1][k] *= x;
    corner_[2][k] = -hypot(x, y);
  });
}

// Adds weight times the springs' coefficients at the places, seen from s further ahead.
void viscous_influence::add_node(const springs &b, places at, double s, double weight) {
  const auto first = static_cast<size_t>(at.first + half());
  if (const double width = elastic_.bodies().line_width; width > 0) {
    // both primitives of the plane together, for which 1/G counts twice: see influence.hpp
    const auto primitive = [&](double x) { return x * (1.0 + log(width / std::abs(x))); };
    for (int i = 0; i < at.count; ++i) {
      const double lower = (at.first + i - 0.5) * grid_.dx + s;
      const double sum[3] = {0, 2.0 * (primitive(lower + grid_.dx) - primitive(lower)), 0};
      add_to(b, weight, sum, first + static_cast<size_t>(i));
    }
    return;
  }
  make_corners(at, s);
  const int nx = at.count + 1;
  for (int j = 0; j < lines_across(); ++j)
    for (int i = 0; i < at.count; ++i) {
      double sum[3];
      for (int k = 0; k < 3; ++k) {
        const double *f = corner_[k].data() + j * nx + i;
        sum[k] = (f[nx + 1] - f[nx]) - (f[1] - f[0]);
      }
      add_to(b, weight, sum, first + static_cast<size_t>(j * columns() + i));
    }
}

// The coefficients of a place from its alternating sums.
void viscous_influence::add_to(const springs &b, double weight, const double sum[3], size_t at) {
  const double c = weight * b.flexibility, nu = weight * b.by_poisson;
  part_[0][at] += (c - nu) * (sum[0] + sum[1]);
  if (kernels() == 1) return;
  part_[1][at] += c * sum[0] + (c - nu) * sum[1];
  part_[2][at] += c * sum[1] + (c - nu) * sum[0];
  part_[3][at] += nu * sum[2];
}

void viscous_influence::make_spectra() {
  const int nx = plane_.nx(), ny = plane_.ny();
  for (int k = 0; k < kernels(); ++k) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int oi = direction_ * (2 * i <= nx ? i : i - nx), oj = 2 * j <= ny ? j : j - ny;
        double value = table_[k][static_cast<size_t>(std::abs(oj) * columns() + oi + half())];
        // xy is odd in y and turns round with the axis along rolling
        if (k == 3) value *= oj < 0 ? -direction_ : direction_;
        plane_.kernel()[j * nx + i] = value;
      }
    plane_.spectrum_of_kernel(re_[k].data(), im_[k].data());
  }
}

double viscous_influence::coefficient(kernel k, int ahead, int j) const {
  const auto at = static_cast<size_t>(std::abs(j) * columns() + half() - ahead);
  return table_[static_cast<size_t>(k)][at];
}

// of_wave(wave number, z, z of the opposite wave, out)
template <class F>
viscous_influence::lines viscous_influence::product(const double *re, const double *im,
                                                    F &&of_wave) {
  using complex = std::complex<double>;
  const int sizes[2] = {grid_.nx, grid_.ny}, nx = plane_.nx(), ny = plane_.ny();
  return plane_.product(sizes, sizes, re, im, [&](lines from, lines to, int stride) {
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j) {
        const int here = i * stride + j, there = (nx - i) % nx * stride + (ny - j) % ny;
        const complex out =
            of_wave(i, static_cast<size_t>(i * ny + j), complex(from.re[here], from.im[here]),
                    complex(from.re[there], -from.im[there]));
        to.re[here] = out.real();
        to.im[here] = out.imag();
      }
  });
}

void viscous_influence::take(lines u, double *re, double *im) const {
  const int stride = plane_transform::fft::whole_packs(grid_.nx);
  for (int j = 0; j < grid_.ny; ++j) {
    std::copy_n(u.re + j * stride, grid_.nx, re + j * grid_.nx);
    if (im) std::copy_n(u.im + j * stride, grid_.nx, im + j * grid_.nx);
  }
}

namespace {

using complex = std::complex<double>;

// Both components travel as one complex field: their transforms are told apart by symmetry.
complex plane_product(complex xx, complex yy, complex xy, complex z, complex opposite) {
  const complex px = 0.5 * (z + opposite), py = complex(0, -0.5) * (z - opposite);
  return (xx * px + xy * py) + complex(0, 1) * (xy * px + yy * py);
}

}  // namespace

void viscous_influence::normal_product(const double *pressure, double *displacement) {
  take(product(
           pressure, nullptr,
           [&](int, size_t at, complex z, complex) { return complex(re_[0][at], im_[0][at]) * z; }),
       displacement, nullptr);
}

// The springs' flexibilities add, their lengths count by them.
void viscous_influence::set_inverse() {
  double elastic = 0, yielding = 0, length = 0;
  for (int k = 0; k < 2; ++k) {
    const double part = (1.0 - bodies_.poisson_ratio[k]) / bodies_.shear_modulus[k];
    elastic += part;
    yielding += bodies_.ratio[k] * part;
    length += bodies_.ratio[k] * part * speed_ * bodies_.relaxation_time[k];
  }
  yielding_ = yielding / elastic;
  decay_ = length > 0 ? exp(-grid_.dx * yielding / length) : 0.0;
}

// f(element, element ahead; negative: none inside), from the leading edge on.
template <class F>
void viscous_influence::along_rows(const unsigned char *inside, F &&f) const {
  for (int j = 0; j < grid_.ny; ++j)
    for (int k = 0; k < grid_.nx; ++k) {
      const int i = direction_ > 0 ? grid_.nx - 1 - k : k, at = j * grid_.nx + i;
      if (inside[at]) f(at, k > 0 && inside[at + direction_] ? at + direction_ : -1);
    }
}

void viscous_influence::normal_inverse(const unsigned char *inside, double *u, double *p) {
  // of the elastic part, that bodies yield from one element to the next
  const double yields = yielding_ * (1.0 - decay_);
  if (yields * grid_.nx < little) return elastic_.normal_inverse(u, p);
  // each from the one ahead as it was, which is kept as it goes
  double ahead = 0;
  along_rows(inside, [&](int at, int next) {
    const double here = u[at];
    u[at] -= next >= 0 ? decay_ * ahead : 0.0;
    ahead = here;
  });
  elastic_.normal_inverse(u, p);
  const double scale = 1.0 / (1.0 + yields);
  along_rows(inside, [&](int at, int next) {
    p[at] = scale * (p[at] + (next >= 0 ? decay_ * p[next] : 0.0));
  });
}

void viscous_influence::tangential_product(const double *px, const double *py, double *ux,
                                           double *uy) {
  take(product(px, py,
               [&](int, size_t at, complex z, complex opposite) {
                 return plane_product({re_[1][at], im_[1][at]}, {re_[2][at], im_[2][at]},
                                      {re_[3][at], im_[3][at]}, z, opposite);
               }),
       ux, uy);
}

void viscous_influence::rolling_product(const double *px, const double *py, double *sx,
                                        double *sy) {
  take(product(px, py,
               [&](int wave, size_t at, complex z, complex opposite) {
                 const auto i = static_cast<size_t>(wave);
                 return complex(shift_[0][i], shift_[1][i]) *
                        plane_product({re_[1][at], im_[1][at]}, {re_[2][at], im_[2][at]},
                                      {re_[3][at], im_[3][at]}, z, opposite);
               }),
       sx, sy);
}

// The imaginary part of a shift is that of a central difference.
double viscous_influence::normal_loss(const double *pressure) {
  take(product(pressure, nullptr,
               [&](int wave, size_t at, complex z, complex) {
                 return complex(0, shift_[1][static_cast<size_t>(wave)]) *
                        (complex(re_[0][at], im_[0][at]) * z);
               }),
       taken_[0].data(), nullptr);
  return dot(pressure, taken_[0].data(), static_cast<size_t>(grid_.count())) * grid_.dx * grid_.dy;
}

double viscous_influence::tangential_loss(const double *px, const double *py) {
  take(product(px, py,
               [&](int wave, size_t at, complex z, complex opposite) {
                 return complex(0, shift_[1][static_cast<size_t>(wave)]) *
                        plane_product({re_[1][at], im_[1][at]}, {re_[2][at], im_[2][at]},
                                      {re_[3][at], im_[3][at]}, z, opposite);
               }),
       taken_[0].data(), taken_[1].data());
  const auto count = static_cast<size_t>(grid_.count());
  return (dot(px, taken_[0].data(), count) + dot(py, taken_[1].data(), count)) * grid_.dx *
         grid_.dy;
}

}  // namespace railpatch
