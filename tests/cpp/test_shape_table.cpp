// Corrections of creep forces by the shape of the pressure: the block's form, functions of creepage
// and how much of each a shape has, symmetries, and that nothing jumps.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "fast/shape_table.hpp"
#include "scenes.hpp"
#include "tables.hpp"

namespace {

using railpatch::grid;
using railpatch::shape_table;
using head = railpatch::shape_table_header;
using std::numbers::pi;

constexpr int spins = head::spins, directions = shape_table::directions;
constexpr int radii = shape_table::radii, lanes = shape_table::lanes;
constexpr int cells = spins * directions * radii, functions = head::functions;
constexpr double places[spins] = {0, 0.15, 0.3, 0.5, 0.75, 1.05, 1.5, 2.1, 3, 4.5, 7, 11};
constexpr double shear = 82e9;

struct node {
  std::array<double, head::features> feature{};
  std::array<double, functions> weight{};  // of which the first is not read
};

using function_of_cells = std::function<std::array<double, 3>(int spin, int direction, int t)>;

// A block with the small table of ellipses; functions in units of 1e-4.
struct block : tables::table {
  block(const std::vector<node> &nodes, const std::vector<function_of_cells> &given) {
    head h{};
    std::memcpy(h.magic, "RPSHAPE3", 8);
    h.node_count = static_cast<int32_t>(nodes.size());
    h.recipe_bytes = 3;
    h.poisson_ratio = 0.25;
    h.reach = 0.5;
    h.radius = 3;
    std::copy_n(places, spins, h.spin);
    for (double &s : h.scale) s = 1;
    h.unit = 1e-4;
    h.error[0] = 0.012;
    h.error[1] = 0.034;
    const size_t blocks = (nodes.size() + lanes - 1) / lanes;
    std::vector<float> features(blocks * lanes * head::features, 1e9f);
    std::vector<double> weights;
    for (size_t n = 0; n < nodes.size(); ++n) {
      for (size_t k = 0; k < head::features; ++k)
        features[(n / lanes * head::features + k) * lanes + n % lanes] =
            static_cast<float>(nodes[n].feature[k]);
      weights.insert(weights.end(), nodes[n].weight.begin(), nodes[n].weight.end());
    }
    std::vector<int16_t> numbers(3 * cells * functions);
    for (size_t k = 0; k < given.size(); ++k)
      for (int c = 0; c < cells; ++c) {
        const auto value = given[k](c / radii / directions, c / radii % directions, c % radii);
        for (size_t d = 0; d < 3; ++d)
          numbers[(3 * static_cast<size_t>(c) + d) * functions + k] =
              static_cast<int16_t>(std::lround(value[d] * 1e4));
      }
    weights.resize(blocks * lanes * functions);
    const tables::table inner = tables::small();
    append(&h, sizeof h);
    append(features.data(), features.size() * sizeof(float));
    append(weights.data(), weights.size() * sizeof(double));
    append(numbers.data(), numbers.size() * sizeof(int16_t));
    append("{} ", 3);
    append(inner.data(), inner.size());
    h.bytes = size();
    set(h);
  }
  head get() const {
    head h;
    std::memcpy(&h, words.data(), sizeof h);
    return h;
  }
  void set(const head &h) {
    std::memcpy(words.data(), &h, sizeof h);
    reseal();
  }
  void reseal() {
    uint64_t hash = 14695981039346656037ull;
    for (size_t i = offsetof(head, node_count) / 8; i < words.size(); ++i)
      hash = (hash ^ words[i]) * 1099511628211ull;
    words[2] = hash;
  }

 private:
  void append(const void *from, size_t bytes) {
    const size_t at = words.size();
    words.resize(at + (bytes + 7) / 8);
    std::memcpy(words.data() + at, from, bytes);
  }
};

std::array<double, 3> nothing(int, int, int) { return {0, 0, 0}; }

// One function that all shapes have.
block lone(const function_of_cells &function) { return {std::vector<node>(1), {function}}; }

grid square(int n, double half) {
  grid g{};
  g.nx = g.ny = n;
  g.dx = g.dy = 2 * half / n;
  g.x0 = g.y0 = -half + 0.5 * g.dx;
  return g;
}

std::vector<double> pressure_of(const grid &g, const std::function<double(double, double)> &p) {
  std::vector<double> found;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) found.push_back(std::max(p(g.x(i), g.y(j)), 0.0));
  return found;
}

