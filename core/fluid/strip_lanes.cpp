#include "fluid/strip_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fluid/asperities.hpp"
#include "fluid/strip_table.hpp"
#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

namespace {

constexpr int lanes = strip_lanes::lanes;
// of the distribution's table: from where films still let liquid pass to where nothing touches
constexpr double lowest_distance = -0.25, highest_distance = 8.0;
constexpr int entries_each = 32, entry_count = 8 * entries_each + 9;
constexpr int most_steps_of_distance = 8;

struct alignas(64) lane_numbers {
  double of[lanes];
};

// d in each lane, and what goes with it: wet_strip's section.
struct lane_sections {
  lane_numbers d, share, density, film, flow, slope;
};

// By Taylor's series from the nearest entry, to 1e-11.
RAILPATCH_INLINE void find_sections(int n, const double *bells, const double *tails,
                                    lane_sections &now) {
  lane_numbers bell, tail, off;
  int entry[lanes];
  for (int l = 0; l < n; ++l)
    entry[l] = static_cast<int>((now.d.of[l] - lowest_distance) * entries_each + 0.5);
  for (int l = 0; l < n; ++l) {
    bell.of[l] = bells[entry[l]];
    tail.of[l] = tails[entry[l]];
  }
  for (int l = 0; l < n; ++l) off.of[l] = entry[l] * (1.0 / entries_each) + lowest_distance;
  for (int l = 0; l < n; ++l) {
    const double node = off.of[l], d = now.d.of[l], x = d - node, square = node * node;
    const double third = (square - 1.0) * (1.0 / 6), fourth = node * (square - 3.0) * (1.0 / 24);
    const double sum = 1.0 - x * (0.5 * node - x * (third - x * fourth));
    const double z = -x * (node + 0.5 * x);
    const double growth =
        1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6 + z * (1.0 / 24 + z * (1.0 / 120)))));
    const double share = tail.of[l] - bell.of[l] * x * sum, density = bell.of[l] * growth;
    const double film = d * (1.0 - share) + density;
    const double above = film - barred_film;
    now.share.of[l] = share;
    now.density.of[l] = density;
    now.film.of[l] = film;
    now.flow.of[l] = above * above * (flow_quadratic + flow_cubic * above);
    now.slope.of[l] = above * (2.0 * flow_quadratic + 3.0 * flow_cubic * above);
  }
}

// of the elements of a run
RAILPATCH_DISPATCH void find_thetas(int count, double front, double over_half, double *found) {
  for (int i = 0; i < count; ++i) {
    const double x = 1.0 - (i - front) * over_half;
    found[i] = near_acos(x > -1.0 ? x : -1.0);
  }
}

}  // namespace

pressed_run pressed_run::of(const double *first, int count, bool backwards, double *squares) {
  pressed_run run;
  for (int i = 0; i < count; ++i) {
    const double p = first[backwards ? count - 1 - i : i];
    squares[i + 1] = p;
    if (p > run.greatest) run.greatest = p, run.most = i;
  }
  const double over = 1.0 / run.greatest;
  for (int i = 1; i <= count; ++i) squares[i] = (squares[i] * over) * (squares[i] * over);
  const auto edge = [&](int last, int before) {
    if (count < 2) return 0.5;
    const double fall = squares[before] - squares[last];
    return fall > 0 ? std::clamp(squares[last] / fall, 0.05, 1.0) : 1.0;
  };
  const double lead = edge(1, 2), trail = edge(count, count - 1);
  squares[0] = squares[1] * (1.0 - 1.0 / lead);
  squares[count + 1] = squares[count] * (1.0 - 1.0 / trail);
  run.squares = squares;
  run.count = count;
  run.front = -lead;
  run.half = 0.5 * (count - 1 + lead + trail);
  return run;
}

double pressed_run::theta(int i) const {
  return acos(std::clamp(1.0 - (i - front) / half, -1.0, 1.0));
}

void pressed_run::thetas(double *found) const { find_thetas(count, front, 1.0 / half, found); }

double run_pressure::at(double cosine, double sine, double &slope) const {
  const double from_first = std::max(run_.front + run_.half * (1.0 - cosine), -1.0) + 1.0;
  const int k = std::min(static_cast<int>(from_first), run_.count);
  const double left = run_.squares[k], rises = run_.squares[k + 1] - left;
  const double value = std::sqrt(std::max(left + (from_first - k) * rises, 0.0));
  slope = value > 0 ? 0.5 * run_.half * sine * rises / value : 0.0;
  return value;
}

