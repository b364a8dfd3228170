// The curved reference surface: its elastic operator against sums of turned vectors, its curve and
// undeformed distance against circles, the plane as its limit, and turned surroundings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "half_space/conformal_coupling.hpp"
#include "half_space/offset_influence.hpp"
#include "normal/normal.hpp"
#include "patch/conformal_rows.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;
using field = std::vector<double>;
using vector3 = std::array<double, 3>;

constexpr double imposed = 1e-12;  // relative to the greatest value

// --- elasticity --------------------------------------------------------------------------------

const double shear_modulus[] = {82e9, 82e9}, poisson_ratio[] = {0.28, 0.28};

// An arc of rows that turns by `span`, with random tractions on it.
struct arc {
  grid g{9, 11, 7e-4, 5e-4, -2.8e-3, -2.5e-3};
  field cosine, sine, angle;
  fft_plans plans{{smooth_size(2 * 9 + 1)}, {smooth_size(2 * 11 - 1)}};
  influence a;
  field px, py, pn;

  static influence::medium elastic(double layer) {
    influence::medium s{combine(shear_modulus, poisson_ratio), layer};
    s.curved = true;
    return s;
  }
  arc(double span, double layer, unsigned seed) : a(elastic(layer), plans) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int j = 0; j < g.ny; ++j) {
      const double t = static_cast<double>(j) / (g.ny - 1) - 0.4;
      angle.push_back(span * (t + 0.3 * t * t));
      cosine.push_back(std::cos(angle.back()));
      sine.push_back(std::sin(angle.back()));
    }
    for (auto *f : {&px, &py, &pn})
      for (int i = 0; i < g.count(); ++i) f->push_back(1e8 * u(random));
    a.set_grid(g);
    a.set_rows(cosine.data(), sine.data());
  }

  // Displacement in observer i of row k from the traction vector t (x, s, n) in element j of row l:
  // the mean of half-spaces along the source's and along the observer's surface. `ahead`: elements
  // that it is seen from further along x.
  vector3 displacement(int i, int k, int j, int l, const vector3 &t, int ahead) const {
    const auto half_space = [&](const vector3 &p) {
      const int x = i - j + ahead, y = k - l;
      const double xx = a.coefficient(kernel::xx, x, y), yy = a.coefficient(kernel::yy, x, y);
      const double xy = a.coefficient(kernel::xy, x, y), zz = a.coefficient(kernel::zz, x, y);
      return vector3{xx * p[0] + xy * p[1], xy * p[0] + yy * p[1], zz * p[2]};
    };
    const double d = angle[static_cast<size_t>(k)] - angle[static_cast<size_t>(l)];
    // s_l = cos d s_k - sin d n_k, n_l = sin d s_k + cos d n_k
    const auto turned = [&](const vector3 &v) {
      return vector3{v[0], std::cos(d) * v[1] + std::sin(d) * v[2],
                     -std::sin(d) * v[1] + std::cos(d) * v[2]};
    };
    const vector3 along_source = turned(half_space(t)), along_observer = half_space(turned(t));
    vector3 mean;
    for (size_t c = 0; c < 3; ++c) mean[c] = 0.5 * (along_source[c] + along_observer[c]);
    return mean;
  }

  // From tractions and pressure, which pushes along -n, [3][ny][nx].
  std::array<field, 3> sum(bool tractions, bool pressure, int ahead = 0) const {
    std::array<field, 3> u;
    for (field &f : u) f.assign(static_cast<size_t>(g.count()), 0.0);
    for (int k = 0; k < g.ny; ++k)
      for (int i = 0; i < g.nx; ++i)
        for (int l = 0; l < g.ny; ++l)
          for (int j = 0; j < g.nx; ++j) {
            const auto from = static_cast<size_t>(l * g.nx + j);
            const vector3 t{tractions ? px[from] : 0, tractions ? py[from] : 0,
                            pressure ? -pn[from] : 0};
            const vector3 v = displacement(i, k, j, l, t, ahead);
            for (size_t c = 0; c < 3; ++c) u[c][static_cast<size_t>(k * g.nx + i)] += v[c];
          }
    return u;
  }
  field zero() const { return field(static_cast<size_t>(g.count())); }
};

