// Profiles along the track and round the wheel whose knots go with features: what cubics through
// sections reproduce, where they are smooth, and that sections that say the same as one profile
// give its result to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/profile_sections.hpp"
#include "profiles.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;

profile_view view(const profiles::curve &c) {
  return {c.s.data(),  c.y.data(),  c.z.data(),
          c.dy.data(), c.dz.data(), static_cast<int>(c.s.size())};
}

constexpr int knots = 7;

// s, y and z of knot i at a place are these polynomials of it, by number.
double polynomial(int number, int i, int degree, double x) {
  const double k = 0.01 * (i + 1) + 0.003 * number;
  double value = 0.1 * i + 0.02 * number;
  if (degree > 0) value += k * x;
  if (degree > 1) value -= 0.3 * k * x * x;
  return value;
}

profiles::curve section_of(int degree, double x) {
  profiles::curve c;
  for (int i = 0; i < knots; ++i) {
    c.s.push_back(polynomial(0, i, degree, x));
    c.y.push_back(polynomial(1, i, degree, x));
    c.z.push_back(polynomial(2, i, degree, x));
    c.dy.push_back(0.8);
    c.dz.push_back(0.6);
  }
  return c;
}

class stack {
 public:
  stack(const std::vector<double> &positions, const section_rules &rules,
        const std::vector<profiles::curve> &curves)
      : sections_(views_of(curves).data(), positions.data(), static_cast<int>(positions.size()),
                  rules) {}
  profile_view at(double x) {
    bool changed;
    return sections_.at(x, changed);
  }
  section_rate rate(int piece, double share) const { return sections_.rate(piece, share); }

 private:
  static std::vector<profile_view> views_of(const std::vector<profiles::curve> &curves) {
    std::vector<profile_view> views;
    for (const profiles::curve &c : curves) views.push_back(view(c));
    return views;
  }
  profile_sections sections_;
};

section_rules cubic_rules() {
  section_rules rules;
  rules.by_knot = rules.cubic = true;
  return rules;
}

// A point at a share of a piece, as a profile has it, and the slopes there by the arc length.
curve_point point_at(stack &sections, double x, int piece, double share) {
  const profile_view v = sections.at(x);
  const profile curve(v);
  return curve.evaluate(v.s[piece] + share * (v.s[piece + 1] - v.s[piece]), piece);
}

void expect_rates(const std::vector<double> &positions, const section_rules &rules,
                  const std::vector<profiles::curve> &curves) {
  stack sections(positions, rules, curves);
  const double h = 1e-6;
  for (const double x : {0.1, 0.5, 0.71, 1.3, 2.4})
    for (const int piece : {0, 2, knots - 2})
      for (const double share : {0.0, 0.3, 0.9}) {
        const curve_point a = point_at(sections, x - h, piece, share),
                          b = point_at(sections, x + h, piece, share);
        const profile_view v = sections.at(x);
        const double length = v.s[piece + 1] - v.s[piece], d = 1e-4;
        const section_rate found = sections.rate(piece, share);
        EXPECT_NEAR(found.y, (b.y - a.y) / (2 * h), 1e-8) << x << ' ' << piece << ' ' << share;
        EXPECT_NEAR(found.z, (b.z - a.z) / (2 * h), 1e-8) << x << ' ' << piece << ' ' << share;
        const section_rate next = sections.rate(piece, share + d),
                           last = sections.rate(piece, share - d);
        EXPECT_NEAR(found.dy, (next.y - last.y) / (2 * d * length), 1e-6);
        EXPECT_NEAR(found.dz, (next.z - last.z) / (2 * d * length), 1e-6);
      }
  sections.at(positions.back() + 0.5);
  EXPECT_EQ(sections.rate(1, 0.5).z, 0.0);
}

stack polynomials(const std::vector<double> &positions, const section_rules &rules, int degree) {
  std::vector<profiles::curve> curves;
  for (const double x : positions) curves.push_back(section_of(degree, x));
  return {positions, rules, curves};
}

