// Rates of one side's geometry: every direction of motion, several at once, against central
// differences of the plain geometry.
#include "geometry/rates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "geometry/patch.hpp"
#include "surfaces.hpp"

namespace {

using namespace railpatch;

// all that moves, one after the other, with lengths for differences
struct number {
  double *at;
  double length;
};
std::vector<number> numbers_of(side_motion &m) {
  wheelset_state &w = m.wheelset;
  std::vector<number> all{{&w.y, 1e-7},         {&w.z, 1e-7},         {&w.roll, 1e-7},
                          {&w.yaw, 1e-6},       {&w.speed, 1e-3},     {&w.vy, 1e-3},
                          {&w.vz, 1e-3},        {&w.roll_rate, 1e-3}, {&w.yaw_rate, 1e-3},
                          {&w.pitch_rate, 1e-3}};
  for (deviation *d : {&m.wheel, &m.rail})
    for (size_t k = 0; k < 3; ++k) {
      all.push_back({&d->offset[k], 1e-7});
      if (d == &m.wheel || k == 0) all.push_back({&d->rotation[k], 1e-6});
      all.push_back({&d->velocity[k], 1e-3});
      all.push_back({&d->angular_velocity[k], 1e-3});
    }
  all.push_back({&m.roller_pitch_rate, 1e-3});
  return all;
}

side_motion at_work(bool roller) {
  side_motion m;
  m.wheelset = {3e-3, 0, 1e-3, 0.012, roller ? 0.3 : 18.0, 0.2, 0.1, 0.05, 0.1, -40};
  m.wheel = {{1e-3, 5e-4, 2e-4}, {2e-3, 1e-3, -3e-3}, {0.1, -0.2, 0.1}, {0.2, 0.1, 0.3}};
  m.rail = {{1e-3, -3e-4, 4e-4}, {-4e-3, 0, 0}, {-0.1, 0.1, 0.2}, {-0.1, 0.2, 0.1}};
  m.roller_pitch_rate = roller ? 19 : 0;
  return m;
}

class GeometryRates : public testing::TestWithParam<track_kind> {
 protected:
  GeometryRates() : side(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track) {
    here = at_work(scene.roller());
    side.place(here);
    double z = 0;
    EXPECT_TRUE(first_touch(side, z));
    here.wheelset.z = z + 6e-5;
    side.place(here);
    find_parts(side, found);
    EXPECT_EQ(found.count, 1);
    s = 0.5 * (found.parts[0].begin + found.parts[0].end);
    const locus_point l = side.locus(s);
    frame = {{l.wheel[0] + 1e-3, l.wheel[1] + 2e-3, l.rail_z}, l.contact_angle + 0.01};
  }
  static constexpr surface_grid grid{4, 5, -5e-3, -4e-3, 3e-3, 2e-3};

  std::vector<double> plain(const side_geometry &g) const {
    const locus_point l = g.locus(s);
    std::vector<double> v{l.wheel[0], l.wheel[1], l.wheel[2], l.gap, l.contact_angle, l.curvature};
    double z = 0, angle = 0;
    EXPECT_TRUE(g.rail_surface(frame.origin[0], frame.origin[1], z, angle));
    v.insert(v.end(), {z, angle});
    const creepage_state c = g.creepages(frame, 5e-5);
    v.insert(v.end(), {c.xi, c.eta, c.phi, c.rolling_speed, g.rolling_radius(frame, 5e-5)});
    for (double x : g.lever(frame)) v.push_back(x);
    double h[20];
    g.undeformed_distance(frame, grid, h);
    v.insert(v.end(), h, h + 20);
    return v;
  }
  std::vector<double> of_part(const side_geometry &g) const {
    part_set parts;
    find_parts(g, parts);
    const part &p = parts.parts[0];
    return {p.begin, p.end,      p.weight * 1e12, p.x,       p.y,       p.angle,  p.x_min,
            p.x_max, p.first[1], p.first[2],      p.last[0], p.last[1], p.last[2]};
  }

