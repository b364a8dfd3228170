// The normal problem and its derivatives by their equations: every sum over elements is written out
// from single coefficients, without transforms.
#include "normal/normal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "normal/normal_derivative.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

constexpr elastic_constants steel{8.2e10, 0.28, 0.0};
constexpr double tolerance = 1e-9;
// sums by transforms
constexpr double rounded = 1e-11;

double sum_of(const std::vector<double> &v) {
  double sum = 0;
  for (double x : v) sum += x;
  return sum;
}

// Three contact areas in one another's reach, on elements of unequal sides.
struct scene {
  grid g{17, 12, 7e-4, 9e-4, -5.9e-3, -4.7e-3};
  contact_parts parts;
  std::vector<double> h;
  double line_width = 0;

  explicit scene(bool separate) {
    if (separate) {
      parts.count = 3;
      parts.first_row[1] = 4;
      parts.first_row[2] = 9;
      parts.factor[0] = 0.6;
      parts.factor[1] = 0.35;
    }
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const double x = g.x(i) - 2e-4 - 0.05 * g.y(j), y = g.y(j);
        h.push_back(1.2 * x * x + 5e-6 * std::cos(y * 2 * pi / 4e-3) + 0.1 * y * y - 3e-6);
      }
  }
  static scene line() {
    scene s(false);
    s.g.ny = 1;
    s.g.nx = 23;
    s.line_width = s.g.dy = 5e-3;
    s.h.clear();
    for (int i = 0; i < s.g.nx; ++i) s.h.push_back(0.9 * s.g.x(i) * s.g.x(i) + 2e-3 * s.g.x(i));
    return s;
  }
  size_t count() const { return static_cast<size_t>(g.count()); }
  influence::medium medium() const {
    influence::medium m{steel};
    m.line_width = line_width;
    return m;
  }
  int part_of(int j) const {
    int k = 0;
    while (k + 1 < parts.count && j >= parts.first_row[k + 1]) ++k;
    return k;
  }
  // Of the parts of two rows.
  double factor(int j, int other) const {
    const int k = part_of(j), l = part_of(other);
    double f = 1;
    for (int m = 0; m + 1 < parts.count; ++m)
      if ((m >= k && m < l) || (m >= l && m < k)) f *= parts.factor[m];
    return f;
  }
  // A, element by element.
  std::vector<double> product(const std::vector<double> &p) const {
    fft_plans plans({smooth_size(2 * g.nx)}, {g.ny == 1 ? 1 : smooth_size(2 * g.ny)});
    influence a(medium(), plans);
    EXPECT_TRUE(a.set_grid(g));
    std::vector<double> u(count());
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        for (int l = 0; l < g.ny; ++l)
          for (int k = 0; k < g.nx; ++k)
            u[static_cast<size_t>(j * g.nx + i)] += factor(j, l) *
                                                    a.coefficient(kernel::zz, i - k, j - l) *
                                                    p[static_cast<size_t>(l * g.nx + k)];
    return u;
  }
};

struct solved {
  normal_result r;
  std::vector<double> p;
};

struct machine {
  scene s;
  fft_plans plans;
  influence a;
  normal_solver solver;
  explicit machine(const scene &of)
      : s(of),
        plans({smooth_size(2 * of.g.nx)}, {of.g.ny == 1 ? 1 : smooth_size(2 * of.g.ny)}),
        a(of.medium(), plans),
        // room for more elements than there are, or for just as many
        solver(of.g.count() + (of.line_width > 0 ? 0 : 5)) {
    EXPECT_TRUE(a.set_grid(s.g));
  }
  solved with(bool force, double value, int most = 200, std::vector<double> start = {}) {
    if (start.empty()) start.resize(s.count());
    solved out{{}, start};
    const normal_options o{tolerance, most};
    out.r = force ? solver.with_force(a, s.g, s.h.data(), value, o, out.p.data(), s.parts)
                  : solver.with_approach(a, s.g, s.h.data(), value, o, out.p.data(), s.parts);
    return out;
  }
};

