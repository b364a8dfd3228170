// Factors of rows' diagonal blocks in single precision against the matrices they stand for: what
// they solve, put back into the equations in greater precision, for every division of stick and
// slip that a row can have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "numeric/pivoted_blocks.hpp"
#include "numeric/row_blocks.hpp"

namespace {

using namespace railpatch;
using vector = std::vector<double>;

constexpr double eps = std::numeric_limits<float>::epsilon();
double unit_draw(std::mt19937_64 &random) {
  return std::uniform_real_distribution<double>(0, 1)(random);
}

double greatest(const vector &v) {
  double most = 0;
  for (double x : v) most = std::max(most, std::abs(x));
  return most;
}

// --- pivoted blocks --------------------------------------------------------------------------

TEST(PivotedBlocks, SolveTheirSystems) {
  std::mt19937_64 random(1);
  constexpr int most = 9, rows = 3;
  pivoted_blocks blocks(most, rows);
  const int lengths[rows] = {9, 1, 4};
  std::vector<vector> matrices(rows);
  for (int row = 0; row < rows; ++row) {
    const int order = 2 * lengths[row];
    vector &a = matrices[static_cast<size_t>(row)];
    a.resize(static_cast<size_t>(order * order));
    // nothing great on the diagonal: pivots have to be exchanged
    for (int j = 0; j < order; ++j)
      for (int i = 0; i < order; ++i) {
        const double great = (i + 1) % order == j ? 3.0 + unit_draw(random) : 0.0;
        a[static_cast<size_t>(j * order + i)] =
            great + (i == j ? 0 : unit_draw(random) - 0.5) / order;
      }
    std::copy(a.begin(), a.end(), blocks.matrix(row));
  }
  // all filled before the first is factored: none reaches into another's
  for (int row : {1, 0, 2}) blocks.factor(row, lengths[row]);
  for (int row = 0; row < rows; ++row)
    for (double scale : {1.0, 1e-60, 1e60}) {
      const int order = 2 * lengths[row];
      const vector &a = matrices[static_cast<size_t>(row)];
      vector b(static_cast<size_t>(order) + 1, 77.0), v;
      for (int i = 0; i < order; ++i) b[static_cast<size_t>(i)] = scale * (unit_draw(random) - 0.5);
      v = b;
      blocks.solve(row, lengths[row], v.data());
      vector left(static_cast<size_t>(order));
      for (int i = 0; i < order; ++i) {
        left[static_cast<size_t>(i)] = b[static_cast<size_t>(i)];
        for (int j = 0; j < order; ++j)
          left[static_cast<size_t>(i)] -=
              a[static_cast<size_t>(j * order + i)] * v[static_cast<size_t>(j)];
      }
      EXPECT_LE(greatest(left), 8 * order * eps * scale) << row;
      EXPECT_EQ(v.back(), 77.0);
    }
  vector zero(18, 0.0);
  blocks.solve(0, 9, zero.data());
  EXPECT_EQ(zero, vector(18, 0.0));
  // matrices, a vector and the exchanges
  EXPECT_EQ(blocks.bytes(), sizeof(float) * (18 * 18 * rows + 18) + sizeof(int) * 18 * rows);
}

// The greatest pivot of each column, so that no factor is above one.
TEST(PivotedBlocks, ExchangeForTheGreatestPivot) {
  pivoted_blocks blocks(1, 1);
  for (double small : {0.0, 1e-6, -1e-6, -0.5}) {
    const double a[4] = {small, -1, 1, 1};  // column by column
    std::copy(a, a + 4, blocks.matrix(0));
    blocks.factor(0, 1);
    const vector b{1, 2};
    vector v = b;
    blocks.solve(0, 1, v.data());
    EXPECT_NEAR(a[0] * v[0] + a[2] * v[1], b[0], 8 * eps);
    EXPECT_NEAR(a[1] * v[0] + a[3] * v[1], b[1], 8 * eps);
  }
}

// A column without pivot counts as one of the unit matrix; the others are solved.
TEST(PivotedBlocks, SolveWhatIsRegular) {
  pivoted_blocks blocks(2, 1);
  const double a[16] = {2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8};
  std::copy(a, a + 16, blocks.matrix(0));
  blocks.factor(0, 2);
  vector v{2, 3, 4, 8};
  blocks.solve(0, 2, v.data());
  EXPECT_EQ(v, (vector{1, 3, 1, 1}));
}

// --- row blocks ------------------------------------------------------------------------------

// like those of a row of elements: nearly Cauchy's 1/(i - j + 1/2), xx and yy with other scales
struct row_matrices {
  int n;
  vector xx, yy;
  explicit row_matrices(int length) : n(length) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double distance = i - j + 0.5;
        xx.push_back(2e-3 / distance * (1 + 0.01 * (i - j)));
        yy.push_back(3e-3 / distance);
      }
  }
  // the first elements alone
  row_matrices first(int length) const {
    row_matrices part(length);
    for (int j = 0; j < length; ++j)
      for (int i = 0; i < length; ++i) {
        part.xx[static_cast<size_t>(j * length + i)] = xx[static_cast<size_t>(j * n + i)];
        part.yy[static_cast<size_t>(j * length + i)] = yy[static_cast<size_t>(j * n + i)];
      }
    return part;
  }
};

