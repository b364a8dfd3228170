// Shapes along the rolling direction: splines by their own system of equations, the least gap and
// the overlap of a row by dense sampling.
#include "geometry/longitudinal_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace {

using namespace railpatch;
using std::numbers::pi;

// --- splines -----------------------------------------------------------------------------------

// Slopes of the C2 spline through values, by elimination; slope zero at the ends of one that is not
// periodic.
std::vector<double> slopes_of(const std::vector<double> &v, double h, bool periodic) {
  const size_t n = v.size();
  std::vector<std::vector<double>> m(n, std::vector<double>(n + 1, 0.0));
  for (size_t i = 0; i < n; ++i) {
    const size_t before = (i + n - 1) % n, after = (i + 1) % n;
    if (!periodic && (i == 0 || i + 1 == n)) {
      m[i][i] = 1;
      continue;
    }
    m[i][before] += 1;
    m[i][i] += 4;
    m[i][after] += 1;
    m[i][n] = 3 * (v[after] - v[before]) / h;
  }
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 0; k < n; ++k) {
      if (k == i || m[k][i] == 0) continue;
      const double factor = m[k][i] / m[i][i];
      for (size_t c = i; c <= n; ++c) m[k][c] -= factor * m[i][c];
    }
  std::vector<double> out(n);
  for (size_t i = 0; i < n; ++i) out[i] = m[i][n] / m[i][i];
  return out;
}

struct reference_spline {
  std::vector<double> values, slopes;
  double start, h;
  bool periodic;

  reference_spline(std::vector<double> given, double first, double spacing, bool round)
      : values(std::move(given)), start(first), h(spacing), periodic(round) {
    if (!periodic) {
      // constant beyond the ends
      constexpr size_t pad = 40;
      values.insert(values.begin(), pad, values.front());
      values.insert(values.end(), pad, values.back());
      start -= pad * h;
    }
    slopes = slopes_of(values, h, periodic);
  }
  double at(double x, double &slope) const {
    const auto n = static_cast<double>(values.size());
    double u = (x - start) / h;
    if (periodic) u -= n * std::floor(u / n);
    u = std::clamp(u, 0.0, periodic ? n : n - 1);
    const auto i = std::min(static_cast<size_t>(u), values.size() - (periodic ? 1 : 2));
    const size_t j = (i + 1) % values.size();
    const double t = u - static_cast<double>(i), rise = values[j] - values[i];
    slope = rise / h * 6 * t * (1 - t) + slopes[i] * (1 - t) * (1 - 3 * t) +
            slopes[j] * t * (3 * t - 2);
    return values[i] + rise * t * t * (3 - 2 * t) + h * slopes[i] * t * (1 - t) * (1 - t) -
           h * slopes[j] * t * t * (1 - t);
  }
  double at(double x) const {
    double slope;
    return at(x, slope);
  }
};

std::vector<double> noise(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(u(random));
  return values;
}

TEST(Splines, AreThoseOfTheirEquations) {
  for (const bool periodic : {true, false})
    for (const int count : {4, 7, 90}) {
      const std::vector<double> v = noise(5, count);
      const double h = 0.3, start = periodic ? 0 : -1.7;
      const even_spline found(v.data(), count, start, h, periodic);
      const reference_spline expected(v, start, h, periodic);
      EXPECT_TRUE(found.given());
      EXPECT_GE(found.bytes(), 2 * static_cast<size_t>(count) * sizeof(double));
      for (double x = start - 2.3 * h * count; x < start + 2.3 * h * count; x += 0.0411) {
        double a, b;
        EXPECT_NEAR(found.at(x, a), expected.at(x, b), 1e-12) << x;
        EXPECT_NEAR(a, b, 1e-11) << x;
        EXPECT_EQ(found.at(x), found.at(x, a));
      }
    }
  EXPECT_FALSE(even_spline().given());
}

// never below the values, and not above what the cubics of the stretch and their neighbours allow
TEST(Splines, BoundTheirValuesClosely) {
  for (const bool periodic : {true, false}) {
    const std::vector<double> v = noise(9, 24);
    const double h = 0.1, start = periodic ? 0 : 0.7;
    const even_spline s(v.data(), 24, start, h, periodic);
    const reference_spline r(v, start, h, periodic);
    const std::vector<double> other = noise(10, 400);
    for (size_t k = 0; k < 400; k += 2) {
      const double a = 3.5 * other[k], b = a + 1.2 * (1 + other[k + 1]);
      const double bound = s.greatest(a, b);
      double most = -HUGE_VAL, allowed = std::max(r.at(a), r.at(b));
      for (int i = 0; i <= 300; ++i) most = std::max(most, s.at(a + (b - a) * i / 300));
      for (int i = -2; i <= static_cast<int>((b - a) / h) + 3; ++i) {
        const double node = start + h * (std::floor((a - start) / h) + i);
        double slope;
        const double value = r.at(node, slope);
        allowed = std::max(allowed, value + std::fabs(slope) * h / 3);
      }
      EXPECT_GE(bound, most - 1e-14);
      EXPECT_LE(bound, allowed + 1e-12) << a << ' ' << b;
    }
  }
}

