// Stresses below the surface against closed forms of Johnson 1985, against point loads by
// quadrature, and by the balance of forces on deep planes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "half_space/below_kernels.hpp"
#include "half_space/stress_measures.hpp"
#include "scenes.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;
using field = std::vector<double>;

class subsurface_of {
 public:
  subsurface_of(const rp_contact *contact, const field &depths, bool displacements = false)
      : contact_(contact) {
    rp_subsurface_config config;
    rp_default_subsurface(&config);
    config.depth = depths.data();
    config.depth_count = static_cast<int32_t>(depths.size());
    config.displacements = displacements;
    rp_message message{};
    EXPECT_EQ(rp_create_subsurface(contact, &config, &below_, &message), RP_OK) << message.text;
  }
  ~subsurface_of() { rp_destroy_subsurface(below_); }
  subsurface_of(const subsurface_of &) = delete;
  subsurface_of &operator=(const subsurface_of &) = delete;

  void solve(int body, int side = RP_RIGHT) {
    rp_message message{};
    EXPECT_EQ(rp_solve_subsurface(below_, contact_, side, 0, body, &message), RP_OK)
        << message.text;
  }
  field get(rp_subsurface_field name) const {
    size_t count = 0;
    EXPECT_EQ(rp_get_subsurface_field(below_, name, nullptr, &count), RP_ERROR_SIZE);
    field values(count);
    EXPECT_EQ(rp_get_subsurface_field(below_, name, values.data(), &count), RP_OK);
    return values;
  }
  rp_subsurface *get() const { return below_; }

 private:
  const rp_contact *contact_;
  rp_subsurface *below_ = nullptr;
};

rp_config patch_case(int elements) {
  rp_config c;
  rp_default_config(&c);
  c.kind = RP_PATCH;
  c.geometry = RP_SEMI_AXES;
  c.semi_axes[0] = c.semi_axes[1] = 4e-3;
  c.elements[0] = c.elements[1] = elements;
  for (int b = 0; b < 2; ++b) c.shear_modulus[b] = 82e9, c.poisson_ratio[b] = 0.3;
  c.normal = RP_NORMAL_HERTZ;
  c.regime = RP_STEADY_ROLLING;
  c.tangential = RP_TANGENTIAL_FULL;
  c.friction_coefficient = 0.3;
  return c;
}

rp_input loaded(double force, double creepage) {
  rp_input in;
  rp_default_input(&in);
  in.normal_force = force;
  in.rolling_speed = 20;
  in.creepage[0] = creepage;
  return in;
}

// Stress under a point load into the body at the origin, per load, from its radial and hoop
// stresses (Johnson 1985, eqs. 3.20).
stress_tensor boussinesq(double x, double y, double z, double nu) {
  const double r = std::hypot(x, y), d = std::hypot(r, z), n = 1 - 2 * nu;
  const double d3 = d * d * d, d5 = d3 * d * d, flat = (1 - z / d) / (r * r);
  const double radial = n * flat - 3 * z * r * r / d5, hoop = -n * (flat - z / d3);
  const double c = x / r, s = y / r;
  stress_tensor found{radial * c * c + hoop * s * s, radial * s * s + hoop * c * c,
                      -3 * z * z * z / d5,           (radial - hoop) * c * s,
                      -3 * y * z * z / d5,           -3 * x * z * z / d5};
  for (double &part : found) part /= 2 * pi;
  return found;
}

}  // namespace

TEST(Subsurface, FollowsPointLoads) {
  const body_constants body{80e9, 0.28};
  const double size[2] = {1e-3, 2e-3}, x = 0.7e-3, y = -1.3e-3, z = 0.9e-3;
  const below_coefficients found = below_rectangle(body, size, x, y, z);
  stress_tensor sum{};
  constexpr int n = 200;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const stress_tensor s = boussinesq(x - size[0] * ((i + 0.5) / n - 0.5),
                                         y - size[1] * ((j + 0.5) / n - 0.5), z, 0.28);
      for (size_t c = 0; c < 6; ++c) sum[c] += s[c] * size[0] * size[1] / (n * n);
    }
  // the midpoint rule's error: a 24th of a cell squared times second derivatives, which are some
  // stress over the depth squared
  for (size_t c = 0; c < 6; ++c)
    EXPECT_NEAR(found[static_cast<size_t>(below::at(below::p, static_cast<int>(c)))], sum[c], 4e-6)
        << c;
}

