#include "contact_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace railpatch {

namespace {

using std::numbers::pi;

// Strips with less than this part of the force are left out: rounding, not contact.
constexpr double negligible = 1e-12;

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
      points_(static_cast<size_t>(max_grid_rows) + 2) {
  for (int k = 0; k < nodes; ++k) {
    const double angle = (k + 1) * pi / (nodes + 1);
    cosine_[static_cast<size_t>(k)] = std::cos(angle);
    sine_[static_cast<size_t>(k)] = std::sin(angle);
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
  const int points = collect(g, pressure);
  count_ = 0;
  if (points == 0) return;
  profile_point *p = points_.data();
  if (g.ny == 1)
    return set_line(std::sqrt(p[1].half_length_squared), g.dy, p[1].load * g.dy, p[1].x);
  const double low = edge(p + 1, 1, points, g.dy);
  const double high = edge(p + points, -1, points, g.dy);
  double force = 0;
  for (int j = 1; j <= points; ++j) force += p[j].load * g.dy;
  // nothing is transferred at the edges
  p[0] = {low, 0.0, p[1].x, 0.0};
  p[points + 1] = {high, 0.0, p[points].x, 0.0};
  cut_strips(points + 2, low, high, force);
}

// The grid's rows from the first to the last in contact, from points_[1] on; returns their number.
int contact_rows::collect(const grid &g, const double *pressure) {
  int points = 0, last = 0;
  for (int j = 0; j < g.ny; ++j) {
    double sum = 0, first = 0, second = 0;
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i);
      sum += p;
      first += p * x;
      second += p * x * x;
    }
    if (points == 0 && !(sum > 0)) continue;
    const double x = sum > 0 ? first / sum : points_[static_cast<size_t>(points)].x;
    // variance of the ellipse is a quarter of its squared half-length; elements have their own
    const double variance = sum > 0 ? second / sum - x * x + g.dx * g.dx / 12.0 : 0.0;
    points_[static_cast<size_t>(++points)] = {g.y(j), sum * g.dx, x, 4.0 * std::max(0.0, variance)};
    if (sum > 0) last = points;
  }
  return last;
}

// y where the load vanishes: the parabola through the three rows next to the outermost one, whose
// own element is only partly in contact; never beyond that element.
double contact_rows::edge(const profile_point *first, int step, int count, double dy) const {
  const double out = first->y - step * 0.5 * dy;
  if (count < 4) return out;
  const double l1 = first[step].load, l2 = first[2 * step].load, l3 = first[3 * step].load;
  // load = l1 + t (l2 - l1) + t (t - 1)/2 bend, t in rows from the first of the three inwards
  const double bend = std::min(0.0, l3 - 2.0 * l2 + l1), slope = l2 - l1 - 0.5 * bend;
  if (!(slope > 0)) return out;
  const double root = std::sqrt(slope * slope - 2.0 * bend * l1);
  const double t = -2.0 * l1 / (slope + root);
  return first->y + step * dy * std::clamp(1.0 + t, -0.5, 0.5);
}

// Strips of equal height with the integrals of what is linear between the points.
void contact_rows::cut_strips(int points, double low, double high, double force) {
  const double height = (high - low) / strips_;
  const profile_point *p = points_.data();
  int at = 0;
  double carried = 0;
  for (int j = 0; j < strips_; ++j) {
    const double begin = low + j * height, end = j + 1 < strips_ ? begin + height : high;
    double load = 0, squared = 0, x = 0, from = begin;
    while (from < end) {
      while (at + 2 < points && p[at + 1].y <= from) ++at;
      const profile_point &a = p[at], &b = p[at + 1];
      const double to = at + 2 < points ? std::min(end, b.y) : end;
      const double t = (0.5 * (from + to) - a.y) / (b.y - a.y), length = to - from;
      load += length * (a.load + t * (b.load - a.load));
      squared +=
          length * (a.half_length_squared + t * (b.half_length_squared - a.half_length_squared));
      x += length * (a.x + t * (b.x - a.x));
      from = to;
    }
    if (!(load > negligible * force) || !(squared > 0)) continue;
    const double half_length = std::sqrt(squared / height);
    rows_[static_cast<size_t>(count_++)] = {j,          begin + 0.5 * height, height,
                                            x / height, half_length,          load};
    carried += load;
  }
  for (int j = 0; j < count_; ++j) {
    contact_row &row = rows_[static_cast<size_t>(j)];
    row.peak = peak_of(row.peak * force / carried, row.half_length, row.height);
  }
}

size_t contact_rows::bytes() const {
  return rows_.bytes() + cosine_.bytes() + sine_.bytes() + points_.bytes();
}

}  // namespace railpatch
