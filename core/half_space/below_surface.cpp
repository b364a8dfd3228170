#include "half_space/below_surface.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "numeric/simd.hpp"

namespace railpatch {

namespace {

// Of plane strain: how many times the greatest distance a strip reaches to either side.
constexpr double strip_reach = 1e4;

struct row {
  const float *re, *im;
};

// Adds one load's share to a component: k real, or k imaginary, times sign.
RAILPATCH_INLINE void add_share(size_t n, bool imaginary, float sign, const float *k, row from,
                                float *re, float *im) {
  if (imaginary) {
    RAILPATCH_INDEPENDENT
    for (size_t j = 0; j < n; ++j) {
      const float c = sign * k[j];
      re[j] -= c * from.im[j];
      im[j] += c * from.re[j];
    }
  } else {
    RAILPATCH_INDEPENDENT
    for (size_t j = 0; j < n; ++j) {
      const float c = sign * k[j];
      re[j] += c * from.re[j];
      im[j] += c * from.im[j];
    }
  }
}

// All loads' shares of all components for one wave number along x.
struct wave_task {
  size_t waves;
  int components;
  bool negative;   // wave number beyond half the transform
  const float *k;  // [loads][components][waves]
  row from;        // [loads][waves]
  float *re, *im;  // [components][waves]
};

RAILPATCH_DISPATCH
void add_shares(const wave_task &t) {
  for (int c = 0; c < t.components; ++c) {
    float *re = t.re + static_cast<size_t>(c) * t.waves,
          *im = t.im + static_cast<size_t>(c) * t.waves;
    std::fill_n(re, t.waves, 0.0f);
    std::fill_n(im, t.waves, 0.0f);
    for (int l = 0; l < below::loads; ++l) {
      const bool odd_x = below::odd(l, c, 0);
      const size_t at = static_cast<size_t>(l) * t.waves;
      add_share(t.waves, odd_x != below::odd(l, c, 1), odd_x && t.negative ? -1.0f : 1.0f,
                t.k + static_cast<size_t>(l * t.components + c) * t.waves,
                {t.from.re + at, t.from.im + at}, re, im);
    }
  }
}

}  // namespace

below_surface::below_surface(const body_constants &body, std::vector<double> depths,
                             const fft_plans &plans, bool displacements, bool plane_strain)
    : body_(body),
      depths_(std::move(depths)),
      plans_(plans),
      components_(displacements && !plane_strain ? below::components : below::stresses),
      plane_strain_(plane_strain),
      along_x_(plans.max_nx()),
      along_y_(plans.max_ny()) {
  const auto nx = static_cast<size_t>(plans.max_nx()), ny = static_cast<size_t>(plans.max_ny());
  const size_t half_x = nx / 2 + 1, half_y = ny / 2 + 1;
  const auto both = static_cast<size_t>(loads * components_);
  spectrum_ = aligned_buffer<number>(depths_.size() * half_x * both * half_y);
  corner_ = aligned_buffer<below_coefficients>((half_x + 1) * (half_y + 1));
  padded_ = aligned_buffer<double>(nx * ny);
  transform_ = aligned_buffer<std::complex<double>>(half_x * ny);
  const auto across = static_cast<size_t>(fft::whole_packs(static_cast<int>(half_x)));
  const auto side = static_cast<size_t>(std::max(pairs(), 2));
  for (auto &b : lateral_) b = aligned_buffer<number>(side * across * ny);
  const auto lines_most =
      static_cast<size_t>(fft::whole_packs(2 * static_cast<int>(side) * static_cast<int>(half_y)));
  for (auto &b : along_) b = aligned_buffer<number>(lines_most * nx);
  for (auto &b : load_) b = aligned_buffer<number>(lines_most * nx);
}

size_t below_surface::bytes() const {
  return spectrum_.bytes() + corner_.bytes() + padded_.bytes() + transform_.bytes() +
         4 * (lateral_[0].bytes() + along_[0].bytes()) + 2 * load_[0].bytes() + along_x_.bytes() +
         along_y_.bytes();
}

bool below_surface::set_grid(const grid &g) {
  const int plan = plans_.find(2 * g.nx, g.ny > 1 ? 2 * g.ny : 1);
  if (plan < 0) return false;
  const bool same = plan == plan_ && g.dx == grid_.dx && g.dy == grid_.dy;
  grid_ = g;
  if (same) return true;
  plan_ = plan;
  along_x_.set_length(big_nx());
  along_y_.set_length(big_ny());
  for (int k = 0; k < depths(); ++k) make_coefficients(k);
  return true;
}

void below_surface::fill_corners(double z) {
  const int width = big_nx() / 2 + 2, height = big_ny() / 2 + 2;
  const double length = std::max(grid_.dx, grid_.dy);
  const double reach = strip_reach * (big_nx() * grid_.dx + z);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double y = plane_strain_ ? (j - 0.5) * 2.0 * reach : (j - 0.5) * grid_.dy;
      corner_[static_cast<size_t>(j * width + i)] =
          below_corner(body_, (i - 0.5) * grid_.dx, y, z, length);
    }
}

