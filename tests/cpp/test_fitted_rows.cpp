// Rows fitted to the contact area carry the load of the pressure they are made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tangential/contact_rows.hpp"

namespace {

using namespace railpatch;

double force_of(const contact_rows &rows) {
  double sum = 0;
  for (int j = 0; j < rows.count(); ++j)
    for (int k = 0; k < rows.nodes(); ++k) sum += rows.pressure(j, k) * rows.area(j, k);
  return sum;
}

TEST(ContactRows, CarryTheForceOfAnyPressure) {
  const int nx = 9, ny = 7;
  const grid g{nx, ny, 1e-3, 2e-3, -4e-3, -6e-3};
  // one element; one row; one column; two separate pieces; all
  const auto in_contact = [](int shape, int i, int j) {
    switch (shape) {
      case 0:
        return i == 3 && j == 2;
      case 1:
        return j == 6;
      case 2:
        return i == 0;
      case 3:
        return j < 2 || (j > 4 && i > 5);
      default:
        return true;
    }
  };
  for (int shape = 0; shape < 5; ++shape)
    for (int strips : {3, 4, 11, 64}) {
      contact_rows rows(5, strips, ny);
      std::vector<double> p(static_cast<size_t>(nx * ny), 0.0);
      double force = 0;
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          if (in_contact(shape, i, j)) {
            p[static_cast<size_t>(j * nx + i)] = 1e8 * (1 + i + 2 * j);
            force += p[static_cast<size_t>(j * nx + i)] * g.dx * g.dy;
          }
      rows.set_pressure(g, p.data());
      SCOPED_TRACE("shape " + std::to_string(shape) + ", strips " + std::to_string(strips));
      ASSERT_GT(rows.count(), 0);
      ASSERT_LE(rows.count(), strips);
      EXPECT_NEAR(force_of(rows), force, 1e-12 * force);
      for (int j = 0; j < rows.count(); ++j) {
        const contact_row &row = rows[j];
        EXPECT_TRUE(row.half_length > 0 && row.peak > 0 && row.height > 0);
        // inside the grid, areas of few rows a quarter of an element beyond; neighbours in order
        const double beyond = shape == 3 ? 0.7501 : 0.5001;
        EXPECT_GE(row.y - 0.5 * row.height, g.y(0) - beyond * g.dy);
        EXPECT_LE(row.y + 0.5 * row.height, g.y(ny - 1) + beyond * g.dy);
        EXPECT_TRUE(j == 0 || row.y > rows[j - 1].y);
      }
    }
}

// Half an ellipsoid of pressure about x = 0, y; unit peak.
struct ellipsoid {
  double a, b, y;
  double squared(double v) const { return 1.0 - (v - y) * (v - y) / (b * b); }
  double operator()(double x, double v) const {
    return std::sqrt(std::max(0.0, squared(v) - x * x / (a * a)));
  }
};

std::vector<double> sampled(const grid &g, const std::vector<ellipsoid> &parts) {
  std::vector<double> p(static_cast<size_t>(g.count()), 0.0);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i)
      for (const ellipsoid &part : parts)
        p[static_cast<size_t>(j * g.nx + i)] += part(g.x(i), g.y(j));
  return p;
}

// One of two areas is narrow and carries most: strips lie in contact only, and each area has its
// own force.
TEST(ContactRows, OfSeparateAreasCarryTheForceOfEach) {
  const int nx = 60, ny = 40;
  const grid g{nx, ny, 2e-4, 3e-4, -5.9e-3, -5.85e-3};
  const ellipsoid parts[2] = {{4e-3, 6e-4, -4.5e-3}, {1e-3, 1.5e-3, 3.5e-3}};
  for (int strips : {2, 7, 14}) {
    contact_rows rows(5, strips, ny);
    const std::vector<double> p = sampled(g, {parts[0], parts[1]});
    rows.set_pressure(g, p.data());
    ASSERT_EQ(rows.count(), strips);
    double force[2] = {0, 0}, exact[2] = {0, 0};
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        exact[g.y(j) > 0] += p[static_cast<size_t>(j * nx + i)] * g.dx * g.dy;
    int count[2] = {0, 0};
    for (int j = 0; j < rows.count(); ++j) {
      const contact_row &row = rows[j];
      const ellipsoid &part = parts[row.y > 0];
      ++count[row.y > 0];
      // to an element
      EXPECT_LE(std::abs(row.y - part.y) + 0.5 * row.height, part.b + g.dy);
      for (int k = 0; k < rows.nodes(); ++k)
        force[row.y > 0] += rows.pressure(j, k) * rows.area(j, k);
    }
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(force[k], exact[k], 1e-12 * exact[k]);
    // the one that carries more has more than its share of the width
    EXPECT_GT(count[0], strips * parts[0].b / (parts[0].b + parts[1].b));
  }
}

// Chords of an ellipse that few rows of the grid cross, all over the shift of the grid.
TEST(ContactRows, FollowAnEllipseThatFewGridRowsCross) {
  const int nx = 100, ny = 12, strips = 8;
  const ellipsoid part{4e-3, 1e-3, 0.0};
  for (double dy : {2.5e-4, 2e-4})
    for (double shift = 0; shift < 1; shift += 0.1) {
      const grid g{nx, ny, 1e-4, dy, -4.95e-3, dy * (shift - 0.5 * ny)};
      contact_rows rows(9, strips, ny);
      const std::vector<double> p = sampled(g, {part});
      rows.set_pressure(g, p.data());
      ASSERT_EQ(rows.count(), strips);
      SCOPED_TRACE("dy " + std::to_string(dy) + ", shift " + std::to_string(shift));
      // the ends to half an element
      EXPECT_NEAR(rows[0].y - 0.5 * rows[0].height, -part.b, 0.5001 * dy);
      EXPECT_NEAR(rows[strips - 1].y + 0.5 * rows[strips - 1].height, part.b, 0.5001 * dy);
      for (int j = 1; j + 1 < strips; ++j) {
        const contact_row &row = rows[j];
        // mean over the strip; straight lines between the grid's rows err by dy^2/6 and more
        const double h = 0.5 * row.height / part.b;
        const double exact = part.a * std::sqrt(part.squared(row.y) - h * h / 3.0);
        EXPECT_NEAR(row.half_length, exact, 0.015 * part.a) << row.y;
        EXPECT_NEAR(row.x, 0.0, 1e-12);
      }
    }
}