double hertz(double x, double y) { return std::sqrt(std::max(1 - x * x - y * y, 0.0)); }

// A lopsided pressure.
double lopsided(double x, double y) {
  return hertz(x / 3e-3, y / 4e-3) * (1 + 60 * x + 80 * y + 1e4 * x * y);
}

struct found_at {
  double force[2], moment;
};

// Creepages that are v about the origin, for a bound of 1 kN.
found_at at(shape_table &table, const grid &g, const std::vector<double> &p, const double v[3],
            int direction = 1) {
  constexpr double bound = 1e3;
  const railpatch::shape_of_pressure s =
      shape_table::describe(railpatch::pressure_view<double>(g, p.data()));
  const double product = s.axes[0] * s.axes[1];
  const double r = std::sqrt(0.5 * (s.axes[0] * s.axes[0] + s.axes[1] * s.axes[1]));
  const double unit = bound / (shear * product), spin = v[2] * unit / (2.3 * r);
  const double creepage[2] = {v[0] * unit / 4.2 + spin * s.centre[1],
                              v[1] * unit / 3.7 - spin * s.centre[0]};
  const auto c = table.evaluate<double>({g, p.data()}, shear, bound, creepage, spin, direction);
  EXPECT_TRUE(std::isfinite(c.force[0]) && std::isfinite(c.force[1]) && std::isfinite(c.moment));
  return {{c.force[0] / bound, c.force[1] / bound}, c.moment / bound};
}

std::array<double, 3> node_v(double spin, double direction, double t) {
  const double size = 3 * (t / radii) / (1 - t / radii), angle = 2 * pi * direction / directions;
  return {size * std::cos(angle), size * std::sin(angle), spin};
}

TEST(ShapeTable, BrokenBytesAreRefused) {
  const block good = lone(nothing);
  EXPECT_EQ(railpatch::creep_table_defect(good.data(), good.size()), nullptr);
  EXPECT_TRUE(shape_table::is_one(good.data(), good.size()));
  const tables::table other = tables::small();
  EXPECT_FALSE(shape_table::is_one(other.data(), other.size()));
  const auto refused = [&](const std::function<void(block &)> &breaks, const char *why) {
    block b = good;
    breaks(b);
    const char *found = railpatch::creep_table_defect(b.data(), b.size());
    ASSERT_NE(found, nullptr) << why;
    EXPECT_NE(std::string(found).find(why), std::string::npos) << found;
  };
  const auto in_header = [&](const std::function<void(head &)> &breaks, const char *why) {
    refused(
        [&](block &b) {
          head h = b.get();
          breaks(h);
          b.set(h);
        },
        why);
  };
  refused([](block &b) { b.words.resize(4); }, "too short");
  refused([](block &b) { b.words.pop_back(); }, "length");
  refused([](block &b) { b.words[b.words.size() / 2] ^= 1; }, "altered");
  in_header([](head &h) { h.node_count = 0; }, "less than one");
  in_header([](head &h) { h.node_count = 20001; }, "20000");
  in_header([](head &h) { h.node_count = 19000; }, "ask for");
  in_header([](head &h) { h.recipe_bytes = -1; }, "ask for");
  in_header([](head &h) { h.radius = 0; }, "out of range");
  in_header([](head &h) { h.reach = NAN; }, "out of range");
  in_header([](head &h) { h.spin[3] = h.spin[2]; }, "out of range");
  in_header([](head &h) { h.spin[0] = 0.1; }, "out of range");
  in_header([](head &h) { h.scale[1] = -1; }, "out of range");
  in_header([](head &h) { h.unit = INFINITY; }, "out of range");
  in_header([](head &h) { h.error[0] = -0.1; }, "out of range");
  refused(
      [](block &b) {
        const float no = NAN;
        std::memcpy(b.words.data() + sizeof(head) / 8, &no, sizeof no);
        b.reseal();
      },
      "no numbers");
  refused(
      [](block &b) {
        const double no = INFINITY;
        std::memcpy(b.words.data() + sizeof(head) / 8 + lanes * head::features / 2, &no, sizeof no);
        b.reseal();
      },
      "no numbers");
  // the table of ellipses in it is looked at too
  refused(
      [](block &b) {
        b.words.back() ^= 1;
        b.reseal();
      },
      "altered");
}

