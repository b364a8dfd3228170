// Strips cut from a pressure on a grid, where what they are to be is known: loads and squared
// chords that are parabolas across, areas of few rows, ends whose rows lose their load; and their
// nodes' rule of integration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tangential/contact_rows.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

double low_end(const contact_rows &rows) { return rows[0].y - 0.5 * rows[0].height; }
double high_end(const contact_rows &rows) {
  const contact_row &last = rows[rows.count() - 1];
  return last.y + 0.5 * last.height;
}
double load_of(const contact_row &row) {
  return 0.5 * pi * row.peak * row.half_length * row.height;
}

// --- what rows are made of -----------------------------------------------------------------------

TEST(Nodes, IntegrateExactly) {
  contact_rows rows(6, 3, 4);
  rows.set_line(2e-3, 0.01, 5e4, 1e-3);
  ASSERT_EQ(rows.count(), 1);
  const contact_row &row = rows[0];
  EXPECT_EQ(row.x, 1e-3);
  EXPECT_EQ(row.y, 0.0);
  EXPECT_EQ(row.height, 0.01);
  EXPECT_EQ(row.half_length, 2e-3);
  EXPECT_NEAR(row.peak, 5e4 / (0.5 * pi * 2e-3 * 0.01), 1e-14 * row.peak);
  // p times powers of x below twice the number of nodes, in closed form
  double exact = 0.5 * pi;  // int sqrt(1 - t^2) t^n
  for (int n = 0; n < 2 * rows.nodes(); n += 2) {
    double sum = 0, odd = 0;
    for (int k = 0; k < rows.nodes(); ++k) {
      EXPECT_NEAR(std::hypot(rows.cosine(k), rows.sine(k)), 1.0, 1e-15);
      EXPECT_EQ(rows.pressure(0, k), row.peak * rows.sine(k));
      // equal steps of the angle, from the leading edge
      EXPECT_NEAR(std::acos(rows.cosine(k)), pi * (k + 1) / 7, 1e-15);
      const double part = rows.area(0, k) * rows.pressure(0, k) * std::pow(rows.cosine(k), n);
      sum += part;
      odd += part * rows.cosine(k);
    }
    EXPECT_NEAR(sum / (row.peak * row.half_length * row.height), exact, 1e-14) << n;
    EXPECT_NEAR(odd / (row.peak * row.half_length * row.height), 0.0, 1e-15) << n;
    exact *= (n + 1.0) / (n + 4.0);
  }
}

TEST(Strips, OfAnEllipseHoldItsIntegrals) {
  const double axes[2] = {5e-3, 3e-3}, force = 7e4;
  for (int strips : {1, 2, 7, 12}) {
    contact_rows rows(5, strips, 4);
    rows.set_ellipse(axes, force);
    ASSERT_EQ(rows.count(), strips);
    const double height = 2 * axes[1] / strips;
    for (int j = 0; j < strips; ++j) {
      const contact_row &row = rows[j];
      const double low = -axes[1] + j * height, high = low + height;
      // of 1 - (y/b)^2 from low to high
      const auto primitive = [&](double y) { return y - y * y * y / (3 * axes[1] * axes[1]); };
      const double integral = primitive(high) - primitive(low);
      EXPECT_EQ(row.strip, j);
      EXPECT_EQ(row.x, 0.0);
      EXPECT_NEAR(row.y, 0.5 * (low + high), 1e-17);
      EXPECT_NEAR(row.height, height, 1e-17);
      EXPECT_NEAR(row.half_length * row.half_length, axes[0] * axes[0] * integral / height, 1e-18);
      EXPECT_NEAR(load_of(row), 0.75 * force / axes[1] * integral, 1e-10);
    }
  }
}

// --- from pressure -------------------------------------------------------------------------------

// A row of the grid with the load per length, middle and squared half-length asked for: in three
// elements' pressures, whose first moments they are.
struct profile {
  double load, x, squared;
};

std::vector<double> pressed(const grid &g, const std::vector<profile> &rows) {
  std::vector<double> p(static_cast<size_t>(g.count()), 0.0);
  for (int j = 0; j < g.ny; ++j) {
    const profile &row = rows[static_cast<size_t>(j)];
    if (!(row.load > 0)) continue;
    // about the element next to the middle, as wide as needed
    const int middle = static_cast<int>(std::lround((row.x - g.x0) / g.dx)), wide = g.nx / 3;
    const double d = wide * g.dx, off = row.x - g.x(middle);
    // second moment about that element: variance and the middle's distance, elements' own apart
    const double second = 0.25 * row.squared - g.dx * g.dx / 12 + off * off;
    const double sides = second / (d * d), tilt = off / d;
    const double share[3] = {0.5 * (sides - tilt), 1 - sides, 0.5 * (sides + tilt)};
    for (int k = 0; k < 3; ++k) {
      const int i = middle + (k - 1) * wide;
      EXPECT_TRUE(i >= 0 && i < g.nx && share[k] >= 0) << i << " " << share[k];
      p[static_cast<size_t>(j * g.nx + i)] += row.load / g.dx * share[k];
    }
  }
  return p;
}

