#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "angles.hpp"
#include "profile.hpp"

// Equal to railpatch/profiles/smooth.py, spline.py and orientation.py, where the reasons stand.

namespace contact_addon {

namespace {

constexpr double min_distance = 1e-5;  // m, points closer than this are one
constexpr double most_turning = 0.05;  // of the points
constexpr double flange_height = 0.01, side_height = 0.002, certain = 1.5;
constexpr double narrowest = 0.01, widest = 0.5;  // m

using values = std::vector<double>;

double length(double y, double z) { return std::sqrt(y * y + z * z); }

std::string text_of(const char *format, double a, double b = 0) {
  char line[160];
  std::snprintf(line, sizeof line, format, a, b);
  return line;
}

// lower, middle, upper diagonals; without exchange of rows
values solve_tridiagonal(const values &lower, const values &middle, const values &upper,
                         const values &right) {
  const size_t n = middle.size();
  values pivot{middle[0]}, value{right[0]};
  for (size_t i = 1; i < n; ++i) {
    const double factor = lower[i - 1] / pivot.back();
    pivot.push_back(middle[i] - factor * upper[i - 1]);
    value.push_back(right[i] - factor * value.back());
  }
  values found(n);
  found[n - 1] = value[n - 1] / pivot[n - 1];
  for (size_t i = n - 1; i-- > 0;) found[i] = (value[i] - upper[i] * found[i + 1]) / pivot[i];
  return found;
}

// Of a row of a spline's equations: its ends are free, or have slopes.
struct spline_end {
  double own, other, right;
};

values slopes(const values &x, const values &y, const spline_end *given) {
  const size_t n = x.size();
  values h(n - 1), rise(n - 1);
  for (size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    rise[i] = (y[i + 1] - y[i]) / h[i];
  }
  const spline_end free[2] = {{2.0, 1.0, 3 * rise[0]}, {2.0, 1.0, 3 * rise[n - 2]}};
  const spline_end *end = given ? given : free;
  values lower(h.begin() + 1, h.end()), middle{end[0].own}, upper{end[0].other};
  values right{end[0].right};
  for (size_t i = 0; i + 2 < n; ++i) {
    middle.push_back(2 * (h[i] + h[i + 1]));
    upper.push_back(h[i]);
    right.push_back(3 * (h[i + 1] * rise[i] + h[i] * rise[i + 1]));
  }
  lower.push_back(end[1].other);
  middle.push_back(end[1].own);
  right.push_back(end[1].right);
  return solve_tridiagonal(lower, middle, upper, right);
}

// Of the natural cubic spline.
values slopes(const values &x, const values &y) { return slopes(x, y, nullptr); }

// A symmetric positive definite matrix of five diagonals.
values solve_five(const values &middle, const values &beside, const values &after, values value) {
  const size_t n = middle.size();
  values pivot(n), one(n), two(n), found(n);
  for (size_t i = 0; i < n; ++i) {
    pivot[i] = middle[i];
    if (i > 0) {
      pivot[i] -= one[i - 1] * one[i - 1] * pivot[i - 1];
      value[i] = value[i] - one[i - 1] * value[i - 1];
    }
    if (i > 1) {
      pivot[i] -= two[i - 2] * two[i - 2] * pivot[i - 2];
      value[i] = value[i] - two[i - 2] * value[i - 2];
    }
    if (i + 1 < n) {
      const double crossed = i > 0 ? one[i - 1] * two[i - 1] * pivot[i - 1] : 0.0;
      one[i] = (beside[i] - crossed) / pivot[i];
    }
    if (i + 2 < n) two[i] = after[i] / pivot[i];
  }
  for (size_t i = 0; i < n; ++i) found[i] = value[i] / pivot[i];
  for (size_t i = n - 1; i-- > 0;) {
    found[i] = found[i] - one[i] * found[i + 1];
    if (i + 2 < n) found[i] = found[i] - two[i] * found[i + 2];
  }
  return found;
}

// Reinsch 1967
values smoothed_values(const values &x, const values &y, const values &weight, double stiffness) {
  const size_t n = x.size();
  values h(n - 1), inverse(n);
  for (size_t i = 0; i + 1 < n; ++i) h[i] = x[i + 1] - x[i];
  for (size_t i = 0; i < n; ++i) inverse[i] = stiffness / weight[i];
  const size_t m = n - 2;
  values a(m), b(m), c(m), middle(m), beside(m - 1), after(m > 1 ? m - 2 : 0), right(m);
  for (size_t j = 0; j < m; ++j) {
    a[j] = 1 / h[j];
    c[j] = 1 / h[j + 1];
    b[j] = -a[j] - c[j];
    middle[j] = (h[j] + h[j + 1]) / 3 + inverse[j] * a[j] * a[j] + inverse[j + 1] * b[j] * b[j];
    middle[j] = middle[j] + inverse[j + 2] * c[j] * c[j];
    right[j] = a[j] * y[j] + b[j] * y[j + 1] + c[j] * y[j + 2];
  }
  for (size_t j = 0; j + 1 < m; ++j)
    beside[j] = h[j + 1] / 6 + inverse[j + 1] * b[j] * a[j + 1] + inverse[j + 2] * c[j] * b[j + 1];
  for (size_t j = 0; j + 2 < m; ++j) after[j] = inverse[j + 2] * c[j] * a[j + 2];
  const values g = solve_five(middle, beside, after, right);
  values bent(n), out(n);
  for (size_t j = 0; j < m; ++j) bent[j] += a[j] * g[j];
  for (size_t j = 0; j < m; ++j) bent[j + 1] += b[j] * g[j];
  for (size_t j = 0; j < m; ++j) bent[j + 2] += c[j] * g[j];
  for (size_t i = 0; i < n; ++i) out[i] = y[i] - inverse[i] * bent[i];
  return out;
}

profile_points clean(const std::string &name, const profile_points &raw) {
  const size_t count = raw.y.size();
  std::vector<size_t> kept;
  size_t turned = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!kept.empty() &&
        length(raw.y[i] - raw.y[kept.back()], raw.z[i] - raw.z[kept.back()]) < min_distance)
      continue;
    while (kept.size() > 1) {
      const size_t a = kept[kept.size() - 2], b = kept.back();
      const double forward = (raw.y[b] - raw.y[a]) * (raw.y[i] - raw.y[b]);
      if (!(forward + (raw.z[b] - raw.z[a]) * (raw.z[i] - raw.z[b]) < 0)) break;
      kept.pop_back();
      ++turned;
    }
    kept.push_back(i);
  }
  if (static_cast<double>(turned) > most_turning * static_cast<double>(count))
    throw profile_error(name + ": the points turn back at " + std::to_string(turned) + " of " +
                        std::to_string(count) + " places");
  if (kept.size() < 5)
    throw profile_error(name + ": " + std::to_string(kept.size()) +
                        " distinct points are left, needs 5 or more");
  profile_points out;
  for (const size_t i : kept) {
    out.y.push_back(raw.y[i]);
    out.z.push_back(raw.z[i]);
    out.weight.push_back(raw.weight[i]);
  }
  return out;
}

