// The creepages of a prescribed creep force. Those that start the search carry the force by the
// simplified theory, whose march along the rows is done here anew; those of the steps that solve no
// linear systems follow what is missing of the force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tangential/rolling_newton.hpp"

namespace {

using namespace railpatch;

struct rows_of_elements {
  std::vector<int> start = {0, 4, 11, 12, 20};
  std::vector<double> bound, area, rigid, p, s;
  prescribed_force force;
  double flexibility[2], ramp_force = 0, capacity = 0;

  explicit rows_of_elements(std::mt19937_64 &random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto n = static_cast<size_t>(start.back());
    bound.resize(n), area.resize(n), rigid.resize(2 * n), p.resize(2 * n), s.resize(2 * n);
    for (double &v : bound) v = 0.5 + unit(random);
    for (double &v : area) v = 0.5 + unit(random);
    for (double &v : rigid) v = 0.1 * (unit(random) - 0.5);
    for (double &v : flexibility) v = 2 + 4 * unit(random);
    for (size_t row = 0; row + 1 < start.size(); ++row) {
      double ramp = 0;
      for (int k = start[row]; k < start[row + 1]; ++k) {
        const double a = area[static_cast<size_t>(k)];
        ramp += a;
        ramp_force += ramp * a;
        capacity += a * bound[static_cast<size_t>(k)];
      }
    }
  }
  rolling_problem problem() {
    return {static_cast<int>(start.size()) - 1,
            start.data(),
            bound.data(),
            area.data(),
            rigid.data(),
            p.data(),
            s.data(),
            &force};
  }
  // traction grows from each row's first element with the rigid slip over the flexibility, not
  // beyond its bound
  std::vector<double> carried() const {
    std::vector<double> sum(2, 0.0);
    for (size_t row = 0; row + 1 < start.size(); ++row) {
      const int begin = start[row], n = start[row + 1] - begin;
      double grown[2] = {0, 0};
      for (int k = 0; k < n; ++k) {
        const auto at = static_cast<size_t>(begin + k), x = static_cast<size_t>(2 * begin + k);
        const double w[2] = {rigid[x] + force.creepage[0],
                             rigid[x + static_cast<size_t>(n)] + force.creepage[1]};
        for (int c = 0; c < 2; ++c) grown[c] -= w[c] * area[at] / flexibility[c];
        const double over = std::max(1.0, std::hypot(grown[0], grown[1]) / bound[at]);
        for (size_t c = 0; c < 2; ++c) {
          grown[c] /= over;
          sum[c] += area[at] * grown[c];
        }
      }
    }
    return sum;
  }
  // of tractions, one component
  double sum_of(const std::vector<double> &traction, int c) const {
    double sum = 0;
    for (size_t row = 0; row + 1 < start.size(); ++row) {
      const int begin = start[row], n = start[row + 1] - begin;
      for (int k = 0; k < n; ++k)
        sum += area[static_cast<size_t>(begin + k)] *
               traction[static_cast<size_t>(2 * begin + c * n + k)];
    }
    return sum;
  }
  // all forces larger by the factor, in the same contact
  void scale_forces(double factor) {
    for (double &v : bound) v *= factor;
    for (double &v : flexibility) v /= factor;
    for (double &v : force.force) v *= factor;
    capacity *= factor;
  }
};

TEST(ForceConstraint, StartsWithTheSimplifiedTheorysCreepages) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 60; ++k) {
    rows_of_elements rows(random);
    const int which = 1 + k % 3;
    // far from full sliding, where the start aims at the whole of the force
    const double share = 0.1 + 0.6 * unit(random), angle = 6.283 * unit(random);
    rows.force.force[0] = share * rows.capacity * std::cos(angle);
    rows.force.force[1] = share * rows.capacity * std::sin(angle);
    double size = 0;
    for (int c = 0; c < 2; ++c) {
      rows.force.component[c] = (which & (1 << c)) != 0;
      if (rows.force.component[c]) size = std::hypot(size, rows.force.force[c]);
    }
    force_constraint constraint(rows.start.back());
    const rolling_problem problem = rows.problem();
    constraint.begin(problem, 1e-6);
    ASSERT_EQ(constraint.unknowns(), which == 3 ? 2 : 1);
    constraint.set_units(problem, rows.flexibility, rows.ramp_force);
    constraint.guess(problem, rows.flexibility);
    const std::vector<double> found = rows.carried();
    double miss = 0;
    for (size_t c = 0; c < 2; ++c)
      if (rows.force.component[c])
        miss = std::hypot(miss, found[c] - rows.force.force[c]);
      else
        EXPECT_EQ(rows.force.creepage[c], 0.0);
    EXPECT_LE(miss, 1.001e-3 * size) << "case " << k << ", share " << share;
  }
}

TEST(ForceConstraint, StartsAlikeInWhateverUnitOfForce) {
  std::mt19937_64 random(20261123);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 20; ++k) {
    rows_of_elements rows(random);
    const double share = 0.3 + 0.4 * unit(random), angle = 6.283 * unit(random);
    rows.force = {
        {true, true},
        {share * rows.capacity * std::cos(angle), share * rows.capacity * std::sin(angle)},
        {0, 0}};
    // by powers of two only exponents change
    double first[2] = {0, 0};
    for (double factor : {1.0, 0x1p-30, 0x1p60}) {
      rows_of_elements scaled = rows;
      scaled.scale_forces(factor);
      force_constraint constraint(rows.start.back());
      const rolling_problem problem = scaled.problem();
      constraint.begin(problem, 1e-6);
      constraint.set_units(problem, scaled.flexibility, scaled.ramp_force);
      constraint.guess(problem, scaled.flexibility);
      for (int c = 0; c < 2; ++c) {
        if (factor == 1.0) first[c] = scaled.force.creepage[c];
        EXPECT_NEAR(scaled.force.creepage[c], first[c], 1e-9 * std::hypot(first[0], first[1]))
            << "case " << k << ", forces times " << factor;
      }
    }
  }
}

