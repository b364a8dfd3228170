// Elements in rows and what stands for their operator in the preconditioner, against the grid they
// are taken from; and a prescribed force's bordered system against elimination.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tangential/force_constraint.hpp"
#include "tangential/rolling_operator.hpp"
#include "tangential/row_strips.hpp"

namespace {

using namespace railpatch;
using vector = std::vector<double>;

// --- rows ----------------------------------------------------------------------------------------

struct pressed {
  grid g{7, 5, 1e-3, 2e-3, 0, 0};
  // row 0 whole, row 1 empty, row 2 with a gap, row 3 short, row 4 longest but one
  const char *in_contact =
      "*******"
      "......."
      "**..***"
      "...*..."
      ".*****.";
  vector pressure;
  pressed() {
    for (int k = 0; k < g.count(); ++k) pressure.push_back(in_contact[k] == '*' ? 1.0 + k : 0.0);
  }
};

TEST(RowElements, AreThoseUnderPressureFromTheLeadingEdge) {
  const pressed p;
  row_elements rows(7, 5);
  for (int direction : {1, -1}) {
    rows.collect(p.g, p.pressure.data(), direction);
    ASSERT_EQ(rows.rows(), 4);
    EXPECT_EQ(rows.count(), 18);
    EXPECT_EQ(rows.vector_size(), 36u);
    const int grid_row[] = {0, 2, 3, 4};
    size_t element = 0;
    for (int row = 0; row < 4; ++row) {
      std::vector<int> should;
      for (int i = 0; i < 7; ++i)
        if (p.pressure[static_cast<size_t>(grid_row[row] * 7 + i)] > 0)
          should.push_back(grid_row[row] * 7 + i);
      if (direction > 0) std::reverse(should.begin(), should.end());
      ASSERT_EQ(rows.length(row), static_cast<int>(should.size()));
      for (size_t k = 0; k < should.size(); ++k) EXPECT_EQ(rows.at(row)[k], should[k]);
      EXPECT_EQ(rows.gapless(row), row != 1);
      EXPECT_EQ(rows.row_start()[row], static_cast<int>(element));
      element += should.size();
    }
    EXPECT_EQ(rows.common_row(), -1);
    // vectors hold a row's x components and then its y components
    vector v(36), out(36), x(35), y(35);
    for (size_t k = 0; k < v.size(); ++k) v[k] = 1.0 + static_cast<double>(k);
    rows.product(v.data(), out.data(), [&](double *px, double *py, double *sx, double *sy) {
      size_t begin = 0;
      for (int row = 0; row < 4; ++row) {
        const auto n = static_cast<size_t>(rows.length(row));
        for (size_t k = 0; k < n; ++k) {
          const auto at = static_cast<size_t>(rows.at(row)[k]);
          EXPECT_EQ(px[at], v[begin + k]);
          EXPECT_EQ(py[at], v[begin + n + k]);
        }
        begin += 2 * n;
      }
      for (size_t at = 0; at < 35; ++at) {
        if (!(p.pressure[at] > 0)) {
          EXPECT_EQ(px[at], 0.0);
          EXPECT_EQ(py[at], 0.0);
        }
        sx[at] = 2 * px[at];
        sy[at] = 3 * py[at];
      }
    });
    size_t begin = 0;
    for (int row = 0; row < 4; ++row) {
      const auto n = static_cast<size_t>(rows.length(row));
      for (size_t k = 0; k < 2 * n; ++k) EXPECT_EQ(out[begin + k], (k < n ? 2 : 3) * v[begin + k]);
      begin += 2 * n;
    }
  }
  // without gaps the longest row, the first of them
  vector whole = p.pressure;
  for (size_t i = 14; i < 21; ++i) whole[i] = i < 18 ? 1.0 : 0.0;
  rows.collect(p.g, whole.data(), 1);
  EXPECT_EQ(rows.common_row(), 0);
  for (size_t i = 0; i < 4; ++i) whole[i] = 0;
  rows.collect(p.g, whole.data(), 1);
  EXPECT_EQ(rows.common_row(), 3);
  // with a gap in the first row alone
  whole[1] = 1;
  rows.collect(p.g, whole.data(), 1);
  EXPECT_EQ(rows.common_row(), -1);
}

TEST(RowUnknowns, CountElementsThatStickTwice) {
  struct state {
    bool stick;
  };
  const state states[] = {{true}, {false}, {true}, {false}, {true}};
  const int start[] = {0, 3, 5};
  std::vector<std::vector<size_t>> seen;
  const size_t count = for_each_row_unknown(
      2, start, states, [&](const state &, size_t first, size_t second, size_t x, size_t y) {
        seen.push_back({first, second, x, y});
      });
  EXPECT_EQ(count, 8u);
  const std::vector<std::vector<size_t>> should{
      {0, 3, 0, 3}, {1, 4, 1, 4}, {2, 4, 2, 5}, {5, 7, 6, 8}, {6, 7, 7, 9}};
  EXPECT_EQ(seen, should);
}

// The preconditioner's matrices: mean slip in a strip of rows from tractions alike in all of them,
// summed pair by pair.
TEST(RowStrips, AreMeansOverTheRowsOfAStrip) {
  const pressed p;
  const fft_plans plans({smooth_size(15)}, {smooth_size(9)});
  influence a({{82e9, 0.28, 0}}, plans);
  ASSERT_TRUE(a.set_grid(p.g));
  for (int across : {1, 2, 3, 8}) {
    row_strips strips(7, across);
    row_elements rows(7, 5);
    for (int direction : {1, -1})
      for (bool transposed : {false, true}) {
        rows.collect(p.g, p.pressure.data(), direction);
        strips.set(a, p.g, rows.rows(), transposed);
        const int strip = 1 + rows.rows() / across;
        for (int row = 0; row < rows.rows(); ++row) {
          const int n = rows.length(row);
          vector xx(static_cast<size_t>(n * n)), yy = xx;
          strips.matrices(rows, row, direction, xx.data(), yy.data());
          for (int source = 0; source < n; ++source)
            for (int observer = 0; observer < n; ++observer) {
              const int from = transposed ? observer : source, to = transposed ? source : observer;
              const int apart = rows.at(row)[to] - rows.at(row)[from];
              double sum[2] = {0, 0};
              for (int j = 0; j < strip; ++j)
                for (int k = 0; k < strip; ++k) {
                  const int across_by = j - k;
                  sum[0] += a.coefficient(kernel::xx, apart, across_by) -
                            a.coefficient(kernel::xx, apart + direction, across_by);
                  sum[1] += a.coefficient(kernel::yy, apart, across_by) -
                            a.coefficient(kernel::yy, apart + direction, across_by);
                }
              const auto at = static_cast<size_t>(source * n + observer);
              const double size = strip * a.coefficient(kernel::xx, 0, 0) / p.g.dx;
              EXPECT_NEAR(xx[at], sum[0] / (strip * p.g.dx), 1e-14 * size);
              EXPECT_NEAR(yy[at], sum[1] / (strip * p.g.dx), 1e-14 * size);
            }
        }
      }
  }
}

// --- a prescribed force --------------------------------------------------------------------------

vector solved(vector a, vector b) {
  const size_t n = b.size();
  for (size_t k = 0; k < n; ++k) {
    size_t p = k;
    for (size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[p * n + k])) p = i;
    for (size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[p * n + j]);
    std::swap(b[k], b[p]);
    for (size_t i = k + 1; i < n; ++i) {
      const double f = a[i * n + k] / a[k * n + k];
      for (size_t j = k; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
      b[i] -= f * b[k];
    }
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t j = k + 1; j < n; ++j) b[k] -= a[k * n + j] * b[j];
    b[k] /= a[k * n + k];
  }
  return b;
}

