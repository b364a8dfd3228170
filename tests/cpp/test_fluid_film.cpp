// Film of an elliptic contact: each asymptote alone, rates against differences, the load shared
// with asperities against a root found by halving, and extremes.
#include "fluid/film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fluid/asperities.hpp"
#include "fluid/mixed.hpp"

namespace {

using namespace railpatch;

constexpr double steel = 210e9 / (1.0 - 0.09);  // Pa, E'

film_contact contact_of(double speed, double viscosity, double alpha) {
  return {{0.46, 0.30}, steel, 80e3, speed, viscosity, alpha};
}

struct groups {
  double unit, n, l, d, k;
};
groups groups_of(const film_contact &c) {
  const double u = 2 * c.viscosity * c.speed / (c.modulus * c.radius[0]);
  const double d = c.radius[0] / c.radius[1];
  return {c.radius[0] * std::sqrt(u),
          c.force / (c.modulus * c.radius[0] * c.radius[0]) * std::pow(u, -0.75),
          c.pressure_coefficient * c.modulus * std::pow(u, 0.25), d,
          1 + 0.006 * std::log(d) + 0.63 * std::pow(d, 4.0 / 7.0)};
}

// With the groups N and L.
film_contact contact_with(double n, double l) {
  film_contact c = contact_of(1, 1, 1);
  const groups g = groups_of(c);
  c.force *= n / g.n;
  c.pressure_coefficient *= l / g.l;
  return c;
}

double ratio(const film_contact &c, double asymptote) {
  return elliptic_film(c).at().thickness() / (asymptote * groups_of(c).unit);
}

// A number of groups far in each corner, where the other terms are below a thousandth.
TEST(FluidFilm, RigidIsoviscousAlone) {
  film_contact c = contact_of(1, 1, 0);
  c.force = 1e-3;
  const groups g = groups_of(c);
  const double h =
      145 * std::pow(1 + 0.796 * std::pow(g.d, 14.0 / 15), -15.0 / 7) / g.d / g.n / g.n;
  EXPECT_NEAR(ratio(c, h), 1.0, 1e-3);
}

TEST(FluidFilm, ElasticIsoviscousAlone) {
  film_contact c = contact_of(1e-9, 1e-3, 0);
  const groups g = groups_of(c);
  const double h =
      3.18 * std::pow(g.k, -14.0 / 25) * std::pow(g.d, -1.0 / 15) * std::pow(g.n, -2.0 / 15);
  EXPECT_NEAR(ratio(c, h), 1.0, 1e-3);
}

TEST(FluidFilm, RigidPiezoviscousAlone) {
  const film_contact c = contact_with(10, 1e6);
  const groups g = groups_of(c);
  const double h = 1.29 * std::pow(1 + 0.691 * g.d, -2.0 / 3) * std::pow(g.l, 2.0 / 3);
  EXPECT_NEAR(ratio(c, h), 1.0, 1e-3);
}

TEST(FluidFilm, ElasticPiezoviscousAlone) {
  const film_contact c = contact_with(1e10, 1e4);
  const groups g = groups_of(c);
  const double h = 1.48 * std::pow(g.k, -7.0 / 20) * std::pow(g.d, -1.0 / 24) *
                   std::pow(g.n, -1.0 / 12) * std::pow(g.l, 0.75);
  EXPECT_NEAR(ratio(c, h), 1.0, 1e-3);
}

// Soft and hard contacts of Hamrock and Dowson (1978, 1977), with their ellipticity from D as they
// give it: k = 1.03 D^-0.64.
TEST(FluidFilm, HamrockAndDowson) {
  // at 5 m/s it is 17 %
  for (double v : {10.0, 20.0, 40.0, 72.2, 100.0}) {
    const film_contact c = contact_of(v, 1.0035e-3, 5e-10);
    const double u = c.viscosity * v / (c.modulus * c.radius[0]);
    const double w = c.force / (c.modulus * c.radius[0] * c.radius[0]);
    const double across = 1.03 * std::pow(c.radius[1] / c.radius[0], 0.64);
    const double soft = 7.32 * (1 - 0.72 * std::exp(-0.28 * across)) * std::pow(u, 0.64) *
                        std::pow(w, -0.22) * c.radius[0];
    EXPECT_NEAR(elliptic_film(c).at().thickness() / soft, 1.0, 0.15) << v;
  }
  for (double v : {1.0, 5.0, 10.0, 30.0}) {
    const film_contact c = contact_of(v, 0.1, 20e-9);
    const double u = c.viscosity * v / (c.modulus * c.radius[0]);
    const double w = c.force / (c.modulus * c.radius[0] * c.radius[0]);
    const double across = 1.03 * std::pow(c.radius[1] / c.radius[0], 0.64);
    const double hard = 2.69 * std::pow(u, 0.67) *
                        std::pow(c.pressure_coefficient * c.modulus, 0.53) * std::pow(w, -0.067) *
                        (1 - 0.61 * std::exp(-0.73 * across)) * c.radius[0];
    EXPECT_NEAR(elliptic_film(c).at().thickness() / hard, 1.0, 0.07) << v;
  }
}

TEST(FluidFilm, RatesAreThoseOfDifferences) {
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> flat(0, 1);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, flat(draw));
  };
  for (int i = 0; i < 300; ++i) {
    film_contact c{{between(0.05, 2), between(0.05, 2)},
                   between(1e9, 5e11),
                   between(100, 3e5),
                   between(0.01, 150),
                   between(1e-4, 10),
                   i % 4 == 0 ? 0.0 : between(1e-11, 5e-8)};
    const double q = i % 3 == 0 ? 1.0 : between(1e-3, 1), e = 1e-5;
    const auto logarithm = [&](double load, double speed, double part) {
      film_contact other = c;
      other.force *= std::exp(load);
      other.speed *= std::exp(speed);
      return std::log(elliptic_film(other).at(q * std::exp(part)).thickness());
    };
    const film_point p = elliptic_film(c).at(q);
    EXPECT_NEAR(p.by_load, (logarithm(e, 0, 0) - logarithm(-e, 0, 0)) / (2 * e), 1e-8) << i;
    EXPECT_NEAR(p.by_speed, (logarithm(0, e, 0) - logarithm(0, -e, 0)) / (2 * e), 1e-8) << i;
    EXPECT_NEAR(p.by_part, (logarithm(0, 0, e) - logarithm(0, 0, -e)) / (2 * e), 1e-8) << i;
  }
}

