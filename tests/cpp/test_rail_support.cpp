// Rails on springs and dampers: the step's equations, solved by hand for contacts whose forces are
// known in closed form.
#include "wheel/rail_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace {

using namespace railpatch;

// Two contacts with Hertzian springs, and lateral forces by the rail's lateral place and rate.
struct springs final : supported_wheels {
  int count = 2;
  double stiffness[2] = {1.1e11, 0.8e11};  // N/m^1.5
  double touch[2] = {0, 1e-5};             // m
  double lateral[2] = {-2e6, -1e6};        // N/m, falls with the rail's way
  double push[2] = {4e3, -6e3};            // N
  double drag = 0;                         // N s/m
  // of contacts that are inclined: each way by the other
  double slope[2] = {0, 0};
  double speed = 0;  // m/s
  // N, m: of a lateral force that rises and falls with the rail's place
  double wave = 0, wave_length = 1;
  bool nowhere = false;
  // whether the contacts are known at a place of the first rail and z
  std::function<bool(const lateral_vertical &, double)> known;
  int evaluations = 0;
  std::array<lateral_vertical, 2> at{}, rates{};
  double z_now = 0;

  void move_rails(const lateral_vertical *deflection, const lateral_vertical *rate) override {
    for (size_t w = 0; w < static_cast<size_t>(count); ++w)
      at[w] = deflection[w], rates[w] = rate[w];
  }
  bool first_touch(int wheel, double &z) override {
    if (nowhere) return false;
    // rails on their way down are touched later
    const lateral_vertical &u = at[static_cast<size_t>(wheel)];
    z = touch[wheel] + u[1] + slope[wheel] * u[0];
    return true;
  }
  lateral_vertical force(size_t w, double z) const {
    const double depth = z - touch[w] - at[w][1] - slope[w] * at[w][0];
    if (!(depth > 0) || nowhere) return {0, 0};
    const double pressed = stiffness[w] * depth * std::sqrt(depth);
    return {push[w] + lateral[w] * at[w][0] - drag * rates[w][0] + slope[w] * pressed +
                wave * std::sin(at[w][0] / wave_length),
            pressed};
  }
  bool evaluate(double z, wheel_on_rail *out) override {
    ++evaluations;
    z_now = z;
    for (size_t w = 0; w < static_cast<size_t>(count); ++w) out[w] = {force(w, z), speed};
    return !known || known(at[0], z);
  }
};

support_setup setup_of(int count) {
  support_setup s;
  s.wheels = count;
  s.stiffness = {2e7, 5e7};
  s.damping = {2e4, 5e4};
  s.tolerance = 1e-9;
  s.modulus = 1.1e11;
  s.radius = 0.23;
  return s;
}

// The equations of a step, as they are told in the header.
void expect_solved(const support_setup &setup, const rail_support &support, const springs &wheels,
                   const support_load &load, const support_result &found,
                   const std::array<lateral_vertical, 2> &before) {
  ASSERT_TRUE(found.converged);
  EXPECT_FALSE(found.beyond);
  EXPECT_LE(found.residual, setup.tolerance);
  double carried = 0;
  for (size_t w = 0; w < static_cast<size_t>(setup.wheels); ++w) {
    const lateral_vertical &u = support.deflection(static_cast<int>(w)),
                           &rate = support.rate(static_cast<int>(w));
    // what the contact was left with is what is reported
    EXPECT_EQ(wheels.at[w], u);
    EXPECT_EQ(wheels.rates[w], rate);
    const lateral_vertical f = wheels.force(w, found.z);
    carried += f[1];
    const double size = std::hypot(f[0], f[1]);
    for (size_t k = 0; k < 2; ++k) {
      const double expected = load.time_step > 0 ? (u[k] - before[w][k]) / load.time_step : 0.0;
      EXPECT_DOUBLE_EQ(rate[k], expected);
      if (setup.stiffness[k] > 0) {
        EXPECT_NEAR(setup.stiffness[k] * u[k] + setup.damping[k] * expected, f[k],
                    3e-9 * size + 1e-6);
      } else {
        EXPECT_EQ(u[k], 0);
      }
    }
  }
  EXPECT_EQ(wheels.z_now, found.z);
  if (load.prescribed)
    EXPECT_NEAR(carried, load.force, 2e-9 * load.force);
  else
    EXPECT_EQ(found.z, load.z);
}

