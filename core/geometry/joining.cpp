#include "geometry/joining.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

// How an edge moves along the wheel's profile with z, m/m; 0 at the end of a profile.
double edge_rate(const side_geometry &side, double s) {
  constexpr double step = 1e-6;  // m
  const double low = side.gap(s - step), high = side.gap(s + step);
  const bool ended = std::max(low, high) > 0.5 * side_geometry::far_apart;
  return ended || low == high ? 0.0 : 2.0 * step / (high - low);
}

}  // namespace

joining::joining(const side_geometry &side, const part_set &found, int k) {
  const part &a = found.parts[k], &b = found.parts[k + 1];
  const double z = side.motion().wheelset.z;
  const int later = lateral_width(a) < lateral_width(b) ? 0 : 1;
  for (int i = 0; i < 2; ++i) {
    const part &p = i == 0 ? a : b;
    inside_[i] = i == later ? lowest_gap(side, p.begin, p.end) : 0.5 * (p.begin + p.end);
  }
  appears_ = z + side.gap(inside_[later]);
  add(side, a, b);
}

joining::joining(const side_geometry &side, const blend_rules &rule, const appearance &found)
    : appears_(found.z), merges_(found.z + found.bump) {
  const int later = found.neighbour > 0 ? 0 : 1;
  inside_[later] = found.at;
  inside_[1 - later] = found.at + found.neighbour;
  for (int i = 0; i < 2; ++i) angle_[i] = side.locus(inside_[i]).contact_angle;
  const double distance = std::fabs(found.neighbour), width = rule.grown * distance;
  const double root = std::sqrt(found.length);
  node_[0] = {root, distance - 0.5 * width, width, -0.5 * width / root, width / root};
}

void joining::add(const side_geometry &side, const part &a, const part &b) {
  const double z = side.motion().wheelset.z, r = root(z);
  if (!(nodes_ > 0 && node_[0].root == r)) {
    node_[1] = node_[0];
    nodes_ = std::min(nodes_ + 1, 2);
  }
  const double by_root = 2.0 * r;  // z by the root
  const part &narrow = lateral_width(a) < lateral_width(b) ? a : b;
  const double begin = edge_rate(side, narrow.begin), end = edge_rate(side, narrow.end);
  const double facing = edge_rate(side, b.begin) - edge_rate(side, a.end);
  node_[0] = {r, facing_distance(a, b), lateral_width(narrow), by_root * facing,
              by_root * (end - begin)};
  angle_[0] = a.angle;
  angle_[1] = b.angle;
  merges_ = z + a.bump;
}

double joining::root(double z) const { return std::sqrt(std::max(z - appears_, 0.0)); }

double joining::joined(const blend_rules &rule, double z) const {
  const double r = root(z);
  if (r == 0) return 0;
  if (z >= merges_) return 1;
  const node &last = node_[0], &other = node_[1];
  const double way = r - last.root;
  double distance = last.distance + way * last.distance_rate;
  double width = last.width + way * last.width_rate;
  const double back = other.root - last.root;
  if (nodes_ > 1 && back != 0) {
    const double bend = way * way / (back * back);
    distance += bend * (other.distance - last.distance - back * last.distance_rate);
    width += bend * (other.width - last.width - back * last.width_rate);
  }
  return railpatch::joined(rule, std::max(distance, 0.0), std::max(width, 0.0), merges_ - z,
                           angle_[0], angle_[1]);
}

}  // namespace railpatch
