// A contact search that passes over what cannot be near the rail finds what a full one finds.
#include "geometry/gap_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/patch.hpp"
#include "surfaces.hpp"

namespace {

using namespace railpatch;

class GapSamples : public testing::Test {
 protected:
  GapSamples()
      : full(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track),
        kept(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track) {}

  // The same bits of every part, and how many of the samples were looked at.
  int expect_same(const side_motion &m) {
    full.place(m);
    kept.place(m, true);
    EXPECT_EQ(full.no_overlap(), kept.no_overlap());
    int looked = 0;
    for (int i = 0; (i = kept.next_sample(i)) < kept.sample_count(); ++i, ++looked)
      EXPECT_EQ(kept.sample_gap(i), full.sample_gap(i));
    part_set there, here;
    find_parts(full, there);
    find_parts(kept, here);
    EXPECT_EQ(here.count, there.count);
    most = std::max(most, here.count);
    for (int k = 0; k < std::min(here.count, there.count); ++k) {
      const part &a = here.parts[k], &b = there.parts[k];
      EXPECT_EQ(a.begin, b.begin);
      EXPECT_EQ(a.end, b.end);
      EXPECT_EQ(a.weight, b.weight);
      EXPECT_EQ(a.angle, b.angle);
      EXPECT_EQ(a.bump, b.bump);
    }
    return looked;
  }

  // The motion with its wheel pressed a little into the rail, or lifted off it.
  side_motion pressed(side_motion m, double depth) {
    full.place(m);
    double z = 0;
    if (first_touch(full, z)) m.wheelset.z = z + depth;
    return m;
  }

  // y at which the flange begins to bear.
  double flanging() {
    double low = 0, high = 0.02;
    while (high - low > 1e-7) {
      side_motion m;
      m.wheelset.y = 0.5 * (low + high);
      full.place(pressed(m, 1e-6));
      part_set found;
      find_parts(full, found);
      (found.count > 0 && found.parts[0].begin < 0.03 ? high : low) = m.wheelset.y;
    }
    return high;
  }

  surfaces::scene scene{track_kind::rail};
  side_geometry full, kept;
  int most = 0;
};

// From the field side into the flange and back, with yaw, roll and a rail that moves, in small
// steps with some large ones among them.
TEST_F(GapSamples, FindTheSamePartsOnEveryWay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  side_motion m;
  long looked = 0, all = 0;
  for (int i = 0; i < 3000; ++i) {
    const double way = i % 500 == 499 ? 4e-3 : 3e-5;
    m.wheelset.y = 0.014 * std::sin(2e-3 * i) + way * any(random);
    m.wheelset.yaw = 0.02 * std::sin(1.3e-3 * i) + 1e-5 * any(random);
    m.wheelset.roll = 0.003 * std::sin(7e-4 * i) + 1e-6 * any(random);
    m.rail.offset = {0, 0.004 * std::sin(9e-4 * i) + 1e-5 * any(random), 3e-5 * any(random)};
    if (i % 700 > 690) m.rail.rotation[0] = 1e-4 * any(random);
    looked += expect_same(pressed(m, 1e-4 * any(random)));
    all += kept.sample_count();
    if (HasFailure()) FAIL() << "step " << i;
  }
  EXPECT_LT(looked, all / 2);
}

// Where flange and tread bear at once.
TEST_F(GapSamples, FindTheSameOfTwoParts) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const double flange = flanging();
  for (int i = 0; i < 300; ++i) {
    side_motion m;
    m.wheelset.y = flange + 4e-5 * any(random);
    m.wheelset.yaw = 1e-5 * any(random);
    expect_same(pressed(m, 6e-5));
    if (HasFailure()) FAIL() << "step " << i;
  }
  EXPECT_GT(most, 1);
}

// Where nothing is kept, or the last place was far away, all samples are looked at.
TEST_F(GapSamples, AreFullAtFirstAndAfterJumps) {
  side_motion m;
  m = pressed(m, 5e-5);
  EXPECT_EQ(expect_same(m), kept.sample_count());
  expect_same(m);
  EXPECT_LT(expect_same(m), kept.sample_count());
  m.wheelset.y += 2e-3;
  EXPECT_EQ(expect_same(pressed(m, 5e-5)), kept.sample_count());
}

// A rail out of reach is told as it is from a full look.
TEST_F(GapSamples, TellThatNothingOverlaps) {
  side_motion m;
  for (int i = 0; i < 3; ++i) expect_same(pressed(m, 5e-5));
  for (int i = 0; i < 400; ++i) {
    m.wheelset.y += 4e-4;
    expect_same(m);
  }
  EXPECT_TRUE(kept.no_overlap());
}

}  // namespace
