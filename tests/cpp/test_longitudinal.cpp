// Shapes along the rolling direction and transient rolling of wheels: splines, the displacement
// between grids that move, and the history of a wheel's patches.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "geometry/longitudinal_shape.hpp"
#include "half_space/offset_influence.hpp"
#include "handle/case_fields.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

// --- splines -------------------------------------------------------------------------------

std::vector<double> samples(int count, double (*f)(double), double start, double spacing) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(f(start + i * spacing));
  return values;
}

TEST(Splines, OfOneWaveConvergeWithFourthOrder) {
  const auto wave = [](double x) { return std::sin(3 * x); };
  double last = 0;
  for (int n : {24, 48, 96}) {
    const even_spline s(samples(n, wave, 0, 2 * pi / n).data(), n, 0, 2 * pi / n, true);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      const double x = -7 + 0.02 * i;
      worst = std::max(worst, std::fabs(s.at(x) - wave(x)));
    }
    // interpolation by a C2 cubic spline errs by h^4 |f''''|/384 (Hall and Meyer 1976)
    EXPECT_LT(worst, 5.0 / 384 * std::pow(2 * pi / n, 4) * 81);
    if (last > 0) {
      EXPECT_NEAR(last / worst, 16, 2);
    }
    last = worst;
  }
}

TEST(Splines, AreSmoothAndConstantBeyondTheirEnds) {
  const double values[] = {0, 1e-3, -2e-3, 5e-4, 3e-4};
  const even_spline s(values, 5, 2.0, 0.1, false);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(s.at(2.0 + 0.1 * i), values[i], 1e-15);
  EXPECT_EQ(s.at(-100), 0);
  EXPECT_EQ(s.at(100), 3e-4);
  const double h = 1e-6;
  for (int i = 0; i < 5; ++i) {
    // slope and bend from both sides of a node
    const double x = 2.0 + 0.1 * i;
    double left, right, before, after;
    s.at(x - h, left);
    s.at(x + h, right);
    s.at(x - 2 * h, before);
    s.at(x + 2 * h, after);
    EXPECT_NEAR(left, right, 1e-5);
    EXPECT_NEAR((left - before) / h, (after - right) / h,
                1e-3 * (1 + std::fabs(left - before) / h));
  }
}

TEST(Splines, KnowABoundOfTheirValues) {
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<double> values(20);
  for (double &v : values) v = u(random);
  const even_spline s(values.data(), 20, 0, 0.1, true);
  for (int i = 0; i < 100; ++i) {
    const double a = 3 * u(random), b = a + 0.9 * (1 + u(random));
    const double bound = s.greatest(a, b);
    for (int k = 0; k <= 200; ++k) EXPECT_LE(s.at(a + (b - a) * k / 200), bound + 1e-15);
  }
}

// --- displacement between grids --------------------------------------------------------------

TEST(MovedGrids, TakeTheDisplacementOfTheDirectSum) {
  const elastic_constants steel{82e9, 0.28, 0};
  const fft_plans plans({48, 96}, {32, 64});
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> u(-1, 1);
  for (double layer : {0.0, 6e-15}) {
    influence a({steel, layer, 0, true}, plans);
    offset_influence moved(plans, true);
    for (int round = 0; round < 6; ++round) {
      const grid from{9 + 2 * round, 14 - round, 4e-4, 6e-4, 0, 0};
      const grid to{20 - round, 5 + round, 4e-4, 6e-4, 0, 0};
      a.set_grid(to);
      const double offset[2] = {5e-3 * u(random), 4e-3 * u(random)};
      std::vector<double> p[2], got[2];
      for (auto &f : p) {
        f.resize(static_cast<size_t>(from.count()));
        for (double &v : f) v = 1e9 * u(random);
      }
      for (auto &f : got) f.assign(static_cast<size_t>(to.count()), 1e-6);
      moved.add_moved(a, from, to, offset, 0.75, p[0].data(), p[1].data(), got[0].data(),
                      got[1].data());
      for (int j = 0; j < to.ny; ++j)
        for (int i = 0; i < to.nx; ++i) {
          double sum[2] = {0, 0};
          for (int n = 0; n < from.ny; ++n)
            for (int m = 0; m < from.nx; ++m) {
              const double x = offset[0] + (i - m) * to.dx, y = offset[1] + (j - n) * to.dy;
              const auto k = static_cast<size_t>(n * from.nx + m);
              double values[3];
              a.bodies_at(x, y, values);
              // the layer's part falls to nothing at the next element
              const double u1 = std::fabs(x) / to.dx, v1 = std::fabs(y) / to.dy;
              const double near = u1 < 1 && v1 < 1 ? layer * (1 - u1) * (1 - v1) : 0.0;
              sum[0] += (values[0] + near) * p[0][k] + values[2] * p[1][k];
              sum[1] += values[2] * p[0][k] + (values[1] + near) * p[1][k];
            }
          const auto at = static_cast<size_t>(j * to.nx + i);
          for (int c = 0; c < 2; ++c) EXPECT_NEAR(got[c][at], 1e-6 + 0.75 * sum[c], 1e-14);
        }
    }
  }
}

