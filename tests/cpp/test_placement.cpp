// Where surfaces stand and how they move, told anew: gaps and undeformed distances by halving along
// lines, creepages by differences of the places of material points.
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "geometry/geometry.hpp"
#include "geometry/placement.hpp"
#include "surfaces.hpp"

namespace {

using namespace railpatch;
using surfaces::about;
using surfaces::ex;
using surfaces::ey;
using surfaces::ez;
using surfaces::matrix;
using surfaces::plus;
using surfaces::times;
using surfaces::vector;

constexpr double deep = 5e-5;  // m, of the wheel in the rail

side_motion any_motion(std::mt19937_64 &random, bool roller) {
  std::uniform_real_distribution<double> u(-1, 1);
  side_motion m;
  m.wheelset = {5e-3 * u(random), 0,         4e-3 * u(random), 0.02 * u(random), 15 * u(random),
                u(random),        u(random), 0.3 * u(random),  0.3 * u(random),  40 * u(random)};
  for (deviation *d : {&m.wheel, &m.rail})
    for (size_t k = 0; k < 3; ++k) {
      d->offset[k] = 2e-3 * u(random);
      d->rotation[k] = 0.01 * u(random);
      d->velocity[k] = u(random);
      d->angular_velocity[k] = u(random);
    }
  m.rail.rotation[1] = m.rail.rotation[2] = 0;
  m.roller_pitch_rate = roller ? 20 * u(random) : 0;
  if (roller) m.wheelset.speed = 0.1 * u(random);
  return m;
}

class Placement : public testing::TestWithParam<track_kind> {
 protected:
  Placement() : side(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track) {}

  // A motion with the wheel in the rail, and a frame there.
  contact_frame put(const side_motion &m) {
    scene.motion = m;
    scene.motion.wheelset.z = 0;
    side.place(scene.motion);
    double s = 0, least = HUGE_VAL;
    for (int i = 0; i < side.sample_count(); ++i)
      if (side.sample_gap(i) < least) least = side.sample_gap(i), s = side.sample_s(i);
    scene.motion.wheelset.z = least + deep;
    side.move_to(scene.motion.wheelset.z);
    const locus_point l = side.locus(s);
    EXPECT_TRUE(l.valid);
    return {{l.wheel[0], l.wheel[1], l.rail_z}, l.contact_angle};
  }

