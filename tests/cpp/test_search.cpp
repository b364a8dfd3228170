// Searches for fixed points and for depths on functions whose answer is known, and what they take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "numeric/fixed_point.hpp"
#include "numeric/force_search.hpp"

namespace {

using namespace railpatch;
using vector = std::vector<double>;

// --- fixed points ----------------------------------------------------------------------------

// Evaluations of g until |g(x) - x| is below the tolerance.
template <class G>
int evaluations(fixed_point &search, vector &x, double tolerance, int most, G &&g) {
  search.begin(x.size());
  for (int k = 1; k <= most; ++k) {
    const vector gx = g(x);
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) sum += (gx[i] - x[i]) * (gx[i] - x[i]);
    if (std::sqrt(sum) <= tolerance) return k;
    search.advance(x.data(), gx.data());
  }
  return most + 1;
}

// g(x) = x* + M (x - x*) with eigenvalues along the axes
struct affine {
  vector point, eigenvalue;
  vector operator()(const vector &x) const {
    vector out(x.size());
    for (size_t i = 0; i < x.size(); ++i) out[i] = point[i] + eigenvalue[i] * (x[i] - point[i]);
    return out;
  }
};

// On an affine map of n directions the method is GMRES in disguise: n differences, with the start
// and the last check two evaluations more.
TEST(FixedPoint, OfAnAffineMapIsFoundInAsManyStepsAsDirections) {
  fixed_point search(16);
  for (size_t n : {1u, 2u, 3u, 5u}) {
    affine g{vector(n), vector(n)};
    for (size_t i = 0; i < n; ++i) {
      g.point[i] = 1.0 + static_cast<double>(i);
      g.eigenvalue[i] = 0.9 - 0.4 * static_cast<double>(i);
    }
    vector x(n, 0.0);
    const int count = evaluations(search, x, 1e-5, 40, g);
    EXPECT_LE(count, static_cast<int>(n) + 2) << n;
    for (size_t i = 0; i < n; ++i) EXPECT_NEAR(x[i], g.point[i], 1e-4) << n;
  }
}

// The first step is plain: x becomes g(x).
TEST(FixedPoint, BeginsWithAPlainStep) {
  fixed_point search(3);
  for (int again = 0; again < 2; ++again) {
    search.begin(2);
    vector x{1, 2, 9};
    const vector gx{4, -1};
    search.advance(x.data(), gx.data());
    EXPECT_EQ(x, (vector{4, -1, 9}));
    // the second is the secant's through both remainders
    const vector second{4.5, -1.5};
    search.advance(x.data(), second.data());
    const double r0[2] = {3, -3}, r1[2] = {0.5, -0.5};
    double over = 0, under = 0;
    for (int i = 0; i < 2; ++i) {
      over += (r1[i] - r0[i]) * r1[i];
      under += (r1[i] - r0[i]) * (r1[i] - r0[i]);
    }
    const double share = over / under;
    for (int i = 0; i < 2; ++i) {
      const double at = i == 0 ? 4 : -1, before = i == 0 ? 1 : 2;
      EXPECT_NEAR(x[static_cast<size_t>(i)], at + r1[i] - share * ((at - before) + (r1[i] - r0[i])),
                  1e-11);
    }
  }
}

// More directions than are remembered, far beyond contraction in some: found all the same, in
// many times fewer steps than a plain iteration of the least damping would take.
TEST(FixedPoint, IsFoundWherePlainStepsDiverge) {
  fixed_point search(16);
  for (double worst : {-3.0, -20.0}) {
    affine g{vector(12), vector(12)};
    for (size_t i = 0; i < 12; ++i) {
      g.point[i] = std::sin(1.0 + static_cast<double>(i));
      g.eigenvalue[i] = 0.5 + (worst - 0.5) * static_cast<double>(i) / 11;
    }
    vector x(12, 0.0);
    EXPECT_LE(evaluations(search, x, 1e-9, 400, g), 400) << worst;
    for (size_t i = 0; i < 12; ++i) EXPECT_NEAR(x[i], g.point[i], 1e-8);
  }
}