// Curves whose knots, tangents and lengths differ.
TEST(Sections, RatesAreDerivativesByPosition) {
  const std::vector<double> positions{0.0, 0.7, 1.1, 3.0};
  std::vector<profiles::curve> apart, alike;
  for (const double x : positions) {
    profiles::curve c = section_of(2, 0.2 * x);
    for (size_t i = 0; i < c.dy.size(); ++i) {
      c.dy[i] = 0.8 + 0.05 * std::sin(static_cast<double>(i) + x);
      c.dz[i] = 0.6 + 0.05 * std::cos(2.0 * static_cast<double>(i) - x);
    }
    apart.push_back(c);
    for (int i = 0; i < knots; ++i)
      c.s[static_cast<size_t>(i)] = (0.1 + 0.01 * x) * i / (knots - 1);
    alike.push_back(c);
  }
  section_rules by_knot = cubic_rules(), by_share;
  const std::vector<std::int32_t> kinks{0, 1, 0, 0};
  expect_rates(positions, by_knot, apart);
  by_knot.kink = kinks.data();
  expect_rates(positions, by_knot, apart);
  by_knot.cubic = false;
  expect_rates(positions, by_knot, apart);
  expect_rates(positions, by_share, alike);
}

TEST(Sections, CubicsHaveTheParabolaThroughThreeSections) {
  const std::vector<double> positions{-1.0, -0.2, 0.5, 0.9, 2.0, 2.6};
  stack sections = polynomials(positions, cubic_rules(), 2);
  // but at the outer ends, where the slope is 0
  for (double x = -0.2; x <= 2.0; x += 0.05) {
    const profile_view v = sections.at(x);
    for (int i = 0; i < knots; ++i) {
      EXPECT_NEAR(v.s[i], polynomial(0, i, 2, x), 1e-15) << x;
      EXPECT_NEAR(v.y[i], polynomial(1, i, 2, x), 1e-15) << x;
      EXPECT_NEAR(v.z[i], polynomial(2, i, 2, x), 1e-15) << x;
    }
  }
}

// A straight line that turns at a kink stays two straight lines.
TEST(Sections, CubicsTurnAtAKink) {
  const std::vector<double> positions{-2.0, -1.0, 0.0, 0.7, 1.5, 3.0};
  std::vector<profiles::curve> curves;
  for (const double x : positions) curves.push_back(section_of(1, std::fabs(x)));
  const std::int32_t kinks[] = {0, 0, 1, 0, 0, 0};
  section_rules rules = cubic_rules();
  rules.kink = kinks;
  stack sections(positions, rules, curves);
  for (double x = -1.0; x <= 1.5; x += 0.05) {
    const profile_view v = sections.at(x);
    for (int i = 0; i < knots; ++i)
      EXPECT_NEAR(v.z[i], polynomial(2, i, 1, std::fabs(x)), 1e-15) << x;
  }
  // and one between two kinks is a chord
  const std::int32_t both[] = {0, 1, 1, 0, 0, 0};
  rules.kink = both;
  stack chord(positions, rules, curves);
  EXPECT_NEAR(chord.at(-0.25).y[3], polynomial(1, 3, 1, 0.25), 1e-15);
}

// What goes on evenly through a kink has one slope there, also from or to an outer end, whose slope
// is 0: a rail on the way beside which a part begins or ends.
TEST(Sections, CubicsGoOnEvenlyThroughAKinkNextToAnEnd) {
  const std::vector<double> positions{-0.3, -0.001, 0.0, 0.5, 0.501, 0.8};
  const std::int32_t kinks[] = {0, 1, 1, 1, 1, 0};
  section_rules rules = cubic_rules();
  rules.kink = kinks;
  stack sections = polynomials(positions, rules, 1);
  for (const double x : {-0.001, 0.0, 0.5, 0.501})
    for (const double side : {-1e-7, 1e-7})
      for (int i = 0; i + 1 < knots; ++i) {
        sections.at(x + side);
        const section_rate found = sections.rate(i, 0.0);
        EXPECT_NEAR(found.y, 0.01 * (i + 1) + 0.003, 1e-7) << x << ' ' << side;
        EXPECT_NEAR(found.z, 0.01 * (i + 1) + 0.006, 1e-7) << x << ' ' << side;
      }
  EXPECT_EQ((sections.at(-0.3), sections.rate(2, 0.5).z), 0.0);
}