  std::mt19937_64 random{20261122};
  surfaces::scene scene{GetParam()};
  side_geometry side;
};

TEST_P(Placement, MarkerLiesWhereGaugeAndTopAsk) {
  // by steps of 2 um
  EXPECT_NEAR(side.rail_marker_y(), scene.marker_y, 2e-6);
  EXPECT_NEAR(side.rail_marker_z(), scene.marker_z, 1e-12);
  EXPECT_GE(side.bytes(), sizeof side);
}

TEST_P(Placement, LocusIsWhereSurfacesComeClosest) {
  for (int n = 0; n < 3; ++n) {
    put(any_motion(random, scene.roller()));
    scene.marker_y = side.rail_marker_y();
    for (int k = -6; k <= 6; ++k) {
      double near = 0, least = HUGE_VAL;
      for (int i = 0; i < side.sample_count(); ++i)
        if (side.sample_gap(i) < least) least = side.sample_gap(i), near = side.sample_s(i);
      const locus_point l = side.locus(near + 1.3e-3 * k);
      if (!l.valid || l.gap > 1e-3) continue;
      const double y = l.wheel[1], z = l.rail_z;
      EXPECT_NEAR(l.gap, scene.gap(l.wheel[0], y, z), 1e-12);
      EXPECT_NEAR(l.wheel[2], z + scene.wheel_height({l.wheel[0], y, z}, ez), 1e-12);
      // the parabola through three points about it is level there
      const double h = 1e-3, low = scene.gap(l.wheel[0] - h, y, z),
                   high = scene.gap(l.wheel[0] + h, y, z);
      EXPECT_GT(low, l.gap);
      EXPECT_GT(high, l.gap);
      EXPECT_NEAR(0.25 * (low - high) * h / (0.5 * (low + high) - l.gap), 0, 5e-6);
      const vector q =
          times(surfaces::transposed(scene.wheel_axes()), plus(l.wheel, scene.axis_point(), -1));
      const double r = std::hypot(q[0], q[2]);
      EXPECT_NEAR(l.sine, q[0] / r, 1e-12);
      const double roller = scene.axle()[2] - l.rail_z;
      EXPECT_NEAR(l.curvature, 0.5 / r + (scene.roller() ? 0.5 / roller : 0.0), 1e-12);
      const double dz = scene.rail_meridian().height(y + 1e-6, scene.rail_from, scene.rail_to) -
                        scene.rail_meridian().height(y - 1e-6, scene.rail_from, scene.rail_to);
      EXPECT_NEAR(std::tan(l.contact_angle), dz / 2e-6, 1e-6);
    }
    // samples are near
    for (int i = 0; i < side.sample_count(); i += 5) {
      const locus_point l = side.locus(side.sample_s(i));
      if (l.valid && side.sample_gap(i) < 0.5 * side_geometry::far_apart &&
          std::fabs(l.contact_angle) < 1) {
        EXPECT_NEAR(side.sample_gap(i), l.gap, 1e-6);
      }
    }
  }
}

// A far turned wheel over a rail, or ahead of a roller's axle: both surfaces fall alike along x.
TEST_P(Placement, LocusIsWhereBothSurfacesFallAlike) {
  int compared = 0;
  double farthest = 0;
  for (int n = 0; n < 8; ++n) {
    side_motion m = any_motion(random, scene.roller());
    m.wheelset.yaw = n % 2 ? 0.02 * (n - 3) : 0.03 * (n - 4);
    m.rail.offset[0] = 0.01 * (n - 3);
    put(m);
    const double no = 0.5 * side_geometry::far_apart;
    for (int i = 1; i + 1 < side.sample_count(); ++i) {
      const double s = side.sample_s(i);
      const locus_point l = side.locus(s);
      if (!l.valid || side.sample_gap(i - 1) > no || side.sample_gap(i) > no ||
          side.sample_gap(i + 1) > no)
        continue;
      const curve_point p = scene.wheel_curve.evaluate(s);
      const double c = std::cos(m.wheel.rotation[0]), t = std::sin(m.wheel.rotation[0]);
      const double across = c * p.dy - t * p.dz, down = t * p.dy + c * p.dz;
      const double cosine = std::sqrt(1 - l.sine * l.sine);
      const vector in_axes{l.sine * across, -down, cosine * across};
      const vector normal = times(scene.wheel_axes(), in_axes);
      const double of_wheel = -normal[0] / normal[2];
      // the height of a roller's surface is taken from the sampled gap, and steps of the search,
      // down to 1e-7, leave aside how it changes along the wheel
      const vector a = scene.axle();
      const double reach = a[2] - l.rail_z, x = l.wheel[0] - a[0];
      const double of_roller = scene.roller() ? x / reach : 0;
      const double aside = std::fabs(l.gap - side.sample_gap(i)) +
                           1e-7 * scene.sizes.nominal_radius * std::fabs(l.sine);
      const double allowed = 1.1 * std::fabs(of_roller / reach) * aside + 1e-12;
      EXPECT_NEAR(of_wheel, of_roller, allowed) << n << ' ' << i << ' ' << l.sine;
      ++compared;
      farthest = std::max(farthest, std::fabs(l.sine));
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_GT(farthest, 0.2);
}

TEST_P(Placement, RailSurfaceIsWhereARailLies) {
  put(any_motion(random, scene.roller()));
  scene.marker_y = side.rail_marker_y();
  for (double y = 0.70; y < 0.83; y += 1.7e-3)
    for (const double x : {0.0, 0.02, -0.03}) {
      double z = 7, angle = 7;
      const bool found = side.rail_surface(x, y, z, angle);
      const double level = scene.rail_meridian().height(y, scene.rail_from, scene.rail_to);
      if (std::isnan(level)) continue;
      ASSERT_TRUE(found);
      const vector a = scene.axle();
      const double expected =
          scene.roller()
              ? a[2] - std::sqrt((a[2] - level) * (a[2] - level) - (x - a[0]) * (x - a[0]))
              : level;
      EXPECT_NEAR(z, expected, 1e-12);
      if (scene.roller()) {
        EXPECT_NEAR(side.roller_inclination({x, y, z}), std::atan((x - a[0]) / (a[2] - z)), 1e-15);
      }
    }
  double z, angle;
  EXPECT_FALSE(side.rail_surface(0, 0.6, z, angle));
  EXPECT_FALSE(side.rail_surface(0, 0.9, z, angle));
  // beside a roller
  if (scene.roller()) {
    EXPECT_FALSE(side.rail_surface(1.01, 0.755, z, angle));
  }
}

TEST_P(Placement, UndeformedDistanceIsThatOfTheSurfaces) {
  for (int n = 0; n < 3; ++n) {
    contact_frame f = put(any_motion(random, scene.roller()));
    scene.marker_y = side.rail_marker_y();
    if (scene.roller() && n % 2) f.inclination = side.roller_inclination(f.origin);
    const surfaces::frame axes(f);
    // some of the rows reach beyond the surfaces
    const surface_grid g{7, 9, -6.1e-3, n == 0 ? -0.045 : -5.2e-3, 2e-3, n == 0 ? 0.011 : 1.4e-3};
    std::vector<double> h(static_cast<size_t>(g.nx * g.ny), -1.0);
    side.undeformed_distance(f, g, h.data());
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const vector p = axes.at(g.x0 + i * g.dx, g.y0 + j * g.dy);
        const double found = h[static_cast<size_t>(j * g.nx + i)];
        const double expected = scene.rail_height(p, axes.n) - scene.wheel_height(p, axes.n);
        if (std::isnan(expected))
          EXPECT_TRUE(found == side_geometry::no_surface || n == 0) << i << ' ' << j;
        else
          EXPECT_NEAR(found, expected, 1e-10) << i << ' ' << j;
      }
    double start[2] = {NAN, NAN};
    const double step = 1e-5;
    const section_point p = side.section(f, start);
    ASSERT_TRUE(p.valid);
    EXPECT_NEAR(p.wheel, scene.wheel_height(axes.origin, axes.n), 1e-10);
    EXPECT_NEAR(p.rail, scene.rail_height(axes.origin, axes.n), 1e-10);
    const auto slope = [&](auto &&height) {
      return std::atan((height(axes.at(0, step)) - height(axes.at(0, -step))) / (2 * step));
    };
    EXPECT_NEAR(p.wheel_angle,
                slope([&](const vector &at) { return scene.wheel_height(at, axes.n); }), 1e-7);
    EXPECT_NEAR(p.rail_angle,
                slope([&](const vector &at) { return scene.rail_height(at, axes.n); }), 1e-7);
    // from where it was found the search goes on
    const section_point again = side.section(f, start);
    EXPECT_NEAR(again.wheel, p.wheel, 1e-12);
    EXPECT_NEAR(again.rail, p.rail, 1e-12);
    EXPECT_NEAR(scene.wheel_meridian().at(start[0])[0],
                times(surfaces::transposed(scene.wheel_axes()),
                      plus(plus(axes.origin, axes.n, p.wheel), scene.axis_point(), -1))[1],
                1e-10);
    EXPECT_NEAR(scene.rail_meridian().at(start[1])[0], axes.origin[1] + p.rail * axes.n[1], 1e-10);
  }
}

// far wider than what is worked on at once, and with its origin at an edge
TEST_P(Placement, WideGridsAreThoseOfTheirParts) {
  const contact_frame f = put(any_motion(random, scene.roller()));
  const surface_grid wide{600, 2, -0.008, 0, 2e-5, 1e-3};
  std::vector<double> h(1200), part(2 * 50);
  side.undeformed_distance(f, wide, h.data());
  for (int first = 0; first < 600; first += 50) {
    const surface_grid g{50, 2, wide.x0 + first * wide.dx, 0, 2e-5, 1e-3};
    side.undeformed_distance(f, g, part.data());
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 50; ++i)
        EXPECT_NEAR(part[static_cast<size_t>(j * 50 + i)],
                    h[static_cast<size_t>(j * 600 + first + i)], 2e-10);
  }
}

TEST_P(Placement, ShapesAddToTheDistance) {
  // wheels out of round on rails with heights; rollers are level
  std::vector<double> runout, height;
  for (int i = 0; i < 720; ++i) runout.push_back(1e-4 * std::sin(2 * M_PI * 20 * i / 720));
  for (int i = 0; i < 200; ++i) height.push_back(1e-4 * std::sin(0.4 * i));
  longitudinal_values values{runout.data(), 720, nullptr, 0, 0, 1};
  if (!scene.roller()) {
    values.height = height.data();
    values.height_count = 200;
    values.height_start = -1;
    values.height_spacing = 0.01;
  }
  longitudinal_shape shape(values);
  shape.place(0.3, 0.11, 0.46);
  side.set_shape(&shape);
  EXPECT_TRUE(side.shaped());
  scene.runout = [&](double angle) { return shape.runout(angle); };
  scene.rise = [&](double x) { return shape.height(x); };
  for (int n = 0; n < 3; ++n) {
    const contact_frame f = put(any_motion(random, scene.roller()));
    scene.marker_y = side.rail_marker_y();
    const surfaces::frame axes(f);
    const surface_grid g{6, 5, -0.011, -4e-3, 4e-3, 2e-3};
    double h[30];
    side.undeformed_distance(f, g, h);
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i) {
        const vector p = axes.at(g.x0 + i * g.dx, g.y0 + j * g.dy);
        EXPECT_NEAR(h[j * 6 + i], scene.rail_height(p, axes.n) - scene.wheel_height(p, axes.n),
                    1e-10);
      }
    double z, angle;
    ASSERT_TRUE(side.rail_surface(0.02, f.origin[1], z, angle));
    EXPECT_NEAR(z, f.origin[2] + scene.rail_height({0.02, f.origin[1], f.origin[2]}, ez), 1e-11);
  }
}

