// Derivatives of the tangential problem's resultants against central differences of its solutions,
// by every quantity that it knows a derivative by, both ways: one system for each direction and one
// for each resultant.
#include "tangential/tangential_derivative.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "railpatch.h"

namespace {

using namespace railpatch;
using field = std::vector<double>;
using resultants = std::array<double, 4>;  // forces, moment, elastic energy

struct state {
  grid g;
  field pressure, row_friction;
  double friction = 0.3;
  rolling_input input;
};

struct contact_case {
  const char *name;
  int nx, ny, direction;
  double layer, width;  // m/Pa; m, of a line contact
  double slip;          // creepages over what full sliding takes, about
};
void PrintTo(const contact_case &c, std::ostream *out) { *out << c.name; }

const contact_case cases[] = {
    {"ahead", 11, 8, 1, 0.0, 0.0, 0.5},          {"back", 9, 10, -1, 0.0, 0.0, 0.5},
    {"layer", 10, 7, 1, 2e-14, 0.0, 0.5},        {"sticking", 9, 7, 1, 0.0, 0.0, 0.01},
    {"sliding", 9, 7, -1, 0.0, 0.0, 20.0},       {"line", 25, 1, 1, 0.0, 0.01, 0.5},
    {"line_layer", 24, 1, -1, 2e-14, 0.01, 0.5},
};

class Derivative : public testing::TestWithParam<contact_case> {
 protected:
  const contact_case c = GetParam();
  fft_plans plans{{smooth_size(2 * c.nx + 1)}, {c.ny > 1 ? smooth_size(2 * c.ny - 1) : 1}};
  influence::medium of{{82e9, 0.28, 0}, c.layer, c.width};
  influence a{of, plans};
  tangential_solver solver{c.nx, c.ny, {}};
  field px, py, sx, sy;
  std::vector<unsigned char> division;

  state begun() const {
    state s;
    s.g = {c.nx, c.ny, 1.1e-3, c.width > 0 ? c.width : 1.3e-3, -5e-3, -4.2e-3};
    const double mx = s.g.x0 + 0.47 * c.nx * s.g.dx, my = s.g.y0 + 0.5 * (c.ny - 1) * s.g.dy;
    for (int j = 0; j < c.ny; ++j) {
      s.row_friction.push_back(1.0 + 0.03 * j);
      for (int i = 0; i < c.nx; ++i) {
        const double x = (s.g.x(i) - mx) / (0.46 * c.nx * s.g.dx);
        const double y = c.ny > 1 ? (s.g.y(j) - my) / (0.47 * c.ny * s.g.dy) : 0;
        s.pressure.push_back(8e8 * std::sqrt(std::max(0.0, 1 - x * x - y * y)));
      }
    }
    s.input.creepage[0] = 2e-3 * c.slip;
    s.input.creepage[1] = -1.2e-3 * c.slip;
    s.input.spin_creepage = c.ny > 1 ? 0.2 * c.slip : 0.1;
    s.input.spin_offset = 4e-4;
    s.input.direction = c.direction;
    return s;
  }

