#include "tangential/bound_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

using std::numbers::ln2;

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1]; }

// f(u) of a shape: 1 at rest, 1/2 at u = 1, nowhere below 0, falling ever more slowly, u |f'| not
// above 1. The limits of steepest_fall rest on that.
double shape_at(rp_slip_law shape, double u, double &slope) {
  double f = 0;
  slope = 0;
  switch (shape) {
    case RP_SLIP_EXPONENTIAL:
      f = exp2(-u);
      slope = -ln2 * f;
      break;
    case RP_SLIP_RATIONAL:
      f = 1.0 / (1.0 + u);
      slope = -f * f;
      break;
    case RP_SLIP_LINEAR:
      f = std::max(0.0, 1.0 - 0.5 * u);
      slope = f > 0 ? -0.5 : 0.0;
      break;
  }
  return f;
}

}  // namespace

// --- slip velocity -------------------------------------------------------------------------------

double slip_velocity_law::coefficient(double speed, double &slope) const {
  double mu = kinetic;
  slope = 0;
  for (int i = 0; i < 2; ++i) {
    if (amplitude[i] == 0) continue;
    double df;
    const double f = shape_at(shape, speed / halving_speed[i], df);
    mu += amplitude[i] * f;
    slope += amplitude[i] * df / halving_speed[i];
  }
  return mu;
}

double slip_velocity_law::greatest() const {
  return kinetic + std::max(amplitude[0], 0.0) + std::max(amplitude[1], 0.0);
}

bool slip_velocity_law::rises(double carried) const {
  return amplitude[0] < 0 || amplitude[1] < 0 ||
         (memory_distance > 0 && carried < greatest() - standing());
}

double slip_velocity_law::steepest_fall(double rate) const {
  double at_rest;
  shape_at(shape, 0.0, at_rest);
  double at_once = 0, height = 0, rise = 0;
  for (int i = 0; i < 2; ++i) {
    at_once += -at_rest * std::max(amplitude[i], 0.0) / halving_speed[i] * rate;
    height += std::max(amplitude[i], 0.0);
    rise += std::max(-amplitude[i], 0.0);
  }
  if (!(memory_distance > 0)) return at_once;
  // with D the way: d (mu_before - mu)/(d + D)^2 + D/(d + D) |dmu/dD|, mu_before not above the
  // law's greatest, and D |dmu/dD| not above the height for any of the laws; mu_before may be as
  // much above mu as the law rises
  const double moving =
      std::min(1.25 * at_once, 2.0 * height / memory_distance) + rise / memory_distance;
  // slower than s_0 the way is its least, however little is slipped, and the second term alone
  const double least = rate > 0 ? memory_speed / rate : 0.0;
  return std::max(moving, least / (memory_distance + least) * at_once);
}

// --- yield stress --------------------------------------------------------------------------------

hardening_curve hardening_curve::straight(double yield_stress, double hardening) {
  hardening_curve c;
  c.points = 1;
  c.stress[0] = yield_stress;
  c.last_slope = hardening;
  if (!(hardening < 0)) return c;
  c.points = 2;
  c.displacement[1] = 0.9 * yield_stress / -hardening;
  c.stress[1] = 0.1 * yield_stress;
  c.last_slope = 0;
  return c;
}

double hardening_curve::at(double u, double &slope) const {
  int i = 1;
  while (i < points && u >= displacement[i]) ++i;
  if (i == points) {
    slope = last_slope;
  } else {
    slope = (stress[i] - stress[i - 1]) / (displacement[i] - displacement[i - 1]);
  }
  return stress[i - 1] + slope * (u - displacement[i - 1]);
}

double hardening_curve::next_above(double from, double level) const {
  for (int i = 1; i <= points; ++i) {
    const double end = i < points ? displacement[i] : HUGE_VAL;
    if (end <= from) continue;
    double slope;
    const double begin = std::max(from, displacement[i - 1]), now = at(begin, slope);
    if (now == level && begin > from) return begin;
    const double there = begin + (level - now) / slope;
    if (slope != 0 && there > begin && there <= end) return there;
  }
  return HUGE_VAL;
}

double hardening_curve::next_below(double from, double level) const {
  for (int i = points; i >= 1; --i) {
    const double begin = displacement[i - 1];
    if (begin >= from) continue;
    double slope;
    const double first = at(begin, slope);
    const double there = begin + (level - first) / slope;
    const double end = std::min(from, i < points ? displacement[i] : HUGE_VAL);
    if (slope != 0 && there >= begin && there < end) return there;
  }
  return -1;
}

double hardening_curve::greatest() const {
  if (last_slope > 0) return HUGE_VAL;
  return *std::max_element(stress, stress + points);
}