void expect_near(const field &a, const field &b, double tolerance, const char *what) {
  double scale = 0;
  for (double v : b) scale = std::max(scale, std::abs(v));
  ASSERT_EQ(a.size(), b.size()) << what;
  for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance * scale) << what;
}

TEST(ConformalInfluence, ProductsAreSumsOfTurnedVectors) {
  for (double span : {0.0, 0.2, 1.2}) {
    for (double layer : {0.0, 3e-14}) {
      arc c(span, layer, 7);
      field u = c.zero(), v = c.zero(), gap = c.zero();
      const auto from_pressure = c.sum(false, true), from_traction = c.sum(true, false);
      field parted = from_pressure[2];
      for (double &value : parted) value = -value;
      c.a.normal_product(c.pn.data(), u.data());
      expect_near(u, parted, imposed, "gap from pressure");
      c.a.normal_product_single(c.pn.data(), u.data());
      expect_near(u, parted, 1e-5, "gap from pressure, single");
      c.a.tangential_product(c.px.data(), c.py.data(), u.data(), v.data());
      expect_near(u, from_traction[0], imposed, "x from traction");
      expect_near(v, from_traction[1], imposed, "s from traction");
      if (span == 0) continue;
      conformal_coupling coupling(c.a, c.g.count());
      coupling.set_grid(c.g);
      coupling.from_traction(c.px.data(), c.py.data(), gap.data());
      field apart = from_traction[2];
      for (double &value : apart) value = -value;
      expect_near(gap, apart, imposed, "gap from traction");
      coupling.from_pressure(0.0, c.pn.data(), u.data(), v.data());
      expect_near(u, from_pressure[0], imposed, "x from pressure");
      expect_near(v, from_pressure[1], imposed, "s from pressure");
    }
  }
}

TEST(ConformalInfluence, SeesRollingFromUpstream) {
  arc c(0.8, 0.0, 8);
  field u = c.zero(), v = c.zero(), single_u = c.zero(), single_v = c.zero();
  conformal_coupling coupling(c.a, c.g.count());
  coupling.set_grid(c.g);
  const auto here = c.sum(true, false);
  for (int direction : {1, -1}) {
    const auto there = c.sum(true, false, direction), pressed = c.sum(false, true, direction);
    field sx = here[0], sy = here[1];
    for (size_t i = 0; i < sx.size(); ++i) {
      sx[i] = (sx[i] - there[0][i]) / c.g.dx;
      sy[i] = (sy[i] - there[1][i]) / c.g.dx;
    }
    c.a.rolling_product(c.px.data(), c.py.data(), direction, u.data(), v.data());
    expect_near(u, sx, 1e-11, "x");
    expect_near(v, sy, 1e-11, "s");
    c.a.rolling_product_single(c.px.data(), c.py.data(), direction, single_u.data(),
                               single_v.data());
    expect_near(single_u, sx, 1e-4, "x, single");
    expect_near(single_v, sy, 1e-4, "s, single");
    coupling.from_pressure(direction * c.g.dx, c.pn.data(), u.data(), v.data());
    expect_near(u, pressed[0], imposed, "x from pressure");
    expect_near(v, pressed[1], imposed, "s from pressure");
  }
}

// Maxwell and Betti: the work of one state's tractions on the other's displacements is mutual; and
// the work of any state on its own is positive.
TEST(ConformalInfluence, IsSymmetricAndPositive) {
  for (double span : {0.3, 1.0, 1.5}) {
    arc one(span, 0.0, 1), two(span, 0.0, 2);
    const auto u_one = one.sum(true, true), u_two = two.sum(true, true);
    double forth = 0, back = 0, own = 0;
    for (size_t i = 0; i < one.px.size(); ++i) {
      forth += one.px[i] * u_two[0][i] + one.py[i] * u_two[1][i] - one.pn[i] * u_two[2][i];
      back += two.px[i] * u_one[0][i] + two.py[i] * u_one[1][i] - two.pn[i] * u_one[2][i];
      own += one.px[i] * u_one[0][i] + one.py[i] * u_one[1][i] - one.pn[i] * u_one[2][i];
    }
    EXPECT_NEAR(forth, back, imposed * own) << "span " << span;
    EXPECT_GT(own, 0) << "span " << span;
  }
}