struct forced {
  std::vector<int> start{0, 4, 9};
  vector bound, area, rigid, p, s;
  prescribed_force force;
  explicit forced(std::mt19937_64 &random, int which) {
    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 9; ++k) {
      bound.push_back(0.5 + unit(random));
      area.push_back(0.5 + unit(random));
    }
    for (int k = 0; k < 18; ++k) {
      rigid.push_back(0.1 * (unit(random) - 0.5));
      p.push_back(0.4 * (unit(random) - 0.5));
      s.push_back(0);
    }
    for (int c = 0; c < 2; ++c) {
      force.component[c] = which & (1 << c);
      force.force[c] = unit(random) - 0.5;
      if (force.component[c]) force.creepage[c] = 0.2 * (unit(random) - 0.5);
    }
  }
  rolling_problem problem() {
    return {2, start.data(), bound.data(), area.data(), rigid.data(), p.data(), s.data(), &force};
  }
  // sum of area p over the elements
  double carried(int c, const vector &v) const {
    double sum = 0;
    for (int row = 0; row < 2; ++row) {
      const int begin = start[static_cast<size_t>(row)];
      const int n = start[static_cast<size_t>(row) + 1] - begin;
      for (int k = 0; k < n; ++k)
        sum += area[static_cast<size_t>(begin + k)] * v[static_cast<size_t>(2 * begin + c * n + k)];
    }
    return sum;
  }
};

