// Slip of fitted rows: at the collocation points against the influence functions summed over many
// more nodes, at the nodes by how it is blended, and its derivative against differences; and the
// elastic energy by the displacements.
#include "tangential/fitted_operator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace railpatch;
using std::numbers::pi;
using field = std::vector<double>;

constexpr int nodes = 15, points = nodes + 1;
const elastic_constants steel{82e9, 0.28, 0};

struct contact_case {
  const char *name;
  bool line, alike;
  int direction;
  double layer;  // m/Pa
};
void PrintTo(const contact_case &c, std::ostream *out) { *out << c.name; }

const contact_case cases[] = {
    {"ahead", false, false, 1, 0.0},
    {"back", false, false, -1, 0.0},
    {"mirrored", false, true, 1, 0.0},
    {"mirrored_back", false, true, -1, 0.0},
    {"layer", false, false, -1, 2e-14},
    {"line", true, false, 1, 0.0},
    {"line_back_layer", true, false, -1, 2e-14},
};

// Two areas beside each other, of one strip each, or one row of a line contact.
class Slip : public testing::TestWithParam<contact_case> {
 protected:
  const contact_case c = GetParam();
  contact_rows rows{nodes, c.line ? 1 : 2, 64};
  rolling_input input;
  std::vector<int> start;
  prescribed_force force;
  std::mt19937_64 random{20261122};

  Slip() {
    if (c.line)
      rows.set_line(3e-3, 0.02, 1e4, 4e-4);
    else
      rows.set_pressure(beside(), pressure().data());
    input.creepage[0] = 1.1e-3;
    input.creepage[1] = -7e-4;
    input.spin_creepage = 0.15;
    input.spin_offset = 3e-4;
    input.direction = c.direction;
    force.component[0] = force.component[1] = true;
    force.creepage[0] = 3e-4;
    force.creepage[1] = -5e-4;
    for (int j = 0; j <= rows.count(); ++j) start.push_back(j * nodes);
  }
  static grid beside() { return {40, 64, 0.125e-3, 0.5e-3, -19.5 * 0.125e-3, -31.5 * 0.5e-3}; }
  // wide strips far from each other: the sums over the nodes then are exact but for rounding
  field pressure() const {
    const grid g = beside();
    field p;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const bool right = g.y(j) > 0;
        const double a = right || c.alike ? 2e-3 : 1.6e-3, x = right || c.alike ? 0.0 : 3e-4;
        const double u = (g.x(i) - x) / a, v = (std::abs(g.y(j)) - 8e-3) / 5e-3;
        p.push_back(1e9 * std::sqrt(std::max(0.0, 1 - u * u - v * v)));
      }
    return p;
  }
  fitted_operator made() const {
    fitted_operator b(steel, c.layer, c.line, rows);
    b.set(rows, input);
    return b;
  }
  rolling_problem problem(bool forced) {
    rolling_problem p;
    p.rows = rows.count();
    p.row_start = start.data();
    p.force = forced ? &force : nullptr;
    return p;
  }
  size_t size() const { return 2 * static_cast<size_t>(rows.count() * nodes); }

  // Coefficients of polynomials times the square root at the edges, row by row, x and then y.
  field polynomials() {
    std::uniform_real_distribution<double> unit(-1, 1);
    field f(8 * static_cast<size_t>(rows.count()));
    for (double &v : f) v = 3e8 * unit(random);
    return f;
  }
  static double traction(const field &f, int row, int component, double angle) {
    const double *v = f.data() + 8 * row + 4 * component, u = std::cos(angle);
    return std::sin(angle) * (v[0] + u * (v[1] + u * (v[2] + u * v[3])));
  }
  field at_nodes(const field &f) const {
    field p;
    for (int j = 0; j < rows.count(); ++j)
      for (int component = 0; component < 2; ++component)
        for (int k = 0; k < nodes; ++k)
          p.push_back(traction(f, j, component, (k + 1) * pi / points));
    return p;
  }
  double position(int row, double angle) const {
    return rows[row].x + c.direction * rows[row].half_length * std::cos(angle);
  }
  static double point_angle(int i) { return (2 * i + 1) * pi / (2 * points); }

  // (du_x/dx, du_y/dx) at (x, y) from the tractions (px, py) along the line (0, height)
  void add_slope(double x, double y, double height, const double p[2], double slope[2]) const {
    const double nu = steel.poisson_ratio, g = steel.shear_modulus;
    if (c.line) {
      slope[0] -= (1 - nu) * 2 / (pi * g * x) * p[0];
      slope[1] -= 2 / (pi * g * x) * p[1];
      return;
    }
    for (int edge : {1, -1}) {
      const double h = y + 0.5 * edge * height, r = std::hypot(x, h);
      const double a = x * h / (r * r * r), b = h / (x * r), cross = -nu * h * h / (r * r * r);
      slope[0] += edge / (pi * g) * ((-a + (1 - nu) * (a - b)) * p[0] + cross * p[1]);
      slope[1] += edge / (pi * g) * (((a - b) - (1 - nu) * a) * p[1] + cross * p[0]);
    }
  }
  // s at a collocation point without what is rigid
  void elastic_slip(const field &f, int row, int i, double s[2]) const {
    // an odd number of times as many nodes: of these too the point is one of collocation
    constexpr int finer = 9 * points;
    const double x = position(row, point_angle(i));
    double slope[2] = {0, 0};
    for (int source = 0; source < rows.count(); ++source)
      for (int l = 1; l < finer; ++l) {
        const double angle = l * pi / finer;
        const double weight = rows[source].half_length * pi / finer * std::sin(angle);
        const double p[2] = {weight * traction(f, source, 0, angle),
                             weight * traction(f, source, 1, angle)};
        add_slope(x - position(source, angle), rows[row].y - rows[source].y, rows[source].height, p,
                  slope);
      }
    const double before = i * pi / points, after = (i + 1) * pi / points;
    for (int component = 0; component < 2; ++component) {
      const double change = traction(f, row, component, after) * (i < nodes) -
                            traction(f, row, component, before) * (i > 0);
      s[component] =
          -c.direction * slope[component] -
          c.direction * c.layer * change / (position(row, after) - position(row, before));
    }
  }
};