// Love 1929, the normal displacement of a uniform pressure on an element at (x, y).
double pressed(const grid &g, double x, double y) {
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const double u = x + (k & 1 ? -0.5 : 0.5) * g.dx, v = y + (k & 2 ? -0.5 : 0.5) * g.dy;
    const double sign = k == 0 || k == 3 ? 1.0 : -1.0;
    sum += sign * (v * std::asinh(u / std::fabs(v)) + u * std::asinh(v / std::fabs(u)));
  }
  return sum * (1 - poisson_ratio[0]) / (pi * shear_modulus[0]);
}

// From rows of one curve to those of another, which lie elsewhere: the same sums of turned vectors;
// work of either state's tractions on the other's displacements is mutual.
TEST(ConformalInfluence, MovesFromOneCurveToAnother) {
  arc last(0.9, 0.0, 3), now(0.5, 0.0, 4);
  const double offset[2] = {0.37 * now.g.dx, -1.6 * now.g.dy}, share = 0.75;
  offset_influence moved(last.plans, true);
  const curved_past past{last.px.data(),
                         last.py.data(),
                         last.pn.data(),
                         {last.cosine.data(), now.cosine.data()},
                         {last.sine.data(), now.sine.data()}};
  field t[2] = {now.zero(), now.zero()}, p[2] = {now.zero(), now.zero()}, gap = now.zero();
  moved.add_curved(now.a, last.g, now.g, offset, share, past,
                   {{t[0].data(), t[1].data()}, {p[0].data(), p[1].data()}, gap.data()});
  field u[2] = {now.zero(), now.zero()}, v[2] = {now.zero(), now.zero()}, apart = now.zero();
  for (int k = 0; k < now.g.ny; ++k)
    for (int i = 0; i < now.g.nx; ++i)
      for (int l = 0; l < last.g.ny; ++l)
        for (int j = 0; j < last.g.nx; ++j) {
          const double x = offset[0] + (i - j) * now.g.dx, y = offset[1] + (k - l) * now.g.dy;
          double a[3];
          now.a.bodies_at(x, y, a);
          const double n = pressed(now.g, x, y);
          const double d = now.angle[static_cast<size_t>(k)] - last.angle[static_cast<size_t>(l)];
          const double c = std::cos(d), s = std::sin(d);
          const auto from = static_cast<size_t>(l * last.g.nx + j);
          const auto to = static_cast<size_t>(k * now.g.nx + i);
          const double px = share * last.px[from], ps = share * last.py[from];
          const double pressure = share * last.pn[from];
          u[0][to] += a[0] * px + 0.5 * (1 + c) * a[2] * ps;
          u[1][to] += 0.5 * (1 + c) * a[2] * px + c * a[1] * ps;
          v[0][to] -= 0.5 * s * a[2] * pressure;
          v[1][to] -= 0.5 * s * (a[1] + n) * pressure;
          apart[to] += 0.5 * s * (a[2] * px + (a[1] + n) * ps);
        }
  for (int c = 0; c < 2; ++c) {
    expect_near(t[c], u[c], imposed, "from traction");
    expect_near(p[c], v[c], imposed, "from pressure");
  }
  expect_near(gap, apart, imposed, "gap");
}

// --- geometry ----------------------------------------------------------------------------------

// A rail head of radius `rail` under a wheel tread of radius `wheel` (> 0 hollow), their arcs' ends
// inclined by `angle`, on a track that is turned about x as a whole by `turn`.
struct pair_of_arcs {
  profiles::curve wheel_curve, rail_curve;
  std::unique_ptr<profile> wheel, rail;
  std::unique_ptr<side_geometry> side;
  double rail_radius, wheel_radius;
  static constexpr double radius = 0.46;