// What the result says of itself, and whether it is true.
void expect_conditions(const scene &s, const solved &found) {
  const std::vector<double> u = s.product(found.p);
  const double scale = *std::max_element(u.begin(), u.end());
  double worst = 0;
  int loaded = 0;
  bool border = false;
  for (size_t i = 0; i < u.size(); ++i) {
    const double e = s.h[i] + u[i] - found.r.approach;
    const int x = static_cast<int>(i) % s.g.nx, y = static_cast<int>(i) / s.g.nx;
    ASSERT_GE(found.p[i], 0) << i;
    if (found.p[i] > 0) {
      ++loaded;
      worst = std::max(worst, std::fabs(e));
      border = border || x == 0 || x == s.g.nx - 1;
      border = border || (s.g.ny > 1 && (y == 0 || y == s.g.ny - 1));
    } else {
      worst = std::max(worst, -e);
    }
  }
  EXPECT_EQ(found.r.contact_count, loaded);
  EXPECT_EQ(found.r.touches_border, border);
  EXPECT_NEAR(found.r.scale, scale, rounded * scale);
  EXPECT_NEAR(found.r.residual, worst / scale, rounded);
  EXPECT_EQ(found.r.converged, found.r.residual <= tolerance);
  const double force = sum_of(found.p) * s.g.dx * s.g.dy;
  EXPECT_NEAR(found.r.normal_force, force, 1e-13 * force);
}

std::vector<scene> scenes() { return {scene(false), scene(true), scene::line()}; }

TEST(Normal, SolutionsMeetTheirConditions) {
  for (const scene &s : scenes()) {
    machine m(s);
    for (double force : {30.0, 3e3, 2e5}) {
      const solved found = m.with(true, force);
      SCOPED_TRACE(std::to_string(s.parts.count) + " " + std::to_string(force));
      ASSERT_TRUE(found.r.converged) << found.r.residual;
      EXPECT_NEAR(found.r.normal_force, force, tolerance * force);
      expect_conditions(s, found);
      // a method that converges with the root of the condition: far fewer than elements
      EXPECT_LE(found.r.iterations, 40);
      // the solution is where it ends
      const solved again = m.with(true, force, 200, found.p);
      EXPECT_EQ(again.r.iterations, 0);
      // and the approach found gives the force
      const solved near = m.with(false, found.r.approach);
      ASSERT_TRUE(near.r.converged);
      expect_conditions(s, near);
      EXPECT_EQ(near.r.approach, found.r.approach);
      EXPECT_NEAR(near.r.normal_force, force, 1e-6 * force);
      EXPECT_LE(near.r.iterations, 40);
      EXPECT_EQ(m.with(false, found.r.approach, 200, near.p).r.iterations, 0);
      // a start that has no part in the solution
      std::vector<double> corner(s.count());
      corner[0] = 1e8;
      const solved elsewhere = m.with(true, force, 200, corner);
      ASSERT_TRUE(elsewhere.r.converged);
      expect_conditions(s, elsewhere);
    }
  }
}

TEST(Normal, SaysWhereItDidNotConverge) {
  for (const scene &s : scenes()) {
    machine m(s);
    for (int most : {0, 1, 2}) {
      const solved found = m.with(true, 2e4, most);
      EXPECT_FALSE(found.r.converged);
      EXPECT_EQ(found.r.iterations, most);
      EXPECT_GT(found.r.residual, tolerance);
      EXPECT_NEAR(found.r.normal_force, 2e4, tolerance * 2e4);
    }
  }
}

TEST(Normal, WithoutContactThereIsNothing) {
  for (const scene &s : scenes()) {
    machine m(s);
    const double lowest = *std::min_element(s.h.begin(), s.h.end());
    for (double above : {0.0, 1e-6}) {
      const solved none = m.with(false, lowest - above);
      EXPECT_TRUE(none.r.converged);
      EXPECT_EQ(none.r.contact_count, 0);
      EXPECT_EQ(none.r.normal_force, 0);
      EXPECT_EQ(none.r.residual, 0);
      EXPECT_EQ(none.r.iterations, 0);
      EXPECT_FALSE(none.r.touches_border);
    }
    // flat bodies: all touches
    scene flat = s;
    std::fill(flat.h.begin(), flat.h.end(), 1e-6);
    machine even(flat);
    const solved all = even.with(true, 1e4);
    EXPECT_TRUE(all.r.converged);
    EXPECT_EQ(all.r.contact_count, flat.g.count());
    EXPECT_TRUE(all.r.touches_border);
    expect_conditions(flat, all);
  }
}

