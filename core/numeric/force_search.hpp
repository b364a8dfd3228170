// Safeguarded search for the depth at which a contact carries a prescribed force.
//
// Depth is measured from first touch, so F(0) = 0. A Hertzian contact has F^(2/3) proportional to
// depth, so the secant rule works on F^(2/3), and is there in some three to five steps. While all
// depths lie on one side of the target it goes on by a few times the way that a Hertzian contact
// would need, and by twice as many with every step that has led nowhere. What is not found by the
// `patience`-th step is bracketed: quadratic interpolation through the ends of the bracket and the
// one before where it can be trusted, else halving (Chandrupatla 1997, Advances in Engineering
// Software 28), and halving in any case where the bracket falls behind the schedule of `slack`
// steps more than halving alone would take. Where one patch becomes two the force can rise a
// hundred times as steeply over a fraction of a micrometre; who knows the force there better than a
// secant may suggest a depth (wheel/joined_forces.hpp). A force that jumps over the target is known
// by a bracket that has shrunk to rounding, and by nothing else.
#pragma once

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"

namespace railpatch {

// Where a function that is below zero at low and above it at high is zero: by chords, of which an
// end that stays counts half as much (the Illinois rule); low where its signs are other ones.
template <class F>
double root_between(double low, double high, double tolerance, F &&function) {
  double a = low, b = high, fa = function(a), fb = function(b);
  if (!(fa < 0 && fb > 0)) return low;
  double at = a;
  for (int i = 0, kept = 0; i < 40; ++i) {
    at = b - fb * (b - a) / (fb - fa);
    const double f = function(at);
    if (std::abs(f) <= tolerance) break;
    if (f < 0) {
      a = at, fa = f;
      if (kept > 0) fb *= 0.5;
      kept = 1;
    } else {
      b = at, fb = f;
      if (kept < 0) fa *= 0.5;
      kept = -1;
    }
  }
  return at;
}

class force_search {
 public:
  // Steps that any search ends within: those of patience, doublings from a micrometre's thousandth
  // to the greatest depth, halvings from a depth to its rounding, and what is granted beyond.
  static constexpr int most_steps = 80;

  force_search(double target, double first_depth, double tolerance)
      : target_(target), tolerance_(tolerance), depth_(first_depth) {
    lower_.value = -root(target);
  }
  // Before the first report: how fast F^(2/3) rises, over a Hertzian contact of this depth.
  void assume(double stiffness) { last_depth_ = depth_ * (1 - 1 / stiffness); }

  double depth() const { return depth_; }
  double residual() const { return residual_; }
  bool converged() const { return residual_ <= tolerance_; }
  // The bracket has shrunk to rounding, or the depth left every sensible range.
  bool exhausted() const { return exhausted_; }
  // No depth that could be evaluated carries the force.
  bool too_deep() const { return exhausted_ && limited_; }

  // It lies between two depths whose forces are known.
  bool between_known() const { return bracketed() && upper_.known && lower_.depth > 0; }
  double low() const { return lower_.depth; }
  double high() const { return upper_.depth; }
  // The same between the first depth and the last one, and how well it is known, 0 to 1: noise of
  // the forces is a part of what they differ by.
  double stiffness(double &known) const {
    const double rise = reported_root_ - first_root_, way = reported_ - first_depth_;
    known = 0;
    if (!(way != 0) || !std::isfinite(rise)) return 1;
    known = std::abs(rise) / (std::abs(rise) + noise * tolerance_ * root(target_));
    return rise / way * reported_ / reported_root_;
  }
  // The depth that was reported last.
  double last() const { return reported_; }
  // A depth that is expected to carry the force: taken where it lies in the bracket.
  void suggest(double depth) {
    if (steps_ >= tired) return;
    // not where the last one has led nowhere
    const bool led = residual_ < 0.5 * suggested_residual_ || width() < 0.5 * suggested_width_;
    suggested_residual_ = residual_;
    suggested_width_ = width();
    if (!led) return;
    const double least = std::min(1e-13 * depth, 0.1 * width());
    if (depth > lower_.depth && depth < upper_.depth)
      depth_ = std::clamp(depth, lower_.depth + least, upper_.depth - least);
  }

  // Takes the force at depth() and moves on; `beyond` marks a depth too great to be evaluated.
  void report(double force, bool beyond) {
    ++steps_;
    reported_ = depth_;
    residual_ = beyond ? HUGE_VAL : std::abs(force - target_) / target_;
    reported_root_ = beyond ? nan : root(force);
    if (steps_ == 1) first_depth_ = reported_, first_root_ = reported_root_;
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
    depth_ = steps_ < patience ? next : careful(next, moved, deeper ? upper_ : lower_, before);
  }

 private:
  static constexpr double max_depth = 0.02;  // m
  static constexpr int patience = 6, tired = 16;
  static constexpr double noise = 30.0;  // tolerances, of which a thirtieth part of it is known
  static constexpr double slack = 8.0;   // two to the power of the steps granted

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
    const bool known = slope > 0 && std::isfinite(slope);
    if (bracketed() && lower_.depth > 0) return known ? depth_ + (goal - value) / slope : middle();
    // one-sided so far: by the secant as far as a Hertzian contact can explain, and the farther the
    // longer it has led nowhere
    const double way = hertzian(force);
    const double most = std::ldexp(2.0, std::abs(held_));  // ways
    const double least = std::abs(held_) > 1 ? 0.125 * most : 0.0;
    const double share = known ? (goal - value) / slope / way : 0.5 * most;
    return depth_ + std::clamp(share, least, most) * way;
  }
  // The way to the target by Hertz's law, from the last depth.
  double hertzian(double force) const {
    if (!(force > 0)) return depth_ + 1e-6;
    const double ratio = target_ / force;
    return depth_ * (cbrt(ratio * ratio) - 1.0);
  }
  // keeps away from the ends of the bracket, so that it shrinks on both sides
  double inside(double next) const {
    const double low = lower_.depth, high = upper_.depth, margin = 0.01 * width();
    if (!bracketed()) return std::min(std::max(next, low * (1 + 1e-9)), 4.0 * low + 1e-4);
    if (next <= low || next >= high) return middle();
    return std::clamp(next, low + std::min(margin, 1e-9), high - std::min(margin, 1e-9));
  }

  // The next depth of a search that takes long; now: the end that has moved, and from where.
  double careful(double next, const end &now, const end &other, const end &before) {
    if (!bracketed() || lower_.depth == 0) return next;
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
  double reported_ = 0;                                                // m
  double reported_root_ = 0, first_depth_ = 0, first_root_ = 0;        // N^(2/3), m
  double suggested_residual_ = HUGE_VAL, suggested_width_ = HUGE_VAL;  // at the last suggestion
  int steps_ = 0;
  int held_ = 0;  // steps that the upper end has stayed for, or less than 0: the lower one
  bool exhausted_ = false, limited_ = true;
};

}  // namespace railpatch