TEST(RailSupport, StepsFulfilTheirEquations) {
  for (const int count : {1, 2})
    for (const bool prescribed : {true, false})
      for (const auto &stiff : std::vector<std::array<double, 2>>{{2e7, 5e7}, {0, 5e7}, {2e7, 0}})
        for (const double drag : {0.0, 3e3})
          for (const double speed : {0.0, 20.0}) {
            SCOPED_TRACE(testing::Message() << count << prescribed << ' ' << stiff[0] << ' '
                                            << stiff[1] << ' ' << drag << ' ' << speed);
            support_setup setup = setup_of(count);
            setup.stiffness = stiff;
            for (size_t k = 0; k < 2; ++k)
              if (stiff[k] == 0) setup.damping[k] = 0;
            rail_support support(setup);
            springs wheels;
            wheels.count = count;
            wheels.drag = drag;
            wheels.speed = speed;
            std::array<lateral_vertical, 2> before{};
            for (int step = 0; step < 6; ++step) {
              const support_load load{prescribed, 1e5 * (1 + 0.3 * step), 1e-4 * (step + 1),
                                      step > 1 ? 1e-3 : 0.0};
              wheels.push[0] = 4e3 + 500 * step;
              const support_result found = support.solve(wheels, load);
              expect_solved(setup, support, wheels, load, found, before);
              for (size_t w = 0; w < 2; ++w)
                if (static_cast<int>(w) < count)
                  before[w] = support.deflection(static_cast<int>(w));
            }
          }
}

// Residuals with many bends before the root: no shorter step is better, and yet there is a place.
TEST(RailSupport, PlacesBehindBendsAreFound) {
  for (const int count : {1, 2})
    for (const bool prescribed : {true, false})
      for (const double time_step : {0.0, 1e-3})
        for (const auto &stiff : std::vector<std::array<double, 2>>{{2e7, 5e7}, {2e7, 0}}) {
          SCOPED_TRACE(testing::Message()
                       << count << prescribed << ' ' << time_step << ' ' << stiff[1]);
          support_setup setup = setup_of(count);
          setup.stiffness = stiff;
          if (stiff[1] == 0) setup.damping[1] = 0;
          rail_support support(setup);
          springs wheels;
          wheels.count = count;
          wheels.push[0] = 1e5;
          wheels.push[1] = -8e4;
          wheels.wave = 4e4;
          wheels.wave_length = 1e-4;
          const support_load load{prescribed, 1e5, 1e-3, time_step};
          const support_result found = support.solve(wheels, load);
          expect_solved(setup, support, wheels, load, found, {});
          EXPECT_LT(wheels.evaluations, 3000);
        }
}

// A force that jumps past the springs' has no place, and is known by that.
TEST(RailSupport, JumpsAreNotConverged) {
  struct jump final : supported_wheels {
    double at = 0;
    int evaluations = 0;
    void move_rails(const lateral_vertical *u, const lateral_vertical *) override { at = u[0][0]; }
    bool first_touch(int, double &z) override {
      z = 0;
      return true;
    }
    bool evaluate(double, wheel_on_rail *out) override {
      ++evaluations;
      out[0] = {{at < 1e-3 ? 5e4 : 1e4, 8e4}, 0.0};
      return true;
    }
  } wheels;
  support_setup setup = setup_of(1);
  setup.stiffness = {2e7, 0};
  setup.damping = {0, 0};
  rail_support support(setup);
  const support_result found = support.solve(wheels, {false, 0, 1e-4, 0});
  EXPECT_FALSE(found.converged);
  EXPECT_FALSE(found.beyond);
  EXPECT_GT(found.residual, 0.1);
  EXPECT_LT(wheels.evaluations, 1000);
}

// With contacts that couple both ways, by different slopes on each wheel, Newton's method is quick.
TEST(RailSupport, CoupledContactsTakeFewEvaluations) {
  for (const int count : {1, 2})
    for (const bool prescribed : {true, false})
      for (const double slope : {0.2, -0.1}) {
        SCOPED_TRACE(testing::Message() << count << prescribed << ' ' << slope);
        const support_setup setup = setup_of(count);
        rail_support support(setup);
        springs wheels;
        wheels.count = count;
        wheels.slope[0] = slope;
        wheels.slope[1] = -0.5 * slope;
        wheels.speed = 20;
        wheels.drag = 2e3;
        std::array<lateral_vertical, 2> before{};
        for (int step = 0; step < 8; ++step) {
          wheels.evaluations = 0;
          wheels.push[0] = 4e3 + 3e3 * step;
          wheels.push[1] = -6e3 + 1e3 * step;
          const support_load load{prescribed, 1e5 * (1 + 0.1 * step), 1.2e-3 + 1e-4 * step, 1e-3};
          const support_result found = support.solve(wheels, load);
          expect_solved(setup, support, wheels, load, found, before);
          // start, slopes by two differences, and Newton's steps to 1e-9 from within some per cent
          EXPECT_LE(wheels.evaluations, step == 0 ? 16 : 12) << step;
          for (size_t w = 0; w < static_cast<size_t>(count); ++w)
            before[w] = support.deflection(static_cast<int>(w));
        }
      }
}

