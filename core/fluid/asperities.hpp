// Rough surfaces of a Gaussian height, squeezed flat where they touch: plastic truncation. Over the
// combined standard deviation sigma, d is the distance of the mean planes, Phi and phi the normal
// distribution and its density:
//   mean film  h_T/sigma = d Phi(d) + phi(d),   asperity pressure  p_a = H (1 - Phi(d))
// with H the hardness of the softer body (Tabor 1951: about three times its yield stress).
#pragma once

namespace railpatch {

// of a normal distribution
double density(double d);
double beyond(double d);     // 1 - Phi
double mean_film(double d);  // d Phi + phi, over sigma
// d where 1 - Phi(d) = share, 0 < share < 1
double distance_of(double share);

}  // namespace railpatch
