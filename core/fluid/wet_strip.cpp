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

// of the flow factor where flow is barred: there the film is that of the flow
constexpr double least_flow = 1e-12;
// ends of the search for d: 1 - Phi is 1 and 1e-300 there
constexpr double lowest = -9.0, highest = 37.0;

// of the distribution's table, from -reach to reach
constexpr int reach = 8, each = 32, entries = 2 * reach * each + 1;
// 1/n!
constexpr double over[] = {1.0,       1.0,       1.0 / 2,    1.0 / 6,    1.0 / 24,
                           1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320};

}  // namespace

double flow_factor(double t) {
  const double above = std::max(t - barred_film, 0.0);
  return above * above * (flow_quadratic + flow_cubic * above);
}

double elliptic_strip::at(double cosine, double sine, double &slope) const {
  slope = cosine;
  return sine;
}

double elliptic_strip::peak() const { return 0.5 * pi; }

// d, and what goes with it.
struct strip_solver::section {
  double d, share, density, film, flow, slope;  // slope: of flow by film

  section(double at, double tail, double bell) : d(at), share(tail), density(bell) {
    film = at < -4.0 ? mean_film(at) : at * (1.0 - tail) + bell;
    flows();
  }
  // By so little that its square does not count.
  void move(double by) {
    d += by;
    film += (1.0 - share) * by;
    share -= density * by;
    flows();
  }

 private:
  void flows() {
    const double above = std::max(film - barred_film, 0.0);
    flow = std::max(above * above * (flow_quadratic + flow_cubic * above), least_flow);
    slope = above * (2.0 * flow_quadratic + 3.0 * flow_cubic * above);
  }
};

strip_solver::strip_solver(int steps) : steps_(steps) {
  for (auto *b : {&theta_, &liquid_, &film_, &liquid_rate_, &film_rate_})
    *b = aligned_buffer<double>(static_cast<size_t>(steps + 1));
  bell_ = aligned_buffer<double>(entries);
  tail_ = aligned_buffer<double>(entries);
  for (int k = 0; k < entries; ++k) {
    const double d = static_cast<double>(k) / each - reach;
    bell_[static_cast<size_t>(k)] = density(d);
    tail_[static_cast<size_t>(k)] = beyond(d);
  }
}

// By Taylor's series from the nearest entry; its terms are Hermite's polynomials.
strip_solver::section strip_solver::at(double d) const {
  const double place = (d + reach) * each + 0.5;
  if (!(place >= 0 && place < entries)) return {d, beyond(d), density(d)};
  const int k = static_cast<int>(place);
  const double n = static_cast<double>(k) / each - reach, x = d - n, square = n * n;
  const double bell = bell_[static_cast<size_t>(k)];
  const double third = square - 1.0, fourth = n * (square - 3.0);
  const double fifth = square * (square - 6.0) + 3.0;
  const double sixth = n * (square * (square - 10.0) + 15.0);
  const double sum =
      1.0 -
      x * (0.5 * n - x * (third * over[3] -
                          x * (fourth * over[4] - x * (fifth * over[5] - x * sixth * over[6]))));
  const double z = -x * (n + 0.5 * x);  // phi/phi(n) is its exponential
  double growth = over[8];
  for (int i = 7; i >= 0; --i) growth = over[i] + z * growth;
  return {d, tail_[static_cast<size_t>(k)] - bell * x * sum, bell * growth};
}

// Rates marked _end are by theta of X_c, with which all nodes move.
double strip_solver::march(const strip_pressure &pressure, double s, double r, double end,
                           double tolerance, double &slope) {
  const double h = end / steps_, over_r = 1.0 / r, over_steps = 1.0 / steps_;
  double cosine = cos(end), sine = sin(end), rise = 0;
  const double turn = cos(h), lift_of = sin(h);
  const double nominal = pressure.at(cosine, sine, rise);
  section now = at(distance_of(std::clamp(r * nominal, 1e-300, 1.0 - 1e-15)));
  flow_ = now.film;
  double d_end = now.density > 0 ? -r * rise / now.density : 0.0;
  flow_rate_ = (1.0 - now.share) * d_end;
  double p = 0, rate = 0, moved = 0;  // P, dP/dtheta, d in the last step
  double p_end = 0, rate_end = 0;
  slope = 0;
  for (int k = steps_; k > 0; --k) {
    const auto here = static_cast<size_t>(k);
    theta_[here] = k == steps_ ? end : k * h;
    liquid_[here] = p;
    film_[here] = now.film;
    liquid_rate_[here] = p_end;
    film_rate_[here] = (1.0 - now.share) * d_end;
    // P at the step's end but for its own rate
    const double known = p - 0.5 * h * rate;
    const double known_end = p_end - 0.5 * (over_steps * rate + h * rate_end);
    if (k == 1) {
      theta_[0] = 0;
      liquid_[0] = known;
      film_[0] = HUGE_VAL;
      liquid_rate_[0] = known_end;
      film_rate_[0] = 0;
      slope = known_end;
      return known;
    }
    const double before = cosine, part = (k - 1) * over_steps;
    cosine = before * turn + sine * lift_of;
    sine = sine * turn - before * lift_of;
    const double load = pressure.at(cosine, sine, rise);
    if (!(known < load)) return known - load + (k - 1);
    // load - (1 - Phi)/r - known + h/2 s sin(theta) (t - C)/K = 0 for d
    const double weight = 0.5 * h * s * sine;
    double low = lowest, high = highest, d = std::clamp(now.d + moved, lowest, highest);
    const double last = now.d;
    double grows = 1;
    for (int i = 0; i < 80; ++i) {
      now = at(d);
      const double over_flow = 1.0 / now.flow, resistance = weight * over_flow,
                   lifted = now.film - flow_;
      const double value = load - known - now.share * over_r + resistance * lifted;
      (value < 0 ? low : high) = d;
      grows = now.density * over_r +
              (1.0 - now.share) * resistance * (1.0 - lifted * now.slope * over_flow);
      const double step = -value / grows;
      if (std::fabs(step) <= tolerance) {
        now.move(step);
        break;
      }
      if (high - low < tolerance) break;
      d += step;
      if (!(d > low && d < high)) d = 0.5 * (low + high);
    }
    moved = now.d - last;
    const double over_flow = 1.0 / now.flow, lifted = (now.film - flow_) * over_flow;
    const double load_end = rise * part;
    const double pull = s * sine, pull_end = s * cosine * part;
    const double weight_end = 0.5 * (over_steps * pull + h * pull_end);
    d_end = -(load_end - known_end + weight_end * lifted - weight * flow_rate_ * over_flow) / grows;
    rate = pull * lifted;
    rate_end =
        pull_end * lifted +
        pull * over_flow * ((1.0 - now.share) * (1.0 - lifted * now.slope) * d_end - flow_rate_);
    p = load - now.share * over_r;
    p_end = load_end + now.density * over_r * d_end;
  }
  return p;
}

