// What the divisions of a wheel's contact into patches carry, each on its own.
#include <algorithm>

#include "wheel/wheel_contact.hpp"

namespace railpatch {

namespace {

// of joined: what is beyond counts as one division
constexpr double alone = 1e-5;

}  // namespace

double wheel_contact::vertical_force() const {
  double sum = 0;
  for (size_t i = 0; i < static_cast<size_t>(patches_); ++i)
    sum += regions_[i].share * vertical_[i];
  return sum;
}

int wheel_contact::joining_gap() const {
  if (!rules_.blended || shape_ || patches_ < 2) return -1;
  int gap = -1;
  double most = alone;
  for (int k = 0; k + 1 < parts_.count; ++k) {
    const double join = railpatch::joined(rules_.blend, parts_.parts[k], parts_.parts[k + 1]);
    const double both = join * (1 - join);
    if (both > most) most = both, gap = k;
  }
  return gap;
}

division_forces wheel_contact::forces_of(joining &pair) const {
  int at[2] = {-1, -1};
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < parts_.count; ++k) {
      const part &p = parts_.parts[k];
      if (p.begin <= pair.inside(i) && pair.inside(i) <= p.end) at[i] = k;
    }
  division_forces out;
  if (at[0] < 0 && at[1] < 0) return out;
  if (at[0] < 0 || at[1] < 0) {
    out.apart = vertical_force();
    out.apart_known = true;
    return out;
  }
  if (at[0] == at[1]) {
    out.joined = vertical_force();
    out.joined_known = true;
    return out;
  }
  if (at[1] != at[0] + 1) return out;
  pair.add(*geometry_, parts_.parts[at[0]], parts_.parts[at[1]]);
  double join[max_parts];
  for (int k = 0; k + 1 < parts_.count; ++k)
    join[k] = railpatch::joined(rules_.blend, parts_.parts[k], parts_.parts[k + 1]);
  double &between = join[at[0]];
  out.apart_known = between < 1 - alone;
  out.joined_known = between > alone;
  for (const bool one : {false, true}) {
    between = one ? 1.0 : 0.0;
    double &sum = one ? out.joined : out.apart;
    for (size_t i = 0; i < static_cast<size_t>(patches_); ++i) {
      const int begin = regions_[i].first_part, end = begin + regions_[i].parts;
      sum += interval_share(join, parts_.count, begin, end) * vertical_[i];
    }
  }
  return out;
}

}  // namespace railpatch