// letters: s sticks, any other slips
std::vector<element_linearisation> linearised(const std::string &state, std::mt19937_64 &random) {
  std::vector<element_linearisation> elements;
  for (char c : state) {
    if (c == 's') {
      elements.push_back({{1, 0}, 0, 300.0, true});
      continue;
    }
    const double angle = 6.28 * unit_draw(random), theta = 0.2 + 0.7 * unit_draw(random);
    elements.push_back({{std::cos(angle), std::sin(angle)}, 1 - theta, 300.0 * theta, false});
  }
  return elements;
}

// the equations of row_blocks.hpp, of z of all and z_y of those that stick
vector applied(const row_matrices &b, const std::vector<element_linearisation> &elements,
               const vector &v) {
  const auto n = static_cast<size_t>(b.n);
  vector px(n), py(n), out(v.size());
  for (size_t k = 0, second = n; k < n; ++k) {
    px[k] = elements[k].c[0] * v[k];
    py[k] = elements[k].stick ? v[second++] : elements[k].c[1] * v[k];
  }
  for (size_t k = 0, second = n; k < n; ++k) {
    double sx = 0, sy = 0;
    for (size_t j = 0; j < n; ++j) {
      sx += b.xx[j * n + k] * px[j];
      sy += b.yy[j * n + k] * py[j];
    }
    const element_linearisation &e = elements[k];
    out[k] = e.keep * v[k] + e.stiff * (e.c[0] * sx + e.c[1] * sy);
    if (e.stick) out[second++] = e.stiff * sy;
  }
  return out;
}

size_t unknowns(const std::vector<element_linearisation> &elements) {
  return elements.size() +
         static_cast<size_t>(std::count_if(elements.begin(), elements.end(),
                                           [](const auto &e) { return e.stick; }));
}

const std::vector<std::string> states = {"s",
                                         "d",
                                         "sd",
                                         "ssssssss",
                                         "dddddddd",
                                         "ssssssssd",
                                         "dsdsdsds",
                                         "sssssssddd",
                                         "ssssssssssssssssdddd",
                                         "ssssdssssddddssddd",
                                         "ddddddddddddsssss",
                                         "sssssssssssssssssssssssssdddddd",
                                         "ssssssssssssssssddddddddddssssss",
                                         "ssssssssssssssssssssssssssssssssssss"};