double hardening_curve::steepest() const {
  double steepest = std::abs(last_slope);
  for (int i = 1; i < points; ++i)
    steepest = std::max(
        steepest, std::abs(stress[i] - stress[i - 1]) / (displacement[i] - displacement[i - 1]));
  return steepest;
}

// --- both together -------------------------------------------------------------------------------

struct bound_law::slipping {
  double bound, by_slip, by_before;         // Pa
  double coefficient, c_by_slip, c_before;  // with memory: mu after the step
};

bound_law::slipping bound_law::friction_at(double normal, double carried,
                                           double slip_length) const {
  if (!by_velocity) return {normal, 0, 0, 0, 0, 1};
  const double rest = slip.standing(), rate = speed / step;
  // without speed no way is slipped over which friction could follow
  if (!(rate > 0) && remembers()) return {normal * (rest + carried), 0, normal, carried, 0, 1};
  double slope;
  const double mu = slip.coefficient(slip_length * rate, slope) - rest;
  slope *= rate;
  if (!remembers()) return {normal * (rest + mu), normal * slope, 0, mu, slope, 0};
  const double least = slip.memory_speed / rate, d = slip.memory_distance;
  const double way = std::max(slip_length, least), sum = d + way;
  const double now = (d * carried + way * mu) / sum;
  const double grows = slip_length >= least ? 1.0 : 0.0;
  const double by_slip = (grows * (mu - now) + way * slope) / sum;
  return {normal * (rest + now), normal * by_slip, normal * d / sum, now, by_slip, d / sum};
}

struct bound_law::yielding {
  double stress, by_slip, by_angle, by_state[2];
  double slip;  // m, and its derivatives where it ends at a given stress
  double slip_by_angle, slip_by_state[2], slip_by_level;
};

// tau after plastic displacement m along e
bound_law::yielding bound_law::yield_at(const carried_state &before, const double e[2],
                                        double m) const {
  yielding y{};
  y.slip = m;
  double slope;
  if (!by_magnitude) {
    y.stress = yield.at(before.v[1] + m, slope);
    y.by_slip = y.by_state[0] = slope;
    return y;
  }
  const double w[2] = {before.v[1] + m * e[0], before.v[2] + m * e[1]};
  const double across[2] = {-e[1], e[0]}, size = hypot(w[0], w[1]);
  y.stress = yield.at(size, slope);
  const double n[2] = {size > 0 ? w[0] / size : e[0], size > 0 ? w[1] / size : e[1]};
  y.by_slip = slope * dot(n, e);
  y.by_angle = slope * m * dot(n, across);
  for (int c = 0; c < 2; ++c) y.by_state[c] = slope * n[c];
  return y;
}

// Plastic displacement that lifts tau to the level; slip infinite: none does.
bound_law::yielding bound_law::until(const carried_state &before, const double e[2],
                                     double level) const {
  yielding y{};
  if (!by_magnitude) {
    const double u = yield.next_above(before.v[1], level);
    y = yield_at(before, e, u - before.v[1]);
    if (!std::isfinite(u)) {
      y.slip = HUGE_VAL;
      return y;
    }
    y.slip_by_state[0] = -1;
    y.slip_by_level = y.by_slip != 0 ? 1.0 / y.by_slip : 0.0;
    return y;
  }
  const double *u = before.v + 1, size = hypot(u[0], u[1]), along = dot(u, e);
  const double inside = along < 0 ? yield.next_below(size, level) : -1;
  const double least = size * size - along * along;  // square of the least magnitude on the way
  double m = HUGE_VAL;
  if (inside >= 0 && inside * inside >= least) {
    m = -along - std::sqrt(inside * inside - least);
  } else {
    const double outside = yield.next_above(size, level);
    if (std::isfinite(outside)) m = -along + std::sqrt(outside * outside - least);
  }
  if (!std::isfinite(m)) {
    y.slip = HUGE_VAL;
    return y;
  }
  y = yield_at(before, e, m);
  if (y.by_slip != 0) {
    y.slip_by_level = 1.0 / y.by_slip;
    y.slip_by_angle = -y.by_angle / y.by_slip;
    for (int c = 0; c < 2; ++c) y.slip_by_state[c] = -y.by_state[c] / y.by_slip;
  }
  return y;
}

double bound_law::at_rest(double friction, const carried_state &before) const {
  const double g = friction_at(friction, before.v[0], 0).bound;
  if (!plastic()) return g;
  const double e[2] = {1, 0};
  return std::min(g, yield_at(before, e, 0).stress);
}

double bound_law::greatest(double friction) const {
  const double g = by_velocity ? friction * slip.greatest() : friction;
  return plastic() ? std::min(g, yield.greatest()) : g;
}