  // tilt: of the rail's arc about its crown, so that contact is at its side
  pair_of_arcs(double rail_arc, double wheel_arc, double angle, double tilt)
      : rail_radius(rail_arc), wheel_radius(wheel_arc) {
    // a knot at the origin, so that it lies on the circle
    const double side_sign = wheel_arc > 0 ? 1 : -1;
    profiles::pen r(tilt - angle), w(tilt - side_sign * angle);
    r.turn_to(tilt, rail_arc);
    w.turn_to(tilt, std::fabs(wheel_arc));
    const double origin[] = {r.y(), w.y()};
    r.turn_to(tilt + angle, rail_arc);
    w.turn_to(tilt + side_sign * angle, std::fabs(wheel_arc));
    rail_curve = r.moved_to_origin(origin[0]);
    wheel_curve = w.moved_to_origin(origin[1]);
    wheel = std::make_unique<profile>(view(wheel_curve));
    rail = std::make_unique<profile>(view(rail_curve));
    side = std::make_unique<side_geometry>(*wheel, *rail, wheel_config{radius, 1.36, 0.0},
                                           track_config{track_kind::rail, 1.435, 0.05, 0, 0, 0});
  }
  static profile_view view(const profiles::curve &c) {
    return {c.s.data(),  c.y.data(),  c.z.data(),
            c.dy.data(), c.dz.data(), static_cast<int>(c.s.size())};
  }
  // Both origins above each other, the wheel lowered by `depth`.
  side_motion above(double depth) const {
    side_motion m;
    m.wheelset.y = side->rail_marker_y() - 0.68;
    m.wheelset.z = side->rail_marker_z() + depth;
    m.wheelset.speed = 20;
    m.wheelset.pitch_rate = -20.1 / radius;
    m.wheelset.vy = 0.05;
    m.wheelset.yaw_rate = 0.02;
    return m;
  }
  // The same turned by an angle about the track's origin.
  side_motion turned(side_motion m, double angle) const {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](double &y, double &z) {
      const double was = y;
      y = c * was - s * z;
      z = s * was + c * z;
    };
    double z = m.wheelset.z - radius;
    turn(m.wheelset.y, z);
    m.wheelset.z = z + radius;
    turn(m.wheelset.vy, m.wheelset.vz);
    m.wheelset.roll = angle;
    m.rail.rotation[0] = angle;
    double y_marker = side->rail_marker_y(), z_marker = side->rail_marker_z();
    turn(y_marker, z_marker);
    m.rail.offset = {0, y_marker - side->rail_marker_y(), z_marker - side->rail_marker_z()};
    return m;
  }
};

// Where a line from (y, z) along n = (-sin, cos) of the angle meets a circle, the near side of it.
double to_circle(double y, double z, double angle, double cy, double cz, double radius) {
  const double dy = y - cy, dz = z - cz, ny = -std::sin(angle), nz = std::cos(angle);
  const double b = dy * ny + dz * nz, c = dy * dy + dz * dz - radius * radius;
  const double root = std::sqrt(b * b - c);
  return std::fabs(-b + root) < std::fabs(-b - root) ? -b + root : -b - root;
}

// of cubic Hermite interpolation of a circle of 13 mm at points 0.5 mm apart: h^4 k^3/384, and of
// its angle (h k)^3/125
constexpr double point_error = 1e-10, angle_error = 5e-7;

