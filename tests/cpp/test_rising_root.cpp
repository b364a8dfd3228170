// The bracketed search for a root, on functions whose roots are known.
#include "numeric/rising_root.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace {

using railpatch::rising_root;

struct ended {
  double at;
  int reports;
  bool exhausted;
};

// Until the value is below the tolerance or the search gives up; NaN is not known.
ended search(const std::function<double(double)> &f, double start, double step, double tolerance) {
  rising_root root(start, step, 100.0);
  int reports = 0;
  while (!root.exhausted()) {
    const double value = f(root.at());
    if (std::fabs(value) <= tolerance) return {root.at(), reports, false};
    std::isnan(value) ? root.report_unknown() : root.report(value);
    if (++reports > 500) break;
  }
  return {root.at(), reports, root.exhausted()};
}

TEST(RisingRoot, IsFoundFromEitherSide) {
  for (const double root : {-3.0, 0.2, 7.0})
    for (const double start : {-10.0, 0.0, 10.0}) {
      const ended line = search([=](double x) { return 4 * (x - root); }, start, 0.1, 1e-12);
      EXPECT_NEAR(line.at, root, 1e-12);
      EXPECT_LE(line.reports, 16);
      const ended cubic = search([=](double x) { return std::pow(x - root, 3) + 0.1 * (x - root); },
                                 start, 0.1, 1e-12);
      EXPECT_NEAR(cubic.at, root, 1e-10);
      EXPECT_LE(cubic.reports, 25);
      // as steep as a jump but for a millionth
      const ended steep =
          search([=](double x) { return std::tanh(1e6 * (x - root)); }, start, 0.1, 1e-6);
      EXPECT_NEAR(steep.at, root, 2e-12);
      EXPECT_LE(steep.reports, 70);
    }
}

TEST(RisingRoot, BendsDoNotCatchIt) {
  const auto bent = [](double x) { return x - 3 + 2 * std::sin(20 * x); };
  for (const double start : {-10.0, 0.0, 10.0}) {
    const ended found = search(bent, start, 0.01, 1e-12);
    EXPECT_FALSE(found.exhausted);
    EXPECT_NEAR(bent(found.at), 0, 1e-12);
    EXPECT_LE(found.reports, 40);
  }
}

TEST(RisingRoot, TurnsBackWhereNothingIsKnown) {
  const auto known_below = [](double limit) {
    return [limit](double x) { return x < limit ? x - 1 : std::nan(""); };
  };
  const ended found = search(known_below(1.001), -4, 0.5, 1e-12);
  EXPECT_NEAR(found.at, 1, 1e-12);
  // the root is where nothing is known
  EXPECT_TRUE(search(known_below(0.9), -4, 0.5, 1e-12).exhausted);
}

TEST(RisingRoot, JumpsAndMissingRootsEnd) {
  const ended jump = search([](double x) { return x < 0.3 ? -1.0 : 1.0; }, 0, 0.1, 1e-3);
  EXPECT_TRUE(jump.exhausted);
  EXPECT_NEAR(jump.at, 0.3, 1e-14);
  const ended none = search([](double) { return -1.0; }, 0, 0.1, 1e-3);
  EXPECT_TRUE(none.exhausted);
  EXPECT_LE(none.reports, 12);
}

}  // namespace
