// The place of rails and wheelset by bracketed searches, one within the other, where Newton's
// method is caught in a bend: by depth, which forces rise with; by the rails' lateral places, where
// springs push back more the farther they are bent; by z, which both wheels' load rises with.
#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/rising_root.hpp"
#include "wheel/rail_support.hpp"

namespace railpatch {

namespace {

constexpr double first_way = 1e-5, farthest = 0.05;  // m, of rails and wheelset
constexpr double least_way = 1e-7, deepest = 0.02;   // m, of depths
constexpr double part_inside = 0.1;                  // of the tolerance, of the search within

}  // namespace

// One search per wheel, both at once: a wheel whose search has ended waits.
struct rail_support::both_roots {
  std::array<rising_root, 2> root;
  std::array<bool, 2> done{};
  std::size_t count = 1;

  bool all_done() const { return done[0] && (count < 2 || done[1]); }
  bool stuck() const {
    for (std::size_t w = 0; w < count; ++w)
      if (!done[w] && root[w].exhausted()) return true;
    return false;
  }
  void report(std::size_t w, double value, double tolerance) {
    if (done[w]) return;
    done[w] = std::fabs(value) <= tolerance;
    if (!done[w]) root[w].report(value);
  }
  // Of those that are not known, or of all; the others stay where they are.
  void report_unknown(const trial &t) {
    bool any = false;
    for (std::size_t w = 0; w < count; ++w) any = any || !t.wheel[w].known;
    for (std::size_t w = 0; w < count; ++w) {
      if (any && t.wheel[w].known) continue;
      done[w] = false;
      root[w].report_unknown();
    }
  }
};

// Depths that carry what springs push with at z, or the load, the rails being where they are
// laterally.
bool rail_support::search_depth(supported_wheels &wheels, trial &t, double tolerance) {
  const lateral_vertical level[2] = {{t.deflection[0][0], 0.0}, {t.deflection[1][0], 0.0}};
  const lateral_vertical still[2] = {};
  wheels.move_rails(level, still);
  both_roots depth;
  depth.count = at(count_);
  for (std::size_t w = 0; w < depth.count; ++w) {
    double z = 0;
    touch_[w] = wheels.first_touch(static_cast<int>(w), z) ? z : nowhere;
    if (!(touch_[w] < nowhere)) return false;
    // just lifted where it is not known to touch
    const double guess = guessed_depth_of(w, t.z);
    depth.root[w] =
        rising_root(guess > 0 ? guess : -least_way, std::max(0.1 * guess, least_way), deepest);
  }
  while (!depth.all_done() && !depth.stuck() && evaluations_ < most_searched) {
    for (std::size_t w = 0; w < depth.count; ++w) place(w, depth.root[w].at(), t);
    if (!evaluate(wheels, t)) {
      depth.report_unknown(t);
      continue;
    }
    for (std::size_t w = 0; w < depth.count; ++w) {
      const double force = t.wheel[w].force[1];
      const double value = load_alone() ? force - load_.force : -t.gap[w][1];
      depth.report(w, value, tolerance * size_of(t) + rounding * total(1) * std::fabs(t.z));
    }
  }
  return depth.all_done();
}

// The rail's vertical place, and z where it follows from the load, of a wheel at a depth.
void rail_support::place(std::size_t w, double depth, trial &t) const {
  if (load_alone()) {
    t.deflection[w][1] = rigid(1) ? 0.0 : (load_.force + carried(w, 1)) / total(1);
    t.z = touch_[w] + t.deflection[w][1] + depth;
  } else {
    t.deflection[w][1] = rigid(1) ? 0.0 : t.z - touch_[w] - depth;
  }
}

double rail_support::guessed_depth_of(std::size_t w, double z) const {
  if (!load_alone()) return guessed_depth(w, z);
  const double share = load_.force / rails_[w].hertz;
  return cbrt(share * share);
}

// Lateral places of the rails at z.
bool rail_support::search_sideways(supported_wheels &wheels, trial &t, double tolerance) {
  if (rigid(0)) return search_depth(wheels, t, tolerance);
  both_roots side;
  side.count = at(count_);
  for (std::size_t w = 0; w < side.count; ++w)
    side.root[w] = rising_root(t.deflection[w][0], first_way, farthest);
  while (!side.all_done() && !side.stuck() && evaluations_ < most_searched) {
    for (std::size_t w = 0; w < side.count; ++w) t.deflection[w][0] = side.root[w].at();
    if (!search_depth(wheels, t, part_inside * tolerance)) {
      side.report_unknown(t);
      continue;
    }
    for (std::size_t w = 0; w < side.count; ++w) {
      const double most = std::fabs(total(0) * t.deflection[w][0]) + std::fabs(carried(w, 0));
      side.report(w, t.gap[w][0], tolerance * size_of(t) + rounding * most);
    }
  }
  return side.all_done();
}

// N, what a search measures by: a wheel that is lifted has no force of its own.
double rail_support::size_of(const trial &t) const {
  double most = load_.prescribed ? load_.force : 0.0;
  for (std::size_t w = 0; w < at(count_); ++w) most = std::max(most, length(t.wheel[w].force));
  return most;
}

// Rails that carry no wheel are where their springs and dampers leave them, to the last digit.
void rail_support::release_lifted(trial &t) const {
  for (std::size_t w = 0; w < at(count_); ++w)
    for (std::size_t k = 0; k < 2; ++k)
      if (!(length(t.wheel[w].force) > 0) && !rigid(k))
        t.deflection[w][k] = carried(w, k) / total(k);
}

// All of it, to a residual of `tolerance`, from where the rails were.
bool rail_support::search(supported_wheels &wheels, trial &t, double tolerance) {
  for (std::size_t w = 0; w < at(count_); ++w) t.deflection[w][0] = before_[w][0];
  if (!load_.prescribed || load_alone()) {
    if (!load_.prescribed) t.z = load_.z;
    return search_sideways(wheels, t, tolerance);
  }
  rising_root height(t.z, first_way, farthest);
  while (!height.exhausted() && evaluations_ < most_searched) {
    t.z = height.at();
    if (!search_sideways(wheels, t, part_inside * tolerance)) {
      height.report_unknown();
      continue;
    }
    if (std::fabs(t.missing) <= tolerance * load_.force) return true;
    height.report(t.missing);
  }
  return false;
}

}  // namespace railpatch