TEST(PrescribedForce, IsMeasuredAndMoved) {
  std::mt19937_64 random(1);
  for (int which = 1; which < 4; ++which) {
    forced f(random, which);
    const rolling_problem problem = f.problem();
    force_constraint constraint(9);
    constraint.begin(problem, 1e-6);
    double squares = 0, capacity = 0, size = 0, miss = 0;
    for (size_t k = 0; k < 9; ++k) {
      squares += f.bound[k] * f.bound[k];
      capacity += f.bound[k] * f.area[k];
    }
    const double weight = std::sqrt(squares) / capacity;
    EXPECT_NEAR(constraint.weight(), weight, 1e-15);
    int m = 0;
    for (int c = 0; c < 2; ++c) {
      if (!f.force.component[c]) continue;
      EXPECT_EQ(constraint.component(m), c);
      const double missing = f.force.force[c] - f.carried(c, f.p);
      EXPECT_NEAR(constraint.remainder(m, problem), weight * missing, 1e-14);
      size = std::hypot(size, f.force.force[c]);
      miss = std::hypot(miss, missing);
      ++m;
    }
    EXPECT_EQ(constraint.unknowns(), m);
    EXPECT_NEAR(constraint.size(), weight * size, 1e-15);
    EXPECT_NEAR(constraint.miss(problem, f.p.data()), weight * miss, 1e-14);
    EXPECT_FALSE(constraint.beyond());
    // within the tolerance of all of friction, and beyond it
    const int c = constraint.component(0);
    f.force.force[0] = f.force.force[1] = 0;
    for (double share : {1.0, 1.0009, 1.0011, 2.0}) {
      f.force.force[c] = -share * capacity;
      constraint.begin(problem, 1e-3);
      EXPECT_EQ(constraint.beyond(), share > 1.001) << share;
    }
  }
}

