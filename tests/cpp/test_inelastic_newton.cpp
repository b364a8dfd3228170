// The Newton method of inelastic laws on elements that do not feel each other, where each of them
// can be solved by itself; and the plastic displacement that material carries along a row.
#include "tangential/inelastic_newton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "dense_operator.hpp"
#include "tangential/tangential.hpp"

namespace {

using namespace railpatch;
using dense::dense_operator, dense::lengths, dense::without_steps;
using field = std::vector<double>;

constexpr double tolerance = 1e-10;

// s = w + p of each element by itself, in units of 1
struct lone_elements {
  std::mt19937_64 random;
  dense_operator b{0.0, random};
  size_t n = b.size() / 2;
  field friction = field(n), area = field(n), rigid = field(2 * n), p = field(2 * n, 0.0),
        s = field(2 * n), found = field(n);
  std::vector<carried_state> before{n, carried_state{{0, 0, 0}}}, after{n};
  std::vector<unsigned char> state = std::vector<unsigned char>(n);

  lone_elements(unsigned seed, double unit_area, double unit_slip) : random(seed) {
    std::uniform_real_distribution<double> unit(0, 1);
    for (double &v : friction) v = unit_slip * (0.5 + unit(random));
    for (double &v : area) v = unit_area * (0.5 + unit(random));
    for (size_t k = 0; k < n; ++k) {
      const double size = friction[k] * (0.2 + unit(random)), angle = 6.283 * unit(random);
      rigid[x(k)] = size * std::cos(angle);
      rigid[y(k)] = size * std::sin(angle);
    }
  }
  size_t row(size_t k) const {
    size_t j = 0;
    while (static_cast<int>(k) >= b.start()[j + 1]) ++j;
    return j;
  }
  size_t x(size_t k) const { return k + static_cast<size_t>(b.start()[row(k)]); }
  size_t y(size_t k) const { return x(k) + static_cast<size_t>(lengths[row(k)]); }

