#include "geometry/patch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr double closeness = side_geometry::closeness;
constexpr double closest = 1e-4;      // m, steps on the way from an appearing part to its neighbour
constexpr double least_share = 1e-6;  // what counts less is below any tolerance and left out

double gap_at(const side_geometry &side, double s) { return side.gap(s); }

// where the gap changes sign between a and b: halving, sped up by the Illinois rule
double edge(const side_geometry &side, double a, double b, locus_place &last) {
  double fa = side.gap(a, last), fb = side.gap(b, last);
  for (int i = 0; i < 100 && std::fabs(b - a) > 1e-12; ++i) {
    const double m = b - fb * (b - a) / (fb - fa), fm = side.gap(m, last);
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

// The same between two samples that are gaps nearly: by newton's steps, two where the profiles are
// smooth, from where the line through both changes sign. Its error falls with the square.
double edge(const side_geometry &side, double a, double b, double near_a, double near_b,
            locus_place &last) {
  const double enough = side.level() ? 1e-8 : 1e-10;  // m, of a step
  double at = b - near_b * (b - a) / (near_b - near_a), before = HUGE_VAL;
  for (int i = 0; i < 8 && !side.shaped(); ++i) {
    if (!(std::min(a, b) <= at && at <= std::max(a, b))) break;
    double slope;
    const double step = -side.gap(at, last, slope) / slope, size = std::fabs(step);
    if (!(size < 0.5 * before)) break;
    at += step;
    if (size < enough) return std::clamp(at, std::min(a, b), std::max(a, b));
    before = size;
  }
  return edge(side, a, b, last);
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

// greatest gap between two parts, and where
void find_bump(const side_geometry &side, part &a, const part &b) {
  constexpr int samples = 16;
  const double step = (b.begin - a.end) / samples;
  double at = a.end, most = 0;
  for (int i = 1; i < samples; ++i) {
    const double s = a.end + i * step, gap = gap_at(side, s);
    if (gap > most) most = gap, at = s;
  }
  // golden section between the neighbours
  constexpr double ratio = 0.6180339887498949;
  double low = std::max(a.end, at - step), high = std::min(b.begin, at + step);
  for (int i = 0; i < 24; ++i) {
    const double p = high - ratio * (high - low), q = low + ratio * (high - low);
    (gap_at(side, p) > gap_at(side, q) ? high : low) = gap_at(side, p) > gap_at(side, q) ? q : p;
  }
  a.bump_at = 0.5 * (low + high);
  a.bump = std::max(gap_at(side, a.bump_at), 0.0);
}

class part_list {
 public:
  part_list(const side_geometry &side, part *parts) : side_(side), parts_(parts) {}

  void search() {
    for (int i = 0; (i = pass_over(i)) < side_.sample_count(); ++i) {
      const double sampled = side_.sample_gap(i);
      if (!open_ && sampled >= closeness && last_ >= closeness) {
        before_ = last_;
        last_ = sampled;
        continue;
      }
      // within contact a sample's sign is all that counts
      const double near = open_ ? 0.25 * closeness : closeness;
      const double g = std::fabs(sampled) < near ? side_.gap(side_.sample_s(i), place_) : sampled;
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
    if (start) begin(last_ < ended ? edge(side_, back, s, last_, g, place_) : s, !(last_ < ended));
    if (stop) close(g < ended ? edge(side_, s, back, g, last_, place_) : back, !(g < ended));
    // a dip between samples: contact that is only just beginning
    if (!start && !stop && !open_ && i > 1 && last_ < closeness && last_ <= before_ && last_ <= g)
      dip(side_.sample_s(i - 2), s);
  }

  // samples that were not looked at, and their neighbours, are not close
  int pass_over(int i) {
    const int next = side_.next_sample(i);
    if (next > i) before_ = last_ = closeness;
    return next;
  }

  void dip(double a, double c) {
    const double m = lowest(side_, a, c);
    if (!(gap_at(side_, m) < 0)) return;
    begin(edge(side_, a, m, place_), false);
    close(edge(side_, c, m, place_), false);
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
  locus_place place_;
};

// A row whose overlap has any shape along x, see longitudinal_shape.hpp.
void add_shaped(const side_geometry &side, double s, double width, part &p) {
  const locus_point l = side.locus(s);
  if (!l.valid || !(l.gap < 0)) return;
  double y = 0, dy = 0;
  const row_overlap o = side.overlap(s, y, dy);
  if (!(o.weight > 0)) return;
  const double weight = o.weight * width * dy;
  p.x_min = p.weight > 0 ? std::min(p.x_min, o.x_min) : o.x_min;
  p.x_max = p.weight > 0 ? std::max(p.x_max, o.x_max) : o.x_max;
  p.weight += weight;
  p.x += weight * o.x;
  p.y += weight * y;
  p.angle += weight * l.contact_angle;
}

// The sums over rows, as in patch_parts.hpp, where wheel or rail are shaped along x. A row is as
// wide as the arc length of its neighbours says: on a yawed wheel they may be touched elsewhere.
void sum_shaped_rows(const side_geometry &side, part &p) {
  const double half = 0.5 * (p.end - p.begin), middle = 0.5 * (p.end + p.begin);
  const auto at = [&](int i) {
    const double share = std::clamp((i - 0.5) / part_rows, 0.0, 1.0);
    return middle - half * cos(std::numbers::pi * share);
  };
  p.first = side.locus(p.begin).wheel;
  p.last = side.locus(p.end).wheel;
  for (int i = 1; i <= part_rows; ++i) add_shaped(side, at(i), 0.5 * (at(i + 1) - at(i - 1)), p);
  for (double *v : {&p.x, &p.y, &p.angle}) *v /= p.weight;
}

// The sums over rows, and how they change with the position of sections.
void sum_section_rows(const side_geometry &side, locus_walk &walk, part &p) {
  double at[part_rows + 2];
  int calls = 0;
  const auto locus = [&](double s) {
    at[calls++] = s;
    return walk(s);
  };
  double by_angle[2] = {0, 0};
  const auto seen = [&](int call, const locus_point &l, double weight, double growth) {
    const section_growth g = side.section_growth_at(at[call], l);
    for (int k = 0; k < 2; ++k) {
      p.weight_rate[k] += growth * g.depth[k];
      by_angle[k] += growth * g.depth[k] * l.contact_angle + weight * g.angle[k];
    }
  };
  sum_rows(locus, p, seen);
  for (int k = 0; k < 2; ++k)
    p.angle_rate[k] = (by_angle[k] - p.angle * p.weight_rate[k]) / p.weight;
}

bool together(const patch_rules &r, const part &a, const part &b) {
  return facing_distance(a, b) < r.separate && std::fabs(b.angle - a.angle) < r.max_angle;
}

// Angles of neighbouring patches approach their mean as their distance falls from turn to separate.
void turn_neighbours(const patch_rules &r, const part *parts, const part_interval *groups,
                     int count, double *angles) {
  for (int k = 0; k < count; ++k) angles[k] = groups[k].angle;
  for (int k = 0; k + 1 < count; ++k) {
    const part_interval &a = groups[k], &b = groups[k + 1];
    const double d = facing_distance(parts[a.end - 1], parts[b.begin]);
    if (d >= r.turn || std::fabs(b.angle - a.angle) >= r.max_angle) continue;
    const double share = std::min(1.0, (r.turn - d) / (r.turn - r.separate));
    const double mean = (a.weight * a.angle + b.weight * b.angle) / (a.weight + b.weight);
    angles[k] += share * (mean - a.angle);
    angles[k + 1] += share * (mean - b.angle);
  }
}

double lateral(const contact_frame &f, const vec3 &p) {
  return lateral_in(f.origin, f.contact_angle, p);
}

patch_region describe(const side_geometry &side, const patch_rules &r, const part *parts,
                      const part_interval &g, double contact_angle) {
  patch_region out;
  double angle;
  out.frame.origin = {g.x, g.y, 0};
  out.frame.contact_angle = contact_angle;
  // between two parts the reference can lie where the rail is not touched, but never beyond it
  side.rail_surface(g.x, g.y, out.frame.origin[2], angle);
  if (r.inclined) out.frame.inclination = side.roller_inclination(out.frame.origin);
  out.weight = g.weight;
  out.share = g.share;
  if (r.blended) out.angle_slope = g.angle_slope;
  if (r.blended) std::copy_n(g.angle_rate, 2, out.angle_rate);
  out.first_part = g.begin;
  out.parts = g.end - g.begin;
  const basic_bounds<double> bounds = bounds_of(parts, g, out.frame.origin, contact_angle);
  out.x_min = bounds.x_min;
  out.x_max = bounds.x_max;
  out.s_min = bounds.s_min;
  out.s_max = bounds.s_max;
  for (int i = g.begin; i < g.end; ++i) {
    const part &p = parts[i];
    out.at_profile_end |= p.cut_off;
    if (i + 1 == g.end) break;
    const part &next = parts[i + 1];
    out.cut[i - g.begin] = 0.5 * (lateral(out.frame, p.last) + lateral(out.frame, next.first));
    if (r.blended) {
      out.coupling[i - g.begin] = interaction(r.blend, p, next);
      continue;
    }
    const double d = facing_distance(p, next);
    const double share = std::clamp((r.separate - d) / (r.separate - r.combine), 0.0, 1.0);
    out.coupling[i - g.begin] = pow(share, r.coupling_exponent);
  }
  return out;
}

// All intervals of parts that count, with their shares, in the order of their first and last part.
int blend(const blend_rules &rules, const part_set &found, part_interval *out) {
  double join[max_parts];
  for (int k = 0; k + 1 < found.count; ++k)
    join[k] = joined(rules, found.parts[k], found.parts[k + 1]);
  // each gap is as it mostly is in the division that leads
  double mostly[max_parts];
  for (int k = 0; k + 1 < found.count; ++k) mostly[k] = join[k] < 0.5 ? 0.0 : 1.0;
  int count = 0;
  for (const bool leading : {true, false})
    for (int begin = 0; begin < found.count; ++begin)
      for (int end = begin + 1; end <= found.count; ++end) {
        const bool leads = interval_share(mostly, found.count, begin, end) > 0;
        const double share = interval_share(join, found.count, begin, end);
        if (leads != leading || !(share > least_share)) continue;
        out[count] = sum_parts(found.parts, begin, end);
        out[count].leads = leads;
        out[count++].share = share;
      }
  return count;
}

// Neighbours that are near enough as one, all others on their own.
int divide(const patch_rules &rules, const part_set &found, part_interval *out) {
  int count = 0;
  for (int i = 0, begin = 0; i < found.count; ++i) {
    if (i + 1 < found.count && together(rules, found.parts[i], found.parts[i + 1])) continue;
    out[count++] = sum_parts(found.parts, begin, i + 1);
    begin = i + 1;
  }
  return count;
}

// the heaviest patches first to stay, in their order along the rail
void keep_heaviest(part_interval *groups, double *angles, int &count, int limit) {
  while (count > limit) {
    const auto less = [](const part_interval &a, const part_interval &b) {
      return a.share * a.weight < b.share * b.weight;
    };
    part_interval *least = std::min_element(groups, groups + count, less);
    std::move(angles + (least - groups) + 1, angles + count, angles + (least - groups));
    std::move(least + 1, groups + count, least);
    --count;
  }
}

// Where gaps are `lower` less a part appears at found.at: its nearest neighbour that it would be
// one patch with, and the greatest gap on the way.
void find_neighbour(const side_geometry &side, const blend_rules &rule, double lower,
                    appearance &found) {
  for (const int step : {-1, 1}) {
    double bump = 0;
    for (int k = 0; k * closest < rule.two; ++k) {
      const double distance = (k + 1) * closest;
      const double gap = gap_at(side, found.at + step * distance) - lower;
      bump = std::max(bump, gap);
      if (bump > rule.high) break;
      if (gap >= 0) continue;
      if (found.neighbour == 0 || distance < std::fabs(found.neighbour)) {
        found.neighbour = step * distance;
        found.bump = bump;
      }
      break;
    }
  }
}

}  // namespace

void find_parts(const side_geometry &side, part_set &found) {
  part_list list(side, found.parts);
  list.search();
  found.count = 0;
  found.overflow = list.overflow();
  locus_walk walk(side);
  const auto locus = [&](double s) { return walk(s); };
  const bool varies = side.varies(body::rail) || side.varies(body::wheel);
  for (int i = 0; i < list.count(); ++i) {
    if (side.shaped())
      sum_shaped_rows(side, found.parts[i]);
    else if (varies)
      sum_section_rows(side, walk, found.parts[i]);
    else
      sum_rows(locus, found.parts[i]);
    if (found.parts[i].weight > 0) found.parts[found.count++] = found.parts[i];
  }
  for (int i = 0; i + 1 < found.count; ++i) find_bump(side, found.parts[i], found.parts[i + 1]);
}

double lowest_gap(const side_geometry &side, double begin, double end) {
  return lowest(side, begin, end);
}

search_result find_patches(const side_geometry &side, const patch_rules &rules, part_set &found,
                           patch_region *out, int max_patches) {
  found.count = 0;
  if (side.no_overlap()) return {search_status::out_of_range, 0};
  find_parts(side, found);
  if (found.count == 0) return {search_status::no_contact, 0};
  part_interval groups[max_parts * (max_parts + 1) / 2];
  double angles[max_parts * (max_parts + 1) / 2];
  int patches = rules.blended ? blend(rules.blend, found, groups) : divide(rules, found, groups);
  if (rules.blended)
    for (int k = 0; k < patches; ++k) angles[k] = groups[k].angle;
  else
    turn_neighbours(rules, found.parts, groups, patches, angles);
  const bool too_many = found.overflow || patches > max_patches;
  keep_heaviest(groups, angles, patches, max_patches);
  int lead = 0;
  for (int k = 0; k < patches; ++k) {
    out[k] = describe(side, rules, found.parts, groups[k], angles[k]);
    lead += groups[k].leads;
  }
  return {too_many ? search_status::too_many_patches : search_status::contact, patches, lead};
}

int find_appearances(const side_geometry &side, const patch_rules &rules, double low, double high,
                     appearance *out, int most) {
  if (!rules.blended || side.no_overlap() || side.shaped()) return 0;
  int count = 0;
  const double z = side.motion().wheelset.z;
  const auto gap = [&](int i) { return z + side.sample_gap(i); };
  const auto exact = [&](int i) {
    const double g = gap(i);
    return g < low - closeness || g > high + closeness ? g : z + gap_at(side, side.sample_s(i));
  };
  double before = HUGE_VAL, last = HUGE_VAL;
  for (int i = 1; i < side.sample_count() && count < most; ++i) {
    const double g = exact(i);
    if (last <= before && last < g && last > low - closeness && last < high + closeness) {
      const double s = lowest(side, side.sample_s(i - 2), side.sample_s(i));
      appearance found;
      found.z = z + gap_at(side, s);
      found.at = s;
      const bool within = found.z > low && found.z < high;
      if (within) find_neighbour(side, rules.blend, found.z - z, found);
      const double distance = std::fabs(found.neighbour);
      // as wide as it is then
      const double half = 0.5 * rules.blend.grown * distance;
      found.length = 0.5 * (gap_at(side, s - half) + gap_at(side, s + half)) - (found.z - z);
      if (distance > 0 && found.length > 0 && found.length < closeness) out[count++] = found;
    }
    before = last;
    last = g;
  }
  return count;
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
