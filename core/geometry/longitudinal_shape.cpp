#include "geometry/longitudinal_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

// of a spline's slopes a value has a part that falls by this factor with each node
const double decay = std::sqrt(3.0) - 2.0;
constexpr int far_nodes = 32;  // beyond which nothing of it is left in double precision
constexpr double fine = 1e-3;  // m, between trial places of the least gap
constexpr int most_places = 100;

}  // namespace

// Slopes m of a C2 spline fulfil m[i-1] + 4 m[i] + m[i+1] = 3 (y[i+1] - y[i-1])/h. On an endless
// row, and a periodic one is such, the inverse of (1 4 1) is decay^|k|/(2 sqrt 3).
even_spline::even_spline(const double *values, int count, double start, double spacing,
                         bool periodic)
    : start_(start), spacing_(spacing), periodic_(periodic) {
  // constant data beyond the ends let the spline's slope run out
  const int pad = periodic ? 0 : far_nodes;
  start_ -= pad * spacing;
  const auto value = [&](int i) {
    if (periodic) return values[((i % count) + count) % count];
    return values[std::clamp(i, 0, count - 1)];
  };
  nodes_.resize(static_cast<size_t>(count + 2 * pad));
  for (int i = 0; i < count + 2 * pad; ++i) {
    double slope = 0, weight = 3.0 / (2.0 * std::sqrt(3.0) * spacing);
    const auto rise = [&](int k) { return value(k + 1) - value(k - 1); };
    slope = weight * rise(i - pad);
    for (int k = 1; k <= far_nodes; ++k) {
      weight *= decay;
      slope += weight * (rise(i - pad - k) + rise(i - pad + k));
    }
    nodes_[static_cast<size_t>(i)] = {value(i - pad), slope};
  }
  if (!periodic) nodes_.front().slope = nodes_.back().slope = 0;
}

// The interval that holds x, and where in it; -1 where the spline has ended.
int even_spline::cell(double x, double &share) const {
  const int last = static_cast<int>(nodes_.size()) - 1;
  double u = (x - start_) / spacing_;
  if (periodic_) {
    u -= (last + 1) * std::floor(u / (last + 1));
    const int i = std::clamp(static_cast<int>(u), 0, last);
    share = u - i;
    return i;
  }
  if (!(u > 0) || !(u < last)) {
    share = u > 0 ? 1 : 0;
    return -1;
  }
  const int i = static_cast<int>(u);
  share = u - i;
  return i;
}

double even_spline::at(double x, double &slope) const {
  double t;
  const int i = cell(x, t);
  if (i < 0) {
    slope = 0;
    return t > 0 ? nodes_.back().value : nodes_.front().value;
  }
  const node &a = nodes_[static_cast<size_t>(i)];
  const node &b = nodes_[i + 1 < static_cast<int>(nodes_.size()) ? static_cast<size_t>(i) + 1 : 0];
  const double rise = b.value - a.value, h = spacing_;
  const double c2 = 3 * rise - h * (2 * a.slope + b.slope),
               c3 = -2 * rise + h * (a.slope + b.slope);
  slope = (h * a.slope + t * (2 * c2 + 3 * t * c3)) / h;
  return a.value + t * (h * a.slope + t * (c2 + t * c3));
}

double even_spline::greatest(double a, double b) const {
  // a cubic stays below the greatest of its four Bernstein coefficients
  const int count = static_cast<int>(nodes_.size());
  const auto first = static_cast<long>(std::floor((a - start_) / spacing_)) - 1;
  const long last = first + std::min<long>(static_cast<long>((b - a) / spacing_) + 4, count);
  double most = std::max(at(a), at(b));
  for (long k = first; k <= last; ++k) {
    const long at = periodic_ ? ((k % count) + count) % count : std::clamp<long>(k, 0, count - 1);
    const node &n = nodes_[static_cast<size_t>(at)];
    most = std::max(most, n.value + std::fabs(n.slope) * spacing_ / 3);
  }
  return most;
}

longitudinal_shape::longitudinal_shape(const longitudinal_values &v) {
  if (const int n = v.runout_count; n > 0)
    runout_ = even_spline(v.runout, n, 0, 2 * std::numbers::pi / n, true);
  if (const int n = v.height_count; n > 0)
    height_ = even_spline(v.height, n, v.height_start, v.height_spacing, false);
}

void longitudinal_shape::place(double pitch, double x, double radius) {
  pitch_ = pitch;
  x_ = x;
  // the closest point of a yawed round wheel lies ahead, too
  const double reach = 2 * widest;
  greatest_ = 0;
  if (has_runout()) {
    const double runout = runout_.greatest(pitch - reach, pitch + reach);
    greatest_ += runout > 0 ? runout : runout * cos(reach);
  }
  if (has_height()) greatest_ += height_.greatest(x - reach * radius, x + reach * radius);
}

double longitudinal_shape::runout(double angle, double &slope) const {
  const double value = runout_.at(pitch_ - angle, slope);
  slope = -slope;
  return value;
}

double longitudinal_row::x(double a) const { return x0 + advance * (sin(a) - sin(angle)); }

double longitudinal_row::at(double a) const {
  const double half = sin(0.5 * (a - angle)), place = x(a), apart = place - x0;
  return gap + 2 * radius * half * half + bend * apart * apart - shape->runout(a) * cos(a) -
         shape->height(place);
}

