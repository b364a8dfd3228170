// Which of a wheel's patches start from which solutions of the last step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "wheel/wheel_contact.hpp"

namespace {

using namespace railpatch;

constexpr double dy = 1e-3;  // m

patch_region region_at(double y, double z, double low, double high) {
  patch_region r;
  r.frame.origin = {0, y, z};
  r.s_min = low;
  r.s_max = high;
  return r;
}

// A solution whose outermost rows lie at `low` and rows - 1 elements above.
struct solution {
  double y, z, low;
  int rows;
  bool warm = true;

  double high() const { return low + (rows - 1) * dy; }
};

// By patch and, after these, by what is left: the places where the solutions were.
std::vector<int> matched(const std::vector<patch_region> &regions,
                         const std::vector<solution> &solutions) {
  std::vector<patch_memory> slots(solutions.size());
  for (size_t k = 0; k < slots.size(); ++k) {
    const solution &s = solutions[k];
    slots[k].warm = s.warm;
    slots[k].reference = {0, s.y, s.z};
    slots[k].g.ny = s.rows;
    slots[k].g.dy = dy;
    slots[k].g.y0 = s.low;
    slots[k].approach = static_cast<double>(k);
  }
  match_memory(regions.data(), static_cast<int>(regions.size()), slots.data(),
               static_cast<int>(slots.size()));
  std::vector<int> from;
  for (const patch_memory &m : slots) from.push_back(static_cast<int>(m.approach));
  return from;
}

// The same by sorting all pairs; -1: no solution is near.
std::vector<int> by_sorting(const std::vector<patch_region> &regions,
                            const std::vector<solution> &solutions) {
  std::vector<std::tuple<double, size_t, size_t>> pairs;
  for (size_t i = 0; i < regions.size(); ++i)
    for (size_t k = 0; k < solutions.size(); ++k) {
      const patch_region &r = regions[i];
      const solution &s = solutions[k];
      const double apart = std::hypot(r.frame.origin[1] - s.y, r.frame.origin[2] - s.z);
      if (s.warm && apart <= 2e-3)
        pairs.emplace_back(apart + std::fabs(r.s_min - s.low) + std::fabs(r.s_max - s.high()), i,
                           k);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> slot_of(regions.size(), -1);
  for (const auto &[u, i, k] : pairs)
    if (slot_of[i] < 0 &&
        std::find(slot_of.begin(), slot_of.end(), static_cast<int>(k)) == slot_of.end())
      slot_of[i] = static_cast<int>(k);
  return slot_of;
}

TEST(MatchMemory, TheMostAlikeInExtentIsTaken) {
  // at the same place, one row shorter at either end
  const solution alike{0, 0, -5 * dy, 11}, shorter[2] = {{0, 0, -4 * dy, 10}, {0, 0, -5 * dy, 10}};
  const std::vector<patch_region> one{region_at(0, 0, -5 * dy, 5 * dy)};
  for (const solution &s : shorter) {
    EXPECT_EQ(matched(one, {s, alike}), (std::vector{1, 0}));
    EXPECT_EQ(matched(one, {alike, s}), (std::vector{0, 1}));
    // half a row aside is less
    for (const auto &[y, z] : {std::pair{0.5 * dy, 0.0}, {-0.5 * dy, 0.0}, {0.0, 0.5 * dy}})
      EXPECT_EQ(matched(one, {s, {y, z, -5 * dy, 11}}), (std::vector{1, 0}));
  }
}

TEST(MatchMemory, OnlySolutionsNearByAreStarts) {
  const std::vector<patch_region> two{region_at(0, 0, -5 * dy, 5 * dy),
                                      region_at(0.02, 0.01, -5 * dy, 5 * dy)};
  const auto with = [&](double aside, double down, bool warm) {
    return matched(two,
                   {{0.05, 0, 0, 3}, {0.05, 0, 0, 3}, {0.02 + aside, 0.01 + down, 0, 3, warm}});
  };
  const std::vector<int> found{0, 2, 1}, none{0, 1, 2};
  EXPECT_EQ(with(1.99e-3, 0, true), found);
  EXPECT_EQ(with(0, -1.99e-3, true), found);
  EXPECT_EQ(with(2.01e-3, 0, true), none);
  EXPECT_EQ(with(0, -2.01e-3, true), none);
  EXPECT_EQ(with(1.5e-3, 1.5e-3, true), none);
  EXPECT_EQ(with(0, 0, false), none);
}

// The rest keep their order, and none is lost.
TEST(MatchMemory, PairsAreTakenFromTheMostAlike) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const int slots = 2 + trial % (RP_MAX_PATCHES - 1), count = trial % (slots + 1);
    std::vector<patch_region> regions;
    std::vector<solution> solutions;
    // some of them alike to the last bit
    const auto anywhere = [&] { return 1e-3 * std::floor(4 * u(random)); };
    for (int i = 0; i < count; ++i) {
      const double low = -anywhere();
      regions.push_back(region_at(anywhere(), 0, low, low + anywhere()));
    }
    for (int k = 0; k < slots; ++k)
      solutions.push_back({anywhere(), 0, -anywhere(), 1 + trial / 7 % 4, u(random) < 0.8});
    std::vector<int> expected = by_sorting(regions, solutions);
    const std::vector<int> found = matched(regions, solutions);
    SCOPED_TRACE(testing::Message() << "seed 5, trial " << trial);
    for (size_t i = 0; i < expected.size(); ++i) {
      if (expected[i] >= 0) {
        EXPECT_EQ(found[i], expected[i]) << i;
        continue;
      }
      int first = 0;
      while (std::find(expected.begin(), expected.end(), first) != expected.end()) ++first;
      EXPECT_EQ(found[i], expected[i] = first) << i;
    }
    std::vector<int> all = found;
    std::sort(all.begin(), all.end());
    for (int k = 0; k < slots; ++k) EXPECT_EQ(all[static_cast<size_t>(k)], k);
  }
}

}  // namespace