TEST_P(Slip, AtPointsIsThatOfTheInfluenceFunctions) {
  ASSERT_EQ(rows.count(), c.line ? 1 : 2);
  const field f = polynomials(), p = at_nodes(f);
  fitted_operator b = made();
  // until the first linearisation a product gives the slip ahead of each node
  field found(size());
  b.product(p.data(), found.data());
  double most = 0;
  for (double v : found) most = std::max(most, std::abs(v));
  EXPECT_GT(most, 1e-4);
  for (int j = 0; j < rows.count(); ++j)
    for (int k = 0; k < nodes; ++k) {
      double s[2];
      elastic_slip(f, j, k, s);
      for (int component = 0; component < 2; ++component)
        EXPECT_NEAR(found[static_cast<size_t>((2 * j + component) * nodes + k)], s[component],
                    1e-11 * most)
            << "row " << j << ", point " << k << ", component " << component;
    }
}

TEST_P(Slip, AtNodesIsBlended) {
  const field f = polynomials(), p = at_nodes(f);
  for (bool forced : {false, true}) {
    fitted_operator b = made();
    field found(size());
    b.micro_slip(problem(forced), p.data(), found.data());
    for (int j = 0; j < rows.count(); ++j) {
      double s[points][2], most = 0;
      for (int i = 0; i < points; ++i) {
        elastic_slip(f, j, i, s[i]);
        const double x = position(j, point_angle(i)), y = rows[j].y;
        s[i][0] += input.creepage[0] - input.spin_creepage * y;
        s[i][1] += input.creepage[1] + input.spin_creepage * (x + input.spin_offset);
        for (int component = 0; component < 2; ++component) {
          if (forced) s[i][component] += force.creepage[component];
          most = std::max(most, std::abs(s[i][component]));
        }
      }
      for (int k = 0; k < nodes; ++k) {
        // the node lies between two points; the slip of the point before it tells how far to go
        const double ahead = position(j, point_angle(k)), behind = position(j, point_angle(k + 1));
        const double tau = (position(j, (k + 1) * pi / points) - ahead) / (behind - ahead);
        const double d[2] = {tau * (s[k + 1][0] - s[k][0]), tau * (s[k + 1][1] - s[k][1])};
        const double size2 = s[k][0] * s[k][0] + s[k][1] * s[k][1];
        const double lambda = size2 / (size2 + 4 * (d[0] * d[0] + d[1] * d[1]));
        for (int component = 0; component < 2; ++component)
          EXPECT_NEAR(found[static_cast<size_t>((2 * j + component) * nodes + k)],
                      s[k][component] + lambda * d[component], 1e-10 * most)
              << "row " << j << ", node " << k << ", component " << component;
      }
    }
  }
}

// Where nothing slips the slip stays zero, whatever is beside it.
TEST_P(Slip, OfNoTractionAndNothingRigidIsZero) {
  input = {};
  input.direction = c.direction;
  fitted_operator b = made();
  const field p(size(), 0.0);
  field s(size(), 1.0), ds(size(), 1.0);
  b.micro_slip(problem(false), p.data(), s.data());
  EXPECT_EQ(s, p);
  // there the slip ahead alone counts
  b.linearise();
  const field v = at_nodes(polynomials());
  field first(size());
  b.product(v.data(), ds.data());
  made().product(v.data(), first.data());
  for (size_t i = 0; i < size(); ++i) EXPECT_EQ(ds[i], first[i]);
}

