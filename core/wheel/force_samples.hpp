// Whether other heights carry the vertical force too, by what a search for the height has tried.
//
// Where two divisions of the contact, or the theory of one, let the vertical force fall with depth,
// up to three heights carry a load. As the wheelset moves, two of them meet and vanish, and the
// result goes to the third: a jump of height and force. Depths tried on the way may show the fall;
// next to its end the force hardly rises with depth, or a depth just beyond the root carries less.
// That one is tried where the patches carry far more than the vertical force, on a steep flange:
// there parts that press sideways and creep forces outweigh the rise with depth.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "numeric/force_search.hpp"

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

  // root: the depth that carries the target, and its force
  bool jump_near(double depth, double force) const {
    double nearest = HUGE_VAL, slope = HUGE_VAL;
    for (size_t i = 0; i < count_; ++i) {
      const double way = depth - samples_[i].depth, rise = force - samples_[i].force;
      if (std::fabs(way) < noise * depth) continue;
      // a deeper place carries less, or a higher one more
      if (std::fabs(rise) > noise * target_ && (rise > 0) != (way > 0)) return true;
      if (std::fabs(way) < nearest) nearest = std::fabs(way), slope = rise / way;
    }
    return std::min(slope, first_slope(depth, force)) < flat * 1.5 * force / depth;
  }

 private:
  struct sample {
    double depth = 0, force = 0;
  };
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

  double target_;
  size_t count_ = 0;
  std::array<sample, force_search::most_steps + 5> samples_;
};

}  // namespace railpatch
