// Friction that falls or rises with temperature: the outer loop on tangential problems of few
// lines.
#include "temperature/loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace railpatch;

constexpr double effusivity = 2 * 13290.0;  // steel on steel, W s^0.5/(m^2 K)

// One row of an elliptic pressure; rigid slip grows from the leading edge on, and what sticks makes
// no heat.
struct row_model {
  heat_rows rows{40, 1, 3e-4, 1, 30.0};
  std::vector<double> pressure, background, mu, q, temperature;
  heat_kernel kernel{40};
  double stuck = 0;  // share of the row, from the leading edge
  // how far slip grows where less friction holds it back, relative
  double compliance = 0;
  int calls = 0;
  row_model() : pressure(40), background(40, 20.0), mu(40, 0.3), q(40), temperature(40) {
    for (size_t i = 0; i < 40; ++i) {
      const double x = (static_cast<double>(i) - 19.5) / 20;
      pressure[i] = 8e8 * std::sqrt(1 - x * x);
    }
    kernel.set(rows, 1.0);
  }
  void tangential(const double *m, double *heat) {
    ++calls;
    double mean = 0;
    for (size_t i = 0; i < 40; ++i) mean += m[i] / 40;
    for (size_t i = 0; i < 40; ++i) {
      const double behind = (39.5 - static_cast<double>(i)) / 40;
      const double slip = 0.033 * (1 + compliance * (0.3 - mean)) * std::max(behind - stuck, 0.0);
      heat[i] = m[i] * pressure[i] * slip * rows.speed;
    }
  }
  temperature_loop_result solve(const temperature_law &law, int max_iterations = 50,
                                double tolerance = 1e-8) {
    temperature_loop loop(40);
    const temperature_loop_result r = loop.solve(
        {law, rows, &kernel, effusivity, background.data(), pressure.data()},
        {tolerance, max_iterations}, mu.data(), q.data(), [&](const double *m, double *heat) {
          tangential(m, heat);
          return true;
        });
    kernel.apply(rows, q.data(), nullptr, temperature.data());
    for (size_t i = 0; i < 40; ++i) temperature[i] = background[i] + temperature[i] / effusivity;
    return r;
  }
  // greatest deviation from the law, in temperature or coefficient, whichever is less
  double inconsistency(const temperature_law &law) const {
    double worst = 0;
    for (size_t i = 0; i < 40; ++i) {
      const double by_mu = std::fabs(mu[i] - law.coefficient(temperature[i])) / 0.3;
      const double at =
          law.reference_temperature + (mu[i] - law.reference) / law.change * law.range;
      worst = std::max(worst, std::min(by_mu, std::fabs(temperature[i] - at) / 100));
    }
    return worst;
  }
};

TEST(Loop, FullSlidingIsOnePass) {
  for (double range : {4000.0, 400.0, 40.0, 1.0, 0.01}) {
    row_model m;
    const temperature_law law{0.3, -0.18, 20, range};
    const temperature_loop_result r = m.solve(law);
    EXPECT_TRUE(r.converged) << range;
    EXPECT_LE(r.iterations, 2) << range;
    EXPECT_LT(m.inconsistency(law), 1e-7) << range;
  }
}

// Only an element's own heat counts where it rolls less than half of its length.
TEST(Loop, StepsOfPartsOfAnElement) {
  for (const double part : {0.1, 0.4, 0.6}) {
    row_model m;
    m.kernel.set(m.rows, part * m.rows.dx);
    const temperature_law law{0.3, -0.18, 20, 40};
    EXPECT_TRUE(m.solve(law).converged) << part;
    EXPECT_LT(m.inconsistency(law), 1e-7) << part;
  }
}

TEST(Loop, SlipThatAnswersConverges) {
  for (double compliance : {-2.0, 0.5, 2.0, 8.0})
    for (double change : {-0.29, -0.1, 0.1, 0.3})
      for (double range : {1000.0, 100.0, 10.0}) {
        row_model m;
        m.stuck = 0.3;
        m.compliance = compliance;
        const temperature_law law{0.3, change, 30, range};
        const temperature_loop_result r = m.solve(law);
        EXPECT_TRUE(r.converged) << compliance << " " << change << " " << range << " "
                                 << r.residual;
        EXPECT_LT(m.inconsistency(law), 1e-6) << compliance << " " << change << " " << range;
      }
}