TEST_P(Slip, HasTheDerivativeOfDifferences) {
  const field p = at_nodes(polynomials()), v = at_nodes(polynomials());
  fitted_operator b = made();
  const rolling_problem forced = problem(true);
  field s(size()), found(size()), before(size()), after(size());
  const auto expect = [&](const char *what) {
    double most = 0;
    for (double d : found) most = std::max(most, std::abs(d));
    for (size_t i = 0; i < size(); ++i)
      EXPECT_NEAR((after[i] - before[i]) / 2e-6, found[i], 1e-6 * most) << what << ", " << i;
  };
  b.micro_slip(forced, p.data(), s.data());
  b.linearise();
  b.product(v.data(), found.data());
  for (double side : {-1e-6, 1e-6}) {
    field moved(p);
    for (size_t i = 0; i < size(); ++i) moved[i] += side * v[i];
    b.micro_slip(forced, moved.data(), (side < 0 ? before : after).data());
  }
  expect("traction");
  for (int component = 0; component < 2; ++component) {
    b.slip_of_creepage(forced, component, found.data());
    const double creepage = force.creepage[component];
    for (double side : {-1e-6, 1e-6}) {
      // in thousandths
      force.creepage[component] = creepage + 1e-3 * side;
      field &to = side < 0 ? before : after;
      b.micro_slip(forced, p.data(), to.data());
      for (double &d : to) d *= 1e3;
    }
    force.creepage[component] = creepage;
    expect(component == 0 ? "creepage along" : "creepage across");
  }
}

TEST_P(Slip, OfRowsIsPartOfTheProduct) {
  const field p = at_nodes(polynomials()), v = at_nodes(polynomials());
  fitted_operator b = made();
  field s(size()), all(size());
  b.micro_slip(problem(false), p.data(), s.data());
  b.linearise();
  for (int row = 0; row < rows.count(); ++row) {
    const auto begin = static_cast<size_t>(2 * row * nodes);
    field cut(v), part(2 * nodes, 1.0);
    std::fill(cut.begin() + 2 * row * nodes, cut.end(), 0.0);
    b.product(cut.data(), all.data());
    ASSERT_TRUE(b.product_of_rows_before(row, v.data(), part.data()));
    double most = 0;
    for (double d : part) most = std::max(most, std::abs(d));
    for (size_t i = 0; i < part.size(); ++i) EXPECT_NEAR(part[i], all[begin + i], 1e-13 * most);

    field matrix[2] = {field(nodes * nodes), field(nodes * nodes)};
    b.row_matrices(row, matrix[0].data(), matrix[1].data());
    for (size_t component = 0; component < 2; ++component)
      for (size_t source = 0; source < nodes; ++source) {
        field one(size(), 0.0);
        one[begin + component * nodes + source] = 1.0;
        b.product(one.data(), all.data());
        const double own = std::abs(all[begin + component * nodes + source]);
        for (size_t k = 0; k < nodes; ++k)
          EXPECT_NEAR(matrix[component][source * nodes + k], all[begin + component * nodes + k],
                      1e-12 * own);
      }
  }
}

// From the displacement at the leading edges, by sums over the nodes, and from there on by the
// slope between the nodes.
TEST_P(Slip, MakesTheElasticEnergy) {
  const field f = polynomials(), p = at_nodes(f);
  const double nu = steel.poisson_ratio, g = steel.shear_modulus;
  double energy = 0;
  for (int j = 0; j < rows.count(); ++j) {
    double u[2] = {0, 0};
    for (int source = 0; source < rows.count(); ++source)
      for (int k = 0; k < nodes; ++k) {
        const double angle = (k + 1) * pi / points, x = position(j, 0) - position(source, angle);
        for (int edge : {1, -1}) {
          const double h = rows[j].y - rows[source].y + 0.5 * edge * rows[source].height;
          const double r = std::hypot(x, h),
                       weight = edge * rows.area(source, k) / (rows[source].height * pi * g);
          const double pc[2] = {traction(f, source, 0, angle), traction(f, source, 1, angle)};
          const double log = std::asinh(h / std::abs(x)), cross = -nu * x / r;
          u[0] += weight * (((1 - nu) * log + nu * h / r) * pc[0] + cross * pc[1]);
          u[1] += weight * ((log - nu * h / r) * pc[1] + cross * pc[0]);
        }
      }
    for (int k = 0; k < nodes; ++k) {
      const double angle = (k + 1) * pi / points, before = k * pi / points;
      double s[2];
      elastic_slip(f, j, k, s);
      for (int component = 0; component < 2; ++component) {
        // the slip is the slope upstream
        u[component] += std::abs(position(j, before) - position(j, angle)) * s[component];
        energy += 0.5 * rows.area(j, k) * traction(f, j, component, angle) * u[component];
      }
    }
  }
  for (bool forced : {false, true}) {
    fitted_operator b = made();
    field s(size());
    b.micro_slip(problem(forced), p.data(), s.data());
    const double found = b.elastic_energy(rows, p.data());
    if (c.line)
      EXPECT_TRUE(std::isnan(found)) << "the displacement is known up to a constant only";
    else
      EXPECT_NEAR(found, energy, 1e-11 * std::abs(energy)) << "creepages unknown: " << forced;
  }
}

INSTANTIATE_TEST_SUITE_P(Contacts, Slip, testing::ValuesIn(cases),
                         [](const auto &i) { return std::string(i.param.name); });

}  // namespace