  inelastic_result solve(const bound_law &law, bool carried) {
    return solve(b, law, carried, {tolerance, 400});
  }
  inelastic_result solve(rolling_operator &of, const bound_law &law, bool carried,
                         const tangential_options &options) {
    inelastic_newton newton(12, static_cast<int>(lengths.size()), false);
    const rolling_problem problem{static_cast<int>(lengths.size()),
                                  b.start().data(),
                                  friction.data(),
                                  area.data(),
                                  rigid.data(),
                                  p.data(),
                                  s.data()};
    inelastic_problem inelastic;
    inelastic.law = &law;
    inelastic.before = carried ? nullptr : before.data();
    inelastic.after = after.data();
    inelastic.friction = found.data();
    inelastic.state = state.data();
    return newton.solve(of, problem, inelastic, options);
  }
};

// Friction that falls with the slip's speed, faster than some elements can follow.
bound_law falling(double unit_slip) {
  bound_law law;
  law.by_velocity = true;
  law.speed = 1;
  law.slip.kinetic = 0.2;
  law.slip.amplitude[0] = 0.3;
  law.slip.halving_speed[0] = 0.05 * unit_slip;
  return law;
}

// How many tractions there are for an element follows from changes of sign, finely sampled.
TEST(InelasticNewton, CountsElementsOfSeveralSolutions) {
  int all = 0;
  for (unsigned seed = 0; seed < 3; ++seed)
    for (bool carried : {false, true}) {
      // forces, slip and stress in any unit
      const double unit_area = seed == 1 ? 1e-6 : 1.0, unit_slip = seed == 2 ? 1e6 : 1.0;
      const bound_law law = falling(unit_slip);
      const auto coefficient = [&](double speed) {
        double slope;
        return law.slip.coefficient(speed, slope);
      };
      lone_elements e(seed, unit_area, unit_slip);
      const double near = 1e-8 * unit_slip;
      const inelastic_result result = e.solve(law, carried);
      ASSERT_TRUE(result.tangential.converged) << result.tangential.residual;
      int ambiguous = 0, stick = 0;
      double dissipated = 0, supplied = 0;
      for (size_t k = 0; k < e.n; ++k) {
        const double px = e.p[e.x(k)], py = e.p[e.y(k)], sx = e.s[e.x(k)], sy = e.s[e.y(k)];
        const double size = std::hypot(e.rigid[e.x(k)], e.rigid[e.y(k)]);
        const double traction = std::hypot(px, py), slip = std::hypot(sx, sy);
        const double rest = e.friction[k] * coefficient(0);
        // where it slips, |p| = size - |s|
        int solutions = size <= rest;
        constexpr int samples = 400;
        bool above = size > rest;
        for (int i = 1; i <= samples; ++i) {
          const double at = size * i / samples;
          const bool now = size - at > e.friction[k] * coefficient(at);
          solutions += now != above;
          above = now;
        }
        ambiguous += solutions > 1;
        // and the one found is one of them
        stick += e.state[k] == RP_STICK;
        if (e.state[k] == RP_STICK)
          EXPECT_LE(traction, rest * (1 + 1e-9));
        else
          EXPECT_NEAR(traction, e.friction[k] * coefficient(slip), near);
        EXPECT_NEAR(traction, size - slip, near) << "element " << k;
        dissipated -= e.area[k] * (px * sx + py * sy);
        supplied -= e.area[k] * (px * e.rigid[e.x(k)] + py * e.rigid[e.y(k)]);
        EXPECT_NEAR(px * sx + py * sy, -traction * slip, near * unit_slip) << "opposite";
      }
      all += ambiguous;
      EXPECT_EQ(result.ambiguous, ambiguous) << "carried along: " << carried;
      EXPECT_EQ(result.tangential.stick, stick);
      EXPECT_EQ(result.tangential.slip, static_cast<int>(e.n) - stick);
      // of states carried along rows the supply of the rigid motion is what is dissipated
      EXPECT_NEAR(result.tangential.friction, carried ? supplied : dissipated,
                  10 * near * unit_area * unit_slip);
    }
  EXPECT_GT(all, 10);
}

// Element by element, along each row, is all it takes here: where the linear systems break down the
// safeguard's first round ends it.
TEST(InelasticNewton, SweepsOverElements) {
  const bound_law law = falling(1);
  for (unsigned seed = 0; seed < 3; ++seed)
    for (bool carried : {false, true}) {
      lone_elements e(seed, 1, 1);
      without_steps hindered(e.b);
      const inelastic_result result = e.solve(hindered, law, carried, {tolerance, 8});
      EXPECT_TRUE(result.tangential.converged) << result.tangential.residual;
      for (size_t k = 0; k < e.n; ++k) {
        const double traction = std::hypot(e.p[e.x(k)], e.p[e.y(k)]);
        const double slip = std::hypot(e.s[e.x(k)], e.s[e.y(k)]);
        double slope;
        const double bound = e.friction[k] * law.slip.coefficient(slip, slope);
        if (e.state[k] == RP_STICK)
          EXPECT_LE(traction, bound * (1 + 1e-9));
        else
          EXPECT_NEAR(traction, bound, 1e-8);
        EXPECT_NEAR(traction, std::hypot(e.rigid[e.x(k)], e.rigid[e.y(k)]) - slip, 1e-8);
      }
    }
}

// Where the law falls nowhere, steps that need no linear system come closer to the solution however
// little B's symmetric part is.
TEST(InelasticNewton, SafeguardGainsOnAnySkewness) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> entry(-1, 1);
  inelastic_newton newton(12, static_cast<int>(lengths.size()), false);
  for (double skewness : {1.0, 30.0, 1e3, 3e4}) {
    dense_operator b(skewness, random);
    without_steps hindered(b);
    const size_t n = b.size() / 2;
    field bound(n, 1e9), area(n, 1.0), rigid(2 * n), p(2 * n), s(2 * n), friction(n);
    for (double &v : rigid) v = 2 * entry(random);
    std::vector<carried_state> before(n, carried_state{{0, 0, 0}}), after(n);
    std::vector<unsigned char> state(n);
    const rolling_problem problem{static_cast<int>(lengths.size()),
                                  b.start().data(),
                                  bound.data(),
                                  area.data(),
                                  rigid.data(),
                                  p.data(),
                                  s.data()};
    const bound_law coulomb;
    inelastic_problem inelastic;
    inelastic.law = &coulomb;
    inelastic.before = before.data();
    inelastic.after = after.data();
    inelastic.friction = friction.data();
    inelastic.state = state.data();
    // to be tried once, and again and again
    for (const tangential_options options : {tangential_options{0.9, 8}, {0.5, 200}}) {
      std::fill(p.begin(), p.end(), 0.0);
      const tangential_result result =
          newton.solve(hindered, problem, inelastic, options).tangential;
      EXPECT_TRUE(result.converged) << "skewness " << skewness << ", left " << result.residual;
    }
  }
}