// Greatest distance of a coefficient from the law at its temperature, over the law's greatest.
double missed(const row_model &m, const temperature_law &law) {
  double worst = 0;
  for (size_t i = 0; i < 40; ++i)
    worst = std::max(worst, std::fabs(m.mu[i] - law.coefficient(m.temperature[i])));
  return worst / std::max(law.reference, law.reference + law.change);
}

// Heat that moves far with little friction: what a pass changes says little of how far the law is.
TEST(Loop, SteepLawsAreMetAtTheTemperaturesOfTheirHeat) {
  for (double compliance : {-2.0, 0.5, 8.0})
    for (double range : {1000.0, 100.0, 10.0})
      for (double tolerance : {1e-3, 1e-5}) {
        row_model m;
        m.rows.speed = 300;
        m.kernel.set(m.rows, 1.0);
        m.stuck = 0.3;
        m.compliance = compliance;
        const temperature_law law{0.3, -0.29, 20, range};
        const temperature_loop_result r = m.solve(law, 100, tolerance);
        EXPECT_TRUE(r.converged) << compliance << " " << range << " " << r.residual;
        EXPECT_LE(missed(m, law), tolerance * (1 + 1e-9)) << compliance << " " << range;
      }
}

TEST(Loop, SaysSoWhereItDoesNotConverge) {
  row_model m;
  m.compliance = 2;
  const temperature_law law{0.3, -0.18, 20, 50};
  const temperature_loop_result r = m.solve(law, 2);
  EXPECT_FALSE(r.converged);
  EXPECT_GT(r.residual, 1e-8);
  EXPECT_LE(r.iterations, 3);
  // no coefficient is consistent with slip that is no function of friction
  row_model noisy;
  temperature_loop loop(40);
  const temperature_loop_result n = loop.solve(
      {law, noisy.rows, &noisy.kernel, effusivity, noisy.background.data(), noisy.pressure.data()},
      {1e-8, 30}, noisy.mu.data(), noisy.q.data(), [&](const double *mu, double *heat) {
        noisy.compliance = noisy.calls % 2 ? 3 : -3;
        noisy.tangential(mu, heat);
        return true;
      });
  EXPECT_FALSE(n.converged);
  EXPECT_LE(n.iterations, 31);
  EXPECT_GT(n.residual, 1e-8);
}

TEST(Loop, ATangentialProblemThatFailsIsNoResult) {
  row_model m;
  const temperature_law law{0.3, -0.18, 20, 400};
  temperature_loop loop(40);
  const temperature_loop_result r =
      loop.solve({law, m.rows, &m.kernel, effusivity, m.background.data(), m.pressure.data()},
                 {1e-8, 5}, m.mu.data(), m.q.data(), [&](const double *mu, double *heat) {
                   m.tangential(mu, heat);
                   return false;
                 });
  EXPECT_FALSE(r.converged);
}

TEST(Loop, RisingLawHasOneSolutionWhateverTheStart) {
  // heat acts downstream only, so that the leading edge decides (Volterra's equation)
  const temperature_law law{0.05, 0.55, 25, 20};
  row_model cold, hot;
  std::fill(cold.mu.begin(), cold.mu.end(), 0.05);
  std::fill(hot.mu.begin(), hot.mu.end(), 0.6);
  ASSERT_TRUE(cold.solve(law).converged);
  ASSERT_TRUE(hot.solve(law).converged);
  EXPECT_LT(cold.inconsistency(law), 1e-7);
  for (size_t i = 0; i < 40; ++i) EXPECT_NEAR(cold.mu[i], hot.mu[i], 1e-7) << i;
  EXPECT_NEAR(cold.mu[5], 0.6, 1e-12);  // hot behind
}

// What a result says is left, told anew: temperatures from the leading edge on, each coefficient by
// halving.
double change_left(const row_model &m, const temperature_law &law) {
  std::vector<double> heat(40), next(40);
  double worst = 0;
  for (int i = 39; i >= 0; --i) {
    const auto at = static_cast<size_t>(i);
    const double per_mu = m.q[at] / m.mu[at];
    double ahead = m.background[at];
    for (int k = i + 1; k < 40 && k - i < m.kernel.count(); ++k)
      ahead += m.kernel.weight(k - i) * heat[static_cast<size_t>(k)] / effusivity;
    double low = std::min(law.reference, law.reference + law.change);
    double high = std::max(law.reference, law.reference + law.change);
    for (int k = 0; k < 60; ++k) {
      const double mu = 0.5 * (low + high);
      const double t = ahead + m.kernel.weight(0) * per_mu * mu / effusivity;
      (law.coefficient(t) > mu ? low : high) = mu;
    }
    next[at] = 0.5 * (low + high);
    heat[at] = per_mu * next[at];
    worst = std::max(worst, std::fabs(next[at] - m.mu[at]));
  }
  return worst / std::max(law.reference, law.reference + law.change);
}