struct listener final : surface_visitor {
  int count = 0;
  std::function<void(int, int, double, double)> heard;
  void meet(int column, int row, double p, double n) override {
    ++count;
    heard(column, row, p, n);
  }
};

TEST_P(Placement, VisitorsAreToldWhereLinesMeetASurface) {
  const contact_frame f = put(any_motion(random, scene.roller()));
  scene.marker_y = side.rail_marker_y();
  const surfaces::frame axes(f);
  const surface_grid g{5, 7, -4e-3, -3e-3, 2e-3, 1e-3};
  listener visitor;
  for (const body which : {body::wheel, body::rail}) {
    visitor.count = 0;
    visitor.heard = [&](int column, int row, double p, double n) {
      const vector at = axes.at(g.x0 + column * g.dx, g.y0 + row * g.dy);
      if (which == body::wheel) {
        EXPECT_NEAR(n, scene.wheel_height(at, axes.n), 1e-10);
        const vector q = times(surfaces::transposed(scene.wheel_axes()),
                               plus(plus(at, axes.n, n), scene.axis_point(), -1));
        EXPECT_NEAR(scene.wheel_meridian().at(p)[0], q[1], 1e-10);
      } else {
        EXPECT_NEAR(n, scene.rail_height(at, axes.n), 1e-10);
        EXPECT_NEAR(scene.rail_meridian().at(p)[0], at[1] + n * axes.n[1], 1e-10);
      }
    };
    side.meet_surface(which, f, g, visitor);
    EXPECT_EQ(visitor.count, 35);
  }
}