double slope_of(stack &sections, double x, double step, int i) {
  const double after = sections.at(x + step).z[i];
  return (after - sections.at(x).z[i]) / step;
}

TEST(Sections, CubicsHaveAContinuousSlope) {
  const std::vector<double> positions{0.0, 0.4, 1.5, 1.7, 2.9};
  std::vector<profiles::curve> curves;
  for (const double x : positions) curves.push_back(section_of(2, std::sin(7 * x)));
  for (const double period : {0.0, 4.0}) {
    section_rules rules = cubic_rules();
    rules.period = period;
    stack sections(positions, rules, curves);
    constexpr double step = 1e-6;
    for (const double x : positions)
      for (int i = 0; i < knots; ++i) {
        const double before = slope_of(sections, x, -step, i);
        EXPECT_NEAR(slope_of(sections, x, step, i), before, 1e-5) << x << ' ' << period;
        if (period == 0 && (x == 0.0 || x == 2.9)) {
          EXPECT_NEAR(before, 0, 1e-6);
        }
      }
  }
}

// Round a wheel: a turn further on, or back, there is the same profile.
TEST(Sections, GoRound) {
  const std::vector<double> positions{0.3, 1.0, 2.0, 5.5};
  std::vector<profiles::curve> curves;
  for (const double x : positions) curves.push_back(section_of(1, std::cos(x)));
  for (const bool cubic : {false, true}) {
    section_rules rules;
    rules.cubic = cubic;
    rules.by_knot = true;
    rules.period = 2 * std::numbers::pi;
    stack sections(positions, rules, curves);
    for (const double x : {0.0, 0.2999, 0.3, 0.7, 5.0, 5.5, 6.2}) {
      const double z = sections.at(x).z[4];
      for (const int turns : {-3, -1, 1, 200})
        EXPECT_NEAR(sections.at(x + turns * rules.period).z[4], z, 1e-12) << x << ' ' << turns;
    }
    // between the last and the first
    const double w = 0.5, middle = 5.5 + w * (0.3 + rules.period - 5.5);
    if (!cubic) {
      EXPECT_NEAR(sections.at(middle).z[4],
                  0.5 * (polynomial(2, 4, 1, std::cos(5.5)) + polynomial(2, 4, 1, std::cos(0.3))),
                  1e-15);
    }
  }
}

// Tangents are those by the knots' number over that of the arc length: of sections that are one
// curve drawn to other scales it is the curve's.
TEST(Sections, HaveTheTangentsOfTheMixedCurve) {
  profiles::curve circles[2];
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i <= 40; ++i) {
      const double r = 0.1 + 0.05 * k, a = 0.02 * i;
      circles[k].s.push_back(r * a);
      circles[k].y.push_back(r * std::sin(a));
      circles[k].z.push_back(r * (1 - std::cos(a)));
      circles[k].dy.push_back(std::cos(a));
      circles[k].dz.push_back(std::sin(a));
    }
  section_rules rules;
  rules.by_knot = true;
  stack sections({0.0, 1.0}, rules, {circles[0], circles[1]});
  const profile_view v = sections.at(0.3);
  for (int i = 0; i <= 40; ++i) {
    EXPECT_NEAR(v.dy[i], std::cos(0.02 * i), 1e-14);
    EXPECT_NEAR(v.dz[i], std::sin(0.02 * i), 1e-14);
    EXPECT_NEAR(v.y[i], 0.115 * std::sin(0.02 * i), 1e-16);
  }
}

