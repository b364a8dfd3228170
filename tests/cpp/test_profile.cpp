// Profiles: the cubic Hermite curve by its basis functions, the search for arc lengths, what is
// refused, and the running branch of a placed profile by dense sampling.
#include "geometry/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "geometry/profile_sections.hpp"
#include "profiles.hpp"

namespace {

using namespace railpatch;

profile_view view(const profiles::curve &c) {
  return {c.s.data(),  c.y.data(),  c.z.data(),
          c.dy.data(), c.dz.data(), static_cast<int>(c.s.size())};
}

// knots anywhere, some close together, values and slopes at random: no profile, but a curve
profiles::curve wild(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  profiles::curve c;
  double s = 0.3;
  for (int i = 0; i < count; ++i) {
    c.s.push_back(s);
    s += i % 5 == 2 ? 1e-5 : 1e-3 * (1.1 + u(random));
    for (auto *v : {&c.y, &c.z, &c.dy, &c.dz}) v->push_back(u(random));
  }
  return c;
}

profiles::curve straight(double length, int count = 5) {
  profiles::curve c;
  for (int i = 0; i < count; ++i) {
    c.s.push_back(length * i / (count - 1));
    c.y.push_back(length * i / (count - 1));
    c.z.push_back(0);
    c.dy.push_back(1);
    c.dz.push_back(0);
  }
  return c;
}

// value, slope and bend of a cubic between knots, by Hermite's basis functions
std::array<double, 3> hermite(double h, double t, double f0, double f1, double d0, double d1) {
  const double u = t / h;
  return {f0 * (1 + 2 * u) * (1 - u) * (1 - u) + d0 * h * u * (1 - u) * (1 - u) +
              f1 * u * u * (3 - 2 * u) - d1 * h * u * u * (1 - u),
          (f1 - f0) / h * 6 * u * (1 - u) + d0 * (1 - u) * (1 - 3 * u) + d1 * u * (3 * u - 2),
          ((f1 - f0) * (6 - 12 * u) / h + d0 * (6 * u - 4) + d1 * (6 * u - 2)) / h};
}

int interval_of(const profiles::curve &c, double s) {
  int k = 0;
  while (k + 2 < static_cast<int>(c.s.size()) && c.s[static_cast<size_t>(k) + 1] <= s) ++k;
  return k;
}

TEST(Profile, IsTheHermiteCurveOfItsKnots) {
  for (int count : {4, 5, 40}) {
    const profiles::curve c = wild(7, count);
    const profile p(view(c));
    EXPECT_EQ(p.begin(), c.s.front());
    EXPECT_EQ(p.end(), c.s.back());
    std::vector<double> places = c.s;
    for (int i = -40; i <= 440; ++i)
      places.push_back(p.begin() + (p.end() - p.begin()) * i / 400.0);
    for (double s : c.s) {
      places.push_back(std::nextafter(s, 0.0));
      places.push_back(std::nextafter(s, 1.0));
    }
    for (const double s : places) {
      EXPECT_EQ(p.covers(s), !(s < c.s.front() || s > c.s.back()));
      const int k = interval_of(c, s);
      ASSERT_EQ(p.interval(s), k) << s;
      for (int last = 0; last + 1 < count; ++last) ASSERT_EQ(p.interval(s, last), k) << last;
      const auto i = static_cast<size_t>(k);
      const double h = c.s[i + 1] - c.s[i], t = s - c.s[i];
      const auto y = hermite(h, t, c.y[i], c.y[i + 1], c.dy[i], c.dy[i + 1]);
      const auto z = hermite(h, t, c.z[i], c.z[i + 1], c.dz[i], c.dz[i + 1]);
      const curve_point q = p.evaluate(s);
      const double size = 1 + std::fabs(c.y[i + 1] - c.y[i]) + std::fabs(c.z[i + 1] - c.z[i]);
      const double far = 1 + std::pow(std::fabs(t / h), 3);
      EXPECT_NEAR(q.y, y[0], 1e-12 * size * far);
      EXPECT_NEAR(q.z, z[0], 1e-12 * size * far);
      EXPECT_NEAR(q.dy, y[1], 1e-11 * size * far / h);
      EXPECT_NEAR(q.dz, z[1], 1e-11 * size * far / h);
      EXPECT_NEAR(q.d2y, y[2], 1e-10 * size * far / (h * h));
      EXPECT_NEAR(q.d2z, z[2], 1e-10 * size * far / (h * h));
    }
    EXPECT_GE(p.bytes(), static_cast<size_t>(count - 1) * 9 * sizeof(double));
    EXPECT_LE(p.bytes(), static_cast<size_t>(count) * 11 * sizeof(double));
  }
}

// of up to two metres, with knots that are anything but even
TEST(Profile, IntervalsOfAnyLength) {
  for (const double length : {1e-3, 0.1, 0.99, 1.01, 1.4, 2.0}) {
    profiles::curve c = straight(length, 30);
    for (size_t i = 1; i + 1 < 30; ++i) {
      const double share = static_cast<double>(i) / 29;
      c.s[i] = c.y[i] = length * share * share;
    }
    ASSERT_EQ(validate(view(c)), profile_fault::none);
    const profile p(view(c));
    for (int i = -20; i <= 1020; ++i) {
      const double s = length * i / 1000.0;
      ASSERT_EQ(p.interval(s), interval_of(c, s)) << length << ' ' << i;
    }
    for (const double s : c.s) ASSERT_EQ(p.interval(s), interval_of(c, s)) << length << ' ' << s;
  }
}

TEST(Profile, TakesOverAnotherCurve) {
  const profiles::curve first = wild(3, 20), second = wild(4, 12);
  profile p(view(first));
  p.assign(view(second));
  const profile fresh(view(second));
  EXPECT_EQ(p.begin(), fresh.begin());
  EXPECT_EQ(p.end(), fresh.end());
  for (double s = p.begin() - 1e-3; s < p.end() + 1e-3; s += 1e-4) {
    EXPECT_EQ(p.evaluate(s).y, fresh.evaluate(s).y);
    EXPECT_EQ(p.evaluate(s).d2z, fresh.evaluate(s).d2z);
  }
}

TEST(Profile, InclinationAndCurvatureOfACircle) {
  for (double curvature_of_circle : {20.0, -3.0}) {
    profiles::pen pen(-0.3);
    pen.arc(0.02, curvature_of_circle);
    const profiles::curve c = pen.moved_to_origin(0);
    const profile p(view(c));
    for (double s = 0; s <= 0.02; s += 7e-4) {
      EXPECT_NEAR(inclination(p.evaluate(s)), -0.3 + curvature_of_circle * s, 1e-6);
      EXPECT_NEAR(curvature(p.evaluate(s)), curvature_of_circle,
                  1e-3 * std::fabs(curvature_of_circle));
    }
  }
  // a curve run through at another speed bends the same
  curve_point p{0, 0, 0.6, 0.8, 3, -2};
  const double same = curvature(p);
  EXPECT_NEAR(same, (0.6 * -2 - 0.8 * 3) / 1.0, 1e-14);
  p = {0, 0, 1.2, 1.6, 12, -8};
  EXPECT_NEAR(curvature(p), same, 1e-14);
}

// --- what is refused ---------------------------------------------------------------------------

TEST(Profile, FaultsAreTold) {
  const auto fault = [](const profiles::curve &c) { return validate(view(c)); };
  EXPECT_EQ(fault(straight(0.1, 4)), profile_fault::none);
  EXPECT_EQ(fault(straight(0.1, 3)), profile_fault::too_few_points);
  const profiles::curve good = straight(0.1);
  for (int field = 0; field < 5; ++field) {
    profile_view v = view(good);
    const double **arrays[] = {&v.s, &v.y, &v.z, &v.dy, &v.dz};
    *arrays[field] = nullptr;
    EXPECT_EQ(validate(v), profile_fault::too_few_points);
    for (size_t at = 0; at < 5; ++at)
      for (double bad : {std::nan(""), HUGE_VAL}) {
        profiles::curve c = good;
        std::vector<double> *const values[] = {&c.s, &c.y, &c.z, &c.dy, &c.dz};
        (*values[field])[at] = bad;
        EXPECT_EQ(fault(c), profile_fault::not_finite) << field << ' ' << at;
      }
  }
  profiles::curve c = good;
  c.s[1] = c.s[0];
  EXPECT_EQ(fault(c), profile_fault::not_increasing);
  c = good;
  c.s[4] = c.s[3];
  EXPECT_EQ(fault(c), profile_fault::not_increasing);

  EXPECT_EQ(fault(straight(1.9999)), profile_fault::none);
  EXPECT_EQ(fault(straight(2.0)), profile_fault::none);
  EXPECT_EQ(fault(straight(2.0001)), profile_fault::too_long);

  // chords over arcs
  const auto stretched = [&](double ratio) {
    profiles::curve d = good;
    for (double &s : d.s) s = 5 + s / ratio;
    return fault(d);
  };
  EXPECT_EQ(stretched(0.801), profile_fault::none);
  EXPECT_EQ(stretched(0.799), profile_fault::not_arc_length);
  EXPECT_EQ(stretched(1.049), profile_fault::none);
  EXPECT_EQ(stretched(1.051), profile_fault::not_arc_length);
  // neither bound counts
  for (const double bound : {0.8, 1.05}) {
    profiles::curve d = straight(1, 4);
    for (size_t i = 0; i < 4; ++i) d.y[i] = std::array{0.0, 0.25, 0.5, bound}[i];
    EXPECT_EQ(fault(d), profile_fault::not_arc_length) << bound;
  }
  // slopes by something else, in either component, at either end
  for (size_t at : {0, 2, 4})
    for (const double angle : {0.0, 0.7, 2.0}) {
      const auto with = [&](double speed) {
        profiles::curve d = good;
        d.dy[at] = speed * std::cos(angle);
        d.dz[at] = speed * std::sin(angle);
        return fault(d);
      };
      EXPECT_EQ(with(0.501), profile_fault::none);
      EXPECT_EQ(with(0.499), profile_fault::not_arc_length);
      EXPECT_EQ(with(1.999), profile_fault::none);
      EXPECT_EQ(with(2.001), profile_fault::not_arc_length);
    }
  c = good;
  for (double &y : c.y) y = -y;
  EXPECT_EQ(fault(c), profile_fault::wrong_direction);
  // straight up is not towards the field side
  c = good;
  std::swap(c.y, c.z);
  EXPECT_EQ(fault(c), profile_fault::wrong_direction);
}

TEST(Profile, LengthsAreThoseOfTheChords) {
  // zigzag: the distance of its ends says nothing
  profiles::curve c = straight(0.1);
  for (size_t i = 0; i < 5; ++i) {
    c.z[i] = i % 2 ? 0.1 : 0.0;
    c.s[i] = std::hypot(0.025, 0.1) * static_cast<double>(i);
  }
  EXPECT_EQ(validate(view(c)), profile_fault::none);
  for (double &s : c.s) s *= 0.25;
  EXPECT_EQ(validate(view(c)), profile_fault::not_arc_length);
}

TEST(Profile, EveryFaultHasItsText) {
  const std::pair<profile_fault, const char *> words[] = {
      {profile_fault::none, "usable"},
      {profile_fault::too_few_points, "at least 4 points"},
      {profile_fault::not_finite, "not finite"},
      {profile_fault::not_increasing, "must grow"},
      {profile_fault::not_arc_length, "is not the arc length"},
      {profile_fault::too_long, "longer than 2 m"},
      {profile_fault::wrong_direction, "field side (+y)"}};
  for (const auto &[fault, word] : words)
    EXPECT_NE(std::string(text(fault)).find(word), std::string::npos) << text(fault);
}

// --- placed ------------------------------------------------------------------------------------

struct spot {
  double y, z, dy;
};

class PlacedProfile : public testing::TestWithParam<body> {
 protected:
  PlacedProfile() : placed(curve, GetParam()) {}
  static profiles::curve drawn() {
    return GetParam() == body::rail ? profiles::rail() : profiles::wheel();
  }
  double sign() const { return GetParam() == body::rail ? 1 : -1; }
  // by hand
  spot at(double s) const {
    const curve_point p = curve.evaluate(s);
    const double c = std::cos(angle), t = std::sin(angle);
    return {y + c * p.y - t * p.z, z + t * p.y + c * p.z, c * p.dy - t * p.dz};
  }
  void place(double a, double to_y, double to_z) {
    angle = a, y = to_y, z = to_z;
    placed.place(a, to_y, to_z);
  }

