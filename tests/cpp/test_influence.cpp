// Influence coefficients against numerical integration of the point-load solutions, and products by
// FFT against direct sums.
#include "half_space/influence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace railpatch;
using std::numbers::pi;

constexpr double imposed = 1e-12;  // fft = direct sum, relative
// some tens of roundings of single precision, one after the other
constexpr double rounded = 32 * std::numeric_limits<float>::epsilon();
constexpr double integration = 1e-11;  // closed form = quadrature, relative to the self-influence

// --- independent integration ---------------------------------------------------------------

// Gauss-Legendre nodes and weights on (-1, 1), by Newton's method on the polynomial.
struct rule {
  std::vector<double> x, w;
  explicit rule(int n) : x(static_cast<size_t>(n)), w(static_cast<size_t>(n)) {
    for (int i = 0; i < n; ++i) {
      double t = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 0;
      for (int pass = 0; pass < 50; ++pass) {
        double p0 = 1, p1 = t;
        for (int k = 2; k <= n; ++k) {
          const double p2 = ((2 * k - 1) * t * p1 - (k - 1) * p0) / k;
          p0 = p1;
          p1 = p2;
        }
        slope = n * (t * p1 - p0) / (t * t - 1);
        const double step = p1 / slope;
        t -= step;
        if (std::fabs(step) < 1e-16) break;
      }
      x[static_cast<size_t>(i)] = t;
      w[static_cast<size_t>(i)] = 2 / ((1 - t * t) * slope * slope);
    }
  }
  template <class F>
  double operator()(double a, double b, F &&f) const {
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) sum += w[i] * f(0.5 * (a + b) + 0.5 * (b - a) * x[i]);
    return 0.5 * (b - a) * sum;
  }
};

// Point loads on the half-space (Boussinesq; Cerruti), both bodies together; displacement at (x, y)
// from the load.
double point_load(kernel k, double x, double y, const elastic_constants &e) {
  const double r = std::hypot(x, y), nu = e.poisson_ratio, c = 1 / (pi * e.shear_modulus * r);
  switch (k) {
    case kernel::zz:
      return c * (1 - nu);
    case kernel::xx:
      return c * (1 - nu + nu * x * x / (r * r));
    case kernel::yy:
      return c * (1 - nu + nu * y * y / (r * r));
    case kernel::xy:
      return c * nu * x * y / (r * r);
  }
  return 0;
}

template <class F>
double over_rectangle(double x0, double x1, double y0, double y1, const F &f, int depth = 0) {
  static const rule coarse(8), fine(12);
  const auto integrate = [&](const rule &q) {
    return q(y0, y1, [&](double y) { return q(x0, x1, [&](double x) { return f(x, y); }); });
  };
  const double a = integrate(coarse), b = integrate(fine);
  if (depth == 12 || std::fabs(a - b) <= 1e-14 * (std::fabs(b) + (x1 - x0) * (y1 - y0) * 1e-9))
    return b;
  const double xm = 0.5 * (x0 + x1), ym = 0.5 * (y0 + y1);
  return over_rectangle(x0, xm, y0, ym, f, depth + 1) +
         over_rectangle(xm, x1, y0, ym, f, depth + 1) +
         over_rectangle(x0, xm, ym, y1, f, depth + 1) +
         over_rectangle(xm, x1, ym, y1, f, depth + 1);
}

// The load's element around the observer: kernels are f(angle)/r, so the integral over r is exact.
double over_own_element(kernel k, double dx, double dy, const elastic_constants &e) {
  static const rule q(40);
  const double corner = std::atan2(dy, dx);
  const double breaks[] = {-corner, 0,           corner,   0.5 * pi,       pi - corner,
                           pi,      pi + corner, 1.5 * pi, 2 * pi - corner};
  double sum = 0;
  for (int i = 0; i < 8; ++i)
    sum += q(breaks[i], breaks[i + 1], [&](double t) {
      const double c = std::cos(t), s = std::sin(t);
      const double reach = 0.5 * std::min(dx / std::fabs(c), dy / std::fabs(s));
      return point_load(k, c, s, e) * reach;
    });
  return sum;
}

