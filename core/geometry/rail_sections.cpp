#include "geometry/rail_sections.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

constexpr double same_share = 1e-9;  // of the arc length

double share_of(const profile_view &v, int i) {
  return (v.s[i] - v.s[0]) / (v.s[v.n - 1] - v.s[0]);
}

}  // namespace

bool rail_sections::belong_together(const profile_view &a, const profile_view &b) {
  if (a.n != b.n) return false;
  for (int i = 0; i < a.n; ++i)
    if (!(std::fabs(share_of(a, i) - share_of(b, i)) <= same_share)) return false;
  return true;
}

rail_sections::rail_sections(const profile_view *sections, const double *positions, int count) {
  for (int k = 0; k < count; ++k) {
    const profile_view &v = sections[k];
    const auto copy = [&](const double *from) { return std::vector<double>(from, from + v.n); };
    sections_.push_back({positions[k], copy(v.s), copy(v.y), copy(v.z), copy(v.dy), copy(v.dz)});
  }
  now_ = sections_.front();
}

profile_view rail_sections::at(double x, bool &changed) {
  const auto above = std::upper_bound(sections_.begin(), sections_.end(), x,
                                      [](double v, const section &k) { return v < k.position; });
  const auto after = static_cast<std::size_t>(above - sections_.begin());
  const std::size_t first = after > 0 ? after - 1 : 0;
  const bool between = after > 0 && after < sections_.size();
  const section &a = sections_[first], &b = sections_[between ? after : first];
  const double w = between ? (x - a.position) / (b.position - a.position) : 0.0;
  changed = first != first_ || w != share_;
  if (!changed) return view();
  first_ = first;
  share_ = w;
  // equal sections blend to the same bits
  const auto mix = [w](double from, double to) { return from + w * (to - from); };
  const std::size_t n = a.s.size();
  const double length = mix(a.s[n - 1] - a.s[0], b.s[n - 1] - b.s[0]);
  const double to_a = (a.s[n - 1] - a.s[0]) / length, to_b = (b.s[n - 1] - b.s[0]) / length;
  for (std::size_t i = 0; i < n; ++i) {
    now_.s[i] = mix(a.s[i], b.s[i]);
    now_.y[i] = mix(a.y[i], b.y[i]);
    now_.z[i] = mix(a.z[i], b.z[i]);
    now_.dy[i] = mix(to_a * a.dy[i], to_b * b.dy[i]);
    now_.dz[i] = mix(to_a * a.dz[i], to_b * b.dz[i]);
  }
  return view();
}

std::size_t rail_sections::bytes() const {
  return (sections_.size() + 1) * (sizeof(section) + 5 * now_.s.size() * sizeof(double));
}

}  // namespace railpatch
