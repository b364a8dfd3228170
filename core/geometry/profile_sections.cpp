#include "geometry/profile_sections.hpp"

#include <algorithm>
#include <cmath>

namespace railpatch {

namespace {

constexpr double same_share = 1e-9;  // of the arc length

double share_of(const profile_view &v, int i) {
  return (v.s[i] - v.s[0]) / (v.s[v.n - 1] - v.s[0]);
}

// Weights of Hermite's cubic over a way h at a share t of it: of the second value, of both slopes.
struct cubic {
  double second, first_slope, second_slope;
};

cubic cubic_at(double t, double h, bool curved) {
  if (!curved) return {t, 0, 0};
  return {t * t * (3 - 2 * t), h * t * (1 - t) * (1 - t), -h * t * t * (1 - t)};
}

// Their derivatives by the share.
cubic cubic_rate_at(double t, double h, bool curved) {
  if (!curved) return {1, 0, 0};
  return {6 * t * (1 - t), h * (1 - t) * (1 - 3 * t), -h * t * (2 - 3 * t)};
}

// About how much of the arc length belongs to knot i; also of its changes.
double span(const std::vector<double> &s, std::size_t i) {
  const std::size_t last = s.size() - 1;
  return s[std::min(i + 1, last)] - s[i > 0 ? i - 1 : 0];
}

}  // namespace

bool profile_sections::belong_together(const profile_view &a, const profile_view &b, bool by_knot) {
  if (a.n != b.n) return false;
  if (by_knot) return true;
  for (int i = 0; i < a.n; ++i)
    if (!(std::fabs(share_of(a, i) - share_of(b, i)) <= same_share)) return false;
  return true;
}

profile_sections::profile_sections(const profile_view *sections, const double *positions, int count,
                                   const section_rules &rules)
    : rules_(rules) {
  for (int k = 0; k < count; ++k) {
    const profile_view &v = sections[k];
    const auto copy = [&](const double *from) { return values(from, from + v.n); };
    sections_.push_back({positions[k], copy(v.s), copy(v.y), copy(v.z), copy(v.dy), copy(v.dz)});
  }
  now_ = sections_.front();
  if (rules.cubic) find_slopes(rules.kink);
  rules_.kink = nullptr;
}

// From section k to the one that follows.
double profile_sections::way(std::size_t k) const {
  if (k + 1 < sections_.size()) return sections_[k + 1].position - sections_[k].position;
  return sections_.front().position + rules_.period - sections_[k].position;
}

template <class F>
void profile_sections::set_slopes(slopes &to, F slope) const {
  for (std::size_t i = 0; i < to.s.size(); ++i) {
    to.s[i] = slope(&section::s, &slopes::s, i);
    to.y[i] = slope(&section::y, &slopes::y, i);
    to.z[i] = slope(&section::z, &slopes::z, i);
  }
}

void profile_sections::find_slopes(const std::int32_t *kink) {
  const std::size_t count = sections_.size(), n = now_.s.size();
  const bool round = rules_.period > 0 && count > 1;
  const auto before = [&](std::size_t k) { return k > 0 ? k - 1 : count - 1; };
  const auto after = [&](std::size_t k) { return k + 1 < count ? k + 1 : 0; };
  const auto broken = [&](std::size_t k) { return kink && kink[k] != 0; };
  const auto outer = [&](std::size_t k) { return !round && (k == 0 || k + 1 == count); };
  left_.resize(count);
  right_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    left_[k] = right_[k] = slopes_.size();
    slopes_.push_back({values(n), values(n), values(n)});
    if (outer(k)) continue;
    if (broken(k)) {
      right_[k] = slopes_.size();
      slopes_.push_back({values(n), values(n), values(n)});
      continue;
    }
    const section &a = sections_[before(k)], &b = sections_[k], &c = sections_[after(k)];
    const double h1 = way(before(k)), h2 = way(k);
    set_slopes(slopes_[left_[k]], [&](values section::*of, values slopes::*, std::size_t i) {
      const double d1 = ((b.*of)[i] - (a.*of)[i]) / h1, d2 = ((c.*of)[i] - (b.*of)[i]) / h2;
      return (h2 * d1 + h1 * d2) / (h1 + h2);
    });
  }
  // sides of kinks, from the slopes at their other ends: a chord between two kinks, and beside an
  // outer end, whose slope of 0 is that of the rail beyond
  for (std::size_t k = 0; k < count; ++k) {
    if (left_[k] == right_[k]) continue;
    const auto one_sided = [&](std::size_t from, std::size_t to, std::size_t own, std::size_t far,
                               double h, bool chord) {
      const section &a = sections_[from], &b = sections_[to];
      const slopes &other = slopes_[far];
      set_slopes(slopes_[own], [&](values section::*of, values slopes::*rate, std::size_t i) {
        const double d = ((b.*of)[i] - (a.*of)[i]) / h;
        return chord ? d : 0.5 * (3 * d - (other.*rate)[i]);
      });
    };
    const std::size_t p = before(k), q = after(k);
    one_sided(p, k, left_[k], right_[p], way(p), broken(p) || outer(p));
    one_sided(k, q, right_[k], left_[q], way(k), broken(q) || outer(q));
  }
}

