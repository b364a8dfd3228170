// Nothing tells the longitudinal component from the lateral one: with the two in each other's place
// the solvers of the tangential problem take the same steps to the same solution, whatever the law
// and whether creepage or force is given. And a solution is one: the contact's conditions are
// checked here anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "dense_operator.hpp"
#include "railpatch.h"
#include "tangential/inelastic_newton.hpp"

namespace {

using namespace railpatch;
using dense::dense_operator, dense::lengths;

constexpr double tolerance = 1e-8, close = 1e-6;
constexpr int rows = 5;

// One problem with its own copy of all that is read and written.
struct contact {
  dense_operator b;
  std::vector<double> bound, area, rigid, p, s;
  prescribed_force force;
  bool forced = false;

  contact(const dense_operator &operator_, std::mt19937_64 &random)
      : b(operator_),
        bound(b.size() / 2),
        area(b.size() / 2),
        rigid(b.size()),
        p(b.size()),
        s(b.size()) {
    std::uniform_real_distribution<double> entry(-1, 1);
    for (double &v : bound) v = 0.2 + std::fabs(entry(random));
    for (double &v : area) v = 1.0 + 0.3 * entry(random);
    for (double &v : rigid) v = 2 * entry(random);
  }
  contact exchanged() const {
    contact other(*this);
    other.b = b.exchanged();
    other.rigid = b.exchanged(rigid);
    other.p = b.exchanged(p);
    std::swap(other.force.component[0], other.force.component[1]);
    std::swap(other.force.force[0], other.force.force[1]);
    std::swap(other.force.creepage[0], other.force.creepage[1]);
    return other;
  }
  rolling_problem problem() {
    return {rows,         b.start().data(), bound.data(), area.data(),
            rigid.data(), p.data(),         s.data(),     forced ? &force : nullptr};
  }
  // slip from the tractions, by nothing but the operator
  std::vector<double> slip() {
    std::vector<double> v(b.size());
    b.product(p.data(), v.data());
    for_each([&](size_t, size_t x, size_t y) {
      v[x] += rigid[x] + force.creepage[0];
      v[y] += rigid[y] + force.creepage[1];
    });
    return v;
  }
  double carried(int component) {
    double sum = 0;
    for_each([&](size_t k, size_t x, size_t y) { sum += area[k] * p[component == 0 ? x : y]; });
    return sum;
  }
  template <class F>
  void for_each(F &&f) const {
    for (size_t row = 0; row < lengths.size(); ++row)
      for (int i = 0; i < lengths[row]; ++i) {
        const auto x = static_cast<size_t>(2 * b.start()[row] + i);
        f(static_cast<size_t>(b.start()[row] + i), x, x + static_cast<size_t>(lengths[row]));
      }
  }
};

// Rounding makes two of many steps.
bool brief(const tangential_result &a, const tangential_result &b) {
  return std::max(a.newton_iterations, b.newton_iterations) <= 12;
}

void expect_exchanged(const contact &one, const contact &other, const tangential_result &a,
                      const tangential_result &b) {
  EXPECT_EQ(a.newton_iterations, b.newton_iterations);
  EXPECT_NEAR(a.products, b.products, 1 + 0.03 * a.products);
  EXPECT_EQ(a.stick, b.stick);
  EXPECT_EQ(a.slip, b.slip);
  EXPECT_NEAR(a.friction, b.friction, close * std::fabs(a.friction));
  const std::vector<double> p = one.b.exchanged(one.p), s = one.b.exchanged(one.s);
  for (size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(p[i], other.p[i], close) << "traction " << i;
    EXPECT_NEAR(s[i], other.s[i], close) << "slip " << i;
  }
  for (size_t c = 0; c < 2; ++c)
    EXPECT_NEAR(one.force.creepage[c], other.force.creepage[1 - c], 10 * close);
}

// After some steps, far from the end; the preconditioner has single precision.
void expect_begun(const contact &one, const contact &other, const tangential_result &a,
                  const tangential_result &b) {
  constexpr double rounded = 1e-4;
  EXPECT_EQ(a.products, b.products);
  if (a.residual > 1e-4) {
    EXPECT_NEAR(a.residual, b.residual, rounded * a.residual);
  }
  const std::vector<double> p = one.b.exchanged(one.p);
  for (size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], other.p[i], rounded) << "traction " << i;
}