TEST(ShapeTable, DescribesHertz) {
  // of a semi-ellipsoid <x^4> = 3/35 a^4, <x^2 y^2> = 1/35 a^2 b^2, and of its rows' loads
  // 3/4 (1 - (y/b)^2)/b the square has the integral 3/5/b
  const grid g = square(160, 6e-3);
  const auto p = pressure_of(
      g, [](double x, double y) { return hertz((x - 1e-3) / 2e-3, (y + 5e-4) / 5e-3); });
  const railpatch::shape_of_pressure s =
      shape_table::describe(railpatch::pressure_view<double>(g, p.data()));
  EXPECT_NEAR(s.centre[0], 1e-3, 1e-6);
  EXPECT_NEAR(s.centre[1], -5e-4, 1e-6);
  EXPECT_NEAR(s.axes[0], 2e-3, 2e-6);
  EXPECT_NEAR(s.axes[1], 5e-3, 5e-6);
  const double wanted[] = {std::log(0.4), 0, 3.0 / 35, 0, 0, 1.0 / 35, 3.0 / 35, std::log(0.6)};
  for (size_t k = 0; k < head::features; ++k) EXPECT_NEAR(s.feature[k], wanted[k], 2e-3) << k;
}

TEST(ShapeTable, HoldsItsFunction) {
  const auto value = [](int s, int d, int t) -> std::array<double, 3> {
    // at no creepage no direction
    const double k = t == 0 ? 0.1 * s : std::sin(0.7 * s + 1.3 * d + 2.1 * t);
    return {0.1 * k, -0.05 * k, 0.02 * k};
  };
  const block b = lone(value);
  shape_table table(b.data(), 0.25);
  const grid g = square(24, 6e-3);
  const auto p = pressure_of(g, lopsided);
  const auto s = shape_table::describe(railpatch::pressure_view<double>(g, p.data()));
  const double c = std::sqrt(s.axes[0] * s.axes[1]);
  for (int spin = 1; spin < spins; ++spin)
    for (int d = 0; d < directions; ++d)
      for (int t = 0; t < radii; ++t) {
        const auto v = node_v(places[spin], d, t);
        const found_at f = at(table, g, p, v.data());
        const auto wanted = value(spin, d, t);
        // half of a unit, and what creepages round off
        EXPECT_NEAR(f.force[0], wanted[0], 0.6e-4) << spin << d << t;
        EXPECT_NEAR(f.force[1], wanted[1], 0.6e-4);
        const double moment = c * wanted[2] + s.centre[0] * f.force[1] - s.centre[1] * f.force[0];
        EXPECT_NEAR(f.moment, moment, 0.6e-4 * c);
      }
}

// Slopes by parabolas: what grows with the square of the spin is met between the nodes too.
TEST(ShapeTable, IsExactForParabolas) {
  const auto value = [](double spin) { return 0.03 * spin - 0.002 * spin * spin; };
  const block b = lone([&](int s, int, int t) -> std::array<double, 3> {
    const double k = value(places[s]) * (1 - t * t / (1.0 * radii * radii));
    return {k, k, 0};
  });
  shape_table table(b.data(), 0.25);
  const grid g = square(24, 6e-3);
  const auto p = pressure_of(g, lopsided);
  for (double spin : {0.25, 0.6, 1.0, 2.0, 4.0})
    for (double t : {2.5, 4.25, 6.75}) {
      const auto v = node_v(spin, 3.3, t);
      const found_at f = at(table, g, p, v.data());
      const double wanted = value(spin) * (1 - t * t / (1.0 * radii * radii));
      // rounded remainders, each half of a unit
      EXPECT_NEAR(f.force[0], wanted, 1e-4) << spin << " " << t;
      EXPECT_NEAR(f.force[1], wanted, 1e-4);
    }
}