// Beyond this angle from the round wheel's closest point the gap is greater than level.
double longitudinal_row::half_width(double level) const {
  const double rise = std::max(level - gap + shape->greatest(), 0.0);
  return std::min(2 * asin(std::min(std::sqrt(0.5 * rise / radius), 0.1)),
                  longitudinal_shape::widest);
}

// The least gap within step of middle, where it is lower than there: by the parabola through all
// three where that is true of the gap, by golden section where not.
double longitudinal_row::dip(double middle, double step, const double gaps[3], double &best) const {
  constexpr double ratio = 0.6180339887498949, smooth = 1e-8;  // -, m
  const double bend = gaps[0] - 2 * gaps[1] + gaps[2], rise = 0.5 * (gaps[0] - gaps[2]);
  best = middle + (bend > 0 ? rise / bend * step : 0.0);
  double least = at(best);
  if (bend > 0 && std::fabs(gaps[1] - 0.5 * rise * rise / bend - least) < smooth) return least;
  double a = middle - step, c = middle + step;
  double p = c - ratio * (c - a), q = a + ratio * (c - a), fp = at(p), fq = at(q);
  for (int i = 0; i < 16; ++i) {
    if (fp < fq) {
      c = q, q = p, fq = fp;
      p = c - ratio * (c - a), fp = at(p);
    } else {
      a = p, p = q, fp = fq;
      q = a + ratio * (c - a), fq = at(q);
    }
  }
  best = fp < fq ? p : q;
  return std::min(fp, fq);
}

double longitudinal_row::least(double &best) const {
  best = angle;
  const double level = at(angle), width = half_width(level);
  const int n = std::clamp(static_cast<int>(std::ceil(width * radius / fine)), 4, most_places);
  const double step = width / n;
  if (!(step > 0)) return level;
  double gaps[2 * most_places + 3];
  double coarse = level;
  for (int i = 0; i < 2 * n + 3; ++i) {
    gaps[i] = i == n + 1 ? level : at(angle + (i - n - 1) * step);
    coarse = std::min(coarse, gaps[i]);
  }
  // between two places the gap falls by less than a wheel's slope there
  const double reach = coarse + 2 * (width + step) * step * radius;
  double least = level;
  for (int i = 1; i < 2 * n + 2; ++i) {
    if (gaps[i] > reach || gaps[i] > gaps[i - 1] || gaps[i] > gaps[i + 1]) continue;
    double a;
    const double g = dip(angle + (i - n - 1) * step, step, gaps + i - 1, a);
    if (g < least) least = g, best = a;
  }
  return least;
}

// Where the gap changes sign: halving, sped up by the Illinois rule.
double longitudinal_row::edge(double outside, double inside) const {
  double a = outside, b = inside, fa = at(a), fb = at(b);
  for (int i = 0; i < 60 && std::fabs(b - a) > 1e-9; ++i) {
    const double m = b - fb * (b - a) / (fb - fa), fm = at(m);
    if (fm == 0 || std::fabs(m - b) < 1e-10) return m;
    if ((fm < 0) != (fb < 0)) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = m;
    fb = fm;
  }
  return b;
}

// One stretch of overlap, by Gauss's rule of eight points.
void longitudinal_row::add(double from, double to, row_overlap &sum) const {
  constexpr double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                              0.9602898564975363};
  constexpr double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                0.1012285362903763};
  const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
  for (int k = 0; k < 8; ++k) {
    const double a = middle + (k & 1 ? half : -half) * node[k / 2];
    const double depth = std::min(at(a), 0.0);
    const double share = 15.0 / 16.0 * half * radius * weight[k / 2] * depth * depth;
    sum.weight += share;
    sum.x += share * x(a);
  }
  // the gap of a row across the rail is known only nearly away from the round wheel's point
  const double margin = 0.03 * radius;
  sum.x_min = std::min(sum.x_min, x(from) - margin * std::fabs(from - angle));
  sum.x_max = std::max(sum.x_max, x(to) + margin * std::fabs(to - angle));
}

row_overlap longitudinal_row::overlap() const {
  constexpr int n = 64;
  row_overlap sum;
  sum.x_min = HUGE_VAL;
  sum.x_max = -HUGE_VAL;
  const double step = half_width(0) / n;
  double begin = angle - n * step, before = HUGE_VAL, last = HUGE_VAL;
  bool open = false;
  for (int i = -n; i <= n; ++i) {
    const double a = angle + i * step, g = at(a);
    if (g < 0 && !open) {
      begin = last < HUGE_VAL ? edge(a - step, a) : a;
      open = true;
    } else if (g >= 0 && open) {
      add(begin, edge(a, a - step), sum);
      open = false;
    } else if (g >= 0 && last <= before && last <= g && before < HUGE_VAL) {
      // a dip between the places looked at
      const double gaps[3] = {before, last, g};
      double m;
      if (last < 0.1 * radius * step && dip(a - step, step, gaps, m) < 0)
        add(edge(a - 2 * step, m), edge(a, m), sum);
    }
    before = last;
    last = g;
  }
  if (open) add(begin, angle + n * step, sum);
  if (sum.weight > 0) sum.x /= sum.weight;
  return sum;
}

}  // namespace railpatch