// Of an ellipse whose ends lie in the outermost elements: load and squared chord are parabolas,
// middles on a straight line, which strips follow exactly but for the whole force, which is that of
// the grid's rows.
TEST(Strips, FollowParabolasExactly) {
  const double b = 4e-3, a = 3e-3, most = 2e7;
  for (int between : {4, 5, 9})
    for (double low : {0.15, 0.3, 0.5})
      for (double high : {0.2, 0.5})
        for (int strips : {1, 2, 5, 8, 31}) {
          // the outermost rows lie that many elements from the ends
          const double dy = 2 * b / (low + between + high);
          const int ny = between + 3;
          const grid g{61, ny, 2e-4, dy, -6.1e-3, -b + (low - 1) * dy};
          std::vector<profile> across;
          double force = 0;
          for (int j = 0; j < ny; ++j) {
            const double y = g.y(j), round = 1 - y * y / (b * b);
            across.push_back({most * round, 1e-4 + 0.05 * y, a * a * round});
            if (round > 0) force += most * round * dy;
          }
          contact_rows rows(5, strips, ny);
          rows.set_pressure(g, pressed(g, across).data());
          SCOPED_TRACE(testing::Message()
                       << between << ", " << low << ", " << high << ", " << strips);
          ASSERT_EQ(rows.count(), strips);
          EXPECT_NEAR(low_end(rows), -b, 1e-11);
          EXPECT_NEAR(high_end(rows), b, 1e-11);
          const auto primitive = [&](double y) { return y - y * y * y / (3 * b * b); };
          const double scale = force / (most * 4 * b / 3);
          double before = -b, sum = 0;
          for (int j = 0; j < strips; ++j) {
            const contact_row &row = rows[j];
            const double begin = row.y - 0.5 * row.height, end = begin + row.height;
            const double integral = primitive(end) - primitive(begin);
            EXPECT_EQ(row.strip, j);
            EXPECT_NEAR(begin, before, 1e-11);
            EXPECT_NEAR(load_of(row), scale * most * integral, 1e-8 * force);
            EXPECT_NEAR(row.half_length * row.half_length, a * a * integral / row.height,
                        1e-8 * a * a);
            // beyond the outermost rows middles stay
            if (begin > g.y(1) && end < g.y(ny - 2)) {
              EXPECT_NEAR(row.x, 1e-4 + 0.05 * row.y, 1e-12);
            }
            before = end;
            sum += load_of(row);
          }
          EXPECT_NEAR(sum, force, 1e-12 * force);
        }
}

// Every strip has the same integral of the density (1/10 + load over the greatest)^(1/5), straight
// between the grid's rows and the ends; rows beyond the ends do not count, and those within a third
// of a row from them so much less.
TEST(Strips, AreOfEqualWeight) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 20; ++round) {
    const int ny = 6 + round % 5, strips = 2 + round % 7;
    const grid g{61, ny, 2e-4, 6e-4, -6.1e-3, -2e-3};
    std::vector<profile> across;
    double most = 0;
    for (int j = 0; j < ny; ++j) across.push_back({1e7 * (0.5 + unit(random)), 0, 9e-6});
    contact_rows rows(5, strips, ny);
    rows.set_pressure(g, pressed(g, across).data());
    ASSERT_EQ(rows.count(), strips);
    std::vector<double> y{low_end(rows)}, load{0};
    for (int j = 0; j < ny; ++j) {
      if (g.y(j) <= low_end(rows) || g.y(j) >= high_end(rows)) continue;
      y.push_back(g.y(j));
      load.push_back(across[static_cast<size_t>(j)].load);
    }
    const size_t last = load.size() - 1;
    const double whole_rows[2] = {load[1], load[last]}, next[2] = {load[2], load[last - 1]};
    const double near[2] = {y[1] - y[0], high_end(rows) - y[last]};
    for (int k = 0; k < 2; ++k)
      load[k ? last : 1] *=
          std::min(1.0, 3 * near[k] / g.dy * std::max(1.0, next[k] / whole_rows[k]));
    most = *std::max_element(load.begin(), load.end());
    y.push_back(high_end(rows)), load.push_back(0);
    const auto density = [&](double at) {
      size_t i = 0;
      while (i + 2 < y.size() && y[i + 1] < at) ++i;
      const double t = (at - y[i]) / (y[i + 1] - y[i]);
      const double from = std::pow(0.1 + load[i] / most, 0.2);
      const double to = std::pow(0.1 + load[i + 1] / most, 0.2);
      return from + t * (to - from);
    };
    std::vector<double> weight;
    double whole = 0;
    for (int j = 0; j < strips; ++j) {
      constexpr int samples = 4000;
      double sum = 0;
      for (int k = 0; k < samples; ++k)
        sum += density(rows[j].y + rows[j].height * ((k + 0.5) / samples - 0.5)) * rows[j].height /
               samples;
      weight.push_back(sum);
      whole += sum;
    }
    for (double w : weight) EXPECT_NEAR(w, whole / strips, 1e-5 * whole) << round;
  }
}

