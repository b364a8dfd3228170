// Strips of liquid: the values of docs/fluids.md, the flow that is the same all along, the table
// against the solver, rows of elements against the ellipse that they are taken from.
#include "fluid/wet_strip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "fluid/asperities.hpp"
#include "fluid/strip_lanes.hpp"
#include "fluid/strip_table.hpp"
#include "numeric/sums.hpp"
#include "patch/fluid_strips.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

// Of asperities, by the trapezoidal rule in theta.
double share_of(const strip_solver &s) {
  double sum = 0;
  for (int k = 1; k < s.nodes(); ++k)
    sum +=
        0.5 * (s.theta()[k] - s.theta()[k - 1]) *
        (s.liquid()[k] * std::sin(s.theta()[k]) + s.liquid()[k - 1] * std::sin(s.theta()[k - 1]));
  return 1 - sum / (0.5 * pi);
}

TEST(FluidStrip, ReferenceCase) {
  strip_solver s(4096);
  const strip_solution found = s.solve(elliptic_strip{}, 0.36, 1 / 2.8);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(share_of(s), 0.94937800, 1e-6);
  EXPECT_NEAR(found.cavitation, 0.5016423, 1e-6);
  int most = 0;
  for (int k = 1; k < s.nodes(); ++k)
    if (s.liquid()[k] > s.liquid()[most]) most = k;
  EXPECT_NEAR(s.liquid()[most], 0.09315118, 1e-6);
  EXPECT_NEAR(-std::cos(s.theta()[most]), -0.286016, 1e-3);  // steps are 5e-4
}

TEST(FluidStrip, SharesOfEllipticStrips) {
  const double numbers[7] = {0.0225, 0.1, 0.3, 1, 3, 10, 30};
  const double shares[3][7] = {{.99917, .99629, .98862, .95975, .87301, .66393, .43711},
                               {.99702, .98640, .95788, .86975, .71994, .51273, .33391},
                               {.98826, .95117, .88486, .76284, .61222, .43076, .28180}};
  const double pressures[3] = {0.2, 1 / 2.8, 0.5};
  strip_solver s(2048);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 7; ++i) {
      s.solve(elliptic_strip{}, numbers[i], pressures[j]);
      EXPECT_NEAR(share_of(s), shares[j][i], 5.5e-6) << numbers[i] << " " << pressures[j];
      EXPECT_NEAR(strip_table::share(numbers[i], pressures[j]), shares[j][i], 1e-3);
    }
}

// What a solution without the condition of cavitation gets wrong: t - K(t)/S dP/dX is one number.
TEST(FluidStrip, FlowIsTheSameAllAlong) {
  for (double number : {0.01, 0.36, 3.0, 100.0}) {
    strip_solver s(4096);
    const double r = 1 / 2.8;
    const strip_solution found = s.solve(elliptic_strip{}, number, r);
    EXPECT_NEAR(found.residual, 0, 1e-12);
    double worst = 0;
    for (int k = s.nodes() / 50; k + 1 < s.nodes(); ++k) {
      const double x = -std::cos(s.theta()[k + 1]), before = -std::cos(s.theta()[k - 1]);
      const double rise = (s.liquid()[k + 1] - s.liquid()[k - 1]) / (x - before);
      const double flow = s.film()[k] - flow_factor(s.film()[k]) / number * rise;
      worst = std::max(worst, std::fabs(flow - found.flow));
      // and the film is that of what asperities bear
      const double asperities = std::sin(s.theta()[k]) - s.liquid()[k];
      EXPECT_GT(asperities, 0);
      EXPECT_GE(s.liquid()[k], -1e-12);
    }
    EXPECT_LT(worst, 2e-4 * found.flow) << number;
    EXPECT_NEAR(s.liquid()[s.nodes() - 1], 0, 1e-15);
  }
}

TEST(FluidStrip, SecondOrder) {
  double last = 0;
  for (int steps : {64, 128, 256}) {
    strip_solver s(steps);
    s.solve(elliptic_strip{}, 0.36, 1 / 2.8);
    const double error = share_of(s) - 0.949377997;
    if (last != 0) {
      EXPECT_NEAR(last / error, 4, 0.2);
    }
    last = error;
  }
}

TEST(FluidStrip, SlowLiquidBearsNothing) {
  strip_solver s(256);
  for (double r : {0.05, 0.3, 0.5}) {
    s.solve(elliptic_strip{}, 1e-7, r);
    EXPECT_NEAR(share_of(s), 1, 1e-6);
    EXPECT_NEAR(strip_table::rows_of(0).share_of_ellipse(r), 1, 1e-5);
  }
}

