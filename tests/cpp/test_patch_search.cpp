// From parts of contact to patches: divisions, frames, cuts, bounds and couplings put together anew
// from the parts that were found.
#include "geometry/patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/joining.hpp"
#include "surfaces.hpp"

namespace {

using namespace railpatch;

class PatchSearch : public testing::TestWithParam<track_kind> {
 protected:
  PatchSearch() : side(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track) {}

  // Flange and tread bear at once where the flange has come near enough; depth of the first touch.
  void place(double y, double depth, double yaw = 0) {
    side_motion m;
    m.wheelset.y = y;
    m.wheelset.yaw = yaw;
    side.place(m);
    double z = 0;
    ASSERT_TRUE(first_touch(side, z));
    side.move_to(z + depth);
  }
  double flanging() {
    double low = 0, high = 0.02;
    while (high - low > 1e-7) {
      const double y = 0.5 * (low + high);
      place(y, 1e-6);
      part_set found;
      find_parts(side, found);
      (found.count > 0 && found.parts[0].begin < 0.03 ? high : low) = y;
    }
    return high;
  }
  static double lateral(const contact_frame &f, const vec3 &p) {
    return std::cos(f.contact_angle) * (p[1] - f.origin[1]) +
           std::sin(f.contact_angle) * (p[2] - f.origin[2]);
  }
  // What a region says of the parts that it takes up.
  void expect_region(const patch_region &r, const part_set &found, bool inclined,
                     bool own_angle = true) const {
    double weight = 0, x = 0, y = 0, angle = 0, low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = r.first_part; k < r.first_part + r.parts; ++k) {
      const part &p = found.parts[k];
      weight += p.weight;
      x += p.weight * p.x;
      y += p.weight * p.y;
      angle += p.weight * p.angle;
      low = std::min(low, p.x_min);
      high = std::max(high, p.x_max);
    }
    const contact_frame &f = r.frame;
    EXPECT_NEAR(r.weight, weight, 1e-12 * weight);
    EXPECT_NEAR(f.origin[0], x / weight, 1e-14);
    EXPECT_NEAR(f.origin[1], y / weight, 1e-14);
    if (own_angle) {
      EXPECT_NEAR(f.contact_angle, angle / weight, 1e-14);
    }
    double z = 0, unused = 0;
    ASSERT_TRUE(side.rail_surface(f.origin[0], f.origin[1], z, unused));
    EXPECT_EQ(f.origin[2], z);
    EXPECT_EQ(f.inclination, inclined ? side.roller_inclination(f.origin) : 0.0);
    EXPECT_NEAR(r.x_min, low - x / weight, 1e-14);
    EXPECT_NEAR(r.x_max, high - x / weight, 1e-14);
    const part &first = found.parts[r.first_part], &last = found.parts[r.first_part + r.parts - 1];
    EXPECT_NEAR(r.s_min, lateral(f, first.first), 1e-14);
    EXPECT_NEAR(r.s_max, lateral(f, last.last), 1e-14);
    for (int k = 0; k + 1 < r.parts; ++k) {
      const part &a = found.parts[r.first_part + k], &b = found.parts[r.first_part + k + 1];
      EXPECT_NEAR(r.cut[k], 0.5 * (lateral(f, a.last) + lateral(f, b.first)), 1e-14);
    }
  }

  surfaces::scene scene{GetParam()};
  side_geometry side;
};

double distance(const part &a, const part &b) {
  return std::hypot(b.first[1] - a.last[1], b.first[2] - a.last[2]);
}