// One to three rows: the ends of the ellipse with their moments, at least an element wide, at most
// three quarters of an element beyond the outermost rows. No row has less than a tenth of the load
// of the next one.
TEST(Strips, OfFewRowsEndWithTheirMoments) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 200; ++round) {
    const int count = 1 + round % 3, ny = 9, first = round % 7;
    const double dy = 6e-4;
    const grid g{61, ny, 2e-4, dy, -6.1e-3, -2e-3};
    std::vector<profile> across(ny);
    double sum = 0, moment = 0, second = 0;
    for (int j = first; j < first + count; ++j) {
      const double load = 1e7 * (0.15 + unit(random));
      across[static_cast<size_t>(j)] = {load, 0, 9e-6};
      sum += load;
      moment += load * g.y(j);
    }
    const double middle = moment / sum;
    for (int j = first; j < first + count; ++j)
      second += across[static_cast<size_t>(j)].load * std::pow(g.y(j) - middle, 2) / sum;
    // a quarter of the squared axis over 5/4: of an ellipsoid's pressure, b^2/5
    const double half = std::max(std::sqrt(5 * second), 0.5 * dy);
    contact_rows rows(5, 4, ny);
    rows.set_pressure(g, pressed(g, across).data());
    ASSERT_GT(rows.count(), 0);
    EXPECT_NEAR(low_end(rows), std::max(middle - half, g.y(first) - 0.75 * dy), 1e-9) << round;
    EXPECT_NEAR(high_end(rows), std::min(middle + half, g.y(first + count - 1) + 0.75 * dy), 1e-9)
        << round;
    double carried = 0;
    for (int j = 0; j < rows.count(); ++j) carried += load_of(rows[j]);
    EXPECT_NEAR(carried, sum * dy, 1e-12 * sum * dy);
  }
}

TEST(Strips, OfALineContactAreOne) {
  const grid g{61, 1, 2e-4, 0.02, -6.1e-3, 0};
  contact_rows rows(5, 4, 1);
  rows.set_pressure(g, pressed(g, {{3e6, 1.3e-4, 9e-6}}).data());
  ASSERT_EQ(rows.count(), 1);
  EXPECT_NEAR(rows[0].x, 1.3e-4, 1e-15);
  EXPECT_EQ(rows[0].height, 0.02);
  EXPECT_NEAR(rows[0].half_length, 3e-3, 1e-14);
  EXPECT_NEAR(load_of(rows[0]), 3e6 * 0.02, 1e-8);
}

// As an outermost row loses its load the end goes over, without a jump and without a kink, to where
// it is without that row, on either side.
TEST(Strips, EndsDoNotJumpWhenARowIsGone) {
  const int ny = 9;
  const double dy = 6e-4;
  const grid g{61, ny, 2e-4, dy, -6.1e-3, -2.4e-3};
  for (bool mirrored : {false, true}) {
    const auto end_at = [&](double share) {
      std::vector<profile> across;
      for (double load : {0.0, share * 3, 3.0, 5.5, 7.0, 6.5, 4.5, 2.0, 0.0})
        across.push_back({1e6 * load, 0, 9e-6});
      if (mirrored) std::reverse(across.begin(), across.end());
      contact_rows rows(5, 5, ny);
      rows.set_pressure(g, pressed(g, across).data());
      return mirrored ? -high_end(rows) : low_end(rows);
    };
    // the parabola through the three rows next to the outermost one, loads 3, 5.5, 7
    const double bend = 7 - 2 * 5.5 + 3, slope = 5.5 - 3 - 0.5 * bend;
    const double t = (-slope + std::sqrt(slope * slope - 2 * bend * 3)) / bend;
    const double with = g.y(2) + dy * std::clamp(t, -1.5, -0.5);
    for (double share : {0.1, 0.15, 0.3}) EXPECT_NEAR(end_at(share), with, 1e-12);
    const double without = end_at(0);
    EXPECT_NEAR(end_at(1e-9), without, 1e-9 * dy);
    EXPECT_GT(std::abs(with - without), 0.05 * dy);
    double before = without, rise = 0;
    for (int k = 1; k <= 100; ++k) {
      const double now = end_at(0.1 * k / 100), next = now - before;
      EXPECT_LE(std::abs(next), 0.016 * std::abs(with - without)) << k;
      // of a smooth step's slope, never over 3/2 of its mean, nothing jumps
      EXPECT_LE(std::abs(next - rise), 7e-4 * std::abs(with - without)) << k;
      before = now;
      rise = next;
    }
    EXPECT_NEAR(before, with, 1e-12);
  }
}

}  // namespace
