// Heat of a step's way, which lies upstream of the element that it is counted at.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "temperature/columns.hpp"

namespace {

using namespace railpatch;

constexpr int nx = 30, ny = 2;

heat_rows rows_of(int direction, double upstream) {
  return {nx, ny, 4e-4, direction, 12.0, upstream};
}

// Smooth, and nothing near the rows' ends.
std::vector<double> flux() {
  std::vector<double> q(nx * ny);
  for (int j = 0; j < ny; ++j)
    for (int i = 9; i < 21; ++i)
      q[static_cast<size_t>(j * nx + i)] = (1 + j) * 1e6 * std::pow(std::sin((i - 8) * 0.24), 2);
  return q;
}

TEST(Upstream, AnElementIsFeltAsFarAsItsWay) {
  heat_kernel kernel(nx);
  kernel.set(rows_of(1, 0.5), 1.0);
  ASSERT_EQ(kernel.count(), nx);
  // constant flux over the passages m to m + 1 (Carslaw and Jaeger 1959, section 2.9)
  const double unit = 2 * std::sqrt(4e-4 / 12.0 / std::numbers::pi);
  for (int m = 0; m < nx; ++m)
    EXPECT_NEAR(kernel.weight(m), unit * (std::sqrt(m + 1.0) - std::sqrt(1.0 * m)), 1e-15);
  // a step of a part of an element: its own heat and no other
  kernel.set(rows_of(1, 0.15), 0.3 * 4e-4);
  ASSERT_EQ(kernel.count(), 1);
  EXPECT_NEAR(kernel.weight(0), unit * std::sqrt(0.3), 1e-15);
}

// What columns store is the flux times the time, wherever they stand between the elements.
TEST(Upstream, ColumnsStoreAllHeat) {
  const std::vector<double> q = flux(), pressure(q.size(), 1.0);
  double sum = 0;
  for (double v : q) sum += v;
  for (int direction : {1, -1})
    for (double upstream : {0.0, 0.2, 0.5}) {
      const heat_rows rows = rows_of(direction, upstream);
      heat_columns columns(nx, ny, false);
      std::vector<double> state(columns.state_size());
      double time = 0;
      for (double part : {0.3, 1.0, 0.6, 1.7, 0.1, 0.45, 2.0, 0.9}) {
        columns.begin(rows, part * rows.dx, pressure.data(), state.data());
        columns.commit(q.data(), pressure.data(), state.data());
        time += part * rows.dx / rows.speed;
        double stored = 0;
        for (int j = 0; j < ny; ++j)
          for (int i = 0; i < nx; ++i) stored += columns.stored(i, j, state.data());
        EXPECT_NEAR(stored, sum * time, 1e-12 * sum * time) << direction << upstream << part;
      }
    }
}

TEST(Upstream, StepsTendToSteadyRolling) {
  const std::vector<double> q = flux(), pressure(q.size(), 1.0);
  for (int direction : {1, -1})
    for (double part : {1.0, 1.4, 0.7, 2.0}) {
      const heat_rows rows = rows_of(direction, 0.5);
      heat_columns columns(nx, ny, false);
      std::vector<double> state(columns.state_size()), y(q.size()), steady(q.size());
      steady_temperature t(nx, false);
      t.set(rows);
      t.rise(q.data(), nullptr, steady.data());
      for (int k = 0; k < 2.5 * nx / part; ++k) {
        columns.begin(rows, part * rows.dx, pressure.data(), state.data());
        columns.rise(q.data(), y.data());
        columns.commit(q.data(), pressure.data(), state.data());
      }
      double greatest = 0, off = 0;
      for (size_t i = 0; i < q.size(); ++i) {
        greatest = std::max(greatest, steady[i]);
        off = std::max(off, std::fabs(y[i] - steady[i]));
      }
      // columns on the centres: the modes' error; between them also that of linear interpolation
      EXPECT_LT(off, (part == std::round(part) ? 1e-6 : 1e-2) * greatest) << direction << part;
    }
}

}  // namespace