double integrated(kernel k, int i, int j, double dx, double dy, const elastic_constants &e) {
  if (i == 0 && j == 0) return over_own_element(k, dx, dy, e);
  return over_rectangle((i - 0.5) * dx, (i + 0.5) * dx, (j - 0.5) * dy, (j + 0.5) * dy,
                        [&](double x, double y) { return point_load(k, x, y, e); });
}

// --- set-up --------------------------------------------------------------------------------

struct set_up {
  fft_plans plans;
  influence a;
  set_up(const influence::medium &of, const grid &g)
      : plans({smooth_size(2 * g.nx + 1)}, {g.ny > 1 ? smooth_size(2 * g.ny - 1) : 1}),
        a(of, plans) {
    EXPECT_TRUE(a.set_grid(g));
  }
};

elastic_constants steel(double nu = 0.28) {
  const double g[] = {82e9, 82e9}, n[] = {nu, nu};
  return combine(g, n);
}

constexpr kernel all_kernels[] = {kernel::zz, kernel::xx, kernel::yy, kernel::xy};

// --- coefficients --------------------------------------------------------------------------

TEST(Coefficients, EqualTheIntegralOfThePointLoads) {
  for (const auto &[dx, dy] : {std::pair{1e-3, 1e-3}, {2e-4, 9e-4}, {5e-3, 5e-4}})
    for (double nu : {0.0, 0.28, 0.5}) {
      const elastic_constants e = steel(nu);
      set_up s({e}, {8, 6, dx, dy, 0, 0});
      for (kernel k : all_kernels)
        for (int j = -5; j <= 5; ++j)
          for (int i = -8; i <= 8; ++i) {
            const double bound = integration * s.a.coefficient(kernel::xx, 0, 0);
            EXPECT_NEAR(s.a.coefficient(k, i, j), integrated(k, i, j, dx, dy, e), bound)
                << "kernel " << static_cast<int>(k) << " offset " << i << ", " << j << " element "
                << dx << " x " << dy << " nu " << nu;
          }
    }
}

TEST(Coefficients, OfUnequalBodiesAreTheSumOfBoth) {
  const double g[] = {82e9, 26e9}, nu[] = {0.28, 0.33};
  const elastic_constants both = combine(g, nu);
  set_up s({both}, {5, 5, 1e-3, 7e-4, 0, 0});
  for (kernel k : all_kernels)
    for (int i = 0; i <= 5; ++i) {
      double sum = 0;
      for (int body = 0; body < 2; ++body)
        // point_load holds two equal bodies
        sum += 0.5 * integrated(k, i, 2, 1e-3, 7e-4, {g[body], nu[body], 0});
      EXPECT_NEAR(s.a.coefficient(k, i, 2), sum, integration * s.a.coefficient(kernel::xx, 0, 0));
    }
}

TEST(Coefficients, AreEvenOrOdd) {
  set_up s({steel()}, {9, 7, 1e-3, 6e-4, 0, 0});
  for (kernel k : all_kernels) {
    const double sign = k == kernel::xy ? -1 : 1;
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 9; ++i) {
        const double v = s.a.coefficient(k, i, j);
        EXPECT_EQ(s.a.coefficient(k, -i, j), sign * v);
        EXPECT_EQ(s.a.coefficient(k, i, -j), sign * v);
        EXPECT_EQ(s.a.coefficient(k, -i, -j), v);
      }
  }
  // exchanging the axes exchanges xx and yy
  set_up t({steel()}, {7, 9, 6e-4, 1e-3, 0, 0});
  for (int j = 0; j < 7; ++j)
    for (int i = 0; i < 9; ++i) {
      const double v = s.a.coefficient(kernel::xx, i, j);
      EXPECT_NEAR(v, t.a.coefficient(kernel::yy, j, i), imposed * v);
    }
}

