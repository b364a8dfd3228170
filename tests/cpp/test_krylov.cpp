// GMRES and conjugate residuals in a shared space against elimination of dense systems: solutions,
// residuals as they are told and as they are, numbers of products.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "numeric/gmres.hpp"
#include "numeric/shared_krylov.hpp"

namespace {

using namespace railpatch;
using vector = std::vector<double>;

struct dense {
  size_t n;
  vector a;  // [row][column]

  // unit matrix and `strength` times a random one
  dense(size_t size, double strength, std::mt19937_64 &random) : n(size), a(size * size) {
    std::uniform_real_distribution<double> entry(-1, 1);
    for (double &v : a) v = strength * entry(random) / std::sqrt(static_cast<double>(n));
    for (size_t i = 0; i < n; ++i) a[i * n + i] += 1;
  }
  void product(const double *v, double *out) const {
    for (size_t i = 0; i < n; ++i) {
      out[i] = 0;
      for (size_t j = 0; j < n; ++j) out[i] += a[i * n + j] * v[j];
    }
  }
  vector solved(vector b) const {
    vector m = a;
    for (size_t k = 0; k < n; ++k) {
      size_t p = k;
      for (size_t i = k + 1; i < n; ++i)
        if (std::abs(m[i * n + k]) > std::abs(m[p * n + k])) p = i;
      for (size_t j = 0; j < n; ++j) std::swap(m[k * n + j], m[p * n + j]);
      std::swap(b[k], b[p]);
      for (size_t i = k + 1; i < n; ++i) {
        const double f = m[i * n + k] / m[k * n + k];
        for (size_t j = k; j < n; ++j) m[i * n + j] -= f * m[k * n + j];
        b[i] -= f * b[k];
      }
    }
    for (size_t k = n; k-- > 0;) {
      for (size_t j = k + 1; j < n; ++j) b[k] -= m[k * n + j] * b[j];
      b[k] /= m[k * n + k];
    }
    return b;
  }
};

double norm(const vector &v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum);
}

vector drawn(size_t n, std::mt19937_64 &random) {
  std::uniform_real_distribution<double> value(-1, 1);
  vector v(n);
  for (double &x : v) x = value(random);
  return v;
}

double residual_of(const dense &m, const double *b, const double *x) {
  vector r(m.n);
  m.product(x, r.data());
  for (size_t i = 0; i < m.n; ++i) r[i] = b[i] - r[i];
  return norm(r) / norm(vector(b, b + m.n));
}

void expect_near(const vector &found, const vector &should, double share) {
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], should[i], share * norm(should));
}

// how a system is preconditioned: by its diagonal, scaled so that sides could be mistaken
const auto by_row = [](double *v, size_t n) {
  for (size_t i = 0; i < n; ++i) v[i] /= 1.0 + 0.1 * static_cast<double>(i % 7);
};

TEST(Gmres, SolvesInOneGoAndRestarted) {
  std::mt19937_64 random(1);
  for (size_t n : {1u, 2u, 13u, 30u})
    for (int krylov : {4, 40}) {
      const dense m(n, 0.4, random);
      const vector b = drawn(n, random), should = m.solved(b);
      gmres solver(40, krylov);
      vector x(n, 5.0);
      int products = 0;
      const auto out = solver.solve(
          n, b.data(), x.data(), 1e-11, 200,
          [&](const double *v, double *w) {
            ++products;
            m.product(v, w);
          },
          [&](double *v) { by_row(v, n); });
      EXPECT_EQ(out.products, products);
      EXPECT_LE(out.residual, 1e-11);
      EXPECT_NEAR(residual_of(m, b.data(), x.data()), out.residual, 1e-14);
      expect_near(x, should, 1e-9);
      // in one go it ends with as many products as unknowns
      if (krylov == 40) {
        EXPECT_LE(products, static_cast<int>(n));
      }
    }
}