void below_surface::make_coefficients(int depth) {
  const int nx = big_nx(), ny = big_ny(), half_x = nx / 2, half_y = ny / 2, width = half_x + 2;
  fill_corners(depths_[static_cast<size_t>(depth)]);
  const double factor = 1.0 / (static_cast<double>(nx) * ny);
  number *const to = spectrum_.data() + static_cast<size_t>(depth) *
                                            static_cast<size_t>((half_x + 1) * waves()) *
                                            static_cast<size_t>(loads * components_);
  for (int l = 0; l < loads; ++l)
    for (int c = 0; c < components_; ++c) {
      const auto k = static_cast<size_t>(below::at(l, c));
      const bool odd_x = below::odd(l, c, 0), odd_y = below::odd(l, c, 1);
      for (int j = 0; j <= half_y; ++j)
        for (int i = 0; i <= half_x; ++i) {
          const below_coefficients *f = corner_.data() + j * width + i;
          // where both ends of the period meet nothing is asked for
          const bool nothing = (odd_x && 2 * i == nx) || (odd_y && ny > 1 && 2 * j == ny);
          const double value =
              nothing ? 0.0 : (f[width + 1][k] - f[width][k]) - (f[1][k] - f[0][k]);
          const int i2 = (nx - i) % nx, j2 = (ny - j) % ny;
          const double mx = odd_x && i2 != i ? -value : value;
          padded_[static_cast<size_t>(j * nx + i)] = value;
          padded_[static_cast<size_t>(j * nx + i2)] = mx;
          if (j2 == j) continue;
          padded_[static_cast<size_t>(j2 * nx + i)] = odd_y ? -value : value;
          padded_[static_cast<size_t>(j2 * nx + i2)] = odd_y ? -mx : mx;
        }
      plans_.forward(plan_, padded_.data(), transform_.data());
      for (int i = 0; i <= half_x; ++i)
        for (int j = 0; j < waves(); ++j) {
          const std::complex<double> z = transform_[static_cast<size_t>(j * (half_x + 1) + i)];
          to[static_cast<size_t>(((i * loads + l) * components_ + c) * waves() + j)] =
              static_cast<number>(factor * (odd_x != odd_y ? z.imag() : z.real()));
        }
    }
}

// Transforms the loads: load_ has [big_nx][loaded].
void below_surface::load(const double *p, const double *qx, const double *qy) {
  const int nx = grid_.nx, ny = grid_.ny, across = 2 * columns(), half = waves(), n = loaded();
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < columns(); ++i) {
      const auto at = static_cast<size_t>(j * across + i),
                 second = at + static_cast<size_t>(columns());
      const bool inside = i < nx;
      lateral_[0][at] = inside ? static_cast<number>(p[j * nx + i]) : 0;
      lateral_[1][at] = inside && qx ? static_cast<number>(qx[j * nx + i]) : 0;
      lateral_[0][second] = inside && qy ? static_cast<number>(qy[j * nx + i]) : 0;
      lateral_[1][second] = 0;
    }
  const lines z = along_y_.forward(across, ny, {lateral_[0].data(), lateral_[1].data()},
                                   {lateral_[2].data(), lateral_[3].data()});
  std::fill_n(along_[0].data(), static_cast<size_t>(n) * static_cast<size_t>(nx), number(0));
  std::fill_n(along_[1].data(), static_cast<size_t>(n) * static_cast<size_t>(nx), number(0));
  for (int j = 0; j < half; ++j) {
    const int j2 = (big_ny() - j) % big_ny();
    for (int i = 0; i < nx; ++i) {
      const auto a = static_cast<size_t>(j * across + i), b = static_cast<size_t>(j2 * across + i);
      const auto to = static_cast<size_t>(i * n + j);
      const size_t next = static_cast<size_t>(half), s = static_cast<size_t>(columns());
      along_[0][to] = 0.5f * (z.re[a] + z.re[b]);
      along_[1][to] = 0.5f * (z.im[a] - z.im[b]);
      along_[0][to + next] = 0.5f * (z.im[a] + z.im[b]);
      along_[1][to + next] = 0.5f * (z.re[b] - z.re[a]);
      along_[0][to + 2 * next] = z.re[a + s];
      along_[1][to + 2 * next] = z.im[a + s];
    }
  }
  const lines found = along_x_.forward(n, nx, {along_[0].data(), along_[1].data()},
                                       {along_[2].data(), along_[3].data()});
  const auto count = static_cast<size_t>(n) * static_cast<size_t>(big_nx());
  std::copy_n(found.re, count, load_[0].data());
  std::copy_n(found.im, count, load_[1].data());
}

