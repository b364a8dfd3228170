// Safeguarded search for the depth at which a contact carries a prescribed force.
//
// Depth is measured from first touch, so F(0) = 0. A Hertzian contact has F^(2/3) proportional to
// depth, so the secant rule works on F^(2/3); a bracket keeps it safe where that law is far off.
#pragma once

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

class force_search {
 public:
  force_search(double target, double first_depth, double tolerance)
      : target_(target), tolerance_(tolerance), depth_(first_depth) {}

  double depth() const { return depth_; }
  double residual() const { return residual_; }
  bool converged() const { return residual_ <= tolerance_; }
  // The bracket has shrunk to rounding, or the depth left every sensible range.
  bool exhausted() const { return exhausted_; }
  // No depth that could be evaluated carries the force.
  bool too_deep() const { return exhausted_ && limited_; }

  // Takes the force at depth() and moves on; `beyond` marks a depth too great to be evaluated.
  void report(double force, bool beyond) {
    residual_ = beyond ? HUGE_VAL : std::abs(force - target_) / target_;
    if (converged()) return;
    const bool deeper = !beyond && force < target_;
    (deeper ? lower_ : upper_) = depth_;
    if (!deeper) limited_ = beyond;
    const double next = beyond ? 0.5 * (lower_ + upper_) : secant(force);
    if (!beyond) {
      last_depth_ = depth_;
      last_root_ = root(force);
    }
    exhausted_ = upper_ - lower_ < 1e-16 + 1e-12 * lower_ || lower_ >= max_depth;
    depth_ = inside(next);
  }

 private:
  static constexpr double max_depth = 0.02;  // m
  static double root(double force) { return cbrt(force > 0 ? force * force : 0.0); }

  double secant(double force) const {
    const double value = root(force), goal = root(target_);
    const double slope = (value - last_root_) / (depth_ - last_depth_);
    if (slope > 0 && std::isfinite(slope)) return depth_ + (goal - value) / slope;
    return upper_ < max_depth ? 0.5 * (lower_ + upper_) : 2.0 * depth_ + 1e-6;
  }
  // keeps away from the ends of the bracket, so that it shrinks on both sides
  double inside(double next) const {
    const double margin = 0.01 * (upper_ - lower_);
    if (upper_ >= max_depth) return std::min(std::max(next, lower_ + 1e-9), 4.0 * lower_ + 1e-4);
    if (next <= lower_ || next >= upper_) return 0.5 * (lower_ + upper_);
    return std::clamp(next, lower_ + std::min(margin, 1e-9), upper_ - std::min(margin, 1e-9));
  }

  double target_, tolerance_, depth_;
  double last_depth_ = 0, last_root_ = 0;
  double lower_ = 0, upper_ = max_depth;
  double residual_ = HUGE_VAL;
  bool exhausted_ = false, limited_ = true;
};

}  // namespace railpatch