TEST(FluidStrip, TableAgainstSolver) {
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> flat(0, 1);
  strip_solver s(1024);
  for (int i = 0; i < 60; ++i) {
    const double number = std::pow(10.0, -5 + 8 * flat(draw)), r = 0.02 + 0.5 * flat(draw);
    s.solve(elliptic_strip{}, number, r, -2, 1e-9);
    const strip_table::strip row = strip_table::at(number, r);
    EXPECT_NEAR(row.share, share_of(s), 1e-3) << number << " " << r;
    for (int k = 0; k < s.nodes(); k += 16)
      EXPECT_NEAR(row.pressure(s.theta()[k]), s.liquid()[k], 5e-3) << number << " " << r;
  }
}

// Many places at once, whose angles are within 4e-8.
TEST(FluidStrip, PlacesAtOnceAreThoseOneByOne) {
  for (double number : {1e-3, 0.36, 50.0, 1e4})
    for (int count : {1, 31, 32, 33, 77}) {
      const strip_table::strip row = strip_table::at(number, 0.3);
      std::vector<double> x(static_cast<size_t>(count)), found(x);
      for (int i = 0; i < count; ++i)
        x[static_cast<size_t>(i)] = count > 1 ? -1.0 + 2.0 * i / (count - 1) : 0.1;
      row.pressures(x.data(), count, found.data());
      for (size_t i = 0; i < x.size(); ++i)
        EXPECT_NEAR(found[i], row.pressure(std::acos(-x[i])), 1e-6) << number << " " << x[i];
    }
}

// Rows of elements cut out of an ellipse, each solved by itself, and the table.
TEST(FluidStrip, RowsOfElements) {
  hertz_contact hertz;
  hertz.semi_axes[0] = 6e-3;
  hertz.semi_axes[1] = 5e-3;
  hertz.max_pressure = 1e9;
  grid g;
  g.nx = 50;
  g.ny = 41;
  g.dx = g.dy = 2.5e-4;
  g.x0 = -0.5 * (g.nx - 1) * g.dx;
  g.y0 = -0.5 * (g.ny - 1) * g.dy;
  std::vector<double> p(static_cast<size_t>(g.count())), table(p), direct(p), back(p);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i)
      p[static_cast<size_t>(j * g.nx + i)] =
          hertz.max_pressure *
          std::sqrt(std::max(inside_ellipse(hertz.semi_axes, g.x(i), g.y(j)), 0.0));
  for (double speed : {2.0, 20.0, 72.0}) {
    const strip_liquid liquid{1e-3, speed, 0.5e-6, 2.8e9};
    fluid_strips strips(false, g.nx, g.ny);
    const strip_outcome a = strips.solve(g, p.data(), hertz, 1, liquid, table.data());
    const strip_outcome b = strips.solve(g, p.data(), hertz_contact{}, 1, liquid, direct.data());
    EXPECT_TRUE(b.converged);
    EXPECT_NEAR(a.share, b.share, 4e-3) << speed;
    EXPECT_NEAR(a.film / b.film, 1, 5e-3) << speed;
    EXPECT_NEAR(a.share, fluid_strips::of_ellipse(hertz, liquid).share, 2e-3) << speed;
    double off = 0;
    for (size_t k = 0; k < p.size(); ++k) {
      off = std::max(off, std::fabs(table[k] - direct[k]));
      EXPECT_TRUE(direct[k] >= 0 && direct[k] <= p[k]);
    }
    EXPECT_LT(off, 0.02 * hertz.max_pressure) << speed;
    // the other way round it is the mirror image
    strips.solve(g, p.data(), hertz_contact{}, -1, liquid, back.data());
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        EXPECT_NEAR(back[static_cast<size_t>(j * g.nx + g.nx - 1 - i)],
                    direct[static_cast<size_t>(j * g.nx + i)], 2e-5 * hertz.max_pressure);
  }
}

// Where the liquid bears all but 1e-12, what it leaves is summed to its own last digits; the
// difference of both sums has lost them.
TEST(FluidStrip, WhatNextToNothingIsLeft) {
  std::vector<double> pressure(257), fluid(pressure);
  long double left = 0;
  for (size_t k = 0; k < pressure.size(); ++k) {
    pressure[k] = 1e9 * (1.0 + std::sin(static_cast<double>(k)));
    fluid[k] = (1.0 - 1e-12) * pressure[k];
    left += static_cast<long double>(pressure[k]) - fluid[k];
  }
  const double found = total_difference(pressure.data(), fluid.data(), pressure.size());
  EXPECT_NEAR(found / static_cast<double>(left), 1, 1e-14);
}

