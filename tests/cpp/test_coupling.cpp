// Coupling of normal and tangential directions of unlike bodies: displacements by FFT against
// direct sums of the point-load solutions (Boussinesq; Cerruti), integrated over the elements by
// quadrature.
#include "half_space/coupling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace railpatch;
using std::numbers::pi;
using field = std::vector<double>;

constexpr double imposed = 1e-11;  // relative to the greatest displacement

// rubber on steel, and the other way round
const double shear_modulus[] = {1e6, 82e9}, poisson_ratio[] = {0.3, 0.28};

elastic_constants bodies(bool exchanged = false) {
  const double g[] = {shear_modulus[exchanged], shear_modulus[!exchanged]};
  const double nu[] = {poisson_ratio[exchanged], poisson_ratio[!exchanged]};
  return combine(g, nu);
}

// int f from a to b by Gauss-Legendre with five points on each of many panels
template <class F>
double integral(double a, double b, const F &f) {
  constexpr int panels = 64;
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

// The integral of x/r^2 over the element around (x, y), the inner one in closed form.
double over_element(double x, double y, double dx, double dy) {
  return integral(y - 0.5 * dy, y + 0.5 * dy, [&](double v) {
    const double near = x - 0.5 * dx, far = x + 0.5 * dx;
    return 0.5 * std::log((far * far + v * v) / (near * near + v * v));
  });
}

// (u_x, u_y) at (x, y) from the middle of an element of unit pressure. A point load P draws a
// body's surface towards it by (1 - 2 nu)/(4 pi G) P/r (Johnson 1985, eq. 3.18); wheel minus rail
// counts.
std::array<double, 2> by_quadrature(double x, double y, const grid &g, bool line, bool exchanged) {
  double factor = 0;
  for (int body = 0; body < 2; ++body) {
    const int k = exchanged ? 1 - body : body;
    factor -= (body == 0 ? 1 : -1) * (1 - 2 * poisson_ratio[k]) / (4 * pi * shear_modulus[k]);
  }
  if (line) {
    // pi sign(x) is the integral of x/r^2 over y
    const double ahead = std::clamp(x / g.dx + 0.5, 0.0, 1.0);
    return {factor * pi * g.dx * (2 * ahead - 1), 0.0};
  }
  return {factor * over_element(x, y, g.dx, g.dy), factor * over_element(y, x, g.dy, g.dx)};
}

struct size_case {
  const char *name;
  grid g;
  bool line;
};

const size_case sizes[] = {
    {"square", {7, 7, 1e-3, 1e-3, 0, 0}, false},
    {"long", {11, 4, 2e-4, 9e-4, 0, 0}, false},
    {"wide", {3, 9, 1e-3, 3e-4, 0, 0}, false},
    {"line", {21, 1, 1e-4, 0.02, 0, 0}, true},
    // any unit of length will do
    {"large", {5, 4, 2.0, 2.0, 0, 0}, false},
};

class Coupling : public testing::TestWithParam<size_case> {
 protected:
  const grid g = GetParam().g;
  const bool line = GetParam().line;
  fft_plans plans{{smooth_size(2 * g.nx + 1)}, {g.ny > 1 ? smooth_size(2 * g.ny - 1) : 1}};
  std::mt19937_64 random{20241121};

  coupling_influence made(bool exchanged = false) const {
    coupling_influence c(bodies(exchanged), line, plans);
    EXPECT_TRUE(c.set_grid(g));
    return c;
  }
  field zeros() const { return field(static_cast<size_t>(g.count())); }
  field any() {
    std::uniform_real_distribution<double> u(-1e6, 1e6);
    field f = zeros();
    for (double &v : f) v = u(random);
    return f;
  }
  std::array<field, 2> direct(const field &p, double offset, bool exchanged = false) const {
    std::array<field, 2> u{zeros(), zeros()};
    for (int to = 0; to < g.count(); ++to)
      for (int from = 0; from < g.count(); ++from) {
        const int i = to % g.nx - from % g.nx, j = to / g.nx - from / g.nx;
        const auto k = by_quadrature(i * g.dx + offset, j * g.dy, g, line, exchanged);
        for (size_t c = 0; c < 2; ++c)
          u[c][static_cast<size_t>(to)] += k[c] * p[static_cast<size_t>(from)];
      }
    return u;
  }
  static double largest(const field &f) {
    double size = 0;
    for (double v : f) size = std::max(size, std::fabs(v));
    return size;
  }
  static void expect_near(const field &found, const field &expected, double scale) {
    for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], imposed * scale);
  }
};

