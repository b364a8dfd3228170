// Viscosity of the liquid between wheel and rail by its temperature, at the pressure of the air.
//   water   0.02939 mPa s exp(507.88/(T_K - 149.3)), Vogel's equation (1921); 5 to 80 degrees C
//   within
//           0.5 % of the tables
//   oil     ln(eta/eta_0) = (ln eta_0 + 9.67) (((T_K - 138)/(T_0K - 138))^-S_0 - 1), after Roelands
//           1966, not verified
//   table   ln eta straight between points, constant beyond
// Solids raise it: eta exp(k c), c their share of the volume (exponential after Beagley 1976, wheel
// and rail oxide with water; k is a number of the user).
#pragma once

#include "railpatch.h"

namespace railpatch {

struct viscosity {
  double value;  // Pa s
  double fall;   // 1/K, -d ln eta/dT
  double bend;   // 1/K^2, its slope: d fall/dT
};

struct viscosity_law {
  rp_liquid liquid = RP_LIQUID_GIVEN;
  double value = 1e-3;    // Pa s, given, or of oil at the reference
  double reference = 40;  // degrees C
  double slope = 1.1;     // -, S_0
  int points = 0;         // of the table
  double temperature[RP_MAX_POINTS] = {};
  double logarithm[RP_MAX_POINTS] = {};  // of Pa s
  double solids = 0;                     // -, k c

  viscosity at(double celsius) const;
};

}  // namespace railpatch
