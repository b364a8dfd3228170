// FASTSIM row by row: a row whose contact has a gap is two contacts behind each other.
#include <gtest/gtest.h>

#include <array>

#include "fast/fastsim.hpp"
#include "railpatch.h"

namespace {

constexpr int columns = 12;
constexpr double size = 1.0 / 1024;  // m, of an element: places without rounding
using row = std::array<double, columns>;

struct solution {
  row px{}, py{}, sx{}, sy{};
  std::array<unsigned char, columns> division{};
};

solution solve(const row &pressure, double leading, double trailing, int direction) {
  const railpatch::grid g{columns, 1, size, size, 0.0, 0.0};
  row bound = pressure;
  for (double &b : bound) b *= 0.3;
  railpatch::rolling_input input;
  input.creepage[0] = 1e-3;
  input.creepage[1] = -5e-4;
  input.direction = direction;
  solution s;
  railpatch::fastsim(g, pressure.data(), bound.data(), {&leading, &trailing, 0.0},
                     {2e-14, 3e-14, 4e-14}, false, input,
                     {s.px.data(), s.py.data(), s.sx.data(), s.sy.data(), s.division.data()});
  return s;
}

class Fastsim : public testing::TestWithParam<int> {};

TEST_P(Fastsim, TractionDoesNotCrossAGap) {
  const bool forward = GetParam() > 0;
  const row both{0, 1e9, 1e9, 1e9, 1e9, 0, 0, 1e9, 1e9, 1e9, 1e9, 0};
  row behind = both;
  for (int i = 0; i < 6; ++i) behind[static_cast<size_t>(forward ? 11 - i : i)] = 0;
  const double front = (forward ? 10.5 : 0.5) * size, rear = (forward ? 0.5 : 10.5) * size;
  const double after_gap = (forward ? 4.5 : 6.5) * size;
  const solution whole = solve(both, front, rear, GetParam());
  const solution alone = solve(behind, after_gap, rear, GetParam());
  for (size_t i = 0; i < columns; ++i) {
    if (!(behind[i] > 0)) continue;
    EXPECT_NE(alone.px[i], 0.0);
    EXPECT_DOUBLE_EQ(whole.px[i], alone.px[i]) << i;
    EXPECT_DOUBLE_EQ(whole.py[i], alone.py[i]) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Directions, Fastsim, testing::Values(1, -1));

}  // namespace