// --- shapes ------------------------------------------------------------------------------------

struct shape_scene {
  double start = -0.4, spacing = 2e-3, radius = 0.46;
  std::vector<double> runout, height;
  longitudinal_shape shape;

  shape_scene(const std::function<double(double)> &round, const std::function<double(double)> &up,
              int angles = 720, int places = 400)
      : runout(sampled(round, angles, 0, 2 * pi / angles)),
        height(sampled(up, places, start, spacing)),
        shape({runout.data(), static_cast<int>(runout.size()), height.data(),
               static_cast<int>(height.size()), start, spacing}) {}
  static std::vector<double> sampled(const std::function<double(double)> &f, int count, double from,
                                     double step) {
    std::vector<double> out;
    for (int i = 0; f && i < count; ++i) out.push_back(f(from + i * step));
    return out;
  }
};

double wave(double a) { return 2e-4 * std::sin(5 * a) + 1e-4 * std::cos(2 * a); }
double dip(double x) { return -3e-4 * std::exp(-x * x / 0.01); }

TEST(Shapes, TurnWithTheWheelAndMoveAlongTheTrack) {
  shape_scene s(wave, dip);
  for (const double pitch : {0.0, 1.3, -40.2})
    for (const double x : {0.0, -0.15, 0.2}) {
      s.shape.place(pitch, x, s.radius);
      EXPECT_TRUE(s.shape.has_runout());
      EXPECT_TRUE(s.shape.has_height());
      double most = -HUGE_VAL;
      for (double a = -0.5; a <= 0.5; a += 0.013) {
        double slope;
        // what lies ahead of a wheel rolling forward, its pitch falling, comes to the bottom
        EXPECT_NEAR(s.shape.runout(a, slope), wave(pitch - a), 1e-9);
        EXPECT_NEAR(slope, -1e-3 * std::cos(5 * (pitch - a)) + 2e-4 * std::sin(2 * (pitch - a)),
                    2e-7);
        EXPECT_EQ(s.shape.runout(a), s.shape.runout(a, slope));
        if (x + a * s.radius > s.start + 0.1) {
          EXPECT_NEAR(s.shape.height(a * s.radius), dip(x + a * s.radius), 1e-8);
        }
        for (double b = -0.5; b <= 0.5; b += 0.05)
          most = std::max(most, s.shape.runout(a) * std::cos(a) + s.shape.height(b * s.radius));
      }
      EXPECT_GE(s.shape.greatest(), most);
      // each part's own most and little more
      EXPECT_LE(s.shape.greatest(), 3e-4 + 1e-6);
    }
  shape_scene round(nullptr, dip), level(wave, nullptr),
      raised([](double) { return 3e-4; }, nullptr), lowered([](double) { return -3e-4; }, nullptr);
  round.shape.place(0.3, 0, 0.46);
  level.shape.place(0.3, 0, 0.46);
  EXPECT_FALSE(round.shape.has_runout());
  EXPECT_EQ(round.shape.runout(0.1), 0);
  EXPECT_FALSE(level.shape.has_height());
  EXPECT_EQ(level.shape.height(0.1), 0);
  raised.shape.place(0, 0, 0.46);
  EXPECT_NEAR(raised.shape.greatest(), 3e-4, 1e-15);
  // the radius points aside away from the lowest point: there a lower wheel is lowered less
  lowered.shape.place(0, 0, 0.46);
  EXPECT_NEAR(lowered.shape.greatest(), -3e-4 * std::cos(2 * longitudinal_shape::widest), 1e-15);
  EXPECT_FALSE((longitudinal_values{}).given());
  longitudinal_values one;
  one.height_count = 1;
  EXPECT_TRUE(one.given());
  one = {};
  one.runout_count = 1;
  EXPECT_TRUE(one.given());
  EXPECT_GE(level.shape.bytes(), sizeof level.shape + 2 * 720 * sizeof(double));
  EXPECT_GE(round.shape.bytes(), sizeof round.shape + 2 * 400 * sizeof(double));
}