// Of layer and friction that move together tau = g, so b' = tau' g'/(tau' + g'): where the two have
// other signs it is steeper than either, and b jumps where both cancel.
bool bound_law::falls_in_series(double friction, double carried) const {
  return plastic() && by_velocity && slip.rises(carried) && fall_of_each(friction) > 0;
}

double bound_law::steepest_fall(double friction) const {
  return falls_in_series(friction, -HUGE_VAL) ? HUGE_VAL : fall_of_each(friction);
}

double bound_law::fall_of_each(double friction) const {
  const double ahead = fall_ahead(friction);
  // only where plastic displacement is undone does a hardening layer soften
  return plastic() && by_magnitude ? std::max(ahead, yield.steepest()) : ahead;
}

double bound_law::fall_ahead(double friction) const {
  double fall = by_velocity ? friction * slip.steepest_fall(speed / step) : 0.0;
  if (!plastic()) return fall;
  fall = std::max(fall, -yield.last_slope);
  for (int i = 1; i < yield.points; ++i)
    fall = std::max(fall, (yield.stress[i - 1] - yield.stress[i]) /
                              (yield.displacement[i] - yield.displacement[i - 1]));
  return fall;
}

// Plastic part of m >= limit, where the surfaces slip; limit: plastic part at which g(0) is
// reached. Friction that rises with slip takes the layer on: the first split with tau = g.
double bound_law::split(double friction, const carried_state &before, const double e[2],
                        double limit, double m) const {
  if (!plastic() || !by_velocity) return limit;
  const auto excess = [&](double part, double &slope) {
    const yielding y = yield_at(before, e, part);
    const slipping s = friction_at(friction, before.v[0], m - part);
    slope = y.by_slip + s.by_slip;
    return y.stress - s.bound;
  };
  double slope, low = limit, high = m, part = limit, last = excess(limit, slope);
  // up to rounding both are equal at the limit itself
  if (!(last < -4e-16 * friction)) return limit;
  // a table may rise and fall again before m
  double share = excess(m, slope) > 0 ? 1.0 : 0x1p-20;
  while (share < 1.0 && excess(limit + share * (m - limit), slope) <= 0) share *= 2.0;
  high = limit + share * (m - limit);
  if (excess(high, slope) <= 0) return m;
  for (int i = 0; i < 100; ++i) {
    last = excess(part, slope);
    (last < 0 ? low : high) = part;
    if (std::abs(last) <= 4e-16 * friction) break;
    const double next = part - last / slope;
    const double to = slope > 0 && next > low && next < high ? next : 0.5 * (low + high);
    if (to == part) break;
    part = to;
  }
  return part;
}

// b at m
double bound_law::value(double friction, const carried_state &before, const double e[2],
                        double limit, double m, double &slope) const {
  const double part = m < limit ? m : split(friction, before, e, limit, m);
  if (m < limit || (part == m && m > limit)) {
    const yielding y = yield_at(before, e, m);
    slope = y.by_slip;
    return y.stress;
  }
  const slipping s = friction_at(friction, before.v[0], m - part);
  slope = s.by_slip;
  if (part == limit) return s.bound;
  const double layer = yield_at(before, e, part).by_slip, sum = layer + slope;
  slope = sum > 0 ? layer * slope / sum : layer;
  return s.bound;
}

double bound_law::resolve(double friction, const carried_state &before, const double e[2],
                          double size, double stiffness, double low) const {
  const double g = friction_at(friction, before.v[0], 0).bound;
  double limit = 0;
  if (plastic() && yield_at(before, e, 0).stress < g) limit = until(before, e, g).slip;
  if (!by_velocity && limit == 0) return (size - g) / stiffness;
  // size - stiffness m - b(m) falls from above to below 0
  double high = size / stiffness, m = low;
  for (int i = 0; i < 100; ++i) {
    double slope;
    const double gap = size - stiffness * m - value(friction, before, e, limit, m, slope);
    (gap > 0 ? low : high) = m;
    if (std::abs(gap) <= 4e-16 * size || !(high > low)) break;
    const double next = m + gap / (stiffness + slope);
    const bool inside = stiffness + slope > 0 && next > low && next < high;
    const double to = inside ? next : 0.5 * (low + high);
    if (to == m) break;
    m = to;
  }
  return m;
}