// With a shape the locus is where a row is closest, and the row's overlap that of the surfaces.
TEST_P(Placement, RowsOfShapedSurfacesMeetWhereTheyAreClosest) {
  std::vector<double> runout;
  for (int i = 0; i < 720; ++i) runout.push_back(3e-5 * std::sin(2 * M_PI * 30 * i / 720));
  longitudinal_shape shape({runout.data(), 720, nullptr, 0, 0, 1});
  shape.place(0.31, 0, 0.46);
  scene.runout = [&](double angle) { return shape.runout(angle); };
  side.set_shape(&shape);
  side_motion m;
  m.wheelset.y = 2e-3;
  m.wheelset.yaw = 1e-3;
  m.wheel.offset = {1e-3, 5e-4, 0};
  put(m);
  scene.marker_y = side.rail_marker_y();
  int compared = 0;
  for (int i = 0; i < side.sample_count(); i += 11) {
    const locus_point l = side.locus(side.sample_s(i));
    if (!l.valid || l.gap > -3e-5) continue;
    ++compared;
    EXPECT_NEAR(side.sample_gap(i), l.gap, 1e-6);
    // a meridian plane of the yawed wheel moves aside on its way along x
    const auto aside = [&](double x) {
      return l.wheel[1] + std::tan(m.wheelset.yaw) * (x - l.wheel[0]);
    };
    double least = HUGE_VAL, where = 0, weight = 0, mean = 0;
    constexpr double step = 4e-4;
    for (double x = l.wheel[0] - 0.012; x < l.wheel[0] + 0.012; x += step) {
      const double g = scene.gap(x, aside(x), 0);
      if (g < least) least = g, where = x;
      const double share = 15.0 / 16 * step * std::pow(std::min(g, 0.0), 2);
      weight += share;
      mean += share * x;
    }
    // rows leave aside that the rail slopes, by 1:20, across what yaw moves over 3 mm
    EXPECT_NEAR(l.gap, least, 2e-7);
    EXPECT_NEAR(l.wheel[0], where, step);
    double y = 0, dy = 0;
    const row_overlap o = side.overlap(side.sample_s(i), y, dy);
    EXPECT_NEAR(o.weight / weight, 1, 0.02);
    EXPECT_NEAR(o.x, mean / weight, 2e-4);
    EXPECT_NEAR(y, aside(o.x), 1e-7);
    const double h = 1e-6;
    EXPECT_NEAR(dy,
                (scene.wheel_meridian().at(side.sample_s(i) + h)[0] -
                 scene.wheel_meridian().at(side.sample_s(i) - h)[0]) /
                    (2 * h),
                1e-6);
  }
  EXPECT_GE(compared, 1);
}