// Hooke's law between stresses and displacements, and the balance of forces in the body, of each
// load by itself.
TEST(Subsurface, IsElasticAndInBalance) {
  const body_constants body{80e9, 0.3};
  const double size[2] = {1e-3, 1.5e-3}, h = 1e-7;
  const double lame = 2 * body.shear_modulus * body.poisson_ratio / (1 - 2 * body.poisson_ratio);
  const int index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  for (const auto &at : {std::array{0.3e-3, -0.9e-3, 0.4e-3}, std::array{-2e-3, 0.2e-3, 1e-3}}) {
    double slope[below::loads][below::components][3];
    for (int d = 0; d < 3; ++d) {
      auto up = at, down = at;
      up[static_cast<size_t>(d)] += h;
      down[static_cast<size_t>(d)] -= h;
      const auto a = below_rectangle(body, size, up[0], up[1], up[2]);
      const auto b = below_rectangle(body, size, down[0], down[1], down[2]);
      for (int l = 0; l < below::loads; ++l)
        for (int c = 0; c < below::components; ++c) {
          const auto k = static_cast<size_t>(below::at(l, c));
          slope[l][c][d] = (a[k] - b[k]) / (2 * h);
        }
    }
    const auto found = below_rectangle(body, size, at[0], at[1], at[2]);
    for (int l = 0; l < below::loads; ++l) {
      const auto *s = slope[l];
      const auto *u = s + below::ux;
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(s[index[i][0]][0] + s[index[i][1]][1] + s[index[i][2]][2], 0, 1e-6 / 1e-3);
        for (int j = 0; j < 3; ++j) {
          const double strain = body.shear_modulus * (u[i][j] + u[j][i]);
          const double volume = i == j ? lame * (u[0][0] + u[1][1] + u[2][2]) : 0.0;
          EXPECT_NEAR(found[static_cast<size_t>(below::at(l, index[i][j]))], strain + volume, 1e-6);
        }
      }
    }
  }
}

// Johnson 1985, sections 4.2 and 3.4: 0.310 p0 at 0.48 a, and on the axis the stresses themselves.
TEST(Subsurface, BelowACircle) {
  rp_config c = patch_case(48);
  c.regime = RP_REGIME_NONE;
  c.normal = RP_NORMAL_HALF_SPACE;
  c.tangential = RP_TANGENTIAL_NONE;
  scenes::handle contact(c);
  const rp_result r = contact.step(loaded(1e5, 0));
  ASSERT_EQ(r.status, RP_CONVERGED);
  const double a = 4e-3, p0 = 1.5 * 1e5 / (pi * a * a), nu = 0.3;
  field points;
  for (int k = 1; k <= 120; ++k) points.insert(points.end(), {0.0, 0.0, 0.01 * k * a});
  field values(9 * 120);
  ASSERT_EQ(rp_stress_at(contact.get(), RP_RIGHT, 0, RP_BODY_RAIL, points.data(), 120,
                         values.data(), nullptr),
            RP_OK);
  double most = 0, where = 0;
  for (size_t k = 0; k < 120; ++k) {
    const double *s = values.data() + 9 * k, z = points[3 * k + 2] / a;
    const double radial = -p0 * ((1 + nu) * (1 - z * std::atan(1 / z)) - 0.5 / (1 + z * z));
    EXPECT_NEAR(s[0], radial, 0.01 * p0) << z;
    EXPECT_NEAR(s[2], -p0 / (1 + z * z), 0.01 * p0) << z;
    const double shear = greatest_shear({s[0], s[1], s[2], s[3], s[4], s[5]});
    if (shear > most) most = shear, where = z;
  }
  EXPECT_NEAR(most / p0, 0.310, 0.003);
  EXPECT_NEAR(where, 0.48, 0.02);
}