// With one wheel the vertical deflection is that of the load, by hand.
TEST(RailSupport, AStaticLoadDeflectsByItsStiffness) {
  rail_support support(setup_of(1));
  springs wheels;
  wheels.count = 1;
  const support_result found = support.solve(wheels, {true, 8e4, 0, 0});
  ASSERT_TRUE(found.converged);
  const double u = 8e4 / 5e7;
  EXPECT_NEAR(support.deflection(0)[1], u, 1e-8 * u);
  EXPECT_NEAR(found.z, u + std::pow(8e4 / 1.1e11, 2.0 / 3), 1e-9 * u);
  // k u = push + slope u
  EXPECT_NEAR(support.deflection(0)[0], 4e3 / (2e7 + 2e6), 1e-10);
  EXPECT_EQ(support.rate(0)[0], 0);
  EXPECT_EQ(support.rate(0)[1], 0);
}

// A rail let go falls back by (c/dt)/(k + c/dt) in each step.
TEST(RailSupport, LetGoItFallsBackStepByStep) {
  const support_setup setup = setup_of(1);
  rail_support support(setup);
  springs wheels;
  wheels.count = 1;
  ASSERT_TRUE(support.solve(wheels, {true, 8e4, 0, 0}).converged);
  lateral_vertical u = support.deflection(0);
  for (int i = 0; i < 5; ++i) {
    const support_result found = support.solve(wheels, {false, 0, -0.01, 1e-3});
    ASSERT_TRUE(found.converged);
    for (size_t k = 0; k < 2; ++k) {
      const double c = setup.damping[k] / 1e-3, next = u[k] * c / (setup.stiffness[k] + c);
      EXPECT_NEAR(support.deflection(0)[k], next, 1e-12 + 1e-9 * std::fabs(next));
      u[k] = support.deflection(0)[k];
    }
  }
}

TEST(RailSupport, WithoutAContactNothingIsFound) {
  rail_support support(setup_of(2));
  springs wheels;
  ASSERT_TRUE(support.solve(wheels, {true, 1e5, 0, 0}).converged);
  const lateral_vertical last = support.rails()[0].deflection;
  wheels.nowhere = true;
  const support_result found = support.solve(wheels, {true, 1e5, 0.25, 1e-3});
  EXPECT_FALSE(found.converged);
  EXPECT_TRUE(found.beyond);
  EXPECT_EQ(found.residual, HUGE_VAL);
  EXPECT_EQ(support.rails()[0].deflection, last);
  EXPECT_EQ(support.rails()[0].hertz, 0);
  EXPECT_LT(support.rails()[0].time_step, 0);
  support.reset();
  for (int w = 0; w < 2; ++w) {
    EXPECT_EQ(support.rails()[w].deflection, (lateral_vertical{0, 0}));
    EXPECT_EQ(support.rails()[w].rate, (lateral_vertical{0, 0}));
  }
  EXPECT_GE(support.bytes(), sizeof(rail_support));
}

// What is kept makes steps that change little cheap.
TEST(RailSupport, SlopesAreKeptFromStepToStep) {
  for (const bool prescribed : {true, false}) {
    support_setup setup = setup_of(2);
    setup.tolerance = 1e-5;
    rail_support support(setup);
    springs wheels;
    wheels.drag = 1e3;
    wheels.speed = 20;
    const auto load = [&](int step) {
      return support_load{prescribed, 1e5 + 200 * std::sin(step), 1.3e-3 + 1e-6 * std::sin(step),
                          1e-3};
    };
    for (int step = 0; step < 3; ++step) ASSERT_TRUE(support.solve(wheels, load(step)).converged);
    for (int step = 3; step < 20; ++step) {
      wheels.evaluations = 0;
      ASSERT_TRUE(support.solve(wheels, load(step)).converged);
      // the start, and few corrections; finding slopes anew takes two more
      EXPECT_LE(wheels.evaluations, 6) << step;
    }
    // another length of step asks for them again
    support_load other = load(20);
    other.time_step = 2e-3;
    wheels.push[0] += 3e4;
    wheels.evaluations = 0;
    ASSERT_TRUE(support.solve(wheels, other).converged);
    EXPECT_GE(wheels.evaluations, 4);
    EXPECT_EQ(support.rails()[0].time_step, 2e-3);
    // slopes are those of the contact: falling with the vertical way, by the drag with the lateral
    const rail_support::rail &r = support.rails()[0];
    const double depth = wheels.z_now - wheels.touch[0] - r.deflection[1];
    EXPECT_NEAR(r.slope[1][1] / (-1.5 * wheels.stiffness[0] * std::sqrt(depth)), 1, 0.05);
    EXPECT_NEAR(r.slope[0][0] / (wheels.lateral[0] - wheels.drag / 2e-3), 1, 0.05);
    EXPECT_NEAR(r.hertz, wheels.stiffness[0], 1e-6 * wheels.stiffness[0]);
  }
}