TEST(Loop, SaysWhatIsLeft) {
  for (double compliance : {-1.0, 2.0, 8.0})
    for (const temperature_law &law :
         {temperature_law{0.3, -0.25, 30, 150}, temperature_law{0.3, -0.1, 40, 30},
          temperature_law{0.1, 0.05, 30, 300}}) {
      double last = HUGE_VAL;
      for (int most : {1, 2, 3, 4, 5, 6}) {
        row_model m;
        std::fill(m.mu.begin(), m.mu.end(), law.reference);
        m.stuck = 0.3;
        m.compliance = compliance;
        const temperature_loop_result r = m.solve(law, most);
        EXPECT_EQ(r.iterations, m.calls);
        EXPECT_LE(r.iterations, std::max(most, 2));
        // within the tolerance also what the law itself is missed by
        double left = change_left(m, law);
        if (left <= 1e-8) left = std::max(left, missed(m, law));
        EXPECT_NEAR(r.residual, left, 1e-10) << compliance << " " << most;
        EXPECT_EQ(r.converged, r.residual <= 1e-8);
        // the best pass is the result: more passes are never worse
        EXPECT_LE(r.residual, last * (1 + 1e-9)) << compliance << " " << most;
        last = r.residual;
      }
      // a fixed point with two former passes mixed in: digits by the pass
      row_model m;
      std::fill(m.mu.begin(), m.mu.end(), law.reference);
      m.stuck = 0.3;
      m.compliance = compliance;
      const temperature_loop_result r = m.solve(law);
      EXPECT_TRUE(r.converged);
      EXPECT_LE(r.iterations, 20) << compliance << " " << law.change;
    }
}

// The step of Anderson's mixing does not take coefficients out of the law, and what has no contact
// keeps its own.
TEST(Loop, CoefficientsStayInTheLaw) {
  const temperature_law law{0.3, -0.25, 30, 60};
  row_model m;
  m.stuck = 0.2;
  m.compliance = 8;
  m.pressure[0] = m.pressure[1] = m.pressure[39] = 0;
  temperature_loop loop(40);
  const temperature_loop_result r =
      loop.solve({law, m.rows, &m.kernel, effusivity, m.background.data(), m.pressure.data()},
                 {1e-8, 50}, m.mu.data(), m.q.data(), [&](const double *mu, double *heat) {
                   for (size_t i = 2; i < 39; ++i) {
                     EXPECT_GE(mu[i], 0.05 - 1e-15);
                     EXPECT_LE(mu[i], 0.3 + 1e-15);
                   }
                   for (size_t i : {0u, 1u, 39u}) EXPECT_EQ(mu[i], 0.3);
                   m.tangential(mu, heat);
                   return true;
                 });
  EXPECT_TRUE(r.converged);
}

TEST(Loop, RootsOfOneElement) {
  const temperature_law falls{0.4, -0.3, 100, 50}, rises{0.1, 0.3, 100, 50};
  for (double a : {0.0, 90.0, 120.0, 400.0})
    for (double b : {0.0, 10.0, 300.0, 1e6})
      for (const temperature_law &law : {falls, rises}) {
        const double mu = consistent_coefficient(law, a, b, 0.2);
        const double slope = std::fabs(law.change / law.range) * b;
        EXPECT_NEAR(mu, law.coefficient(a + b * mu), 1e-13 * (1 + slope)) << a << " " << b;
      }
  // 0.1 stays below 100, 0.4 above 150: both are roots, and the nearest is taken
  EXPECT_EQ(consistent_coefficient(rises, 50, 400, 0.24), 0.1);
  EXPECT_EQ(consistent_coefficient(rises, 50, 400, 0.26), 0.4);
  EXPECT_EQ(consistent_coefficient(rises, 50, 400, 0.1), 0.1);
}

}  // namespace
