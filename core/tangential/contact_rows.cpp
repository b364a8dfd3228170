#include "tangential/contact_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

// Strips with less than this part of the force are left out: rounding, not contact.
constexpr double negligible = 1e-12;
// Strips lie closer where a row carries more: density ~ (base + load over the greatest)^power.
// Measured: higher powers err more on ellipses, lower ones where a short part carries most.
constexpr double density_base = 0.1, density_power = 0.2;
// Grid rows from which on the ends of an area follow from its outermost rows.
constexpr int least_rows = 4;
// Load of an outermost row over that of the next one, below which its own place counts less.
constexpr double barely_loaded = 0.1;
// An outermost row counts less within this part of a grid row from the end (one over it, of rows
// with equal loads; of an ellipse none does), and its bend within that part.
constexpr double near_end = 3.0, bend_near_end = 8.0;

// Peak of the elliptic pressure that carries the load of a strip.
double peak_of(double load, double half_length, double height) {
  return load / (0.5 * pi * half_length * height);
}

}  // namespace

contact_rows::contact_rows(int nodes, int strips, int max_grid_rows)
    : nodes_(nodes),
      strips_(strips),
      rows_(static_cast<size_t>(strips)),
      cosine_(static_cast<size_t>(nodes)),
      sine_(static_cast<size_t>(nodes)),
      // every other grid row may be an area of its own, with two ends
      points_(2 * static_cast<size_t>(max_grid_rows) + 2),
      density_(points_.size()),
      weight_(points_.size()),
      areas_(static_cast<size_t>(strips)) {
  for (int k = 0; k < nodes; ++k) {
    const double angle = (k + 1) * pi / (nodes + 1);
    cosine_[static_cast<size_t>(k)] = cos(angle);
    sine_[static_cast<size_t>(k)] = sin(angle);
  }
}

double contact_rows::area(int row, int k) const {
  const contact_row &r = (*this)[row];
  return r.half_length * r.height * pi / (nodes_ + 1) * sine(k);
}

void contact_rows::set_ellipse(const double semi_axes[2], double normal_force) {
  count_ = strips_;
  const double height = 2.0 * semi_axes[1] / strips_;
  for (int j = 0; j < strips_; ++j) {
    // mean of 1 - (y/b)^2 over the strip: of the squared chord, and of the load per length
    const double low = -1.0 + 2.0 * j / strips_, high = -1.0 + 2.0 * (j + 1) / strips_;
    const double mean = 1.0 - (low * low + low * high + high * high) / 3.0;
    const double half_length = semi_axes[0] * std::sqrt(mean);
    const double load = 0.75 * normal_force * mean * 2.0 / strips_;
    rows_[static_cast<size_t>(j)] = {j,           0.5 * (low + high) * semi_axes[1], height, 0.0,
                                     half_length, peak_of(load, half_length, height)};
  }
}

void contact_rows::set_line(double half_length, double width, double normal_force, double x) {
  count_ = 1;
  rows_[0] = {0, 0.0, width, x, half_length, peak_of(normal_force, half_length, width)};
}

void contact_rows::set_pressure(const grid &g, const double *pressure) {
  collect(g, pressure);
  count_ = 0;
  if (area_count_ == 0) return;
  const profile_point *p = points_.data();
  if (g.ny == 1)
    return set_line(std::sqrt(p[1].half_length_squared), g.dy, p[1].load * g.dy, p[1].x);
  share_strips();
}

// Every area gets at least one strip, and the more the wider it is and the more it carries.
void contact_rows::share_strips() {
  double peak = 0, whole = 0, before = 0;
  // of points of areas only: what stands beside them is of rows that gave way, or of another step
  for (int k = 0; k < area_count_; ++k) {
    const contact_area &area = areas_[static_cast<size_t>(k)];
    for (int i = area.first; i <= area.last; ++i)
      peak = std::max(peak, points_[static_cast<size_t>(i)].load);
  }
  for (int k = 0; k < area_count_; ++k) whole += weigh(areas_[static_cast<size_t>(k)], peak);
  int strip = 0;
  for (int k = 0; k < area_count_; ++k) {
    const contact_area &area = areas_[static_cast<size_t>(k)];
    before += area.share;
    const int end = std::clamp(static_cast<int>(std::lround(strips_ * before / whole)), strip + 1,
                               strips_ - (area_count_ - 1 - k));
    cut_strips(area, strip, end - strip);
    strip = end;
  }
}

// The grid's rows in contact, with the ends of every area between rows without contact. Where there
// are more areas than strips, the last strip holds the rest.
void contact_rows::collect(const grid &g, const double *pressure) {
  int points = 0, begin = 0, last = -1;
  area_count_ = 0;
  for (int j = 0; j < g.ny; ++j) {
    double sum = 0, first = 0, second = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i);
      sum += p;
      first += p * x;
      second += p * x * x;
    }
    const bool loaded = sum > 0;
    if (loaded && last >= 0 && last < j - 1 && area_count_ + 1 < strips_) {
      close_area(g, begin, points);
      points = begin = points + 1;
    }
    if (!loaded) continue;
    if (points == begin) ++points;  // the end
    const double x = first / sum;
    // variance of the ellipse is a quarter of its squared half-length; elements have their own
    const double variance = second / sum - x * x + g.dx * g.dx / 12.0;
    points_[static_cast<size_t>(points++)] = {g.y(j), sum * g.dx, x, 4.0 * std::max(0.0, variance)};
    last = j;
  }
  if (last >= 0) close_area(g, begin, points);
}