std::vector<node> random_nodes(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<node> nodes(static_cast<size_t>(count));
  for (node &n : nodes) {
    for (double &f : n.feature) f = 0.3 * number(random);
    for (double &w : n.weight) w = number(random);
    n.feature.back() += std::log(0.6);
  }
  return nodes;
}

std::vector<function_of_cells> random_functions() {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<function_of_cells> found;
  for (int k = 0; k < functions; ++k) {
    const double a = number(random), b = number(random);
    found.emplace_back([a, b](int s, int d, int t) -> std::array<double, 3> {
      const double angle = 2 * pi * d / directions, size = t * (radii - t) / 16.0;
      // odd where there is no spin
      const double even = 0.05 * b * places[s];
      return {0.1 * a * size * std::cos(angle) + even, 0.1 * a * size * std::sin(angle) - even,
              0.05 * b * size * std::sin(angle)};
    });
  }
  return found;
}

block random_block(int count) { return {random_nodes(count), random_functions()}; }

// Amounts of the functions by the formula, node by node.
TEST(ShapeTable, WeighsItsNodes) {
  const grid g = square(24, 6e-3);
  const auto p = pressure_of(g, lopsided);
  const auto s = shape_table::describe(railpatch::pressure_view<double>(g, p.data()));
  const double c = std::sqrt(s.axes[0] * s.axes[1]);
  const auto given = random_functions();
  for (int count : {1, 8, 83}) {
    auto nodes = random_nodes(count);
    // one that the shape hits, one out of sight
    nodes.front().feature = s.feature;
    if (count > 8) nodes.back().feature[2] += 1;
    std::array<double, 3> wanted{};
    constexpr int spin = 5, d = 7, t = 4;
    for (size_t k = 0; k < functions; ++k) {
      double amount = k == 0 ? 1.0 : 0.0;
      for (const node &n : nodes) {
        double square = 0;
        for (size_t i = 0; i < head::features; ++i)
          square += std::pow(n.feature[i] - s.feature[i], 2);
        const double r = std::min(std::sqrt(square), 1.0);
        if (k > 0) amount += n.weight[k] * std::pow(1 - r, 4) * (4 * r + 1);
      }
      const auto value = given[k](spin, d, t);
      for (size_t i = 0; i < 3; ++i) wanted[i] += amount * std::lround(value[i] * 1e4) * 1e-4;
    }
    const block b(nodes, given);
    shape_table table(b.data(), 0.25);
    const auto v = node_v(places[spin], d, t);
    const found_at f = at(table, g, p, v.data());
    EXPECT_NEAR(f.force[0], wanted[0], 1e-6) << count;
    EXPECT_NEAR(f.force[1], wanted[1], 1e-6);
    const double moment = c * wanted[2] + s.centre[0] * f.force[1] - s.centre[1] * f.force[0];
    EXPECT_NEAR(f.moment, moment, 1e-6 * c);
  }
}

TEST(ShapeTable, TurnsItsSignWithTheCreepages) {
  const block b = random_block(40);
  shape_table table(b.data(), 0.25);
  const grid g = square(24, 6e-3);
  const auto p = pressure_of(g, lopsided);
  const auto mirrored = pressure_of(g, [](double x, double y) { return lopsided(-x, y); });
  for (const std::array<double, 3> &v :
       {std::array{0.3, 0.2, 0.4}, {1.0, -2.0, 0.0}, {-3.0, 0.1, -2.0}, {0.0, 0.0, 12.0}}) {
    const found_at f = at(table, g, p, v.data());
    const double back[3] = {-v[0], -v[1], -v[2]};
    const found_at r = at(table, g, p, back);
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(r.force[k], -f.force[k], 1e-12);
    EXPECT_NEAR(r.moment, -f.moment, 1e-15);
    // seen in a mirror, x and what turns about z change their signs
    const double image[3] = {-v[0], v[1], -v[2]};
    const found_at m = at(table, g, mirrored, image, -1);
    EXPECT_NEAR(m.force[0], -f.force[0], 1e-9);
    EXPECT_NEAR(m.force[1], f.force[1], 1e-9);
    EXPECT_NEAR(m.moment, -f.moment, 1e-12);
  }
}