// --- wheels ----------------------------------------------------------------------------------

// A wheel with a wavy circumference on a rail with a dip, rolling on step by step.
struct wavy {
  scenes::profile_pair pair;
  std::vector<double> runout, height;
  rp_config config;

  explicit wavy(rp_kind kind, bool falling = false)
      : config(scenes::coarse(scenes::wheels(kind, RP_RAIL, pair))) {
    if (falling) scenes::set_falling_friction(config);
    for (int i = 0; i < 720; ++i) runout.push_back(1e-4 * std::sin(2 * pi * 20 * i / 720));
    for (int i = 0; i < 200; ++i) height.push_back(-1e-4 * std::exp(-std::pow((i - 100) / 15., 2)));
    config.regime = RP_TRANSIENT_ROLLING;
    for (int side = 0; side < 2; ++side) {
      config.runout[side] = runout.data();
      config.runout_count[side] = 720;
      config.rail_height[side] = height.data();
      config.rail_height_count[side] = 200;
    }
    config.rail_height_start = -0.1;
  }
  rp_input input(int step) const {
    rp_input in = scenes::running(RP_RAIL);
    in.time_step = 5e-5;
    in.x = in.speed * in.time_step * step - 0.02;
    in.pitch = in.pitch_rate * in.time_step * step;
    in.y = 1e-5 * step;
    return in;
  }
};

TEST(TransientWheels, AStateRestoredStepsToTheSameBits) {
  for (rp_kind kind : {RP_WHEEL_RAIL, RP_WHEELSET})
    for (bool falling : {false, true}) {
      const wavy w(kind, falling);
      scenes::handle first(w.config), second(w.config);
      for (int k = 0; k < 6; ++k) first.step(w.input(k));
      const auto state = first.state();
      ASSERT_EQ(second.restore(state), RP_OK);
      for (int k = 6; k < 12; ++k) {
        const rp_result a = first.step(w.input(k)), b = second.step(w.input(k));
        EXPECT_EQ(a.status, RP_CONVERGED);
        EXPECT_EQ(scenes::difference(a, b), "");
      }
    }
}

TEST(TransientWheels, WhatLiftsOffForgets) {
  for (bool falling : {false, true}) {
    wavy w(RP_WHEEL_RAIL, falling);
    w.config.load = RP_POSITION;
    const auto at = [&](int k, double z) {
      rp_input in = w.input(k);
      in.z = z;
      return in;
    };
    scenes::handle used(w.config), fresh(w.config);
    for (int k = 0; k < 5; ++k) EXPECT_EQ(used.step(at(k, 4e-4)).status, RP_CONVERGED);
    EXPECT_EQ(used.step(at(5, -2e-3)).status, RP_NO_CONTACT);
    EXPECT_EQ(scenes::difference(used.step(at(6, 4e-4)), fresh.step(at(6, 4e-4))), "");
  }
}

// From the first step, in which little has crept yet, towards what is steady.
TEST(TransientWheels, CreepForcesGrowWithTheWayRolled) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  rp_input in = scenes::running(RP_RAIL);
  in.pitch_rate *= 1.0008;
  in.yaw = 8e-4;
  in.time_step = 5e-5;
  const auto forces = [&](scenes::handle &h) {
    const rp_result r = h.step(in);
    EXPECT_EQ(r.status, RP_CONVERGED);
    const double *f = r.side[c.side].patch[0].creep_force;
    return std::array{f[0], f[1]};
  };
  scenes::handle steady(c);
  const auto last = forces(steady);
  c.regime = RP_TRANSIENT_ROLLING;
  scenes::handle rolling(c);
  std::array<double, 2> before = forces(rolling), now = before;
  for (size_t k = 0; k < 2; ++k) EXPECT_LT(std::fabs(now[k]), 0.5 * std::fabs(last[k])) << k;
  for (int step = 1; step < 5; ++step) {
    before = now;
    now = forces(rolling);
    for (size_t k = 0; k < 2; ++k) {
      EXPECT_GT(std::fabs(now[k]), std::fabs(before[k])) << step << ' ' << k;
      EXPECT_LT(std::fabs(now[k]), std::fabs(last[k])) << step << ' ' << k;
    }
  }
}

