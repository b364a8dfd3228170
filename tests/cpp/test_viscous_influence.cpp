// Viscoelastic bodies' influence coefficients: the elastic ones under the history's integral by
// quadrature of its own, products by transforms against sums over elements, limits of short and
// long relaxation.
#include "half_space/viscous_influence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace railpatch;
using std::numbers::pi;
using field = std::vector<double>;

constexpr viscous_bodies bodies{{8e7, 3e8}, {0.5, 0.3}, {3.0, 0.7}, {2e-4, 9e-4}};
constexpr double rounded = 1e-12;      // of coefficients, relative to the greatest
constexpr double transformed = 1e-11;  // of products by transforms

// int f over [a, b] by the tanh-sinh rule, which ends with a logarithm do not disturb
template <class F>
double integral(double a, double b, const F &f) {
  double sum = 0;
  for (int k = -90; k <= 90; ++k) {
    const double t = k / 25.0, u = 0.5 * pi * std::sinh(t);
    const double share = 1 / (1 + std::exp(-2 * u));  // of the way from a to b
    const double weight = 0.5 * pi * std::cosh(t) / (std::cosh(u) * std::cosh(u)) / 25.0;
    // from the nearer end, so that no digits go
    const double rest = 1 / (1 + std::exp(2 * u));
    const double x = share < 0.5 ? a + (b - a) * share : b - (b - a) * rest;
    if (weight > 1e-30 && x > a && x < b) sum += weight * f(x);
  }
  return 0.5 * (b - a) * sum;
}

// Coefficient of one elastic body at a place: the primitives of influence.hpp, written out.
double elastic_at(const grid &g, double width, kernel k, double shear, double nu, double x,
                  double y) {
  const double c = 1 / (2 * pi * shear);
  if (width > 0) {
    const auto f = [&](double u) { return u != 0 ? u * (1 + std::log(width / std::abs(u))) : 0; };
    const double value = 2 * c * (f(x + g.dx / 2) - f(x - g.dx / 2));
    return k == kernel::xy ? 0.0 : k == kernel::yy ? value : (1 - nu) * value;
  }
  double sum[3] = {0, 0, 0};
  for (int corner = 0; corner < 4; ++corner) {
    const double sign = corner == 0 || corner == 3 ? 1 : -1;
    const double u = x + (corner & 1 ? -0.5 : 0.5) * g.dx;
    const double v = y + (corner & 2 ? -0.5 : 0.5) * g.dy;
    sum[0] += sign * v * std::asinh(u / std::abs(v));
    if (u != 0) sum[1] += sign * u * std::asinh(v / std::abs(u));
    sum[2] -= sign * std::sqrt(u * u + v * v);
  }
  if (k == kernel::zz) return c * (1 - nu) * (sum[0] + sum[1]);
  if (k == kernel::xx) return c * (sum[0] + (1 - nu) * sum[1]);
  if (k == kernel::yy) return c * (sum[1] + (1 - nu) * sum[0]);
  return c * nu * sum[2];
}

// Of both bodies with their histories: panels between the edges, and beyond them by doubling.
double coefficient_by_quadrature(const grid &g, double width, kernel k, int direction, double speed,
                                 int i, int j) {
  double sum = 0;
  for (int b = 0; b < 2; ++b) {
    const auto at = [&](double x) {
      return elastic_at(g, width, k, bodies.shear_modulus[b], bodies.poisson_ratio[b], x, j * g.dy);
    };
    const double x = i * g.dx, length = speed * bodies.relaxation_time[b];
    sum += at(x);
    if (!(length > 0)) {
      sum += bodies.ratio[b] * at(x);
      continue;
    }
    field ends = {0.0};
    for (const double edge : {-0.5 * g.dx, 0.5 * g.dx})
      if (direction * (edge - x) > 0) ends.push_back(direction * (edge - x));
    std::sort(ends.begin(), ends.end());
    while (ends.back() < 40 * length)
      ends.push_back(ends.back() + std::max(0.5 * length, ends.back() - ends.front()));
    for (size_t n = 0; n + 1 < ends.size(); ++n)
      for (int part = 0; part < 2; ++part) {
        const double a = ends[n] + (ends[n + 1] - ends[n]) * part / 2;
        const double e = ends[n] + (ends[n + 1] - ends[n]) * (part + 1) / 2;
        sum += bodies.ratio[b] * integral(a, e, [&](double s) {
                 return at(x + direction * s) * std::exp(-s / length) / length;
               });
      }
  }
  return sum;
}

