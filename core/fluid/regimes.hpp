// Creep forces by regimes of water: Polach's theory (fast/polach.hpp) with the friction
// mu = mu_0 ((1 - A) exp(-B w) + A), w the speed of the rigid slip, and the reduction factors k_A
// and k_S of a knot for each of some water rates q (the architecture of WILAC, Trummer et al. 2017,
// whose own numbers are not public). Between knots the forces, not the parameters, are interpolated
// over ln(q + q_0) by shape-preserving cubics (Fritsch and Butland 1984), so that each knot is met.
//
// Recovery by cleaning (after Allotta, Meli, Ridolfi and Rindi 2013): with W the friction work that
// was spent on each metre of the rail, by wheels before, and of the wheel, F goes over to that of
// the first knot by the share 1 - exp(-tau W).
#pragma once

#include "railpatch.h"

namespace railpatch {

struct polach_regime {
  double rate;         // m^3/s
  double k_a, k_s;     // -
  double coefficient;  // -, mu_0
  double a, b;         // -, s/m
};

struct water_regimes {
  int count = 0;
  polach_regime knot[RP_MAX_KNOTS] = {};
  double reference_rate = 1e-9;  // m^3/s, q_0
  double recovery = 0;           // 1/N, tau
  // Polach 2005, dry and wet; between them sustained low adhesion: see docs/fluids.md.
  static water_regimes shipped();
};

// Value at x of the curve through count >= 2 points, monotonic where they are; constant beyond.
double shape_preserving(const double *x, const double *y, int count, double at);

}  // namespace railpatch