// Where the remainder grows to more than twice the least, the search is back at the best point, and
// from there takes the step along the remainder half as long as before, with nothing of the past.
TEST(FixedPoint, GoesBackToTheBestPointWithHalfTheStep) {
  fixed_point search(1);
  search.begin(1);
  double x = 1, gx = 2;
  search.advance(&x, &gx);  // remainder 1
  EXPECT_EQ(x, 2);
  double step = 1;
  for (int k = 0; k < 8; ++k) {
    gx = x + 2.01;
    search.advance(&x, &gx);
    step *= 0.5;
    EXPECT_EQ(x, 1 + step) << k;
  }
  // the least step: from now on forward whatever comes
  gx = x + 5;
  search.advance(&x, &gx);
  EXPECT_NE(x, 1 + 0.5 * step);

  // twice as great is not yet too great: the secant's step
  search.begin(1);
  x = 1, gx = 2;
  search.advance(&x, &gx);
  gx = x + 2;
  search.advance(&x, &gx);
  EXPECT_NEAR(x, 0, 1e-10);
  // no number at all is worse than any
  search.begin(1);
  x = 1, gx = 2;
  search.advance(&x, &gx);
  gx = std::nan("");
  search.advance(&x, &gx);
  EXPECT_EQ(x, 1.5);
  // a remainder less than half of the least doubles the step again, to one at most
  gx = x + 0.4;
  search.advance(&x, &gx);
  // secant from 1 with remainder 1 to 1.5 with 0.4, in one dimension whatever the step
  EXPECT_NEAR(x, 1.5 + 0.4 * 0.5 / 0.6, 1e-9);
}

