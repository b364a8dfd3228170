// What the material of a patch carries on: shifted along the rows, and what a step starts from.
#include "patch/history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace railpatch;

bound_law plastic_law(bool by_magnitude) {
  bound_law law;
  law.by_magnitude = by_magnitude;
  law.yield = hardening_curve::straight(1e8, 2e12);
  return law;
}

class PatchHistory : public testing::TestWithParam<bool> {
 protected:
  PatchHistory() {
    g.nx = 6;
    g.ny = 3;
    g.dx = 1e-3;
    g.dy = 2e-3;
    for (int i = 0; i < g.count(); ++i) px.push_back(1e6 * i), py.push_back(-2e6 * i);
  }
  double number(int i, int j, int c) const { return 1e-6 * (1 + 7 * i + 3 * j * j + i * i * c); }
  // all 0 beside the grid; linear between elements
  double shifted(double upstream, int i, int j, int c) const {
    const double u = i + upstream / g.dx, low = std::floor(u);
    const auto at = [&](double k) {
      return k >= 0 && k < g.nx ? number(static_cast<int>(k), j, c) : 0.0;
    };
    return at(low) + (u - low) * (at(low + 1) - at(low));
  }
  // one step with numbers of its own
  void fill(patch_history &h) const {
    h.begin(g, 0, px.data(), py.data());
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const auto at = static_cast<size_t>(j * g.nx + i);
        for (int c = 0; c < 3; ++c) h.after[at].v[c] = number(i, j, c);
        for (int c = 0; c < 2; ++c) h.plastic[c][at] = number(i, j, 5 + c);
      }
  }

  grid g;
  std::vector<double> px, py;
  bound_law law = plastic_law(GetParam());
  double slope = 0;
};

// Of wheels, whose grid moves either way: straight between elements, so linear numbers stay what
// they are, and nothing where there was no row. Two divisions count by their shares.
TEST_P(PatchHistory, StatesAreReadWhereTheMaterialWas) {
  const auto linear = [&](double i, double j, int c) { return 1e-6 * (2 + i - 3 * j + c * i); };
  patch_history last[2] = {{18, true, true, &law, 0}, {18, true, true, &law, 0}},
                h(18, true, true, &law, 0);
  for (int k = 0; k < 2; ++k) {
    fill(last[k]);
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        for (int c = 0; c < 3; ++c)
          last[k].after[static_cast<size_t>(j * g.nx + i)].v[c] = (1 + k) * linear(i, j, c);
    last[k].remember(g, {}, k == 0 ? 0.3 : 0.7, px.data(), py.data());
  }
  for (const double along : {0.0, 1.3, -2.0, 40.0})
    for (const double across : {0.0, 0.25, -1.5}) {
      h.begin_states(g);
      // the second one's first row is not this patch's
      h.add_states(g, {&last[0], 0, 3, {along * g.dx, across * g.dy}});
      h.add_states(g, {&last[1], 1, 2, {along * g.dx, (across - 1) * g.dy}});
      for (int j = 0; j < g.ny; ++j)
        for (int i = 0; i < g.nx; ++i)
          for (int c = 0; c < 3; ++c) {
            const double x = i + along, y = j + across;
            const double found = h.before[static_cast<size_t>(j * g.nx + i)].v[c];
            const bool beside = x <= -1 || x >= 6 || y <= -1 || y >= 3;
            if (beside) {
              EXPECT_EQ(found, 0.0);
            }
            if (x < 0 || x > 5 || y < 0 || y > 2 || (y > 0 && y < 1)) continue;
            const double share = y >= 1 ? 0.3 + 2 * 0.7 : 0.3;
            EXPECT_NEAR(found, share * linear(x, y, c), 1e-19) << along << " " << across;
          }
    }
}