// Beside the rail there is none.
TEST_P(Placement, RowsBesideTheRailOverlapNowhere) {
  std::vector<double> runout(16, 0.0);
  longitudinal_shape shape({runout.data(), 16, nullptr, 0, 0, 1});
  shape.place(0, 0, 0.46);
  side.set_shape(&shape);
  side_motion m;
  m.wheelset.y = 0.04;
  m.wheelset.z = 0.05;
  side.place(m);
  double y = 0, dy = 0;
  const row_overlap o = side.overlap(scene.wheel_to, y, dy);
  for (const double v : {o.weight, o.x, o.x_min, o.x_max}) EXPECT_EQ(v, 0);
}

// --- velocities --------------------------------------------------------------------------------

// Track axes at t = 0 seen from the ground a little later.
struct later {
  const surfaces::scene &scene;
  double t;

  vector on_ground(const vector &p) const {
    const double v = scene.motion.wheelset.speed;
    return plus(times(about(ez, scene.track.curvature * v * t), p), ex, v * t);
  }
  matrix wheelset() const {
    const wheelset_state &w = scene.motion.wheelset;
    return times(about(ex, w.roll + w.roll_rate * t), about(ez, w.yaw + w.yaw_rate * t));
  }
  // the place of what is now at p, without and with the wheel's own rolling
  vector carried(const vector &p) const {
    const wheelset_state &w = scene.motion.wheelset;
    const deviation &d = scene.motion.wheel;
    const vector centre = plus(scene.centre(), {0, w.vy, w.vz}, t);
    const matrix to_wheelset = surfaces::transposed(scene.axes());
    const vector from_centre = times(to_wheelset, plus(p, scene.centre(), -1));
    const vector own = times(to_wheelset, plus(p, scene.axis_point(), -1));
    const vector below = plus(own, {0, d.offset[1], scene.sizes.nominal_radius + d.offset[2]}, -1);
    vector moved = plus(from_centre, d.velocity, t);
    const auto turn = [&](const vector &axis, double rate, const vector &arm) {
      moved = plus(moved, plus(times(about(axis, rate * t), arm), arm, -1));
    };
    turn(ex, d.angular_velocity[0], below);
    turn(ez, d.angular_velocity[2], own);
    return on_ground(plus(centre, times(wheelset(), moved)));
  }
  vector rolled(const vector &p) const {
    const matrix axes = scene.wheel_axes();
    const vector axis{axes[0][1], axes[1][1], axes[2][1]};
    const double rate = scene.motion.wheelset.pitch_rate + scene.motion.wheel.angular_velocity[1];
    const vector arm = plus(p, scene.axis_point(), -1);
    return plus(scene.axis_point(), times(about(axis, rate * t), arm));
  }
  vector of_rail(const vector &p) const {
    const deviation &d = scene.motion.rail;
    const vector origin = plus({0, scene.marker_y, scene.marker_z}, d.offset);
    const vector arm = plus(p, origin, -1);
    vector moved = plus(p, d.velocity, t);
    const auto turn = [&](const vector &axis, double rate, const vector &from) {
      moved = plus(moved, plus(times(about(axis, rate * t), from), from, -1));
    };
    turn(ex, d.angular_velocity[0], arm);
    turn(ez, d.angular_velocity[2], arm);
    if (scene.roller())
      turn(ey, scene.motion.roller_pitch_rate + d.angular_velocity[1],
           plus(p, {scene.axle()[0], p[1], scene.axle()[2]}, -1));
    else
      turn(ey, d.angular_velocity[1], arm);
    return moved;
  }
};