// An area of contact from the points between its ends; nothing is transferred at those.
void contact_rows::close_area(const grid &g, int first, int last) {
  profile_point *p = points_.data();
  double sum = 0;
  for (int i = first + 1; i < last; ++i) sum += p[i].load;
  const area_ends end = ends_of(p + first + 1, p + last - 1, g.dy);
  // rows whose middle lies beyond the end give way to it
  while (first + 2 < last && !(p[first + 1].y > end.low)) ++first;
  while (first + 2 < last && !(p[last - 1].y < end.high)) --last;
  lessen(p + first + 1, 1, last - first - 1, end.low, g.dy);
  lessen(p + last - 1, -1, last - first - 1, end.high, g.dy);
  p[first] = {end.low, 0.0, p[first + 1].x, 0.0};
  p[last] = {end.high, 0.0, p[last - 1].x, 0.0};
  areas_[static_cast<size_t>(area_count_++)] = {first, last, sum * g.dy, 0.0, 0.0};
}

// An outermost row near the end loses what it has as the end passes its middle, so that nothing
// jumps when it gives way.
void contact_rows::lessen(profile_point *outermost, int step, int rows, double end, double dy) {
  if (rows < 2) return;
  const profile_point &next = outermost[step];
  const double near = near_end * std::abs(outermost->y - end) / dy;
  const double part = near * std::max(1.0, next.load / outermost->load);
  if (!(part < 1)) return;
  outermost->load *= part;
  outermost->half_length_squared *= part;
  outermost->x = part * outermost->x + (1.0 - part) * next.x;
}

// Density of strips from the load, and its integral, linear and quadratic between the points;
// returns the area's share of the strips.
double contact_rows::weigh(contact_area &p, double peak_load) {
  double sum = 0;
  for (int i = p.first; i <= p.last; ++i) {
    const auto at = static_cast<size_t>(i);
    density_[at] = pow(density_base + points_[at].load / peak_load, density_power);
    if (i > p.first)
      sum += 0.5 * (density_[at] + density_[at - 1]) * (points_[at].y - points_[at - 1].y);
    weight_[at] = sum;
  }
  p.weight = sum;
  return p.share = std::sqrt(p.weight * p.force);
}

// y up to which the integral of the density is so much.
double contact_rows::place(const contact_area &p, double weight) const {
  int i = p.first;
  while (i + 2 <= p.last && weight_[static_cast<size_t>(i + 1)] < weight) ++i;
  const auto at = static_cast<size_t>(i);
  const double length = points_[at + 1].y - points_[at].y, q = (weight - weight_[at]) / length;
  const double a = density_[at], bend = density_[at + 1] - a;
  const double t = 2.0 * q / (a + std::sqrt(std::max(0.0, a * a + 2.0 * bend * q)));
  return points_[at].y + std::clamp(t, 0.0, 1.0) * length;
}

// y where the load vanishes. As an outermost row loses its load, both ends go over to those of the
// rows without it: so they do not jump when that row is gone.
contact_rows::area_ends contact_rows::ends_of(const profile_point *first, const profile_point *last,
                                              double dy) {
  const auto counting = [](const profile_point *row, int step) {
    const double share = row->load / (barely_loaded * row[step].load);
    return share < 1 ? share * share * (3.0 - 2.0 * share) : 1.0;
  };
  // both sums end at the row with the greatest load or before
  area_ends mean{0, 0};
  double low_left = 1;
  for (const profile_point *low = first; low_left > 0; ++low) {
    const double low_part = low < last ? low_left * counting(low, 1) : low_left;
    low_left -= low_part;
    double high_left = low_part;
    for (const profile_point *high = last; high_left > 0; --high) {
      const double part = high > low ? high_left * counting(high, -1) : high_left;
      high_left -= part;
      if (!(part > 0)) continue;
      const area_ends own = high - low + 1 < least_rows
                                ? ends_by_moments(low, high, dy)
                                : area_ends{edge_beyond(low, 1, dy), edge_beyond(high, -1, dy)};
      mean.low += part * own.low;
      mean.high += part * own.high;
    }
  }
  return mean;
}

// Of too few rows for their shape: the ends of the ellipse with their moments, which may lie beyond
// the outermost elements, but not near the next ones.
contact_rows::area_ends contact_rows::ends_by_moments(const profile_point *first,
                                                      const profile_point *last, double dy) {
  double sum = 0, moment = 0, second = 0;
  for (const profile_point *row = first; row <= last; ++row) {
    const double y = row->y - first->y;
    sum += row->load;
    moment += row->load * y;
    second += row->load * y * y;
  }
  const double middle = moment / sum, variance = second / sum - middle * middle;
  const double half = std::sqrt(std::max(5.0 * variance, 0.25 * dy * dy));
  return {std::max(first->y + middle - half, first->y - 0.75 * dy),
          std::min(first->y + middle + half, last->y + 0.75 * dy)};
}

