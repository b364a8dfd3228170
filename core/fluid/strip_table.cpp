#include "fluid/strip_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

constexpr double least_s = 1e-6, most_s = 1e5, least_r = 0.01, most_r = 0.55;

// [row][column]: theta of X_c, share, P from the leading edge to X_c
constexpr double solved[] = {
#include "fluid/strip_table.inc"
};
static_assert(sizeof solved / sizeof solved[0] ==
              strip_table::rows * strip_table::columns * strip_table::numbers);

struct four_weights {
  double w[4];
};

// Of four nodes 0, 1, 2, 3 at x (Lagrange).
RAILPATCH_INLINE four_weights weigh(double x) {
  const double a = x, b = x - 1, c = x - 2, d = x - 3;
  return {{b * c * d * (-1.0 / 6.0), a * c * d * 0.5, a * b * d * -0.5, a * b * c * (1.0 / 6.0)}};
}

// The first of the four nodes about a place, 0 ... count - 1.
int first_of(double at, int count) {
  return std::clamp(static_cast<int>(std::floor(at)) - 1, 0, count - 4);
}

}  // namespace

strip_table::place strip_table::place_of_s(double s) {
  const double at = (log(std::clamp(s, least_s, most_s)) - low_s) / across_s * (rows - 1);
  place p;
  p.first = first_of(at, rows);
  std::copy_n(weigh(at - p.first).w, 4, p.weight);
  return p;
}

strip_table::place strip_table::place_of_r(double r) {
  const double at = (std::sqrt(std::clamp(r, least_r, most_r)) - low_r) / across_r * (columns - 1);
  place p;
  p.first = first_of(at, columns);
  std::copy_n(weigh(at - p.first).w, 4, p.weight);
  return p;
}

const double *strip_table::node(int s, int r) { return solved + (s * columns + r) * numbers; }

strip_table::rows_of::rows_of(double s) {
  const place p = place_of_s(s);
  const double *v[4];
  for (int i = 0; i < 4; ++i) v[i] = node(p.first + i, 0);
  const double *w = p.weight;
  for (size_t k = 0; k < of_r_.size(); ++k)
    of_r_[k] = w[0] * v[0][k] + w[1] * v[1][k] + w[2] * v[2][k] + w[3] * v[3][k];
}

strip_table::strip strip_table::rows_of::at(double r) const {
  const place p = place_of_r(r);
  const double *v[4], *w = p.weight;
  for (int j = 0; j < 4; ++j) v[j] = of_r_.data() + (p.first + j) * numbers;
  const auto sum = [&](int k) {
    return w[0] * v[0][k] + w[1] * v[1][k] + w[2] * v[2][k] + w[3] * v[3][k];
  };
  strip found{};
  found.end = sum(0);
  found.share = sum(1);
  for (int k = 0; k < profile_nodes; ++k) found.liquid[static_cast<size_t>(k)] = sum(2 + k);
  return found;
}

strip_table::strip strip_table::at(double s, double r) { return rows_of(s).at(r); }

double strip_table::number(double s, double r, int which) {
  const place of_s = place_of_s(s), of_r = place_of_r(r);
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      sum += of_s.weight[i] * of_r.weight[j] * node(of_s.first + i, of_r.first + j)[which];
  return sum;
}

double strip_table::share(double s, double r) { return std::clamp(number(s, r, 1), 0.0, 1.0); }

double strip_table::end(double s, double r) { return number(s, r, 0); }

// Of a row at y = b sin(v) the load is as cos^2(v), r as cos(v): sum of share cos^3(v) dv 3/4.
double strip_table::rows_of::share_of_ellipse(double r) const {
  // cosines of Gauss and Legendre's six points of 0 to pi/2
  static constexpr double cosine[6] = {0.8264705149430952,  0.56298000668735571,
                                       0.96480762309374257, 0.26295674629148197,
                                       0.99859379802231674, 0.053013456323508387};
  static constexpr double w[3] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    const double c = cosine[k];
    const place p = place_of_r(r * c);
    const double *v = of_r_.data() + p.first * numbers + 1;
    double share = 0;
    for (int j = 0; j < 4; ++j) share += p.weight[j] * v[j * numbers];
    sum += w[k / 2] * c * c * c * std::clamp(share, 0.0, 1.0);
  }
  return std::clamp(0.25 * pi * 1.5 * sum, 0.0, 1.0);
}

namespace {

constexpr int at_once = 32;  // places of a strip

// within this file: what chooses the clone would be seen from outside
RAILPATCH_DISPATCH void find_pressures(const double *x, int count, double end, const double *liquid,
                                       double *found) {
  constexpr double each = (strip_table::profile_nodes - 1) / pi;
  constexpr int last = strip_table::profile_nodes - 4;
  const double over = 2.0 / end;
  double part[at_once], at[at_once], weight[4][at_once];
  int first[at_once];
  for (int from = 0; from < count; from += at_once) {
    const int here = std::min(at_once, count - from);
    const double *place = x + from;
    double *p = found + from;
    // cosine of the nodes' angle, below -1 where the liquid has ended
    for (int i = 0; i < here; ++i) part[i] = 1.0 - over * near_acos(-place[i]);
    for (int i = 0; i < here; ++i) at[i] = near_acos(part[i]) * each;
    for (int i = 0; i < here; ++i) {
      const double within = part[i] > -1.0 ? at[i] : 0.0;
      const int below = static_cast<int>(within) - 1, least = below > 0 ? below : 0;
      first[i] = least < last ? least : last;
    }
    for (int i = 0; i < here; ++i) {
      const four_weights of = weigh(at[i] - first[i]);
      for (int k = 0; k < 4; ++k) weight[k][i] = of.w[k];
    }
    for (int i = 0; i < here; ++i) {
      const double *v = liquid + first[i];
      p[i] = weight[0][i] * v[0] + weight[1][i] * v[1] + weight[2][i] * v[2] + weight[3][i] * v[3];
    }
    for (int i = 0; i < here; ++i) p[i] = part[i] > -1.0 && p[i] > 0.0 ? p[i] : 0.0;
  }
}

}  // namespace

double strip_table::strip::pressure(double theta) const {
  if (!(theta < end) || !(theta > 0)) return 0;
  // nodes at theta = end (1 - cos(pi k/(nodes - 1)))/2
  const double at = acos(1.0 - 2.0 * theta / end) / pi * (profile_nodes - 1);
  const int first = first_of(at, profile_nodes);
  const four_weights of = weigh(at - first);
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += of.w[k] * liquid[static_cast<size_t>(first + k)];
  return std::max(sum, 0.0);
}

void strip_table::strip::pressures(const double *x, int count, double *found) const {
  find_pressures(x, count, end, liquid.data(), found);
}

}  // namespace railpatch