// The wheel of a mirrored case, whose inputs are symmetric.
// Rails that stand aside with the wheelset, or move on with it: the material goes along.
TEST(TransientWheels, RailsMovedAsideCarryTheirMaterial) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  c.regime = RP_TRANSIENT_ROLLING;
  c.load = RP_FORCE;
  scenes::handle middle(c), aside(c);
  rp_input in = scenes::running(RP_RAIL);
  in.vertical_force = 6e4;
  in.pitch_rate *= 1 + 1e-3;
  in.time_step = 1e-4;
  for (int step = 0; step < 4; ++step) {
    rp_input moved = in;
    const double way = 1.5e-3 + 4e-4 * step;
    moved.y += way;
    for (auto &offset : moved.rail_offset) offset[1] += way;
    const rp_side_result expected = middle.step(in).side[RP_RIGHT],
                         found = aside.step(moved).side[RP_RIGHT];
    ASSERT_EQ(expected.status, RP_CONVERGED);
    ASSERT_EQ(found.status, RP_CONVERGED);
    const double size = std::fabs(expected.force[2]);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(found.force[k], expected.force[k], 1e-5 * size) << step << ' ' << k;
  }
}

TEST(TransientWheels, LeftIsTheMirrorOfRight) {
  for (bool falling : {false, true}) {
    const wavy w(RP_WHEELSET, falling);
    scenes::handle contact(w.config);
    for (int k = 0; k < 6; ++k) {
      rp_input in = w.input(k);
      in.y = 0;
      const rp_result r = contact.step(in);
      EXPECT_EQ(r.side[0].force[0], r.side[1].force[0]);
      EXPECT_EQ(r.side[0].force[1], -r.side[1].force[1]);
      EXPECT_EQ(r.side[0].force[2], r.side[1].force[2]);
    }
  }
}

// Differences start from what each wheel's material has carried so far.
TEST(TransientWheels, DerivativesOfLeftMirrorThoseOfRight) {
  wavy w(RP_WHEELSET);
  w.config.derivatives = 1;
  scenes::handle contact(w.config);
  for (int k = 0; k < 2; ++k) {
    rp_input in = w.input(k);
    in.y = 0;
    contact.step(in);
  }
  rp_input direction;
  rp_default_input(&direction);
  for_each_number(direction, [](const char *, double &v, double) { v = 0; });
  direction.pitch_rate = 1;
  rp_result change{};
  rp_derivative_kind kind;
  ASSERT_EQ(rp_differentiate(contact.get(), &direction, &change, &kind, nullptr), RP_OK);
  EXPECT_EQ(kind, RP_DERIVATIVE_BY_DIFFERENCES);
  EXPECT_NE(change.side[0].force[0], 0);
  EXPECT_EQ(change.side[0].force[0], change.side[1].force[0]);
  EXPECT_EQ(change.side[0].force[1], -change.side[1].force[1]);
  EXPECT_EQ(change.side[0].force[2], change.side[1].force[2]);
}

TEST(TransientWheels, WhatTheyCannotDoIsRefused) {
  const wavy w(RP_WHEELSET);
  const auto refused = [&](auto change, const char *word) {
    rp_config c = w.config;
    change(c);
    rp_contact *contact = nullptr;
    rp_message message{};
    EXPECT_EQ(rp_create(&c, &contact, &message), RP_ERROR_VALUE);
    EXPECT_NE(std::string(message.text).find(word), std::string::npos) << message.text;
    rp_destroy(contact);
  };
  refused([](rp_config &c) { c.regime = RP_SHIFT; }, "regime");
  refused([](rp_config &c) { c.temperature = 1; }, "temperature");
  refused([](rp_config &c) { c.friction_law = RP_TEMPERATURE, c.temperature = 1; }, "friction_law");
  refused([](rp_config &c) { c.layer_yield_stress = 1e8; }, "layer_yield_stress");
  refused([](rp_config &c) { c.poisson_ratio[0] = 0.1; }, "(1-2nu)/G");
  refused([](rp_config &c) { c.normal = RP_NORMAL_ANALYN; }, "half_space");
  refused([](rp_config &c) { c.runout_count[1] = 7; }, "runout_count[1]");
  refused([](rp_config &c) { c.runout[0] = nullptr; }, "runout[0]");
  refused([](rp_config &c) { c.rail_height_count[0] = -1; }, "rail_height_count[0]");
  refused([](rp_config &c) { c.rail_height_spacing = 0; }, "rail_height_spacing");
  refused([](rp_config &c) { c.track = RP_ROLLER, c.cant = 0; }, "rollers");
  refused(
      [](rp_config &c) {
        c.elements[0] = c.elements[1] = 20;
        c.element_size[0] = c.element_size[1] = 0;
      },
      "element_size");
  scenes::handle contact(w.config);
  rp_input in = w.input(0);
  in.time_step = 0;
  rp_result result{};
  rp_message message{};
  EXPECT_EQ(rp_step(contact.get(), &in, &result, &message), RP_ERROR_VALUE);
  EXPECT_NE(std::string(message.text).find("time_step"), std::string::npos) << message.text;
}

}  // namespace