// The part of the load that the liquid carries is a contact of its own.
TEST(FluidFilm, PartIsTheReducedProblem) {
  for (double q : {1.0, 0.5, 0.1, 1e-3}) {
    const film_contact whole = contact_of(20, 1e-3, 5e-10);
    film_contact reduced = whole;
    reduced.force *= q;
    reduced.modulus *= q;
    EXPECT_NEAR(elliptic_film(whole).at(q).thickness() / elliptic_film(reduced).at().thickness(), 1,
                1e-12);
  }
}

TEST(FluidFilm, NormalDistribution) {
  // Abramowitz and Stegun 1964, table 26.1
  EXPECT_NEAR(beyond(1.0), 0.158655253931457, 1e-15);
  EXPECT_NEAR(beyond(3.0), 0.001349898031630, 1e-15);
  EXPECT_NEAR(density(1.0), 0.241970724519143, 1e-15);
  for (double d : {-7.0, -6.1, -5.9, -3.0, 0.0, 2.0, 8.0}) {
    // t'(d) = Phi(d), by Simpson's rule over short ways
    const double e = 1e-3;
    const double way = (2 * e / 6) * (beyond(e - d) + 4 * beyond(-d) + beyond(-d - e));
    EXPECT_NEAR((mean_film(d + e) - mean_film(d - e)) / way, 1, 1e-6) << d;
  }
  for (double share : {1e-30, 1e-9, 0.01, 0.3, 0.5, 0.7, 0.99})
    EXPECT_NEAR(beyond(distance_of(share)) / share, 1, 1e-12) << share;
  // Wichura 1988, his check values
  EXPECT_NEAR(distance_of(0.25) / 0.674489750196081743, 1, 1e-15);
  EXPECT_NEAR(distance_of(0.001) / 3.09023230616781354, 1, 1e-15);
  EXPECT_NEAR(distance_of(1e-20) / 9.26234008979840963, 1, 1e-15);
}