constexpr double instant = 1e-6;

template <class F>
vector velocity(const surfaces::scene &scene, F place) {
  const vector a = place(later{scene, -instant}), b = place(later{scene, instant});
  return {(b[0] - a[0]) / (2 * instant), (b[1] - a[1]) / (2 * instant),
          (b[2] - a[2]) / (2 * instant)};
}

// Angular velocity from the velocities of three points.
template <class F>
vector spin_of(F velocity_at, const vector &p) {
  vector spin{};
  const vector base = velocity_at(p);
  const vector axes[3] = {ex, ey, ez};
  for (size_t k = 0; k < 3; ++k) {
    const vector v = plus(velocity_at(plus(p, axes[k], 0.1)), base, -1);
    // half the sum of e x dv
    const size_t i = (k + 1) % 3, j = (k + 2) % 3;
    spin[i] -= 0.5 * v[j] / 0.1;
    spin[j] += 0.5 * v[i] / 0.1;
  }
  return spin;
}

TEST_P(Placement, CreepagesAreThoseOfMaterialPoints) {
  std::uniform_real_distribution<double> u(-1, 1);
  for (const double slow : {0.0, 0.5, 200.0}) {
    scene.sizes.standstill_speed = slow;
    side_geometry one(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track);
    wheel_config sizes = scene.sizes;
    sizes.one_point = false;
    side_geometry two(scene.wheel_curve, scene.rail_curve, sizes, scene.track);
    for (int n = 0; n < 80; ++n) {
      SCOPED_TRACE(testing::Message() << slow << ' ' << n);
      // velocities at one point, or of each body's surface
      const bool shared = n < 40;
      side_geometry &with = shared ? one : two;
      side_motion m = any_motion(random, scene.roller());
      // either body may be at rest in its axes, and rolling may go either way
      if (n % 3 == 1) m.wheel.velocity = m.wheel.angular_velocity = {};
      if (n % 3 == 2) m.rail.velocity = m.rail.angular_velocity = {};
      if (n % 5 == 4) m.wheel.velocity = m.rail.velocity = {};
      if (n % 7 == 3) m.wheel.angular_velocity = m.rail.angular_velocity = {};
      contact_frame f = put(m);
      scene.marker_y = side.rail_marker_y();
      scene.marker_z = side.rail_marker_z();
      with.place(scene.motion);
      if (n % 2) f.inclination = 0.03 * u(random);
      const double depth = 4e-5;
      const surfaces::frame axes(f);
      vector on_wheel = plus(axes.origin, axes.n, depth), on_rail = axes.origin;
      if (shared) {
        const double reach =
            std::hypot(f.origin[0] - scene.axle()[0], f.origin[2] - scene.axle()[2]);
        const double wheel_radius = with.rolling_radius(f, depth);
        const double below = scene.roller() ? depth * reach / (reach + wheel_radius) : depth;
        EXPECT_NEAR(with.contact_depth(f, depth), below, 1e-18);
        on_wheel = on_rail = plus(axes.origin, axes.n, below);
      } else {
        EXPECT_EQ(with.contact_depth(f, depth), 0);
      }
      const auto at = [&](auto &&place, const vector &p) {
        return velocity(scene, [&](const later &l) { return place(l, p); });
      };
      const auto carried = [](const later &l, const vector &p) { return l.carried(p); };
      const auto rolled = [](const later &l, const vector &p) { return l.rolled(p); };
      const auto rail = [](const later &l, const vector &p) { return l.of_rail(p); };
      const vector c = at(carried, on_wheel), r = at(rolled, on_wheel), b = at(rail, on_rail);
      const vector slip = plus(plus(c, r), b, -1);
      vector spin{};
      spin = plus(spin, spin_of([&](const vector &p) { return at(carried, p); }, on_wheel));
      spin = plus(spin, spin_of([&](const vector &p) { return at(rolled, p); }, on_wheel));
      spin = plus(spin, spin_of([&](const vector &p) { return at(rail, p); }, on_wheel), -1);
      // of the speeds with which the contact runs over rail and wheel
      const double over_rail = scene.roller() ? -b[0] : c[0] - b[0];
      const double over_wheel = scene.roller() ? c[0] + r[0] : r[0];
      const double mean = 0.5 * (std::fabs(over_rail) + std::fabs(over_wheel));
      const double heading = 0.5 * (over_rail - over_wheel);
      const double divisor = mean < slow ? (mean * mean + slow * slow) / (2 * slow) : mean;
      const double h = std::fabs(heading);
      const double share =
          h < slow ? h * (3 * slow * slow - h * h) / (2 * slow * slow * slow) : 1.0;
      const creepage_state found = with.creepages(f, depth);
      EXPECT_NEAR(found.rolling_speed, divisor, 1e-7 * divisor);
      EXPECT_NEAR(found.xi, slip[0] / divisor, 1e-7);
      EXPECT_NEAR(found.eta, surfaces::product(axes.s, slip) / divisor, 1e-7);
      EXPECT_NEAR(found.phi, surfaces::product(axes.n, spin) / divisor * share, 1e-6);
      EXPECT_EQ(found.direction, heading > 0 ? 1 : -1);
      // the axis and what turns about it
      const matrix turned = scene.wheel_axes();
      const vector arm = times(surfaces::transposed(turned),
                               plus(plus(axes.origin, axes.n, depth), scene.axis_point(), -1));
      EXPECT_NEAR(with.rolling_radius(f, depth), std::hypot(arm[0], arm[2]), 1e-14);
      for (size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(with.lever(f)[k], axes.origin[k] - scene.centre()[k], 1e-15);
    }
  }
}

// Of the wheelset with its pitch, at any angles: from where points of it go.
TEST(WheelsetMotion, AngularVelocityIsThatOfItsPoints) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int n = 0; n < 20; ++n) {
    wheelset_state w;
    w.roll = u(random), w.yaw = u(random);
    w.roll_rate = u(random), w.yaw_rate = u(random), w.pitch_rate = 3 * u(random);
    const auto place = [&](double t, const vector &p) {
      const matrix axes =
          times(about(ex, w.roll + w.roll_rate * t), about(ez, w.yaw + w.yaw_rate * t));
      return times(axes, times(about(ey, w.pitch_rate * t), p));
    };
    const vec3 spin = angular_velocity(w);
    for (const vector &p : {ex, ey, ez}) {
      const vector ahead = place(instant, p), behind = place(-instant, p);
      const vec3 expected = cross(spin, place(0, p));
      for (size_t k = 0; k < 3; ++k)
        EXPECT_NEAR((ahead[k] - behind[k]) / (2 * instant), expected[k], 1e-9);
    }
  }
}