// The components' spectra at one depth into along_, [big_nx][found].
void below_surface::multiply(int depth, lines from) {
  const int nx = big_nx(), half_x = nx / 2, n = found();
  const auto block = static_cast<size_t>(loads * components_ * waves());
  const number *const k =
      spectrum_.data() + static_cast<size_t>(depth) * static_cast<size_t>(half_x + 1) * block;
  for (int i = 0; i < nx; ++i) {
    const int wave = i > half_x ? nx - i : i;
    const auto of = static_cast<size_t>(i) * static_cast<size_t>(loaded());
    const auto to = static_cast<size_t>(i) * static_cast<size_t>(n);
    add_shares({static_cast<size_t>(waves()),
                components_,
                i > half_x,
                k + static_cast<size_t>(wave) * block,
                {from.re + of, from.im + of},
                along_[0].data() + to,
                along_[1].data() + to});
    const auto made = static_cast<size_t>(components_ * waves()), rest = static_cast<size_t>(n);
    std::fill(along_[0].data() + to + made, along_[0].data() + to + rest, number(0));
    std::fill(along_[1].data() + to + made, along_[1].data() + to + rest, number(0));
  }
}

// Two components as one complex field each, and apart again on the grid.
void below_surface::back(int depth, double *out) {
  const int nx = grid_.nx, ny = grid_.ny, n = found(), half = waves(), wide = columns();
  const int across = pairs() * wide;
  const lines x = along_x_.backward(n, nx, {along_[0].data(), along_[1].data()},
                                    {along_[2].data(), along_[3].data()});
  for (int pair = 0; pair < pairs(); ++pair)
    for (int j = 0; j < half; ++j) {
      const int j2 = (big_ny() - j) % big_ny();
      number *const re = lateral_[0].data() + pair * wide, *const im =
                                                               lateral_[1].data() + pair * wide;
      for (int i = 0; i < wide; ++i) {
        const auto a = static_cast<size_t>(i * n + 2 * pair * half + j);
        const auto b = a + static_cast<size_t>(half);
        const bool inside = i < nx;
        const number ar = inside ? x.re[a] : 0, ai = inside ? x.im[a] : 0;
        const number br = inside ? x.re[b] : 0, bi = inside ? x.im[b] : 0;
        re[j2 * across + i] = ar + bi;
        im[j2 * across + i] = br - ai;
        re[j * across + i] = ar - bi;
        im[j * across + i] = ai + br;
      }
    }
  const lines u = along_y_.backward(across, ny, {lateral_[0].data(), lateral_[1].data()},
                                    {lateral_[2].data(), lateral_[3].data()});
  const auto count = static_cast<size_t>(nx * ny);
  for (int c = 0; c < components_; ++c) {
    const number *const from = (c % 2 == 0 ? u.re : u.im) + (c / 2) * wide;
    double *const to =
        out + (static_cast<size_t>(c) * depths_.size() + static_cast<size_t>(depth)) * count;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) to[j * nx + i] = static_cast<double>(from[j * across + i]);
  }
}

void below_surface::product(const double *p, const double *qx, const double *qy, double *out) {
  load(p, qx, qy);
  const lines from{load_[0].data(), load_[1].data()};
  for (int k = 0; k < depths(); ++k) {
    multiply(k, from);
    back(k, out);
  }
}

}  // namespace railpatch