film_outcome solve(rp_fluid_share share, double roughness, double speed, double load,
                   double viscosity, fluid_supply supply = {}) {
  fluid_scene scene;
  scene.share = share;
  scene.roughness = roughness;
  scene.mean_pressure = 0;
  scene.liquid.value = viscosity;
  wet_contact contact{};
  contact.film = contact_of(speed, viscosity, 5e-10);
  contact.film.force = load;
  contact.half_width = 5e-3;
  contact.mean_pressure = 7.66e8 * std::cbrt(load / 80e3);
  contact.dry_friction = 0.5;
  return solve_film(scene, supply, contact);
}

// By halving, with nothing of the solver but the film itself.
double halved(double roughness, double speed, double load, double viscosity) {
  film_contact c = contact_of(speed, viscosity, 5e-10);
  c.force = load;
  const double pressure = 7.66e8 * std::cbrt(load / 80e3);
  double low = 0, high = 1;  // share
  for (int k = 0; k < 200; ++k) {
    const double f = 0.5 * (low + high);
    // d by the share, the film by d against that by the reduced problem
    double below = -9, above = 40;
    for (int m = 0; m < 200; ++m) {
      const double d = 0.5 * (below + above);
      (0.5 * std::erfc(d / std::sqrt(2.0)) * 2.8e9 / pressure > f ? below : above) = d;
    }
    const double d = 0.5 * (below + above);
    const double phi = std::exp(-0.5 * d * d) / std::sqrt(2 * std::acos(-1.0));
    const double rough = roughness * (d * (1 - 0.5 * std::erfc(d / std::sqrt(2.0))) + phi);
    film_contact reduced = c;
    reduced.force *= 1 - f;
    reduced.modulus *= 1 - f;
    (elliptic_film(reduced).at().thickness() > rough ? high : low) = f;
  }
  return 0.5 * (low + high);
}

TEST(FluidFilm, SharedLoadAgainstHalving) {
  for (double roughness : {2e-8, 3e-7, 1e-6, 5e-6})
    for (double speed : {0.05, 1.0, 20.0, 100.0})
      for (double load : {1e3, 8e4, 2e5}) {
        const film_outcome f = solve(RP_SHARE_LOAD_SHARING, roughness, speed, load, 1e-3);
        EXPECT_NEAR(f.share, halved(roughness, speed, load, 1e-3), 1e-9)
            << roughness << " " << speed << " " << load;
      }
}

TEST(FluidFilm, GoesOverToDry) {
  for (rp_fluid_share share : {RP_SHARE_FILM_RATIO, RP_SHARE_LOAD_SHARING}) {
    // slower and slower: boundary friction of wet surfaces
    EXPECT_NEAR(solve(share, 1e-6, 1e-7, 8e4, 1e-3).friction, 0.15, 1e-5);
    EXPECT_EQ(solve(share, 1e-6, 0, 8e4, 1e-3).friction, 0.15);
    // less and less liquid: dry
    double last = 0;
    for (double rate = 1e-6; rate > 1e-16; rate *= 0.5) {
      const double mu = solve(share, 1e-6, 20, 8e4, 1e-3, {rate, 20, NAN}).friction;
      EXPECT_GT(mu, last - 1e-12);
      EXPECT_LT(mu - last, last > 0 ? 0.2 : 1.0);
      last = mu;
    }
    EXPECT_NEAR(last, 0.5, 1e-6);
    EXPECT_EQ(solve(share, 1e-6, 20, 8e4, 1e-3, {0, 20, NAN}).friction, 0.5);
  }
}

TEST(FluidFilm, Extremes) {
  for (rp_fluid_share share : {RP_SHARE_FILM_RATIO, RP_SHARE_LOAD_SHARING})
    for (double roughness : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4})
      for (double speed : {0.0, 1e-300, 0.01, 1.0, 150.0})
        for (double load : {1e-200, 1.0, 100.0, 1e5, 1e7})
          for (double viscosity : {1e-4, 1e-3, 1.0, 1e4}) {
            const film_outcome f = solve(share, roughness, speed, load, viscosity);
            EXPECT_TRUE(f.share >= 0 && f.share <= 1 && f.friction >= 0 && f.friction <= 0.15 &&
                        std::isfinite(f.film_thickness) && f.film_thickness >= 0)
                << roughness << " " << speed << " " << load << " " << viscosity << ": " << f.share
                << " " << f.film_thickness << " " << f.friction;
          }
}

}  // namespace
