// Factor of the friction law over the lateral position, the angle of the rail's surface or the
// position along the track: linear between points, constant beyond the first and the last.
#pragma once

#include <algorithm>
#include <array>

#include "railpatch.h"

namespace railpatch {

class friction_factor {
 public:
  friction_factor() = default;
  // place, factor: RP_MAX_POINTS values
  friction_factor(int count, const double *place, const double *factor) : count_(count) {
    std::copy_n(place, RP_MAX_POINTS, place_.begin());
    std::copy_n(factor, RP_MAX_POINTS, factor_.begin());
  }
  bool varies() const { return count_ > 0; }
  double at(double place) const {
    const auto begin = place_.begin(), end = begin + count_;
    const auto above = std::upper_bound(begin, end, place) - begin;
    if (above == 0) return factor_.front();
    const auto below = static_cast<size_t>(above - 1), next = static_cast<size_t>(above);
    if (above == count_) return factor_[below];
    const double part = (place - place_[below]) / (place_[next] - place_[below]);
    return factor_[below] + part * (factor_[next] - factor_[below]);
  }
  // by the place; where two lines meet that of the upper one
  double slope(double place) const {
    const auto begin = place_.begin(), end = begin + count_;
    const auto above = std::upper_bound(begin, end, place) - begin;
    if (above == 0 || above == count_) return 0.0;
    const auto below = static_cast<size_t>(above - 1), next = static_cast<size_t>(above);
    return (factor_[next] - factor_[below]) / (place_[next] - place_[below]);
  }

 private:
  int count_ = 0;
  std::array<double, RP_MAX_POINTS> place_{}, factor_{};
};

}  // namespace railpatch
