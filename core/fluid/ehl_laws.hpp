// What liquid and rough surfaces contribute to one element of a lubricated contact, each value with
// its slopes.
//
// Viscosity over pressure: constant; Barus 1893 eta0 exp(alpha p); Roelands 1966
//   eta0 exp((ln eta0 + 9.67)((1 + p/p_r)^z - 1)),  p_r = 0.196 GPa,  z = alpha p_r/(ln eta0
//   + 9.67)
// (eta0 in Pa s), whose slope at p = 0 is Barus's. Density (Dowson and Higginson 1966):
//   rho/rho0 = 1 + 0.6e-9 p/(1 + 1.7e-9 p).
// Rough surfaces, heights together Gaussian with standard deviation sigma: mean planes a distance h
// apart, d = h/sigma, the higher peaks cut off (plastic truncation),
//   mean film h_T = sigma (d Phi(d) + phi(d)),  asperity pressure p_a = H (1 - Phi(d)),
// and sigma^3 K(h_T/sigma) in place of h^3 for flow by pressure (Wilson and Marsault 1998,
// isotropic roughness, after the coefficients of docs/ehl.md), 0 below the threshold where peaks
// close all ways, or h^3 (1 - 0.9 exp(-0.56 d)) (Patir and Cheng 1978, isotropic roughness, made
// for d > 0.5). sigma = 0: h_T = h, h^3, and no asperities.
#pragma once

namespace railpatch {

enum class ehl_viscosity { constant, barus, roelands };

struct ehl_liquid {
  double viscosity = 1e-3;          // Pa s, at p = 0
  double pressure_coefficient = 0;  // alpha, 1/Pa
  ehl_viscosity law = ehl_viscosity::constant;
  bool compressible = false;
};

enum class ehl_flow { wilson_marsault, patir_cheng };

struct ehl_roughness {
  double height = 0;    // m, combined standard deviation
  double hardness = 0;  // Pa, of the softer body
  ehl_flow flow = ehl_flow::wilson_marsault;
};

struct with_slope {
  double value, slope;
};
// eta(p)/eta0 and rho(p)/rho0, slopes by p
with_slope viscosity_ratio(const ehl_liquid &liquid, double p);
with_slope density_ratio(const ehl_liquid &liquid, double p);

// By h: mean film (m), its cube for the flow (m^3) and the asperities' pressure (Pa).
struct film_of_gap {
  with_slope film, cube, asperity;
};
film_of_gap film_of(const ehl_roughness &roughness, double h);

}  // namespace railpatch
