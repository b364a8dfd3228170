// Displacements away from elements' centres, their rates by an element's length, and sums over
// elements: against quadrature, sums of parts, differences and direct sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "half_space/coupling.hpp"
#include "half_space/forces.hpp"
#include "half_space/offset_influence.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;
using field = std::vector<double>;

const elastic_constants steel{82e9, 0.28, 0};
constexpr double close = 1e-11;  // closed form = quadrature or sum, relative to the greatest

// int f from a to b by Gauss-Legendre with five points on each of some panels
template <class F>
double integral(double a, double b, const F &f) {
  constexpr int panels = 24;
  constexpr double at[] = {0.0, 0.53846931010568309, 0.90617984593866399};
  constexpr double weight[] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
  const double half = 0.5 * (b - a) / panels;
  double sum = 0;
  for (int k = 0; k < panels; ++k) {
    const double middle = a + (2 * k + 1) * half;
    sum += weight[0] * f(middle);
    for (int i = 1; i < 3; ++i)
      sum += weight[i] * (f(middle - at[i] * half) + f(middle + at[i] * half));
  }
  return half * sum;
}

struct bodies {
  fft_plans plans;
  influence a;
  bodies(const influence::medium &of, const grid &g)
      : plans({smooth_size(2 * g.nx + 1)}, {g.ny > 1 ? smooth_size(2 * g.ny - 1) : 1}),
        a(of, plans) {
    EXPECT_TRUE(a.set_grid(g));
  }
  std::array<double, 3> at(double x, double y) const {
    double values[3];
    a.bodies_at(x, y, values);
    return {values[0], values[1], values[2]};
  }
};

// --- at any offset -----------------------------------------------------------------------------

TEST(AnyOffset, EqualsTheIntegralOfThePointLoads) {
  const grid g{4, 4, 1e-3, 7e-4, 0, 0};
  for (double nu : {0.0, 0.28, 0.5}) {
    const elastic_constants e{82e9, nu, 0};
    const bodies b({e}, g);
    const double size = b.at(0, 0)[0];
    for (const auto &[x, y] :
         {std::pair{1.7e-3, 0.3e-3}, {-0.9e-3, 1.1e-3}, {0.2e-3, -1.6e-3}, {-2.3e-3, -0.8e-3}}) {
      // displacement at (x, y) of unit traction on the element about the origin (Cerruti)
      const auto over = [&, x = x, y = y](auto &&kernel) {
        return integral(-0.5 * g.dy, 0.5 * g.dy, [&](double v) {
          return integral(-0.5 * g.dx, 0.5 * g.dx, [&](double u) {
            const double r = std::hypot(x - u, y - v);
            return kernel((x - u) / r, (y - v) / r) / (pi * e.shear_modulus * r);
          });
        });
      };
      const auto found = b.at(x, y);
      EXPECT_NEAR(found[0], over([&](double c, double) { return 1 - nu + nu * c * c; }),
                  close * size);
      EXPECT_NEAR(found[1], over([&](double, double s) { return 1 - nu + nu * s * s; }),
                  close * size);
      EXPECT_NEAR(found[2], over([&](double c, double s) { return nu * c * s; }), close * size);
    }
  }
}