TEST_P(PatchSearch, BlendedDivisionsTakeUpTheirParts) {
  const double flange = flanging();
  int together = 0, apart = 0, both = 0;
  for (double beyond = -4e-5; beyond < 6e-5; beyond += 4e-6)
    for (const bool inclined : {false, true}) {
      if (inclined && !scene.roller()) continue;
      place(flange + beyond, 4e-5, 2e-3);
      patch_rules rules;
      rules.inclined = inclined;
      part_set found;
      patch_region regions[8];
      const search_result result = find_patches(side, rules, found, regions, 8);
      ASSERT_EQ(result.status, search_status::contact);
      double counted[max_parts] = {};
      int lead = 0;
      for (int i = 0; i < result.count; ++i) {
        expect_region(regions[i], found, inclined);
        const int first = regions[i].first_part, end = first + regions[i].parts;
        for (int k = first; k < end; ++k) counted[k] += regions[i].share;
        for (int k = first; k + 1 < end; ++k)
          EXPECT_EQ(regions[i].coupling[k - first],
                    interaction(rules.blend, found.parts[k], found.parts[k + 1]));
        EXPECT_FALSE(regions[i].at_profile_end);
        if (i < result.lead) lead += regions[i].parts;
      }
      for (int k = 0; k < found.count; ++k) EXPECT_NEAR(counted[k], 1, 1e-5);
      // the leading division holds each part once
      EXPECT_EQ(lead, found.count);
      if (found.count == 2) {
        const double join = joined(rules.blend, found.parts[0], found.parts[1]);
        const bool one = join > 1e-6, two = join < 1 - 1e-6;
        EXPECT_EQ(result.count, one + 2 * two);
        EXPECT_EQ(result.lead, join < 0.5 ? 2 : 1);
        for (int i = 0; i < result.count; ++i)
          EXPECT_NEAR(regions[i].share, regions[i].parts == 2 ? join : 1 - join, 1e-14);
        both += one && two;
        ++(one ? together : apart);
      }
    }
  EXPECT_GT(together + apart, 2);
}

TEST_P(PatchSearch, OfTheProgramContactByDistance) {
  const double flange = flanging();
  int several = 0;
  for (double beyond = -4e-5; beyond < 6e-5; beyond += 4e-6) {
    place(flange + beyond, 4e-5);
    part_set found;
    find_parts(side, found);
    if (found.count != 2) continue;
    ++several;
    const part a = found.parts[0], b = found.parts[1];
    const double d = distance(a, b);
    patch_rules rules;
    rules.blended = false;
    patch_region regions[8];
    const auto search = [&](double separate) {
      rules.combine = 0.5 * separate;
      rules.separate = separate;
      rules.turn = 2 * separate;
      rules.max_angle = 1.5;
      return find_patches(side, rules, found, regions, 8);
    };
    // nearer than that distance: one, with a coupling that falls between both
    for (const double share : {0.3, 0.6, 0.9}) {
      ASSERT_EQ(search(d / share).count, 1);
      expect_region(regions[0], found, false);
      EXPECT_EQ(regions[0].parts, 2);
      const double near = std::clamp((1 - share) / 0.5, 0.0, 1.0);
      EXPECT_NEAR(regions[0].coupling[0], std::pow(near, 0.8), 1e-12);
    }
    // turned towards their mean up to the next one
    for (const double share : {1.1, 1.5, 1.9, 2.1, 4.0}) {
      const search_result result = search(d / share);
      ASSERT_EQ(result.count, 2);
      EXPECT_EQ(result.lead, 2);
      const double by = std::clamp(2 - share, 0.0, 1.0);
      const double mean = (a.weight * a.angle + b.weight * b.angle) / (a.weight + b.weight);
      EXPECT_NEAR(regions[0].frame.contact_angle, a.angle + by * (mean - a.angle), 1e-12);
      EXPECT_NEAR(regions[1].frame.contact_angle, b.angle + by * (mean - b.angle), 1e-12);
      for (int i = 0; i < 2; ++i) expect_region(regions[i], found, false, false);
    }
    // angles too far apart always separate, and do not turn
    rules.separate = 2 * d;
    rules.turn = 3 * d;
    rules.max_angle = 0.99 * std::fabs(a.angle - b.angle);
    ASSERT_EQ(find_patches(side, rules, found, regions, 8).count, 2);
    EXPECT_EQ(regions[0].frame.contact_angle, a.angle);
    EXPECT_EQ(regions[1].frame.contact_angle, b.angle);
    // where there is room for one, the heavier stays
    const search_result one = find_patches(side, rules, found, regions, 1);
    EXPECT_EQ(one.status, search_status::too_many_patches);
    ASSERT_EQ(one.count, 1);
    EXPECT_EQ(regions[0].first_part, a.weight < b.weight ? 1 : 0);
    EXPECT_EQ(regions[0].frame.contact_angle, a.weight < b.weight ? b.angle : a.angle);
  }
  EXPECT_GT(several, 2);
}