values chord_length(const values &y, const values &z) {
  values s{0.0};
  for (size_t i = 1; i < y.size(); ++i)
    s.push_back(s.back() + length(y[i] - y[i - 1], z[i] - z[i - 1]));
  return s;
}

// First derivative of a cubic Hermite piece at the share t.
double rate(double h, double v0, double v1, double m0, double m1, double t) {
  return 6 * t * (1 - t) * (v1 - v0) / h + (1 - t) * (1 - 3 * t) * m0 + t * (3 * t - 2) * m1;
}

// Over the arc length of the curve itself (Gauss's rule of five points).
profile_curve spline(const values &s, const values &y, const values &z) {
  constexpr double node[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                              0.9061798459386640};
  constexpr double weight[5] = {0.23692688505618908, 0.47862867049936647, 0.5688888888888889,
                                0.47862867049936647, 0.23692688505618908};
  const values my = slopes(s, y), mz = slopes(s, z);
  values arc{0.0};
  for (size_t i = 0; i + 1 < s.size(); ++i) {
    const double h = s[i + 1] - s[i];
    double sum = 0;
    for (int k = 0; k < 5; ++k) {
      const double t = 0.5 * (1 + node[k]);
      sum += weight[k] * length(rate(h, y[i], y[i + 1], my[i], my[i + 1], t),
                                rate(h, z[i], z[i + 1], mz[i], mz[i + 1], t));
    }
    arc.push_back(arc.back() + 0.5 * h * sum);
  }
  return {arc, y, z, slopes(arc, y), slopes(arc, z)};
}

double median(values v) {
  std::sort(v.begin(), v.end());
  const size_t n = v.size();
  return n % 2 ? v[n / 2] : 0.5 * (v[n / 2 - 1] + v[n / 2]);
}

// Whether z points up, by the flange or the sides of the head.
bool points_up(const std::string &name, profile_role role, const profile_points &p) {
  const double middle = median(p.z);
  const double down = *std::max_element(p.z.begin(), p.z.end()) - middle;
  const double up = middle - *std::min_element(p.z.begin(), p.z.end());
  const double depth = role == profile_role::wheel ? flange_height : side_height;
  if (std::max(down, up) < depth || std::max(down, up) < certain * std::min(down, up))
    throw profile_error(name + ": shows no " +
                        (role == profile_role::wheel ? "flange" : "side of a rail's head") +
                        " by which up is told from down: say MIRRORZ = -1 or 1");
  return up > down;
}

void reverse(profile_points &p) {
  for (values *v : {&p.y, &p.z, &p.weight}) std::reverse(v->begin(), v->end());
}

}  // namespace

