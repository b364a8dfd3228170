// The work of a step of shift, in which nothing rolls and traction may turn round.
//
// Of rolling the mean traction of both ends of a step serves, as its steps are short against the
// contact. Steps of shift are as long as one likes, and where they turn round the mean of both ends
// is next to nothing: a step from sliding to sliding back would take no work. But an element that
// sticks at first slides after its traction has come to the bound, and there it stays: it slides
// against the bound in the direction of the end (Mindlin and Deresiewicz 1953; exact where pressure
// stays and the shift does not bend). One that slid before slides on, by the mean of both ends; and
// one whose bound has fallen below its traction, or that has left the contact, does too. Where the
// bound has changed by g' -> g while an element came to slide, it slides against the mean of g at
// the beginning of sliding, which is linear between both, and at the end; the part of the step in
// which it slides is that of slip in slip and elastic displacement.
//
// Elastic displacement takes what the energy changes by on any way, and the layer the mean of its
// yield stress at both ends: the work of the rigid slip is their sum with friction's.
#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "patch/tangential_stage.hpp"

namespace railpatch {

namespace {

constexpr double at_bound = 1 - 1e-6;  // of the bound: an element that slid

struct sliding_element {
  double p[2], before[2];      // Pa
  double bound, bound_before;  // Pa
  double slip[2], stretch[2];  // m
};

// Pa, of the traction that an element slides against.
void sliding_traction(const sliding_element &e, double (&t)[2]) {
  const double size = hypot(e.p[0], e.p[1]);
  const double along = size > 0 ? (e.before[0] * e.p[0] + e.before[1] * e.p[1]) / size : 0.0;
  const bool slid = along > 0 && hypot(e.before[0], e.before[1]) >= at_bound * e.bound_before;
  if (!(size > 0) || slid || along >= size) {
    for (int c = 0; c < 2; ++c) t[c] = 0.5 * (e.p[c] + e.before[c]);
    return;
  }
  const double slides = hypot(e.slip[0], e.slip[1]), stretches = hypot(e.stretch[0], e.stretch[1]);
  const double part = slides > 0 ? slides / (slides + stretches) : 0.0;
  const double factor = 1 + 0.5 * part * (e.bound_before - e.bound) / size;
  for (int c = 0; c < 2; ++c) t[c] = factor * e.p[c];
}

}  // namespace

// N, of plastic displacement over the way of the step: by the mean traction of both ends, and in
// shift by that of the yield stress.
plastic_sums tangential_stage::plastic_works(const patch_problem &problem,
                                             const rolling_input &rolling,
                                             const patch_memory &memory) const {
  plastic_sums sum;
  const grid &g = problem.g;
  const patch_history &history = memory.history;
  const hardening_curve &curve = shared_.scene.law->yield;
  double *before[2] = {shared_.mean[0].data(), shared_.mean[1].data()};
  shift_field(g, rolling.upstream(), 0.0, history.last_px.data(), before[0]);
  shift_field(g, rolling.upstream(), 0.0, history.last_py.data(), before[1]);
  for (size_t at = 0; at < static_cast<size_t>(g.count()); ++at) {
    const double p[2] = {memory.px[at], memory.py[at]};
    double now = 0, mean = 0;
    for (int c = 0; c < 2; ++c) {
      const double way = history.plastic[c][at] - history.plastic_before[c][at];
      now += p[c] * way;
      mean += 0.5 * (p[c] + before[c][at]) * way;
    }
    sum.by_mean += mean;
    if (!(now > 0)) continue;
    const double *u = history.before[at].v + 1;
    double slope;
    const double yield =
        curve.at(shared_.scene.law->by_magnitude ? hypot(u[0], u[1]) : u[0], slope);
    sum.by_yield += 0.5 * now * (1 + yield / history.yield_stress[at]);
  }
  const double factor = g.dx * g.dy / rolling.distance;
  return {factor * sum.by_mean, factor * sum.by_yield};
}

// grown: J, of the tractions' energy. The work by the mean of both ends is in found already.
void tangential_stage::close_shift(const patch_problem &problem, const rolling_input &rolling,
                                   const patch_memory &memory, double grown, tangential_result &t,
                                   traction_outcome &found) {
  const grid &g = problem.g;
  const patch_history &history = memory.history;
  double *moved[2] = {shared_.moved[0].data(), shared_.moved[1].data()};
  tangential_->displacement_before(*shared_.influence, g, rolling, moved[0], moved[1]);
  double friction = 0, by_mean = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      const double pressure = memory.pressure[at];
      sliding_element e{{memory.px[at], memory.py[at]},
                        {history.last_px[at], history.last_py[at]},
                        bound_[at],
                        pressure > 0 ? bound_[at] * (history.last_pressure[at] / pressure) : 0.0,
                        {memory.sx[at], memory.sy[at]},
                        {0, 0}};
      const bool left = !(pressure > 0) && (e.before[0] != 0 || e.before[1] != 0);
      if (pressure > 0 ? memory.division[at] == RP_STICK : !left) continue;
      for (int c = 0; c < 2; ++c) {
        // elastic_energy left the present displacement there
        e.stretch[c] = shared_.scratch[c][at] - moved[c][at];
        if (!left) continue;
        e.slip[c] = rolling.slip(c, g.x(i), g.y(j)) + e.stretch[c];
        if (rolling.coupled[c]) e.slip[c] += rolling.coupled[c][at];
        if (rolling.force) e.slip[c] += rolling.force->creepage[c];
      }
      double traction[2];
      sliding_traction(e, traction);
      friction -= traction[0] * e.slip[0] + traction[1] * e.slip[1];
      by_mean -= 0.5 * ((e.p[0] + e.before[0]) * e.slip[0] + (e.p[1] + e.before[1]) * e.slip[1]);
    }
  t.friction = friction * g.dx * g.dy;
  plastic_sums plastic;
  if (shared_.scene.yields()) {
    plastic = plastic_works(problem, rolling, memory);
    found.plastic_power = plastic.by_yield;
  }
  const double more = t.friction - by_mean * g.dx * g.dy + plastic.by_yield - plastic.by_mean;
  // of unlike bodies pressure has its part in the energy
  found.supplied = shared_.coupled ? found.supplied + more : t.friction + plastic.by_yield + grown;
}

}  // namespace railpatch