// Rounding of great elastic forces is no error of small ones: rails let go come to rest.
TEST(RailSupport, LetGoFromAnywhereItFallsBack) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 60; ++trial) {
    support_setup setup = setup_of(1);
    for (size_t k = 0; k < 2; ++k) {
      setup.stiffness[k] = 1e7 * (1 + 9 * u(random));
      setup.damping[k] = 1e4 * (1 + 9 * u(random));
    }
    rail_support support(setup);
    springs wheels;
    wheels.count = 1;
    ASSERT_TRUE(support.solve(wheels, {true, 8e4, 0, 0}).converged);
    lateral_vertical u_before = support.deflection(0);
    for (int i = 0; i < 4; ++i) {
      const double step = 1e-3 * (0.5 + u(random));
      ASSERT_TRUE(support.solve(wheels, {false, 0, -0.01, step}).converged) << trial << ' ' << i;
      for (size_t k = 0; k < 2; ++k) {
        const double c = setup.damping[k] / step, next = u_before[k] * c / (setup.stiffness[k] + c);
        EXPECT_NEAR(support.deflection(0)[k], next, 1e-12 + 1e-9 * std::fabs(next));
      }
      u_before = support.deflection(0);
    }
  }
}

// Differences that slopes are found by: small against the contact's depth, and as creepage.
TEST(RailSupport, DifferencesAreSmallForTheContact) {
  for (const double force : {300.0, 1e5})
    for (const double speed : {0.0, 1e-3, 20.0}) {
      const support_setup setup = setup_of(1);
      rail_support support(setup);
      springs wheels;
      wheels.count = 1;
      wheels.speed = speed;
      wheels.push[0] = 0.1 * force;
      const double step = 1e-3;
      const support_load load{true, force, 0, step};
      ASSERT_TRUE(support.solve(wheels, load).converged);
      const lateral_vertical &h = support.rails()[0].difference;
      const double depth = std::pow(force / wheels.stiffness[0], 2.0 / 3);
      EXPECT_GT(h[0], 0);
      EXPECT_GT(h[1], 0);
      EXPECT_LE(h[0], 1e-6);
      EXPECT_LE(h[1], 0.1 * depth) << force << ' ' << speed;
      if (speed > 0) {
        EXPECT_LE(h[0] / step / speed, 3e-5 * (1 + 1e-12)) << force << ' ' << speed;
      }
    }
}

// Contacts far softer than those of two bodies of the material: Newton's steps would go far beyond
// what is known of them, and are shortened.
TEST(RailSupport, StepsIntoTheContactAreShort) {
  for (const bool rigid : {false, true})
    for (const int count : {1, 2}) {
      support_setup setup = setup_of(count);
      if (rigid) setup.stiffness[1] = setup.damping[1] = 0;
      rail_support support(setup);
      springs wheels;
      wheels.count = count;
      wheels.stiffness[0] = wheels.stiffness[1] = 1e8;
      double deepest = 0;
      bool first = true;
      wheels.known = [&](const lateral_vertical &u, double z) {
        const double depth = z - u[1] - wheels.touch[0];
        if (!first) {
          EXPECT_LE(depth, 1.001 * (3 * deepest + 2e-5));
        }
        first = false;
        deepest = std::max(deepest, depth);
        return true;
      };
      const support_load load{true, 1e5, 0, 0};
      const support_result found = support.solve(wheels, load);
      expect_solved(setup, support, wheels, load, found, {});
    }
}

// A step that cannot be taken is halved, 24 times with slopes found where it begins.
TEST(RailSupport, StepsThatCannotBeTakenAreHalved) {
  rail_support support(setup_of(1));
  springs wheels;
  wheels.count = 1;
  wheels.stiffness[0] = 0.9e11;
  std::vector<std::array<double, 2>> places;
  // the start and the two places beside it where slopes are found
  wheels.known = [&](const lateral_vertical &u, double z) {
    places.push_back({u[0], z - u[1]});
    return places.size() <= 3;
  };
  EXPECT_FALSE(support.solve(wheels, {true, 1e5, 0, 0}).converged);
  // a search that finds nothing known either, and at last the start again
  ASSERT_GT(places.size(), 3 + 25 + 1);
  EXPECT_LT(places.size(), 400);
  EXPECT_EQ(places.back(), places[0]);
  double way = 0;
  for (size_t i = 0; i < 25; ++i) {
    const double now = places[3 + i][0] - places[0][0];
    if (i > 0) {
      EXPECT_NEAR(now, 0.5 * way, 1e-17);
    }
    way = now;
  }
}

}  // namespace