// On the grid's own offsets it is the grid's coefficient without the layer; anywhere, edges and
// corners of the element among them, the sum of what four quarters of the element do.
TEST(AnyOffset, AgreesWithTheGridAndWithItsQuarters) {
  for (bool line : {false, true}) {
    const grid g{6, line ? 1 : 5, 1e-3, 7e-4, 0, 0};
    const grid halved{6, g.ny, 0.5 * g.dx, line ? g.dy : 0.5 * g.dy, 0, 0};
    const influence::medium of{steel, 0.0, line ? 0.02 : 0.0};
    const bodies whole(of, g), parts(of, halved);
    const double size = whole.at(0, 0)[0];
    EXPECT_TRUE(std::isfinite(size));
    for (int j = -g.ny + 1; j < g.ny; ++j)
      for (int i = -6; i <= 6; ++i) {
        const auto found = whole.at(i * g.dx, j * g.dy);
        EXPECT_NEAR(found[0], whole.a.coefficient(kernel::xx, i, j), close * size);
        EXPECT_NEAR(found[1], whole.a.coefficient(kernel::yy, i, j), close * size);
        EXPECT_NEAR(found[2], whole.a.coefficient(kernel::xy, i, j), close * size);
      }
    for (double x : {0.0, 0.5 * g.dx, -0.5 * g.dx, 0.25 * g.dx, 0.7 * g.dx, -3.4 * g.dx})
      for (double y : {0.0, 0.5 * g.dy, -0.5 * g.dy, 0.25 * g.dy, -0.9 * g.dy}) {
        if (line && y != 0) continue;
        std::array<double, 3> sum{};
        for (double u : {-0.25 * g.dx, 0.25 * g.dx})
          for (double v : {-0.25 * g.dy, 0.25 * g.dy}) {
            if (line && v > 0) continue;
            const auto part = parts.at(x + u, line ? 0 : y + v);
            for (size_t c = 0; c < 3; ++c) sum[c] += part[c];
          }
        const auto found = whole.at(x, y);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], sum[c], close * size) << x << " " << y;
      }
    if (line) continue;
    // in two steps
    for (double x : {0.0, 0.5e-3, -1.3e-3})
      for (double y : {0.0, 0.35e-3, -2e-3}) {
        double corner[4][3], sum[3], values[3];
        for (int k = 0; k < 4; ++k)
          influence::corner_at(x + (k & 1 ? 0.5 : -0.5) * g.dx, y + (k & 2 ? 0.5 : -0.5) * g.dy,
                               corner[k]);
        for (int c = 0; c < 3; ++c)
          sum[c] = corner[3][c] - corner[2][c] - corner[1][c] + corner[0][c];
        whole.a.from_corners(sum, values);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(values[c], whole.at(x, y)[c], close * size);
      }
  }
}

// Rates of the coefficients, offsets in elements kept, against differences of the coefficients.
TEST(Rates, ByAnElementsLengthAreThoseOfDifferences) {
  const grid g{5, 4, 8e-4, 5e-4, 0, 0};
  const double h = 1e-5 * g.dx;
  grid less = g, more = g;
  less.dx -= h, more.dx += h;
  influence::medium of{steel};
  const bodies before(of, less), after(of, more), plain(of, g);
  of.by_length = true;
  const bodies rates(of, g);
  for (kernel k : {kernel::zz, kernel::xx, kernel::yy, kernel::xy})
    for (int j = -3; j <= 3; ++j)
      for (int i = -4; i <= 4; ++i) {
        const double slope =
            (after.a.coefficient(k, i, j) - before.a.coefficient(k, i, j)) / (2 * h);
        const double size = plain.a.coefficient(kernel::xx, 0, 0) / g.dx;
        EXPECT_NEAR(rates.a.coefficient(k, i, j), slope, 1e-8 * size) << i << " " << j;
      }
}

// --- products at an offset ---------------------------------------------------------------------

field drawn(int n, std::mt19937_64 &random) {
  std::uniform_real_distribution<double> u(-1, 1);
  field f(static_cast<size_t>(n));
  for (double &v : f) v = u(random);
  return f;
}

// as shift_field says: straight between centres
double shifted(const grid &g, const field &f, double elements, double outside, int i, int j) {
  const double at = i + elements;
  double sum = 0, weights = 0;
  for (int k = -1; k <= g.nx; ++k) {
    const double weight = std::max(0.0, 1 - std::abs(at - k));
    const bool inside = k >= 0 && k < g.nx;
    sum += weight * (inside ? f[static_cast<size_t>(j * g.nx + k)] : outside);
    weights += weight;
  }
  return sum + (1 - weights) * outside;
}

