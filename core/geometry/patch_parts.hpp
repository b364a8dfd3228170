// From parts of contact to the patches that are solved: the smooth half of the contact search.
//
// The discrete half (patch.cpp) finds the parts, the stretches of negative gap along the contact
// locus, as pairs of arc lengths [begin, end] of the wheel's profile at whose ends the gap is zero.
// All that follows is here, as functions of these edges and of the locus, and a template on the
// scalar T, so that it can be differentiated forward with numbers that carry derivatives:
//   sum_rows           edges and locus -> weight, reference, angle, extent of a part
//   facing_distance, joined   two neighbours -> how far they are one patch, 0 ... 1
//   interval_share     joined of all gaps -> share of an interval of parts
//   sum_parts          interval -> weighted means
//   bounds_of          parts and frame -> bounds of the interpenetration
// Choices by value (comparisons, min, max) keep to one smooth branch each.
//
// T: double, or a type with its operators, comparisons with itself and double, and sqrt, hypot,
// cos, sin, fabs found by argument. Locus: locus(T s) gives .valid, .wheel[3], .gap,
// .contact_angle, .curvature and .normal[3], as side_geometry::locus does.
//
// Blended rule. Every interval [i ... j] of neighbouring parts may be solved as one patch, and
// counts with the share
//   (product of joined_k over the gaps k inside) (1 - joined_{i-1}) (1 - joined_j),
// as if each gap were joined by chance, independently of the others. So the shares of the intervals
// that hold a part sum up to one, for each part. joined falls from one to zero as the greatest gap
// between two parts grows from 25 to 75 um: a bump that elastic displacement closes or bridges. The
// distance of their edges will not do: it grows with the root of the gap, by millimetres in a few
// micrometres of motion. joined falls at smaller gaps as contact angles differ by more than 60
// degrees, at distances of 10 to 16 mm, beyond which a common grid would be too wide, and goes to
// zero with the width of the smaller part over the distance: a part that
// appears (width 0) begins as a patch of its own with no force, one that splits (gap and distance
// 0) as one patch. Within a patch neighbours interact as in the program CONTACT: fully up to a
// distance of 4 mm, not at all from 8 mm on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "geometry/place_slope.hpp"
#include "numeric/elementary.hpp"
#include "numeric/fade.hpp"

