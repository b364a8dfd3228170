#include "fast/pressed_ellipses.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/fade.hpp"

namespace railpatch {

using std::sqrt;

template <class T>
pressed_ellipses<T>::pressed_ellipses(int max_rows)
    : rows_(static_cast<size_t>(max_rows)),
      before_(static_cast<size_t>(max_rows)),
      beyond_(static_cast<size_t>(max_rows)) {}

// Least rows between greater ones, in order; returns how many.
template <class T>
int pressed_ellipses<T>::find_falls(int ny) {
  const auto load = [&](int j) { return rows_[static_cast<size_t>(j)].load; };
  T greatest = 0;
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
    while (next < ny && value_of(load(next)) == value_of(load(j))) ++next;
    if (next == ny || load(next) < load(j)) continue;
    const T lesser = std::min(before_[static_cast<size_t>(j)], beyond_[static_cast<size_t>(j)]);
    const T joined = 1.0 - fade((load(j) / lesser - apart) / (one - apart));
    if (!(joined < 1)) continue;
    // parts meet where a parabola is least, so that nothing jumps as another row becomes the least
    const T rise = load(j - 1) - load(j), ahead = load(j + 1) - load(j);
    falls_[count++] = {j, joined, rise / (rise + ahead)};
  }
  return count;
}

// The ellipse of the parts from one to another.
template <class T>
void pressed_ellipses<T>::add(const pressure_view<T> &g, int first_part, int last_part, int falls,
                              const T &share) {
  const int first = first_part > 0 ? falls_[first_part - 1].row : 0;
  const int last = last_part < falls ? falls_[last_part].row : g.ny - 1;
  const T middle = g.y((first + last) / 2);
  T sum = 0, x = 0, y = 0, xx = 0, yy = 0;
  for (int j = first; j <= last; ++j) {
    const row_sums &row = rows_[static_cast<size_t>(j)];
    T part = 1.0;
    if (j == first && first_part > 0) part = 1.0 - falls_[first_part - 1].before;
    if (j == last && last_part < falls) part = falls_[last_part].before;
    const T v = g.y(j) - middle, load = part * row.load;
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
  const T along = std::max(T(0.0), xx / sum - x * x) + g.dx * g.dx / 12.0;
  const T across = std::max(T(0.0), yy / sum - y * y) + g.dy * g.dy / 12.0;
  ellipse_[count_++] = {
      {sqrt(5.0 * along), sqrt(5.0 * across)}, {x + middle_, y + middle}, sum / whole_, share};
}

template <class T>
void pressed_ellipses<T>::set(const pressure_view<T> &g) {
  count_ = 0;
  whole_ = 0;
  middle_ = g.x(g.nx / 2);
  for (int j = 0; j < g.ny; ++j) {
    row_sums row{0, 0, 0};
    for (int i = 0; i < g.nx; ++i) {
      const T p = g.at(j * g.nx + i), x = g.x(i) - middle_;
      row.load += p;
      row.x += p * x;
      row.xx += p * x * x;
    }
    rows_[static_cast<size_t>(j)] = row;
    whole_ += row.load;
  }
  const int falls = find_falls(g.ny);
  for (int first = 0; first <= falls; ++first) {
    T share = first > 0 ? 1.0 - falls_[first - 1].joined : T(1.0);
    for (int last = first; last <= falls && share > 0; ++last) {
      const T joined = last < falls ? falls_[last].joined : T(0.0);
      if (joined < 1) add(g, first, last, falls, share * (1.0 - joined));
      share *= joined;
    }
  }
}

template class pressed_ellipses<double>;
template class pressed_ellipses<directed>;

}  // namespace railpatch