TEST(Coefficients, TendToThePointLoadFarAway) {
  const elastic_constants e = steel();
  const double dx = 1e-3, dy = 5e-4;
  set_up s({e}, {120, 120, dx, dy, 0, 0});
  for (kernel k : all_kernels)
    for (int n : {15, 30, 60, 120}) {
      const double x = n * dx, y = 0.6 * n * dy, r = std::hypot(x, y);
      const int j = static_cast<int>(0.6 * n);
      const double far = dx * dy * point_load(k, x, y, e);
      // the next term of the expansion is of second order in size over distance
      EXPECT_NEAR(s.a.coefficient(k, n, j) / far, 1, 0.5 * (dx / r) * (dx / r))
          << "kernel " << static_cast<int>(k) << " distance " << n << " elements";
    }
}

TEST(Coefficients, OfALayerAddToTheDiagonalOnly) {
  const double flexibility = 5e-5 / 8.2e9;
  const grid g{6, 5, 1e-3, 1e-3, 0, 0};
  set_up with({steel(), flexibility}, g), without({steel()}, g);
  for (kernel k : all_kernels)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i) {
        const bool own = i == 0 && j == 0 && (k == kernel::xx || k == kernel::yy);
        const double expected = without.a.coefficient(k, i, j) + (own ? flexibility : 0.0);
        EXPECT_DOUBLE_EQ(with.a.coefficient(k, i, j), expected);
      }
}

// Strip loads in plane strain; the logarithm at the load is resolved by s = h t^6.
TEST(Coefficients, OfALineContactEqualTheIntegralOfTheLogarithm) {
  static const rule q(40);
  const double width = 0.02, dx = 1e-4, nu = 0.28;
  const elastic_constants e = steel(nu);
  set_up s({e, 0.0, width}, {40, 1, dx, width, 0, 0});
  const auto from_zero = [&](double h) {
    return q(0, 1, [&](double t) {
      const double x = h * std::pow(t, 6);
      return std::log(width / x) * 6 * h * std::pow(t, 5);
    });
  };
  for (int i = 0; i <= 40; ++i) {
    const double upper = from_zero((i + 0.5) * dx);
    const double value = i == 0 ? 2 * upper : upper - from_zero((i - 0.5) * dx);
    const double c = 2 / (pi * e.shear_modulus);
    EXPECT_NEAR(s.a.coefficient(kernel::zz, i, 0), c * (1 - nu) * value, 1e-10 * c * dx);
    EXPECT_NEAR(s.a.coefficient(kernel::xx, i, 0), c * (1 - nu) * value, 1e-10 * c * dx);
    EXPECT_NEAR(s.a.coefficient(kernel::yy, i, 0), c * value, 1e-10 * c * dx);
    EXPECT_EQ(s.a.coefficient(kernel::xy, i, 0), 0);
  }
}

// --- products ------------------------------------------------------------------------------

struct size_case {
  const char *name;
  grid g;
  double layer, width;
};

const size_case sizes[] = {
    {"square", {16, 16, 1e-3, 1e-3, 0, 0}, 0, 0},
    {"odd", {13, 17, 4e-4, 7e-4, 0, 0}, 0, 0},
    {"long", {37, 5, 2e-4, 1e-3, 0, 0}, 6e-15, 0},
    {"wide", {3, 41, 1e-3, 2e-4, 0, 0}, 0, 0},
    {"prime with layer", {23, 19, 5e-4, 5e-4, 0, 0}, 6e-15, 0},
    {"one more than two packs", {17, 6, 5e-4, 4e-4, 0, 0}, 0, 0},
    {"two rows", {2, 2, 5e-4, 4e-4, 0, 0}, 0, 0},
    {"factors of five", {50, 25, 3e-4, 4e-4, 0, 0}, 0, 0},
    {"line", {51, 1, 1e-4, 0.02, 0, 0}, 0, 0.02},
    {"line with layer", {32, 1, 1e-4, 0.02, 0, 0}, 6e-15, 0.02},
};

