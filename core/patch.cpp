#include "patch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace railpatch {

namespace {

constexpr double closeness = 2e-5;  // m, sampled gaps below this are looked at closely
constexpr int rows = 64;            // of one part, for its means

// One part of contact, with its sums over rows.
struct part {
  double begin = 0, end = 0;                   // m, arc length on the wheel
  bool cut_off = false;                        // by the end of a profile
  vec3 first{}, last{};                        // edges, track axes, on the surfaces
  double weight = 0, x = 0, y = 0, angle = 0;  // weighted means
  double x_min = 0, x_max = 0;
};

double gap_at(const side_geometry &side, double s) {
  const locus_point l = side.locus(s);
  return l.valid ? l.gap : side_geometry::far_apart;
}

// where the gap changes sign between a and b: halving, sped up by the Illinois rule
double edge(const side_geometry &side, double a, double b) {
  double fa = gap_at(side, a), fb = gap_at(side, b);
  for (int i = 0; i < 100 && std::fabs(b - a) > 1e-12; ++i) {
    const double m = b - fb * (b - a) / (fb - fa), fm = gap_at(side, m);
    if (fm == 0) return m;
    if ((fm < 0) != (fb < 0)) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    if (std::fabs(m - b) < 1e-13) return m;
    b = m;
    fb = fm;
  }
  return b;
}

// least gap between a and c, where the middle is lower than both: golden section
double lowest(const side_geometry &side, double a, double c) {
  constexpr double ratio = 0.6180339887498949;
  double p = c - ratio * (c - a), q = a + ratio * (c - a);
  double fp = gap_at(side, p), fq = gap_at(side, q);
  for (int i = 0; i < 40 && c - a > 1e-9; ++i) {
    if (fp < fq) {
      c = q, q = p, fq = fp;
      p = c - ratio * (c - a);
      fp = gap_at(side, p);
    } else {
      a = p, p = q, fp = fq;
      q = a + ratio * (c - a);
      fq = gap_at(side, q);
    }
  }
  return fp < fq ? p : q;
}

class part_list {
 public:
  part_list(const side_geometry &side, part *parts) : side_(side), parts_(parts) {}

  void search() {
    for (int i = 0; i < side_.sample_count(); ++i) {
      const double sampled = side_.sample_gap(i);
      const double g = sampled < closeness ? gap_at(side_, side_.sample_s(i)) : sampled;
      advance(i, g);
      before_ = last_;
      last_ = g;
    }
    if (open_) close(side_.sample_s(side_.sample_count() - 1), true);
  }
  int count() const { return count_; }
  bool overflow() const { return overflow_; }

 private:
  void advance(int i, double g) {
    const double s = side_.sample_s(i), back = i > 0 ? side_.sample_s(i - 1) : s;
    const bool start = g < 0 && !open_, stop = g >= 0 && open_;
    if (start) begin(last_ < ended ? edge(side_, back, s) : s, !(last_ < ended));
    if (stop) close(g < ended ? edge(side_, s, back) : back, !(g < ended));
    // a dip between samples: contact that is only just beginning
    if (!start && !stop && !open_ && i > 1 && last_ < closeness && last_ <= before_ && last_ <= g)
      dip(side_.sample_s(i - 2), s);
  }

  void dip(double a, double c) {
    const double m = lowest(side_, a, c);
    if (!(gap_at(side_, m) < 0)) return;
    begin(edge(side_, a, m), false);
    close(edge(side_, c, m), false);
  }

  void begin(double s, bool cut_off) {
    open_ = true;
    current_ = {};
    current_.begin = s;
    current_.cut_off = cut_off;
  }

  void close(double s, bool cut_off) {
    open_ = false;
    current_.end = s;
    current_.cut_off |= cut_off;
    if (count_ == max_parts)
      overflow_ = true;
    else
      parts_[count_++] = current_;
  }

