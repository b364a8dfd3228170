// What the depths that a search has tried tell of other depths that carry the same force.
#include "wheel/force_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace railpatch;

constexpr double target = 1e5, root = 1e-4;  // N, m

double hertz(double depth) { return target * std::pow(depth / root, 1.5); }

// A force that rises as a ball's on a plane hides nothing.
TEST(ForceSamples, OfARisingForceTellNoJump) {
  force_samples tried(target);
  for (const double depth : {0.99 * root, 1.01 * root, 1.0001 * root})
    tried.add(depth, hertz(depth));
  EXPECT_TRUE(std::isnan(tried.in_between(root, target)));
  EXPECT_FALSE(tried.jump_near(root, target));
}

// From the last step's depth the force hardly rises, next to the root it does: half-way between
// both it is tried, and a fall on either side is a jump, a rise is none.
TEST(ForceSamples, AskHalfWayWhereAFallMayBeHidden) {
  constexpr double last = root - 3e-8, near = root - 2e-9;
  const double at_last = target * (1 - 8e-5), at_near = target * (1 - 3e-5);
  for (const double share : {-0.5, 0.5, 4.0}) {
    force_samples tried(target);
    tried.add(last, at_last);
    tried.add(near, at_near);
    const double between = tried.in_between(root, target);
    EXPECT_DOUBLE_EQ(between, 0.5 * (last + root));
    tried.add_between(root, at_last + share * (target - at_last), target);
    EXPECT_EQ(tried.jump_near(root, target), share < 0 || share > 1) << share;
  }
}

// A deeper place that carries less, and a step that ends farther off than the force explains.
TEST(ForceSamples, TellJumpsByWhatWasTried) {
  force_samples deeper(target);
  deeper.add(0.999 * root, hertz(0.999 * root));
  deeper.add(1.05 * root, 0.99 * target);
  EXPECT_TRUE(deeper.jump_near(root, target));
  force_samples far(target);
  far.add(0.9 * root, 0.9995 * target);
  far.add(0.999 * root, hertz(0.999 * root));
  EXPECT_TRUE(far.jump_near(root, target));
}

}  // namespace