values slopes(const values &x, const values &y, double first, double last) {
  const spline_end given[2] = {{1.0, 0.0, first}, {1.0, 0.0, last}};
  return slopes(x, y, given);
}

void orient(const std::string &name, const profile_options &options, profile_points &p) {
  if (p.y.size() < 5)
    throw profile_error(name + ": holds " + std::to_string(p.y.size()) +
                        " points, needs 5 or more");
  for (size_t i = 0; i < p.y.size(); ++i)
    if (!std::isfinite(p.y[i]) || !std::isfinite(p.z[i]))
      throw profile_error(name + ": point " + std::to_string(i + 1) + " is not finite");
  const auto [low, high] = std::minmax_element(p.y.begin(), p.y.end());
  if (!(*high - *low >= narrowest && *high - *low <= widest))
    throw profile_error(name + text_of(": is %.6g mm wide, allowed 10 ... 500 mm: wrong SCALE?",
                                       1e3 * (*high - *low)));
  if (options.mirror_y)
    for (double &y : p.y) y = -y;
  const bool up = options.mirror_z == 0 ? points_up(name, options.role, p) : options.mirror_z > 0;
  if (up)
    for (double &z : p.z) z = -z;
  if (p.y.front() > p.y.back()) reverse(p);
  if (options.role != profile_role::wheel) return;
  // a flange on the field side is a mirrored profile
  const auto tip = std::max_element(p.z.begin(), p.z.end()) - p.z.begin();
  const auto ends = std::minmax_element(p.y.begin(), p.y.end());
  const double share = (p.y[static_cast<size_t>(tip)] - *ends.first) / (*ends.second - *ends.first);
  if (share > 0.5 && p.z[static_cast<size_t>(tip)] - median(p.z) > flange_height)
    throw profile_error(name + ": the flange lies at +y: say MIRRORY = 1");
}

profile_curve fit(const std::string &name, const profile_points &points, double smoothing) {
  if (!(smoothing >= 0 && smoothing <= 0.1))
    throw profile_error(name +
                        text_of(": smoothing is %g mm, allowed 0 ... 100 mm", 1e3 * smoothing));
  profile_points p = clean(name, points);
  const values s = chord_length(p.y, p.z);
  if (smoothing > 0) {
    const double square =
        (smoothing / (2 * std::numbers::pi)) * (smoothing / (2 * std::numbers::pi));
    const double stiffness = square * square;
    values share(s.size());
    for (size_t i = 0; i < s.size(); ++i) {
      const double after = i + 1 < s.size() ? s[i + 1] - s[i] : 0.0;
      const double before = i > 0 ? s[i] - s[i - 1] : 0.0;
      share[i] = 0.5 * (after + before) * p.weight[i];
    }
    p.y = smoothed_values(s, p.y, share, stiffness);
    p.z = smoothed_values(s, p.z, share, stiffness);
  }
  return spline(s, p.y, p.z);
}

void profile_curve::at(double s, double &y_at, double &z_at, double &slope) const {
  const double inside = std::clamp(s, arc_length.front(), arc_length.back());
  const auto after = std::upper_bound(arc_length.begin() + 1, arc_length.end() - 1, inside);
  const auto k = static_cast<size_t>(after - arc_length.begin()) - 1;
  const double h = arc_length[k + 1] - arc_length[k], t = (inside - arc_length[k]) / h;
  const auto cubic = [&](const values &v, const values &m) {
    return (1 + 2 * t) * (1 - t) * (1 - t) * v[k] + t * t * (3 - 2 * t) * v[k + 1] +
           h * (t * (1 - t) * (1 - t) * m[k] + t * t * (t - 1) * m[k + 1]);
  };
  y_at = cubic(y, dy);
  z_at = cubic(z, dz);
  slope = contact_addon::atan2(rate(h, z[k], z[k + 1], dz[k], dz[k + 1], t),
                               rate(h, y[k], y[k + 1], dy[k], dy[k + 1], t));
}

double profile_curve::nearest(double y_at, double z_at) const {
  const auto square = [&](double s) {
    double py, pz, slope;
    at(s, py, pz, slope);
    return (py - y_at) * (py - y_at) + (pz - z_at) * (pz - z_at);
  };
  size_t best = 0;
  double least = HUGE_VAL;
  for (size_t i = 0; i < y.size(); ++i) {
    const double far = (y[i] - y_at) * (y[i] - y_at) + (z[i] - z_at) * (z[i] - z_at);
    if (far < least) least = far, best = i;
  }
  double low = arc_length[best > 0 ? best - 1 : 0];
  double high = arc_length[std::min(best + 1, y.size() - 1)];
  for (int i = 0; i < 100; ++i) {  // thirds
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (square(a) < square(b) ? high : low) = square(a) < square(b) ? b : a;
  }
  return 0.5 * (low + high);
}

}  // namespace contact_addon
