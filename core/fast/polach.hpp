// Creep forces in closed form by Polach (1999, Vehicle System Dynamics Suppl. 33; 2005, Wear 258),
// for Coulomb friction: the resultant creepage with spin's lateral part
//   eta_c = eta + phi a where that is greater than eta, else eta,  nu_c = |(xi, eta_c)|
// saturates as a stress growing linearly from the leading edge does,
//   F = (2 mu Q/pi) (k_A e/(1 + (k_A e)^2) + atan(k_S e)),  e = G pi a b c_jj nu_c/(4 mu Q),
// c_jj of the resultant's direction; its parts are F xi/nu_c and F eta/nu_c. Spin adds the lateral
// force of his eqs. for pure spin, with e_s = (8/3) G b sqrt(a b) c23 |eta_c|/(mu Q S),
// S = 1 + 6.3 (1 - exp(-a/b)), d = (e_s^2 - 1)/(e_s^2 + 1):
//   F_yS = (9/16) a mu Q S (phi/nu_c) (e_s (d^3/3 - d^2/2 + 1/6) - (1 - d^2)^(3/2)/3)
// which tends to -G c^3 C23 phi for small spin. The theory has no spin moment: it is zero. Nor has
// it the power of spin, so friction counts the creepages and their forces alone.
#pragma once

#include "fast/fast_problem.hpp"

namespace railpatch {

// The creepage that saturates, and e of it.
struct resultant_creepage {
  double lateral;   // eta_c
  double size;      // nu_c
  double gradient;  // e
};
// capacity: N, mu times the normal force.
resultant_creepage resultant_of(const creepage_coefficients &c, double shear_modulus,
                                const double semi_axes[2], double capacity,
                                const rolling_input &input);
tangential_result solve_polach(const fast_problem &problem, tangential_fields fields,
                               creep_resultants &sums);

}  // namespace railpatch