profile_sections::place profile_sections::place_of(double x) const {
  const double start = sections_.front().position;
  if (rules_.period > 0) {
    x -= rules_.period * std::floor((x - start) / rules_.period);
    if (!(x - start < rules_.period)) x = start;
  }
  const auto above = std::upper_bound(sections_.begin(), sections_.end(), x,
                                      [](double v, const section &k) { return v < k.position; });
  const auto after = static_cast<std::size_t>(above - sections_.begin());
  const std::size_t first = after > 0 ? after - 1 : 0;
  const bool round = rules_.period > 0 && sections_.size() > 1;
  const bool between = after > 0 && (after < sections_.size() || round);
  const std::size_t second = !between ? first : after < sections_.size() ? after : 0;
  const double length = between ? way(first) : 1.0;
  const double share = between ? (x - sections_[first].position) / length : 0.0;
  return {first, second, share, length};
}

profile_view profile_sections::at(double x, bool &changed) {
  const place found = place_of(x);
  changed =
      found.first != last_.first || found.second != last_.second || found.share != last_.share;
  last_ = found;
  if (!changed) return view();
  if (rules_.by_knot || rules_.cubic)
    mix_knots(found);
  else
    mix_shares(sections_[found.first], sections_[found.second], found.share);
  return view();
}

void profile_sections::mix_shares(const section &a, const section &b, double w) {
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
}

// Knot by knot. Tangents are those by the knots' number, over that of the arc length.
void profile_sections::mix_knots(const place &at) {
  const section &a = sections_[at.first], &b = sections_[at.second];
  const cubic w = cubic_at(at.share, at.length, rules_.cubic);
  const auto mix = [&w](double from, double to) { return from + w.second * (to - from); };
  const std::size_t n = a.s.size();
  const slopes *p = rules_.cubic ? &slopes_[right_[at.first]] : nullptr;
  const slopes *q = rules_.cubic ? &slopes_[left_[at.second]] : nullptr;
  const auto blend = [&](const values &from, const values &to, values slopes::*rate, values &out) {
    for (std::size_t i = 0; i < n; ++i) out[i] = mix(from[i], to[i]);
    if (!p) return;
    const values &c = p->*rate, &d = q->*rate;
    for (std::size_t i = 0; i < n; ++i) out[i] += w.first_slope * c[i] + w.second_slope * d[i];
  };
  blend(a.s, b.s, &slopes::s, now_.s);
  blend(a.y, b.y, &slopes::y, now_.y);
  blend(a.z, b.z, &slopes::z, now_.z);
  for (std::size_t i = 0; i < n; ++i) {
    const double here = span(now_.s, i), to_a = span(a.s, i) / here, to_b = span(b.s, i) / here;
    now_.dy[i] = mix(to_a * a.dy[i], to_b * b.dy[i]);
    now_.dz[i] = mix(to_a * a.dz[i], to_b * b.dz[i]);
    if (!p) continue;
    now_.dy[i] += (w.first_slope * span(p->y, i) + w.second_slope * span(q->y, i)) / here;
    now_.dz[i] += (w.first_slope * span(p->z, i) + w.second_slope * span(q->z, i)) / here;
  }
}