// A rail of 13 mm in a hollow of 16 mm, at an inclination of 40 degrees: the curve has equal
// distances to both circles and their mean angle, its rows are equally spaced, and the points found
// on the wheel lie on its surface of revolution.
TEST(ConformalRows, LieMidwayBetweenCircles) {
  const double tilt = -40 * pi / 180, depth = 8e-5;
  pair_of_arcs arcs(0.013, 0.016, 0.6, tilt);
  const side_motion m = arcs.above(depth);
  arcs.side->place(m);
  part_set parts;
  patch_region region;
  const search_result found = find_patches(*arcs.side, patch_rules{}, parts, &region, 1);
  ASSERT_EQ(found.status, search_status::contact);
  conformal_rows rows(40);
  const double s_min = region.s_min;
  ASSERT_TRUE(rows.begin(*arcs.side, region));
  // an arc is longer than its chord
  EXPECT_LT(region.s_min, s_min);
  const grid g{15, 30, 5e-4, (region.s_max - region.s_min) / 28, -3.5e-3, region.s_min};
  std::vector<double> h(static_cast<size_t>(g.count()));
  rows.place(*arcs.side, g, h.data());
  const double y = arcs.side->rail_marker_y(), z = arcs.side->rail_marker_z();
  // centres: both profiles have the angle `tilt` at their origins
  const double rail_centre[] = {y - 0.013 * std::sin(tilt), z + 0.013 * std::cos(tilt)};
  const double wheel_centre[] = {y - 0.016 * std::sin(tilt), z + depth + 0.016 * std::cos(tilt)};
  EXPECT_GT(rows.angle(29) - rows.angle(0), 0.4);
  for (int j = 0; j < g.ny; ++j) {
    const double a = rows.angle(j);
    const double up = to_circle(rows.y(j), rows.z(j), a, rail_centre[0], rail_centre[1], 0.013);
    const double down = to_circle(rows.y(j), rows.z(j), a, wheel_centre[0], wheel_centre[1], 0.016);
    EXPECT_NEAR(up + down, 0, 2 * point_error) << "row " << j;
    // the angle of a circle is that of the radius to the point
    const auto circle_angle = [&](const double *centre, double height) {
      const double py = rows.y(j) - height * std::sin(a) - centre[0];
      const double pz = rows.z(j) + height * std::cos(a) - centre[1];
      return std::atan2(py, -pz);
    };
    EXPECT_NEAR(a, 0.5 * (circle_angle(rail_centre, up) + circle_angle(wheel_centre, down)),
                angle_error);
    if (j > 0) {
      const double chord = std::hypot(rows.y(j) - rows.y(j - 1), rows.z(j) - rows.z(j - 1));
      const double bend = a - rows.angle(j - 1);
      EXPECT_NEAR(chord / g.dy, 1, 0.1 * bend * bend) << "row " << j;
    }
    for (int i = 0; i < g.nx; ++i) {
      const double height = up - h[static_cast<size_t>(j * g.nx + i)];
      const double wy = rows.y(j) - height * std::sin(a), wz = rows.z(j) + height * std::cos(a);
      const double x = g.x(i) + region.frame.origin[0];
      const double axle = m.wheelset.z - pair_of_arcs::radius;
      const double off_axis = std::hypot(x, wz - axle);
      EXPECT_NEAR(std::hypot(wy - wheel_centre[0], off_axis + axle - wheel_centre[1]), 0.016,
                  2 * point_error)
          << "row " << j << " column " << i;
    }
  }
}

// Turned as a whole nothing changes but the angles.
TEST(ConformalRows, TurnWithTheirSurroundings) {
  pair_of_arcs arcs(0.013, 0.016, 0.6, -0.5);
  const double by = 0.3;
  const side_motion m = arcs.above(8e-5);
  arcs.side->place(m);
  part_set parts;
  patch_region region, other;
  ASSERT_EQ(find_patches(*arcs.side, patch_rules{}, parts, &region, 1).status,
            search_status::contact);
  other = region;
  const vec3 at = region.frame.origin;
  other.frame.origin = {at[0], std::cos(by) * at[1] - std::sin(by) * at[2],
                        std::sin(by) * at[1] + std::cos(by) * at[2]};
  other.frame.contact_angle += by;
  conformal_rows rows(20), turned(20);
  ASSERT_TRUE(rows.begin(*arcs.side, region));
  const grid g{15, 20, 5e-4, (region.s_max - region.s_min) / 18, -3.5e-3, region.s_min};
  std::vector<double> h(static_cast<size_t>(g.count())), k = h;
  rows.place(*arcs.side, g, h.data());
  rows.set_slip(*arcs.side, 1e-4, 20.0);
  arcs.side->place(arcs.turned(m, by));
  ASSERT_TRUE(turned.begin(*arcs.side, other));
  EXPECT_NEAR(other.s_min, region.s_min, 1e-11);
  EXPECT_NEAR(other.s_max, region.s_max, 1e-11);
  turned.place(*arcs.side, g, k.data());
  turned.set_slip(*arcs.side, 1e-4, 20.0);
  const field unit(static_cast<size_t>(g.count()), 1e8);
  const patch_wrench w = rows.sum_tractions(g, unit.data(), unit.data(), unit.data());
  const patch_wrench v = turned.sum_tractions(g, unit.data(), unit.data(), unit.data());
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(v.force[c], w.force[c], 1e-8 * std::fabs(w.force[2]));
    EXPECT_NEAR(v.moment[c], w.moment[c], 1e-8 * std::fabs(w.force[2]) * 1e-3);
  }
  for (int j = 0; j < g.ny; ++j) {
    EXPECT_NEAR(turned.angle(j), rows.angle(j) + by, 1e-9);
    EXPECT_NEAR(turned.y(j), std::cos(by) * rows.y(j) - std::sin(by) * rows.z(j), 1e-11);
    // each row has its own radius
    EXPECT_NE(rows.slip(0, j, 0), 0);
    EXPECT_NEAR(turned.slip(0, j, 0), rows.slip(0, j, 0), 1e-10);
    EXPECT_NEAR(turned.slip(1, j, 1e-3), rows.slip(1, j, 1e-3), 1e-10);
  }
  for (size_t i = 0; i < h.size(); ++i) EXPECT_NEAR(k[i], h[i], 1e-11);
}

