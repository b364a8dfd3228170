// Whether other heights carry the vertical force too, by what a search for the height has tried.
//
// Where two divisions of the contact, or the theory of one, let the vertical force fall with depth,
// up to three heights carry a load. As the wheelset moves, two of them meet and vanish, and the
// result goes to the third: a jump of height and force. Depths tried on the way may show the fall;
// next to its end the force hardly rises with depth, or a depth just beyond the root carries less.
// That one is tried where the patches carry far more than the vertical force, on a steep flange:
// there parts that press sideways and creep forces outweigh the rise with depth. So is one half-way
// from the last step's depth where both ends carry more alike than the slope at the root bears.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "numeric/force_search.hpp"
#include "numeric/nan.hpp"

namespace railpatch {

class force_samples {
 public:
  // -, of the vertical force: patches that carry more are to be tried beyond the root
  static constexpr double steep = 1.5;
  // -, of the depth: how far beyond; the first ones where a wheel has several patches
  static constexpr std::array<double, 5> beyond = {0.2, 0.1, 0.05, 2e-3, 1e-3};
  static constexpr size_t of_divisions = 3;
  // -, of the depth: how far above the root a part that is being joined may have appeared
  static constexpr double joins_within = 0.05;

  explicit force_samples(double target) : target_(target) {}

  void add(double depth, double force) {
    if (count_ < samples_.size()) samples_[count_++] = {depth, force};
  }

  // Whether a force at a lesser depth is above one at a greater depth.
  static bool crosses(double before, double after) { return before > after * (1 + noise); }

  // Half-way from the last step's depth to the root, if the force may fall in between; else NaN.
  double in_between(double depth, double force) const {
    const double first = first_slope(depth, force), near = slope_near(depth, force, 1);
    if (near == HUGE_VAL || !(first < alike * near)) return nan;
    return 0.5 * (samples_[0].depth + depth);
  }
  // What was found there, with the root's force.
  void add_between(double depth, double between, double force) {
    const double way = depth - samples_[0].depth;
    falls_ = opposite(between - samples_[0].force, way) || opposite(force - between, way);
  }

  // root: the depth that carries the target, and its force
  bool jump_near(double depth, double force) const {
    if (falls_) return true;
    for (size_t i = 0; i < count_; ++i) {
      const double way = depth - samples_[i].depth;
      // a deeper place carries less, or a higher one more
      if (std::fabs(way) >= noise * depth && opposite(force - samples_[i].force, way)) return true;
    }
    const double slope = std::min(slope_near(depth, force, 0), first_slope(depth, force));
    return slope < flat * 1.5 * force / depth;
  }

 private:
  struct sample {
    double depth = 0, force = 0;
  };
  bool opposite(double rise, double way) const {
    return std::fabs(rise) > noise * target_ && (rise > 0) != (way > 0);
  }
  // To the nearest depth that was tried, from the given one on.
  double slope_near(double depth, double force, size_t from) const {
    double nearest = HUGE_VAL, slope = HUGE_VAL;
    for (size_t i = from; i < count_; ++i) {
      const double way = depth - samples_[i].depth;
      if (std::fabs(way) < noise * depth || !(std::fabs(way) < nearest)) continue;
      nearest = std::fabs(way);
      slope = (force - samples_[i].force) / way;
    }
    return slope;
  }
  // From the depth that the last step ended at, where its force is nearly the target still: a
  // height that lies farther off than the missing force explains was reached by a jump.
  double first_slope(double depth, double force) const {
    if (count_ == 0) return HUGE_VAL;
    const double way = depth - samples_[0].depth;
    return std::fabs(way) < noise * depth ? HUGE_VAL : (force - samples_[0].force) / way;
  }

  // -, of the target and the depth: less is that of solvers' tolerances
  static constexpr double noise = 1e-5;
  // -, of the slope of a Hertzian contact of this depth and force
  static constexpr double flat = 0.1;
  // -, of the slope at the root: less from the last step's depth on hides a fall or a bend
  static constexpr double alike = 0.3;

  double target_;
  size_t count_ = 0;
  bool falls_ = false;
  std::array<sample, force_search::most_steps + 5> samples_;
};

}  // namespace railpatch