// The derivative of mix_shares and mix_knots; a tangent is a sum over a length, of which both go.
profile_sections::knot_rate profile_sections::rate_of(std::size_t i) const {
  const section &a = sections_[last_.first], &b = sections_[last_.second];
  const double per = 1 / last_.length;
  if (!rules_.by_knot && !rules_.cubic) {
    const std::size_t end = a.s.size() - 1;
    const auto whole = [end](const section &k) { return k.s[end] - k.s[0]; };
    const double of_a = whole(a), of_b = whole(b), length = whole(now_);
    const auto tangent = [&](values section::*of) {
      const double rise = of_b * (b.*of)[i] - of_a * (a.*of)[i];
      return per * (rise - (now_.*of)[i] * (of_b - of_a)) / length;
    };
    return {per * (b.s[i] - a.s[i]), per * (b.y[i] - a.y[i]), per * (b.z[i] - a.z[i]),
            tangent(&section::dy), tangent(&section::dz)};
  }
  const cubic w = cubic_rate_at(last_.share, last_.length, rules_.cubic);
  const slopes *p = rules_.cubic ? &slopes_[right_[last_.first]] : nullptr;
  const slopes *q = rules_.cubic ? &slopes_[left_[last_.second]] : nullptr;
  const auto mix = [&](double from, double to, double first, double second) {
    return per * (w.second * (to - from) + w.first_slope * first + w.second_slope * second);
  };
  const auto knot = [&](values section::*of, values slopes::*rate) {
    return mix((a.*of)[i], (b.*of)[i], p ? (p->*rate)[i] : 0.0, q ? (q->*rate)[i] : 0.0);
  };
  const auto wide = [&](const slopes *of, values slopes::*rate) {
    return of ? span(of->*rate, i) : 0.0;
  };
  const double here = span(now_.s, i);
  const double grows = mix(span(a.s, i), span(b.s, i), wide(p, &slopes::s), wide(q, &slopes::s));
  const auto tangent = [&](values section::*of, values slopes::*rate) {
    const double rise =
        mix(span(a.s, i) * (a.*of)[i], span(b.s, i) * (b.*of)[i], wide(p, rate), wide(q, rate));
    return (rise - (now_.*of)[i] * grows) / here;
  };
  return {knot(&section::s, &slopes::s), knot(&section::y, &slopes::y),
          knot(&section::z, &slopes::z), tangent(&section::dy, &slopes::y),
          tangent(&section::dz, &slopes::z)};
}

section_rate profile_sections::rate(int piece, double t) const {
  const auto i = static_cast<std::size_t>(piece);
  if (last_.first == last_.second) return {};
  const knot_rate a = rate_of(i), b = rate_of(i + 1);
  const double length = now_.s[i + 1] - now_.s[i], grows = b.s - a.s;
  // Hermite's cubic over the share: ends, and tangents by the share
  const auto at = [&](double first, double last, double from, double to, double &slope) {
    const double rise = last - first, bend = 3 * rise - 2 * from - to, turn = from + to - 2 * rise;
    slope = (from + t * (2 * bend + 3 * t * turn)) / length;
    return first + t * (from + t * (bend + t * turn));
  };
  const auto tangent = [&](double rate, double value) { return length * rate + grows * value; };
  section_rate out;
  out.y = at(a.y, b.y, tangent(a.dy, now_.dy[i]), tangent(b.dy, now_.dy[i + 1]), out.dy);
  out.z = at(a.z, b.z, tangent(a.dz, now_.dz[i]), tangent(b.dz, now_.dz[i + 1]), out.dz);
  return out;
}

std::size_t profile_sections::bytes() const {
  const std::size_t knots = now_.s.size() * sizeof(double);
  return (sections_.size() + 1) * (sizeof(section) + 5 * knots) +
         slopes_.size() * (sizeof(slopes) + 3 * knots);
}

}  // namespace railpatch
