#include "fast/pressed_ellipses.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/fade.hpp"

namespace railpatch {

pressed_ellipses::pressed_ellipses(int max_rows)
    : rows_(static_cast<size_t>(max_rows)),
      before_(static_cast<size_t>(max_rows)),
      beyond_(static_cast<size_t>(max_rows)) {}

// Least rows between greater ones, in order; returns how many.
int pressed_ellipses::find_falls(int ny) {
  const auto load = [&](int j) { return rows_[static_cast<size_t>(j)].load; };
  double greatest = 0;
  for (int j = 0; j < ny; ++j)
    before_[static_cast<size_t>(j)] = greatest = std::max(greatest, load(j));
  greatest = 0;
  for (int j = ny - 1; j >= 0; --j)
    beyond_[static_cast<size_t>(j)] = greatest = std::max(greatest, load(j));
  int count = 0;
  for (int j = 1; j + 1 < ny && count + 1 < most_parts; ++j) {
    // of equal ones the first
    if (!(load(j) < load(j - 1))) continue;
    int next = j + 1;
    while (next < ny && load(next) == load(j)) ++next;
    if (next == ny || load(next) < load(j)) continue;
    const double lesser =
        std::min(before_[static_cast<size_t>(j)], beyond_[static_cast<size_t>(j)]);
    const double joined = 1.0 - fade((load(j) / lesser - apart) / (one - apart));
    if (!(joined < 1)) continue;
    // parts meet where a parabola is least, so that nothing jumps as another row becomes the least
    const double rise = load(j - 1) - load(j), ahead = load(j + 1) - load(j);
    falls_[count++] = {j, joined, rise / (rise + ahead)};
  }
  return count;
}

// The ellipse of the parts from one to another.
void pressed_ellipses::add(const grid &g, int first_part, int last_part, int falls, double share) {
  const int first = first_part > 0 ? falls_[first_part - 1].row : 0;
  const int last = last_part < falls ? falls_[last_part].row : g.ny - 1;
  const double middle = g.y((first + last) / 2);
  double sum = 0, x = 0, y = 0, xx = 0, yy = 0;
  for (int j = first; j <= last; ++j) {
    const row_sums &row = rows_[static_cast<size_t>(j)];
    double part = 1.0;
    if (j == first && first_part > 0) part = 1.0 - falls_[first_part - 1].before;
    if (j == last && last_part < falls) part = falls_[last_part].before;
    const double v = g.y(j) - middle, load = part * row.load;
    sum += load;
    x += part * row.x;
    xx += part * row.xx;
    y += load * v;
    yy += load * v * v;
  }
  if (!(sum > 0)) return;
  x /= sum;
  y /= sum;
  // elements have a second moment of their own; of Hertz's pressure it is a fifth of the axis
  // squared
  const double along = std::max(0.0, xx / sum - x * x) + g.dx * g.dx / 12.0;
  const double across = std::max(0.0, yy / sum - y * y) + g.dy * g.dy / 12.0;
  ellipse_[count_++] = {{std::sqrt(5.0 * along), std::sqrt(5.0 * across)},
                        {x + middle_, y + middle},
                        sum / whole_,
                        share};
}

void pressed_ellipses::set(const grid &g, const double *pressure) {
  count_ = 0;
  whole_ = 0;
  middle_ = g.x(g.nx / 2);
  for (int j = 0; j < g.ny; ++j) {
    row_sums row{0, 0, 0};
    for (int i = 0; i < g.nx; ++i) {
      const double p = pressure[j * g.nx + i], x = g.x(i) - middle_;
      row.load += p;
      row.x += p * x;
      row.xx += p * x * x;
    }
    rows_[static_cast<size_t>(j)] = row;
    whole_ += row.load;
  }
  const int falls = find_falls(g.ny);
  for (int first = 0; first <= falls; ++first) {
    double share = first > 0 ? 1.0 - falls_[first - 1].joined : 1.0;
    for (int last = first; last <= falls && share > 0; ++last) {
      const double joined = last < falls ? falls_[last].joined : 0.0;
      if (joined < 1) add(g, first, last, falls, share * (1.0 - joined));
      share *= joined;
    }
  }
}

}  // namespace railpatch
