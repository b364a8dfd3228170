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
  const bool upper = share < 0.5;
  const double part = upper ? share : 1.0 - share, target = log(part);
  // within 4.5e-4 by Hastings' rational (Abramowitz and Stegun 1964, 26.2.23), then Halley's method
  // on ln(1 - Phi), whose error is cubed by each step
  const double t = std::sqrt(-2.0 * target);
  double x = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                     (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  for (int k = 0; k < 4; ++k) {
    const double tail = beyond(x), hazard = density(x) / tail;
    const double newton = (log(tail) - target) / hazard;
    // second derivative of ln(1 - Phi) over the first: the hazard less x
    const double step = newton / (1.0 - 0.5 * newton * (x - hazard));
    x += step;
    if (!(std::fabs(step) > 1e-5)) break;
  }
  return upper ? x : -x;
}

}  // namespace railpatch
