#include "fluid/strip_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "fluid/asperities.hpp"
#include "fluid/strip_table.hpp"
#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

constexpr int lanes = strip_lanes::lanes;
// of the distribution's table: from where films still let liquid pass to where nothing touches
constexpr double lowest_distance = -0.25, highest_distance = 8.0;
constexpr int entries_each = 32, entry_count = 8 * entries_each + 9;
constexpr int most_steps_of_distance = 8;
constexpr double most_way = 0.1;   // of a guess of d
constexpr double warm_way = 0.01;  // of X_c's theta: farther, rates say little of where d is

struct alignas(64) lane_numbers {
  double of[lanes];
};

// d in each lane, and what goes with it: wet_strip's section.
struct lane_sections {
  lane_numbers d, share, density, film, flow, slope;
};

// By Taylor's series from the nearest entry, to 1e-11.
RAILPATCH_INLINE void find_sections(const double *bells, const double *tails, lane_sections &now) {
  lane_numbers bell, tail, off;
  int entry[lanes];
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l)
    entry[l] = static_cast<int>((now.d.of[l] - lowest_distance) * entries_each + 0.5);
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    bell.of[l] = bells[entry[l]];
    tail.of[l] = tails[entry[l]];
  }
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) off.of[l] = entry[l] * (1.0 / entries_each) + lowest_distance;
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
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
  double all = 0, moment = 0;
  for (int i = 0; i < count; ++i) {
    const double p = first[backwards ? count - 1 - i : i];
    all += p;
    moment += p * (i - run.front - run.half);
  }
  // its centre lies at k/4
  run.lean = 4.0 * moment / (all * run.half);
  return run;
}

// The rate by k, of the solver for S from 1e-3 to 100 and r from 0.1 to 0.5, to a sixth.
double strip_lanes::strip::likely_end() const {
  const double ellipse = strip_table::end(s, r);
  return ellipse + std::min(1.08, 1.9 * (pi - ellipse)) * std::clamp(run.lean, -0.3, 0.3);
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
  const double *squares[lanes];
  int count[lanes];
  lane_numbers front, half, s, over_r;
  lane_numbers h, cosine, sine, turn, lift;  // of X_c and a step
  lane_numbers begin;                        // d at X_c, about; found there
  lane_numbers alive;                        // 0: not of interest, or failed
  lane_numbers warm, moved;  // whether the march before went all the way; theta of X_c since then
  int cold;                  // lanes that are not warm
  int steps;
  double tolerance;  // of d, before its last step, which cubes it
  const double *bells, *tails;
  double *liquid, *distance, *liquid_rate, *distance_rate;
  // P at the leading edge, or more than it could be where P meets the nominal pressure before; its
  // rate by theta of X_c, then 0
  lane_numbers value, slope, flow, flow_rate;
};

namespace {

// Nominal pressure over p_0 and its rate by theta.
template <class Task>
RAILPATCH_INLINE void press(const Task &task, const lane_numbers &cosine, const lane_numbers &sine,
                            lane_numbers &load, lane_numbers &rise) {
  lane_numbers part, left, right;
  int k[lanes];
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    const double u = task.front.of[l] + task.half.of[l] * (1.0 - cosine.of[l]) + 1.0;
    part.of[l] = u > 0.0 ? u : 0.0;
    k[l] = static_cast<int>(part.of[l]);
  }
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    k[l] = k[l] < task.count[l] ? k[l] : task.count[l];
    left.of[l] = task.squares[l][k[l]];
    right.of[l] = task.squares[l][k[l] + 1];
  }
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    const double rises = right.of[l] - left.of[l];
    const double square = left.of[l] + (part.of[l] - k[l]) * rises;
    const double value = std::sqrt(square > 0.0 ? square : 0.0);
    load.of[l] = value;
    const double slope = 0.5 * task.half.of[l] * sine.of[l] * rises / (value > 0.0 ? value : 1.0);
    rise.of[l] = value > 0.0 ? slope : 0.0;
  }
}

// d within the table; what is no number too
RAILPATCH_INLINE double in_table(double d) {
  d = d > lowest_distance ? d : lowest_distance;
  return d < highest_distance ? d : highest_distance;
}