TEST(Shapes, HeightsAreBoundedWithinReachOnly) {
  // a bump that comes near
  const auto bump = [](double x) { return 1e-3 * std::exp(-x * x / 1e-4); };
  shape_scene s(nullptr, bump);
  const double reach = 2 * longitudinal_shape::widest * s.radius;
  s.shape.place(0, -reach + 1e-3, s.radius);
  EXPECT_GE(s.shape.greatest(), 0.99e-3);
  s.shape.place(0, reach - 1e-3, s.radius);
  EXPECT_GE(s.shape.greatest(), 0.99e-3);
  for (const double away : {-1.0, 1.0}) {
    s.shape.place(0, away * (reach + 0.05), s.radius);
    EXPECT_LT(s.shape.greatest(), 2e-5);
  }
}

// --- rows --------------------------------------------------------------------------------------

struct row_scene : shape_scene {
  using shape_scene::shape_scene;

  longitudinal_row row(double angle, double gap, double yaw = 0.01, double bend = 0) const {
    return {&shape, angle, radius - 0.001, gap, 0.02 * angle, (radius - 0.001) * std::cos(yaw),
            bend};
  }
};

// by the header's formula
double gap_of(const longitudinal_row &r, double a) {
  const double x = r.x0 + r.advance * (std::sin(a) - std::sin(r.angle));
  return r.gap + r.radius * (1 - std::cos(a - r.angle)) + r.bend * (x - r.x0) * (x - r.x0) -
         r.shape->runout(a) * std::cos(a) - r.shape->height(x);
}

const std::vector<std::pair<const char *, std::function<double(double)>>> &wheels() {
  static const std::vector<std::pair<const char *, std::function<double(double)>>> all{
      {"round", [](double) { return 0.0; }},
      {"larger", [](double) { return 2e-4; }},
      {"smaller", [](double) { return -2e-4; }},
      {"wavy", [](double a) { return 1e-4 * std::sin(20 * a); }},
      {"short waves", [](double a) { return 2e-5 * std::sin(90 * a); }},
      // a chord of 60 mm
      {"flat", [](double a) {
         const double t = std::remainder(a, 2 * pi);
         return std::fabs(t) < 0.065 ? 0.46 * (std::cos(0.065) / std::cos(t) - 1) : 0.0;
       }}};
  return all;
}

TEST(Rows, LeastGapIsThatOfDenseSampling) {
  for (const auto &[name, runout] : wheels())
    for (const double bend : {0.0, 0.5})
      for (const double angle : {0.0, 0.004, -0.01})
        for (const double pitch : {0.0, 0.03, -0.07, 1.0}) {
          SCOPED_TRACE(testing::Message() << name << ' ' << bend << ' ' << angle << ' ' << pitch);
          row_scene s(runout, dip, 2400);
          s.shape.place(pitch, 0.03, s.radius);
          const longitudinal_row r = s.row(angle, 1e-4, 0.02, bend);
          double least = HUGE_VAL, where = 0;
          for (int i = -8000; i <= 8000; ++i) {
            const double a = angle + longitudinal_shape::widest * i / 8000;
            if (i % 100 == 0) {
              EXPECT_NEAR(r.at(a), gap_of(r, a), 1e-16);
            }
            if (const double g = r.at(a); g < least) least = g, where = a;
          }
          double a = 0;
          const double found = r.least(a);
          // what a parabola between places 1 mm apart leaves
          EXPECT_NEAR(found, least, 2e-8);
          EXPECT_NEAR(r.at(a), found, 1e-8);
          if (std::fabs(a - where) > 2e-3) {
            // two places as deep as each other
            EXPECT_NEAR(r.at(a), r.at(where), 1e-8) << a << ' ' << where;
          }
        }
}

struct sums {
  double weight = 0, x = 0, x_min = HUGE_VAL, x_max = -HUGE_VAL;
};

sums summed(const longitudinal_row &r) {
  constexpr int count = 20000;
  constexpr double step = longitudinal_shape::widest / count;
  sums out;
  for (int i = -count; i < count; ++i) {
    const double a = r.angle + (i + 0.5) * step, depth = -r.at(a);
    if (!(depth > 0)) continue;
    const double share = 15.0 / 16 * depth * depth * r.radius * step, x = r.x(a);
    out.weight += share;
    out.x += share * x;
    const double margin = 0.03 * r.radius * std::fabs(a - r.angle);
    out.x_min = std::min(out.x_min, x - margin);
    out.x_max = std::max(out.x_max, x + margin);
  }
  out.x /= out.weight;
  return out;
}