  static constexpr double ended = 0.5 * side_geometry::far_apart;
  const side_geometry &side_;
  part *parts_;
  part current_{};
  int count_ = 0;
  bool open_ = false, overflow_ = false;
  double last_ = side_geometry::far_apart, before_ = last_;
};

// A row whose overlap has any shape along x, see longitudinal_shape.hpp.
bool add_shaped(const side_geometry &side, double s, double width, double angle, bool any,
                part &p) {
  double y = 0, dy = 0;
  const row_overlap o = side.overlap(s, y, dy);
  if (!(o.weight > 0)) return false;
  const double weight = o.weight * width * dy;
  p.weight += weight;
  p.x += weight * o.x;
  p.y += weight * y;
  p.angle += weight * angle;
  p.x_min = any ? std::min(p.x_min, o.x_min) : o.x_min;
  p.x_max = any ? std::max(p.x_max, o.x_max) : o.x_max;
  return true;
}

// Rows at s = m - h cos t for equally spaced t: the weight's d^2.5 at the edges becomes smooth, so
// that few rows give the means to many digits. Their number is fixed and a row is as wide as the
// lateral distance of its neighbours, so the means move smoothly with the wheelset, kinks in the
// profiles' curvature included.
void sum_rows(const side_geometry &side, part &p) {
  const double half = 0.5 * (p.end - p.begin), middle = 0.5 * (p.end + p.begin);
  locus_point row[rows + 2];
  for (int i = 1; i <= rows; ++i)
    row[i] = side.locus(middle - half * std::cos(std::numbers::pi * (i - 0.5) / rows));
  row[0] = side.locus(p.begin);
  row[rows + 1] = side.locus(p.end);
  p.first = row[0].wheel;
  p.last = row[rows + 1].wheel;
  bool any = false;
  for (int i = 1; i <= rows; ++i) {
    const locus_point &l = row[i];
    if (!l.valid || !(l.gap < 0)) continue;
    if (side.shaped()) {
      const auto at = [&](int k) {
        return middle -
               half * std::cos(std::numbers::pi * std::clamp(k - 0.5, 0.0, 1.0 * rows) / rows);
      };
      any |= add_shaped(side, at(i), 0.5 * (at(i + 1) - at(i - 1)), l.contact_angle, any, p);
      continue;
    }
    const double depth = -l.gap, reach = std::sqrt(depth / l.curvature);
    const double width = 0.5 * (row[i + 1].wheel[1] - row[i - 1].wheel[1]);
    const double weight = depth * depth * reach * width;
    p.weight += weight;
    p.x += weight * l.wheel[0];
    p.y += weight * l.wheel[1];
    p.angle += weight * l.contact_angle;
    p.x_min = any ? std::min(p.x_min, l.wheel[0] - reach) : l.wheel[0] - reach;
    p.x_max = any ? std::max(p.x_max, l.wheel[0] + reach) : l.wheel[0] + reach;
    any = true;
  }
  for (double *v : {&p.x, &p.y, &p.angle}) *v /= p.weight;
}

double distance(const part &a, const part &b) {
  return std::hypot(b.first[1] - a.last[1], b.first[2] - a.last[2]);
}

bool together(const patch_rules &r, const part &a, const part &b) {
  return distance(a, b) < r.separate && std::fabs(b.angle - a.angle) < r.max_angle;
}

// Angles of neighbouring patches approach their mean as their distance falls from turn to separate.
struct group {
  int begin, end;  // parts
  double weight, x, y, angle, turned;
};

group sum_parts(const part *parts, int begin, int end) {
  group g{begin, end, 0, 0, 0, 0, 0};
  for (int i = begin; i < end; ++i) {
    const part &p = parts[i];
    g.weight += p.weight;
    g.x += p.weight * p.x;
    g.y += p.weight * p.y;
    g.angle += p.weight * p.angle;
  }
  for (double *v : {&g.x, &g.y, &g.angle}) *v /= g.weight;
  g.turned = g.angle;
  return g;
}

void turn_neighbours(const patch_rules &r, const part *parts, group *groups, int count) {
  for (int k = 0; k + 1 < count; ++k) {
    group &a = groups[k], &b = groups[k + 1];
    const double d = distance(parts[a.end - 1], parts[b.begin]);
    if (d >= r.turn || std::fabs(b.angle - a.angle) >= r.max_angle) continue;
    const double share = std::min(1.0, (r.turn - d) / (r.turn - r.separate));
    const double mean = (a.weight * a.angle + b.weight * b.angle) / (a.weight + b.weight);
    a.turned += share * (mean - a.angle);
    b.turned += share * (mean - b.angle);
  }
}

double lateral(const contact_frame &f, const vec3 &p) {
  return std::cos(f.contact_angle) * (p[1] - f.origin[1]) +
         std::sin(f.contact_angle) * (p[2] - f.origin[2]);
}

// greatest overlap along n on the locus, refined by the parabola through the three greatest rows
double deepest(const side_geometry &side, const contact_frame &f, const part &p) {
  constexpr int rows = 24;
  double x[rows], s[rows], h[rows], best = 0;
  for (int i = 0; i < rows; ++i) {
    const locus_point l = side.locus(p.begin + (p.end - p.begin) * (i + 0.5) / rows);
    x[i] = l.wheel[0] - f.origin[0];
    s[i] = lateral(f, l.wheel);
  }
  side.distances(f, x, s, rows, h);
  for (int i = 0; i < rows; ++i) best = std::max(best, -h[i]);
  for (int i = 1; i + 1 < rows; ++i) {
    const double bend = h[i - 1] - 2 * h[i] + h[i + 1], rise = 0.5 * (h[i + 1] - h[i - 1]);
    if (-h[i] == best && bend > 0) return best + 0.5 * rise * rise / bend;
  }
  return best;
}

patch_region describe(const side_geometry &side, const patch_rules &r, const part *parts,
                      const group &g) {
  patch_region out;
  double angle;
  out.frame.origin = {g.x, g.y, 0};
  out.frame.contact_angle = g.turned;
  // between two parts the reference can lie where the rail is not touched, but never beyond it
  side.rail_surface(g.x, g.y, out.frame.origin[2], angle);
  out.weight = g.weight;
  out.parts = g.end - g.begin;
  const part &first = parts[g.begin], &last = parts[g.end - 1];
  out.s_min = lateral(out.frame, first.first);
  out.s_max = lateral(out.frame, last.last);
  for (int i = g.begin; i < g.end; ++i) {
    const part &p = parts[i];
    const double x_min = p.x_min - g.x, x_max = p.x_max - g.x;
    out.x_min = i > g.begin ? std::min(out.x_min, x_min) : x_min;
    out.x_max = i > g.begin ? std::max(out.x_max, x_max) : x_max;
    out.at_profile_end |= p.cut_off;
    out.max_interpenetration = std::max(out.max_interpenetration, deepest(side, out.frame, p));
    if (i + 1 == g.end) break;
    const part &next = parts[i + 1];
    const double d = distance(p, next);
    out.cut[i - g.begin] = 0.5 * (lateral(out.frame, p.last) + lateral(out.frame, next.first));
    const double share = std::clamp((r.separate - d) / (r.separate - r.combine), 0.0, 1.0);
    out.coupling[i - g.begin] = std::pow(share, r.coupling_exponent);
  }
  return out;
}

// the heaviest patches first to stay, in their order along the rail
void keep_heaviest(group *groups, int &count, int limit) {
  while (count > limit) {
    const auto less = [](const group &a, const group &b) { return a.weight < b.weight; };
    group *least = std::min_element(groups, groups + count, less);
    std::move(least + 1, groups + count, least);
    --count;
  }
}

}  // namespace

