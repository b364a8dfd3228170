#include "fluid/asperities.hpp"

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

double distance_of(double share) {
  // Newton's method on ln(1 - Phi), which is concave: from the right it does not overshoot
  const bool upper = share < 0.5;
  const double target = log(upper ? share : 1.0 - share);
  double x = std::sqrt(-2.0 * target);
  for (int k = 0; k < 60; ++k) {
    const double tail = beyond(x), step = (log(tail) - target) * tail / density(x);
    x += step;
    if (!(std::fabs(step) > 1e-15 * (1.0 + x))) break;
  }
  return upper ? x : -x;
}

}  // namespace railpatch
