// Ellipses that stand for a pressure: of Hertz's the ellipse itself, of separate parts one each,
// and nothing jumps as parts come near and become one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fast/pressed_ellipses.hpp"

namespace {

using namespace railpatch;

struct pressed {
  double a, b, x, y, peak;
  double at(double u, double v) const {
    const double r = std::pow((u - x) / a, 2) + std::pow((v - y) / b, 2);
    return peak * std::sqrt(std::max(0.0, 1.0 - r));
  }
  double force() const { return 2.0 / 3.0 * 3.14159265358979 * a * b * peak; }
};

std::vector<double> sampled(const grid &g, const std::vector<pressed> &parts) {
  std::vector<double> p;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      double sum = 0;
      for (const pressed &part : parts) sum += part.at(g.x(i), g.y(j));
      p.push_back(sum);
    }
  return p;
}

const grid fine{120, 160, 1e-4, 1e-4, -5.95e-3, -7.95e-3};

TEST(PressedEllipses, AreHertzsOwn) {
  pressed_ellipses<double> ellipses(fine.ny);
  for (const pressed part :
       {pressed{4e-3, 2e-3, 1e-3, -2e-3, 1e9}, {2e-3, 6e-3, -3e-3, 1e-3, 1e8}}) {
    ellipses.set({fine, sampled(fine, {part}).data()});
    ASSERT_EQ(ellipses.count(), 1);
    const basic_pressed_ellipse<double> &found = ellipses[0];
    EXPECT_EQ(found.share, 1);
    EXPECT_NEAR(found.load, 1, 1e-15);
    // pressure at the middle of elements stands for its mean: 5/24 of the squared element over the
    // axis, and what sums leave at the edge
    const auto bound = [](double axis) { return 5.0 / 24 * 1e-8 / axis + 1e-3 * axis; };
    EXPECT_NEAR(found.axes[0], part.a, bound(part.a));
    EXPECT_NEAR(found.axes[1], part.b, bound(part.b));
    EXPECT_NEAR(found.centre[0], part.x, 1e-3 * part.a);
    EXPECT_NEAR(found.centre[1], part.y, 1e-3 * part.b);
  }
}

TEST(PressedEllipses, OfSeparatePartsAreOneEach) {
  const std::vector<pressed> parts = {{2e-3, 1e-3, 1e-3, -6e-3, 1e9},
                                      {4e-3, 2e-3, -1e-3, -1e-3, 3e8},
                                      {3e-3, 1.5e-3, 0, 4e-3, 5e8}};
  double whole = 0;
  for (const pressed &part : parts) whole += part.force();
  pressed_ellipses<double> ellipses(fine.ny);
  ellipses.set({fine, sampled(fine, parts).data()});
  ASSERT_EQ(ellipses.count(), 3);
  for (int k = 0; k < 3; ++k) {
    const pressed &part = parts[static_cast<size_t>(k)];
    EXPECT_EQ(ellipses[k].share, 1);
    EXPECT_NEAR(ellipses[k].load, part.force() / whole, 2e-3);
    EXPECT_NEAR(ellipses[k].axes[0], part.a, 5e-3 * part.a);
    EXPECT_NEAR(ellipses[k].axes[1], part.b, 5e-3 * part.b);
    EXPECT_NEAR(ellipses[k].centre[0], part.x, 2e-3 * part.a);
    EXPECT_NEAR(ellipses[k].centre[1], part.y, 2e-3 * part.b);
  }
}

// Sums with the shares, of quantities that add up over parts: load, and such as the forces on them
// depend on.
std::vector<double> summed(const pressed_ellipses<double> &ellipses) {
  std::vector<double> sums(5, 0.0);
  for (int k = 0; k < ellipses.count(); ++k) {
    const basic_pressed_ellipse<double> &e = ellipses[k];
    const double part = e.share * e.load;
    const double terms[] = {1.0, e.centre[0], e.centre[1], e.axes[0], e.axes[1]};
    for (size_t n = 0; n < sums.size(); ++n) sums[n] += part * terms[n] / (n > 0 ? 1e-3 : 1.0);
  }
  return sums;
}

double apart(const std::vector<double> &a, const std::vector<double> &b) {
  double most = 0;
  for (size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

// Three parts of which two pass over each other, on a coarse grid. Intervals are halved towards the
// greater change.
TEST(PressedEllipses, DoNotJumpAsPartsBecomeOne) {
  const grid g{24, 32, 5e-4, 5e-4, -5.75e-3, -7.75e-3};
  pressed_ellipses<double> ellipses(g.ny);
  int least = 99, greatest = 0;
  const auto at = [&](double s) {
    ellipses.set({g, sampled(g, {{2e-3, 1.5e-3, 1e-3, -6e-3 + 8e-3 * s, 1e9},
                                 {4e-3, 2e-3, -1e-3, 0, 3e8},
                                 {3e-3, 1.5e-3, 0, 5e-3 - 3e-3 * s, 5e8}})
                         .data()});
    least = std::min(least, ellipses.count()), greatest = std::max(greatest, ellipses.count());
    return summed(ellipses);
  };
  double worst = 0, change = 0;
  for (int n = 0; n < 400; ++n) {
    double low = n / 400.0, high = (n + 1) / 400.0;
    std::vector<double> a = at(low), b = at(high);
    EXPECT_NEAR(a[0], 1.0, 1e-12);
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
  EXPECT_EQ(least, 1);
  EXPECT_GE(greatest, 3);
  EXPECT_GT(change, 0.01);
  EXPECT_LT(worst, 1e-6);
}

}  // namespace