// --- handles -----------------------------------------------------------------------------------

void expect_equal(const rp_result &a, const rp_result &b) {
  EXPECT_EQ(scenes::difference(a, b), "");
}

TEST(Turnout, OfEqualSectionsIsOneProfile) {
  const scenes::profile_pair pair;
  const std::vector<rp_profile> rails(5, pair.rail.view()), wheels(3, pair.wheel.view());
  const double positions[] = {-1.0, 0.0, 0.1, 2.0, 5.0}, angles[] = {0.0, 0.1, 4.0};
  const std::int32_t kinks[] = {0, 1, 1, 0, 0};
  const rp_config plain = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  for (const auto blend : {RP_SECTIONS_LINEAR, RP_SECTIONS_CUBIC}) {
    rp_config c = plain;
    c.section_match = RP_SECTIONS_BY_KNOT;
    c.section_blend = blend;
    for (int side = 0; side < 2; ++side) {
      c.rail_sections[side] = rails.data();
      c.section_position[side] = positions;
      c.section_kink[side] = kinks;
      c.section_count[side] = 5;
      c.wheel_sections[side] = wheels.data();
      c.wheel_section_angle[side] = angles;
      c.wheel_section_count[side] = 3;
    }
    scenes::handle varying(c), one(plain);
    rp_config c_held = c, plain_held = plain;
    c_held.load = plain_held.load = RP_POSITION;
    scenes::handle varying_held(c_held), one_held(plain_held);
    for (int k = 0; k < 6; ++k) {
      rp_input in = scenes::running(RP_RAIL);
      in.x = -1.5 + 1.3 * k;
      in.pitch = -2.0 * k;
      in.y = 1e-3 * k;
      // where profiles vary a search for the height begins elsewhere, and ends as near
      const double z = one.step(in).z, depth = 1e-4;
      EXPECT_NEAR(varying.step(in).z, z, 2 * plain.tolerance * depth);
      in.z = z;
      expect_equal(varying_held.step(in), one_held.step(in));
    }
  }
}

// Sections that rise evenly are, at each place, the rail moved there; pressure has the part along
// the track that takes what the rail gives as it is moved.
TEST(Turnout, OnARampIsTheRailMoved) {
  const scenes::profile_pair pair;
  std::vector<profiles::curve> curves(4, pair.rail);
  const double positions[] = {0.0, 1.0, 1.5, 3.0};
  std::vector<rp_profile> rails;
  for (size_t k = 0; k < 4; ++k) {
    for (double &z : curves[k].z) z -= 2e-3 * positions[k];
    for (double &y : curves[k].y) y += 1e-3 * positions[k];
    rails.push_back(curves[k].view());
  }
  rp_config plain = scenes::coarse(scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair));
  plain.side = RP_RIGHT;
  plain.cant = 0;
  plain.load = RP_POSITION;
  plain.rail_origin_y[RP_RIGHT] = 0.754;
  plain.rail_origin_z[RP_RIGHT] = 0;
  for (const auto blend : {RP_SECTIONS_LINEAR, RP_SECTIONS_CUBIC}) {
    rp_config c = plain;
    c.section_match = RP_SECTIONS_BY_KNOT;
    c.section_blend = blend;
    c.rail_sections[RP_RIGHT] = rails.data();
    c.section_position[RP_RIGHT] = positions;
    c.section_count[RP_RIGHT] = 4;
    scenes::handle varying(c), one(plain);
    rp_config smooth = plain;
    smooth.tangential = RP_TANGENTIAL_NONE;
    scenes::handle frictionless(smooth);
    for (const double x : {1.0, 1.2, 1.45}) {
      rp_input in = scenes::running(RP_RAIL);
      in.x = x;
      in.z = 2e-4 - 2e-3 * x;
      const rp_result found = varying.step(in);
      in.rail_offset[RP_RIGHT][1] = 1e-3 * x;
      in.rail_offset[RP_RIGHT][2] = -2e-3 * x;
      const rp_result expected = one.step(in);
      EXPECT_EQ(found.status, RP_CONVERGED);
      const rp_side_result &a = found.side[RP_RIGHT], &b = expected.side[RP_RIGHT];
      EXPECT_GT(-b.force[2], 1e3);
      for (int k = 1; k < 3; ++k) EXPECT_NEAR(a.force[k], b.force[k], 1e-9 * std::fabs(b.force[2]));
      const rp_side_result pressure = frictionless.step(in).side[RP_RIGHT];
      const double along = -1e-3 * pressure.force[1] + 2e-3 * pressure.force[2];
      // but for the grid's part, as in tests/property/test_power.py
      EXPECT_NEAR(a.force[0] - b.force[0], along, 1e-3 * std::fabs(along));
    }
  }
}

