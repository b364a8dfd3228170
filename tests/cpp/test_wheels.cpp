// What a step of wheels reports of the whole, put together anew from its patches.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes.hpp"

namespace {

struct sums {
  double force[3] = {}, moment[3] = {}, load = 0;
};

// About the wheelset's centre, of the patches of one side.
sums summed(const rp_side_result &side, const double centre[3]) {
  sums out;
  for (int k = 0; k < side.patch_count + side.alternative_count; ++k) {
    const rp_patch_result &p = side.patch[k];
    const double c = std::cos(p.contact_angle), s = std::sin(p.contact_angle);
    const double fx = p.share * p.creep_force[0], fs = p.share * p.creep_force[1],
                 fn = -p.share * p.normal_force, spin = p.share * p.spin_moment;
    const double f[3] = {fx, c * fs - s * fn, s * fs + c * fn};
    double r[3];
    for (int i = 0; i < 3; ++i) r[i] = p.position[i] - centre[i];
    const double turned[3] = {0, -s * spin, c * spin};
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      out.force[i] += f[i];
      out.moment[i] += r[j] * f[l] - r[l] * f[j] + turned[i];
    }
    out.load += p.share * p.normal_force;
  }
  return out;
}

// N and N m that a side has beside the sum of one patch: their size, and along its normal.
struct apart {
  double force = 0, force_along = 0, moment = 0, moment_along = 0;
};

apart beside(const rp_side_result &side, const sums &of_patch) {
  apart out;
  const double angle = side.patch[0].contact_angle;
  const double n[3] = {0, -std::sin(angle), std::cos(angle)};
  for (int i = 0; i < 3; ++i) {
    const double f = side.force[i] - of_patch.force[i], m = side.moment[i] - of_patch.moment[i];
    out.force_along += f * n[i];
    out.moment_along += m * n[i];
    out.force = std::max(out.force, std::fabs(f));
    out.moment = std::max(out.moment, std::fabs(m));
  }
  return out;
}

class Wheels : public testing::TestWithParam<rp_track> {
 protected:
  rp_config config(rp_kind kind) const {
    rp_config c = scenes::wheels(kind, GetParam(), pair);
    c.normal = RP_NORMAL_ANALYN;
    c.tangential = RP_TANGENTIAL_FASTSIM;
    return c;
  }
  rp_input input(int k) const {
    rp_input in = scenes::running(GetParam());
    in.y = 1e-3 * k;
    in.yaw = 2e-3 * (k % 3 - 1);
    in.vertical_force = 8e4 + 2e4 * k;
    return in;
  }
  scenes::profile_pair pair;
};

// By the rule "contact" pressure acts along the frame's normal, and its force is the patch's.
TEST_P(Wheels, ForcesAndMomentsAreThoseOfTheirPatches) {
  for (const rp_kind kind : {RP_WHEEL_RAIL, RP_WHEELSET}) {
    rp_config c = config(kind);
    c.patch_rule = RP_PATCHES_CONTACT;
    scenes::handle h(c);
    for (int n = 0; n < 8; ++n) {
      SCOPED_TRACE(testing::Message() << kind << ' ' << n);
      const rp_input in = input(n);
      const rp_result r = h.step(in);
      ASSERT_EQ(r.status, RP_CONVERGED);
      const double centre[3] = {0, in.y, r.z - c.nominal_radius};
      double vertical = 0, force[3] = {}, moment[3] = {};
      for (int side = 0; side < 2; ++side) {
        const rp_side_result &found = r.side[side];
        if (kind == RP_WHEEL_RAIL && side != c.side) continue;
        const sums expected = summed(found, centre);
        for (int i = 0; i < 3; ++i) {
          EXPECT_NEAR(found.force[i], expected.force[i], 1e-9 * expected.load);
          force[i] += found.force[i];
          moment[i] += found.moment[i];
        }
        vertical -= found.force[2];
        if (!(expected.load > 0)) continue;
        // the running circle's, but for the flange's depth
        EXPECT_NEAR(found.rolling_radius, c.nominal_radius, 0.02);
        if (found.patch_count + found.alternative_count > 1) continue;
        // pressure has a moment of its own about the reference, along the surface; parts of contact
        // that are one patch lie no further from it than the rule says
        const apart own = beside(found, expected);
        EXPECT_NEAR(own.moment_along, 0, 1e-9 * expected.load);
        EXPECT_LE(own.moment, 8e-3 * expected.load);
      }
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(r.force[i], force[i], 1e-12 * std::fabs(vertical));
        EXPECT_NEAR(r.moment[i], moment[i], 1e-12 * std::fabs(vertical));
      }
      EXPECT_NEAR(vertical, in.vertical_force, 1.01 * c.tolerance * in.vertical_force);
      EXPECT_GT(r.evaluations, 0);
    }
  }
}

