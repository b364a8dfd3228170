#include "fluid/asperities.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::inv_sqrtpi;
using std::numbers::sqrt2;

double density(double d) { return inv_sqrtpi / sqrt2 * exp(-0.5 * d * d); }

double beyond(double d) { return 0.5 * erfc(d / sqrt2); }

double mean_film(double d) {
  // far below the planes the two terms are nearly equal: Laplace's continued fraction
  if (d < -4.0) {
    const double x = -d;
    double tail = x;
    for (int k = 60; k >= 2; --k) tail = x + k / tail;
    // phi - x Q = phi (1 - x/(x + 1/tail)) = phi/(x tail + 1)
    return density(d) / (x * tail + 1.0);
  }
  return d * (1.0 - beyond(d)) + density(d);
}

// Wichura 1988, Applied Statistics 37, algorithm AS 241: within 1e-16 of it by rational functions.
double distance_of(double share) {
  static constexpr double middle[2][8] = {
      {3.387132872796366608, 133.14166789178437745, 1971.5909503065514427, 13731.693765509461125,
       45921.953931549871457, 67265.770927008700853, 33430.575583588128105, 2509.0809287301226727},
      {1.0, 42.313330701600911252, 687.1870074920579083, 5394.1960214247511077,
       21213.794301586595867, 39307.89580009271061, 28729.085735721942674, 5226.495278852545925}};
  static constexpr double tail[2][8] = {
      {1.42343711074968357734, 4.6303378461565452959, 5.7694972214606914055, 3.64784832476320460504,
       1.27045825245236838258, 0.24178072517745061177, 0.0227238449892691845833,
       7.7454501427834140764e-4},
      {1.0, 2.05319162663775882187, 1.6763848301838038494, 0.68976733498510000455,
       0.14810397642748007459, 0.0151986665636164571966, 5.475938084995344946e-4,
       1.05075007164441684324e-9}};
  static constexpr double far_tail[2][8] = {
      {6.6579046435011037772, 5.4637849111641143699, 1.7848265399172913358, 0.29656057182850489123,
       0.026532189526576123093, 0.0012426609473880784386, 2.71155556874348757815e-5,
       2.01033439929228813265e-7},
      {1.0, 0.59983220655588793769, 0.13692988092273580531, 0.0148753612908506148525,
       7.868691311456132591e-4, 1.8463183175100546818e-5, 1.4215117583164458887e-7,
       2.04426310338993978564e-15}};
  const auto ratio = [](const double c[2][8], double x) {
    double above = c[0][7], below = c[1][7];
    for (int k = 6; k >= 0; --k) {
      above = above * x + c[0][k];
      below = below * x + c[1][k];
    }
    return above / below;
  };
  const double beside = 0.5 - share;
  if (std::fabs(beside) <= 0.425) return beside * ratio(middle, 0.180625 - beside * beside);
  const double part = std::min(share, 1.0 - share), root = std::sqrt(-log(part));
  const double x = root <= 5.0 ? ratio(tail, root - 1.6) : ratio(far_tail, root - 5.0);
  return std::copysign(x, beside);
}

}  // namespace railpatch