TEST(Shift, IsStraightBetweenElements) {
  std::mt19937_64 random(1);
  const grid g{5, 3, 2e-4, 5e-4, 0, 0};
  const field f = drawn(g.count(), random);
  for (double outside : {0.0, -2.5})
    for (double elements :
         {0.0, 1.0, -1.0, 0.25, -0.25, 3.7, -4.5, 4.999, 7.0, -9.5, 1e12, -1e12}) {
      field to(f.size(), 99.0);
      shift_field(g, elements * g.dx, outside, f.data(), to.data());
      for (int j = 0; j < g.ny; ++j)
        for (int i = 0; i < g.nx; ++i)
          EXPECT_NEAR(to[static_cast<size_t>(j * g.nx + i)], shifted(g, f, elements, outside, i, j),
                      1e-12)
              << elements;
    }
}

void expect_product(offset_influence &moved, influence &a, const grid &g, double offset,
                    std::mt19937_64 &random) {
  SCOPED_TRACE(testing::Message() << g.nx << " x " << g.ny << ", " << g.dx << " by " << g.dy
                                  << ", offset " << offset);
  ASSERT_TRUE(a.set_grid(g));
  const field px = drawn(g.count(), random), py = drawn(g.count(), random);
  field ux(px.size(), 1.0), uy(px.size(), 1.0);
  moved.product(a, g, offset, px.data(), py.data(), ux.data(), uy.data());
  const double layer = a.bodies().layer_flexibility;
  double size[3];
  a.bodies_at(0, 0, size);
  const double scale = (std::abs(size[0]) + std::abs(size[1]) + layer) * g.count();
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      double sum[2] = {layer * shifted(g, px, offset / g.dx, 0, i, j),
                       layer * shifted(g, py, offset / g.dx, 0, i, j)};
      for (int n = 0; n < g.ny; ++n)
        for (int m = 0; m < g.nx; ++m) {
          double values[3];
          a.bodies_at((i - m) * g.dx + offset, (j - n) * g.dy, values);
          const auto k = static_cast<size_t>(n * g.nx + m);
          sum[0] += values[0] * px[k] + values[2] * py[k];
          sum[1] += values[2] * px[k] + values[1] * py[k];
        }
      const auto at = static_cast<size_t>(j * g.nx + i);
      EXPECT_NEAR(ux[at], sum[0], 1e-13 * scale);
      EXPECT_NEAR(uy[at], sum[1], 1e-13 * scale);
    }
}

// One after the other with one object, each differing from the one before in one respect.
TEST(OffsetProduct, EqualsTheDirectSum) {
  std::mt19937_64 random(2);
  const fft_plans plans({12, 20, 30}, {1, 10, 16});
  for (double layer : {0.0, 2e-14})
    for (double width : {0.0, 0.02}) {
      influence a({steel, layer, width}, plans);
      offset_influence moved(plans);
      const int ny = width > 0 ? 1 : 5;
      expect_product(moved, a, {5, ny, 4e-4, 6e-4, 0, 0}, 4e-4, random);
      expect_product(moved, a, {5, ny, 4e-4, 6e-4, 0, 0}, -4e-4, random);
      expect_product(moved, a, {5, ny, 4e-4, 6e-4, 0, 0}, 1.3e-4, random);
      expect_product(moved, a, {5, ny, 3e-4, 6e-4, 0, 0}, 1.3e-4, random);
      expect_product(moved, a, {5, ny, 3e-4, 9e-4, 0, 0}, 1.3e-4, random);
      expect_product(moved, a, {4, ny, 3e-4, 9e-4, 0, 0}, 1.3e-4, random);
      expect_product(moved, a, {14, ny, 3e-4, 9e-4, 0, 0}, 1.3e-4, random);
      expect_product(moved, a, {14, ny, 3e-4, 9e-4, 0, 0}, -2.7e-3, random);
      if (width > 0) continue;
      expect_product(moved, a, {14, 8, 3e-4, 9e-4, 0, 0}, -2.7e-3, random);
      expect_product(moved, a, {3, 8, 3e-4, 9e-4, 0, 0}, -2.7e-3, random);
      expect_product(moved, a, {3, 1, 3e-4, 9e-4, 0, 0}, 0.0, random);
    }
}