struct size_case {
  const char *name;
  grid g;
  double width;
};

const size_case sizes[] = {
    {"square", {7, 6, 1e-3, 1e-3, 0, 0}, 0},   {"long", {11, 4, 2e-4, 3e-3, 0, 0}, 0},
    {"wide", {5, 7, 2e-3, 2e-4, 0, 0}, 0},     {"row", {9, 1, 1e-3, 2e-3, 0, 0}, 0},
    {"line", {14, 1, 1e-4, 0.02, 0, 0}, 0.02},
};

struct scene {
  explicit scene(const size_case &c, const viscous_bodies &of = bodies)
      : g(c.g),
        plans({smooth_size(2 * g.nx + 1)}, {g.ny > 1 ? smooth_size(2 * g.ny - 1) : 1}),
        elastic({combine(of.shear_modulus, of.poisson_ratio), 0.0, c.width}, plans),
        viscous(of, elastic, plans) {
    elastic.set_grid(g);
  }
  field random(unsigned seed) const {
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> value(-1, 1);
    field v(static_cast<size_t>(g.count()));
    for (double &x : v) x = value(engine);
    return v;
  }
  grid g;
  fft_plans plans;
  influence elastic;
  viscous_influence viscous;
};

class Viscous : public testing::TestWithParam<size_case> {};

// speeds whose relaxation lengths are a tenth of an element to a thousand
const double speeds[] = {0.0, 0.3, 2.0, 3e3};

TEST_P(Viscous, CoefficientsAreTheHistorysIntegral) {
  scene s(GetParam());
  const double top = elastic_at(s.g, GetParam().width, kernel::xx, 8e7, 0.5, 0, 0);
  for (const int direction : {1, -1})
    for (const double speed : speeds) {
      if (direction < 0 && speed != 2.0) continue;
      s.viscous.set(s.g, direction, speed);
      for (const kernel k : {kernel::zz, kernel::xx, kernel::yy, kernel::xy})
        for (const int i : {-4, -1, 0, 1, 3})
          for (const int j : {0, 1, 2}) {
            if (j >= s.g.ny) continue;
            const double expected = coefficient_by_quadrature(s.g, GetParam().width, k, direction,
                                                              speed, direction * i, j);
            const double sign = k == kernel::xy ? direction : 1;
            EXPECT_NEAR(s.viscous.coefficient(k, -i, j), sign * expected, rounded * top * 10)
                << "kernel " << static_cast<int>(k) << " at " << i << ", " << j << ", speed "
                << speed << ", direction " << direction;
          }
    }
}

TEST_P(Viscous, ProductsAreSumsOverElements) {
  scene s(GetParam());
  const field p = s.random(1), q = s.random(2);
  const int n = s.g.count();
  field u(p.size()), v(p.size()), z(p.size());
  for (const int direction : {1, -1}) {
    s.viscous.set(s.g, direction, 3.0);
    const auto at = [&](kernel k, int observer, int source, int shift) {
      const int i = observer % s.g.nx - source % s.g.nx + shift * direction;
      const int j = observer / s.g.nx - source / s.g.nx;
      const double value = s.viscous.coefficient(k, -direction * i, j);
      return k != kernel::xy ? value : j == 0 ? 0.0 : (j < 0 ? -direction : direction) * value;
    };
    const auto sum = [&](kernel k, const field &f, int observer, int shift) {
      double total = 0;
      for (int m = 0; m < n; ++m) total += at(k, observer, m, shift) * f[static_cast<size_t>(m)];
      return total;
    };
    double top = 0;
    for (int m = 0; m < n; ++m) top += std::abs(at(kernel::xx, n / 2, m, 0));
    s.viscous.normal_product(p.data(), z.data());
    for (int m = 0; m < n; ++m)
      EXPECT_NEAR(z[static_cast<size_t>(m)], sum(kernel::zz, p, m, 0), transformed * top);
    const auto expect_tangential = [&](int shift, double factor) {
      for (int m = 0; m < n; ++m) {
        double x = 0, y = 0;
        for (const int to : {0, shift}) {
          const double sign = to == 0 ? factor : -factor;
          x += sign * (sum(kernel::xx, p, m, to) + sum(kernel::xy, q, m, to));
          y += sign * (sum(kernel::xy, p, m, to) + sum(kernel::yy, q, m, to));
          if (shift == 0) break;
        }
        EXPECT_NEAR(u[static_cast<size_t>(m)], x, transformed * top * factor);
        EXPECT_NEAR(v[static_cast<size_t>(m)], y, transformed * top * factor);
      }
    };
    s.viscous.tangential_product(p.data(), q.data(), u.data(), v.data());
    expect_tangential(0, 1.0);
    s.viscous.rolling_product(p.data(), q.data(), u.data(), v.data());
    expect_tangential(1, 1.0 / s.g.dx);
  }
}