// What a march takes and finds, in each lane.
struct strip_march {
  int eights;  // 1: a number that is read, since loops of a known length are unrolled, and stay so
  const double *squares[lanes];
  int count[lanes];
  lane_numbers front, half, s, over_r;
  lane_numbers h, cosine, sine, turn, lift;  // of X_c and a step
  lane_numbers begin;                        // d at X_c, about; found there
  lane_numbers alive;                        // 0: not of interest, or failed
  int steps;
  double tolerance;  // of d, before its last step, which cubes it
  const double *bells, *tails;
  double *liquid, *film, *liquid_rate, *film_rate;
  // P at the leading edge, or more than it could be where P meets the nominal pressure before; its
  // rate by theta of X_c, then 0
  lane_numbers value, slope, flow, flow_rate;
};

namespace {

// Nominal pressure over p_0 and its rate by theta.
template <class Task>
RAILPATCH_INLINE void press(const Task &task, const lane_numbers &cosine, const lane_numbers &sine,
                            lane_numbers &load, lane_numbers &rise) {
  const int n = lanes * task.eights;
  lane_numbers part, left, right;
  int k[lanes];
  for (int l = 0; l < n; ++l) {
    const double u = task.front.of[l] + task.half.of[l] * (1.0 - cosine.of[l]) + 1.0;
    part.of[l] = u > 0.0 ? u : 0.0;
    k[l] = static_cast<int>(part.of[l]);
  }
  for (int l = 0; l < n; ++l) {
    k[l] = k[l] < task.count[l] ? k[l] : task.count[l];
    left.of[l] = task.squares[l][k[l]];
    right.of[l] = task.squares[l][k[l] + 1];
  }
  for (int l = 0; l < n; ++l) {
    const double rises = right.of[l] - left.of[l];
    const double square = left.of[l] + (part.of[l] - k[l]) * rises;
    const double value = std::sqrt(square > 0.0 ? square : 0.0);
    load.of[l] = value;
    const double slope = 0.5 * task.half.of[l] * sine.of[l] * rises / (value > 0.0 ? value : 1.0);
    rise.of[l] = value > 0.0 ? slope : 0.0;
  }
}

// The d of each lane where load - (1 - Phi)/r - known + weight (t - C)/K = 0, from that of `now`,
// and how that grows; found: `now` is whole. A lane stays where its own step is small.
template <class Task>
RAILPATCH_INLINE void settle(Task &task, const lane_numbers &load, const lane_numbers &known,
                             const lane_numbers &weight, bool found, lane_sections &now,
                             lane_numbers &grows) {
  const int n = lanes * task.eights;
  const double tolerance = task.tolerance;
  lane_numbers step, curve;
  for (int i = 0;; ++i) {
    if (i > 0 || !found) find_sections(n, task.bells, task.tails, now);
    for (int l = 0; l < n; ++l) {
      const double over_flow = 1.0 / now.flow.of[l], resistance = weight.of[l] * over_flow;
      const double lifted = now.film.of[l] - task.flow.of[l];
      const double value =
          load.of[l] - known.of[l] - now.share.of[l] * task.over_r.of[l] + resistance * lifted;
      const double stiffens = now.slope.of[l] * over_flow, rest = 1.0 - lifted * stiffens;
      const double moves = 1.0 - now.share.of[l],
                   second =
                       2.0 * flow_quadratic + 6.0 * flow_cubic * (now.film.of[l] - barred_film);
      const double slope = now.density.of[l] * task.over_r.of[l] + moves * resistance * rest;
      const double bends =
          now.density.of[l] * (resistance * rest - now.d.of[l] * task.over_r.of[l]) -
          resistance * moves * moves * (2.0 * stiffens * rest + lifted * over_flow * second);
      grows.of[l] = slope;
      curve.of[l] = bends;
      // Halley's step, in one division
      const double halley = -value * slope / (slope * slope - 0.5 * value * bends);
      step.of[l] = task.alive.of[l] > 0.0 ? halley : 0.0;
    }
    int more = 0;
    for (int l = 0; l < n; ++l) more += !(std::fabs(step.of[l]) <= tolerance);
    // the first is by the node before, and always followed by one of its own
    if (more == 0 && i > 0) break;
    if (i >= most_steps_of_distance) {
      for (int l = 0; l < n; ++l)
        if (!(std::fabs(step.of[l]) <= tolerance)) task.alive.of[l] = step.of[l] = 0.0;
      break;
    }
    for (int l = 0; l < n; ++l) {
      double d = now.d.of[l] + (std::fabs(step.of[l]) <= tolerance ? 0.0 : step.of[l]);
      // no number among them
      d = d > lowest_distance ? d : lowest_distance;
      now.d.of[l] = d < highest_distance ? d : highest_distance;
    }
  }
  // by so little that its fourth power does not count
  for (int l = 0; l < n; ++l) {
    const double s = step.of[l], d = now.d.of[l], bell = now.density.of[l];
    now.d.of[l] = d + s;
    now.film.of[l] += s * (1.0 - now.share.of[l] + s * bell * (0.5 - s * d * (1.0 / 6)));
    now.share.of[l] -= s * bell * (1.0 - s * (0.5 * d - s * (d * d - 1.0) * (1.0 / 6)));
    now.density.of[l] = bell * (1.0 - s * (d - 0.5 * s * (d * d - 1.0)));
    grows.of[l] += s * curve.of[l];
    const double above = now.film.of[l] - barred_film;
    now.flow.of[l] = above * above * (flow_quadratic + flow_cubic * above);
    now.slope.of[l] = above * (2.0 * flow_quadratic + 3.0 * flow_cubic * above);
  }
}

// Everything of wet_strip's march, whose words these are, in each lane.
RAILPATCH_DISPATCH void march_lanes(strip_march &task) {
  const int n = lanes * task.eights;
  const double over_steps = 1.0 / task.steps;
  lane_sections now;
  lane_numbers cosine = task.cosine, sine = task.sine, load, rise, d_end, grows;
  lane_numbers p{}, rate{}, p_end{}, rate_end{}, known{}, known_end{}, weight{};
  now.d = task.begin;
  press(task, cosine, sine, load, rise);
  settle(task, load, known, weight, false, now, grows);
  task.begin = now.d;
  task.flow = now.film;
  for (int l = 0; l < n; ++l) {
    d_end.of[l] = -rise.of[l] / (task.over_r.of[l] * now.density.of[l]);
    task.flow_rate.of[l] = (1.0 - now.share.of[l]) * d_end.of[l];
    task.slope.of[l] = 0.0;
  }
  for (int k = task.steps; k > 1; --k) {
    const auto here = static_cast<size_t>(k * lanes);
    const double part = (k - 1) * over_steps;
    for (int l = 0; l < n; ++l) {
      const auto at = here + static_cast<size_t>(l);
      task.liquid[at] = p.of[l];
      task.film[at] = now.film.of[l];
      task.liquid_rate[at] = p_end.of[l];
      task.film_rate[at] = (1.0 - now.share.of[l]) * d_end.of[l];
    }
    for (int l = 0; l < n; ++l) {
      const double h = task.h.of[l], before = cosine.of[l];
      known.of[l] = p.of[l] - 0.5 * h * rate.of[l];
      known_end.of[l] = p_end.of[l] - 0.5 * (over_steps * rate.of[l] + h * rate_end.of[l]);
      cosine.of[l] = before * task.turn.of[l] + sine.of[l] * task.lift.of[l];
      sine.of[l] = sine.of[l] * task.turn.of[l] - before * task.lift.of[l];
      weight.of[l] = 0.5 * h * task.s.of[l] * sine.of[l];
    }
    press(task, cosine, sine, load, rise);
    for (int l = 0; l < n; ++l) {
      if (!(task.alive.of[l] > 0.0) || known.of[l] < load.of[l]) continue;
      task.value.of[l] = known.of[l] - load.of[l] + (k - 1);
      task.alive.of[l] = -1.0;
    }
    settle(task, load, known, weight, true, now, grows);
    for (int l = 0; l < n; ++l) {
      const double over_flow = 1.0 / now.flow.of[l];
      const double lifted = (now.film.of[l] - task.flow.of[l]) * over_flow;
      const double load_end = rise.of[l] * part, flow_rate = task.flow_rate.of[l];
      const double pull = task.s.of[l] * sine.of[l], pull_end = task.s.of[l] * cosine.of[l] * part;
      const double weight_end = 0.5 * (over_steps * pull + task.h.of[l] * pull_end);
      const double by_end = -(load_end - known_end.of[l] + weight_end * lifted -
                              weight.of[l] * flow_rate * over_flow) /
                            grows.of[l];
      rate.of[l] = pull * lifted;
      rate_end.of[l] =
          pull_end * lifted +
          pull * over_flow *
              ((1.0 - now.share.of[l]) * (1.0 - lifted * now.slope.of[l]) * by_end - flow_rate);
      p.of[l] = load.of[l] - now.share.of[l] * task.over_r.of[l];
      p_end.of[l] = load_end + now.density.of[l] * task.over_r.of[l] * by_end;
      d_end.of[l] = by_end;
    }
  }
  for (int l = 0; l < n; ++l) {
    const auto first = static_cast<size_t>(l), second = first + lanes;
    const double h = task.h.of[l];
    task.liquid[second] = p.of[l];
    task.film[second] = now.film.of[l];
    task.liquid_rate[second] = p_end.of[l];
    task.film_rate[second] = (1.0 - now.share.of[l]) * d_end.of[l];
    task.liquid[first] = p.of[l] - 0.5 * h * rate.of[l];
    task.liquid_rate[first] = p_end.of[l] - 0.5 * (over_steps * rate.of[l] + h * rate_end.of[l]);
    task.film[first] = HUGE_VAL;
    task.film_rate[first] = 0.0;
    if (!(task.alive.of[l] > 0.0)) continue;
    task.value.of[l] = task.liquid[first];
    task.slope.of[l] = task.liquid_rate[first];
  }
}

}  // namespace