// The step solves [J C; R -delta], delta a millionth of the curve's slope, and is bounded to half
// of the present creepage and half a unit; traction follows a shortened one by M^-1 C.
TEST(PrescribedForce, StepIsThatOfTheBorderedSystem) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> entry(-1, 1);
  int shortened = 0, whole = 0;
  for (int round = 0; round < 60; ++round) {
    forced f(random, 1 + round % 3);
    const rolling_problem problem = f.problem();
    force_constraint constraint(9);
    constraint.begin(problem, 1e-6);
    const double flexibility[2] = {2.0, 3.0};
    constraint.set_units(problem, flexibility, 5.0);
    const auto unknowns = static_cast<size_t>(constraint.unknowns());
    const size_t n = 13, all = n + unknowns;  // of elements, some of which stick
    double capacity = 0, given = 0;
    for (size_t k = 0; k < 9; ++k) capacity += f.bound[k] * f.area[k];
    for (double w : f.rigid) given = std::max(given, std::abs(w));
    double unit[2], now = 0, far = 1;
    for (size_t m = 0; m < unknowns; ++m) {
      const int c = constraint.component(static_cast<int>(m));
      unit[m] = capacity * flexibility[c] / 5.0 + given;
      now = std::hypot(now, f.force.creepage[c] / unit[m]);
      far += std::abs(f.force.creepage[c]) / unit[m];
    }
    // J near M, a diagonal; column near a multiple of row: the curve rises
    vector matrix(all * all, 0.0), diagonal(n), right(all), step(all), j(n * n);
    for (size_t i = 0; i < n; ++i) {
      diagonal[i] = 1.5 + 0.5 * entry(random);
      for (size_t k = 0; k < n; ++k)
        j[i * n + k] = 0.1 * entry(random) + (i == k ? diagonal[i] : 0);
    }
    for (size_t m = 0; m < unknowns; ++m)
      for (size_t i = 0; i < n; ++i) {
        constraint.row(static_cast<int>(m))[i] = i % 2 == m % 2 ? 1 + 0.3 * entry(random) : 0.0;
        constraint.column(static_cast<int>(m))[i] =
            constraint.row(static_cast<int>(m))[i] + 0.1 * entry(random);
      }
    const double much = round % 2 ? 0.05 : 20.0;
    for (double &r : right) r = much * entry(random);
    for (size_t i = 0; i < n; ++i) {
      for (size_t k = 0; k < n; ++k) matrix[i * all + k] = j[i * n + k];
      for (size_t m = 0; m < unknowns; ++m) {
        matrix[i * all + n + m] = constraint.column(static_cast<int>(m))[i];
        matrix[(n + m) * all + i] = constraint.row(static_cast<int>(m))[i];
      }
    }
    for (size_t m = 0; m < unknowns; ++m)
      matrix[(n + m) * all + n + m] =
          -1e-6 * constraint.weight() * capacity / (unit[m] * far * far * far);
    vector should = solved(matrix, right);
    gmres solver(20, 20);
    constraint.solve(
        solver, n, right.data(), step.data(), 1e-13, 100,
        [&](const double *v, double *out) {
          for (size_t i = 0; i < n; ++i) {
            out[i] = 0;
            for (size_t k = 0; k < n; ++k) out[i] += j[i * n + k] * v[k];
          }
        },
        [&](double *v) {
          for (size_t i = 0; i < n; ++i) v[i] /= diagonal[i];
        });
    double length = 0;
    for (size_t m = 0; m < unknowns; ++m) length = std::hypot(length, should[n + m] / unit[m]);
    const double share = std::min(1.0, (0.5 + 0.5 * now) / length);
    for (size_t m = 0; m < unknowns; ++m)
      for (size_t i = 0; i < n; ++i)
        should[i] +=
            constraint.column(static_cast<int>(m))[i] / diagonal[i] * (1 - share) * should[n + m];
    double size = 0;
    for (double v : should) size = std::max(size, std::abs(v));
    for (size_t i = 0; i < n; ++i) EXPECT_NEAR(step[i], should[i], 1e-9 * size) << round;
    EXPECT_EQ(constraint.travels(), share < 1);
    (share < 1 ? shortened : whole) += 1;
    // creepages along the step, and back
    double before[2] = {f.force.creepage[0], f.force.creepage[1]};
    for (double along : {1.0, 0.25}) {
      constraint.move(problem, along);
      for (size_t m = 0; m < unknowns; ++m) {
        const int c = constraint.component(static_cast<int>(m));
        EXPECT_NEAR(f.force.creepage[c], before[c] + along * share * should[n + m], 1e-9 * size);
      }
    }
    constraint.go_back(problem);
    for (int c = 0; c < 2; ++c) EXPECT_EQ(f.force.creepage[c], before[c]);
    constraint.remember();
    constraint.move(problem, 1.0);
    constraint.keep(problem);
    constraint.recall(problem);
    for (int c = 0; c < 2; ++c) EXPECT_EQ(f.force.creepage[c], before[c]);
  }
  EXPECT_GT(shortened, 10);
  EXPECT_GT(whole, 10);
}

}  // namespace