// --- whole wheels ------------------------------------------------------------------------------

// A wheel and a rail that are each other's image at a plane: the curve is that plane, and the
// results are the plane's, but for the search of surface points, which ends where steps of Newton's
// method are below 4e-7 m (geometry.cpp).
TEST(CurvedSurface, OfEqualBarrelsIsThePlane) {
  const profiles::curve rail = pair_of_arcs(0.3, -0.3, 0.1, 0.0).rail_curve;
  const profiles::curve wheel = pair_of_arcs(0.3, -0.3, 0.1, 0.0).wheel_curve;
  const pair_of_arcs arcs(0.3, -0.3, 0.1, 0.0);
  scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  c.cant = 0;
  c.gauge_height = 0.05;
  c.flange_back_position = 0;
  c.wheel[RP_RIGHT] = wheel.view();
  c.rail[RP_RIGHT] = rail.view();
  c.element_size[0] = c.element_size[1] = 5e-4;
  c.tolerance = 1e-12;
  for (int n = 0; n < 4; ++n) {
    const rp_tangential_method method = n % 2 ? RP_TANGENTIAL_FULL : RP_TANGENTIAL_NONE;
    c.tangential = method;
    c.patch_rule = n < 2 ? RP_PATCHES_CONTACT : RP_PATCHES_BLENDED;
    rp_input in = scenes::running(RP_RAIL);
    in.y = arcs.side->rail_marker_y() - 0.68;
    in.yaw = 0.002;
    in.pitch_rate *= 1.001;
    in.vertical_force = 8e4;
    c.reference_surface = RP_REFERENCE_PLANE;
    const rp_result flat = scenes::handle(c).step(in);
    c.reference_surface = RP_REFERENCE_CURVED;
    const rp_result curved = scenes::handle(c).step(in);
    ASSERT_EQ(flat.status, RP_CONVERGED);
    ASSERT_EQ(curved.status, RP_CONVERGED);
    const rp_side_result &a = flat.side[RP_RIGHT], &b = curved.side[RP_RIGHT];
    const double allowed = 4e-7 * 4e-7 / (2 * 0.3) / a.patch[0].approach;
    EXPECT_LT(allowed, 1e-8);
    EXPECT_NEAR(b.patch[0].max_pressure / a.patch[0].max_pressure, 1, allowed);
    EXPECT_EQ(b.patch[0].contact_area, a.patch[0].contact_area);
    EXPECT_NEAR(curved.z, flat.z, allowed * a.patch[0].approach);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(b.force[k], a.force[k], allowed * 8e4) << k;
      EXPECT_NEAR(b.moment[k], a.moment[k], allowed * 8e4) << k;
    }
    if (method == RP_TANGENTIAL_NONE) continue;
    // where pressure has its own normals, its part is in the curved surface's
    if (c.patch_rule == RP_PATCHES_CONTACT) {
      EXPECT_NEAR(b.patch[0].spin_moment, a.patch[0].spin_moment, allowed * 8e4 * 6e-3);
    }
    EXPECT_NEAR(b.patch[0].friction_power / a.patch[0].friction_power, 1, allowed);
    EXPECT_NEAR(b.patch[0].elastic_energy / a.patch[0].elastic_energy, 1, allowed);
  }
}

