// The parts of Kik-Piotrowski and ANALYN: integrals over strips, the tabulated Hertzian contact,
// and contact areas that are parts of one patch.
#include "normal/row_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "normal/hertz.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

// --- strips ----------------------------------------------------------------------------------

// int over [-half, half] by many midpoints
template <class F>
double sum_of(double half, int n, F &&f) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(half * ((2.0 * i + 1) / n - 1)) * 2 * half / n;
  return sum;
}

TEST(Strip, IntegratesWhereTheChordIsReal) {
  const quadratic all[] = {{1, 0, 0},     {1, 0.5, -0.3}, {-0.1, 1, 0},
                           {0.2, 0, -1},  {-0.01, 0, 1},  {-1, 0, -1},
                           {0.02, 1, -3}, {0, 1e-9, -1},  {0.25, -1, 1.0}};
  // two Gauss points where l^2 changes less than by half, for which the root is the worst
  constexpr int n = 2000000;
  for (const quadratic &q : all) {
    const strip s(q, 1.0);
    const auto over = [&](auto &&f) {
      return sum_of(0.5, n, [&](double t) { return q.at(t) > 0 ? f(t) : 0.0; });
    };
    const auto squares = [](double, double l2) { return l2; };
    const auto lengths = [](double, double l2) { return std::sqrt(l2); };
    EXPECT_NEAR(s.width(), over([](double) { return 1.0; }), 2e-6) << q.c0 << " " << q.c1;
    EXPECT_NEAR(s.integral(squares), over([&](double t) { return q.at(t); }), 1e-6);
    EXPECT_NEAR(s.integral(lengths), over([&](double t) { return std::sqrt(q.at(t)); }), 3e-4);
    for (double y : {0.1, -0.7})
      EXPECT_NEAR(s.log_integral(y), over([&](double t) { return std::log(std::abs(y + t)); }),
                  2e-5);
  }
  EXPECT_TRUE(strip({-1, 0, -1}, 1.0).empty());
  EXPECT_TRUE(strip({NAN, 0, 0}, 1.0).empty());
}

// As a chord gains two ends in its middle or at its side, or loses them, no rule's error comes or
// goes at once: steps are halved towards the greater change until nothing is left of it.
TEST(Strip, IntegralsDoNotJump) {
  const std::function<quadratic(double)> families[] = {
      [](double u) { return quadratic{u, 0.02, 0.9}; },        // two ends in its middle
      [](double u) { return quadratic{0.4 + u, 0.3, -0.2}; },  // of all ratios of its ends
      [](double u) { return quadratic{0.1 + u, 0.5 + u, 0.8}; }};
  for (const auto &q : families) {
    const auto area = [&](double u) {
      return strip(q(u), 1.0).integral([](double, double l2) { return std::sqrt(l2); });
    };
    double least = HUGE_VAL, greatest = 0;
    for (int i = -400; i < 400; ++i) {
      double low = 1e-3 * i, high = 1e-3 * (i + 1);
      while (high - low > 1e-12) {
        const double middle = 0.5 * (low + high), change = area(middle) - area(low);
        (std::fabs(change) > std::fabs(area(high) - area(middle)) ? high : low) = middle;
      }
      EXPECT_NEAR(area(high), area(low), 1e-9) << low;
      least = std::min(least, area(low)), greatest = std::max(greatest, area(low));
    }
    EXPECT_GT(greatest - least, 0.3);
  }
}

TEST(Strip, ParabolaIsExact) {
  // q = 1 - t^2 on strips that cover [-1, 1] with its ends inside
  double squares = 0, lengths = 0;
  for (int j = -3; j <= 3; ++j) {
    const double y = 0.31 * j + 0.07;
    const strip s({1 - y * y, -2 * y, -1}, 0.31);
    squares += s.integral([](double, double l2) { return l2; });
    lengths += s.integral([](double, double l2) { return std::sqrt(l2); });
  }
  EXPECT_NEAR(squares, 4.0 / 3, 1e-14);
  EXPECT_NEAR(lengths, pi / 2, 2e-4);
}