TEST_P(PatchSearch, BumpIsTheGreatestGapBetweenTwoParts) {
  const double flange = flanging();
  int several = 0;
  for (double beyond = -4e-5; beyond < 6e-5; beyond += 4e-6) {
    place(flange + beyond, 4e-5);
    part_set found;
    find_parts(side, found);
    if (found.count != 2) continue;
    ++several;
    const part &a = found.parts[0], &b = found.parts[1];
    double most = 0;
    for (int i = 0; i <= 2000; ++i)
      most = std::max(most, side.locus(a.end + (b.begin - a.end) * i / 2000).gap);
    EXPECT_GT(a.bump_at, a.end);
    EXPECT_LT(a.bump_at, b.begin);
    EXPECT_EQ(a.bump, side.locus(a.bump_at).gap);
    EXPECT_GE(a.bump, most - 1e-15);
  }
  EXPECT_GT(several, 2);
}

profiles::curve with_ripples() {
  profiles::curve rail = profiles::rail();
  for (size_t i = 0; i < rail.y.size(); ++i) {
    constexpr double wave = 5e-3, height = 4e-6;
    rail.z[i] += height * std::cos(2 * M_PI * rail.y[i] / wave);
    rail.dz[i] -= height * 2 * M_PI / wave * std::sin(2 * M_PI * rail.y[i] / wave);
  }
  return rail;
}

// Just above an appearance there is one part less than just below, beside a neighbour; at its
// length it is as wide as lets both be one patch, to a half. On a rail with ripples of 4 um.
TEST_P(PatchSearch, TellsWherePartsAppear) {
  const profiles::curve rippled = with_ripples();
  const profile rail(surfaces::view(rippled));
  side_geometry on(scene.wheel_curve, rail, scene.sizes, scene.track);
  const auto parts = [&](double z) {
    part_set found;
    on.move_to(z);
    find_parts(on, found);
    return found;
  };
  constexpr double sharp = 1e-9;
  const patch_rules rules;
  int told = 0;
  for (int i = 0; i < 120; ++i) {
    side_motion m;
    m.wheelset.y = -6e-3 + 1e-4 * i;
    on.place(m);
    double touch = 0;
    ASSERT_TRUE(first_touch(on, touch));
    on.move_to(touch);
    appearance list[4];
    const int count = find_appearances(on, rules, touch + 1e-6, touch + 1.5e-4, list, 4);
    for (int k = 0; k < count; ++k) {
      ++told;
      EXPECT_EQ(parts(list[k].z + sharp).count, parts(list[k].z - sharp).count + 1) << i;
      const part_set whole = parts(list[k].z + list[k].length);
      double nearest = HUGE_VAL;
      for (int j = 0; j + 1 < whole.count; ++j) {
        const part &a = whole.parts[j], &b = whole.parts[j + 1];
        const double wide = std::min(lateral_width(a), lateral_width(b)) / distance(a, b);
        nearest = std::min(nearest, std::fabs(wide / rules.blend.grown - 1));
      }
      EXPECT_LT(nearest, 0.5) << i;
    }
    on.move_to(touch);
    EXPECT_EQ(find_appearances(on, rules, touch + 1e-6, touch + 1e-6, list, 4), 0);
  }
  EXPECT_GT(told, 10);
}