  profiles::curve points = drawn();
  profile curve{view(points)};
  placed_profile placed;
  double angle = 0, y = 0, z = 0;
  static constexpr int dense = 20000;
  double dense_s(int i) const { return curve.begin() + (curve.end() - curve.begin()) * i / dense; }
};

TEST_P(PlacedProfile, IsTurnedAndThenMoved) {
  place(0.07, 0.75, -0.01);
  const double c = std::cos(angle), t = std::sin(angle);
  for (double s = curve.begin(); s <= curve.end(); s += 1.1e-3) {
    const curve_point p = curve.evaluate(s), q = placed.evaluate(s);
    EXPECT_NEAR(q.y, y + c * p.y - t * p.z, 1e-15);
    EXPECT_NEAR(q.z, z + t * p.y + c * p.z, 1e-15);
    EXPECT_NEAR(q.dy, c * p.dy - t * p.dz, 1e-15);
    EXPECT_NEAR(q.dz, t * p.dy + c * p.dz, 1e-15);
    EXPECT_NEAR(q.d2y, c * p.d2y - t * p.d2z, 1e-12);
    EXPECT_NEAR(q.d2z, t * p.d2y + c * p.d2z, 1e-12);
  }
}

TEST_P(PlacedProfile, EachMoveByItselfCounts) {
  const double moves[][3] = {{0, 0, 0},        {0.01, 0, 0},     {0.01, 0.2, 0},  {0.01, 0.2, 0.3},
                             {0.01, 0.1, 0.3}, {0.02, 0.1, 0.3}, {0.02, 0.1, 0.3}};
  for (const auto &m : moves) {
    place(m[0], m[1], m[2]);
    const spot p = at(placed.sample_s(placed.last()));
    EXPECT_NEAR(placed.sample(placed.last()).y, p.y, 1e-15);
    EXPECT_NEAR(placed.sample(placed.last()).z, p.z, 1e-15);
  }
}

TEST_P(PlacedProfile, SamplesFollowItsRunningBranch) {
  const double length = curve.end() - curve.begin();
  EXPECT_LE(placed.step(), 2e-4);
  EXPECT_GT(placed.step(), 0.99 * 2e-4);
  const double count = length / placed.step();
  EXPECT_NEAR(count, std::round(count), 1e-9);
  for (const double a : {0.0, 0.03, -0.05, 0.4}) {
    for (const double to : {0.75, -0.2}) {
      place(a, to, 0.3 * to);
      int top = 0;
      const int last = static_cast<int>(std::round(count));
      for (int i = 0; i <= last; ++i)
        if (sign() * at(placed.sample_s(i)).z < sign() * at(placed.sample_s(top)).z) top = i;
      EXPECT_LE(placed.first(), top);
      EXPECT_GE(placed.last(), top);
      for (int i = placed.first(); i <= placed.last(); ++i) {
        const spot p = at(placed.sample_s(i));
        EXPECT_NEAR(placed.sample(i).y, p.y, 1e-15);
        EXPECT_NEAR(placed.sample(i).z, p.z, 1e-15);
        EXPECT_TRUE(i == top || p.dy > 0.02);
        if (i > placed.first()) {
          EXPECT_GT(p.y, placed.sample(i - 1).y);
        }
      }
      // as far as the curve goes, or its slope
      if (placed.first() > 0) {
        EXPECT_LE(at(placed.sample_s(placed.first() - 1)).dy, 0.02);
      }
      if (placed.last() < last) {
        EXPECT_LE(at(placed.sample_s(placed.last() + 1)).dy, 0.02);
      }
    }
  }
}

TEST_P(PlacedProfile, FindsArcLengthsByLateralPosition) {
  place(-0.04, 0.75, 0.01);
  const double low = placed.sample(placed.first()).y, high = placed.sample(placed.last()).y;
  double s = 0;
  EXPECT_FALSE(placed.find(low - 1e-9, s));
  EXPECT_FALSE(placed.find(high + 1e-9, s));
  EXPECT_FALSE(placed.find(NAN, s));
  for (int i = 0; i <= 1000; ++i) {
    const double wanted = i == 1000 ? high : low + (high - low) * i / 1000;
    ASSERT_TRUE(placed.find(wanted, s));
    EXPECT_NEAR(at(s).y, wanted, 2e-13);
    EXPECT_GE(s, placed.sample_s(placed.first()) - 1e-12);
    EXPECT_LE(s, placed.sample_s(placed.last()) + 1e-12);
  }
}

TEST_P(PlacedProfile, ExtremeIsThatOfADenseSampling) {
  for (const double a : {0.0, 0.06, -0.05, 0.3}) {
    place(a, 0.7, -0.02);
    double best = HUGE_VAL, where = 0;
    for (int i = 0; i <= dense; ++i)
      if (const double v = sign() * at(dense_s(i)).z; v < best) best = v, where = dense_s(i);
    const double s = placed.extreme();
    // within the branch that counts: the wheel's flange is its lowest point
    EXPECT_NEAR(s, where, 2e-5) << a;
    EXPECT_LE(sign() * at(s).z, best + 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, PlacedProfile, testing::Values(body::wheel, body::rail),
                         [](const auto &info) {
                           return std::string(info.param == body::rail ? "rail" : "wheel");
                         });

// ends that are the extreme themselves
TEST(PlacedProfileEnds, AnExtremeAtAnEndStays) {
  const profiles::curve points = straight(0.1);
  const profile curve(view(points));
  for (const body kind : {body::rail, body::wheel})
    for (const double slope : {0.1, -0.1}) {
      placed_profile p(curve, kind);
      p.place(slope, 0, 0);
      const bool at_begin = (kind == body::rail) == (slope > 0);
      EXPECT_EQ(p.extreme(), at_begin ? curve.begin() : curve.end());
    }
}

TEST(PlacedProfileEnds, NumberOfSamplesIsLimited) {
  const profiles::curve few = straight(1e-3), many = straight(1.9);
  const profile a(view(few)), b(view(many));
  EXPECT_NEAR(placed_profile(a, body::rail).step(), 1e-3 / 16, 1e-15);
  EXPECT_NEAR(placed_profile(b, body::rail).step(), 1.9 / 4096, 1e-15);
  const profiles::curve exact = straight(4e-3);
  const profile c(view(exact));
  EXPECT_EQ(placed_profile(c, body::rail).last(), 20);
}

TEST(PlacedProfileEnds, ANewCurveIsSampledAnew) {
  const profiles::curve first = profiles::rail(), second = straight(0.07);
  profile curve(view(first));
  placed_profile p(curve, body::rail);
  p.place(0.02, 0.1, 0.2);
  curve.assign(view(second));
  p.reload();
  p.place(0.02, 0.1, 0.2);
  EXPECT_EQ(p.first(), 0);
  for (int i = 0; i <= p.last(); ++i) EXPECT_EQ(p.sample(i).y, p.evaluate(p.sample_s(i)).y);
  EXPECT_NEAR(p.sample(p.last()).y, 0.1 + 0.07 * std::cos(0.02), 1e-15);
}

// The gauge face by dense sampling from the top down, of heads with straight and undercut faces.
TEST(GaugeFace, IsTheLeastLateralPositionDownToItsHeight) {
  for (const double face : {70.0, 85.0, 100.0, 120.0}) {
    profiles::pen pen(-face * M_PI / 180);
    pen.line(0.02);
    pen.turn_to(-0.05, 0.013);
    pen.turn_to(0.05, 0.3);
    pen.turn_to(1.3, 0.013);
    const profiles::curve points = pen.moved_to_origin(0.02);
    const profile curve(view(points));
    placed_profile p(curve, body::rail);
    for (const double lean : {-0.025, 0.1}) {
      p.place(lean, 0.01, -0.02);
      const double top = p.evaluate(p.extreme()).z;
      for (const double height : {1e-4, 3e-3, 0.009, 0.014, 0.03, 0.2}) {
        constexpr double step = 2e-6;
        double least = HUGE_VAL;
        for (double s = p.extreme(); s >= curve.begin(); s -= step) {
          const curve_point at = p.evaluate(s);
          if (at.z > top + height) break;
          least = std::min(least, at.y);
        }
        EXPECT_NEAR(p.innermost(height).y, least, step) << face << ' ' << lean << ' ' << height;
      }
    }
  }
}

// --- sections along the track ------------------------------------------------------------------

TEST(RailSections, BlendLinearlyBetweenTheirPositions) {
  const profiles::curve all[3] = {wild(1, 9), wild(2, 9), wild(3, 9)};
  // the same shares of other lengths
  std::vector<profiles::curve> given(all, all + 3);
  const double lengths[3] = {0.07, 0.075, 0.06};
  for (size_t k = 0; k < 3; ++k)
    for (size_t i = 0; i < 9; ++i)
      given[k].s[i] = 0.1 * static_cast<double>(k) +
                      lengths[k] * (all[0].s[i] - all[0].s[0]) / (all[0].s[8] - all[0].s[0]);
  const profile_view views[3] = {view(given[0]), view(given[1]), view(given[2])};
  const double positions[3] = {-1.0, 2.0, 2.5};
  profile_sections sections(views, positions, 3);
  double last = HUGE_VAL;
  int first_before = 0, second_before = 0;
  double share_before = 0;
  for (const double x : {-3.0, -1.5, -1.0, -0.25, -0.25, 1.999, 2.0, 2.1, 2.5, 2.6, 7.0, 0.5}) {
    size_t a = 0, b = 0;
    double w = 0;
    if (x >= -1.0 && x < 2.0)
      a = 0, b = 1, w = (x + 1.0) / 3.0;
    else if (x >= 2.0 && x < 2.5)
      a = 1, b = 2, w = (x - 2.0) / 0.5;
    else if (x >= 2.5)
      a = b = 2;
    bool changed = false;
    const profile_view v = sections.at(x, changed);
    const bool moved = static_cast<int>(a) != first_before || static_cast<int>(b) != second_before;
    EXPECT_EQ(changed, moved || w != share_before) << x << last;
    first_before = static_cast<int>(a);
    second_before = static_cast<int>(b);
    share_before = w;
    ASSERT_EQ(v.n, 9);
    const double length = (1 - w) * lengths[a] + w * lengths[b];
    for (size_t i = 0; i < 9; ++i) {
      const auto mix = [&](double from, double to) { return (1 - w) * from + w * to; };
      EXPECT_NEAR(v.s[i], mix(given[a].s[i], given[b].s[i]), 1e-15);
      EXPECT_NEAR(v.y[i], mix(given[a].y[i], given[b].y[i]), 1e-15);
      EXPECT_NEAR(v.z[i], mix(given[a].z[i], given[b].z[i]), 1e-15);
      // derivatives by the share of the length, over the length
      EXPECT_NEAR(v.dy[i], mix(given[a].dy[i] * lengths[a], given[b].dy[i] * lengths[b]) / length,
                  1e-14);
      EXPECT_NEAR(v.dz[i], mix(given[a].dz[i] * lengths[a], given[b].dz[i] * lengths[b]) / length,
                  1e-14);
    }
    last = x;
  }
  EXPECT_GE(sections.bytes(), 4 * 5 * 9 * sizeof(double));
}

TEST(RailSections, KnotsBelongTogetherAtEqualShares) {
  const profiles::curve a = wild(1, 9);
  profiles::curve b = wild(2, 9);
  for (size_t i = 0; i < 9; ++i) b.s[i] = 2 + 3 * a.s[i];
  EXPECT_TRUE(profile_sections::belong_together(view(a), view(b)));
  const double length = b.s[8] - b.s[0];
  for (size_t i = 1; i < 8; ++i)
    for (const double sign : {-1.0, 1.0}) {
      profiles::curve c = b;
      c.s[i] += sign * 0.8e-9 * length;
      EXPECT_TRUE(profile_sections::belong_together(view(a), view(c)));
      c = b;
      c.s[i] += sign * 1.2e-9 * length;
      EXPECT_FALSE(profile_sections::belong_together(view(a), view(c))) << i;
    }
  profile_view shorter = view(b);
  shorter.n = 8;
  EXPECT_FALSE(profile_sections::belong_together(view(a), shorter));
}

}  // namespace
