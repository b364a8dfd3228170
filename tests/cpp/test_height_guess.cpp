// Where a search for the height begins on profiles that vary along the way: paths that parabolas
// tell are told to rounding, and where they turn what turns not goes on.
#include "wheel/height_guess.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace railpatch;

constexpr double load = 8e4, step = 1e-4;  // N, m

double parabola(double x) { return 6e-5 + 2e-3 * x - 3.0 * x * x; }  // m

// Steps from 0 on, of a depth and of a first touch; the guess at the next place.
template <class Depth, class Touch>
double after(int steps, Depth &&depth, Touch &&touch) {
  height_guess guess;
  for (int k = 0; k < steps; ++k)
    guess.keep(depth(k * step), 0, 1, {k * step, touch(k * step), load});
  const double x = steps * step;
  return guess.depth(guess.found, {x, touch(x), load});
}

const auto level = [](double) { return 0.0; };

TEST(HeightGuess, GoesOnByAParabola) {
  EXPECT_DOUBLE_EQ(after(1, parabola, level), parabola(0));
  EXPECT_NEAR(after(2, parabola, level), 2 * parabola(step) - parabola(0), 1e-18);
  // which four steps have shown to be one
  for (const int steps : {4, 5, 9})
    EXPECT_NEAR(after(steps, parabola, level), parabola(steps * step), 1e-17) << steps;
}

// Not where the depth jumps to and fro: then it stays as it was, or its line goes on.
TEST(HeightGuess, GoesOnByWhatToldTheLastStep) {
  const auto jumps = [](double x) { return 6e-5 + (std::lround(x / step) % 2 ? 1e-6 : 0.0); };
  const double found = after(8, jumps, level);
  EXPECT_GT(found, 6e-5 - 1.01e-6);
  EXPECT_LT(found, 6e-5 + 2.01e-6);
}

// First touch goes over to another part of the rail, and the height does not turn.
TEST(HeightGuess, GoesOnByTheHeightWhereFirstTouchTurns) {
  const auto height = [](double x) { return 1e-4 + 3e-3 * x + 2.0 * x * x; };
  for (const int turn : {4, 6, 7}) {
    const auto touch = [&](double x) { return std::fmin(0.01 * (x - turn * step), 0.0); };
    const auto depth = [&](double x) { return height(x) - touch(x); };
    for (const int steps : {7, 8, 9})
      EXPECT_NEAR(after(steps, depth, touch), depth(steps * step), 1e-15) << turn << ' ' << steps;
  }
}

// A step that was solved to within a tolerance tells the depth that carries its force, and another
// force takes it as Hertz's law says.
TEST(HeightGuess, ScalesToTheForce) {
  const auto depth_of = [](double force) {
    return 6e-5 * std::cbrt(force / load * (force / load));
  };
  height_guess guess;
  for (int k = 0; k < 4; ++k) {
    const double off = k % 2 ? 1e-5 : -1e-5, force = load * (1 + 0.1 * k);
    guess.keep(depth_of(force * (1 + off)), off, 1, {k * step, 0.0, force});
  }
  EXPECT_NEAR(guess.depth(guess.found, {4 * step, 0.0, 2 * load}) / depth_of(2 * load), 1, 1e-9);
}

// What the last step left is taken as it is where it is another depth, as on another grid.
TEST(HeightGuess, OfAnotherDepthIsThat) {
  height_guess guess;
  EXPECT_EQ(guess.depth(5e-5, {0.0, 0.0, load}), 5e-5);
  for (int k = 0; k < 4; ++k) guess.keep(parabola(k * step), 0, 1, {k * step, 0.0, load});
  EXPECT_EQ(guess.depth(5e-5, {4 * step, 0.0, load}), 5e-5);
  // nor far beyond the last step, nor after one without contact
  EXPECT_EQ(guess.depth(guess.found, {9 * step, 0.0, load}), guess.found);
  guess.keep(0, 0, 1, {4 * step, 0.0, load});
  EXPECT_EQ(guess.depth(guess.found, {5 * step, 0.0, load}), 0.0);
}

}  // namespace
