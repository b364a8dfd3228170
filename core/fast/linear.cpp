#include "fast/linear.hpp"

#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// The coefficients are symmetric, so creepages never gain power.
creep_resultants linear(const creepage_coefficients &c, double shear_modulus,
                        const double semi_axes[2], const rolling_input &input) {
  const double c2 = semi_axes[0] * semi_axes[1], length = std::sqrt(c2);
  const double unit = shear_modulus * c2, phi = length * input.spin_creepage;
  const double xi = input.creepage[0], eta = input.creepage[1];
  // rolling towards -x is the mirror image: C23 changes sign
  const double c23 = input.direction * c.c23;
  creep_resultants out;
  out.force[0] = -unit * c.c11 * xi;
  out.force[1] = -unit * (c.c22 * eta + c23 * phi);
  out.moment = unit * length * (c23 * eta - c.c33 * phi);
  out.friction = unit * (c.c11 * xi * xi + c.c22 * eta * eta + c.c33 * phi * phi);
  return out;
}

}  // namespace

tangential_result solve_linear(const fast_problem &p, tangential_fields /*fields*/,
                               creep_resultants &sums) {
  sums = linear(p.coefficients, p.elastic.shear_modulus, p.axes, p.at_centre);
  sums.moment += p.centre[0] * sums.force[1] - p.centre[1] * sums.force[0];
  tangential_result result;
  result.friction = sums.friction;
  result.converged = hypot(sums.force[0], sums.force[1]) <= p.capacity;
  return result;
}

}  // namespace railpatch