TEST(Gmres, LeastResidualOfItsSpace) {
  // what is left after k products is the least that any combination of them leaves
  std::mt19937_64 random(2);
  const size_t n = 12;
  const dense m(n, 0.8, random);
  const vector b = drawn(n, random);
  gmres solver(12, 12);
  for (int k = 1; k <= 6; ++k) {
    vector x(n);
    const auto out = solver.solve(
        n, b.data(), x.data(), 0.0, k, [&](const double *v, double *w) { m.product(v, w); },
        [](double *) {});
    EXPECT_EQ(out.products, k);
    const double left = residual_of(m, b.data(), x.data());
    EXPECT_NEAR(left, out.residual, 1e-13);
    // orthogonal to the images of the space
    vector r(n), v = b, image(n);
    m.product(x.data(), r.data());
    for (size_t i = 0; i < n; ++i) r[i] = b[i] - r[i];
    for (int step = 0; step < k; ++step) {
      m.product(v.data(), image.data());
      double sum = 0;
      for (size_t i = 0; i < n; ++i) sum += r[i] * image[i];
      EXPECT_NEAR(sum, 0.0, 1e-12 * norm(image) * norm(b)) << k << " " << step;
      v = image;
    }
  }
}

TEST(Gmres, EndsWhereThereIsNothingToDo) {
  std::mt19937_64 random(3);
  const dense m(5, 0.5, random);
  gmres solver(8, 3);
  const auto apply = [&](const double *v, double *w) { m.product(v, w); };
  vector x(5, 1.0), zero(5, 0.0);
  auto out = solver.solve(5, zero.data(), x.data(), 1e-8, 20, apply, [](double *) {});
  EXPECT_EQ(out.products, 0);
  EXPECT_EQ(out.residual, 0.0);
  EXPECT_EQ(x, zero);
  // none allowed: the start, zero
  const vector b = drawn(5, random);
  x.assign(5, 1.0);
  out = solver.solve(5, b.data(), x.data(), 1e-8, 0, apply, [](double *) {});
  EXPECT_EQ(out.products, 0);
  EXPECT_EQ(out.residual, 1.0);
  EXPECT_EQ(x, zero);
  // a tolerance that the start meets
  x.assign(5, 1.0);
  out = solver.solve(5, b.data(), x.data(), 1.0, 20, apply, [](double *) {});
  EXPECT_EQ(out.products, 0);
  EXPECT_EQ(x, zero);
  // a singular system whose right side can be met: the space ends early
  const auto project = [](const double *v, double *w) {
    for (int i = 0; i < 5; ++i) w[i] = i < 2 ? 2.0 * v[i] : 0.0;
  };
  const vector met{3, -1, 0, 0, 0};
  out = solver.solve(5, met.data(), x.data(), 1e-14, 20, project, [](double *) {});
  EXPECT_EQ(out.products, 1);
  EXPECT_LE(out.residual, 1e-14);
  expect_near(x, {1.5, -0.5, 0, 0, 0}, 1e-15);
  // and one that is met by nothing: an end, and the start
  const auto none = [](const double *, double *w) { std::fill_n(w, 5, 0.0); };
  out = solver.solve(5, met.data(), x.data(), 1e-14, 20, none, [](double *) {});
  EXPECT_LE(out.products, 20);
  EXPECT_EQ(x, zero);
}

TEST(Gmres, SaysWhatItHolds) {
  const gmres solver(10, 4);
  // basis, a vector, the triangle and the rotations
  EXPECT_EQ(solver.bytes(), sizeof(double) * (10 * 5 + 10 + 5 * 4 + 3 * 5));
}

struct shared_case {
  size_t n, stride;
  int sides;
  vector b;
};

shared_case shared_sides(size_t n, int sides, std::mt19937_64 &random) {
  shared_case c{n, n + 4, sides, {}};
  c.b.assign(c.stride * static_cast<size_t>(sides), 1e9);  // what lies between is not for reading
  const vector first = drawn(n, random);
  for (int k = 0; k < sides; ++k) {
    const vector own = drawn(n, random);
    // of very different sizes, each a little like the first
    const double scale = std::pow(10.0, 3 * k);
    for (size_t i = 0; i < n; ++i)
      c.b[static_cast<size_t>(k) * c.stride + i] = scale * (first[i] + 0.3 * own[i]);
  }
  return c;
}