// From a place nearby some marches find the end, and their rates what lies between: to the
// precision asked for, where it is sought to rounding.
TEST(FluidStrip, NewtonsStepsFindTheSame) {
  strip_solver cold(256), warm(256);
  for (double number : {0.03, 0.36, 3.0, 30.0})
    for (double r : {0.1, 1 / 2.8, 0.5}) {
      const strip_solution all = cold.solve(elliptic_strip{}, number, r);
      for (double off : {-0.02, 0.005, 0.02}) {
        const double start = all.cavitation + off * (1 - all.cavitation);
        const strip_solution found = warm.solve(elliptic_strip{}, number, r, start, 1e-8);
        ASSERT_TRUE(found.converged) << number << " " << r << " " << off;
        EXPECT_LE(found.marches, 6) << number << " " << r << " " << off;
        EXPECT_NEAR(found.cavitation, all.cavitation, 1e-8) << number << " " << r << " " << off;
        EXPECT_NEAR(found.flow / all.flow, 1, 1e-8) << number << " " << r << " " << off;
        for (int k = 0; k < cold.nodes(); ++k)
          EXPECT_NEAR(warm.liquid()[k], cold.liquid()[k], 1e-8) << number << " " << r << " " << k;
      }
    }
}

// Runs of elements with pressures as rough as those of worn surfaces, from which lanes take rows.
struct drawn_runs {
  std::vector<std::vector<double>> pressures, squares;
  std::vector<strip_lanes::strip> strips;

  drawn_runs(int count, unsigned seed) : pressures(static_cast<size_t>(count)), squares(pressures) {
    std::mt19937 draw(seed);
    std::uniform_real_distribution<double> flat(0, 1);
    for (size_t n = 0; n < pressures.size(); ++n) {
      const int elements = 1 + static_cast<int>(40 * flat(draw));
      const double skew = 0.3 * (flat(draw) - 0.5), rough = 0.1 * flat(draw);
      for (int i = 0; i < elements; ++i) {
        const double x = (2 * i + 1.0) / elements - 1;
        pressures[n].push_back(1e9 * std::sqrt(1 - x * x) * (1 + skew * x) *
                               (1 + rough * (flat(draw) - 0.5)));
      }
      squares[n].resize(static_cast<size_t>(elements + 2));
      strip_lanes::strip strip;
      strip.run = pressed_run::of(pressures[n].data(), elements, n % 2 == 1, squares[n].data());
      strip.s = std::pow(10.0, -4 + 6 * flat(draw));
      strip.r = 0.02 + 0.5 * flat(draw);
      strip.start = strip_table::end(strip.s, strip.r);
      strips.push_back(strip);
    }
  }
};

// The march of several rows at once is that of one; what it leaves is little, and it says so.
TEST(FluidStrip, LanesAreTheSolverOfOne) {
  constexpr int lanes = strip_lanes::lanes;
  const drawn_runs drawn(30 * lanes, 3);
  strip_lanes several(64);
  strip_solver one(64);
  int left = 0;
  for (size_t first = 0; first < drawn.strips.size(); first += lanes) {
    several.solve(&drawn.strips[first], lanes, 1e-8);
    for (int l = 0; l < lanes; ++l) {
      const strip_lanes::strip &strip = drawn.strips[first + static_cast<size_t>(l)];
      const strip_solution alone =
          one.solve(run_pressure(strip.run), strip.s, strip.r, -std::cos(strip.start), 1e-12);
      ASSERT_TRUE(alone.converged);
      if (!several.found(l).converged) {
        ++left;
        continue;
      }
      const auto told = [&] { return ::testing::Message() << strip.s << " " << strip.r; };
      // pressures are what is asked for; they fall to nothing at X_c so gently that it is not known
      // as well
      for (int k = 0; k < one.nodes(); ++k)
        EXPECT_NEAR(several.liquid(l)[k], one.liquid()[k], 2e-8) << told() << " " << k;
    }
  }
  EXPECT_LT(left, 12);  // of 240
}