// A sliding line contact: McEwen's stresses under p and under q = mu p (Johnson 1985, eqs. 4.49,
// 4.50 and section 7.1), whose greatest shear without friction is 0.300 p0 at 0.786 a.
TEST(Subsurface, BelowALine) {
  for (const double friction : {0.0, 0.3}) {
    rp_config c = patch_case(240);
    c.geometry = RP_LINE_CONTACT;
    c.line_contact_radius = 0.5;
    c.width = 1.0;
    c.elements[1] = 1;
    c.normal = RP_NORMAL_HALF_SPACE;
    c.friction_coefficient = friction;
    scenes::handle contact(c);
    const double force = 1e6, modulus = c.shear_modulus[0] / (1 - c.poisson_ratio[0]);
    const double a = std::sqrt(4 * force * 0.5 / (pi * modulus)), p0 = 2 * force / (pi * a);
    // all slides back on the wheel, and forwards on the rail
    const rp_result r = contact.step(loaded(force, 0.1));
    ASSERT_EQ(r.status, RP_CONVERGED);
    const double q0 = -r.side[RP_RIGHT].patch[0].creep_force[0] / force * p0;
    EXPECT_NEAR(q0, friction * p0, 1e-6 * p0);
    field depths;
    for (int k = 1; k <= 40; ++k) depths.push_back(0.03 * k * a);
    subsurface_of below(contact.get(), depths);
    below.solve(RP_BODY_RAIL);
    const field x = below.get(RP_SUBSURFACE_X), stress = below.get(RP_SUBSURFACE_STRESS);
    const field shear = below.get(RP_SUBSURFACE_GREATEST_SHEAR);
    const size_t nx = x.size(), points = depths.size() * nx;
    double most = 0, where = 0;
    for (size_t k = 0; k < depths.size(); ++k)
      for (size_t i = 0; i < nx; ++i) {
        const double z = depths[k], u = x[i], level = a * a - u * u + z * z;
        const double root = std::sqrt(level * level + 4 * u * u * z * z);
        const double m = std::sqrt(0.5 * (root + level));
        const double n = std::copysign(std::sqrt(0.5 * (root - level)), u);
        const double sum = m * m + n * n, by_p = -p0 / a, by_q = q0 / a;
        const double xx = by_p * (m * (1 + (z * z + n * n) / sum) - 2 * z);
        const double zz = by_p * m * (1 - (z * z + n * n) / sum);
        const double zx = by_p * n * (m * m - z * z) / sum;
        const double expected[] = {xx + by_q * (n * (2 - (z * z - m * m) / sum) - 2 * u),
                                   zz + q0 / p0 * zx, zx + q0 / p0 * xx};
        const size_t at = k * nx + i, component[] = {0, 2, 5};
        for (size_t c3 = 0; c3 < 3; ++c3)
          EXPECT_NEAR(stress[component[c3] * points + at], expected[c3], 0.005 * p0)
              << friction << " " << component[c3] << " x/a " << u / a << " z/a " << z / a;
        EXPECT_NEAR(stress[points + at], 0.3 * (stress[at] + stress[2 * points + at]), 1e-5 * p0);
        if (shear[at] > most) most = shear[at], where = z;
      }
    if (friction == 0) {
      EXPECT_NEAR(most / p0, 0.300, 0.001);
      EXPECT_NEAR(where / a, 0.786, 0.03);
    }
  }
}