// A rail placed by its profile's origin where the gauge would have it is that rail.
TEST(Turnout, OriginSaysWhereTheRailLies) {
  const scenes::profile_pair pair;
  rp_config plain = scenes::coarse(scenes::wheels(RP_WHEELSET, RP_RAIL, pair));
  plain.load = RP_POSITION;
  rp_input in = scenes::running(RP_RAIL);
  in.z = 2e-4;
  scenes::handle by_gauge(plain);
  const rp_result expected = by_gauge.step(in);
  double y = 0, z = 0;
  const profile curve(view(pair.rail));
  placed_profile rail(curve, body::rail);
  rail.place(-plain.cant, 0, 0);
  y = 0.5 * plain.gauge - rail.innermost(plain.gauge_height).y;
  z = -rail.evaluate(rail.extreme()).z;
  rp_config c = plain;
  c.rail_origin_y[RP_RIGHT] = y;
  c.rail_origin_y[RP_LEFT] = -y;
  c.rail_origin_z[RP_RIGHT] = c.rail_origin_z[RP_LEFT] = z;
  expect_equal(scenes::handle(c).step(in), expected);
}

// A wheel of sections is, at each pitch, the round wheel of that profile.
TEST(Turnout, AWheelOfSectionsHasTheProfileThatIsLowest) {
  const scenes::profile_pair pair;
  std::vector<profiles::curve> curves(2, pair.wheel);
  for (double &z : curves[1].z) z += 1e-4;
  const std::vector<rp_profile> wheels{curves[0].view(), curves[1].view()};
  const double angles[] = {0.0, 3.0};
  rp_config plain = scenes::coarse(scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair));
  plain.side = RP_RIGHT;
  plain.load = RP_POSITION;
  plain.tolerance = 1e-11;
  rp_config c = plain;
  c.wheel_sections[RP_RIGHT] = wheels.data();
  c.wheel_section_angle[RP_RIGHT] = angles;
  c.wheel_section_count[RP_RIGHT] = 2;
  scenes::handle varying(c);
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    profiles::curve mixed = pair.wheel;
    for (size_t i = 0; i < mixed.z.size(); ++i)
      mixed.z[i] += share * (curves[1].z[i] - curves[0].z[i]);
    plain.wheel[RP_RIGHT] = mixed.view();
    rp_input in = scenes::running(RP_RAIL);
    in.z = 2e-4;
    const rp_result expected = scenes::handle(plain).step(in);
    // by the wheelset's pitch, and by the wheel's deviation
    in.pitch = 3.0 * share - 0.2 + 4 * std::numbers::pi;
    in.wheel_rotation[RP_RIGHT][1] = 0.2;
    const rp_result found = varying.step(in);
    EXPECT_EQ(found.status, RP_CONVERGED);
    const rp_side_result &a = found.side[RP_RIGHT], &b = expected.side[RP_RIGHT];
    EXPECT_NEAR(a.rolling_radius, b.rolling_radius, 1e-12);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.force[k], b.force[k], 1e-9 * std::fabs(b.force[2]));
  }
}

}  // namespace