// Steps that have become short grow again: a remainder that falls to less than half of the least
// doubles them, another that falls does not.
TEST(FixedPoint, StepsGrowAgain) {
  for (double across : {0.4, 0.7}) {
    fixed_point search(2);
    search.begin(2);
    vector x{0, 0};
    const auto advance = [&](double rx, double ry) {
      const vector gx{x[0] + rx, x[1] + ry};
      search.advance(x.data(), gx.data());
    };
    advance(1, 0);
    advance(3, 0);  // back, half the step: at (0.5, 0)
    EXPECT_EQ(x, (vector{0.5, 0}));
    // across: the difference of remainders, (-1, across), takes its share of the new remainder
    const double r[2] = {0, across}, d[2] = {-1, across}, moved[2] = {0.5, 0};
    const double share = (r[0] * d[0] + r[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    const double step = across < 0.5 ? 1.0 : 0.5;
    advance(r[0], r[1]);
    for (size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(x[i], moved[i] + step * r[i] - share * (moved[i] + step * d[i]), 1e-10) << i;
  }
}

TEST(FixedPoint, SaysWhatItHolds) {
  // five differences of both, and five vectors more
  EXPECT_EQ(fixed_point(7).bytes(), 15 * 7 * sizeof(double));
}

// --- depth for a force -----------------------------------------------------------------------

struct found {
  int evaluations = 0;
  double depth = 0;
  bool converged = false, exhausted = false, too_deep = false;
};

// beyond: depth that cannot be evaluated
template <class Force>
found search(double target, double first, double tolerance, Force &&force, double beyond = 1) {
  force_search s(target, first, tolerance);
  found f;
  double low = 0, high = 0.02;
  while (f.evaluations < 200) {
    f.depth = s.depth();
    ++f.evaluations;
    const bool deep = f.depth > beyond;
    const double value = deep ? 0 : force(f.depth);
    s.report(value, deep);
    f.converged = s.converged();
    f.exhausted = s.exhausted();
    f.too_deep = s.too_deep();
    if (f.converged || f.exhausted) break;
    if (deep) {
      EXPECT_EQ(s.residual(), HUGE_VAL);
    } else {
      EXPECT_EQ(s.residual(), std::abs(value - target) / target);
    }
    // the next depth lies between those known as too small and too great
    (deep || value >= target ? high : low) = f.depth;
    EXPECT_GT(s.depth(), low);
    if (high < 0.02) {
      EXPECT_LT(s.depth(), high);
    }
  }
  return f;
}

// Exactly Hertz's law: the rule is exact from the second depth on.
TEST(ForceSearch, OfHertzsLawTakesThreeEvaluations) {
  const auto hertz = [](double depth) { return 3e10 * std::pow(std::max(depth, 0.0), 1.5); };
  const double target = hertz(8e-5);
  for (double first : {1e-6, 4e-5, 7.9e-5, 1e-4, 5e-4}) {
    const found f = search(target, first, 1e-9, hertz);
    EXPECT_TRUE(f.converged) << first;
    EXPECT_LE(f.evaluations, 3) << first;
    EXPECT_NEAR(f.depth, 8e-5, 1e-9 * 8e-5);
    EXPECT_FALSE(f.exhausted || f.too_deep);
  }
  EXPECT_EQ(search(target, 8e-5, 1e-9, hertz).evaluations, 1);
}

// Laws that are not Hertz's at all, from any start: a bracket is halved at the worst.
TEST(ForceSearch, OfOtherLawsIsFound) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 200; ++i) {
    const double at = 1e-3 * std::pow(10.0, -3 * share(random)), late = 0.8 * at * share(random);
    // straight, as the fifth power, and with first touch of a second part, from which it is steep
    const auto straight = [&](double d) { return 1e5 * d / at; };
    const auto steep = [&](double d) { return 1e5 * std::pow(d / at, 5.0); };
    const auto parts = [&](double d) {
      return 1e3 * d / at + 1e5 * std::pow(std::max(0.0, d - late) / (at - late), 1.5);
    };
    const double first = at * std::pow(10.0, 2 * share(random) - 1.5);
    const found gentle[] = {search(straight(at), first, 1e-8, straight),
                            search(parts(at), first, 1e-8, parts)};
    const found all[] = {gentle[0], gentle[1], search(steep(at), first, 1e-8, steep)};
    for (const found &f : all) {
      EXPECT_TRUE(f.converged) << i;
      EXPECT_NEAR(f.depth, at, 1e-6 * at) << i;
    }
    // a bracket of a factor of 30 halved to 1e-8 takes 32, and some steps up come before
    for (const found &f : gentle) EXPECT_LE(f.evaluations, 40) << i;
  }
}

// Where one patch becomes two: continuous, but over some nanometres 20 % of the force are added.
struct steep_rise {
  double stiffness, from, over, share;
  double operator()(double depth) const {
    const double t = std::clamp((depth - from) / over, 0.0, 1.0);
    const double risen = t * t * t * (10 - t * (15 - 6 * t));
    return stiffness * std::pow(depth, 1.5) * (1 + share * risen);
  }
};

// Evaluations of halving alone, from a bracket that is known.
template <class Force>
int halvings(double target, double high, double tolerance, Force &&force) {
  double low = 0;
  for (int count = 1;; ++count) {
    const double middle = 0.5 * (low + high), value = force(middle);
    if (std::abs(value - target) <= tolerance * target) return count;
    (value < target ? low : high) = middle;
  }
}

// Targets from below the foot of the rise to above its top: dearer than halving by no more than the
// steps before and those granted, cheaper in the mean.
TEST(ForceSearch, FindsEveryForceOfASteepRise) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  int sum = 0, sum_of_halvings = 0;
  for (int i = 0; i < 2000; ++i) {
    const double at = 1e-4 * (0.3 + 0.7 * share(random));
    const steep_rise force{5e10, at, std::pow(10.0, -11 + 4 * share(random)), 0.5 * share(random)};
    const double foot = force(at), top = force(at + force.over);
    const double target = foot + (1.4 * share(random) - 0.2) * (top - foot);
    const found f = search(target, at * (0.5 + share(random)), 1e-5, force);
    EXPECT_TRUE(f.converged) << i << " " << target;
    const int halved = halvings(target, 2 * at, 1e-5, force);
    EXPECT_LE(f.evaluations, halved + 8 + 3) << i;
    sum += f.evaluations;
    sum_of_halvings += halved;
  }
  EXPECT_LT(sum, sum_of_halvings);
}