TEST(Rows, OverlapIsTheIntegralOfItsSquare) {
  for (const auto &[name, runout] : wheels())
    for (const double pitch : {0.0, 0.03, -0.05}) {
      SCOPED_TRACE(testing::Message() << name << ' ' << pitch);
      row_scene s(runout, dip, 2400);
      s.shape.place(pitch, 0.03, s.radius);
      longitudinal_row r = s.row(0.003, 0, 0.02, 0.2);
      double a;
      r.gap = -r.least(a) - 6e-5;
      const row_overlap found = r.overlap();
      const sums expected = summed(r);
      EXPECT_NEAR(found.weight / expected.weight, 1, 2e-3);
      EXPECT_NEAR(found.x, expected.x, 1e-3 * (expected.x_max - expected.x_min));
      EXPECT_NEAR(found.x_min, expected.x_min, 2e-5);
      EXPECT_NEAR(found.x_max, expected.x_max, 2e-5);
      // nothing where it does not touch
      r.gap += 7e-5;
      EXPECT_EQ(r.overlap().weight, 0);
      EXPECT_EQ(r.overlap().x, 0);
    }
}

// A wheel larger all round by c, seen from the round one's closest point: its own lies where
// r sin(a - a0) + c sin a = 0.
TEST(Rows, LeastGapOfALargerWheelHasItsClosedForm) {
  for (const double c : {1e-3, -1e-3, 4e-4}) {
    row_scene s([&](double) { return c; }, nullptr);
    s.shape.place(0.3, 0, s.radius);
    for (const double angle : {0.2, 0.11, -0.17}) {
      const longitudinal_row r = s.row(angle, -1e-3);
      const double where = std::atan2(r.radius * std::sin(angle), r.radius * std::cos(angle) + c);
      double a = 0;
      const double found = r.least(a);
      // a parabola through places 2e-3 rad apart, aside by up to 4e-4, leaves a sixth of their cube
      EXPECT_NEAR(a, where, 1e-9) << c << ' ' << angle;
      EXPECT_NEAR(found, gap_of(r, where), 1e-15);
    }
  }
}

// Both edges of what a round wheel overlaps, r (1 - cos(a - a0)) deep; as well where the rail rises
// further on, so that more than the overlap is looked at. Edges are searched to 1e-9 rad.
TEST(Rows, EdgesOfARoundWheelHaveTheirClosedForm) {
  for (const double rise : {0.0, 1e-3}) {
    row_scene s(nullptr, [&](double x) { return x > 0.09 && x < 0.11 ? rise : 0.0; });
    s.shape.place(0, 0, s.radius);
    for (double depth = 1e-6; depth < 2e-4; depth *= 1.07)
      for (const double angle : {0.0, 0.012, -0.03}) {
        const longitudinal_row r = s.row(angle, -depth, 0.01);
        const row_overlap o = r.overlap();
        const double half = 2 * std::asin(std::sqrt(0.5 * depth / r.radius));
        const double margin = 0.03 * r.radius * half;
        EXPECT_NEAR(o.x_max, r.x(angle + half) + margin, 5e-10) << rise << ' ' << depth;
        EXPECT_NEAR(o.x_min, r.x(angle - half) - margin, 5e-10) << rise << ' ' << depth;
      }
  }
}

// Dips too sharp for a parabola are searched for themselves.
TEST(Rows, LeastGapOfSharpDips) {
  row_scene s([](double a) { return 2e-5 * std::sin(400 * a); }, nullptr, 2400);
  for (double pitch = 0; pitch < 0.016; pitch += 7e-4) {
    s.shape.place(pitch, 0, s.radius);
    const longitudinal_row r = s.row(0.002, 1e-4);
    double least = HUGE_VAL;
    for (double a = -0.05; a < 0.05; a += 1e-5) least = std::min(least, r.at(a));
    double a = 0;
    const double found = r.least(a);
    EXPECT_EQ(found, r.at(a));
    // a parabola that foresees its own least value to 10 nm is taken
    EXPECT_NEAR(found, least, 1e-8) << pitch;
  }
}

// Hertz's row: the overlap d - x^2/(2 R) has (15/16) times (16/15) d^2.5 sqrt(2 R).
TEST(Rows, OfARoundWheelHaveTheirClosedForm) {
  row_scene s([](double) { return 0.0; }, [](double) { return 0.0; });
  s.shape.place(0, 0, s.radius);
  for (const double depth : {1e-6, 1e-5, 1e-4}) {
    const longitudinal_row r = s.row(0.0, -depth, 0.0);
    const row_overlap o = r.overlap();
    const double half = r.radius * std::acos(1 - depth / r.radius);
    EXPECT_NEAR(o.weight / (std::pow(depth, 2.5) * std::sqrt(2 * r.radius)), 1, 1e-3);
    EXPECT_NEAR(o.x, 0, 1e-12);
    EXPECT_NEAR(o.x_max, 1.03 * half, 1e-4 * half);
    EXPECT_NEAR(o.x_min, -1.03 * half, 1e-4 * half);
  }
}

}  // namespace