// Across a deep plane goes the whole load, of pressure and of tractions.
TEST(Subsurface, CarriesTheLoadThroughAPlane) {
  scenes::handle contact(patch_case(12));
  const rp_result r = contact.step(loaded(6e4, 1e-3));
  ASSERT_EQ(r.status, RP_CONVERGED);
  const double depth = 0.05;
  // rings of r = depth tan t
  constexpr int rings = 200, spokes = 8;
  field points, weight;
  for (int k = 0; k < rings; ++k) {
    const double t = (k + 0.5) / rings * 0.5 * pi, distance = depth * std::tan(t);
    const double area = 0.5 * pi / rings * depth / (std::cos(t) * std::cos(t)) * distance;
    for (int s = 0; s < spokes; ++s) {
      const double turn = 2 * pi * (s + 0.25) / spokes;
      points.insert(points.end(), {distance * std::cos(turn), distance * std::sin(turn), depth});
      weight.push_back(area * 2 * pi / spokes);
    }
  }
  for (const int body : {RP_BODY_WHEEL, RP_BODY_RAIL}) {
    field values(9 * weight.size());
    ASSERT_EQ(rp_stress_at(contact.get(), RP_RIGHT, 0, body, points.data(), weight.size(),
                           values.data(), nullptr),
              RP_OK);
    double sum[3] = {0, 0, 0};  // nn, nx, sn
    for (size_t k = 0; k < weight.size(); ++k) {
      sum[0] += weight[k] * values[9 * k + 2];
      sum[1] += weight[k] * values[9 * k + 5];
      sum[2] += weight[k] * values[9 * k + 4];
    }
    const rp_patch_result &patch = r.side[RP_RIGHT].patch[0];
    EXPECT_NEAR(sum[0], -6e4, 1e-3 * 6e4) << body;
    // on the wheel acts the creep force, whose outward normal is n
    EXPECT_NEAR(sum[1], patch.creep_force[0], 1e-3 * 6e4) << body;
    EXPECT_NEAR(sum[2], patch.creep_force[1], 1e-3 * 6e4) << body;
  }
}

// What acts on the surface is what both bodies have there.
TEST(Subsurface, MeetsTheTractionsOnTheSurface) {
  scenes::handle contact(patch_case(24));
  ASSERT_EQ(contact.step(loaded(6e4, 1e-3)).status, RP_CONVERGED);
  const field pressure = contact.field(RP_RIGHT, 0, RP_FIELD_PRESSURE);
  const field traction = contact.field(RP_RIGHT, 0, RP_FIELD_TRACTION);
  const size_t points = pressure.size();
  const double p0 = *std::max_element(pressure.begin(), pressure.end());
  subsurface_of below(contact.get(), {0.0}, true);
  field displacement[2];
  for (const int body : {RP_BODY_WHEEL, RP_BODY_RAIL}) {
    below.solve(body);
    const field stress = below.get(RP_SUBSURFACE_STRESS);
    ASSERT_EQ(stress.size(), 6 * points);
    for (size_t i = 0; i < points; ++i) {
      EXPECT_NEAR(stress[2 * points + i], -pressure[i], 1e-5 * p0);
      EXPECT_NEAR(stress[5 * points + i], traction[i], 1e-5 * p0);
      EXPECT_NEAR(stress[4 * points + i], traction[points + i], 1e-5 * p0);
    }
    displacement[body] = below.get(RP_SUBSURFACE_DISPLACEMENT);
  }
  // together they fill the gap of Hertz's circle (Johnson 1985, eq. 3.42a); tractions move the
  // surfaces of like bodies alike
  const field x = below.get(RP_SUBSURFACE_X), y = below.get(RP_SUBSURFACE_Y);
  const double a = 4e-3, modulus = 82e9 / 0.7, peak = 1.5 * 6e4 / (pi * a * a);
  for (size_t i = 0; i < points; ++i) {
    const double square = std::pow(x[i % x.size()], 2) + std::pow(y[i / x.size()], 2);
    if (square > 0.8 * a * a) continue;
    const double closed = displacement[1][2 * points + i] - displacement[0][2 * points + i];
    const double expected = pi * peak / (4 * a * modulus) * (2 * a * a - square);
    EXPECT_NEAR(closed, expected, 0.005 * expected);
  }
}