void expect_solved(row_blocks &blocks, int row, const row_matrices &b,
                   const std::vector<element_linearisation> &elements, std::mt19937_64 &random) {
  ASSERT_EQ(static_cast<size_t>(blocks.size(row)), unknowns(elements));
  for (double scale : {1.0, 1e-60, 1e60}) {
    vector right(unknowns(elements) + 1, 77.0);
    for (size_t i = 0; i + 1 < right.size(); ++i) right[i] = scale * (unit_draw(random) - 0.5);
    vector v = right;
    blocks.solve(row, v.data());
    EXPECT_EQ(v.back(), 77.0);
    v.pop_back(), right.pop_back();
    const vector found = applied(b, elements, v);
    vector left(v.size());
    for (size_t i = 0; i < v.size(); ++i) left[i] = right[i] - found[i];
    // no pivot or product above some units: roundings of as many terms as there are unknowns
    EXPECT_LE(greatest(left), 16 * eps * static_cast<double>(v.size()) * greatest(right));
  }
}

TEST(RowBlocks, SolveTheirEquations) {
  std::mt19937_64 random(2);
  const int longest = 36, rows = static_cast<int>(states.size());
  row_blocks blocks(longest, rows);
  std::vector<int> start{0};
  for (const auto &state : states) start.push_back(start.back() + static_cast<int>(state.size()));
  blocks.start(rows, start.data());
  std::vector<std::vector<element_linearisation>> elements;
  for (int row = 0; row < rows; ++row) {
    const auto &state = states[static_cast<size_t>(row)];
    const row_matrices b(static_cast<int>(state.size()));
    elements.push_back(linearised(state, random));
    EXPECT_FALSE(blocks.serves(row, elements.back().data()));
    EXPECT_FALSE(blocks.set_row(row, elements.back().data()));
    blocks.set_row(row, b.xx.data(), b.yy.data(), elements.back().data());
  }
  // no row's factors reach into another's
  for (int row = 0; row < rows; ++row) {
    SCOPED_TRACE(states[static_cast<size_t>(row)]);
    const row_matrices b(static_cast<int>(states[static_cast<size_t>(row)].size()));
    expect_solved(blocks, row, b, elements[static_cast<size_t>(row)], random);
    EXPECT_TRUE(blocks.serves(row, elements[static_cast<size_t>(row)].data()));
    vector zero(unknowns(elements[static_cast<size_t>(row)]), 0.0);
    const vector none = zero;
    blocks.solve(row, zero.data());
    EXPECT_EQ(zero, none);
  }
}

// By what all rows share they solve the same, but for slip further away than its traction answers
// to, which no row here is long enough for.
TEST(RowBlocks, ByWhatTheyShareSolveTheSame) {
  std::mt19937_64 random(3);
  std::vector<std::string> states = ::states;
  for (const char *rest : {"d", "dsdd", "dddddddssdd"})
    states.push_back(std::string(69, 's') + rest);
  const int longest = 80, rows = static_cast<int>(states.size());
  const row_matrices whole(longest);
  row_blocks blocks(longest, rows);
  std::vector<int> start{0};
  for (const auto &state : states) start.push_back(start.back() + static_cast<int>(state.size()));
  for (int length : {longest, 0}) {
    blocks.start(rows, start.data());
    if (length == 0) continue;
    blocks.share(longest, whole.xx.data(), whole.yy.data());
    std::vector<std::vector<element_linearisation>> elements;
    for (int row = 0; row < rows; ++row) {
      elements.push_back(linearised(states[static_cast<size_t>(row)], random));
      EXPECT_TRUE(blocks.set_row(row, elements.back().data()));
    }
    for (int row = 0; row < rows; ++row) {
      const auto &state = states[static_cast<size_t>(row)];
      SCOPED_TRACE(state);
      expect_solved(blocks, row, whole.first(static_cast<int>(state.size())),
                    elements[static_cast<size_t>(row)], random);
    }
  }
  // the next problem shares nothing before it says so
  std::vector<element_linearisation> e = linearised(states[0], random);
  EXPECT_FALSE(blocks.set_row(0, e.data()));
  // a matrix that is none of rolling is not shared
  const vector negative(whole.xx.size(), -1.0);
  blocks.share(longest, negative.data(), negative.data());
  EXPECT_FALSE(blocks.set_row(0, e.data()));
}

