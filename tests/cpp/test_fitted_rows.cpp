// Rows fitted to the contact area carry the load of the pressure they are made from.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "contact_rows.hpp"

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
        // inside the grid, neighbours in order
        EXPECT_GE(row.y - 0.5 * row.height, g.y(0) - 0.5001 * g.dy);
        EXPECT_LE(row.y + 0.5 * row.height, g.y(ny - 1) + 0.5001 * g.dy);
        EXPECT_TRUE(j == 0 || row.y > rows[j - 1].y);
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

}  // namespace