// The d of each lane where load - (1 - Phi)/r - known + weight (t - C)/K = 0, and how that grows.
// It begins with that of `guess`, or without one of `now`; with a guess `now` is whole, of the node
// before, and lanes that are not warm take a step from there. A lane stays where its own step is
// small.
template <class Task>
RAILPATCH_INLINE void settle(Task &task, const lane_numbers &load, const lane_numbers &known,
                             const lane_numbers &weight, const lane_numbers *guess,
                             lane_sections &now, lane_numbers &grows) {
  const double tolerance = task.tolerance;
  lane_numbers step, curve;
  const bool all_warm = guess && task.cold == 0;
  if (all_warm) now.d = *guess;
  for (int i = all_warm ? 1 : 0;; ++i) {
    if (i > 0 || !guess) find_sections(task.bells, task.tails, now);
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l) {
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
    int64_t more = 0;  // as wide as a lane
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l) more += std::fabs(step.of[l]) <= tolerance ? 0 : 1;
    // the first is by the node before, and always followed by one of its own
    if (more == 0 && i > 0) break;
    if (i >= most_steps_of_distance) {
      RAILPATCH_ROLLED
      for (int l = 0; l < lanes; ++l)
        if (!(std::fabs(step.of[l]) <= tolerance)) task.alive.of[l] = step.of[l] = 0.0;
      break;
    }
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l)
      now.d.of[l] = in_table(now.d.of[l] + (std::fabs(step.of[l]) <= tolerance ? 0.0 : step.of[l]));
    if (i > 0 || !guess) continue;
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l)
      now.d.of[l] = task.warm.of[l] > 0.0 ? guess->of[l] : now.d.of[l];
  }
  // by so little that its fourth power does not count
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
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

// What a march has found of a node, for the next one.
template <class Task>
RAILPATCH_INLINE void write_node(Task &task, size_t node, const lane_numbers &p,
                                 const lane_numbers &d, const lane_numbers &p_end,
                                 const lane_numbers &d_end) {
  RAILPATCH_INDEPENDENT
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    const auto at = node + static_cast<size_t>(l);
    task.liquid[at] = p.of[l];
    task.distance[at] = d.of[l];
    task.liquid_rate[at] = p_end.of[l];
    task.distance_rate[at] = d_end.of[l];
  }
}

// Where d of a node lies by the last march, as far as the beginning has moved since.
template <class Task>
RAILPATCH_INLINE void look_back(const Task &task, size_t node, lane_numbers &guess) {
  RAILPATCH_INDEPENDENT
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    const auto at = node + static_cast<size_t>(l);
    double way = task.moved.of[l] * task.distance_rate[at];
    way = way > -most_way ? way : -most_way;
    guess.of[l] = in_table(task.distance[at] + (way < most_way ? way : most_way));
  }
}

// Everything of wet_strip's march, whose words these are, in each lane.
RAILPATCH_DISPATCH void march_lanes(strip_march &task) {
  const double over_steps = 1.0 / task.steps;
  lane_sections now;
  lane_numbers cosine = task.cosine, sine = task.sine, load, rise, d_end, grows;
  lane_numbers p{}, rate{}, p_end{}, rate_end{}, known{}, known_end{}, weight{}, guess{};
  now.d = task.begin;
  press(task, cosine, sine, load, rise);
  settle(task, load, known, weight, nullptr, now, grows);
  task.begin = now.d;
  task.flow = now.film;
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    d_end.of[l] = -rise.of[l] / (task.over_r.of[l] * now.density.of[l]);
    task.flow_rate.of[l] = (1.0 - now.share.of[l]) * d_end.of[l];
    task.slope.of[l] = 0.0;
  }
  for (int k = task.steps; k > 1; --k) {
    const auto here = static_cast<size_t>(k * lanes);
    const double part = (k - 1) * over_steps;
    write_node(task, here, p, now.d, p_end, d_end);
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l) {
      const double h = task.h.of[l], before = cosine.of[l];
      known.of[l] = p.of[l] - 0.5 * h * rate.of[l];
      known_end.of[l] = p_end.of[l] - 0.5 * (over_steps * rate.of[l] + h * rate_end.of[l]);
      cosine.of[l] = before * task.turn.of[l] + sine.of[l] * task.lift.of[l];
      sine.of[l] = sine.of[l] * task.turn.of[l] - before * task.lift.of[l];
      weight.of[l] = 0.5 * h * task.s.of[l] * sine.of[l];
    }
    look_back(task, here - lanes, guess);
    press(task, cosine, sine, load, rise);
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l) {
      if (!(task.alive.of[l] > 0.0) || known.of[l] < load.of[l]) continue;
      task.value.of[l] = known.of[l] - load.of[l] + (k - 1);
      task.alive.of[l] = -1.0;
    }
    settle(task, load, known, weight, &guess, now, grows);
    RAILPATCH_ROLLED
    for (int l = 0; l < lanes; ++l) {
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
  write_node(task, lanes, p, now.d, p_end, d_end);
  RAILPATCH_ROLLED
  for (int l = 0; l < lanes; ++l) {
    const auto first = static_cast<size_t>(l);
    const double h = task.h.of[l];
    task.liquid[first] = p.of[l] - 0.5 * h * rate.of[l];
    task.liquid_rate[first] = p_end.of[l] - 0.5 * (over_steps * rate.of[l] + h * rate_end.of[l]);
    if (!(task.alive.of[l] > 0.0)) continue;
    task.value.of[l] = task.liquid[first];
    task.slope.of[l] = task.liquid_rate[first];
  }
}

}  // namespace