// With normals of its own pressure has a part in the frame's plane, no more than the surface turns
// by over the contact, and the same force along the frame's normal.
TEST_P(Wheels, PressureAlongItsNormalsHasAPartInThePlane) {
  for (int n = 0; n < 8; ++n) {
    SCOPED_TRACE(n);
    rp_config c = config(RP_WHEEL_RAIL);
    c.load = RP_POSITION;
    rp_input in = input(n);
    {
      rp_config by_force = c;
      by_force.load = RP_FORCE;
      in.z = scenes::handle(by_force).step(in).z;
    }
    const rp_result r = scenes::handle(c).step(in);
    c.patch_rule = RP_PATCHES_CONTACT;
    const rp_result other = scenes::handle(c).step(in);
    ASSERT_EQ(r.status, RP_CONVERGED);
    ASSERT_EQ(other.status, RP_CONVERGED);
    const rp_side_result &found = r.side[c.side];
    if (found.patch_count + found.alternative_count > 1) continue;
    const double centre[3] = {0, in.y, r.z - c.nominal_radius};
    const sums expected = summed(found, centre);
    const apart own = beside(found, expected);
    EXPECT_NEAR(own.force_along, 0, 1e-9 * expected.load);
    EXPECT_GT(own.force, 0);
    // rad, half of a contact that is less than 20 mm across on arcs of 80 mm and more
    EXPECT_LE(own.force, 10e-3 / 80e-3 * expected.load);
    EXPECT_EQ(found.patch[0].normal_force, other.side[c.side].patch[0].normal_force);
  }
}

// The height found carries the force, and the step at that height is the same one.
TEST_P(Wheels, AHeightFoundIsAHeightGiven) {
  rp_config c = config(RP_WHEELSET);
  scenes::handle by_force(c);
  c.load = RP_POSITION;
  scenes::handle by_height(c);
  for (int n = 0; n < 5; ++n) {
    rp_input in = input(n);
    const rp_result a = by_force.step(in);
    in.z = a.z;
    const rp_result b = by_height.step(in);
    EXPECT_EQ(b.z, a.z);
    EXPECT_EQ(b.evaluations, 1);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a.force[i], b.force[i], 1e-9 * in.vertical_force);
    // without change the next step finds it at once
    rp_input same = input(n);
    EXPECT_LE(by_force.step(same).evaluations, 2);
  }
}

// Grids of a size: centres on its multiples, one element beyond the contact on each side; of a
// count: that many across, one more on each side.
TEST_P(Wheels, GridsHoldTheirContacts) {
  for (const int elements : {0, 14}) {
    rp_config c = config(RP_WHEEL_RAIL);
    if (elements > 0) {
      c.elements[0] = elements;
      c.elements[1] = elements + 3;
      c.element_size[0] = c.element_size[1] = 0;
    } else {
      c.element_size[0] = 1.1e-3;
      c.element_size[1] = 0.7e-3;
    }
    scenes::handle h(c);
    for (int n = 0; n < 5; ++n) {
      const rp_patch_result p = h.step(input(n)).side[c.side].patch[0];
      const auto distance = h.field(c.side, 0, RP_FIELD_UNDEFORMED_DISTANCE);
      ASSERT_EQ(distance.size(), static_cast<size_t>(p.grid[0] * p.grid[1]));
      int low[2] = {1000, 1000}, high[2] = {-1, -1};
      for (int j = 0; j < p.grid[1]; ++j)
        for (int i = 0; i < p.grid[0]; ++i) {
          if (!(distance[static_cast<size_t>(j * p.grid[0] + i)] < 0)) continue;
          const int at[2] = {i, j};
          for (int k = 0; k < 2; ++k)
            low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
        }
      for (int k = 0; k < 2; ++k) {
        EXPECT_GE(low[k], 1);
        EXPECT_LE(high[k], p.grid[k] - 2);
        if (elements > 0) {
          EXPECT_EQ(p.grid[k], c.elements[k] + 2);
        } else {
          EXPECT_EQ(p.element_size[k], c.element_size[k]);
          const double first = p.grid_origin[k] / p.element_size[k];
          EXPECT_NEAR(first, std::round(first), 1e-9);
          // and little more than that
          EXPECT_LE(low[k], 3);
          EXPECT_GE(high[k], p.grid[k] - 4);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tracks, Wheels, testing::Values(RP_RAIL, RP_ROLLER), [](const auto &info) {
  return std::string(info.param == RP_RAIL ? "rail" : "roller");
});

}  // namespace
