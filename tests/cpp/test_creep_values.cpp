// Creepage coefficients and creep forces from tables: interpolation told anew, by other forms of
// the same polynomials and splines.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "fast/coefficients.hpp"
#include "tables.hpp"

namespace {

using namespace railpatch;
using std::numbers::pi;

#include "fast/kalker_table.inc"

// --- computed coefficients -------------------------------------------------------------------

std::array<double, 4> values(const creepage_coefficients &c) {
  return {c.c11, c.c22, c.c23, c.c33};
}

// Neville's scheme
double polynomial(std::vector<double> x, std::vector<double> f, double at) {
  for (size_t m = 1; m < x.size(); ++m)
    for (size_t i = 0; i + m < x.size(); ++i)
      f[i] = ((at - x[i + m]) * f[i] + (x[i] - at) * f[i + 1]) / (x[i] - x[i + m]);
  return f[0];
}

const std::vector<double> poisson = {0, 0.25 - std::sqrt(0.03125), 0.25, 0.25 + std::sqrt(0.03125),
                                     0.5};

double of_table(int node, int k, int d, double nu) {
  const auto &v = kalker_values[node][k][d];
  return polynomial(poisson, {v, v + 5}, nu);
}

TEST(Coefficients, CubicsBetweenTheNodes) {
  const double step = 2 * std::log(20.0) / 24;
  for (double nu : {0.0, 0.0732233, 0.25, 0.28, 0.37, 0.5, 0.1}) {
    const coefficient_table table(nu);
    for (int node = 0; node < 24; ++node)
      for (double u : {0.0, 0.2, 0.5, 0.9}) {
        const auto found = values(table.at(std::exp((node - 12 + u) * step)));
        for (int k = 0; k < 4; ++k) {
          // the cubic of two values and two slopes, as a Bezier curve
          const double l = of_table(node, k, 0, nu), r = of_table(node + 1, k, 0, nu);
          const double a = l + of_table(node, k, 1, nu) * step / 3;
          const double b = r - of_table(node + 1, k, 1, nu) * step / 3, v = 1 - u;
          const double wanted =
              v * v * v * l + 3 * v * v * u * a + 3 * v * u * u * b + u * u * u * r;
          EXPECT_NEAR(found[static_cast<size_t>(k)], wanted, 1e-11 * std::fabs(wanted))
              << node << " " << u << " " << k;
        }
      }
  }
}

TEST(Coefficients, EndsOfTheTables) {
  const coefficient_table table(0.28);
  for (double end : {1.0 / 20, 20.0}) {
    const double beyond = end > 1 ? end * 1.01 : end / 1.01,
                 inside = end > 1 ? end / 1.01 : end * 1.01;
    EXPECT_TRUE(table.at(end).in_range);
    EXPECT_TRUE(table.at(inside).in_range);
    EXPECT_FALSE(table.at(beyond).in_range);
    EXPECT_EQ(values(table.at(beyond)), values(table.at(end)));
    EXPECT_NE(values(table.at(inside)), values(table.at(end)));
  }
  for (double end : {0.1, 10.0}) {
    const double beyond = end > 1 ? end * 1.01 : end / 1.01,
                 inside = end > 1 ? end / 1.01 : end * 1.01;
    EXPECT_TRUE(published_coefficients(end, 0.28).in_range);
    EXPECT_TRUE(published_coefficients(inside, 0.28).in_range);
    EXPECT_FALSE(published_coefficients(beyond, 0.28).in_range);
    EXPECT_EQ(values(published_coefficients(beyond, 0.28)),
              values(published_coefficients(end, 0.28)));
    EXPECT_EQ(published_coefficients(end, 0.28).c33, 0);
  }
}

// --- published coefficients ------------------------------------------------------------------

// a/b = 0.1 ... 1 ... 10
std::vector<double> published_rows() {
  std::vector<double> rows;
  for (int k = 1; k <= 10; ++k) rows.push_back(k / 10.0);
  for (int k = 9; k >= 1; --k) rows.push_back(10.0 / k);
  return rows;
}

TEST(Coefficients, PublishedAgreeWithComputed) {
  // three digits of an older program, trusted to 2 %, and to twice that for slender ellipses
  for (double nu : {0.0, 0.25, 0.5}) {
    const coefficient_table table(nu);
    for (double ratio : published_rows()) {
      const auto found = values(published_coefficients(ratio, nu)), own = values(table.at(ratio));
      for (size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(found[k], own[k], (ratio < 0.2 || ratio > 5 ? 0.04 : 0.02) * own[k])
            << ratio << " " << nu << " " << k;
    }
  }
}

TEST(Coefficients, PublishedAreJoinedByLines) {
  const std::vector<double> rows = published_rows();
  for (size_t i = 0; i < rows.size(); ++i) {
    const double ratio = rows[i];
    // the flexibilities by Poisson's ratio
    const auto v0 = values(published_coefficients(ratio, 0)),
               v1 = values(published_coefficients(ratio, 0.25)),
               v2 = values(published_coefficients(ratio, 0.5));
    // the table has three digits: its numbers come back as they are
    for (const auto &v : {v0, v1, v2})
      for (size_t k = 0; k < 3; ++k) {
        const double digits = v[k] < 1 ? 1e3 : v[k] < 10 ? 100 : 10;
        EXPECT_NEAR(v[k] * digits, std::round(v[k] * digits), 1e-9) << ratio;
      }
    for (double t : {0.2, 0.5, 0.9}) {
      const auto low = values(published_coefficients(ratio, 0.25 * t)),
                 high = values(published_coefficients(ratio, 0.25 + 0.25 * t));
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(1 / low[k], (1 - t) / v0[k] + t / v1[k], 1e-13);
        EXPECT_NEAR(1 / high[k], (1 - t) / v1[k] + t / v2[k], 1e-13);
      }
      // and the coefficients by ln(a/b)
      if (i + 1 == rows.size()) continue;
      const auto left = values(published_coefficients(ratio, 0.3)),
                 right = values(published_coefficients(rows[i + 1], 0.3)),
                 between = values(published_coefficients(
                     std::pow(ratio, 1 - t) * std::pow(rows[i + 1], t), 0.3));
      for (size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(between[k], (1 - t) * left[k] + t * right[k], 1e-12 * right[k]);
    }
  }
}

// --- creep forces ----------------------------------------------------------------------------

struct sizes {
  int ratio = 5, psi = 6, theta = 7, t = 8, recipe = 0;
};

// A table in which no two numbers are alike.
tables::table varied(const sizes &n, double level = -0.8) {
  creep_table_header h{};
  std::memcpy(h.magic, "RPCREEP1", 8);
  h.ratio_count = n.ratio;
  h.psi_count = n.psi;
  h.theta_count = n.theta;
  h.t_count = n.t;
  h.recipe_bytes = n.recipe;
  h.poisson_ratio[1] = 0.23;
  h.poisson_ratio[2] = 0.5;
  h.log_ratio[0] = -2.0;
  h.log_ratio[1] = 1.5;
  h.radius = 2.5;
  const double unit[3] = {3e-5, 5e-5, 4e-5};
  std::copy_n(unit, 3, h.remainder_scale);
  h.error[0] = 0.011;
  h.error[1] = 0.022;
  const auto wave = [](size_t i, double f) { return std::sin(f * static_cast<double>(i) + 1); };
  std::vector<double> scale(static_cast<size_t>(9 * n.ratio));
  for (size_t i = 0; i < scale.size(); ++i) scale[i] = 4 + 0.5 * wave(i, 1.7);
  std::vector<float> linear(static_cast<size_t>(24 * n.ratio * n.t));
  const double base[8] = {level, level, -0.1, 0.1, -0.5, 0, 0, 0};
  for (size_t i = 0; i < linear.size(); ++i)
    linear[i] = static_cast<float>(base[i % 8] == 0 ? 0.0 : base[i % 8] + 0.05 * wave(i, 2.3));
  std::vector<int16_t> remainder(static_cast<size_t>(9 * n.ratio * n.psi * n.theta * n.t));
  for (size_t i = 0; i < remainder.size(); ++i)
    remainder[i] = static_cast<int16_t>(static_cast<int>(i * 7919 % 2001) - 1000);
  const auto words = [](size_t bytes) { return (bytes + 7) / 8; };
  const size_t parts[] = {sizeof h / 8, scale.size(), words(linear.size() * sizeof(float)),
                          words(remainder.size() * sizeof(int16_t)),
                          words(static_cast<size_t>(n.recipe))};
  tables::table t;
  size_t all = 0;
  for (size_t part : parts) all += part;
  t.words.resize(all);
  h.bytes = t.size();
  uint64_t *at = t.words.data() + parts[0];
  std::memcpy(at, scale.data(), scale.size() * sizeof(double));
  std::memcpy(at += parts[1], linear.data(), linear.size() * sizeof(float));
  std::memcpy(at += parts[2], remainder.data(), remainder.size() * sizeof(int16_t));
  t.set_header(h);
  return t;
}

// Cubic B-spline k of `count` on 0 ... count - 3, by the recursion of Cox and de Boor.
double spline(double x, int k, int degree = 3) {
  const double first = k - 3;
  if (degree == 0) return x >= first && x < first + 1 ? 1.0 : 0.0;
  const double left = (x - first) / degree, right = (first + degree + 1 - x) / degree;
  return left * spline(x, k, degree - 1) + right * spline(x, k + 1, degree - 1);
}

std::vector<double> splines(double x, int count) {
  // the last interval holds its end
  x = std::min(x, std::nextafter(count - 3.0, 0.0));
  std::vector<double> w;
  for (int k = 0; k < count; ++k) w.push_back(spline(x, k));
  return w;
}

struct once_more {
  const tables::table &table;
  creep_table_header h;
  const double *scale;
  const float *linear;
  const int16_t *remainder;
  std::array<double, 3> nu;

  once_more(const tables::table &t, double poisson_ratio) : table(t), h(t.header()) {
    const auto *bytes = static_cast<const unsigned char *>(t.data()) + sizeof h;
    scale = reinterpret_cast<const double *>(bytes);
    bytes += 9 * sizeof(double) * static_cast<size_t>(h.ratio_count);
    linear = reinterpret_cast<const float *>(bytes);
    bytes += 24 * sizeof(float) * static_cast<size_t>(h.ratio_count * h.t_count);
    remainder = reinterpret_cast<const int16_t *>(bytes);
    for (size_t k = 0; k < 3; ++k) {
      std::vector<double> unit(3);
      unit[k] = 1;
      nu[k] = polynomial({h.poisson_ratio, h.poisson_ratio + 3}, unit, poisson_ratio);
    }
  }

  creep_forces operator()(const creep_problem &p) const {
    creep_forces out{};
    const double a = p.semi_axes[0], b = p.semi_axes[1], c = std::sqrt(a * b);
    const double at = std::clamp(std::log(a / b), h.log_ratio[0], h.log_ratio[1]);
    const auto wr =
        splines((at - h.log_ratio[0]) / (h.log_ratio[1] - h.log_ratio[0]) * (h.ratio_count - 3),
                h.ratio_count);
    double s[3] = {};
    for (int n = 0; n < 3; ++n)
      for (int r = 0; r < h.ratio_count; ++r)
        for (int k = 0; k < 3; ++k)
          s[k] += nu[static_cast<size_t>(n)] * wr[static_cast<size_t>(r)] *
                  scale[(n * h.ratio_count + r) * 3 + k];
    // into the quadrant of the table: xi >= 0, and spin >= 0 or, without it, eta >= 0
    double v[3] = {p.direction * p.creepage[0] * s[0], p.creepage[1] * s[1],
                   p.direction * p.spin_creepage * c * s[2]};
    const double x_sign = v[0] < 0 ? -1 : 1, y_sign = v[2] < 0 || (v[2] == 0 && v[1] < 0) ? -1 : 1;
    v[0] *= x_sign;
    v[1] *= y_sign;
    v[2] *= y_sign;
    const double size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double load = p.shear_modulus * c * c * size / p.bound, t = load / (h.radius + load);
    const double psi = std::asin(std::clamp(v[2] / size, -1.0, 1.0));
    const double theta = std::atan2(v[1], v[0]);
    const auto wt = splines(t * (h.t_count - 3), h.t_count);
    const auto wp = splines(psi / (pi / 2) * (h.psi_count - 3), h.psi_count);
    const auto wa = splines((theta + pi / 2) / pi * (h.theta_count - 3), h.theta_count);
    double m[5] = {}, rest[3] = {};
    for (int n = 0; n < 3; ++n)
      for (int r = 0; r < h.ratio_count; ++r)
        for (int l = 0; l < h.t_count; ++l) {
          const double w =
              nu[static_cast<size_t>(n)] * wr[static_cast<size_t>(r)] * wt[static_cast<size_t>(l)];
          if (w == 0) continue;
          for (int k = 0; k < 5; ++k)
            m[k] +=
                w * static_cast<double>(linear[((n * h.ratio_count + r) * h.t_count + l) * 8 + k]);
          for (int i = 0; i < h.psi_count; ++i)
            for (int j = 0; j < h.theta_count; ++j)
              for (int k = 0; k < 3; ++k) {
                const int line = ((n * h.ratio_count + r) * h.psi_count + i) * h.theta_count + j;
                rest[k] += w * wp[static_cast<size_t>(i)] * wa[static_cast<size_t>(j)] *
                           h.remainder_scale[k] * remainder[(line * h.t_count + l) * 3 + k];
              }
        }
    const double n1 = v[0] / size, n2 = v[1] / size, n3 = v[2] / size, share = 1 - n3 * n3;
    const double fx = t * (m[0] * n1 + share * rest[0]);
    const double fy = t * (m[1] * n2 + m[2] * n3 + share * rest[1]);
    const double mz = t * (m[3] * n2 + m[4] * n3 + share * rest[2]);
    // within the bound: the last thousandth bends from slope 1 towards it
    const double f = std::sqrt(fx * fx + fy * fy);
    double kept = f;
    if (f > 0.999) {
      const double u = (f - 0.999) / 0.001;
      kept = 0.999 + 0.001 * u / std::sqrt(1 + u * u);
    }
    const double cut = f > 0 ? kept / f : 1;
    out.force[0] = v[0] == 0 ? 0.0 : p.direction * x_sign * cut * fx * p.bound;
    out.force[1] = y_sign * cut * fy * p.bound;
    out.moment = p.direction * y_sign * mz * c * p.bound;
    out.friction = std::max(0.0, -(out.force[0] * p.creepage[0] + out.force[1] * p.creepage[1] +
                                   out.moment * p.spin_creepage));
    return out;
  }
};

TEST(CreepTable, SplinesOfTheFormat) {
  bool bent = false, free = false;
  for (const auto &[n, level] : {std::pair{sizes{}, -0.8}, {sizes{4, 5, 4, 6, 13}, -1.3}}) {
    const tables::table t = varied(n, level);
    ASSERT_EQ(creep_table::defect(t.data(), t.size()), nullptr);
    for (double nu : {0.0, 0.1, 0.23, 0.28, 0.5}) {
      const creep_table table(t.data(), nu);
      EXPECT_EQ(table.force_error(), 0.011);
      EXPECT_EQ(table.moment_error(), 0.022);
      const once_more wanted_of(t, nu);
      for (double ratio : {0.13, 0.14, 0.5, 1.0, 2.3, 4.5})
        for (const auto &[xi, eta, phi] : std::vector<std::array<double, 3>>{{1, 0.4, 90},
                                                                             {0.3, -1, 40},
                                                                             {-1, 0.2, -200},
                                                                             {0.1, 0.2, -300},
                                                                             {1, 0, 0},
                                                                             {0, 1, 0},
                                                                             {0, -1, 0},
                                                                             {-0.5, -0.5, 0},
                                                                             {0, 0, 200},
                                                                             {0, 0.3, 150},
                                                                             {0, 0, -200}})
          for (double size : {1e-6, 3e-4, 2e-3, 9e-3, 1.0})
            for (int direction : {1, -1}) {
              const creep_problem p{{5e-3 * std::sqrt(ratio), 5e-3 / std::sqrt(ratio)},
                                    8.2e10,
                                    2.7e4,
                                    {xi * size, eta * size},
                                    phi * size,
                                    direction};
              const creep_forces found = table.evaluate(p), wanted = wanted_of(p);
              const double force = std::hypot(wanted.force[0], wanted.force[1]);
              for (int k : {0, 1})
                ASSERT_NEAR(found.force[k], wanted.force[k], 1e-11 * 2.7e4)
                    << ratio << " " << xi << " " << eta << " " << phi << " " << size;
              ASSERT_NEAR(found.moment, wanted.moment, 1e-11 * 2.7e4 * 5e-3);
              ASSERT_NEAR(found.friction, wanted.friction, 1e-11 * 2.7e4 * size * 3);
              (force > 0.999 * 2.7e4 ? bent : free) = true;
              EXPECT_EQ(found.in_range, ratio > std::exp(-2.0) && ratio < std::exp(1.5));
            }
    }
  }
  EXPECT_TRUE(bent && free);
}

TEST(CreepTable, RangeHoldsItsEnds) {
  const tables::table t = varied({});
  const auto in_range = [&](double nu, double ratio) {
    return creep_table(t.data(), nu)
        .evaluate<double>({{ratio, 1.0}, 8e10, 1e4, {1e-3, 0}, 0, 1})
        .in_range;
  };
  EXPECT_TRUE(in_range(0, 1) && in_range(0.5, 1) && in_range(0.23, 1));
  EXPECT_FALSE(in_range(-1e-9, 1) || in_range(0.5 + 1e-9, 1));
  EXPECT_FALSE(in_range(0.2, std::exp(-2.0 - 1e-9)) || in_range(0.2, std::exp(1.5 + 1e-9)));
  tables::table exact = t;
  creep_table_header h = exact.header();
  h.log_ratio[0] = std::log(0.25);
  h.log_ratio[1] = std::log(4.0);
  exact.set_header(h);
  for (double ratio : {0.25, 4.0})
    EXPECT_TRUE(creep_table(exact.data(), 0.2)
                    .evaluate<double>({{ratio, 1.0}, 8e10, 1e4, {1e-3, 0}, 0, 1})
                    .in_range);
}

TEST(CreepTable, NothingMovesNothing) {
  const tables::table t = varied({});
  const creep_table table(t.data(), 0.28);
  for (const auto &[bound, xi] : {std::pair{0.0, 1e-3}, {1e4, 0.0}}) {
    const creep_forces f = table.evaluate<double>({{5e-3, 5e-3}, 8e10, bound, {xi, xi}, xi, 1});
    EXPECT_EQ(f.force[0], 0);
    EXPECT_EQ(f.force[1], 0);
    EXPECT_EQ(f.moment, 0);
    EXPECT_EQ(f.friction, 0);
    EXPECT_TRUE(f.in_range);
  }
}

// Beyond 1e150 creepages are shrunk: nothing changes, whichever is the great one.
TEST(CreepTable, CreepagesOfAnySize) {
  const tables::table t = varied({});
  const creep_table table(t.data(), 0.28);
  for (const auto &[xi, eta, phi] : std::vector<std::array<double, 3>>{
           {1, 0.3, 20}, {0.1, -1, 10}, {0.1, 0.1, 1000}, {0, 0, -700}}) {
    const auto at = [&, xi = xi, eta = eta, phi = phi](double size) {
      return table.evaluate<double>(
          {{4e-3, 6e-3}, 8e10, 1e4, {xi * size, eta * size}, phi * size, 1});
    };
    const creep_forces wanted = at(1e100);
    for (double size : {1e145, 1e148, 1e152, 1e200, 1e300}) {
      const creep_forces found = at(size);
      for (int k : {0, 1}) EXPECT_NEAR(found.force[k], wanted.force[k], 1e-11 * 1e4) << size;
      EXPECT_NEAR(found.moment, wanted.moment, 1e-11 * 1e4 * 5e-3) << size;
    }
  }
}

// --- what is refused -------------------------------------------------------------------------

std::string defect_of(const tables::table &t) {
  const char *text = creep_table::defect(t.data(), t.size());
  return text ? text : "";
}

TEST(CreepTable, AxesOfFourToTwoHundredAndFiftySix) {
  for (int which = 0; which < 4; ++which)
    for (int count : {3, 4, 256, 257}) {
      sizes n{4, 4, 4, 4, 0};
      (which == 0 ? n.ratio : which == 1 ? n.psi : which == 2 ? n.theta : n.t) = count;
      const bool good = count >= 4 && count <= 256;
      EXPECT_EQ(defect_of(varied(n)).find("axis") == std::string::npos, good) << which << count;
      EXPECT_EQ(defect_of(varied(n)).empty(), good);
    }
}

TEST(CreepTable, RecipesOfAnyLength) {
  for (int bytes : {0, 1, 7, 8, 9, 1000}) {
    tables::table t = varied({5, 6, 7, 8, bytes});
    EXPECT_EQ(defect_of(t), "");
    t.words.push_back(0);
    EXPECT_NE(defect_of(t), "");
    creep_table_header h = t.header();
    h.bytes = t.size();
    t.set_header(h);
    EXPECT_NE(defect_of(t).find("its axes"), std::string::npos);
  }
  const tables::table t = varied({});
  const auto *bytes = static_cast<const char *>(t.data());
  EXPECT_STREQ(creep_table::defect(nullptr, 8), "is null: tangential = table needs one");
  EXPECT_NE(creep_table::defect(bytes + 4, t.size() - 4), nullptr);
  EXPECT_NE(creep_table::defect(bytes, sizeof(creep_table_header) - 1), nullptr);
  EXPECT_NE(creep_table::defect(bytes, t.size() - 4), nullptr);
}

// Any altered word behind the header's checksum.
TEST(CreepTable, EveryWordIsChecked) {
  tables::table t = varied({4, 4, 4, 4, 20});
  for (size_t i = 0; i < t.words.size(); ++i)
    for (int bit : {0, 31, 63}) {
      t.words[i] ^= uint64_t{1} << bit;
      EXPECT_NE(defect_of(t), "") << i;
      t.words[i] ^= uint64_t{1} << bit;
    }
  EXPECT_EQ(defect_of(t), "");
}

TEST(CreepTable, HeadersOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
  const auto defect = [&](auto &&change) {
    tables::table t = varied({});
    creep_table_header h = t.header();
    change(h);
    t.set_header(h);
    return defect_of(t);
  };
  const std::string bad = "has an axis or a scale out of range";
  for (int k = 0; k < 3; ++k)
    for (double value : {0.0, -1.0, nan, inf}) {
      EXPECT_EQ(defect([&](auto &h) { h.remainder_scale[k] = value; }), bad);
      EXPECT_EQ(defect([&](auto &h) { h.radius = value; }), bad);
    }
  for (int k = 0; k < 2; ++k) {
    for (double value : {-1e-9, nan, inf})
      EXPECT_EQ(defect([&](auto &h) { h.error[k] = value; }), bad);
    EXPECT_EQ(defect([&](auto &h) { h.error[k] = 0; }), "");
    for (double value : {-20.0, 20.0, nan, inf, -inf})
      EXPECT_EQ(defect([&](auto &h) { h.log_ratio[k] = value; }), bad) << value;
  }
  EXPECT_EQ(defect([](auto &h) { h.log_ratio[0] = h.log_ratio[1]; }), bad);
  EXPECT_EQ(defect([](auto &h) { h.log_ratio[0] = -19.99, h.log_ratio[1] = 19.99; }), "");
  EXPECT_EQ(defect([](auto &h) { h.poisson_ratio[0] = -1; }), bad);
  EXPECT_EQ(defect([](auto &h) { h.poisson_ratio[2] = 1; }), bad);
  EXPECT_EQ(defect([](auto &h) { h.poisson_ratio[0] = -0.99, h.poisson_ratio[2] = 0.99; }), "");
  EXPECT_EQ(defect([](auto &h) { h.poisson_ratio[2] = h.poisson_ratio[1]; }), bad);
  EXPECT_EQ(defect([](auto &h) { h.poisson_ratio[1] = h.poisson_ratio[0]; }), bad);
}

TEST(CreepTable, EveryNumberIsANumber) {
  const sizes n{4, 4, 4, 4, 0};
  const tables::table good = varied(n);
  const size_t head = sizeof(creep_table_header) / 8, scales = 36, linear = 24 * 4 * 4 / 2;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const float none = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < scales + linear; ++i)
    for (int half : {0, 1}) {
      tables::table t = good;
      auto *bytes = reinterpret_cast<unsigned char *>(t.words.data() + head + i);
      if (i < scales)
        std::memcpy(bytes, &nan, sizeof nan);
      else
        std::memcpy(bytes + 4 * half, &none, sizeof none);
      t.seal();
      EXPECT_EQ(defect_of(t), "holds values that are no numbers") << i;
    }
}

}  // namespace