// Whatever they were fitted to before.
TEST(ContactRows, AreThoseOfThePressureAlone) {
  std::mt19937_64 random(20261123);
  std::uniform_real_distribution<double> part(0, 1);
  const int nx = 9, ny = 21;
  const grid g{nx, ny, 1e-3, 1e-3, -4e-3, -10e-3};
  // rows between two borders, the outermost ones hardly loaded
  const auto pressure = [&] {
    std::vector<double> p(static_cast<size_t>(nx * ny), 0.0);
    const double middle = 4 + 12 * part(random), half = 1 + 6 * part(random);
    const double peak = std::pow(10.0, 6 + 3 * part(random));
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double u = (j - middle) / half, v = (i - 4) / 4.5;
        p[static_cast<size_t>(j * nx + i)] = peak * std::sqrt(std::max(0.0, 1 - u * u - v * v));
      }
    return p;
  };
  contact_rows used(7, 12, ny);
  for (int n = 0; n < 2000; ++n) {
    const std::vector<double> p = pressure();
    contact_rows fresh(7, 12, ny);
    fresh.set_pressure(g, p.data());
    used.set_pressure(g, p.data());
    ASSERT_EQ(used.count(), fresh.count());
    for (int j = 0; j < fresh.count(); ++j) {
      EXPECT_EQ(used[j].y, fresh[j].y) << "pressure " << n << ", row " << j;
      EXPECT_EQ(used[j].height, fresh[j].height);
      EXPECT_EQ(used[j].half_length, fresh[j].half_length);
      EXPECT_EQ(used[j].peak, fresh[j].peak);
    }
  }
}

TEST(ContactRows, AreEmptyWithoutPressure) {
  const grid g{4, 4, 1e-3, 1e-3, -1.5e-3, -1.5e-3};
  contact_rows rows(5, 6, 4);
  const std::vector<double> p(16, 0.0);
  rows.set_pressure(g, p.data());
  EXPECT_EQ(rows.count(), 0);
}

// What rows are: lower edge, height, middle and half length of the chord, peak; of grids with unit
// elements and pressures about 1.
std::vector<double> described(const contact_rows &rows) {
  std::vector<double> all;
  for (int j = 0; j < rows.count(); ++j) {
    const contact_row &row = rows[j];
    for (double value :
         {row.y - 0.5 * row.height, row.height, row.x, row.half_length, row.peak * row.height})
      all.push_back(value);
  }
  return all;
}

double apart(const std::vector<double> &a, const std::vector<double> &b) {
  double most = a.size() == b.size() ? 0.0 : 1e9;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

// Grid rows that lie side by side, of which outer ones lose their load and others get one: rows
// change as evenly as pressure does. Intervals are halved towards the greater change.
TEST(ContactRows, DoNotJumpAsGridRowsComeAndGo) {
  const int nx = 6, ny = 9, strips = 6;
  const grid g{nx, ny, 1.0, 1.0, -2.5, -4.0};
  std::mt19937 random(20261123);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  contact_rows rows(5, strips, ny);
  // all rows between the first and the last one have load, of a bulge and at random
  const auto drawn = [&](int first, int last) {
    std::vector<double> p(static_cast<size_t>(g.count()), 0.0);
    for (int j = first; j <= last; ++j) {
      const double t = (j - 0.5 * (first + last)) / (0.5 * (last - first) + 0.5);
      const double most = (0.2 + uniform(random)) * (1.0 - t * t);
      for (int i = 0; i < nx; ++i)
        p[static_cast<size_t>(j * nx + i)] = most * (0.05 + uniform(random));
    }
    return p;
  };
  double worst = 0, change = 0;
  for (int pair = 0; pair < 60; ++pair) {
    const int first = pair % 4, last = ny - 1 - (pair / 4) % 4;
    const std::vector<double> from = drawn(first, last);
    // the other one has a row less or more at either end
    const std::vector<double> to = drawn(std::max(0, first + (pair % 2 ? 1 : -1)),
                                         std::min(ny - 1, last - (pair % 3 ? 1 : 0)));
    const auto at = [&](double s) {
      std::vector<double> p(from.size());
      for (size_t k = 0; k < p.size(); ++k) p[k] = (1.0 - s) * from[k] + s * to[k];
      rows.set_pressure(g, p.data());
      return described(rows);
    };
    const int steps = 64;
    for (int n = 0; n < steps; ++n) {
      double low = n / double(steps), high = (n + 1) / double(steps);
      std::vector<double> a = at(low), b = at(high);
      change = std::max(change, apart(a, b));
      while (high - low > 1e-12 && apart(a, b) > 1e-6) {
        const double middle = 0.5 * (low + high);
        const std::vector<double> m = at(middle);
        if (apart(a, m) > apart(m, b))
          high = middle, b = m;
        else
          low = middle, a = m;
      }
      worst = std::max(worst, apart(a, b));
    }
  }
  EXPECT_GT(change, 0.01);  // rows did change
  EXPECT_LT(worst, 1e-6);
}

}  // namespace