TEST(SharedKrylov, SolvesAllSides) {
  std::mt19937_64 random(4);
  for (size_t n : {3u, 14u, 33u})
    for (int sides : {1, 2, 4})
      for (bool each : {true, false}) {
        const dense m(n, 0.4, random);
        const shared_case c = shared_sides(n, sides, random);
        shared_krylov solver(40, 60, 4);
        vector x(c.b.size(), 7.0);
        int exact = 0, inexact = 0;
        std::vector<int> last(4, -1);
        std::vector<vector> at(4);
        const auto out = solver.solve(
            n, sides, c.stride, c.b.data(), x.data(), {1e-9, 1e-7, 200, each},
            [&](const double *z, double *w, bool is_exact, int side) {
              ++(is_exact ? exact : inexact);
              m.product(z, w);
              if (side >= 0) at[static_cast<size_t>(side)].assign(z, z + n);
              // a product in single precision
              for (size_t i = 0; i < n && !is_exact; ++i) w[i] *= 1 + 3e-8 * std::sin(i + 1.0);
            },
            [&](double *v) { by_row(v, n); });
        EXPECT_TRUE(out.converged);
        EXPECT_EQ(out.exact, exact);
        EXPECT_EQ(out.inexact, inexact);
        double worst = 0;
        for (int k = 0; k < sides; ++k) {
          const size_t begin = static_cast<size_t>(k) * c.stride;
          const vector own(x.begin() + static_cast<long>(begin),
                           x.begin() + static_cast<long>(begin + n));
          const double left = residual_of(m, &c.b[begin], own.data());
          worst = std::max(worst, left);
          EXPECT_LE(left, 1.01e-9);
          expect_near(own, m.solved({&c.b[begin], &c.b[begin] + n}), 1e-7);
          // its last product was that of what is returned
          if (each) {
            EXPECT_EQ(at[static_cast<size_t>(k)], own);
          }
          for (size_t i = n; i < c.stride; ++i) EXPECT_EQ(x[begin + i], 7.0);
        }
        EXPECT_LE(out.residual, 1e-9);
        if (each) {
          EXPECT_NEAR(out.residual, worst, 1e-13);
        } else {
          EXPECT_GE(out.residual, 0.99 * worst);
        }
        // sides that resemble each other share what they need
        EXPECT_LE(exact + inexact, static_cast<int>(n) * sides + 8);
      }
}

TEST(SharedKrylov, AWorseProductIsMeasuredAndMended) {
  std::mt19937_64 random(5);
  const size_t n = 25;
  const dense m(n, 0.4, random);
  const shared_case c = shared_sides(n, 2, random);
  for (bool each : {true, false}) {
    shared_krylov solver(25, 40, 2);
    vector x(c.b.size());
    int fresh = 0;
    const auto out = solver.solve(
        n, 2, c.stride, c.b.data(), x.data(), {1e-9, 1e-7, 200, each},
        [&](const double *z, double *w, bool exact, int side) {
          m.product(z, w);
          fresh += side >= 0 || !exact ? 0 : 1;
          // ten thousand times worse than what was said
          for (size_t i = 0; i < n && !exact; ++i) w[i] *= 1 + 1e-3 * std::sin(3.0 * i + 1.0);
        },
        [](double *) {});
    EXPECT_TRUE(out.converged);
    EXPECT_GT(fresh, 0);
    for (size_t k : {0u, 1u}) {
      EXPECT_LE(residual_of(m, &c.b[k * c.stride], &x[k * c.stride]), 1.01e-9);
    }
  }
}