TEST_P(PatchHistory, FreshMaterialHasNothing) {
  patch_history h(18, true, false, &law, 0);
  EXPECT_TRUE(h.keeps_steps() && h.has_law());
  h.begin(g, 1e-3, px.data(), py.data());
  h.start_from_before(g, law, true);
  for (size_t k = 0; k < 18; ++k) {
    EXPECT_EQ(h.last_px[k], 0);
    EXPECT_EQ(h.last_py[k], 0);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(h.after[k].v[c], 0);
    for (int c = 0; c < 2; ++c) EXPECT_EQ(h.plastic[c][k], 0);
    EXPECT_EQ(h.yield_stress[k], 1e8);
  }
}

TEST_P(PatchHistory, WhatWasCarriedIsWhereTheMaterialIs) {
  for (const double upstream : {0.0, 1e-3, 4e-4, -1.7e-3, 9e-3}) {
    SCOPED_TRACE(upstream);
    patch_history h(18, true, false, &law, 0);
    fill(h);
    h.begin(g, upstream, px.data(), py.data());
    h.start_from_before(g, law, true);
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const auto at = static_cast<size_t>(j * g.nx + i);
        EXPECT_EQ(h.last_px[at], px[at]);
        EXPECT_EQ(h.last_py[at], py[at]);
        double carried[3];
        for (int c = 0; c < 3; ++c) {
          carried[c] = shifted(upstream, i, j, c);
          EXPECT_NEAR(h.before[at].v[c], carried[c], 1e-18);
        }
        for (int c = 0; c < 2; ++c)
          EXPECT_NEAR(h.plastic[c][at], shifted(upstream, i, j, 5 + c), 1e-18);
        // friction starts at rest, and no element has slipped yet
        EXPECT_EQ(h.after[at].v[0], 0);
        EXPECT_EQ(h.friction[at], 0);
        // hardened by the path's length or by the vector sum's
        const double u = GetParam() ? std::hypot(carried[1], carried[2]) : carried[1];
        EXPECT_NEAR(h.yield_stress[at], 1e8 + 2e12 * u, 1e-6);
      }
  }
}

// A smaller grid than what there is room for: nothing is written beside it.
TEST_P(PatchHistory, WhatIsBesideTheGridStays) {
  patch_history h(24, true, false, &law, 0);
  fill(h);
  for (size_t k = 18; k < 24; ++k) h.before[k] = {{5, 6, 7}};
  h.begin(g, 4e-4, px.data(), py.data());
  for (size_t k = 18; k < 24; ++k)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(h.before[k].v[c], 5 + c);
}

// In steady rolling there is no step before: material comes in at the front, and what it has
// carried along the row counts.
TEST_P(PatchHistory, PlasticWorkIsThatOfTheStepsDisplacement) {
  for (const bool steps : {true, false})
    for (const int direction : {1, -1}) {
      patch_history h(18, steps, false, &law, 0);
      if (steps) {
        fill(h);
        h.begin(g, 0, px.data(), py.data());
      }
      for (int c = 0; c < 2; ++c)
        for (size_t k = 0; k < 18; ++k)
          h.plastic[c][k] = (c == 0 ? 1 : -1) * 1e-6 * static_cast<double>(k * k + 1);
      std::vector<double> work(18, -1);
      h.plastic_work(g, direction, px.data(), py.data(), work.data());
      for (int j = 0; j < g.ny; ++j)
        for (int i = 0; i < g.nx; ++i) {
          const int k = j * g.nx + i, ahead = i + direction;
          double expected = 0;
          for (int c = 0; c < 2; ++c) {
            const auto at = static_cast<size_t>(k);
            const bool inside = ahead >= 0 && ahead < g.nx;
            const size_t front = static_cast<size_t>(j * g.nx + ahead);
            // elements without traction carry nothing on
            double before = inside && px[front] != 0 ? h.plastic[c][front] : 0.0;
            if (steps) before = h.plastic_before[c][at];
            expected += (c == 0 ? px : py)[at] * (h.plastic[c][at] - before);
          }
          EXPECT_NEAR(work[static_cast<size_t>(k)], std::max(expected, 0.0), 1e-9) << k;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Rules, PatchHistory, testing::Bool(), [](const auto &info) {
  return std::string(info.param ? "by_magnitude" : "by_path");
});

}  // namespace
