// Safeguarded search for the depth at which a contact carries a prescribed force.
//
// Depth is measured from first touch, so F(0) = 0. A Hertzian contact has F^(2/3) proportional to
// depth, so the secant rule works on F^(2/3), and is there in some three to five steps. Where one
// patch becomes two the force can rise a hundred times as steeply over a fraction of a micrometre:
// secants through its foot or its top miss it, again and again on the same side. What is not found
// by the `patience`-th step is bracketed: quadratic interpolation through the ends of the bracket
// and the one before where it can be trusted, else halving (Chandrupatla 1997, Advances in
// Engineering Software 28), and halving in any case where the bracket falls behind the schedule of
// `slack` steps more than halving alone would take. A force that jumps over the target is known by
// a bracket that has shrunk to rounding, and by nothing else.
#pragma once

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

class force_search {
 public:
  // Steps that any search ends within: those of patience, doublings from a micrometre's thousandth
  // to the greatest depth, halvings from a depth to its rounding, and what is granted beyond.
  static constexpr int most_steps = 80;

  force_search(double target, double first_depth, double tolerance)
      : target_(target), tolerance_(tolerance), depth_(first_depth) {
    lower_.value = -root(target);
  }

  double depth() const { return depth_; }
  double residual() const { return residual_; }
  bool converged() const { return residual_ <= tolerance_; }
  // The bracket has shrunk to rounding, or the depth left every sensible range.
  bool exhausted() const { return exhausted_; }
  // No depth that could be evaluated carries the force.
  bool too_deep() const { return exhausted_ && limited_; }

  // Takes the force at depth() and moves on; `beyond` marks a depth too great to be evaluated.
  void report(double force, bool beyond) {
    ++steps_;
    residual_ = beyond ? HUGE_VAL : std::abs(force - target_) / target_;
    if (converged()) return;
    const bool deeper = !beyond && force < target_;
    end &moved = deeper ? lower_ : upper_;
    const end before = moved;
    moved = {depth_, beyond ? 0.0 : root(force) - root(target_), !beyond};
    if (!deeper) limited_ = beyond;
    const double next = inside(beyond ? middle() : secant(force));
    if (!beyond) {
      last_depth_ = depth_;
      last_root_ = root(force);
    }
    exhausted_ = width() < 1e-16 + 1e-12 * lower_.depth || lower_.depth >= max_depth;
    depth_ = steps_ < patience ? next : careful(next, moved, deeper ? upper_ : lower_, before);
  }

 private:
  static constexpr double max_depth = 0.02;  // m
  static constexpr int patience = 8;
  static constexpr double slack = 8.0;  // two to the power of the steps granted

  // Of the bracket: a depth and, where the force there is known, its root minus the target's.
  struct end {
    double depth = 0, value = 0;
    bool known = true;
  };

  static double root(double force) { return cbrt(force > 0 ? force * force : 0.0); }
  double width() const { return upper_.depth - lower_.depth; }
  double middle() const { return 0.5 * (lower_.depth + upper_.depth); }
  bool bracketed() const { return upper_.depth < max_depth; }

  double secant(double force) const {
    const double value = root(force), goal = root(target_);
    const double slope = (value - last_root_) / (depth_ - last_depth_);
    if (slope > 0 && std::isfinite(slope)) return depth_ + (goal - value) / slope;
    return bracketed() ? middle() : 2.0 * depth_ + 1e-6;
  }
  // keeps away from the ends of the bracket, so that it shrinks on both sides
  double inside(double next) const {
    const double low = lower_.depth, high = upper_.depth, margin = 0.01 * width();
    if (!bracketed()) return std::min(std::max(next, low + 1e-9), 4.0 * low + 1e-4);
    if (next <= low || next >= high) return middle();
    return std::clamp(next, low + std::min(margin, 1e-9), high - std::min(margin, 1e-9));
  }

  // The next depth of a search that takes long; now: the end that has moved, and from where.
  double careful(double next, const end &now, const end &other, const end &before) {
    if (!bracketed()) return std::max(next, 2.0 * lower_.depth);
    allowed_ = allowed_ > 0 ? 0.5 * allowed_ : slack * width();
    if (width() > allowed_) return middle();
    if (!(now.known && other.known && before.known)) return next;
    const double least = 1e-13 * lower_.depth;
    const double at = now.depth + share(now, other, before) * (other.depth - now.depth);
    return std::clamp(at, std::min(lower_.depth + least, middle()),
                      std::max(upper_.depth - least, middle()));
  }
  // Of the way from a to b, between which the value changes its sign; c lies beyond a.
  static double share(const end &a, const end &b, const end &c) {
    const double x = (a.depth - b.depth) / (c.depth - b.depth);
    const double y = (a.value - b.value) / (c.value - b.value);
    // where the quadratic through all three is monotonic between a and b
    if (!(y * y < x && (1 - y) * (1 - y) < 1 - x)) return 0.5;
    return a.value / (b.value - a.value) * c.value / (b.value - c.value) +
           (c.depth - a.depth) / (b.depth - a.depth) * a.value / (c.value - a.value) * b.value /
               (c.value - b.value);
  }

  double target_, tolerance_, depth_;
  double last_depth_ = 0, last_root_ = 0;
  end lower_, upper_{max_depth, 0, false};
  double allowed_ = 0;  // m, of the bracket; 0: not yet bracketed after the patience
  double residual_ = HUGE_VAL;
  int steps_ = 0;
  bool exhausted_ = false, limited_ = true;
};

}  // namespace railpatch
