#include "wheel/joined_forces.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

void division_force::add(double depth, double force) {
  depth_[1] = depth_[0];
  force_[1] = force_[0];
  depth_[0] = depth;
  force_[0] = force;
  count_ = std::min(count_ + 1, 2);
}

double division_force::measure(double depth) const {
  return from_ > 0 ? std::sqrt(std::max(depth - from_, 0.0)) : depth;
}

double division_force::at(double depth) const {
  const double stiffness = 1.5 * force_[0] / depth_[0], step = depth - depth_[0];
  const double hertz = force_[0] + stiffness * step, last = depth_[0] - depth_[1];
  // no farther than two depths can tell
  if (count_ < 2 || !(std::fabs(step) <= 2.0 * std::fabs(last))) return hertz;
  const double way = measure(depth_[0]) - measure(depth_[1]);
  if (way == 0) return hertz;
  const double more = (force_[0] - force_[1] - stiffness * last) / way;
  return hertz + more * (measure(depth) - measure(depth_[0]));
}

void joined_forces::add(double touch, double depth, const wheel_contact &wheel) {
  touch_ = touch;
  division_forces now = pair_ ? wheel.forces_of(*pair_) : division_forces{};
  const int gap = wheel.joining_gap();
  if (gap >= 0 && !(now.apart_known && now.joined_known)) {
    take(wheel.joining_at(gap), wheel);
    now = wheel.forces_of(*pair_);
  }
  if (now.apart_known) apart_.add(depth, now.apart);
  if (now.joined_known) joined_.add(depth, now.joined);
  whole_.add(depth, wheel.vertical_force());
  if (count_ < samples_.size()) samples_[count_++] = {depth, wheel.vertical_force()};
}

// What was solved before was one division, else the pair were known already.
void joined_forces::take(const joining &pair, const wheel_contact &wheel) {
  pair_ = pair;
  apart_.begin(0);
  joined_.begin(pair.appears() - touch_);
  for (std::size_t i = 0; i < count_; ++i) {
    const sample &s = samples_[i];
    (wheel.joined(pair, touch_ + s.depth) < 0.5 ? apart_ : joined_).add(s.depth, s.force);
  }
}

void joined_forces::look_between(double touch, double low, double high,
                                 const wheel_contact &wheel) {
  if (pair_ || looked_) return;
  looked_ = true;
  touch_ = touch;
  appearance found;
  if (wheel.appearances(touch + low, touch + high, &found, 1) > 0)
    take(wheel.joining_at(found), wheel);
}

double joined_forces::force(double depth, const wheel_contact &wheel) const {
  if (!joins()) return whole_.at(depth);
  const double joined = wheel.joined(*pair_, touch_ + depth);
  return (1 - joined) * apart_.at(depth) + joined * joined_.at(depth);
}

}  // namespace railpatch
