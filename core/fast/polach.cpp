#include "fast/polach.hpp"

#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::pi;

resultant_creepage resultant_of(const creepage_coefficients &c, double shear_modulus,
                                const double semi_axes[2], double capacity,
                                const rolling_input &input) {
  const double eta = input.creepage[1];
  // rolling towards -x is the mirror image: longitudinal creepage and spin change sign
  const double with_spin = eta + input.direction * input.spin_creepage * semi_axes[0];
  resultant_creepage r{};
  r.lateral = std::abs(with_spin) > std::abs(eta) ? with_spin : eta;
  r.size = hypot(input.creepage[0], r.lateral);
  if (!(r.size > 0)) return r;
  const double weighted = hypot(c.c11 * input.creepage[0], c.c22 * r.lateral);
  r.gradient = shear_modulus * pi * semi_axes[0] * semi_axes[1] * weighted / (4.0 * capacity);
  return r;
}

namespace {

creep_resultants polach(const creepage_coefficients &c, double shear_modulus,
                        const double semi_axes[2], double capacity, const polach_factors &factors,
                        const rolling_input &input) {
  creep_resultants out;
  if (!(capacity > 0)) return out;
  const resultant_creepage r = resultant_of(c, shear_modulus, semi_axes, capacity, input);
  if (!(r.size > 0)) return out;
  const double adhesion = factors.adhesion * r.gradient;
  // x/(1 + x^2), for any x
  const double hump = adhesion > 0 ? 1.0 / (adhesion + 1.0 / adhesion) : 0.0;
  const double size = 2.0 * capacity / pi * (hump + atan(factors.slip * r.gradient));
  const double eta = input.creepage[1];
  out.force[0] = -size * (input.creepage[0] / r.size);
  out.force[1] = -size * (eta / r.size);
  out.friction = -(out.force[0] * input.creepage[0] + out.force[1] * eta);

  const double a = semi_axes[0], b = semi_axes[1];
  const double shape = 1.0 + 6.3 * (1.0 - exp(-a / b));
  const double spin = 8.0 / 3.0 * shear_modulus * b * std::sqrt(a * b) * c.c23 *
                      std::abs(r.lateral) / (capacity * shape);
  // with t = 1/(1 + e_s^2), d = 1 - 2 t: what follows keeps its digits at large spin
  const double t = 1.0 / (1.0 + spin * spin);
  const double polynomial = 2.0 * t * t * (1.0 - 4.0 / 3.0 * t);
  const double root = 4.0 * t * (1.0 - t);
  const double lever = spin * polynomial - root * std::sqrt(root) / 3.0;
  out.force[1] +=
      9.0 / 16.0 * a * capacity * shape * lever * input.direction * input.spin_creepage / r.size;
  return out;
}

}  // namespace

tangential_result solve_polach(const fast_problem &p, tangential_fields /*fields*/,
                               creep_resultants &sums) {
  sums = polach(p.coefficients, p.elastic.shear_modulus, p.axes, p.capacity, p.options.polach,
                p.at_centre);
  sums.moment += p.centre[0] * sums.force[1] - p.centre[1] * sums.force[0];
  tangential_result result;
  result.friction = sums.friction;
  result.converged = true;
  return result;
}

}  // namespace railpatch
