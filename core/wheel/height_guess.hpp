// Where a search for the height begins if profiles vary along the way, and how fast the force rises
// there.
//
// The depth below first touch goes on as it did from step to step: by the polynomial through the
// last one to four steps that would have told the last step best from those before it. Where
// another part of the rail is the first to be touched, as in the transfer from a wing rail to a
// nose, the depth turns at once and the height does not: then that goes on. Of a step counts the
// depth at which it would have met its force to the last digit, by what its solution was off:
// within the search's tolerance depths scatter by more than the polynomial is wrong. Another force
// takes depths as a Hertzian contact does. The force rises as by Hertz's law of each patch, times
// what the last searches have found of it.
#pragma once

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

struct height_guess {
  static constexpr double longest = 2.0;  // -, of the last step, that it goes on for
  static constexpr double most = 0.3;     // -, of the depth, that it changes by
  static constexpr double turned = 0.1;   // -, of the change of first touch: it is another part's
  static constexpr double least_factor = 0.5, greatest_factor = 2.0;
  static constexpr int kept = 5;  // steps

  struct way {
    double place;  // m along the track, or rad round the wheel
    double touch;  // m, z of first touch there
    double force;  // N, prescribed
  };
  struct passed {
    way at;
    double depth;  // m, that carries the force
  };

  passed past[kept] = {};  // the last one first, each at another place
  int count = 0;
  double found = 0;   // m, the depth that the last step ended at; 0: none
  double factor = 1;  // -, of the stiffness by Hertz's law

  // last: m, that of the last step, or of this one on another grid, which stays as it is
  double depth(double last, const way &now) const {
    if (count == 0 || last != found) return last;
    line on{};
    for (int i = 0; i < count; ++i) {
      on.place[i] = past[i].at.place;
      on.touch[i] = past[i].at.touch;
      on.depth[i] = past[i].depth * by_force(past[i].at.force, now.force);
    }
    const double moved = now.place - on.place[0];
    const bool near =
        count > 1 && std::fabs(moved) <= longest * std::fabs(on.place[0] - on.place[1]);
    if (moved == 0 || !near) return last * by_force(past[0].at.force, now.force);
    bool by_height = false;
    const int points = best(on, by_height);
    // turns now
    const double rise = on.at(on.touch, 0, 2, now.place) - on.touch[0];
    const double beyond = now.touch - on.touch[0] - rise;
    by_height = by_height || std::fabs(beyond) > turned * std::fabs(rise);
    const double then = on.at(on.depth, 0, points, now.place);
    const double guess =
        by_height ? then + on.at(on.touch, 0, points, now.place) - now.touch : then;
    return std::clamp(guess, (1 - most) * on.depth[0], (1 + most) * on.depth[0]);
  }
  double stiffness(double by_hertz) const {
    return by_hertz > 0 && std::isfinite(by_hertz) ? factor * by_hertz : 1.0;
  }
  // The stiffness that a search found and how well it is known, 0 to 1, beside that by Hertz's law.
  void learn(double of_search, double by_hertz, double known) {
    const double ratio = of_search / by_hertz;
    if (ratio > least_factor && ratio < greatest_factor) factor += known * (ratio - factor);
  }
  // Of a step that ended at a depth, where its force was off by a part of what is prescribed; 0:
  // without depth.
  void keep(double depth, double off, double by_hertz, const way &now) {
    found = depth;
    if (!(depth > 0)) {
      count = 0;
      return;
    }
    if (count == 0 || now.place != past[0].at.place) {
      for (int i = kept - 1; i > 0; --i) past[i] = past[i - 1];
      count = std::min(count + 1, kept);
    }
    past[0] = {now, depth * (1 - off / (1.5 * stiffness(by_hertz)))};
  }

 private:
  // What was at the last places, by number.
  struct line {
    double place[kept], touch[kept], depth[kept];
    // Of values, the polynomial through so many from one on: Newton's divided differences.
    double at(const double (&value)[kept], int from, int points, double x) const {
      const double *p = place + from;
      double divided[kept] = {};
      std::copy_n(value + from, points, divided);
      for (int order = 1; order < points; ++order)
        for (int i = points - 1; i >= order; --i)
          divided[i] = (divided[i] - divided[i - 1]) / (p[i] - p[i - order]);
      double sum = divided[points - 1];
      for (int i = points - 2; i >= 0; --i) sum = divided[i] + (x - p[i]) * sum;
      return sum;
    }
  };
  static double by_force(double then, double now) {
    return then == now ? 1.0 : cbrt(now * now / (then * then));
  }
  // How many points would have told the last step best, of depths or of heights.
  int best(const line &on, bool &by_height) const {
    if (count < 3) return 2;
    int points = 2;
    double least = HUGE_VAL;
    for (int n = 1; n < count && n < kept; ++n) {
      const double x = on.place[0];
      const double of_depth = on.at(on.depth, 1, n, x) - on.depth[0];
      const double of_height = of_depth + on.at(on.touch, 1, n, x) - on.touch[0];
      for (const bool height : {false, true}) {
        const double error = std::fabs(height ? of_height : of_depth);
        if (!(error < least)) continue;
        least = error;
        points = n;
        by_height = height;
      }
    }
    return points;
  }
};

}  // namespace railpatch