  resultants solved(const state &s) {
    EXPECT_TRUE(a.set_grid(s.g));
    const auto n = static_cast<size_t>(s.g.count());
    field bound(n), ux(n), uy(n);
    for (auto *f : {&px, &py, &sx, &sy}) f->assign(n, 0.0);
    division.assign(n, 0);
    for (size_t k = 0; k < n; ++k)
      bound[k] = s.friction * s.row_friction[k / static_cast<size_t>(c.nx)] * s.pressure[k];
    const tangential_result r =
        solver.solve({a,
                      s.g,
                      s.pressure.data(),
                      bound.data(),
                      s.input,
                      {1e-13, 100},
                      {px.data(), py.data(), sx.data(), sy.data(), division.data()}});
    EXPECT_LE(r.residual, 1e-11);
    a.tangential_product(px.data(), py.data(), ux.data(), uy.data());
    resultants sum{};
    for (int j = 0; j < c.ny; ++j)
      for (int i = 0; i < c.nx; ++i) {
        const auto k = static_cast<size_t>(j * c.nx + i);
        const double area = s.g.dx * s.g.dy;
        sum[0] += area * px[k];
        sum[1] += area * py[k];
        sum[2] += area * (s.g.x(i) * py[k] - s.g.y(j) * px[k]);
        sum[3] += 0.5 * area * (px[k] * ux[k] + py[k] * uy[k]);
      }
    return sum;
  }
};

TEST_P(Derivative, IsThatOfDifferences) {
  const state s = begun();
  field rate(s.pressure), row_rate(s.row_friction);
  for (size_t k = 0; k < rate.size(); ++k) rate[k] *= 0.4 + 0.3 * std::sin(1.0 + 0.7 * k);
  for (size_t j = 0; j < row_rate.size(); ++j) row_rate[j] = std::cos(1.0 + j);

  // how each direction moves a state by a step of its own unit, and as a variation
  struct direction {
    std::string name;
    tangential_variation in;
    void (*move)(state &, double, const field &, const field &);
  };
  std::vector<direction> directions;
  const auto add = [&](const char *name, auto &&set, auto move) {
    direction d{name, {}, move};
    set(d.in);
    directions.push_back(d);
  };
  using variation = tangential_variation;
  const double creep = 1e-3, unit = 1e-3;
  add(
      "pressure", [&](variation &v) { v.pressure = rate.data(); },
      [](state &t, double h, const field &p, const field &) {
        for (size_t k = 0; k < p.size(); ++k) t.pressure[k] += h * p[k];
      });
  add(
      "rows' friction", [&](variation &v) { v.row_friction = row_rate.data(); },
      [](state &t, double h, const field &, const field &f) {
        for (size_t j = 0; j < f.size(); ++j) t.row_friction[j] += h * f[j];
      });
  add(
      "friction", [&](variation &v) { v.friction_coefficient = 1; },
      [](state &t, double h, const field &, const field &) { t.friction += h; });
  add(
      "creepage along", [&](variation &v) { v.creepage[0] = creep; },
      [](state &t, double h, const field &, const field &) { t.input.creepage[0] += h * 1e-3; });
  add(
      "creepage across", [&](variation &v) { v.creepage[1] = creep; },
      [](state &t, double h, const field &, const field &) { t.input.creepage[1] += h * 1e-3; });
  add(
      "spin", [&](variation &v) { v.spin_creepage = 0.3; },
      [](state &t, double h, const field &, const field &) { t.input.spin_creepage += h * 0.3; });
  add(
      "spin offset", [&](variation &v) { v.spin_offset = unit; },
      [](state &t, double h, const field &, const field &) { t.input.spin_offset += h * 1e-3; });
  add(
      "origin along", [&](variation &v) { v.origin[0] = unit; },
      [](state &t, double h, const field &, const field &) { t.g.x0 += h * 1e-3; });
  add(
      "origin across", [&](variation &v) { v.origin[1] = unit; },
      [](state &t, double h, const field &, const field &) { t.g.y0 += h * 1e-3; });
  add(
      "length", [&](variation &v) { v.size[0] = unit; },
      [](state &t, double h, const field &, const field &) { t.g.dx += h * 1e-3; });
  // the strip of a line contact keeps its width
  if (c.ny > 1)
    add(
        "width", [&](variation &v) { v.size[1] = unit; },
        [](state &t, double h, const field &, const field &) { t.g.dy += h * 1e-3; });
  add(
      "all",
      [&](variation &v) {
        v.pressure = rate.data();
        v.row_friction = row_rate.data();
        v.friction_coefficient = 1;
        v.creepage[0] = v.creepage[1] = creep;
        v.spin_creepage = 0.3;
        v.origin[0] = v.size[0] = unit;
      },
      [](state &t, double h, const field &p, const field &f) {
        for (size_t k = 0; k < p.size(); ++k) t.pressure[k] += h * p[k];
        for (size_t j = 0; j < f.size(); ++j) t.row_friction[j] += h * f[j];
        t.friction += h;
        for (double &creepage : t.input.creepage) creepage += h * 1e-3;
        t.input.spin_creepage += h * 0.3;
        t.g.x0 += h * 1e-3;
        t.g.dx += h * 1e-3;
      });

  constexpr double h = 1e-6;
  std::vector<resultants> slopes;
  resultants size{};
  for (const direction &d : directions) {
    resultants slope{};
    for (double side : {-h, h}) {
      state moved = s;
      d.move(moved, side, rate, row_rate);
      const resultants found = solved(moved);
      for (size_t k = 0; k < 4; ++k) slope[k] += found[k] / (2 * side);
    }
    slopes.push_back(slope);
  }
  const resultants at = solved(s);
  for (size_t k = 0; k < 4; ++k) {
    size[k] = std::abs(at[k]);
    for (const resultants &slope : slopes) size[k] = std::max(size[k], 0.1 * std::abs(slope[k]));
  }

  influence::medium rates = of;
  rates.by_length = true;
  rates.layer_flexibility = 0;  // does not change with an element
  influence by_length(rates, plans);
  ASSERT_TRUE(a.set_grid(s.g) && by_length.set_grid(s.g));
  row_blocks &blocks = *solver.blocks();
  const tangential_point point{a,
                               c.width > 0 ? nullptr : &by_length,
                               blocks,
                               s.g,
                               s.input,
                               s.friction,
                               s.row_friction.data(),
                               s.pressure.data(),
                               px.data(),
                               py.data(),
                               sx.data(),
                               sy.data(),
                               division.data()};
  tangential_derivative derivative(c.nx, c.ny, static_cast<int>(directions.size()));
  const auto expect = [&](const tangential_change &found, size_t k, const char *way, bool energy) {
    const double values[] = {found.force[0], found.force[1], found.moment, found.energy};
    for (size_t r = 0; r < (energy ? 4 : 3); ++r)
      EXPECT_NEAR(values[r], slopes[k][r], 2e-5 * size[r])
          << directions[k].name << ", resultant " << r << ", " << way;
    if (!energy) {
      EXPECT_EQ(found.energy, 0.0);
    }
  };
  for (bool energy : {true, false}) {
    EXPECT_LE(derivative.begin_resultants(point, {1e-9, energy}), 1e-9);
    EXPECT_GE(derivative.products(), derivative.exact_products());
    EXPECT_GE(derivative.exact_products(), energy ? 4 : 3);
    for (size_t k = 0; k < directions.size(); ++k) {
      tangential_change found;
      derivative.resultants(point, directions[k].in, found);
      expect(found, k, "by resultants", energy);
    }
    std::vector<tangential_variation> in;
    for (const direction &d : directions) in.push_back(d.in);
    std::vector<tangential_change> out(in.size());
    EXPECT_LE(
        derivative.solve(point, in.data(), static_cast<int>(in.size()), {1e-9, energy}, out.data()),
        1e-9);
    for (size_t k = 0; k < in.size(); ++k) expect(out[k], k, "by directions", energy);
  }
}

INSTANTIATE_TEST_SUITE_P(Contacts, Derivative, testing::ValuesIn(cases),
                         [](const auto &i) { return std::string(i.param.name); });

// A single row's equations are those that its preconditioner has the factors of, in single
// precision: the first direction leaves of a residual what that leaves, less than 1e-4, the second
// one 1e-8 and the third nothing that counts; then each residual is formed once more.
class SingleRow : public Derivative {};

TEST_P(SingleRow, IsSolvedByItsFactors) {
  const state s = begun();
  solved(s);
  row_blocks &blocks = *solver.blocks();
  const tangential_point point{a,
                               nullptr,
                               blocks,
                               s.g,
                               s.input,
                               s.friction,
                               s.row_friction.data(),
                               s.pressure.data(),
                               px.data(),
                               py.data(),
                               sx.data(),
                               sy.data(),
                               division.data()};
  tangential_derivative derivative(c.nx, c.ny, 4);
  EXPECT_LE(derivative.begin_resultants(point, {1e-9, false}), 1e-9);
  // 3 resultants
  EXPECT_LE(derivative.products(), 3 * (3 + 1));
  tangential_variation in[2];
  in[0].creepage[0] = in[1].creepage[1] = 1e-3;
  tangential_change out[2];
  EXPECT_LE(derivative.solve(point, in, 2, {1e-9, false}, out), 1e-9);
  EXPECT_LE(derivative.products(), 2 * (3 + 1));
}

const contact_case single_rows[] = {
    {"ahead", 25, 1, 1, 0.0, 0.0, 0.5},
    {"back", 24, 1, -1, 0.0, 0.0, 0.5},
    {"layer", 25, 1, 1, 2e-14, 0.0, 0.5},
    {"sticking", 25, 1, 1, 0.0, 0.0, 0.01},
};

INSTANTIATE_TEST_SUITE_P(Contacts, SingleRow, testing::ValuesIn(single_rows),
                         [](const auto &i) { return std::string(i.param.name); });

}  // namespace
