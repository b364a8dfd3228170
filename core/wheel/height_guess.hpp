// Where a search for the height begins if profiles vary along the way, and how fast the force rises
// there.
//
// The depth below first touch goes on as it did from step to step. Where another part of the rail
// is the first to be touched, as in the transfer from a wing rail to a nose, the depth turns at
// once and the height does not: then that goes on. The force rises as by Hertz's law of each patch,
// times what the last searches have found of it.
#pragma once

#include <algorithm>
#include <cmath>

namespace railpatch {

struct height_guess {
  static constexpr double longest = 2.0;  // -, of the last step, that it goes on for
  static constexpr double most = 0.3;     // -, of the depth, that it changes by
  static constexpr double turned = 0.1;   // -, of the change of first touch: it is another part's
  static constexpr double least_factor = 0.5, greatest_factor = 2.0;

  struct way {
    double place;  // m along the track, or rad round the wheel
    double touch;  // m, z of first touch there
  };

  way last_way{0, 0};
  double found = 0;                         // m, the depth there; 0: none
  double step = 0;                          // of the place, to the last step
  double depth_slope = 0, touch_slope = 0;  // by the place
  double factor = 1;                        // -, of the stiffness by Hertz's law

  // last: m, that of the last step, or of this one on another grid, which stays as it is
  double depth(double last, const way &now) const {
    const double moved = now.place - last_way.place;
    if (moved == 0 || last != found || !(std::fabs(moved) <= longest * std::fabs(step)))
      return last;
    double change = depth_slope * moved;
    const double rise = touch_slope * moved, beyond = now.touch - last_way.touch - rise;
    if (std::fabs(beyond) > turned * std::fabs(rise)) change -= beyond;
    return last + std::clamp(change, -most * last, most * last);
  }
  double stiffness(double by_hertz) const {
    return by_hertz > 0 && std::isfinite(by_hertz) ? factor * by_hertz : 1.0;
  }
  // The stiffness that a search found and how well it is known, 0 to 1, beside that by Hertz's law.
  void learn(double found, double by_hertz, double known) {
    const double ratio = found / by_hertz;
    if (ratio > least_factor && ratio < greatest_factor) factor += known * (ratio - factor);
  }
  // Of a step that ended at a depth; 0: without.
  void keep(double depth, const way &now) {
    const double moved = now.place - last_way.place;
    if (moved != 0) {
      const bool known = found > 0 && depth > 0;
      depth_slope = known ? (depth - found) / moved : 0.0;
      touch_slope = known ? (now.touch - last_way.touch) / moved : 0.0;
      step = moved;
    }
    last_way = now;
    found = depth;
  }
};

}  // namespace railpatch
