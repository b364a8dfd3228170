// The parts of contact along a wheel's profile are all of those, and only those, that sampling the
// gap densely shows; edges have no gap, the bump between two parts is the greatest one; and a wheel
// first touches where its least gap is zero.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "geometry/patch.hpp"
#include "profiles.hpp"

namespace {

using namespace railpatch;

struct pair_of_profiles {
  profiles::curve wheel_curve = profiles::wheel(), rail_curve = profiles::rail();
  profile wheel{view(wheel_curve)}, rail{view(rail_curve)};
  side_geometry side;

  explicit pair_of_profiles(track_kind kind)
      : side(wheel, rail, wheel_config{0.46, 1.36, -0.065},
             kind == track_kind::rail ? track_config{kind, 1.435, 0.014, 0.025, 1.0 / 500, 0}
                                      : track_config{kind, 1.435, 0.014, 0, 0, 1.0}) {}
  static profile_view view(const profiles::curve &c) {
    return {c.s.data(),  c.y.data(),  c.z.data(),
            c.dy.data(), c.dz.data(), static_cast<int>(c.s.size())};
  }
  double gap(double s) const {
    const locus_point l = side.locus(s);
    return l.valid ? l.gap : side_geometry::far_apart;
  }
};

constexpr double spacing = 5e-6;

// The wheelset's y at which flange and tread touch at once.
double flanging(pair_of_profiles &pair) {
  const auto on_flange = [&](double y) {
    side_motion m;
    m.wheelset.y = y;
    pair.side.place(m);
    double z = 0;
    EXPECT_TRUE(first_touch(pair.side, z));
    pair.side.move_to(z + 1e-6);
    part_set found;
    find_parts(pair.side, found);
    return found.count > 0 && found.parts[0].begin < 0.03;
  };
  double low = 0, high = 0.02;
  while (high - low > 1e-6) {
    const double y = 0.5 * (low + high);
    (on_flange(y) ? high : low) = y;
  }
  return low;
}

TEST(ContactParts, AreThoseOfADenselySampledGap) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> u(-1, 1);
  int several = 0, bumps = 0;
  for (const track_kind kind : {track_kind::rail, track_kind::roller}) {
    pair_of_profiles pair(kind);
    const double begin = pair.side.sample_s(0);
    const double end = pair.side.sample_s(pair.side.sample_count() - 1);
    const double flange = flanging(pair);
    for (int k = 0; k < 24; ++k) {
      SCOPED_TRACE(testing::Message() << "pose " << k);
      side_motion m;
      // on the tread, or about where the flange comes to bear too
      m.wheelset.y = k % 2 ? flange + 4e-5 * u(random) : 5e-3 + 5e-3 * u(random);
      m.wheelset.yaw = (k % 2 ? 1e-4 : 0.02) * u(random);
      m.wheelset.roll = (k % 2 ? 1e-5 : 2e-3) * u(random);
      m.wheelset.speed = 20;
      pair.side.place(m);
      double z = 0;
      ASSERT_TRUE(first_touch(pair.side, z));
      pair.side.move_to(z);
      std::vector<double> s, gaps;
      for (double at = begin; at <= end; at += spacing) {
        s.push_back(at);
        gaps.push_back(pair.gap(at));
      }
      EXPECT_NEAR(*std::min_element(gaps.begin(), gaps.end()), 0.0, 2e-9);

      m.wheelset.z = z + 2e-4 * (0.52 + 0.48 * u(random));
      pair.side.move_to(m.wheelset.z);
      const double deeper = m.wheelset.z - z;
      for (double &g : gaps) g -= deeper;
      part_set found;
      find_parts(pair.side, found);
      ASSERT_FALSE(found.overflow);
      ASSERT_GT(found.count, 0);
      several += found.count > 1;
      for (size_t i = 0; i < s.size(); ++i) {
        bool inside = false, near_edge = false;
        for (int p = 0; p < found.count; ++p) {
          inside = inside || (s[i] > found.parts[p].begin && s[i] < found.parts[p].end);
          for (const double edge : {found.parts[p].begin, found.parts[p].end})
            near_edge = near_edge || std::fabs(s[i] - edge) < spacing;
        }
        // at its edges the gap has rounding of its own
        if (!near_edge && std::fabs(gaps[i]) > 1e-9) {
          EXPECT_EQ(inside, gaps[i] < 0) << "s " << s[i] << ", gap " << gaps[i];
        }
      }
      for (int p = 0; p < found.count; ++p) {
        const part &a = found.parts[p];
        EXPECT_LT(a.begin, a.end);
        if (!a.cut_off) {
          EXPECT_NEAR(pair.gap(a.begin), 0, 1e-10);
          EXPECT_NEAR(pair.gap(a.end), 0, 1e-10);
        }
        if (p + 1 == found.count) continue;
        const part &b = found.parts[p + 1];
        double most = 0;
        for (size_t i = 0; i < s.size(); ++i)
          if (s[i] > a.end && s[i] < b.begin) most = std::max(most, gaps[i]);
        EXPECT_NEAR(a.bump, most, 1e-3 * most + 1e-10);
        EXPECT_GE(a.bump_at, a.end);
        EXPECT_LE(a.bump_at, b.begin);
        EXPECT_NEAR(pair.gap(a.bump_at), a.bump, 1e-12);
        bumps += most > 1e-6;
      }
    }
  }
  EXPECT_GT(several, 5);
  EXPECT_GT(bumps, 5);
}

}  // namespace