// Fitted rows, laid out on a uniform grid, against a grid.
TEST(Subsurface, OfFittedRowsIsThatOfAGrid) {
  rp_config fine = patch_case(64), rows = patch_case(16);
  rows.elements[0] = rows.elements[1] = 0;
  rows.elements[0] = rows.elements[1] = 32;
  rows.fitted[0] = rows.fitted[1] = 16;
  scenes::handle on_grid(fine), on_rows(rows);
  const rp_result a = on_grid.step(loaded(6e4, 1e-3)), b = on_rows.step(loaded(6e4, 1e-3));
  ASSERT_EQ(a.status, RP_CONVERGED);
  ASSERT_EQ(b.status, RP_CONVERGED);
  const double p0 = 1.5 * 6e4 / (pi * 16e-6);
  field points;
  for (double x : {-3e-3, -1e-3, 0.0, 2e-3})
    for (double y : {-2e-3, 0.0, 1e-3}) points.insert(points.end(), {x, y, 2e-3});
  field values[2];
  for (int k = 0; k < 2; ++k) {
    values[k].resize(9 * 12);
    ASSERT_EQ(rp_stress_at(k == 0 ? on_grid.get() : on_rows.get(), RP_RIGHT, 0, RP_BODY_RAIL,
                           points.data(), 12, values[k].data(), nullptr),
              RP_OK);
  }
  for (size_t i = 0; i < 12; ++i)
    for (size_t c = 0; c < 6; ++c)
      EXPECT_NEAR(values[1][9 * i + c], values[0][9 * i + c], 0.01 * p0) << i << " " << c;
  // and by transforms what it is by sums
  subsurface_of below(on_rows.get(), {2e-3});
  below.solve(RP_BODY_RAIL);
  const field x = below.get(RP_SUBSURFACE_X), y = below.get(RP_SUBSURFACE_Y);
  const field stress = below.get(RP_SUBSURFACE_STRESS);
  const size_t i = x.size() / 3, j = y.size() / 2;
  const double point[3] = {x[i], y[j], 2e-3};
  field direct(9);
  ASSERT_EQ(
      rp_stress_at(on_rows.get(), RP_RIGHT, 0, RP_BODY_RAIL, point, 1, direct.data(), nullptr),
      RP_OK);
  for (size_t c = 0; c < 6; ++c)
    EXPECT_NEAR(stress[c * x.size() * y.size() + j * x.size() + i], direct[c], 0.005 * p0) << c;
}

TEST(Subsurface, OfALeftWheelIsTheMirrorImage) {
  const scenes::profile_pair pair;
  rp_config c = scenes::wheels(RP_WHEELSET, RP_RAIL, pair);
  c.tangential = RP_TANGENTIAL_FULL;
  scenes::handle contact(c);
  rp_input in = scenes::running(RP_RAIL);
  ASSERT_EQ(contact.step(in).status, RP_CONVERGED);
  subsurface_of below(contact.get(), {1e-3, 3e-3}, true);
  field stress[2], y[2], shear[2];
  for (const int side : {RP_LEFT, RP_RIGHT}) {
    below.solve(RP_BODY_RAIL, side);
    stress[side] = below.get(RP_SUBSURFACE_STRESS);
    y[side] = below.get(RP_SUBSURFACE_Y);
    shear[side] = below.get(RP_SUBSURFACE_DANG_VAN);
  }
  ASSERT_EQ(stress[0].size(), stress[1].size());
  const size_t ny = y[0].size(), nx = stress[0].size() / (6 * 2 * ny), points = 2 * ny * nx;
  const double size = *std::max_element(shear[0].begin(), shear[0].end());
  EXPECT_GT(size, 1e7);
  const double sign[] = {1, 1, 1, -1, -1, 1};
  for (size_t k = 0; k < 2; ++k)
    for (size_t j = 0; j < ny; ++j) {
      EXPECT_NEAR(y[0][j], -y[1][ny - 1 - j], 1e-12);
      EXPECT_NEAR(shear[0][k * ny + j], shear[1][k * ny + ny - 1 - j], 1e-5 * size);
      for (size_t i = 0; i < nx; ++i)
        for (size_t n = 0; n < 6; ++n)
          EXPECT_NEAR(stress[0][n * points + (k * ny + j) * nx + i],
                      sign[n] * stress[1][n * points + (k * ny + ny - 1 - j) * nx + i],
                      1e-5 * size);
    }
}