strip_lanes::strip_lanes(int steps) : steps_(steps) {
  for (auto *b : {&liquid_, &film_, &liquid_rate_, &film_rate_})
    *b = aligned_buffer<double>(at(steps + 1, 0));
  bell_ = aligned_buffer<double>(entry_count);
  tail_ = aligned_buffer<double>(entry_count);
  for (size_t k = 0; k < bell_.size(); ++k) {
    const double d = static_cast<double>(k) / entries_each + lowest_distance;
    bell_[k] = density(d);
    tail_[k] = beyond(d);
  }
}

void strip_lanes::set_lane(int lane, const strip &of, strip_march &task) {
  task.squares[lane] = of.run.squares;
  task.count[lane] = of.run.count;
  task.front.of[lane] = of.run.front;
  task.half.of[lane] = of.run.half;
  task.s.of[lane] = of.s;
  task.over_r.of[lane] = 1.0 / of.r;
  task.alive.of[lane] = 1.0;
  const double low = of.run.theta(of.run.most);
  search_[lane] = end_search(of.start, low);
  const double end = search_[lane].at();
  double rise;
  const double nominal = run_pressure(of.run).at(cos(end), sin(end), rise);
  const double d = distance_of(std::clamp(of.r * nominal, 1e-300, 1.0 - 1e-15));
  task.begin.of[lane] = std::clamp(d, lowest_distance, highest_distance);
  by_[lane] = 0.0;
  found_[lane] = {};
}