search_result find_patches(const side_geometry &side, const patch_rules &rules, patch_region *out,
                           int max_patches) {
  if (side.no_overlap()) return {search_status::out_of_range, 0};
  part parts[max_parts];
  part_list list(side, parts);
  list.search();
  int count = 0;
  for (int i = 0; i < list.count(); ++i) {
    sum_rows(side, parts[i]);
    if (parts[i].weight > 0) parts[count++] = parts[i];
  }
  if (count == 0) return {search_status::no_contact, 0};
  group groups[max_parts];
  int patches = 0;
  for (int i = 0, begin = 0; i < count; ++i) {
    if (i + 1 < count && together(rules, parts[i], parts[i + 1])) continue;
    groups[patches++] = sum_parts(parts, begin, i + 1);
    begin = i + 1;
  }
  turn_neighbours(rules, parts, groups, patches);
  const bool too_many = list.overflow() || patches > max_patches;
  keep_heaviest(groups, patches, max_patches);
  for (int k = 0; k < patches; ++k) out[k] = describe(side, rules, parts, groups[k]);
  return {too_many ? search_status::too_many_patches : search_status::contact, patches};
}

bool first_touch(const side_geometry &side, double &z) {
  if (side.no_overlap()) return false;
  // every sampled valley deep enough to hold the least gap is searched exactly
  double least = side_geometry::far_apart;
  for (int i = 0; i < side.sample_count(); ++i) least = std::min(least, side.sample_gap(i));
  double best = least + closeness;
  for (int i = 1; i + 1 < side.sample_count(); ++i) {
    const double g = side.sample_gap(i);
    if (g > least + closeness || g > side.sample_gap(i - 1) || g > side.sample_gap(i + 1)) continue;
    const locus_point l = side.locus(lowest(side, side.sample_s(i - 1), side.sample_s(i + 1)));
    if (l.valid) best = std::min(best, l.gap);
  }
  z = side.motion().wheelset.z + best;
  return true;
}

patch_region mirrored(patch_region p) {
  p.frame = mirrored(p.frame);
  std::swap(p.s_min, p.s_max);
  p.s_min = -p.s_min;
  p.s_max = -p.s_max;
  for (int k = 0; k + 1 < p.parts; ++k) p.cut[k] = -p.cut[k];
  std::reverse(p.cut, p.cut + p.parts - 1);
  std::reverse(p.coupling, p.coupling + p.parts - 1);
  return p;
}

}  // namespace railpatch