// What a search for parts finds at other heights: by the appearance alone to a quarter, between two
// heights whose parts are known to half a hundredth, and at these to rounding.
TEST_P(PatchSearch, TellsHowFarPartsAreJoined) {
  const profiles::curve rippled = with_ripples();
  const profile rail(surfaces::view(rippled));
  side_geometry on(scene.wheel_curve, rail, scene.sizes, scene.track);
  const patch_rules rules;
  part_set found;
  // the neighbours on both sides of what appeared, at z; false: they are not two
  const auto exact = [&](const joining &pair, double z, double &value, int &first) {
    on.move_to(z);
    find_parts(on, found);
    for (first = 0; first + 1 < found.count; ++first) {
      const part &a = found.parts[first], &b = found.parts[first + 1];
      if (!(a.begin < pair.inside(0) && pair.inside(0) < a.end)) continue;
      if (!(b.begin < pair.inside(1) && pair.inside(1) < b.end)) continue;
      value = joined(rules.blend, a, b);
      return true;
    }
    return false;
  };
  int told = 0, steep = 0;
  for (int i = 0; i < 120; ++i) {
    side_motion m;
    m.wheelset.y = -6e-3 + 1e-4 * i;
    on.place(m);
    double touch = 0;
    ASSERT_TRUE(first_touch(on, touch));
    on.move_to(touch);
    appearance list[4];
    const int count = find_appearances(on, rules, touch + 1e-6, touch + 1.5e-4, list, 4);
    for (int k = 0; k < count; ++k) {
      on.move_to(touch);
      joining pair(on, rules.blend, list[k]);
      EXPECT_EQ(pair.joined(rules.blend, list[k].z), 0);
      const auto height = [&](double share) { return list[k].z + share * list[k].length; };
      double value = 0;
      int first = 0;
      for (const double share : {0.2, 0.35, 0.5, 0.7}) {
        if (!exact(pair, height(share), value, first)) continue;
        ++told;
        steep += value > 0.1 && value < 0.9;
        EXPECT_NEAR(pair.joined(rules.blend, height(share)), value, 0.25) << i << " " << share;
      }
      for (const double share : {0.3, 0.6}) {
        if (!exact(pair, height(share), value, first)) continue;
        pair.add(on, found.parts[first], found.parts[first + 1]);
        EXPECT_NEAR(pair.joined(rules.blend, height(share)), value, 1e-12) << i << " " << share;
      }
      for (const double share : {0.35, 0.45, 0.55}) {
        if (!exact(pair, height(share), value, first)) continue;
        EXPECT_NEAR(pair.joined(rules.blend, height(share)), value, 5e-3) << i << " " << share;
      }
    }
  }
  EXPECT_GT(told, 40);
  EXPECT_GT(steep, 10);
}

TEST_P(PatchSearch, FirstTouchLeavesNoGap) {
  for (const double y : {0.0, 1.3e-3, -2e-3, 4.4e-3}) {
    place(y, 0, 1e-3);
    double near = 0, least = HUGE_VAL;
    const double step = side.sample_s(1) - side.sample_s(0);
    for (int i = 0; i < side.sample_count(); ++i)
      if (side.sample_gap(i) < least) least = side.sample_gap(i), near = side.sample_s(i);
    // thirds
    double low = near - 2 * step, high = near + 2 * step;
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (side.locus(a).gap < side.locus(b).gap ? high : low) =
          side.locus(a).gap < side.locus(b).gap ? b : a;
    }
    EXPECT_NEAR(side.locus(0.5 * (low + high)).gap, 0, 2e-15) << y;
  }
}