TEST(ShapeTable, DoesNotJump) {
  const block b = random_block(60);
  shape_table table(b.data(), 0.25);
  const grid g = square(24, 6e-3);
  const auto one = pressure_of(g, lopsided);
  const auto two = pressure_of(g, [](double x, double y) { return hertz(x / 5e-3, y / 2e-3); });
  // creepages through 0, over the branch of the angle, beyond the last spin; pressures from one to
  // the other, past where nodes come into sight
  constexpr int steps = 4000;
  const std::array<double, 3> start = {-4.0, 0.3, -11.0}, end = {5.0, -0.37, 10.0};
  std::array<double, 2> last{};
  double greatest = 0, way = 0;
  for (int k = 0; k <= steps; ++k) {
    const double u = static_cast<double>(k) / steps;
    double v[3];
    for (size_t d = 0; d < 3; ++d) v[d] = start[d] + u * (end[d] - start[d]);
    std::vector<double> p(one.size());
    for (size_t i = 0; i < p.size(); ++i) p[i] = (1 - u) * one[i] + u * two[i];
    const found_at f = at(table, g, p, v);
    if (k > 0) {
      const double change = std::hypot(f.force[0] - last[0], f.force[1] - last[1]);
      greatest = std::max(greatest, change);
      way += change;
    }
    last = {f.force[0], f.force[1]};
  }
  EXPECT_GT(way, 0.1);
  // a jump would be as large at any number of steps
  EXPECT_LT(greatest, 0.01 * way);
}

TEST(ShapeTable, CountsInTheInterface) {
  // Hertz on a grid, up to what its elements leave
  const node n{{0, 0, 3.0 / 35, 0, 0, 1.0 / 35, 3.0 / 35, std::log(0.6)}, {}};
  const block b(
      {n}, {[](int, int, int t) -> std::array<double, 3> { return {t > 0 ? 0.01 : 0.0, 0, 0}; }});
  const tables::table plain = tables::small();
  rp_config c = scenes::patch(RP_NORMAL_HALF_SPACE, RP_TANGENTIAL_TABLE, 32);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  std::vector<double> gap(32 * 32);
  // curvatures 1/m along x and y
  const auto shape = [&](double along, double across) {
    const grid g = square(32, 6e-3);
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i)
        gap[static_cast<size_t>(32 * j + i)] =
            0.5 * (along * g.x(i) * g.x(i) + across * g.y(j) * g.y(j));
  };
  shape(4.0, 4.0);
  c.undeformed_distance = gap.data();
  c.distance_shape[0] = c.distance_shape[1] = 32;
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = c.element_size[1] = 12e-3 / 32;
  c.poisson_ratio[0] = c.poisson_ratio[1] = 0.25;
  const auto solved = [&](const tables::table &t) {
    c.creep_table = t.data();
    c.creep_table_size = t.size();
    scenes::handle contact(c);
    return contact.step(scenes::patch_input(1e5, 0.04, 0.0, 0.0));
  };
  const rp_result with = solved(b), without = solved(plain);
  EXPECT_EQ(with.status, RP_CONVERGED);
  const rp_patch_result &w = with.side[RP_RIGHT].patch[0], &o = without.side[RP_RIGHT].patch[0];
  const double bound = c.friction_coefficient * 1e5;
  EXPECT_NEAR(w.creep_force[0] - o.creep_force[0], 0.01 * bound, 0.002 * bound);
  EXPECT_DOUBLE_EQ(w.creep_force[1], o.creep_force[1]);
  EXPECT_NEAR(w.error_estimate[0], 0.012 * bound, 1e-9 * bound);
  EXPECT_NEAR(w.error_estimate[1], 0.034 * bound * 4e-3, 0.5 * 0.034 * bound * 4e-3);
  EXPECT_TRUE(std::isnan(o.error_estimate[0]));
  // a shape that it does not know
  shape(8.0, 2.0);
  EXPECT_EQ(solved(b).status, RP_OUT_OF_RANGE);
  shape(4.2, 3.9);
  EXPECT_EQ(solved(b).status, RP_CONVERGED);
}

}  // namespace