bound_point bound_law::evaluate(double friction, const carried_state &before, const double e[2],
                                double m) const {
  bound_point b{};
  b.yield_stress = HUGE_VAL;
  const slipping rest = friction_at(friction, before.v[0], 0);
  double limit = 0;
  bool yields = false, met = false;  // below g; both bounds met
  yielding y{};
  if (plastic()) {
    y = yield_at(before, e, 0);
    if (y.stress < rest.bound) {
      const yielding end = until(before, e, rest.bound);
      limit = end.slip;
      yields = m < limit;
      met = !yields;
      y = yields ? yield_at(before, e, m) : end;
    }
  }
  b.plastic = yields ? m : split(friction, before, e, limit, m);
  // friction rose with slip: until the layer yields again, or as much as it hardens
  const bool rises = !yields && b.plastic > limit;
  if (rises) y = yield_at(before, e, b.plastic);
  if (plastic()) b.yield_stress = y.stress;
  yields = yields || (rises && b.plastic == m);
  const slipping s = friction_at(friction, before.v[0], m - b.plastic);
  b.friction = s.bound;
  plastic_part part{};
  if (yields) {
    part.by_slip = 1.0;
  } else if (rises) {
    part = shared(y, s);
  } else if (met) {
    part = ended(y, rest);
  }
  if (yields) {
    b.bound = y.stress;
    b.by_slip = y.by_slip;
    b.by_angle = y.by_angle;
    for (int c = 0; c < 2; ++c) b.by_state[1 + c] = y.by_state[c];
  } else {
    b.bound = s.bound;
    b.by_slip = s.by_slip * (1.0 - part.by_slip);
    b.by_angle = -s.by_slip * part.by_angle;
    for (int i = 0; i < 3; ++i) b.by_state[i] = -s.by_slip * part.by_state[i];
    b.by_state[0] += s.by_before;
  }
  carry_on(b, before, e, part, s);
  return b;
}

// The split where tau = g with both beyond their values at rest.
bound_law::plastic_part bound_law::shared(const yielding &y, const slipping &s) {
  const double sum = y.by_slip + s.by_slip;
  plastic_part part{};
  part.by_slip = 1.0;
  if (!(sum > 0)) return part;
  part.by_slip = s.by_slip / sum;
  part.by_angle = -y.by_angle / sum;
  part.by_state[0] = s.by_before / sum;
  for (int c = 0; c < 2; ++c) part.by_state[1 + c] = -y.by_state[c] / sum;
  return part;
}

// The plastic part that ends at g(0).
bound_law::plastic_part bound_law::ended(const yielding &y, const slipping &rest) {
  plastic_part part{};
  part.by_angle = y.slip_by_angle;
  part.by_state[0] = y.slip_by_level * rest.by_before;
  for (int c = 0; c < 2; ++c) part.by_state[1 + c] = y.slip_by_state[c];
  return part;
}

// State after, with its derivatives.
void bound_law::carry_on(bound_point &b, const carried_state &before, const double e[2],
                         const plastic_part &part, const slipping &s) const {
  b.state = before;
  if (by_velocity) {
    b.state.v[0] = s.coefficient;
    b.state_by_slip[0] = s.c_by_slip * (1.0 - part.by_slip);
    b.state_by_angle[0] = -s.c_by_slip * part.by_angle;
    for (int i = 0; i < 3; ++i) b.state_by_state[0][i] = -s.c_by_slip * part.by_state[i];
    b.state_by_state[0][0] += s.c_before;
  }
  const double across[2] = {-e[1], e[0]};
  const int parts = by_magnitude ? 2 : 1;
  for (int c = 0; c < parts; ++c) {
    const double way = by_magnitude ? e[c] : 1.0, turn = by_magnitude ? across[c] : 0.0;
    double *by_state = b.state_by_state[1 + c];
    b.state.v[1 + c] += b.plastic * way;
    b.state_by_slip[1 + c] = way * part.by_slip;
    b.state_by_angle[1 + c] = b.plastic * turn + way * part.by_angle;
    for (int i = 0; i < 3; ++i) by_state[i] = way * part.by_state[i];
    by_state[1 + c] += 1.0;
  }
}

bool bound_law::ambiguous(double friction, const carried_state &before, const double e[2],
                          double size, double stiffness) const {
  if (stiffness >= fall_of_each(friction) && !falls_in_series(friction, before.v[0])) return false;
  const double g = friction_at(friction, before.v[0], 0).bound;
  double limit = 0;
  if (plastic() && yield_at(before, e, 0).stress < g) limit = until(before, e, g).slip;
  // changes of sign of size - stiffness m - b(m), finely sampled from m = 0 to where b = 0
  constexpr int samples = 256;
  const double most = size / stiffness;
  double slope;
  bool above = size > value(friction, before, e, limit, 0, slope);
  int solutions = above ? 0 : 1;
  for (int i = 1; i <= samples; ++i) {
    const double u = static_cast<double>(i) / samples, at = most * u * u * u;
    const bool now = size - stiffness * at > value(friction, before, e, limit, at, slope);
    solutions += now != above;
    above = now;
  }
  return solutions > 1;
}

}  // namespace railpatch