// Over the whole lateral range, tread to flange: solved, within the bound, friction takes power.
TEST(CurvedSurface, IsSolvedFromTreadToFlange) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
  c.reference_surface = RP_REFERENCE_CURVED;
  scenes::handle contact(c);
  int solved = 0, steps = 0;
  for (double y = -8e-3; y <= 8e-3; y += 2.5e-4, ++steps) {
    rp_input in = scenes::running(RP_RAIL);
    in.y = y;
    in.yaw = 3e-3;
    in.vertical_force = 8e4;
    const rp_result r = contact.step(in);
    solved += r.status == RP_CONVERGED;
    EXPECT_NE(r.status, RP_NO_CONTACT) << y;
    for (int k = 0; k < r.side[RP_RIGHT].patch_count; ++k) {
      const rp_patch_result &p = r.side[RP_RIGHT].patch[k];
      if (p.status != RP_CONVERGED) continue;
      EXPECT_GE(p.friction_power, 0) << y;
      EXPECT_GT(p.elastic_energy, 0) << y;
    }
  }
  EXPECT_EQ(solved, steps);
}

// A ball of 10 mm in grooves, rolling freely (the deep grooves of Li 2002), against the program
// CONTACT (Vtech CMCC, open source version of 2023, its example groove_li: curved reference
// surface, 10 kN, wheel radius 420 mm, friction 0.3, G = 80 GPa, nu = 0.28, elements of 0.0958 by
// 0.25 mm). It has half-space coefficients of the arc length alone, and others fitted to finite
// elements of such bodies (Blanco-Lorenzo). Signs and rates are ours.
struct rolling_state {
  double pitch_rate;          // rad/s, of free rolling
  double approach, pressure;  // m, Pa
  int elements;               // in contact
  double energy, power;       // J, W
};
struct groove {
  double radius;      // m
  double last_angle;  // degrees, of the outermost row in contact, with half-spaces
  rolling_state half_space, fitted;
};
constexpr groove grooves[] = {
    {10.25e-3,
     15.56,
     {-1.0002301, 2.237e-5, 530.2e6, 1187, 8.958e-2, 8.395e-2},
     {-1.0002342, 2.224e-5, 527.4e6, 1199, 9.029e-2, 8.402e-2}},
    {10.10e-3,
     24.23,
     {-1.0004411, 1.939e-5, 409.3e6, 1559, 7.848e-2, 0.3018},
     {-1.0004586, 1.911e-5, 405.9e6, 1569, 7.887e-2, 0.3113}},
    {10.05e-3,
     31.43,
     {-1.0006495, 1.743e-5, 348.7e6, 1843, 7.171e-2, 0.6444},
     {-1.0006824, 1.700e-5, 344.9e6, 1867, 7.146e-2, 0.6789}},
    {10.02e-3,
     42.93,
     {-1.0009761, 1.541e-5, 296.8e6, 2265, 6.552e-2, 1.389},
     {-1.0010425, 1.476e-5, 292.0e6, 2317, 6.398e-2, 1.519}},
};

struct groove_profiles {
  static constexpr double end = 1.3;  // rad, inclination of the arcs' ends
  profiles::curve rail, wheel;

  explicit groove_profiles(double radius) {
    profiles::pen r(end), w(end);
    r.turn_to(0, radius);
    w.turn_to(0, 0.010);
    const double origin[] = {r.y(), w.y()};
    r.turn_to(-end, radius);
    w.turn_to(-end, 0.010);
    rail = r.moved_to_origin(origin[0]);
    wheel = w.moved_to_origin(origin[1]);
  }
};
constexpr double groove_dx = 0.095833e-3, groove_dy = 0.25e-3;