// none, one or both components of the force, a share of what friction can carry
void prescribe(contact &c, int which, std::mt19937_64 &random) {
  double capacity = 0;
  for (size_t k = 0; k < c.area.size(); ++k) capacity += c.area[k] * c.bound[k];
  c.forced = which != 0;
  for (int m = 0; m < 2; ++m) {
    c.force.component[m] = (which & (1 << m)) != 0;
    c.force.force[m] = capacity * (0.1 + 0.4 * std::uniform_real_distribution<double>()(random));
  }
}

class Components : public testing::TestWithParam<double> {};

TEST_P(Components, CanBeExchangedInRollingContact) {
  std::mt19937_64 random(20261122);
  for (int k = 0; k < 16; ++k) {
    contact one(dense_operator(GetParam(), random), random);
    prescribe(one, k % 4, random);
    contact other = one.exchanged();
    SCOPED_TRACE(testing::Message() << "case " << k);
    rolling_newton first(12, rows, one.forced), second(12, rows, one.forced);
    contact begun = one, other_begun = other;
    expect_begun(begun, other_begun, first.solve(begun.b, begun.problem(), {tolerance, 2}),
                 second.solve(other_begun.b, other_begun.problem(), {tolerance, 2}));
    const tangential_result a = first.solve(one.b, one.problem(), {tolerance, 400});
    const tangential_result b = second.solve(other.b, other.problem(), {tolerance, 400});
    EXPECT_EQ(a.converged, b.converged);
    if (k % 4 == 0) {
      EXPECT_TRUE(a.converged) << a.residual;
    }
    if (!a.converged) continue;
    if (brief(a, b)) expect_exchanged(one, other, a, b);
    for (int c = 0; c < 2; ++c)
      if (one.force.component[c]) {
        EXPECT_NEAR(one.carried(c), one.force.force[c], 1e-5 * one.force.force[c]);
      }
  }
}

// Coulomb's friction, friction that changes with slip, a layer that yields, both; with states that
// every element has from before, or that are carried along the rows.
bound_law law_of(int kind) {
  bound_law law;
  law.step = 1.5;
  law.speed = 2;
  law.by_velocity = kind % 2 == 1;
  law.slip.kinetic = law.by_velocity ? 0.8 : 0;
  law.slip.amplitude[0] = law.by_velocity ? (kind % 4 == 1 ? 0.05 : -0.3) : 0;
  if (kind % 4 == 3) law.slip.memory_distance = 0.4;
  if (kind / 4 % 2 == 1) law.yield = hardening_curve::straight(0.5, 0.3);
  law.by_magnitude = kind / 8 % 2 == 1;
  return law;
}

struct inelastic_contact : contact {
  bound_law law;
  std::vector<carried_state> before, after;
  std::vector<double> plastic, yield, friction;
  std::vector<unsigned char> state;
  bool carried_along;