class Products : public testing::TestWithParam<size_case> {
 protected:
  std::vector<double> random_field() {
    std::uniform_real_distribution<double> u(-1e9, 1e9);
    std::vector<double> f(static_cast<size_t>(g.count()));
    for (double &v : f) v = u(random);
    return f;
  }
  std::vector<double> zeros() const { return std::vector<double>(static_cast<size_t>(g.count())); }
  // sum over the sources of the coefficient seen from `ahead` elements further along x
  std::vector<double> direct(kernel k, const std::vector<double> &p, int ahead = 0) const {
    std::vector<double> u = zeros();
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        for (int n = 0; n < g.ny; ++n)
          for (int m = 0; m < g.nx; ++m)
            u[static_cast<size_t>(j * g.nx + i)] +=
                s.a.coefficient(k, i + ahead - m, j - n) * p[static_cast<size_t>(n * g.nx + m)];
    return u;
  }
  static std::vector<double> sum(std::vector<double> a, const std::vector<double> &b, double c) {
    for (size_t i = 0; i < a.size(); ++i) a[i] += c * b[i];
    return a;
  }
  static void expect_near(const std::vector<double> &fft, const std::vector<double> &expected,
                          double bound = imposed) {
    double scale = 0, worst = 0;
    for (size_t i = 0; i < fft.size(); ++i) {
      scale = std::max(scale, std::fabs(expected[i]));
      worst = std::max(worst, std::fabs(fft[i] - expected[i]));
    }
    EXPECT_LE(worst, bound * scale) << "relative " << worst / scale << " bound " << bound;
  }

  grid g = GetParam().g;
  set_up s{{steel(), GetParam().layer, GetParam().width}, g};
  std::mt19937_64 random{20240607};
};

TEST_P(Products, NormalEqualsTheDirectSum) {
  const std::vector<double> p = random_field();
  std::vector<double> u = zeros();
  s.a.normal_product(p.data(), u.data());
  expect_near(u, direct(kernel::zz, p));
  s.a.normal_product_single(p.data(), u.data());
  expect_near(u, direct(kernel::zz, p), rounded);
}

TEST_P(Products, TangentialEqualsTheDirectSum) {
  const std::vector<double> px = random_field(), py = random_field();
  std::vector<double> ux = zeros(), uy = zeros();
  s.a.tangential_product(px.data(), py.data(), ux.data(), uy.data());
  expect_near(ux, sum(direct(kernel::xx, px), direct(kernel::xy, py), 1));
  expect_near(uy, sum(direct(kernel::xy, px), direct(kernel::yy, py), 1));
}

TEST_P(Products, RollingEqualsTheDirectSumInBothDirections) {
  const std::vector<double> px = random_field(), py = random_field();
  for (int direction : {1, -1}) {
    std::vector<double> sx = zeros(), sy = zeros();
    s.a.rolling_product(px.data(), py.data(), direction, sx.data(), sy.data());
    std::vector<double> ex = sum(direct(kernel::xx, px), direct(kernel::xy, py), 1);
    std::vector<double> ey = sum(direct(kernel::xy, px), direct(kernel::yy, py), 1);
    ex = sum(ex, direct(kernel::xx, px, direction), -1);
    ex = sum(ex, direct(kernel::xy, py, direction), -1);
    ey = sum(ey, direct(kernel::xy, px, direction), -1);
    ey = sum(ey, direct(kernel::yy, py, direction), -1);
    for (std::vector<double> *e : {&ex, &ey})
      for (double &v : *e) v /= g.dx;
    expect_near(sx, ex);
    expect_near(sy, ey);
    s.a.rolling_product_single(px.data(), py.data(), direction, sx.data(), sy.data());
    expect_near(sx, ex, rounded);
    expect_near(sy, ey, rounded);
  }
}