// Each side of the grid by itself.
TEST(Normal, TouchesTheBorder) {
  for (int side = 0; side < 5; ++side) {
    scene s(false);
    const double x = side == 0 ? s.g.x(0) : side == 1 ? s.g.x(16) : 0.0;
    const double y = side == 2 ? s.g.y(0) : side == 3 ? s.g.y(11) : 0.0;
    for (int j = 0; j < s.g.ny; ++j)
      for (int i = 0; i < s.g.nx; ++i)
        s.h[static_cast<size_t>(j * s.g.nx + i)] =
            3 * std::pow(s.g.x(i) - x, 2) + 2 * std::pow(s.g.y(j) - y, 2);
    machine m(s);
    const solved found = m.with(true, 3e3);
    EXPECT_TRUE(found.r.converged);
    EXPECT_EQ(found.r.touches_border, side < 4);
    expect_conditions(s, found);
  }
}

TEST(Normal, ProductOfParts) {
  for (const scene &s : scenes()) {
    machine m(s);
    std::vector<double> p(s.count()), exact(p), single(p);
    for (size_t i = 0; i < p.size(); ++i) p[i] = 1e8 * (1 + std::sin(2.7 * static_cast<double>(i)));
    const std::vector<double> wanted = s.product(p);
    const double top = *std::max_element(wanted.begin(), wanted.end());
    m.solver.product(m.a, s.g, s.parts, p.data(), exact.data(), true);
    m.solver.product(m.a, s.g, s.parts, p.data(), single.data(), false);
    for (size_t i = 0; i < p.size(); ++i) {
      EXPECT_NEAR(exact[i], wanted[i], rounded * top);
      EXPECT_NEAR(single[i], wanted[i], 1e-5 * top);
    }
  }
}

// --- derivatives -----------------------------------------------------------------------------

// d(A p) by the elements' size and the factors, by differences of the coefficients.
std::vector<double> operator_rate(const scene &s, const normal_variation &v,
                                  const std::vector<double> &p) {
  const double h = 1e-3;
  const auto moved = [&](double t) {
    scene other = s;
    other.g.dx += t * v.size[0];
    other.g.dy += t * v.size[1];
    for (int k = 0; k + 1 < s.parts.count; ++k) other.parts.factor[k] += t * v.factor[k];
    return other.product(p);
  };
  const auto p1 = moved(h), m1 = moved(-h), p2 = moved(2 * h), m2 = moved(-2 * h);
  std::vector<double> rate(p.size());
  for (size_t i = 0; i < rate.size(); ++i)
    rate[i] = (8 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12 * h);
  return rate;
}