// The parabola through the three rows next to the outermost one, whose own element is only partly
// in contact; never beyond that element.
double contact_rows::edge_beyond(const profile_point *first, int step, double dy) {
  const double l1 = first[step].load, l2 = first[2 * step].load, l3 = first[3 * step].load;
  // load = l1 + t (l2 - l1) + t (t - 1)/2 bend, t in rows from the first of the three inwards
  const double bend = std::min(0.0, l3 - 2.0 * l2 + l1), slope = l2 - l1 - 0.5 * bend;
  const double rise = slope + std::sqrt(slope * slope - 2.0 * bend * l1);
  if (!(rise > 0)) return first->y - step * 0.5 * dy;
  return first->y + step * dy * std::clamp(1.0 - 2.0 * l1 / rise, -0.5, 0.5);
}

// Of load and squared half-length between the points i and i + 1 of an area: k in the parabola
// linear - k t (1 - t), from the smaller one of the second differences at both, never below zero.
contact_rows::bends contact_rows::bend(const contact_area &area, int i) const {
  const profile_point *p = points_.data();
  const auto of = [&](double profile_point::*value) {
    const auto at = [&](int j) {
      const double before = p[j].y - p[j - 1].y, after = p[j + 1].y - p[j].y;
      const double rise = (p[j].*value - p[j - 1].*value) / before;
      const double next = (p[j + 1].*value - p[j].*value) / after;
      return (next - rise) / (before + after);
    };
    const double length = p[i + 1].y - p[i].y, limit = std::max(p[i].*value, p[i + 1].*value);
    const bool inner[2] = {i > area.first, i + 1 < area.last};
    double k = inner[0] ? at(i) : inner[1] ? at(i + 1) : 0.0;
    if (inner[0] && inner[1]) {
      // beside an end that is about to pass it, a point has no bend of its own
      const double own[2] = {k, at(i + 1)};
      const double apart[2] = {i - 1 == area.first ? p[i].y - p[i - 1].y : length,
                               i + 2 == area.last ? p[i + 2].y - p[i + 1].y : length};
      double other[2];
      for (int n = 0; n < 2; ++n) {
        const double part = std::min(1.0, bend_near_end * apart[n] / length);
        other[n] = part * own[n] + (1.0 - part) * own[1 - n];
      }
      k = other[0] * other[1] > 0 ? (std::abs(other[1]) < std::abs(other[0]) ? other[1] : other[0])
                                  : 0.0;
    }
    return std::clamp(k * length * length, -limit, limit);
  };
  return {of(&profile_point::load), of(&profile_point::half_length_squared)};
}

// Strips of equal weight with the integrals of what is linear between the points.
void contact_rows::cut_strips(const contact_area &area, int first_strip, int strips) {
  const profile_point *p = points_.data();
  const int first = count_;
  int at = area.first;
  double carried = 0, end = p[area.first].y;
  for (int j = 0; j < strips; ++j) {
    const double begin = end;
    end = j + 1 < strips ? place(area, area.weight * (j + 1) / strips) : p[area.last].y;
    const double height = end - begin;
    double load = 0, squared = 0, x = 0, from = begin;
    while (from < end) {
      while (at + 1 < area.last && p[at + 1].y <= from) ++at;
      const profile_point &a = p[at], &b = p[at + 1];
      const double to = at + 1 < area.last ? std::min(end, b.y) : end;
      const double span = b.y - a.y, length = to - from, t = (0.5 * (from + to) - a.y) / span;
      // mean of t (1 - t)
      const double bow = t * (1.0 - t) - length * length / (12.0 * span * span);
      const bends k = bend(area, at);
      load += length * (a.load + t * (b.load - a.load) - bow * k.load);
      squared += length * (a.half_length_squared +
                           t * (b.half_length_squared - a.half_length_squared) - bow * k.squared);
      x += length * (a.x + t * (b.x - a.x));
      from = to;
    }
    if (!(load > negligible * area.force) || !(squared > 0)) continue;
    const double half_length = std::sqrt(squared / height);
    rows_[static_cast<size_t>(count_++)] = {first_strip + j, 0.5 * (begin + end), height,
                                            x / height,      half_length,         load};
    carried += load;
  }
  for (int j = first; j < count_; ++j) {
    contact_row &row = rows_[static_cast<size_t>(j)];
    row.peak = peak_of(row.peak * area.force / carried, row.half_length, row.height);
  }
}

size_t contact_rows::bytes() const {
  return rows_.bytes() + cosine_.bytes() + sine_.bytes() + points_.bytes() + density_.bytes() +
         weight_.bytes() + areas_.bytes();
}

}  // namespace railpatch