// By the rule of the vector sum the law's state is the plastic displacement since the leading edge.
void expect_summed_along_rows(int nx, int ny) {
  const fft_plans plans({smooth_size(2 * nx + 1)}, {smooth_size(2 * ny - 1)});
  influence a({{82e9, 0.28, 0}, 1e-14, 0}, plans);
  const grid g{nx, ny, 1.1e-3, 1.3e-3, -5.5e-3, -0.5 * (ny - 1) * 1.3e-3};
  ASSERT_TRUE(a.set_grid(g));
  tangential_solver::setup setup;
  setup.inelastic = setup.plastic = true;
  tangential_solver solver(nx, ny, setup);
  field pressure, bound;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = g.x(i) / 5.7e-3, y = g.y(j) / 5e-3;
      pressure.push_back(8e8 * std::sqrt(std::max(0.0, 1 - x * x - y * y)));
      bound.push_back(0.3 * pressure.back());
    }
  for (int direction : {1, -1}) {
    bound_law law;
    law.by_magnitude = true;
    law.yield = hardening_curve::straight(1.2e8, 1e12);
    rolling_input input;
    input.creepage[0] = 3e-3;
    input.creepage[1] = -2e-3;
    input.spin_creepage = 0.2;
    input.direction = direction;
    const auto n = static_cast<size_t>(g.count());
    field px(n), py(n), sx(n), sy(n), sum_x(n), sum_y(n), yield(n), friction(n);
    std::vector<unsigned char> division(n);
    std::vector<carried_state> after(n, carried_state{{0, 0, 0}});
    const inelastic_fields fields{&law,         nullptr,      after.data(),   sum_x.data(),
                                  sum_y.data(), yield.data(), friction.data()};
    inelastic_sums sums;
    const tangential_result result =
        solver.solve({a,
                      g,
                      pressure.data(),
                      bound.data(),
                      input,
                      {1e-9, 200},
                      {px.data(), py.data(), sx.data(), sy.data(), division.data()},
                      false,
                      &fields,
                      &sums});
    ASSERT_TRUE(result.converged) << result.residual;
    EXPECT_GT(sums.plastic, ny > 1 ? 10 : 5);
    double most = 0;
    for (const carried_state &s : after) most = std::max(most, std::hypot(s.v[1], s.v[2]));
    EXPECT_GT(most, 0);
    for (size_t k = 0; k < n; ++k) {
      EXPECT_NEAR(sum_x[k], after[k].v[1], 1e-9 * most) << k;
      EXPECT_NEAR(sum_y[k], after[k].v[2], 1e-9 * most) << k;
    }
  }
}

TEST(PlasticDisplacement, IsSummedAlongEachRow) {
  expect_summed_along_rows(11, 8);
  // a line contact, one row
  expect_summed_along_rows(11, 1);
}

}  // namespace
