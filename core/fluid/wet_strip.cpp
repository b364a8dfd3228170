#include "fluid/wet_strip.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/asperities.hpp"
#include "numeric/elementary.hpp"
#include "numeric/rising_root.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

// isotropic: of ln 9 and 1.47476, as the source's equations have them
constexpr double barred = 0.27774310294369754, quadratic = 0.37738917651535963, cubic = 1.0019;
// of the flow factor where flow is barred: there the film is that of the flow
constexpr double least_flow = 1e-12;
// ends of the search for d: 1 - Phi is 1 and 1e-300 there
constexpr double lowest = -9.0, highest = 37.0;
constexpr double tolerance = 1e-6;

// d, and what goes with it.
struct section {
  double d, share, density, film, flow, slope;  // slope: of flow by film
  explicit section(double at) : d(at), share(beyond(at)), density(railpatch::density(at)) {
    film = at < -4.0 ? mean_film(at) : at * (1.0 - share) + density;
    const double above = std::max(film - barred, 0.0);
    flow = std::max(above * above * (quadratic + cubic * above), least_flow);
    slope = above * (2.0 * quadratic + 3.0 * cubic * above);
  }
};

}  // namespace

double flow_factor(double t) {
  const double above = std::max(t - barred, 0.0);
  return above * above * (quadratic + cubic * above);
}

double elliptic_strip::at(double theta) const { return sin(theta); }

double elliptic_strip::peak() const { return 0.5 * pi; }

strip_solver::strip_solver(int steps) : steps_(steps) {
  for (auto *b : {&theta_, &liquid_, &film_})
    *b = aligned_buffer<double>(static_cast<size_t>(steps + 1));
}

double strip_solver::march(const strip_pressure &pressure, double s, double r, double end) {
  const double h = end / steps_;
  const double nominal = pressure.at(end);
  section now(distance_of(std::clamp(r * nominal, 1e-300, 1.0 - 1e-15)));
  flow_ = now.film;
  double p = 0, rate = 0;  // P, dP/dtheta
  for (int k = steps_; k > 0; --k) {
    const auto at = static_cast<size_t>(k);
    theta_[at] = k == steps_ ? end : k * h;
    liquid_[at] = p;
    film_[at] = now.film;
    const double known = p - 0.5 * h * rate;  // P at the step's end but for its own rate
    if (k == 1) {
      theta_[0] = 0;
      liquid_[0] = known;
      film_[0] = HUGE_VAL;
      return known;
    }
    const double theta = (k - 1) * h, load = pressure.at(theta);
    if (!(known < load)) return known - load + (k - 1);
    // load - (1 - Phi)/r - known + h/2 s sin(theta) (t - C)/K = 0 for d
    const double weight = 0.5 * h * s * sin(theta);
    double low = lowest, high = highest, d = now.d;
    for (int i = 0; i < 80; ++i) {
      now = section(d);
      const double lift = (now.film - flow_) / now.flow;
      const double value = load - now.share / r - known + weight * lift;
      (value < 0 ? low : high) = d;
      const double grows =
          now.density / r + weight * (1.0 - now.share) * (1.0 - lift * now.slope) / now.flow;
      double next = d - value / grows;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      const double moved = std::fabs(next - d);
      d = next;
      if (moved <= tolerance || high - low < tolerance) {
        // Newton's next step would be its square
        now = section(d);
        break;
      }
    }
    rate = weight * 2.0 / h * (now.film - flow_) / now.flow;
    p = load - now.share / r;
  }
  return p;
}

strip_solution strip_solver::solve(const strip_pressure &pressure, double s, double r, double start,
                                   double precision) {
  strip_solution found;
  // theta of X_c, from the greatest pressure to the trailing edge
  const double low = pressure.peak(), high = pi * (1.0 - 1e-9), width = high - low;
  const bool warm = start > -1 && start < 1;
  const double begin =
      warm ? std::clamp(acos(-start), low + 1e-6 * width, high - 1e-6 * width) : low + 0.4 * width;
  rising_root root(begin, (warm ? 0.01 : 0.15) * width, 64.0 * width);
  double end = begin;
  for (; found.marches < 200; ++found.marches) {
    const double at = root.at();
    if (at <= low || at >= high) {
      // beyond the search: a value of the right sign
      root.report(at <= low ? -1.0 : 1.0);
      continue;
    }
    const double value = march(pressure, s, r, at), moved = std::fabs(at - end);
    end = at;
    found.residual = value;
    found.converged =
        std::fabs(value) <= precision || (found.marches > 0 && moved <= precision * at);
    if (found.converged || root.exhausted()) break;
    root.report(value);
  }
  found.converged = found.converged || root.exhausted();
  found.cavitation = -cos(end);
  found.flow = flow_;
  return found;
}

}  // namespace railpatch