TEST(Strip, PotentialOfARow) {
  // int sqrt(l^2 - x^2)/sqrt(x^2 + y^2) dx with x = l sin(u)
  for (double l : {1.0, 3e-3})
    for (double ratio : {1e-3, 0.02, 0.3, 1.0, 5.0, 100.0}) {
      const double y = ratio * l;
      const double expected = sum_of(pi / 2, 400000, [&](double u) {
        const double c = l * std::cos(u), x = l * std::sin(u);
        return c * c / std::hypot(x, y);
      });
      EXPECT_NEAR(row_potential(l * l, y), expected, 1e-9 * expected) << ratio;
      EXPECT_EQ(row_potential(l * l, -y), row_potential(l * l, y));
    }
  EXPECT_EQ(row_potential(0, 1), 0);
  // near the row: 2 l (ln(4 l/y) - 1)
  EXPECT_NEAR(row_potential(1, 1e-9), 2 * (std::log(4e9) - 1), 1e-12 * 42);
}

TEST(HertzRatios, AgreeWithTheClosedForm) {
  const hertz_ratios table;
  for (double ratio = 1e-6; ratio <= 1e6; ratio *= 1.37) {
    const double curvatures[2] = {0.7 * ratio, 0.7}, modulus = 3e9, approach = 2e-5;
    const hertz_contact h = hertz_from_approach(curvatures, modulus, approach);
    const hertz_ratios::values found = table.at(curvatures[0], curvatures[1]);
    const double a = h.semi_axes[0], b = h.semi_axes[1];
    EXPECT_NEAR(found.edge_along * approach / (curvatures[0] * a * a), 1, 1e-8) << ratio;
    EXPECT_NEAR(found.edge_across * approach / (curvatures[1] * b * b), 1, 1e-8) << ratio;
    EXPECT_NEAR(found.pressure * modulus * curvatures[0] * a / h.max_pressure, 1, 1e-8) << ratio;
  }
}

// --- parts -----------------------------------------------------------------------------------

class Parts : public testing::TestWithParam<rp_normal_method> {
 protected:
  // two valleys of different depth, 8 mm apart
  Parts() : g{60, 60, 3e-4, 3e-4, -29.5 * 3e-4, -29.5 * 3e-4} {
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const double y = g.y(j), left = (y + 4e-3) * (y + 4e-3), right = (y - 4e-3) * (y - 4e-3);
        h.push_back(1.1 * g.x(i) * g.x(i) + std::min(3 * left, 3 * right + 4e-6));
      }
  }
  struct found {
    row_contact_result r;
    std::vector<double> pressure;
  };
  found solve(const contact_parts &parts, double approach = 2e-5) {
    row_contact rows(GetParam(), 1.1e11, g.ny);
    found f{{}, std::vector<double>(h.size())};
    f.r = rows.solve(g, h.data(), {false, 0, approach, 0}, parts, f.pressure.data());
    return f;
  }
  static contact_parts two(double factor) {
    contact_parts parts;
    parts.count = 2;
    parts.first_row[1] = 30;
    parts.factor[0] = factor;
    return parts;
  }
  grid g;
  std::vector<double> h;
};

TEST_P(Parts, ApartAreOnTheirOwn) {
  const found both = solve(two(0));
  double force = 0, area = 0;
  const std::vector<double> all = h;
  for (int side = 0; side < 2; ++side) {
    // the other valley lifted out of reach
    h = all;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        if ((j < 30) != (side == 0)) h[static_cast<size_t>(j * g.nx + i)] += 1e-4;
    const found one = solve({});
    force += one.r.normal_force;
    area += one.r.contact_area;
  }
  EXPECT_NEAR(both.r.normal_force, force, 1e-12 * force);
  EXPECT_NEAR(both.r.contact_area, area, 1e-12 * area);
}

TEST_P(Parts, TogetherAreOne) {
  const found one = solve({}), both = solve(two(1));
  EXPECT_EQ(one.r.normal_force, both.r.normal_force);
  EXPECT_EQ(one.r.max_pressure, both.r.max_pressure);
  EXPECT_EQ(one.pressure, both.pressure);
}

TEST_P(Parts, BetweenAreBlended) {
  const found apart = solve(two(0)), together = solve(two(1)), between = solve(two(0.3));
  for (auto value : {&row_contact_result::normal_force, &row_contact_result::max_pressure,
                     &row_contact_result::contact_area, &row_contact_result::elastic_energy}) {
    const double expected = 0.7 * apart.r.*value + 0.3 * together.r.*value;
    EXPECT_NEAR(between.r.*value, expected, 1e-12 * expected);
  }
  double sum = 0;
  for (double p : between.pressure) sum += p * g.dx * g.dy;
  EXPECT_NEAR(sum, between.r.normal_force, 1e-12 * sum);
}