// The power over V: of the slip's differences towards both sides, half each. Bodies that have
// yielded take none.
TEST_P(Viscous, LossIsTheWorkOfCentralDifferences) {
  scene s(GetParam());
  const field p = s.random(3), q = s.random(4);
  field x(p.size()), y(p.size());
  for (const int direction : {1, -1}) {
    s.viscous.set(s.g, direction, 5.0);
    const double loss = s.viscous.tangential_loss(p.data(), q.data());
    s.viscous.rolling_product(p.data(), q.data(), x.data(), y.data());
    double forward = 0, size = 0;
    for (size_t k = 0; k < p.size(); ++k) {
      forward += (p[k] * x[k] + q[k] * y[k]) * s.g.dx * s.g.dy;
      size += (std::abs(p[k] * x[k]) + std::abs(q[k] * y[k])) * s.g.dx * s.g.dy;
    }
    // less half of a second difference, which is positive
    double second = 0;
    for (int m = 0; m < s.g.count(); ++m)
      for (int n = 0; n < s.g.count(); ++n) {
        const int i = direction * (m % s.g.nx - n % s.g.nx), j = m / s.g.nx - n / s.g.nx;
        const auto of = [&](kernel k) {
          const double sign = k != kernel::xy ? 1 : j == 0 ? 0 : j < 0 ? -direction : direction;
          return sign * (2 * s.viscous.coefficient(k, -i, j) - s.viscous.coefficient(k, -i - 1, j) -
                         s.viscous.coefficient(k, -i + 1, j));
        };
        const auto a = static_cast<size_t>(m), b = static_cast<size_t>(n);
        second += p[a] * (of(kernel::xx) * p[b] + of(kernel::xy) * q[b]) +
                  q[a] * (of(kernel::xy) * p[b] + of(kernel::yy) * q[b]);
      }
    EXPECT_NEAR(loss, forward - 0.5 * second * s.g.dy, 1e-10 * size);
    EXPECT_GT(loss, 0);
    EXPECT_GT(second, 0);
    EXPECT_GT(s.viscous.normal_loss(p.data()), 0);
    s.viscous.set(s.g, direction, 0.0);
    EXPECT_NEAR(s.viscous.tangential_loss(p.data(), q.data()), 0, 1e-12 * size);
  }
}

// Slow: compliance (1 + f)/G, fast: 1/G, by the elastic coefficients of such bodies.
TEST_P(Viscous, LimitsAreElasticBodies) {
  scene s(GetParam());
  const elastic_constants yielded = bodies.relaxed();
  influence soft({yielded, 0.0, GetParam().width}, s.plans);
  soft.set_grid(s.g);
  for (const double speed : {0.0, 1e-9}) {
    s.viscous.set(s.g, 1, speed);
    for (const int i : {-3, -1, 0, 1, 2})
      for (const kernel k : {kernel::zz, kernel::xx, kernel::yy})
        EXPECT_NEAR(s.viscous.coefficient(k, i, 0), soft.coefficient(k, i, 0),
                    1e-8 * soft.coefficient(k, 0, 0));
  }
  // of a line contact but for a rigid approach, which grows with ln L
  s.viscous.set(s.g, 1, 1e12);
  for (const kernel k : {kernel::zz, kernel::xx, kernel::yy}) {
    const double size = s.elastic.coefficient(k, 0, 0);
    const double rigid =
        GetParam().width > 0 ? s.viscous.coefficient(k, 0, 0) - s.elastic.coefficient(k, 0, 0) : 0;
    for (const int i : {-3, -1, 0, 1, 2})
      EXPECT_NEAR(s.viscous.coefficient(k, -i, 0) - rigid, s.elastic.coefficient(k, i, 0),
                  1e-8 * size);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Viscous, testing::ValuesIn(sizes),
                         [](const auto &info) { return std::string(info.param.name); });

}  // namespace