// Rows that lean, as those of worn profiles do, begin near their end: no march goes astray.
TEST(FluidStrip, LeaningRowsBeginNearTheirEnd) {
  constexpr int lanes = strip_lanes::lanes, elements = 24;
  std::vector<double> pressures, squares(elements + 2);
  strip_lanes solver(64);
  for (double lean : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
    pressures.clear();
    for (int i = 0; i < elements; ++i) {
      const double x = (2 * i + 1.0) / elements - 1;
      pressures.push_back(1e9 * std::sqrt(1 - x * x) * (1 + lean * x));
    }
    strip_lanes::strip strips[lanes];
    for (int l = 0; l < lanes; ++l) {
      strips[l].run = pressed_run::of(pressures.data(), elements, false, squares.data());
      strips[l].s = 0.01 * std::pow(3.0, l);
      strips[l].r = 1 / 2.8;
      strips[l].start = strips[l].likely_end();
    }
    EXPECT_NEAR(strips[0].run.lean, lean, 0.1 * std::fabs(lean) + 1e-12);
    solver.solve(strips, lanes, 1e-8);
    for (int l = 0; l < lanes; ++l) {
      EXPECT_TRUE(solver.found(l).converged);
      EXPECT_LE(solver.found(l).marches, 4) << lean << " " << strips[l].s;
      EXPECT_NEAR(strips[l].start, solver.end(l), 0.06) << lean << " " << strips[l].s;
    }
  }
}

// t - K(t)/S dP/dX is one number along each row of the lanes, by differences over two steps.
TEST(FluidStrip, FlowIsTheSameAllAlongInLanes) {
  constexpr int lanes = strip_lanes::lanes, elements = 60;
  std::vector<double> pressures, squares(elements + 2);
  for (int i = 0; i < elements; ++i) {
    const double x = (2 * i + 1.0) / elements - 1;
    pressures.push_back(1e9 * std::sqrt(1 - x * x));
  }
  strip_lanes::strip strips[lanes];
  for (int l = 0; l < lanes; ++l) {
    strips[l].run = pressed_run::of(pressures.data(), elements, false, squares.data());
    strips[l].s = 0.01 * std::pow(4.0, l);
    strips[l].r = 1 / 2.8;
    strips[l].start = strip_table::end(strips[l].s, strips[l].r);
  }
  strip_lanes solver(4096);
  solver.solve(strips, lanes, 1e-12);
  for (int l = 0; l < lanes; ++l) {
    ASSERT_TRUE(solver.found(l).converged) << l;
    const double step = solver.end(l) / (solver.nodes() - 1), r = strips[l].r;
    const double *liquid = solver.liquid(l);
    double worst = 0;
    for (int k = solver.nodes() / 50; k + 1 < solver.nodes(); ++k) {
      const double x = -std::cos((k + 1) * step), before = -std::cos((k - 1) * step);
      const double rise = (liquid[k + 1] - liquid[k - 1]) / (x - before);
      double slope;
      const double nominal =
          run_pressure(strips[l].run).at(std::cos(k * step), std::sin(k * step), slope);
      const double film = mean_film(distance_of(r * (nominal - liquid[k])));
      const double flow = film - flow_factor(film) / strips[l].s * rise;
      worst = std::max(worst, std::fabs(flow - solver.found(l).flow));
    }
    EXPECT_LT(worst, 1e-3 * solver.found(l).flow) << l;
  }
}

// A row's bits do not depend on what is solved beside it.
TEST(FluidStrip, LanesDoNotMeet) {
  constexpr int lanes = strip_lanes::lanes;
  const drawn_runs drawn(8 * lanes, 4);
  strip_lanes several(64), alone(64);
  for (size_t first = 0; first < drawn.strips.size(); first += lanes) {
    several.solve(&drawn.strips[first], lanes, 1e-8);
    for (int l = 0; l < lanes; ++l) {
      alone.solve(&drawn.strips[first + static_cast<size_t>(l)], 1, 1e-8);
      ASSERT_EQ(alone.found(0).converged, several.found(l).converged);
      if (!alone.found(0).converged) continue;
      EXPECT_EQ(alone.end(0), several.end(l));
      EXPECT_EQ(alone.found(0).marches, several.found(l).marches);
      for (int k = 0; k < alone.nodes(); ++k)
        ASSERT_EQ(alone.liquid(0)[k], several.liquid(l)[k]) << l << " " << k;
    }
  }
}

TEST(FluidStrip, Extremes) {
  strip_solver s(64);
  for (double number : {0.0, 1e-12, 1e-3, 1.0, 1e3, 1e6, 1e9})
    for (double r : {1e-6, 0.01, 0.3, 0.55}) {
      const strip_solution found = s.solve(elliptic_strip{}, number, r, -2, 1e-8);
      EXPECT_TRUE(found.converged && std::isfinite(found.cavitation)) << number << " " << r;
      for (int k = 0; k < s.nodes(); ++k)
        EXPECT_TRUE(std::isfinite(s.liquid()[k]) && s.liquid()[k] < 1.01) << number << " " << r;
    }
}

}  // namespace