  surfaces::scene scene{GetParam()};
  side_geometry side;
  side_motion here;
  part_set found;
  double s = 0;
  contact_frame frame;
};

TEST_P(GeometryRates, AreThoseOfDifferencesInEveryDirection) {
  side_motion probe = here;
  const size_t count = numbers_of(probe).size();
  side_geometry beside(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track);
  for (size_t from = 0; from < count; from += rate_directions) {
    motion_rates motion;
    motion.count = static_cast<int>(std::min<size_t>(rate_directions, count - from));
    for (int k = 0; k < motion.count; ++k) {
      side_motion none{};
      *numbers_of(none)[from + static_cast<size_t>(k)].at = 1;
      motion.direction[static_cast<size_t>(k)] = none;
    }
    const moving_geometry moving(side, motion);
    const rated_frame f{{frame.origin[0], frame.origin[1], frame.origin[2]}, frame.contact_angle};
    std::vector<rated> rates;
    const rated_locus l = moving.locus(rated(s));
    ASSERT_TRUE(l.valid);
    rates.insert(rates.end(), l.wheel.begin(), l.wheel.end());
    rates.insert(rates.end(), {l.gap, l.contact_angle, l.curvature});
    rated z, angle;
    ASSERT_TRUE(moving.rail_surface(frame.origin[0], frame.origin[1], z, angle));
    rates.insert(rates.end(), {z, angle});
    const auto c = moving.creepages(f, rated(5e-5));
    rates.insert(rates.end(),
                 {c.xi, c.eta, c.phi, c.rolling_speed, moving.rolling_radius(f, rated(5e-5))});
    for (const rated &x : moving.lever(f)) rates.push_back(x);
    const size_t distances = rates.size();
    double h[rate_directions][20], *to[rate_directions];
    for (size_t k = 0; k < rate_directions; ++k) to[k] = h[k];
    moving.distance_rates(f, grid, nullptr, motion.count, to);
    const basic_part<rated> p = moving.part_of(found.parts[0]);
    const rated of_parts[] = {p.begin,   p.end,     1e12 * p.weight, p.x,        p.y,
                              p.angle,   p.x_min,   p.x_max,         p.first[1], p.first[2],
                              p.last[0], p.last[1], p.last[2]};

    for (int k = 0; k < motion.count; ++k) {
      const auto slot = static_cast<size_t>(k);
      std::vector<double> ends[2], parts[2];
      double length = 0;
      for (int e = 0; e < 2; ++e) {
        side_motion moved = here;
        const number n = numbers_of(moved)[from + slot];
        length = n.length;
        *n.at += e == 0 ? -length : length;
        beside.place(moved);
        ends[e] = plain(beside);
        parts[e] = of_part(beside);
      }
      SCOPED_TRACE(testing::Message() << "number " << from + slot);
      for (size_t i = 0; i < ends[0].size(); ++i) {
        const double difference = (ends[1][i] - ends[0][i]) / (2 * length);
        const double rate = i < distances ? rates[i].rate[slot] : h[k][i - distances];
        // rounding and what searches leave of 1e-12 m
        EXPECT_NEAR(rate, difference, 1e-4 * std::fabs(difference) + 3e-12 / length + 1e-7) << i;
      }
      for (size_t i = 0; i < parts[0].size(); ++i) {
        const double difference = (parts[1][i] - parts[0][i]) / (2 * length);
        EXPECT_NEAR(of_parts[i].rate[slot], difference,
                    2e-3 * std::fabs(difference) + 1e-10 / length + 1e-6)
            << "of the part, " << i;
      }
    }
  }
}

// How a part changes with the wheel's place, against its rates with the wheelset's y, z, roll, yaw.
TEST_P(GeometryRates, PlaceSlopesAreRatesWithTheWheelset) {
  motion_rates motion;
  motion.count = 4;
  using w = wheelset_state;
  size_t slot = 0;
  for (double w::*number : {&w::y, &w::z, &w::roll, &w::yaw})
    motion.direction[slot++].wheelset.*number = 1;
  const basic_part<rated> rates = moving_geometry(side, motion).part_of(found.parts[0]);
  const part &p = found.parts[0];
  const w &at = here.wheelset;
  const vec3 centre{0, at.y, at.z - scene.sizes.nominal_radius};
  const vec3 axis{0, -std::sin(at.roll), std::cos(at.roll)};  // of the yaw
  const auto along = [&](const place_slope &slope) {
    const vec3 turning = slope.by_turn - cross(centre, slope.by_offset);
    return std::array{slope.by_offset[1], slope.by_offset[2], turning[0], dot(turning, axis)};
  };
  // sums over 64 rows, without what the curvature along x changes by
  const auto expect = [&](const char *name, const place_slope &slope, const rated &rate,
                          const std::array<double, 4> &usual) {
    for (size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(along(slope)[k], rate.rate[k], 5e-3 * std::fabs(usual[k]) + 1e-9)
          << name << ", direction " << k;
  };
  expect("weight", p.weight_slope, rates.weight,
         {rates.weight.rate[0], rates.weight.rate[1], rates.weight.rate[2], rates.weight.rate[3]});
  // a mean over the part changes by its angles' half range times the weight's own
  std::array<double, 4> usual = along(p.weight_slope);
  const double range = side.locus(p.end).contact_angle - side.locus(p.begin).contact_angle;
  for (double &u : usual) u *= 0.5 * range / p.weight;
  expect("angle", p.angle_slope, rates.angle, usual);
  const rated gap = moving_geometry(side, motion).locus(rated(s)).gap;
  const locus_point l = side.locus(s);
  EXPECT_NEAR(depth_slope(l.wheel, l.normal).by_offset[2], -gap.rate[1], 1e-12);
}

// Elements that move with their lattice, and a frame that moves.
TEST_P(GeometryRates, DistancesFollowLatticeAndFrame) {
  const moving_geometry moving(side, motion_rates{{}, 4});
  rated_frame f{{frame.origin[0], frame.origin[1], frame.origin[2]}, frame.contact_angle};
  lattice_rates lattice[4];
  lattice[0] = {{1, 0.5}, {0.2, 0.1}};
  lattice[1] = {{0, -1}, {0, 0.3}};
  f.origin[0].rate[2] = 0.3;
  f.origin[1].rate[2] = 1;
  f.origin[2].rate[2] = -0.2;
  f.contact_angle.rate[3] = 1;
  double h[4][20], *to[4] = {h[0], h[1], h[2], h[3]};
  moving.distance_rates(f, grid, lattice, 4, to);
  constexpr double length = 1e-6;
  for (int k = 0; k < 4; ++k) {
    double ends[2][20];
    for (int e = 0; e < 2; ++e) {
      const double by = e == 0 ? -length : length;
      contact_frame g = frame;
      for (size_t c = 0; c < 3; ++c) g.origin[c] += by * f.origin[c].rate[static_cast<size_t>(k)];
      g.contact_angle += by * f.contact_angle.rate[static_cast<size_t>(k)];
      const lattice_rates &l = lattice[k];
      side.undeformed_distance(
          g,
          {grid.nx, grid.ny, grid.x0 + by * l.origin[0], grid.y0 + by * l.origin[1],
           grid.dx + by * l.size[0], grid.dy + by * l.size[1]},
          ends[e]);
    }
    for (int i = 0; i < 20; ++i)
      EXPECT_NEAR(h[k][i], (ends[1][i] - ends[0][i]) / (2 * length), 1e-5) << k << ' ' << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Tracks, GeometryRates,
                         testing::Values(track_kind::rail, track_kind::roller),
                         [](const auto &info) {
                           return std::string(info.param == track_kind::rail ? "rail" : "roller");
                         });

}  // namespace