void strip_lanes::solve(const strip *strips, int count, double precision) {
  strip_march task{};
  task.eights = 1;
  task.steps = steps_;
  task.tolerance = std::clamp(cbrt(0.1 * precision), 1e-6, 1e-3);
  task.bells = bell_.data();
  task.tails = tail_.data();
  task.liquid = liquid_.data();
  task.film = film_.data();
  task.liquid_rate = liquid_rate_.data();
  task.film_rate = film_rate_.data();
  for (int l = 0; l < lanes; ++l) set_lane(l, strips[l < count ? l : 0], task);
  // lanes that are at their ends march along, and find the same again
  bool done[lanes] = {};
  for (int l = count; l < lanes; ++l) done[l] = true, task.alive.of[l] = 0.0;
  int left = count;
  for (int k = 0; k < end_search::most_steps && left > 0; ++k) {
    lane_numbers begin = task.begin;
    for (int l = 0; l < lanes; ++l) {
      const double end = search_[l].at(), h = end / steps_;
      end_[l] = end;
      task.h.of[l] = h;
      task.cosine.of[l] = cos(end);
      task.sine.of[l] = sin(end);
      task.turn.of[l] = cos(h);
      task.lift.of[l] = sin(h);
    }
    march_lanes(task);
    for (int l = 0; l < count; ++l) {
      if (done[l]) {
        task.begin.of[l] = begin.of[l];
        continue;
      }
      strip_solution &found = found_[l];
      ++found.marches;
      const bool failed = task.alive.of[l] == 0.0;
      found.converged = !failed && search_[l].take(task.value.of[l], task.slope.of[l], precision);
      if (task.alive.of[l] < 0.0) task.alive.of[l] = 1.0;
      done[l] = failed || found.converged;
      left -= done[l];
      if (!found.converged) continue;
      task.begin.of[l] = begin.of[l];
      by_[l] = search_[l].by();
      found.residual = search_[l].residual();
      found.cavitation = -cos(end_[l] + by_[l]);
      found.flow = task.flow.of[l] + by_[l] * task.flow_rate.of[l];
    }
  }
}

}  // namespace railpatch
