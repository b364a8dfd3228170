// Bracketed search for the root of a function that rises on the whole: below zero far enough to one
// side, above it far enough to the other.
//
// From a start it goes against the value's sign, by steps that double, until the sign changes. Then
// it interpolates by a quadratic through the ends of the bracket and the one before where that can
// be trusted, and halves it elsewhere (Chandrupatla 1997, Advances in Engineering Software 28) and
// wherever three steps have not halved it. Where the function is not known it ends: the search
// turns back. A jump over zero is a bracket that has shrunk to rounding.
#pragma once

#include <algorithm>
#include <cmath>

namespace railpatch {

class rising_root {
 public:
  rising_root() = default;
  // first_step > 0; limit: greatest way from the start
  rising_root(double start, double first_step, double limit)
      : start_(start), at_(start), step_(first_step), limit_(limit) {}

  double at() const { return at_; }
  // No root can be told from a jump, or there is none within the limit.
  bool exhausted() const { return exhausted_; }

  // Takes the value at at() and moves on.
  void report(double value) {
    const bool below = value < 0;
    move(below, {at_, value, true, true});
  }
  // The function is not known at at(): no farther this way.
  void report_unknown() {
    const bool low = low_.there && !low_.known, high = high_.there && !high_.known;
    move(low || (!high && last_way_ < 0), {at_, 0, true, false});
  }

 private:
  struct end {
    double x = 0, value = 0;
    bool there = false, known = false;
  };

  void move(bool below, const end &now) {
    end &moved = below ? low_ : high_;
    const end &other = below ? high_ : low_;
    const end before = moved;
    moved = now;
    if (!other.there) {
      last_way_ = below ? 1 : -1;
      at_ += last_way_ * step_;
      step_ *= 2.0;
      exhausted_ = std::fabs(at_ - start_) > limit_;
      return;
    }
    const double width = std::fabs(high_.x - low_.x);
    exhausted_ = width <= 1e-15 * (std::fabs(high_.x) + std::fabs(low_.x)) + 1e-18;
    if (!(width <= 0.5 * halved_)) {
      ++behind_;
    } else {
      halved_ = width;
      behind_ = 0;
    }
    double way = 0.5;
    if (behind_ >= 3)
      halved_ = width, behind_ = 0;
    else if (now.known && other.known)
      way = share(now, other, before);
    at_ = now.x + std::clamp(way, 1e-4, 1 - 1e-4) * (other.x - now.x);
  }

  // Of the way from a to b, between which the value changes its sign; c lies beyond a.
  static double share(const end &a, const end &b, const end &c) {
    const double straight = a.value / (a.value - b.value);
    if (!c.known || c.value == a.value) return straight;
    const double x = (a.x - b.x) / (c.x - b.x);
    const double y = (a.value - b.value) / (c.value - b.value);
    // where the quadratic through all three is monotonic between a and b
    if (!(y * y < x && (1 - y) * (1 - y) < 1 - x)) return 0.5;
    return a.value / (b.value - a.value) * c.value / (b.value - c.value) +
           (c.x - a.x) / (b.x - a.x) * a.value / (c.value - a.value) * b.value /
               (c.value - b.value);
  }

  double start_ = 0, at_ = 0, step_ = 0, limit_ = 0;
  end low_, high_;
  double halved_ = HUGE_VAL;  // m, the bracket when it was last known to be halved
  int behind_ = 0;
  double last_way_ = 0;
  bool exhausted_ = false;
};

}  // namespace railpatch
