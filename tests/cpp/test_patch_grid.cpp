// How large grids are: margins of unlike bodies, and what Kik and Piotrowski's theory needs.
#include "patch/patch_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace railpatch;

constexpr double modulus = 1.1e11;  // Pa, G/(1 - nu)

TEST(GridRules, MarginsReachAsFarAsTheContactMay) {
  grid_rules rules;
  for (const int n : {2, 7, 1000, 1100}) EXPECT_EQ(rules.with_margin(n), n);
  // the least on either side that covers `reach` times the contact
  for (const double reach : {1.001, 1.125, 1.3, 2.5}) {
    rules.reach = reach;
    for (int n = 2; n <= 400; ++n) {
      const int wide = rules.with_margin(n);
      EXPECT_EQ((wide - n) % 2, 0) << n;
      EXPECT_GE(wide, reach * n * (1 - 1e-12)) << n;
      EXPECT_LT(wide - 2, reach * n * (1 + 1e-12)) << n;
    }
    // up to the most that grids are made of, but not less than the contact itself
    EXPECT_EQ(rules.with_margin(999), 1000);
    EXPECT_EQ(rules.with_margin(1000), 1000);
    EXPECT_EQ(rules.with_margin(1100), 1100);
  }
}

TEST(GridRules, OtherTheoriesNeedHertzsEllipse) {
  const double curvatures[2] = {1.1, 3.2};
  const hertz_contact hertz = hertz_from_force(curvatures, modulus, 1e5);
  for (const bool force : {false, true}) {
    grid_rules rules;
    rules.force_given = force;
    for (int k = 0; k < 2; ++k) EXPECT_EQ(rules.relative_size(hertz, k), 1);
  }
}

// Its region is where the undeformed paraboloid lies within 0.55 of the approach; the contact is an
// ellipse of the same area with Hertz's axis ratio. At equal force the approach is the one at which
// that ellipse carries it: the ellipse is s times Hertz's at equal approach, and so is its force,
// which grows with the power 3/2 of the approach, the sizes with the power 1/2.
TEST(GridRules, KikAndPiotrowskisCoversItsRegionAndItsContact) {
  grid_rules rules;
  rules.interpenetrates = true;
  for (const double b : {0.2, 1.1, 3.2, 20.0}) {
    const double curvatures[2] = {1.1, b};
    const hertz_contact hertz = hertz_from_force(curvatures, modulus, 1e5);
    double region[2], s = 1;
    for (int k = 0; k < 2; ++k) region[k] = std::sqrt(0.55 * hertz.approach / curvatures[k]);
    s = std::sqrt(region[0] * region[1] / (hertz.semi_axes[0] * hertz.semi_axes[1]));
    // of the approach at which the force is Hertz's
    const double less = std::pow(1 / s, 2.0 / 3);
    for (int k = 0; k < 2; ++k) {
      const double needed = std::max(region[k], s * hertz.semi_axes[k]) / hertz.semi_axes[k];
      rules.force_given = false;
      EXPECT_NEAR(rules.relative_size(hertz, k), needed, 1e-12 * needed) << b;
      rules.force_given = true;
      EXPECT_NEAR(rules.relative_size(hertz, k), std::sqrt(less) * needed, 1e-12 * needed) << b;
    }
  }
}

}  // namespace