// From one grid to another, one respect changing at a time.
TEST(OffsetProduct, BetweenGridsEqualsTheDirectSum) {
  std::mt19937_64 random(3);
  const fft_plans plans({12, 20, 30}, {1, 10, 20});
  influence a({steel, 2e-14}, plans);
  offset_influence moved(plans, true);
  grid from{5, 4, 4e-4, 6e-4, 0, 0}, to{7, 3, 4e-4, 6e-4, 0, 0};
  double offset[2] = {1.3e-3, -0.7e-3};
  const auto expect = [&](const char *changed) {
    SCOPED_TRACE(changed);
    ASSERT_TRUE(a.set_grid(to));
    const field px = drawn(from.count(), random), py = drawn(from.count(), random);
    field ux(static_cast<size_t>(to.count()), 1e-13), uy = ux;
    moved.add_moved(a, from, to, offset, 0.6, px.data(), py.data(), ux.data(), uy.data());
    for (int j = 0; j < to.ny; ++j)
      for (int i = 0; i < to.nx; ++i) {
        double sum[2] = {0, 0};
        for (int n = 0; n < from.ny; ++n)
          for (int m = 0; m < from.nx; ++m) {
            const double x = offset[0] + (i - m) * to.dx, y = offset[1] + (j - n) * to.dy;
            const double u = std::abs(x) / to.dx, v = std::abs(y) / to.dy;
            const double layer = u < 1 && v < 1 ? 2e-14 * (1 - u) * (1 - v) : 0;
            double values[3];
            a.bodies_at(x, y, values);
            const auto k = static_cast<size_t>(n * from.nx + m);
            sum[0] += (values[0] + layer) * px[k] + values[2] * py[k];
            sum[1] += values[2] * px[k] + (values[1] + layer) * py[k];
          }
        const auto at = static_cast<size_t>(j * to.nx + i);
        EXPECT_NEAR(ux[at], 1e-13 + 0.6 * sum[0], 1e-25) << i << " " << j;
        EXPECT_NEAR(uy[at], 1e-13 + 0.6 * sum[1], 1e-25) << i << " " << j;
      }
  };
  expect("first");
  offset[0] = -0.4e-3, expect("offset along");
  offset[1] = 0.9e-3, expect("offset across");
  from.nx = 4, expect("columns before");
  from.nx = 6, expect("more columns before");
  from.ny = 3, expect("rows before");
  from.ny = 5, expect("more rows before");
  to.nx = 6, expect("columns now");
  to.nx = 8, expect("more columns now");
  to.ny = 4, expect("rows now");
  to.ny = 2, expect("fewer rows now");
  from.dx = to.dx = 3e-4, expect("length");
  from.dy = to.dy = 7e-4, expect("width");
  to.nx = 13, expect("size along");
  from.ny = 9, expect("size across");
  from.ny = to.ny = 1, expect("one row");
  offset[0] = offset[1] = 0, expect("no offset");
}

// --- resultants --------------------------------------------------------------------------------

// The wrench of element forces, each at its place, pressure along -n.
TEST(Wrench, IsTheSumOfForcesAndOfTheirMoments) {
  std::mt19937_64 random(4);
  const grid g{4, 3, 2e-3, 3e-3, -1e-3, 5e-3};
  const field p = drawn(12, random), px = drawn(12, random), py = drawn(12, random);
  double force[3] = {0, 0, 0}, moment[3] = {0, 0, 0};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      const auto at = static_cast<size_t>(j * 4 + i);
      const double area = 6e-6, r[3] = {-1e-3 + 2e-3 * i, 5e-3 + 3e-3 * j, 0};
      const double f[3] = {area * px[at], area * py[at], -area * p[at]};
      for (int k = 0; k < 3; ++k) {
        force[k] += f[k];
        moment[k] += r[(k + 1) % 3] * f[(k + 2) % 3] - r[(k + 2) % 3] * f[(k + 1) % 3];
      }
    }
  const patch_wrench w = sum_tractions(g, p.data(), px.data(), py.data());
  const patch_wrench normal = sum_tractions(g, p.data(), nullptr, nullptr);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(w.force[k], force[k], 1e-18);
    EXPECT_NEAR(w.moment[k], moment[k], 1e-20);
    EXPECT_NEAR(normal.force[k], k == 2 ? force[2] : 0, 1e-18);
    EXPECT_NEAR(normal.moment[k], k < 2 ? moment[k] : 0, 1e-20);
  }
}