TEST(Subsurface, OfOwnInfluenceIsRefused) {
  constexpr int nx = 4, ny = 3;
  const std::vector<double> gap(nx * ny, 0.0);
  std::vector<double> own((nx + 1) * ny, 0.0);
  own[0] = 1e-13;
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_NONE);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 1e-3;
  c.distance_shape[0] = nx;
  c.distance_shape[1] = ny;
  c.undeformed_distance = gap.data();
  c.own_influence = 1;
  c.influence_coefficients = own.data();
  const scenes::handle contact(c);
  const double depth[] = {1e-3};
  rp_subsurface_config config;
  rp_default_subsurface(&config);
  config.depth = depth;
  config.depth_count = 1;
  rp_subsurface *below = nullptr;
  rp_message message{};
  EXPECT_EQ(rp_create_subsurface(contact.get(), &config, &below, &message), RP_ERROR_VALUE);
  EXPECT_EQ(below, nullptr);
  EXPECT_STREQ(message.text, "own_influence must be 0: what is given is of the surface alone");
}

TEST(Subsurface, BadInputIsRefused) {
  scenes::handle contact(patch_case(12));
  rp_subsurface *below = nullptr;
  rp_message message{};
  const double depth = 1e-3;
  const auto expect = [&](auto change, rp_error error, const char *words) {
    rp_subsurface_config config;
    rp_default_subsurface(&config);
    config.depth = &depth;
    config.depth_count = 1;
    change(config);
    EXPECT_EQ(rp_create_subsurface(contact.get(), &config, &below, &message), error);
    EXPECT_NE(std::string(message.text).find(words), std::string::npos) << message.text;
  };
  const double wrong[] = {-1e-3, std::nan(""), 1.5};
  for (const double &z : wrong)
    expect([&](rp_subsurface_config &c) { c.depth = &z; }, RP_ERROR_VALUE, "depth[0]");
  expect([](rp_subsurface_config &c) { c.depth = nullptr; }, RP_ERROR_NULL, "depth");
  expect([](rp_subsurface_config &c) { c.depth_count = 0; }, RP_ERROR_VALUE, "depth_count");
  expect([](rp_subsurface_config &c) { c.dang_van = -1; }, RP_ERROR_VALUE, "dang_van");
  expect([](rp_subsurface_config &c) { c.max_elements[1] = -1; }, RP_ERROR_VALUE, "max_elements");
  expect([](rp_subsurface_config &c) { c.cookie = 0; }, RP_ERROR_NOT_DEFAULTED, "never filled");
  // before the first step there is no patch
  subsurface_of made(contact.get(), {1e-3});
  EXPECT_EQ(rp_solve_subsurface(made.get(), contact.get(), RP_RIGHT, 0, 0, &message),
            RP_ERROR_NO_FIELD);
  contact.step(loaded(6e4, 1e-3));
  const int places[][3] = {{2, 0, 0}, {RP_RIGHT, -1, 0}, {RP_RIGHT, 0, 2}};
  for (const auto &at : places)
    EXPECT_EQ(rp_solve_subsurface(made.get(), contact.get(), at[0], at[1], at[2], &message),
              RP_ERROR_VALUE);
  EXPECT_EQ(rp_solve_subsurface(made.get(), contact.get(), RP_LEFT, 0, 0, &message),
            RP_ERROR_NO_FIELD);
  EXPECT_EQ(rp_solve_subsurface(made.get(), contact.get(), RP_RIGHT, 0, 0, &message), RP_OK);
  const double point[3] = {0, 0, -1e-3};
  double values[9];
  EXPECT_EQ(rp_stress_at(contact.get(), RP_RIGHT, 0, 0, point, 1, values, &message),
            RP_ERROR_VALUE);
}