// Parseval's sum over the waves is that over the elements.
TEST_P(Products, RollingReturnsTheTractionsOwnProduct) {
  const std::vector<double> px = random_field(), py = random_field();
  const std::vector<double> ux = sum(direct(kernel::xx, px), direct(kernel::xy, py), 1),
                            uy = sum(direct(kernel::xy, px), direct(kernel::yy, py), 1);
  double own = 0, size = 0;
  for (size_t i = 0; i < px.size(); ++i) {
    own += px[i] * ux[i] + py[i] * uy[i];
    size += std::fabs(px[i] * ux[i]) + std::fabs(py[i] * uy[i]);
  }
  for (int direction : {1, -1}) {
    std::vector<double> sx = zeros(), sy = zeros();
    EXPECT_NEAR(s.a.rolling_product(px.data(), py.data(), direction, sx.data(), sy.data()), own,
                imposed * size);
  }
}

// what makes it fit as a preconditioner of conjugate gradients
TEST_P(Products, InverseIsSymmetricAndPositive) {
  const std::vector<double> p = random_field(), q = random_field();
  std::vector<double> mp = zeros(), mq = zeros();
  s.a.normal_inverse(p.data(), mp.data());
  s.a.normal_inverse(q.data(), mq.data());
  double pq = 0, qp = 0, pp = 0, size = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    pq += p[i] * mq[i];
    qp += q[i] * mp[i];
    pp += p[i] * mp[i];
    size += std::fabs(p[i] * mq[i]);
  }
  EXPECT_NEAR(pq, qp, rounded * size);
  EXPECT_GT(pp, 0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Products, testing::ValuesIn(sizes), [](const auto &info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

// The tables of one element size serve grids of several sizes, growing and shrinking.
TEST(Grids, TheirOrderMakesNoDifference) {
  fft_plans plans({16, 32, 64}, {16, 32, 64});
  influence used({steel()}, plans), fresh({steel()}, plans);
  const grid small{6, 7, 1e-3, 1e-3, 0, 0}, large{25, 30, 1e-3, 1e-3, 0, 0};
  const grid other{7, 7, 9e-4, 1e-3, 0, 0};
  for (const grid &g : {small, large, other}) ASSERT_TRUE(used.set_grid(g));
  ASSERT_TRUE(used.set_grid(small));
  ASSERT_TRUE(fresh.set_grid(small));
  std::vector<double> p(42), u(42), v(42);
  for (size_t i = 0; i < p.size(); ++i) p[i] = std::sin(static_cast<double>(i));
  used.normal_product(p.data(), u.data());
  fresh.normal_product(p.data(), v.data());
  EXPECT_EQ(u, v);
  EXPECT_FALSE(used.set_grid({40, 7, 1e-3, 1e-3, 0, 0})) << "larger than every plan";
}

constexpr int in_a_row = kernel_book::lead;  // from here on kept kernels are read

influence::medium followed(double layer, bool tangential) {
  influence::medium m{steel(), layer, 0.0, tangential};
  m.follows = true;
  return m;
}

// Kept kernels against those of the grid itself: coefficients, products of pressure and traction.
// Lagrange's remainder for eight values h = 1/32 apart is (1/2 3/2 5/2 7/2 h^4)^2 |f^(8)|/8!, and
// |f^(8)|/8! some f/(pi/2)^8 with the nearest singularities at log(dy/dx) = +-i pi/2: 1.1e-12 f.
TEST(Grids, KeptKernelsAreThoseOfTheGrid) {
  constexpr double kept = 1.1e-12;
  const fft_plans plans({40}, {36});
  for (const double layer : {0.0, 2e-15})
    for (const double ratio : {0.21, 0.97, 1.0, 1.62, 2.44, 7.3}) {
      influence exact(followed(layer, true), plans), read(followed(layer, true), plans),
          normal(followed(0, false), plans);
      const grid g{18, 18, 7e-4, 7e-4 * ratio, 0, 0};
      ASSERT_TRUE(exact.set_grid(g) && read.set_grid(g, in_a_row) && normal.set_grid(g, in_a_row));
      for (const kernel k : {kernel::zz, kernel::xx, kernel::yy, kernel::xy})
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 18; ++i)
            EXPECT_NEAR(read.coefficient(k, i, j), exact.coefficient(k, i, j),
                        kept * exact.coefficient(kernel::zz, 0, 0))
                << ratio << " " << static_cast<int>(k) << " " << i << " " << j;
      std::vector<double> p(324), q(324), u[6], v[6];
      for (auto *f : {&u, &v})
        for (auto &one : *f) one.resize(p.size());
      for (size_t i = 0; i < p.size(); ++i)
        p[i] = std::sin(1.0 + static_cast<double>(i)),
        q[i] = std::cos(0.7 * static_cast<double>(i));
      const auto products = [&](influence &a, std::vector<double> *out) {
        a.normal_product(p.data(), out[0].data());
        a.tangential_product(p.data(), q.data(), out[1].data(), out[2].data());
        a.rolling_product(p.data(), q.data(), 1, out[3].data(), out[4].data());
      };
      products(exact, u);
      products(read, v);
      normal.normal_product(p.data(), v[5].data());
      u[5] = u[0];
      for (int k = 0; k < 6; ++k)
        for (size_t i = 0; i < p.size(); ++i) {
          // all elements may be off by as much
          const double scale =
              exact.coefficient(kernel::zz, 0, 0) * 324 / (k == 3 || k == 4 ? g.dx : 1);
          EXPECT_NEAR(v[k][i], u[k][i], kept * scale) << ratio << " " << k;
        }
    }
}

// Pages are the same whenever they were written, also where others had to go.
TEST(Grids, WhatWasReadBeforeMakesNoDifference) {
  const fft_plans plans({40}, {36});
  influence used(followed(0, true), plans), fresh(followed(0, true), plans);
  const auto of = [](double ratio) { return grid{18, 18, 7e-4, 7e-4 * ratio, 0, 0}; };
  for (int k = 0; k < 80; ++k)
    ASSERT_TRUE(used.set_grid(of(0.1 * std::exp(0.06 * k)), k % (in_a_row + 1)));
  ASSERT_TRUE(used.set_grid(of(1.3), in_a_row) && fresh.set_grid(of(1.3), in_a_row));
  std::vector<double> p(324), u(324), v(324);
  for (size_t i = 0; i < p.size(); ++i) p[i] = std::sin(static_cast<double>(i));
  for (const int follows : {in_a_row, 1, 2, in_a_row - 1, 0}) {
    ASSERT_TRUE(used.set_grid(of(1.3), follows) && fresh.set_grid(of(1.3), follows));
    used.normal_product(p.data(), u.data());
    fresh.normal_product(p.data(), v.data());
    EXPECT_EQ(u, v);
  }
}

// The first grids in a row have kernels of their own, to the bit, and write what later ones read.
TEST(Grids, TheFirstInARowHaveTheirOwnKernels) {
  const fft_plans plans({40}, {36});
  influence used(followed(0, true), plans), own(followed(0, true), plans);
  const auto of = [](int k) { return grid{18, 18, 7e-4, 7e-4 * (1 + 1e-3 * k), 0, 0}; };
  std::vector<double> p(324), u(324), v(324);
  for (size_t i = 0; i < p.size(); ++i) p[i] = std::sin(static_cast<double>(i));
  for (int k = 0; k < in_a_row; ++k) {
    ASSERT_TRUE(used.set_grid(of(k), k) && own.set_grid(of(k)));
    used.normal_product(p.data(), u.data());
    own.normal_product(p.data(), v.data());
    EXPECT_EQ(u, v) << k;
  }
}

}  // namespace