TEST_P(Parts, SmallestContactLoadsTheElementsAroundIt) {
  // 10 micrometres long and wide, between the middles of the elements
  const found f = solve({}, 1e-10);
  double sum = 0, x = 0, y = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double load = f.pressure[static_cast<size_t>(j * g.nx + i)] * g.dx * g.dy;
      if (load > 0) {
        EXPECT_LT(std::fabs(g.x(i)), g.dx);
        EXPECT_LT(std::fabs(g.y(j) + 4e-3), g.dy);
      }
      sum += load;
      x += load * g.x(i);
      y += load * g.y(j);
    }
  EXPECT_GT(f.r.normal_force, 0);
  EXPECT_NEAR(sum, f.r.normal_force, 1e-12 * sum);
  EXPECT_NEAR(x / sum, 0, 1e-12);
  EXPECT_NEAR(y / sum, -4e-3, 1e-12);
}

TEST_P(Parts, SymmetricSurfacesHaveSymmetricPressure) {
  // chords of the last rows reach no element's middle: between the two in the middle of a row
  for (const auto &[nx, ny] : {std::pair{6, 17}, {17, 6}, {6, 16}, {12, 13}, {5, 4}}) {
    g = {nx, ny, 5e-4, 2.5e-4, -0.5 * (nx - 1) * 5e-4, -0.5 * (ny - 1) * 2.5e-4};
    const double length = 0.5 * nx * g.dx, width = 0.5 * ny * g.dy;
    for (const double part : {0.9, 0.6, 0.3, 0.05}) {
      h.clear();
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const double x = g.x(i) / length, y = g.y(j) / width;
          h.push_back(2e-5 * (x * x + y * y) / (part * part));
        }
      const found f = solve({});
      EXPECT_GT(f.r.normal_force, 0);
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const auto of = [&](int column, int row) {
            return f.pressure[static_cast<size_t>(row * nx + column)];
          };
          const double near = 1e-9 * f.r.max_pressure;
          EXPECT_NEAR(of(i, j), of(nx - 1 - i, j), near) << nx << ' ' << ny << ' ' << part;
          EXPECT_NEAR(of(i, j), of(i, ny - 1 - j), near) << nx << ' ' << ny << ' ' << part;
        }
    }
  }
}

TEST_P(Parts, MirroredGridsCarryTheSame) {
  // the valleys' lowest points: within, between rows at either side, or beyond one end of the grid
  // but in the middle between two rows no parabolas: rows at the ends see them by those next to
  // them
  const std::pair<double, double> valleys[] = {
      {1e-3, 5e4}, {8.7e-3, 0}, {8.72e-3, 5e4}, {9.1e-3, 5e4}, {10e-3, 5e4}};
  for (const auto &[middle, steeper] : valleys)
    for (double factor : {0.0, 0.4}) {
      row_contact_result found[2];
      for (int side = 0; side < 2; ++side) {
        for (int j = 0; j < g.ny; ++j)
          for (int i = 0; i < g.nx; ++i) {
            const double d = (side == 0 ? 1 : -1) * g.y(j) - middle;
            h[static_cast<size_t>(j * g.nx + i)] =
                1.1 * g.x(i) * g.x(i) + 3 * d * d * (1 + steeper * d * d);
          }
        const double end = g.y(g.ny - 1) + 0.5 * g.dy;
        const double lowest = middle > end ? 3 * (middle - end) * (middle - end) : 0.0;
        found[side] = solve(two(factor), lowest + 2e-5).r;
      }
      EXPECT_GT(found[0].normal_force, 0) << middle;
      for (auto value : {&row_contact_result::normal_force, &row_contact_result::max_pressure,
                         &row_contact_result::contact_area, &row_contact_result::elastic_energy})
        EXPECT_NEAR(found[0].*value, found[1].*value, 1e-12 * found[0].*value) << middle;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Parts,
                         testing::Values(RP_NORMAL_KIK_PIOTROWSKI,
                                         RP_NORMAL_KIK_PIOTROWSKI_CORRECTED, RP_NORMAL_ANALYN));

}  // namespace
