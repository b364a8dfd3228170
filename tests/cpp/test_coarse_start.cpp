// The start from a coarser grid where the solution is known: tractions so small that they move
// nothing, under creepages whose spin pole lies outside, slide against the rigid slip. Its
// direction is a smooth field, of which the start is to be a second-order interpolation.
#include "tangential/coarse_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace railpatch;

// greatest error of the direction well inside, by what half an element's place would change
double error_of(int n, double pole_x, double pole_y) {
  const double size = 1.0 / n;  // mm, of a contact of 1 mm
  const double unit = 1e-3;
  const grid g{
      n, n, size * unit, size * unit, (0.5 * size - 0.5) * unit, (0.5 * size - 0.5) * unit};
  const double shear[2] = {8e10, 8e10}, poisson[2] = {0.28, 0.28};
  const influence::medium medium{combine(shear, poisson)};
  const fft_plans plans({smooth_size(2 * n + 1)}, {smooth_size(2 * n - 1)});
  coarse_start start(medium, plans, n, n);
  rolling_input input;
  input.spin_creepage = 1.0;
  input.creepage[0] = input.spin_creepage * pole_y * unit;
  input.creepage[1] = -input.spin_creepage * pole_x * unit;
  const auto count = static_cast<size_t>(g.count());
  std::vector<double> pressure(count), bound(count), px(count), py(count), sx(count), sy(count);
  std::vector<unsigned char> division(count);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double r = std::hypot(g.x(i), g.y(j)) / (0.5 * unit);
      const auto at = static_cast<size_t>(j * n + i);
      pressure[at] = r < 1 ? 1e3 * std::sqrt(1 - r * r) : 0;
      bound[at] = 0.3 * pressure[at];
    }
  start.find(g, pressure.data(), bound.data(), input, {1e-8, 100},
             {px.data(), py.data(), sx.data(), sy.data(), division.data()});
  double worst = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<size_t>(j * n + i);
      const double x = g.x(i) / unit, y = g.y(j) / unit;
      if (!(bound[at] > 0)) {
        EXPECT_EQ(px[at], 0.0);
        EXPECT_EQ(py[at], 0.0);
        continue;
      }
      EXPECT_LE(std::hypot(px[at], py[at]), bound[at] * (1 + 1e-12));
      // all four coarse elements lie within
      if (std::hypot(x, y) > 0.5 - 4 * size) continue;
      const double w[2] = {pole_y - y, x - pole_x}, speed = std::hypot(w[0], w[1]);
      worst = std::max(
          worst, std::hypot(px[at] / bound[at] + w[0] / speed, py[at] / bound[at] + w[1] / speed));
    }
  return worst;
}

TEST(CoarseStart, InterpolatesToSecondOrder) {
  // poles before, behind and beside the contact
  for (const auto &[x, y] : {std::pair{0.9, 0.2}, {-0.9, 0.1}, {0.1, 1.0}, {-0.3, -0.9}}) {
    SCOPED_TRACE(testing::Message() << "pole at " << x << ", " << y);
    // even and odd numbers of elements, and one that is halved twice
    for (int n : {40, 45, 84}) {
      const double distance = std::hypot(x, y) - 0.5, h = 2.0 / n;
      EXPECT_LE(error_of(n, x, y), 0.5 * h * h / (distance * distance)) << n;
    }
  }
}

}  // namespace