// Ends of parts are where the gap is zero, also of one that a few nanometres of depth open.
TEST_P(PatchSearch, EndsHaveNoGap) {
  int ends = 0;
  for (int i = 0; i < 60; ++i) {
    place(-4e-3 + 1.5e-4 * i, std::pow(10.0, -8 + 4.0 * (i % 20) / 19), 6e-3 * std::sin(2.0 * i));
    part_set found;
    find_parts(side, found);
    ASSERT_GT(found.count, 0);
    for (int k = 0; k < found.count; ++k) {
      const part &p = found.parts[k];
      if (p.cut_off) continue;
      for (const double s : {p.begin, p.end}) {
        // across the 1e-11 m that an end may be off the gap changes sign
        const double inward = s == p.begin ? 1e-11 : -1e-11;
        EXPECT_LT(side.gap(s + inward), 1e-15) << i;
        EXPECT_GT(side.gap(s - inward), -1e-15) << i;
        ++ends;
      }
    }
  }
  EXPECT_GT(ends, 100);
}

TEST_P(PatchSearch, SlopeIsThatOfTheGap) {
  constexpr double step = 1e-6;
  const double slack = scene.track.kind == track_kind::rail ? 1e-4 : 1e-2;
  int known = 0;
  for (const double yaw : {0.0, 8e-3, -3e-3}) {
    place(1.3e-3, 2e-5, yaw);
    for (int i = 0; i < 200; ++i) {
      const double s = side.sample_s(0) + 3.1e-4 * i;
      locus_place last;
      double slope = 0;
      const double gap = side.gap(s, last, slope);
      EXPECT_EQ(gap, side.gap(s));
      // beyond 20 mm no part of contact ends
      if (!(std::fabs(gap) < 0.02)) continue;
      const double low = side.gap(s - step), high = side.gap(s + step);
      EXPECT_NEAR(slope, (high - low) / (2 * step), slack * (1 + std::fabs(slope))) << s;
      ++known;
    }
  }
  EXPECT_GT(known, 200);
}

// From wherever a search starts it ends with the same bits.
TEST_P(PatchSearch, PlacesOfTheLastSearchChangeNothing) {
  place(0.5e-3, 5e-5, 4e-3);
  locus_place last;
  int valid = 0;
  for (int i = 0; i < 600; ++i) {
    const double share = std::fmod(0.618034 * i * (i % 3 == 0 ? 1.0 : 0.01), 1.0);
    const double s = side.sample_s(0) + share * (side.sample_s(side.sample_count() - 1));
    const locus_point one = side.locus(s), other = side.locus(s, last);
    ASSERT_EQ(one.valid, other.valid);
    if (!one.valid) continue;
    ++valid;
    EXPECT_EQ(one.gap, other.gap);
    EXPECT_EQ(one.contact_angle, other.contact_angle);
    EXPECT_EQ(one.wheel, other.wheel);
    EXPECT_EQ(side.gap(s), side.gap(s, last));
  }
  EXPECT_GT(valid, 200);
}

// Points found one from the other are those found alone, over kinks of the profiles too.
TEST_P(PatchSearch, WalkIsTheLocus) {
  for (const double y : {-1e-3, 0.5e-3, 3e-3}) {
    place(y, 8e-5, 6e-3);
    part_set found;
    find_parts(side, found);
    ASSERT_GT(found.count, 0);
    locus_walk walk(side);
    for (int k = 0; k < found.count; ++k)
      for (int i = 0; i <= 60; ++i) {
        const part &p = found.parts[k];
        const double s = p.begin + (p.end - p.begin) * i / 60;
        const locus_point one = side.locus(s), other = walk(s);
        ASSERT_TRUE(one.valid);
        ASSERT_TRUE(other.valid);
        // both end where an error that falls with the step's square or cube is below 1e-13 m
        EXPECT_NEAR(other.gap, one.gap, 3e-13);
        EXPECT_NEAR(other.contact_angle, one.contact_angle, 1e-10);
        EXPECT_NEAR(other.curvature, one.curvature, 1e-14);
        for (size_t j = 0; j < 3; ++j) {
          EXPECT_NEAR(other.wheel[j], one.wheel[j], 1e-15);
          EXPECT_NEAR(other.normal[j], one.normal[j], 1e-14);
        }
      }
  }
}

