// The creepages that start the search for a prescribed creep force: the simplified theory carries
// the force with them. Its march along the rows is done here anew.
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

}  // namespace