// What the last march found, for X_c a little farther.
void strip_solver::move(double end, double by) {
  const double h = (end + by) / steps_;
  for (int k = 0; k <= steps_; ++k) {
    const auto here = static_cast<size_t>(k);
    theta_[here] = k == steps_ ? end + by : k * h;
    liquid_[here] += by * liquid_rate_[here];
    film_[here] += by * film_rate_[here];
  }
  flow_ += by * flow_rate_;
}

end_search::end_search(double begin, double low) : least_(low) {
  most_ = high_ = pi * (1.0 - 1e-9);
  const double width = high_ - low;
  at_ = begin > 0 ? std::clamp(begin, low + 1e-6 * width, high_ - 1e-6 * width) : low + 0.4 * width;
}

double end_search::tolerance_of_distance(double precision) {
  return std::clamp(0.3 * std::sqrt(precision), 1e-7, 1e-4);
}

bool end_search::take(double value, double slope, double precision) {
  const double step = -value / slope;
  (value < 0 ? least_ : most_) = at_;
  const bool last_step = slope > 0 && std::fabs(step) <= 0.3 * std::sqrt(precision);
  if (last_step || std::fabs(value) <= precision) {
    by_ = last_step ? step : 0.0;
    residual_ = last_step ? 0.0 : value;
    return true;
  }
  const bool newton = slope > 0 && std::fabs(step) < 0.5 * last_;
  last_ = newton ? std::fabs(step) : HUGE_VAL;
  if (newton && at_ + step > least_ && at_ + step < most_) {
    at_ += step;
  } else if (!(slope > 0) && most_ < high_) {
    // too far behind, no one knows by how much: little first, as the begin is near
    at_ = std::max(at_ - back_, 0.5 * (least_ + most_));
    back_ *= 4.0;
  } else {  // near the trailing edge all is steep
    at_ = most_ < high_ ? 0.5 * (least_ + most_) : at_ + 0.25 * (most_ - at_);
  }
  return false;
}

// Newton's steps first, then those of rising_root.
strip_solution strip_solver::solve(const strip_pressure &pressure, double s, double r, double start,
                                   double precision) {
  strip_solution found;
  // theta of X_c, from the greatest pressure to the trailing edge
  const double low = pressure.peak(), high = pi * (1.0 - 1e-9), width = high - low;
  const bool warm = start > -1 && start < 1;
  end_search newton(warm ? acos(-start) : 0.0, low);
  const double begin = newton.at(), tolerance = end_search::tolerance_of_distance(precision);
  for (int k = 0; k < end_search::most_steps; ++k) {
    double slope;
    const double at = newton.at(), value = march(pressure, s, r, at, tolerance, slope);
    ++found.marches;
    if (!newton.take(value, slope, precision)) continue;
    if (newton.by() != 0) move(at, newton.by());
    found.converged = true;
    found.residual = newton.residual();
    found.cavitation = -cos(at + newton.by());
    found.flow = flow_;
    return found;
  }
  return search(pressure, s, r, {begin, warm ? 0.003 * width : 0.15 * width, low, high}, tolerance,
                precision, found.marches);
}

// By brackets, where Newton's steps lead nowhere.
strip_solution strip_solver::search(const strip_pressure &pressure, double s, double r,
                                    const range_of_end &range, double tolerance, double precision,
                                    int marches) {
  strip_solution found;
  found.marches = marches;
  rising_root root(range.begin, range.step, 64.0 * (range.high - range.low));
  double end = range.begin, slope;
  for (int k = 0; k < 200; ++k, ++found.marches) {
    const double at = root.at();
    if (at <= range.low || at >= range.high) {
      // beyond the search: a value of the right sign
      root.report(at <= range.low ? -1.0 : 1.0);
      continue;
    }
    const double value = march(pressure, s, r, at, tolerance, slope);
    const double moved = std::fabs(at - end);
    end = at;
    found.residual = value;
    found.converged = std::fabs(value) <= precision || (k > 0 && moved <= precision * at);
    if (found.converged || root.exhausted()) break;
    root.report(value);
  }
  found.converged = found.converged || root.exhausted();
  found.cavitation = -cos(end);
  found.flow = flow_;
  return found;
}

}  // namespace railpatch