// Rows of a grid are what is met on the line through each element alone; slopes of a level rail
// found with them are those found alone.
TEST_P(PatchSearch, HeightsAreThoseOfEachElement) {
  place(0.5e-3, 8e-5, 6e-3);
  part_set found;
  patch_region regions[4];
  ASSERT_GT(find_patches(side, {}, found, regions, 4).count, 0);
  const patch_region &r = regions[0];
  const int nx = 21, ny = 9;
  const double dx = 1.2 * (r.x_max - r.x_min) / (nx - 1), dy = (r.s_max - r.s_min) / (ny - 1);
  const surface_grid g{nx, ny, -0.5 * (nx - 1) * dx, r.s_min, dx, dy};
  std::vector<double> h(nx * ny), field(6 * ny);
  const bool level = GetParam() == track_kind::rail;
  surface_slopes with{field.data(), field.data() + ny, field.data() + 2 * ny};
  surface_slopes alone{field.data() + 3 * ny, field.data() + 4 * ny, field.data() + 5 * ny};
  side.undeformed_distance(r.frame, g, h.data(), level ? &with : nullptr);
  const frame_axes<double> axes = axes_of(r.frame);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      contact_frame moved = r.frame;
      moved.origin = r.frame.origin + (g.x0 + i * dx) * axes.x + (g.y0 + j * dy) * axes.s;
      double start[2] = {std::nan(""), std::nan("")};
      const section_point both = side.section(moved, start);
      ASSERT_TRUE(both.valid);
      EXPECT_NEAR(h[static_cast<size_t>(j * nx + i)], both.rail - both.wheel, 1e-10);
    }
  if (!level) return;
  side.rail_slopes(r.frame, g, true, alone);
  for (int k = 0; k < 3 * ny; ++k)
    EXPECT_EQ(field[static_cast<size_t>(k)], field[static_cast<size_t>(3 * ny + k)]);
}

TEST_P(PatchSearch, TellsWhereThereIsNone) {
  patch_region regions[2];
  part_set found;
  place(0, -1e-4);
  EXPECT_EQ(find_patches(side, {}, found, regions, 2).status, search_status::no_contact);
  side_motion m;
  m.wheelset.y = 0.5;
  side.place(m);
  EXPECT_TRUE(side.no_overlap());
  double z = 7;
  EXPECT_FALSE(first_touch(side, z));
  EXPECT_EQ(find_patches(side, {}, found, regions, 2).status, search_status::out_of_range);
  EXPECT_EQ(found.count, 0);
}

INSTANTIATE_TEST_SUITE_P(Tracks, PatchSearch, testing::Values(track_kind::rail, track_kind::roller),
                         [](const auto &info) {
                           return std::string(info.param == track_kind::rail ? "rail" : "roller");
                         });

TEST(PatchRegion, IsMirroredWithItsCuts) {
  patch_region r;
  r.frame = {{1, 2, 3}, 0.4, 0.5};
  r.x_min = -1, r.x_max = 2, r.s_min = -3, r.s_max = 5;
  r.parts = 4;
  for (int k = 0; k < 3; ++k) r.cut[k] = k - 0.5, r.coupling[k] = 0.1 * (k + 1);
  const patch_region m = mirrored(r);
  EXPECT_EQ(m.frame.origin, (vec3{1, -2, 3}));
  EXPECT_EQ(m.frame.contact_angle, -0.4);
  EXPECT_EQ(m.x_min, -1);
  EXPECT_EQ(m.x_max, 2);
  EXPECT_EQ(m.s_min, -5);
  EXPECT_EQ(m.s_max, 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(m.cut[k], -r.cut[2 - k]);
    EXPECT_EQ(m.coupling[k], r.coupling[2 - k]);
  }
}

}  // namespace