// The curve, its normals and the undeformed distance along them: with half-space coefficients of
// the arc length alone the normal problem is CONTACT's, to the four digits that it prints.
TEST(ConformalRows, OfGroovesAreThoseOfContact) {
  const double g_steel[] = {80e9, 80e9};
  for (const groove &one : grooves) {
    const rolling_state &peer = one.half_space;
    const groove_profiles curves(one.radius);
    const profile wheel(pair_of_arcs::view(curves.wheel)), rail(pair_of_arcs::view(curves.rail));
    side_geometry side(wheel, rail, {0.42, 1.36, 0.0}, {track_kind::rail, 1.435, 0.014, 0, 0, 0});
    side_motion m;
    m.wheelset.y = side.rail_marker_y() - 0.68;
    m.wheelset.z = side.rail_marker_z() + peer.approach;
    side.place(m);
    part_set parts;
    patch_region region;
    ASSERT_EQ(find_patches(side, patch_rules{}, parts, &region, 1).status, search_status::contact);
    conformal_rows rows(101);
    ASSERT_TRUE(rows.begin(side, region));
    const grid g{141, 101, groove_dx, groove_dy, -70 * groove_dx, -50 * groove_dy};
    std::vector<double> h(static_cast<size_t>(g.count())), p = h;
    rows.place(side, g, h.data());
    const fft_plans plans({smooth_size(2 * g.nx + 1)}, {smooth_size(2 * g.ny - 1)});
    influence flat({combine(g_steel, poisson_ratio), 0.0, 0.0, false}, plans);
    flat.set_grid(g);
    normal_solver solver(g.count());
    const normal_result n = solver.with_approach(flat, g, h.data(), 0.0, {1e-7, 200}, p.data());
    ASSERT_TRUE(n.converged);
    EXPECT_NEAR(*std::max_element(p.begin(), p.end()) / peer.pressure, 1, 1e-3) << one.radius;
    EXPECT_NEAR(n.contact_count, peer.elements, 0.005 * peer.elements) << one.radius;
    int last = g.ny - 1;
    while (*std::max_element(p.begin() + last * g.nx, p.begin() + (last + 1) * g.nx) <= 0) --last;
    EXPECT_NEAR(-rows.angle(last) * 180 / pi, one.last_angle, 0.01) << one.radius;
  }
}

// With inclination the result moves from half-spaces towards the coefficients of finite elements.
TEST(CurvedSurface, OfGroovesIsNearFiniteElements) {
  for (const groove &one : grooves) {
    if (scenes::sanitized && &one != grooves) break;
    const rolling_state &peer = one.fitted;
    const groove_profiles curves(one.radius);
    const scenes::profile_pair pair;
    rp_config c = scenes::wheels(RP_WHEEL_RAIL, RP_RAIL, pair);
    c.wheel[RP_RIGHT] = curves.wheel.view();
    c.rail[RP_RIGHT] = curves.rail.view();
    c.reference_surface = RP_REFERENCE_CURVED;
    c.cant = 0;
    c.nominal_radius = 0.42;
    c.flange_back_position = 0;
    c.shear_modulus[0] = c.shear_modulus[1] = 80e9;
    c.element_size[0] = groove_dx;
    c.element_size[1] = groove_dy;
    c.max_elements[0] = 160;
    c.max_elements[1] = 100;
    rp_input in = scenes::running(RP_RAIL);
    // the groove's gauge face is the end of its arc
    in.y =
        0.5 * c.gauge + one.radius * std::sin(groove_profiles::end) - 0.5 * c.flange_back_distance;
    in.speed = 0.42;
    in.pitch_rate = peer.pitch_rate;
    in.vertical_force = 1e4;
    scenes::handle contact(c);
    const rp_result result = contact.step(in);
    ASSERT_EQ(result.status, RP_CONVERGED);
    const rp_patch_result &p = result.side[RP_RIGHT].patch[0];
    const std::string where = std::to_string(one.radius);
    EXPECT_NEAR(p.approach / peer.approach, 1, 0.012) << where;
    EXPECT_NEAR(p.max_pressure / peer.pressure, 1, 0.03) << where;
    EXPECT_NEAR((p.elements[1] + p.elements[2]) / static_cast<double>(peer.elements), 1, 0.02);
    EXPECT_NEAR(p.elastic_energy / peer.energy, 1, 0.012) << where;
    EXPECT_NEAR(p.creep_force[0], 0, 0.03 * 0.3 * 1e4) << where;
    // CONTACT's power is traction times micro-slip
    const field t = contact.field(RP_RIGHT, 0, RP_FIELD_TRACTION);
    const field s = contact.field(RP_RIGHT, 0, RP_FIELD_MICRO_SLIP);
    double power = 0;
    for (size_t i = 0; i < t.size(); ++i)
      power -= t[i] * s[i] * p.rolling_speed * groove_dx * groove_dy;
    EXPECT_NEAR(power / peer.power, 1, 0.1) << where;
  }
}

}  // namespace