TEST(ForceConstraint, PullsByWhatIsMissingOfTheForce) {
  std::mt19937_64 random(20261124);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int which = 1; which <= 3; ++which)
    // friction over that of the other tests
    for (double friction : {1.0, 0x1p-20, 0.0}) {
      rows_of_elements rows(random);
      std::vector<double> now(rows.p.size()), then(rows.p.size());
      for (double &v : now) v = unit(random);
      for (double &v : then) v = unit(random);
      for (int c = 0; c < 2; ++c) {
        rows.force.component[c] = (which & (1 << c)) != 0;
        rows.force.force[c] = 5 * unit(random);
        rows.force.creepage[c] = rows.force.component[c] ? unit(random) : 0.0;
      }
      if (friction > 0) {
        rows.scale_forces(friction);
        for (auto *v : {&now, &then})
          for (double &p : *v) p *= friction;
      } else {
        rows.bound.assign(rows.bound.size(), 0.0);
      }
      const prescribed_force begun = rows.force;
      force_constraint constraint(rows.start.back());
      const rolling_problem problem = rows.problem();
      constraint.begin(problem, 1e-6);
      constraint.set_units(problem, rows.flexibility, rows.ramp_force);

      double given = 0;
      for (double v : rows.rigid) given = std::max(given, std::abs(v));
      constexpr double length = 0.3;
      double moved = 2, turned = 5, expected_moved = 2, expected_turned = 5, again[2] = {0, 0};
      constraint.pull(problem, now.data(), then.data(), length, &moved, &turned);
      for (int c = 0; c < 2; ++c) {
        // a unit of creepage where all of friction is missing
        const double one = rows.capacity * rows.flexibility[c] / rows.ramp_force + given;
        const double sigma = friction > 0 && begun.component[c] ? one / rows.capacity : 0.0;
        const double step = -length * sigma * (begun.force[c] - rows.sum_of(now, c));
        const double change = rows.sum_of(then, c) - rows.sum_of(now, c);
        EXPECT_NEAR(rows.force.creepage[c], begun.creepage[c] + step, 1e-13);
        if (sigma > 0) expected_moved += step * step / sigma;
        expected_turned += sigma * length * length * change * change;
        again[c] = begun.creepage[c] - length * sigma * (begun.force[c] - rows.sum_of(then, c));
      }
      EXPECT_NEAR(moved, expected_moved, 1e-12 * expected_moved);
      EXPECT_NEAR(turned, expected_turned, 1e-12 * expected_turned);

      // from where the trial began, and there to stay
      constraint.pull_again(problem, then.data(), length);
      for (int c = 0; c < 2; ++c) EXPECT_NEAR(rows.force.creepage[c], again[c], 1e-13);
      rows.force.creepage[0] = rows.force.creepage[1] = 7;
      constraint.go_back(problem);
      for (int c = 0; c < 2; ++c)
        EXPECT_NEAR(rows.force.creepage[c], begun.component[c] ? again[c] : 7.0, 1e-13);

      // and back to those remembered, from there on too
      const prescribed_force best = rows.force;
      constraint.remember();
      constraint.pull(problem, now.data(), then.data(), length, &moved, &turned);
      constraint.keep(problem);
      constraint.recall(problem);
      for (int c = 0; c < 2; ++c) EXPECT_EQ(rows.force.creepage[c], best.creepage[c]);
      rows.force.creepage[0] = rows.force.creepage[1] = 7;
      constraint.go_back(problem);
      for (int c = 0; c < 2; ++c) EXPECT_EQ(rows.force.creepage[c], best.creepage[c]);
    }
}

// A start far beyond the creepage of full sliding, and no solution: in either component.
TEST(ForceConstraint, KnowsStartsOnTheFlat) {
  std::mt19937_64 random(20261125);
  for (int c = 0; c < 2; ++c) {
    rows_of_elements rows(random);
    double given = 0;
    for (double v : rows.rigid) given = std::max(given, std::abs(v));
    const double unit = rows.capacity * rows.flexibility[c] / rows.ramp_force + given;
    // traction at its bound, all of it in this component
    std::vector<double> sliding(rows.p.size(), 0.0);
    for (size_t row = 0; row + 1 < rows.start.size(); ++row) {
      const int begin = rows.start[row], n = rows.start[row + 1] - begin;
      for (int k = 0; k < n; ++k)
        sliding[static_cast<size_t>(2 * begin + c * n + k)] =
            rows.bound[static_cast<size_t>(begin + k)];
    }
    rows.force.component[c] = true;
    for (double creepage : {-10.0, -1.0, 1.0, 10.0})
      for (double asked : {0.5, 1.0})
        for (double residual : {1e-3, 0.5}) {
          rows.force.force[c] = asked * rows.capacity;
          rows.force.creepage[c] = creepage * unit;
          force_constraint constraint(rows.start.back());
          const rolling_problem problem = rows.problem();
          constraint.begin(problem, 1e-6);
          constraint.set_units(problem, rows.flexibility, rows.ramp_force);
          const bool far = std::abs(creepage) > 5, unsolved = asked < 1 || residual > 0.1;
          EXPECT_EQ(constraint.overshoots(problem, sliding.data(), residual), far && unsolved)
              << "component " << c << ", creepage " << creepage << ", asked " << asked
              << ", residual " << residual;
        }
  }
}

}  // namespace