TEST_P(Coupling, PressureMovesTheSurfacesAlongEachOther) {
  const field p = any();
  coupling_influence c = made();
  // at the elements, one element on either side, and between
  for (double offset : {0.0, g.dx, -g.dx, 0.3 * g.dx, -2.7 * g.dx}) {
    const auto u = direct(p, offset);
    const double scale = largest(u[0]);
    field ux = zeros(), uy = zeros();
    c.from_pressure(offset, p.data(), ux.data(), uy.data());
    expect_near(ux, u[0], scale);
    expect_near(uy, u[1], scale);
  }
}

TEST_P(Coupling, ExchangedBodiesChangeTheSign) {
  const field p = any();
  coupling_influence c = made(), exchanged = made(true);
  field ux = zeros(), uy = zeros(), vx = zeros(), vy = zeros();
  c.from_pressure(0.0, p.data(), ux.data(), uy.data());
  exchanged.from_pressure(0.0, p.data(), vx.data(), vy.data());
  for (size_t i = 0; i < ux.size(); ++i) {
    EXPECT_EQ(ux[i], -vx[i]);
    EXPECT_EQ(uy[i], -vy[i]);
  }
  expect_near(vx, direct(p, 0.0, true)[0], largest(vx));
}

// Maxwell and Betti: the work of the pressure on what the tractions move, and the other way round.
TEST_P(Coupling, IsReciprocal) {
  const field p = any(), px = any(), py = any();
  coupling_influence c = made();
  field ux = zeros(), uy = zeros(), un = zeros();
  c.from_pressure(0.0, p.data(), ux.data(), uy.data());
  c.from_traction(px.data(), py.data(), un.data());
  double one = 0, other = 0, size = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    one += px[i] * ux[i] + py[i] * uy[i];
    other += p[i] * un[i];
    size += std::fabs(p[i] * un[i]);
  }
  EXPECT_NEAR(one, other, imposed * size);
  // element by element: the transpose of the pressure's kernels
  field unit = zeros();
  for (size_t from = 0; from < p.size(); ++from) {
    std::fill(unit.begin(), unit.end(), 0.0);
    unit[from] = 1;
    c.from_pressure(0.0, unit.data(), ux.data(), uy.data());
    double sum = 0;
    for (size_t i = 0; i < p.size(); ++i) sum += px[i] * ux[i] + py[i] * uy[i];
    EXPECT_NEAR(un[from], sum, imposed * largest(un));
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Coupling, testing::ValuesIn(sizes),
                         [](const auto &info) { return std::string(info.param.name); });

TEST(CouplingGrids, TheirOrderMakesNoDifference) {
  fft_plans plans({16, 32, 64}, {16, 32, 64});
  coupling_influence used(bodies(), false, plans), fresh(bodies(), false, plans);
  const grid small{6, 7, 1e-3, 1e-3, 0, 0}, large{25, 30, 1e-3, 1e-3, 0, 0};
  field p(42), ux(42), uy(42), vx(42), vy(42), big(750), any(750);
  for (size_t i = 0; i < p.size(); ++i) p[i] = std::sin(static_cast<double>(i));
  ASSERT_TRUE(used.set_grid(large));
  used.from_pressure(2e-3, big.data(), any.data(), any.data());
  ASSERT_TRUE(used.set_grid(small));
  ASSERT_TRUE(fresh.set_grid(small));
  for (double offset : {2e-3, 0.0, -5e-4}) {
    used.from_pressure(offset, p.data(), ux.data(), uy.data());
    fresh.from_pressure(offset, p.data(), vx.data(), vy.data());
    EXPECT_EQ(ux, vx);
    EXPECT_EQ(uy, vy);
  }
  EXPECT_FALSE(used.set_grid({40, 7, 1e-3, 1e-3, 0, 0})) << "larger than every plan";
}

}  // namespace