strip_lanes::strip_lanes(int steps) : steps_(steps) {
  for (auto *b : {&liquid_, &distance_, &liquid_rate_, &distance_rate_, &kept_})
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
  // the table's nearest d: settling begins there
  const double *least = std::lower_bound(tail_.begin(), tail_.begin() + 8 * entries_each,
                                         of.r * nominal, std::greater<double>());
  task.begin.of[lane] = static_cast<double>(least - tail_.begin()) / entries_each + lowest_distance;
  found_[lane] = {};
}

void strip_lanes::solve(const strip *strips, int count, double precision) {
  strip_march task{};
  task.steps = steps_;
  task.tolerance = std::clamp(cbrt(0.1 * precision), 1e-6, 1e-3);
  task.bells = bell_.data();
  task.tails = tail_.data();
  task.liquid = liquid_.data();
  task.distance = distance_.data();
  task.liquid_rate = liquid_rate_.data();
  task.distance_rate = distance_rate_.data();
  for (int l = 0; l < lanes; ++l) set_lane(l, strips[l < count ? l : 0], task);
  // lanes that are at their ends march along; what they found is kept
  bool done[lanes] = {};
  for (int l = count; l < lanes; ++l) done[l] = true, task.alive.of[l] = 0.0;
  int left = count;
  task.cold = count;
  for (int k = 0; k < end_search::most_steps && left > 0; ++k) {
    for (int l = 0; l < lanes; ++l) {
      if (done[l]) continue;
      const double end = search_[l].at(), h = end / steps_;
      task.moved.of[l] = end - end_[l];
      end_[l] = end;
      task.h.of[l] = h;
      task.cosine.of[l] = cos(end);
      task.sine.of[l] = sin(end);
      task.turn.of[l] = cos(h);
      task.lift.of[l] = sin(h);
    }
    march_lanes(task);
    task.cold = 0;
    for (int l = 0; l < count; ++l) {
      if (done[l]) continue;
      strip_solution &found = found_[l];
      ++found.marches;
      const bool failed = task.alive.of[l] == 0.0, whole = task.alive.of[l] > 0.0;
      found.converged = !failed && search_[l].take(task.value.of[l], task.slope.of[l], precision);
      done[l] = failed || found.converged;
      left -= done[l];
      task.alive.of[l] = done[l] ? 0.0 : 1.0;
      const bool warm = whole && std::fabs(search_[l].at() - end_[l]) <= warm_way;
      task.warm.of[l] = warm ? 1.0 : 0.0;
      task.cold += !done[l] && !warm;
      if (!found.converged) continue;
      const double by = search_[l].by();
      found.residual = search_[l].residual();
      found.cavitation = -cos(end_[l] + by);
      found.flow = task.flow.of[l] + by * task.flow_rate.of[l];
      keep(l, by);
    }
  }
}

void strip_lanes::keep(int lane, double by) {
  end_[lane] += by;
  double *kept = kept_.data() + lane * nodes();
  for (int k = 0; k <= steps_; ++k) kept[k] = liquid_[at(k, lane)] + by * liquid_rate_[at(k, lane)];
}

}  // namespace railpatch