namespace railpatch {

constexpr int max_parts = 8;  // of one patch, and of one wheel

// How parts become patches without jumps: the gaps up to which they are one, and from which on each
// is a patch of its own.
struct blend_rules {
  double low = 2.5e-5, high = 7.5e-5;  // m, greatest gap between, across the surfaces
  double steepest = 0.1;               // -, least cosine of the contact angle by which it is taken
  double grown = 0.15;                 // -, width of the smaller part over the distance
  double one = 10e-3, two = 16e-3;     // m, distance
  double full = 4e-3, none = 8e-3;     // m, of the interaction within a patch
  // rad; between these differences of contact angles the distances fall to a fraction
  double angle_from = std::numbers::pi / 3, angle_to = std::numbers::pi / 2;
  double angle_fraction = 0.1;
};

// One part of contact, with its sums over rows.
template <class T>
struct basic_part {
  T begin{}, end{};                  // m, arc length on the wheel
  bool cut_off = false;              // by the end of a profile
  std::array<T, 3> first{}, last{};  // edges, track axes, on the surfaces
  T weight{}, x{}, y{}, angle{};     // weighted means
  T x_min{}, x_max{};
  // between this part and the next: the greatest gap, m, and its arc length on the wheel
  T bump{};
  double bump_at = 0;
  // how these change with the wheel's place; zero where a wheel or rail is shaped along x
  basic_place_slope<T> weight_slope{}, angle_slope{};
  // and with the position of the rail's and of the wheel's sections
  double weight_rate[2] = {0, 0}, angle_rate[2] = {0, 0};
};
using part = basic_part<double>;

// Parts [begin, end) as one patch.
template <class T>
struct basic_interval {
  int begin = 0, end = 0;
  bool leads = true;              // belongs to the division of greatest share
  T weight{}, x{}, y{}, angle{};  // weighted means
  T share{};
  basic_place_slope<T> angle_slope{};
  double angle_rate[2] = {0, 0};
};
using part_interval = basic_interval<double>;

template <class T>
struct basic_bounds {
  T x_min{}, x_max{}, s_min{}, s_max{};
};

constexpr int part_rows = 64;  // of one part, for its means

// Rows at s = m - h cos t for equally spaced t: the weight's d^2.5 at the edges becomes smooth, so
// that few rows give the means to many digits. Their number is fixed and a row is as wide as the
// lateral distance of its neighbours, so the means move smoothly with the wheelset, kinks in the
// profiles' curvature included. seen(number of the call of locus, point, weight, its growth with
// the depth) is told each row that counts.
struct nothing_seen {
  template <class... Row>
  void operator()(const Row &...) const {}
};

template <class T, class Locus, class Seen = nothing_seen>
void sum_rows(const Locus &locus, basic_part<T> &p, const Seen &seen = {}) {
  using std::sqrt;
  const T half = 0.5 * (p.end - p.begin), middle = 0.5 * (p.end + p.begin);
  decltype(locus(p.begin)) row[part_rows + 2];
  // cosines of equally spaced angles, each from the two before it
  const double turn = 2 * cos(std::numbers::pi / part_rows);
  double now = cos(0.5 * std::numbers::pi / part_rows), before = now;
  for (int i = 1; i <= part_rows; ++i) {
    row[i] = locus(middle - half * now);
    const double next = turn * now - before;
    before = now;
    now = next;
  }
  row[0] = locus(p.begin);
  row[part_rows + 1] = locus(p.end);
  p.first = row[0].wheel;
  p.last = row[part_rows + 1].wheel;
  bool any = false;
  for (int i = 1; i <= part_rows; ++i) {
    const auto &l = row[i];
    if (!l.valid || !(l.gap < 0)) continue;
    const T depth = -l.gap, reach = sqrt(depth / l.curvature);
    const T width = 0.5 * (row[i + 1].wheel[1] - row[i - 1].wheel[1]);
    const T weight = depth * depth * reach * width;
    p.weight += weight;
    p.x += weight * l.wheel[0];
    p.y += weight * l.wheel[1];
    p.angle += weight * l.contact_angle;
    // the weight goes with depth^2.5, and hardly with the curvature
    const basic_place_slope<T> deeper = depth_slope(l.wheel, l.normal);
    const T growth = 2.5 * weight / depth;
    p.weight_slope.add(growth, deeper);
    p.angle_slope.add(growth * l.contact_angle, deeper);
    seen(i - 1, l, weight, growth);
    const T low = l.wheel[0] - reach, high = l.wheel[0] + reach;
    if (!any || low < p.x_min) p.x_min = low;
    if (!any || p.x_max < high) p.x_max = high;
    any = true;
  }
  for (T *v : {&p.x, &p.y, &p.angle}) *v /= p.weight;
  p.angle_slope.add(-p.angle, p.weight_slope);
  p.angle_slope = scaled(1.0 / p.weight, p.angle_slope);
}

template <class T>
T facing_distance(const basic_part<T> &a, const basic_part<T> &b) {
  return hypot(b.first[1] - a.last[1], b.first[2] - a.last[2]);
}

template <class T>
T lateral_width(const basic_part<T> &p) {
  return hypot(p.last[1] - p.first[1], p.last[2] - p.first[2]);
}

// With which factor the tractions of two neighbours in one patch act on each other.
template <class T>
T interaction(const blend_rules &rule, const basic_part<T> &a, const basic_part<T> &b) {
  using std::max;
  using std::min;
  const T near = (rule.none - facing_distance(a, b)) / (rule.none - rule.full);
  if (!(near > 0)) return T(0);
  return near < 1.0 ? pow(near, 0.8) : T(1);
}

// How far two neighbours are one patch: 1, or 0 for patches of their own. By their distance, the
// smaller one's width, the greatest gap between and their contact angles.
template <class T>
T joined(const blend_rules &rule, const T &d, const T &w, const T &bump, const T &angle_a,
         const T &angle_b) {
  using std::fabs;
  const T apart = (fabs(angle_b - angle_a) - rule.angle_from) / (rule.angle_to - rule.angle_from);
  const T alike = rule.angle_fraction + (1.0 - rule.angle_fraction) * fade(apart);
  // gaps are vertical, and greater than across the surfaces where these are steep
  const T cosine = cos(0.5 * (angle_a + angle_b));
  const T upright = alike / (cosine > rule.steepest ? cosine : T(rule.steepest));
  const T low = upright * rule.low, high = upright * rule.high;
  const T near = fade((bump - low) / (high - low)) * fade((d - rule.one) / (rule.two - rule.one));
  const T share = w / (rule.grown * d);
  return share < 1.0 ? near * (1.0 - fade(share)) : near;
}

template <class T>
T joined(const blend_rules &rule, const basic_part<T> &a, const basic_part<T> &b) {
  using std::min;
  const T d = facing_distance(a, b), w = min(lateral_width(a), lateral_width(b));
  return joined(rule, d, w, a.bump, a.angle, b.angle);
}

// Share of the interval [begin, end) of `count` parts; joined[k] is that of parts k and k + 1.
template <class T>
T interval_share(const T *joined, int count, int begin, int end) {
  T share(1);
  if (begin > 0) share *= 1.0 - joined[begin - 1];
  for (int k = begin; k + 1 < end; ++k) share *= joined[k];
  if (end < count) share *= 1.0 - joined[end - 1];
  return share;
}

template <class T>
basic_interval<T> sum_parts(const basic_part<T> *parts, int begin, int end) {
  basic_interval<T> g;
  g.begin = begin;
  g.end = end;
  g.share = T(1);
  for (int i = begin; i < end; ++i) {
    const basic_part<T> &p = parts[i];
    g.weight += p.weight;
    g.x += p.weight * p.x;
    g.y += p.weight * p.y;
    g.angle += p.weight * p.angle;
  }
  for (T *v : {&g.x, &g.y, &g.angle}) *v /= g.weight;
  for (int i = begin; i < end; ++i) {
    const basic_part<T> &p = parts[i];
    g.angle_slope.add(p.weight / g.weight, p.angle_slope);
    g.angle_slope.add((p.angle - g.angle) / g.weight, p.weight_slope);
    if constexpr (std::is_same_v<T, double>)
      for (int k = 0; k < 2; ++k)
        g.angle_rate[k] += p.weight / g.weight * p.angle_rate[k] +
                           (p.angle - g.angle) / g.weight * p.weight_rate[k];
  }
  return g;
}

// Lateral position in a frame of origin and contact angle.
template <class T>
T lateral_in(const std::array<T, 3> &origin, const T &contact_angle, const std::array<T, 3> &p) {
  return cos(contact_angle) * (p[1] - origin[1]) + sin(contact_angle) * (p[2] - origin[2]);
}

// Bounds of the interpenetration in the frame: an interval's edges and rows.
template <class T>
basic_bounds<T> bounds_of(const basic_part<T> *parts, const basic_interval<T> &g,
                          const std::array<T, 3> &origin, const T &contact_angle) {
  basic_bounds<T> out;
  out.s_min = lateral_in(origin, contact_angle, parts[g.begin].first);
  out.s_max = lateral_in(origin, contact_angle, parts[g.end - 1].last);
  for (int i = g.begin; i < g.end; ++i) {
    const T low = parts[i].x_min - g.x, high = parts[i].x_max - g.x;
    if (i == g.begin || low < out.x_min) out.x_min = low;
    if (i == g.begin || out.x_max < high) out.x_max = high;
  }
  return out;
}

}  // namespace railpatch