// In slip what lies more than four packs away is left out where rows share; nothing else is.
TEST(RowBlocks, OfLongSlipHoldWhatIsNear) {
  std::mt19937_64 random(4);
  const int n = 96;
  row_matrices whole(n);
  row_blocks blocks(n, 12);
  const int start[2] = {0, n};
  const std::string state = std::string(13, 's') + std::string(70, 'd') + std::string(13, 's');
  const auto elements = linearised(state, random);
  blocks.start(1, start);
  blocks.share(n, whole.xx.data(), whole.yy.data());
  ASSERT_TRUE(blocks.set_row(0, elements.data()));
  vector right(unknowns(elements)), shared, own;
  for (double &r : right) r = unit_draw(random) - 0.5;
  shared = own = right;
  blocks.solve(0, shared.data());
  const vector found = applied(whole, elements, shared);
  double square = 0, of_right = 0;
  for (size_t i = 0; i < right.size(); ++i) {
    square += (found[i] - right[i]) * (found[i] - right[i]);
    of_right += right[i] * right[i];
  }
  // a traction's share of what lies beyond: the tail of the Cauchy matrix, 1/32 of the pivot's pi
  EXPECT_LE(std::sqrt(square / of_right), 0.1);
  blocks.set_row(0, whole.xx.data(), whole.yy.data(), elements.data());
  expect_solved(blocks, 0, whole, elements, random);
}

TEST(RowBlocks, ServeWhileStatesAndDirectionsStay) {
  std::mt19937_64 random(5);
  const int start[3] = {0, 3, 7};
  row_blocks blocks(8, 2);
  blocks.start(2, start);
  const row_matrices b(4);
  std::vector<element_linearisation> e = linearised("sddd", random);
  const auto with = [&](int k, auto &&change) {
    auto other = e;
    change(other[static_cast<size_t>(k)]);
    return blocks.serves(1, other.data());
  };
  EXPECT_FALSE(blocks.serves(1, e.data()));
  blocks.set_row(1, b.xx.data(), b.yy.data(), e.data());
  EXPECT_TRUE(blocks.serves(1, e.data()));
  EXPECT_FALSE(blocks.serves(0, e.data()));
  for (int k = 1; k < 4; ++k) {
    const auto turned = [](double angle) {
      return [angle](element_linearisation &x) {
        const double c = std::cos(angle), s = std::sin(angle), old[2] = {x.c[0], x.c[1]};
        x.c[0] = c * old[0] - s * old[1];
        x.c[1] = s * old[0] + c * old[1];
      };
    };
    // cos 0.19 is above 0.98 and cos 0.21 below
    EXPECT_TRUE(with(k, turned(0.19)) && with(k, turned(-0.19)));
    EXPECT_FALSE(with(k, turned(0.21)) || with(k, turned(-0.21)) || with(k, turned(3.0)));
    for (int sign : {-1, 1}) {
      EXPECT_TRUE(with(k, [=](element_linearisation &x) { x.keep += sign * 0.09; }));
      EXPECT_FALSE(with(k, [=](element_linearisation &x) { x.keep += sign * 0.11; }));
    }
    EXPECT_FALSE(with(k, [](element_linearisation &x) { x.stick = true; }));
  }
  EXPECT_FALSE(with(0, [](element_linearisation &x) { x.stick = false; }));
  // in stick nothing but the state counts
  EXPECT_TRUE(with(0, [](element_linearisation &x) { x.keep = 5; }));
  blocks.start(2, start);
  EXPECT_FALSE(blocks.serves(1, e.data()));
}

}  // namespace