// At the wheelset's centre: turned by matrices, about x and then about y, and moved by the lever.
TEST(Wrench, MovesToTheWheelsetsCentre) {
  std::mt19937_64 random(5);
  for (double inclination : {0.0, 0.03, -0.4})
    for (double angle : {0.0, 0.3, -1.1}) {
      const field f = drawn(3, random), m = drawn(3, random), r = drawn(3, random);
      const double c = std::cos(angle), s = std::sin(angle);
      const double d = std::cos(inclination), t = std::sin(inclination);
      const double about_x[3][3] = {{1, 0, 0}, {0, c, -s}, {0, s, c}};
      const double about_y[3][3] = {{d, 0, -t}, {0, 1, 0}, {t, 0, d}};
      const auto turned = [&](const field &v) {
        field once(3, 0.0), twice(3, 0.0);
        for (size_t i = 0; i < 3; ++i)
          for (size_t k = 0; k < 3; ++k) once[i] += about_x[i][k] * v[k];
        for (size_t i = 0; i < 3; ++i)
          for (size_t k = 0; k < 3; ++k) twice[i] += about_y[i][k] * once[k];
        return twice;
      };
      const field force = turned(f), moment = turned(m);
      patch_wrench w{};
      std::copy_n(f.data(), 3, w.force);
      std::copy_n(m.data(), 3, w.moment);
      double found_force[3] = {1, 2, 3}, found_moment[3] = {4, 5, 6};
      add_wrench(w, angle, r.data(), found_force, found_moment, inclination);
      for (size_t k = 0; k < 3; ++k) {
        const size_t l = (k + 1) % 3, n = (k + 2) % 3;
        EXPECT_NEAR(found_force[k], 1.0 + static_cast<double>(k) + force[k], 1e-14);
        EXPECT_NEAR(found_moment[k],
                    4.0 + static_cast<double>(k) + moment[k] + r[l] * force[n] - r[n] * force[l],
                    1e-14);
      }
    }
}

TEST(Bodies, CombineByTheirCompliances) {
  const double g[2] = {82e9, 1e6}, nu[2] = {0.28, 0.45};
  const elastic_constants e = combine(g, nu);
  EXPECT_NEAR(1 / e.shear_modulus, 0.5 * (1 / g[0] + 1 / g[1]), 1e-15 / g[1]);
  EXPECT_NEAR(e.poisson_ratio / e.shear_modulus, 0.5 * (nu[0] / g[0] + nu[1] / g[1]), 1e-15 / g[1]);
  EXPECT_NEAR(e.mismatch / e.shear_modulus,
              0.25 * ((1 - 2 * nu[0]) / g[0] - (1 - 2 * nu[1]) / g[1]), 1e-15 / g[1]);
  EXPECT_TRUE(is_coupled(e));
  for (double poisson : {0.0, 0.28, 0.3, 0.5}) {
    const double alike[2] = {poisson, poisson}, equal[2] = {79.3e9, 79.3e9};
    EXPECT_FALSE(is_coupled(combine(equal, alike)));
  }
  EXPECT_TRUE(is_coupled({82e9, 0.28, 1e-9}));
  EXPECT_TRUE(is_coupled({82e9, 0.28, -1e-9}));
}

}  // namespace