TEST(NormalDerivative, RatesMeetTheDifferentiatedConditions) {
  for (const scene &s : scenes())
    for (bool force : {true, false}) {
      machine m(s);
      influence::medium medium = s.medium();
      medium.by_length = true;
      influence by_length(medium, m.plans);
      const bool is_line = s.line_width > 0;
      if (!is_line) {
        ASSERT_TRUE(by_length.set_grid(s.g));
      }
      const solved found = m.with(force, force ? 2e4 : m.with(true, 2e4).r.approach);
      ASSERT_TRUE(found.r.converged);
      const double scale = found.r.scale, load = found.r.normal_force;
      std::vector<double> tilt(s.count());
      for (size_t i = 0; i < tilt.size(); ++i)
        tilt[i] = scale * std::cos(0.7 * static_cast<double>(i));
      std::vector<normal_variation> in(8);
      in[0].distance = tilt.data();
      in[1].size[0] = 0.5 * s.g.dx;
      in[2].size[1] = is_line ? 0.0 : -0.4 * s.g.dy;
      in[3].factor[0] = 0.3;
      in[4].factor[1] = s.parts.count > 1 ? 0.5 : 0.0;
      in[5].force = 0.7 * load;
      in[5].approach = 0.6 * scale;
      in[7] = {tilt.data(),
               {0.2 * s.g.dx, is_line ? 0.0 : 0.3 * s.g.dy},
               {0.1, -0.2},
               -0.3 * load,
               0.2 * scale};
      const int count = static_cast<int>(in.size());
      normal_derivative derivative(s.g.count() + 3, count);
      std::vector<double> rates(in.size() * s.count(), 5.0), approach(in.size(), 5.0);
      const double residual = derivative.solve(
          {m.a, is_line ? nullptr : &by_length, m.solver, s.g, s.parts, force, found.p.data()},
          in.data(), count, 1e-9, rates.data(), approach.data());
      EXPECT_LE(residual, 1e-9);
      EXPECT_GT(derivative.products(), 0);
      EXPECT_LT(derivative.products(), 250);
      double pressure = *std::max_element(found.p.begin(), found.p.end());
      for (size_t k = 0; k < in.size(); ++k) {
        SCOPED_TRACE(std::to_string(s.parts.count) + (force ? " force " : " approach ") +
                     std::to_string(k));
        const std::vector<double> rate(rates.begin() + static_cast<ptrdiff_t>(k * s.count()),
                                       rates.begin() + static_cast<ptrdiff_t>((k + 1) * s.count()));
        const std::vector<double> u = s.product(rate), moved = operator_rate(s, in[k], found.p);
        double largest = 0;
        for (size_t i = 0; i < rate.size(); ++i) {
          largest = std::max(largest, std::fabs(rate[i]));
          if (found.p[i] <= 0) {
            ASSERT_EQ(rate[i], 0);
            continue;
          }
          const double shift = in[k].distance ? in[k].distance[i] : 0.0;
          ASSERT_NEAR(u[i] + moved[i] + shift, approach[k], 1e-7 * scale) << i;
        }
        if (force) {
          const double area = s.g.dx * s.g.dy;
          const double grown = in[k].size[0] / s.g.dx + in[k].size[1] / s.g.dy;
          const double change = sum_of(rate) * area + load * grown;
          EXPECT_NEAR(change, in[k].force, 1e-9 * load);
        } else {
          EXPECT_EQ(approach[k], in[k].approach);
        }
        // what moves nothing gives nothing, anything else something
        const bool still =
            k == 6 || (k == 2 && is_line) || ((k == 3 || k == 4) && s.parts.count == 1);
        EXPECT_EQ(largest < 1e-12 * pressure, still);
      }
    }
}

TEST(NormalDerivative, NothingMoves) {
  const scene s(true);
  machine m(s);
  const solved found = m.with(true, 2e4);
  normal_derivative derivative(s.g.count(), 2);
  std::vector<normal_variation> in(2);
  in[0].approach = 1;  // not what is prescribed
  std::vector<double> rates(2 * s.count(), 5.0), approach(2, 5.0);
  EXPECT_EQ(derivative.solve({m.a, nullptr, m.solver, s.g, s.parts, true, found.p.data()},
                             in.data(), 2, 1e-9, rates.data(), approach.data()),
            0);
  EXPECT_EQ(derivative.products(), 0);
  for (double r : rates) EXPECT_EQ(r, 0);
  for (double a : approach) EXPECT_EQ(a, 0);
}

// Pressure of one depth is that of another but for its size, on elements that have grown with the
// contact: what a wheel's grid does. Nothing is left to iterate.
TEST(Normal, AStartOfTheRightShapeHasTheRightSizeAtOnce) {
  const fft_plans plans({48}, {40});
  influence a({steel}, plans);
  normal_solver solver(400);
  std::vector<double> p(400), h(400);
  for (const double growth : {1.0, 1.3, 0.6}) {
    grid g{20, 20, 5e-4 * growth, 7e-4 * growth, -4.75e-3 * growth, -6.65e-3 * growth};
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        h[static_cast<size_t>(j * g.nx + i)] = 1.1 * g.x(i) * g.x(i) + 0.5 * g.y(j) * g.y(j);
    ASSERT_TRUE(a.set_grid(g));
    // the first one better than the others are asked for
    const normal_options options{growth == 1.0 ? 1e-10 : 1e-8, 200, {}, false, true};
    const normal_result found =
        solver.with_approach(a, g, h.data(), 2e-5 * growth * growth, options, p.data());
    EXPECT_TRUE(found.converged);
    if (growth == 1.0)
      EXPECT_GT(found.iterations, 0);
    else
      EXPECT_EQ(found.iterations, 0) << growth;
  }
}

}  // namespace