TEST(SharedKrylov, EndsAtItsLimits) {
  std::mt19937_64 random(6);
  const size_t n = 20;
  const dense m(n, 0.5, random);
  const shared_case c = shared_sides(n, 2, random);
  const auto exact_product = [&](const double *z, double *w, bool, int) { m.product(z, w); };
  // fewer directions than it takes: several rounds
  shared_krylov small(20, 6, 2);
  vector x(c.b.size());
  auto out = small.solve(n, 2, c.stride, c.b.data(), x.data(), {1e-6, 0.0, 200, true},
                         exact_product, [](double *) {});
  EXPECT_TRUE(out.converged);
  // what is asked for at most: not there yet, and told so
  for (int most : {0, 1, 5}) {
    out = small.solve(n, 2, c.stride, c.b.data(), x.data(), {1e-9, 0.0, most, true}, exact_product,
                      [](double *) {});
    EXPECT_FALSE(out.converged);
    EXPECT_EQ(out.exact + out.inexact, most + 2) << most;
    double worst = 0;
    for (size_t k : {0u, 1u})
      worst = std::max(worst, residual_of(m, &c.b[k * c.stride], &x[k * c.stride]));
    EXPECT_NEAR(out.residual, worst, 1e-12);
  }
  // a side that is zero has the solution zero; it takes no part
  shared_case with_zero = c;
  std::fill_n(with_zero.b.begin(), n, 0.0);
  for (bool each : {true, false}) {
    shared_krylov solver(20, 30, 2);
    std::fill(x.begin(), x.end(), 3.0);
    out = solver.solve(n, 2, c.stride, with_zero.b.data(), x.data(), {1e-9, 0.0, 200, each},
                       exact_product, [](double *) {});
    EXPECT_TRUE(out.converged);
    for (size_t i = 0; i < n; ++i) EXPECT_EQ(x[i], 0.0);
    EXPECT_LE(residual_of(m, &c.b[c.stride], &x[c.stride]), 1.01e-9);
  }
  // more sides than it has room for: as many as it has
  shared_krylov one(20, 30, 1);
  std::fill(x.begin(), x.end(), 3.0);
  out = one.solve(n, 2, c.stride, c.b.data(), x.data(), {1e-9, 0.0, 200, true}, exact_product,
                  [](double *) {});
  EXPECT_TRUE(out.converged);
  EXPECT_LE(residual_of(m, c.b.data(), x.data()), 1.01e-9);
  EXPECT_EQ(x[c.stride], 3.0);
  // an operator that makes nothing of anything: an end
  out = one.solve(
      n, 1, c.stride, c.b.data(), x.data(), {1e-9, 0.0, 200, true},
      [&](const double *, double *w, bool, int) { std::fill_n(w, n, 0.0); }, [](double *) {});
  EXPECT_FALSE(out.converged);
  EXPECT_NEAR(out.residual, 1.0, 1e-15);
}

TEST(SharedKrylov, KnowsNothingOfMoreSidesBefore) {
  std::mt19937_64 random(7);
  const size_t n = 20;
  const dense m(n, 0.4, random);
  const shared_case c = shared_sides(n, 3, random);
  for (bool each : {true, false}) {
    shared_krylov used(20, 30, 3), fresh(20, 30, 3);
    vector x(c.b.size()), other(c.b.size(), 1e9);
    const auto solve = [&](shared_krylov &solver, int sides, vector &to) {
      return solver.solve(
          n, sides, c.stride, c.b.data(), to.data(), {1e-9, 0.0, 200, each},
          [&](const double *z, double *w, bool, int) { m.product(z, w); }, [](double *) {});
    };
    solve(used, 3, x);
    std::fill(x.begin(), x.end(), 1e9);
    const auto out = solve(used, 2, x), should = solve(fresh, 2, other);
    EXPECT_TRUE(out.converged);
    EXPECT_EQ(x, other);
    EXPECT_EQ(out.residual, should.residual);
    EXPECT_EQ(out.exact, should.exact);
  }
}

TEST(SharedKrylov, SaysWhatItHolds) {
  const shared_krylov solver(10, 6, 3);
  EXPECT_EQ(solver.bytes(),
            sizeof(double) * (2 * 10 * 6 + 10 * 3 + 2 * 10 + 6 * 6 + 6 * 3 + 3 * 3));
}

}  // namespace