// One who knows the force to a thousandth suggests depths: found at once, wherever on the rise the
// target lies. One who is wrong costs no more than the bound.
TEST(ForceSearch, SuggestedDepthsHelpOrDoNotHinder) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> share(0, 1);
  int sum = 0, sum_of_halvings = 0;
  for (int i = 0; i < 500; ++i) {
    const double at = 1e-4 * (0.3 + 0.7 * share(random));
    const steep_rise force{5e10, at, std::pow(10.0, -9 + 2.5 * share(random)),
                           0.02 + 0.2 * share(random)};
    const double foot = force(at), top = force(at + force.over);
    const double target = foot + (1.4 * share(random) - 0.2) * (top - foot);
    const bool wrong = i % 4 == 0;
    force_search s(target, at * (0.9 + 0.2 * share(random)), 1e-5);
    int evaluations = 0;
    while (evaluations < force_search::most_steps) {
      ++evaluations;
      s.report(force(s.depth()), false);
      if (s.converged()) break;
      if (!s.between_known()) continue;
      const double off = wrong ? 0.2 * share(random) - 0.1 : 1e-3 * (share(random) - 0.5);
      const auto excess = [&](double d) { return force(d) * (1 + off) - target; };
      s.suggest(root_between(s.low(), s.high(), 1e-7 * target, excess));
    }
    EXPECT_NEAR(force(s.depth()), target, 1e-5 * target) << i;
    const int halved = halvings(target, 2 * at, 1e-5, force);
    EXPECT_LE(evaluations, halved + 8 + 3) << i;
    if (wrong) continue;
    sum += evaluations;
    sum_of_halvings += halved;
  }
  EXPECT_LT(sum, 0.4 * sum_of_halvings);
}

// Whatever a force does as it grows, the search ends within the steps it names, and says that
// there is a jump where there is one: at its place to rounding.
TEST(ForceSearch, EndsWithinItsBound) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 2000; ++i) {
    double depth[8], rise[8];
    for (int k = 0; k < 8; ++k) {
      depth[k] = std::pow(10.0, -9 + 6.5 * share(random));
      rise[k] = std::pow(10.0, 5 * share(random));
    }
    const auto stairs = [&](double d) {
      double sum = 1e3 * d;
      for (int k = 0; k < 8; ++k) sum += d > depth[k] ? rise[k] : 0.0;
      return sum;
    };
    const double target = stairs(1e-2) * share(random);
    const found f = search(target, std::pow(10.0, -9 + 6 * share(random)), 1e-9, stairs,
                           i % 3 == 0 ? 1e-3 * share(random) : 1.0);
    EXPECT_LE(f.evaluations, force_search::most_steps) << i;
    EXPECT_TRUE(f.converged || f.exhausted) << i;
    if (f.converged || f.too_deep) continue;
    bool jumps = false;
    for (const double d : depth) jumps = jumps || std::abs(f.depth - d) <= 1e-11 * d + 1e-15;
    EXPECT_TRUE(jumps) << i << " " << f.depth;
  }
}

TEST(ForceSearch, SaysWhyItEnds) {
  // a force that jumps over the target: the bracket shrinks to rounding
  const auto jump = [](double d) { return d < 1e-4 ? 1.0 : 3.0; };
  const found over = search(2.0, 3e-5, 1e-6, jump);
  EXPECT_FALSE(over.converged);
  EXPECT_TRUE(over.exhausted);
  EXPECT_FALSE(over.too_deep);
  EXPECT_NEAR(over.depth, 1e-4, 1e-12);
  // no depth that can be evaluated carries the force
  const auto soft = [](double d) { return 1e3 * d; };
  const found deep = search(1.0, 3e-5, 1e-6, soft, 5e-4);
  EXPECT_TRUE(deep.exhausted && deep.too_deep && !deep.converged);
  EXPECT_NEAR(deep.depth, 5e-4, 1e-12);
  // nor any sensible one
  const found far = search(1e3, 3e-5, 1e-6, soft);
  EXPECT_TRUE(far.exhausted && far.too_deep && !far.converged);
  EXPECT_GE(far.depth, 0.02);
  EXPECT_LE(far.evaluations, 20);
  // a depth just within what can be evaluated is found from beyond
  const found within = search(4.9e-1, 2e-3, 1e-6, soft, 5e-4);
  EXPECT_TRUE(within.converged && !within.too_deep);
}

}  // namespace
