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

// From `depth` on the force rises steeply, within `length` in the measure of how much a part that
// appears there is one patch with its neighbour (patch_parts.hpp), and beyond with that part's
// width: both go with the root of how far it has sunk in.
struct force_rise {
  double depth = 0, length = 0;  // m

  double share(double at) const {
    const double t = (at - depth) / length;
    if (!(t > 0)) return 0;
    const double u = std::sqrt(t);
    return u < 1 ? u * u * u * (10.0 - u * (15.0 - 6.0 * u)) : 1.0 + 0.1 * (u - 1.0);
  }
};

class force_search {
 public:
  static constexpr int most_rises = 4;
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

  // Found late, and between two depths whose forces are known: give_rises may help.
  bool wants_rises() const {
    return steps_ >= curious && !asked_ && bracketed() && upper_.known && lower_.depth > 0;
  }
  double low() const { return lower_.depth; }
  double high() const { return upper_.depth; }
  void give_rises(const force_rise *rises, int count) {
    asked_ = true;
    rises_ = std::min(count, most_rises);
    std::copy_n(rises, rises_, rise_);
    if (rises_between()) depth_ = risen();
  }

  // Takes the force at depth() and moves on; `beyond` marks a depth too great to be evaluated.
  void report(double force, bool beyond) {
    ++steps_;
    residual_ = beyond ? HUGE_VAL : std::abs(force - target_) / target_;
    if (converged()) return;
    const bool deeper = !beyond && force < target_;
    end &moved = deeper ? lower_ : upper_;
    const end before = moved;
    moved = {depth_, beyond ? 0.0 : root(force) - root(target_), !beyond, force};
    if (!deeper) limited_ = beyond;
    held_ = deeper ? std::max(held_, 0) + 1 : std::min(held_, 0) - 1;
    const double next = inside(beyond ? middle() : secant(force));
    if (!beyond) {
      last_depth_ = depth_;
      last_root_ = root(force);
    }
    exhausted_ = width() < 1e-16 + 1e-12 * lower_.depth || lower_.depth >= max_depth;
    if (steps_ < tired && rises_between()) {
      depth_ = risen();
      return;
    }
    depth_ = steps_ < patience ? next : careful(next, moved, deeper ? upper_ : lower_, before);
  }

 private:
  static constexpr double max_depth = 0.02;  // m
  static constexpr int patience = 6, curious = 3, tired = 16;
  static constexpr double slack = 8.0;  // two to the power of the steps granted

  // Of the bracket: a depth and, where the force there is known, its root minus the target's.
  struct end {
    double depth = 0, value = 0;
    bool known = true;
    double force = 0;  // N
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

  double risen_between(double low, double high) const {
    double sum = 0;
    for (int i = 0; i < rises_; ++i) sum += rise_[i].share(high) - rise_[i].share(low);
    return sum;
  }
  bool rises_between() const {
    return upper_.known && risen_between(lower_.depth, upper_.depth) > 1e-3;
  }
  // The depth by the model. An end that stays is brought to the foot or the top of the rise that
  // the other one is on; else it counts half as much each time (Dowell and Jarratt 1971, BIT 11).
  double risen() const {
    for (int i = 0; i < rises_ && std::abs(held_) > 1; ++i) {
      // not where the part has no extent at all
      const double foot = rise_[i].depth - 1e-3 * rise_[i].length;
      const double top = rise_[i].depth + rise_[i].length;
      if (held_ < 0 && lower_.depth < foot && foot < upper_.depth && upper_.depth < top)
        return foot;
      if (held_ > 0 && foot < lower_.depth && lower_.depth < top && top < upper_.depth) return top;
    }
    const double kept = std::ldexp(1.0, -std::max(std::abs(held_) - 1, 0));
    const double from = (held_ < 0 ? kept : 1) * (lower_.force - target_);
    const double climb = (held_ > 0 ? kept : 1) * (upper_.force - target_) - from;
    // beside the rises as a ball on a plane
    const double slope = std::min(1.5 * target_ / lower_.depth, 0.5 * climb / width());
    const double jump = (climb - slope * width()) / risen_between(lower_.depth, upper_.depth);
    double low = lower_.depth, high = upper_.depth;
    for (int k = 0; k < 60; ++k) {
      const double at = 0.5 * (low + high);
      const double excess =
          from + slope * (at - lower_.depth) + jump * risen_between(lower_.depth, at);
      (excess < 0 ? low : high) = at;
    }
    const double least = std::min(1e-13 * lower_.depth, 0.1 * width());
    return std::clamp(0.5 * (low + high), lower_.depth + least, upper_.depth - least);
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
  force_rise rise_[most_rises];
  int steps_ = 0, rises_ = 0;
  int held_ = 0;  // steps that the upper end has stayed for, or less than 0: the lower one
  bool asked_ = false;
  bool exhausted_ = false, limited_ = true;
};

}  // namespace railpatch