TEST_P(Placement, StandstillHasNoDirection) {
  contact_frame f = put(side_motion{});
  const creepage_state none = side.creepages(f, deep);
  EXPECT_EQ(none.direction, 0);
  EXPECT_EQ(none.rolling_speed, 0);
  EXPECT_EQ(none.xi, 0);
  EXPECT_EQ(none.eta, 0);
  EXPECT_EQ(none.phi, 0);
  // both surfaces with the same speed do not roll: the way of the contact over the rail counts
  scene.sizes.standstill_speed = 1;
  side_geometry slow(scene.wheel_curve, scene.rail_curve, scene.sizes, scene.track);
  side_motion m;
  m.wheelset.vy = 0.2;
  slow.place(m);
  const creepage_state aside = slow.creepages(f, 0);
  EXPECT_EQ(aside.direction, 0);
  EXPECT_EQ(aside.rolling_speed, 0.5);
  EXPECT_NEAR(aside.eta, 0.4 * std::cos(f.contact_angle), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Tracks, Placement, testing::Values(track_kind::rail, track_kind::roller),
                         [](const auto &info) {
                           return std::string(info.param == track_kind::rail ? "rail" : "roller");
                         });

TEST(Mirror, ChangesTheSignsOfWhatLooksAside) {
  const side_motion m{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10},
                      {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}},
                      {{-1, -2, -3}, {-4, -5, -6}, {-7, -8, -9}, {-10, -11, -12}},
                      13};
  const side_motion r = mirrored(m);
  const wheelset_state &w = r.wheelset;
  EXPECT_EQ((std::array{w.y, w.z, w.roll, w.yaw, w.speed, w.vy, w.vz, w.roll_rate, w.yaw_rate,
                        w.pitch_rate}),
            (std::array{-1., 2., -3., -4., 5., -6., 7., -8., -9., 10.}));
  EXPECT_EQ(r.wheel.offset, (vec3{1, -2, 3}));
  EXPECT_EQ(r.wheel.rotation, (vec3{-4, 5, -6}));
  EXPECT_EQ(r.wheel.velocity, (vec3{7, -8, 9}));
  EXPECT_EQ(r.wheel.angular_velocity, (vec3{-10, 11, -12}));
  EXPECT_EQ(r.rail.offset, (vec3{-1, 2, -3}));
  EXPECT_EQ(r.rail.angular_velocity, (vec3{10, -11, 12}));
  EXPECT_EQ(r.roller_pitch_rate, 13);
  EXPECT_EQ(mirrored(track_config{track_kind::rail, 1, 2, 3, 4, 5}).curvature, -4);
  EXPECT_EQ(mirrored(track_config{track_kind::rail, 1, 2, 3, 4, 5}).cant, 3);
  const contact_frame f = mirrored(contact_frame{{1, 2, 3}, 4, 5});
  EXPECT_EQ(f.origin, (vec3{1, -2, 3}));
  EXPECT_EQ(f.contact_angle, -4);
  EXPECT_EQ(f.inclination, 5);
  const creepage_state c = mirrored(creepage_state{1, 2, 3, 4, -1});
  EXPECT_EQ((std::array{c.xi, c.eta, c.phi, c.rolling_speed}), (std::array{1., -2., -3., 4.}));
  EXPECT_EQ(c.direction, -1);
}

}  // namespace