  inelastic_contact(const contact &c, int kind, bool along, std::mt19937_64 &random)
      : contact(c),
        law(law_of(kind)),
        before(bound.size()),
        after(bound.size()),
        plastic(bound.size()),
        yield(bound.size()),
        friction(bound.size()),
        state(bound.size()),
        carried_along(along) {
    std::uniform_real_distribution<double> entry(-1, 1);
    for (carried_state &v : before) {
      v = {{law.remembers() ? 0.05 * entry(random) : 0.0, 0, 0}};
      if (!law.plastic()) continue;
      v.v[1] = law.by_magnitude ? 0.2 * entry(random) : 0.2 * std::fabs(entry(random));
      if (law.by_magnitude) v.v[2] = 0.2 * entry(random);
    }
  }
  inelastic_contact exchanged() const {
    inelastic_contact other(*this);
    static_cast<contact &>(other) = contact::exchanged();
    if (law.by_magnitude)
      for (carried_state &v : other.before) std::swap(v.v[1], v.v[2]);
    return other;
  }
  inelastic_result solve(int most) {
    const inelastic_problem inelastic{&law,         carried_along ? nullptr : before.data(),
                                      after.data(), law.plastic() ? plastic.data() : nullptr,
                                      yield.data(), friction.data(),
                                      state.data()};
    inelastic_newton newton(12, rows, forced);
    return newton.solve(b, problem(), inelastic, {tolerance, most});
  }
  // p opposes the slip and is what the law says after it
  void expect_conditions() {
    const std::vector<double> slip = this->slip();
    const double exact = 300 * tolerance * std::sqrt(static_cast<double>(b.size()));
    carried_state upstream{{0, 0, 0}};
    for_each([&](size_t k, size_t x, size_t y) {
      const bool first = std::count(b.start().begin(), b.start().end(), static_cast<int>(k)) > 0;
      const carried_state from = !carried_along ? before[k]
                                 : first        ? carried_state{{0, 0, 0}}
                                                : upstream;
      const double size = std::hypot(p[x], p[y]), speed = std::hypot(slip[x], slip[y]);
      const double e[2] = {p[x] / size, p[y] / size};
      EXPECT_LE(size, law.greatest(bound[k]) * (1 + 1e-9)) << k;
      if (state[k] == RP_STICK) {
        EXPECT_LE(speed, exact) << k;
        EXPECT_LE(size, law.at_rest(bound[k], from) * (1 + 1e-9)) << k;
      } else {
        EXPECT_NEAR(p[x] * slip[x] + p[y] * slip[y], -size * speed, exact * (1 + speed)) << k;
        EXPECT_NEAR(law.evaluate(bound[k], from, e, speed * law.step).bound, size, exact) << k;
      }
      upstream = after[k];
    });
  }
};

TEST_P(Components, CanBeExchangedUnderEveryLaw) {
  std::mt19937_64 random(20261123);
  int solved = 0;
  for (int k = 0; k < 64; ++k) {
    const int kind = k % 16;
    contact plain(dense_operator(GetParam(), random), random);
    if (k >= 32) prescribe(plain, 1 + k % 3, random);
    inelastic_contact one(plain, kind, k / 16 % 2 == 1, random), other = one.exchanged();
    SCOPED_TRACE(testing::Message() << "case " << k);
    inelastic_contact begun = one, other_begun = other;
    const inelastic_result c = begun.solve(2), d = other_begun.solve(2);
    expect_begun(begun, other_begun, c.tangential, d.tangential);
    const inelastic_result a = one.solve(400), b = other.solve(400);
    EXPECT_EQ(a.tangential.converged, b.tangential.converged);
    if (!a.tangential.converged) continue;
    one.expect_conditions();
    if (!brief(a.tangential, b.tangential)) continue;
    ++solved;
    expect_exchanged(one, other, a.tangential, b.tangential);
    EXPECT_EQ(a.plastic, b.plastic);
    EXPECT_EQ(a.ambiguous, b.ambiguous);
    EXPECT_NEAR(a.plastic_work, b.plastic_work, close * std::fabs(a.plastic_work));
    for (size_t i = 0; i < one.state.size(); ++i) EXPECT_EQ(one.state[i], other.state[i]) << i;
  }
  EXPECT_GT(solved, 40);
}

INSTANTIATE_TEST_SUITE_P(Skewness, Components, testing::Values(0.0, 0.2, 0.8));

}  // namespace
