#include "geometry/profile.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"

namespace railpatch {

namespace {

constexpr double sample_spacing = 2e-4;  // m; chords of 10 mm radius are then within 0.5 um
constexpr int max_samples = 4096;
constexpr double max_length = 2.0;  // m, longer ones are in millimetres
constexpr double steepest = 0.02;   // dy/ds where a running branch ends (88.9 degrees)

bool finite(const profile_view &v, int i) {
  return std::isfinite(v.s[i]) && std::isfinite(v.y[i]) && std::isfinite(v.z[i]) &&
         std::isfinite(v.dy[i]) && std::isfinite(v.dz[i]);
}

// coefficients of the cubic with these values and slopes over a length h
void hermite(double h, double f0, double f1, double d0, double d1, double c[4]) {
  const double slope = (f1 - f0) / h;
  c[0] = f0;
  c[1] = d0;
  c[2] = (3 * slope - 2 * d0 - d1) / h;
  c[3] = (d0 + d1 - 2 * slope) / (h * h);
}

// where a test that holds at lo and fails at hi turns
template <class F>
double bisect(double lo, double hi, F holds) {
  for (int i = 0; i < 60; ++i) {
    const double m = 0.5 * (lo + hi);
    (holds(m) ? lo : hi) = m;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

profile_fault validate(const profile_view &v) {
  if (v.n < 4 || !v.s || !v.y || !v.z || !v.dy || !v.dz) return profile_fault::too_few_points;
  double length = 0;
  for (int i = 0; i < v.n; ++i) {
    if (!finite(v, i)) return profile_fault::not_finite;
    if (i == 0) continue;
    if (!(v.s[i] > v.s[i - 1])) return profile_fault::not_increasing;
    length += hypot(v.y[i] - v.y[i - 1], v.z[i] - v.z[i - 1]);
  }
  if (length > max_length) return profile_fault::too_long;
  // chords are shorter than arcs, so a wide margin serves: this finds derivatives by something else
  const double ratio = length / (v.s[v.n - 1] - v.s[0]);
  if (!(ratio > 0.8 && ratio < 1.05)) return profile_fault::not_arc_length;
  for (int i = 0; i < v.n; ++i) {
    const double speed = hypot(v.dy[i], v.dz[i]);
    if (!(speed > 0.5 && speed < 2)) return profile_fault::not_arc_length;
  }
  return v.y[v.n - 1] > v.y[0] ? profile_fault::none : profile_fault::wrong_direction;
}

const char *text(profile_fault fault) {
  switch (fault) {
    case profile_fault::none:
      return "the profile is usable";
    case profile_fault::too_few_points:
      return "a profile needs at least 4 points, each with s, y, z, dy, dz";
    case profile_fault::not_finite:
      return "a value of the profile is not finite";
    case profile_fault::not_increasing:
      return "the arc length of the profile must grow from point to point";
    case profile_fault::not_arc_length:
      return "s is not the arc length of the profile or dy, dz are not derivatives by it";
    case profile_fault::too_long:
      return "the profile is longer than 2 m: are its values in millimetres?";
    case profile_fault::wrong_direction:
      return "the profile must run from the flange or gauge side (-y) to the field side (+y)";
  }
  return "unknown";
}

double inclination(const curve_point &p) { return atan2(p.dz, p.dy); }

double curvature(const curve_point &p) {
  const double speed = hypot(p.dy, p.dz);
  return (p.dy * p.d2z - p.dz * p.d2y) / (speed * speed * speed);
}

void profile::assign(const profile_view &v) {
  const auto count = static_cast<size_t>(v.n - 1);
  pieces_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const double h = v.s[i + 1] - v.s[i];
    pieces_[i].s = v.s[i];
    hermite(h, v.y[i], v.y[i + 1], v.dy[i], v.dy[i + 1], pieces_[i].y);
    hermite(h, v.z[i], v.z[i + 1], v.dz[i], v.dz[i + 1], pieces_[i].z);
  }
  begin_ = v.s[0];
  end_ = v.s[count];
  // buckets of equal length, so that a search starts next to its goal
  first_.resize(2 * count + 1);
  buckets_per_length_ = static_cast<double>(2 * count) / (end_ - begin_);
  int k = 0;
  for (size_t b = 0; b < first_.size(); ++b) {
    const double s = begin_ + static_cast<double>(b) / buckets_per_length_;
    while (k + 1 < static_cast<int>(count) && pieces_[static_cast<size_t>(k) + 1].s <= s) ++k;
    first_[b] = k;
  }
}

int profile::interval(double s) const {
  const double b = (s - begin_) * buckets_per_length_;
  const int last = static_cast<int>(first_.size()) - 1;
  if (!(b > 0)) return 0;
  const int bucket = b < last ? static_cast<int>(b) : last;
  const int lo = first_[static_cast<size_t>(bucket)];
  const int hi = first_[static_cast<size_t>(std::min(bucket + 1, last))];
  if (hi == lo) return lo;
  // clustered knots can share a bucket, so halve rather than walk
  const auto from = pieces_.begin() + lo + 1, to = pieces_.begin() + hi + 1;
  const auto at = std::upper_bound(from, to, s, [](double a, const piece &p) { return a < p.s; });
  return static_cast<int>(at - pieces_.begin()) - 1;
}

profile_piece profile::piece_at(int interval) const {
  const auto k = static_cast<size_t>(interval);
  const piece &p = pieces_[k];
  profile_piece out{p.s, k + 1 < pieces_.size() ? pieces_[k + 1].s : end_, {}, {}};
  std::copy_n(p.y, 4, out.y);
  std::copy_n(p.z, 4, out.z);
  return out;
}

placed_profile::placed_profile(const profile &curve, body kind) : curve_(&curve), kind_(kind) {
  const double length = curve.end() - curve.begin();
  const int count =
      std::clamp(static_cast<int>(std::ceil(length / sample_spacing)), 16, max_samples);
  raw_.resize(static_cast<size_t>(count) + 1);
  samples_.resize(raw_.size());
  if (kind_ == body::rail) before_.resize(2 * raw_.size() + 1);
  reload();
  place(0, 0, 0);
}

void placed_profile::reload() {
  const auto count = static_cast<int>(raw_.size()) - 1;
  step_ = (curve_->end() - curve_->begin()) / count;
  for (int i = 0; i <= count; ++i)
    raw_[static_cast<size_t>(i)] = curve_->evaluate(std::min(sample_s(i), curve_->end()));
  placed_ = false;
}

void placed_profile::place(double angle, double y, double z) {
  y_ = y;
  z_ = z;
  // few scenes turn the rail, or the wheel's profile on its axle
  if (placed_ && angle == angle_) return;
  placed_ = true;
  angle_ = angle;
  cos_ = cos(angle);
  sin_ = sin(angle);
  for (size_t i = 0; i < raw_.size(); ++i) samples_[i] = turned(raw_[i]);
  find_branch();
}

profile_piece placed_profile::piece_at(int interval) const {
  profile_piece out = curve_->piece_at(interval);
  for (size_t i = 0; i < 4; ++i) {
    const double y = out.y[i], z = out.z[i];
    out.y[i] = cos_ * y - sin_ * z;
    out.z[i] = sin_ * y + cos_ * z;
  }
  out.y[0] += y_;
  out.z[0] += z_;
  return out;
}

void placed_profile::find_branch() {
  const double sign = kind_ == body::rail ? 1 : -1;
  size_t top = 0;
  for (size_t i = 1; i < samples_.size(); ++i)
    if (sign * samples_[i].z < sign * samples_[top].z) top = i;
  extreme_ = static_cast<int>(top);
  const auto open = [&](size_t i) { return samples_[i].dy > steepest; };
  size_t a = top, b = top;
  while (a > 0 && open(a - 1) && samples_[a - 1].y < samples_[a].y) --a;
  while (b + 1 < samples_.size() && open(b + 1) && samples_[b + 1].y > samples_[b].y) ++b;
  first_ = static_cast<int>(a);
  last_ = static_cast<int>(b);
  if (kind_ == body::rail) index_branch();
}

// As profile::assign does for arc lengths, so that a search by y starts next to its goal.
void placed_profile::index_branch() {
  const auto at = [&](int i) { return samples_[static_cast<size_t>(i)].y; };
  const double from = at(first_), length = at(last_) - from;
  const auto stretches = static_cast<double>(before_.size() - 1);
  stretches_per_length_ = length > 0 ? stretches / length : 0.0;
  int k = first_;
  for (size_t b = 0; b < before_.size(); ++b) {
    const double y = from + static_cast<double>(b) * (length / stretches);
    while (k + 1 < last_ && at(k + 1) <= y) ++k;
    before_[b] = k;
  }
}

int placed_profile::first_not_before(double y) const {
  const auto begin = samples_.begin() + first_, end = samples_.begin() + last_ + 1;
  const auto before = [this](const curve_point &p, double at) { return p.y + y_ < at; };
  return static_cast<int>(std::lower_bound(begin, end, y, before) - samples_.begin());
}

// The sample of the branch, but its last, that y is not before; last: where one nearby was.
int placed_profile::sample_before(double y, int last) const {
  const auto at = [&](int i) { return samples_[static_cast<size_t>(i)].y + y_; };
  const auto holds = [&](int i) { return at(i) <= y && (i + 1 == last_ || y < at(i + 1)); };
  for (const int near : {last, last + 1})
    if (near >= first_ && near < last_ && holds(near)) return near;
  int a = first_, b = last_;
  if (kind_ == body::rail) {
    const auto most = static_cast<int>(before_.size()) - 2;
    const int stretch = std::min(static_cast<int>((y - at(a)) * stretches_per_length_), most);
    // one to either side, for rounding
    a = before_[static_cast<size_t>(std::max(stretch - 1, 0))];
    b = std::min(before_[static_cast<size_t>(std::min(stretch + 2, most + 1))] + 1, last_);
  }
  while (b - a > 1) {
    const int m = (a + b) / 2;
    (at(m) <= y ? a : b) = m;
  }
  return a;
}

bool placed_profile::find(double y, double &s, curve_point &p, profile_place &last) const {
  const auto at = [&](int i) { return samples_[static_cast<size_t>(i)].y + y_; };
  if (!(y >= at(first_) && y <= at(last_))) return false;
  const int a = sample_before(y, last.sample), b = std::min(a + 1, last_);
  last.sample = a;
  double lo = sample_s(a), hi = std::min(sample_s(b), curve_->end());
  s = start_between(a, b, y, hi - lo);
  // newton on y(s), kept between the two samples
  int k = curve_->interval(s, last.interval);
  for (int i = 0; i < 50; ++i) {
    p = evaluate(s, k);
    (p.y < y ? lo : hi) = s;
    double next = s - (p.y - y) / p.dy;
    if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
    const double change = next - s;
    s = next;
    // its error falls with the square: less than 1e-13 m remains of radii above 1 mm
    if (std::fabs(change) < 1e-8) {
      p.y += change * (p.dy + 0.5 * change * p.d2y);
      p.z += change * (p.dz + 0.5 * change * p.d2z);
      p.dy += change * p.d2y;
      p.dz += change * p.d2z;
      break;
    }
    k = curve_->interval(s, k);
  }
  last.interval = k;
  return true;
}

// The cubic of s over y between two samples: as near as 1e-10 m where the curvature is smooth, so
// that one newton step does.
double placed_profile::start_between(int a, int b, double y, double length) const {
  const curve_point &low = samples_[static_cast<size_t>(a)],
                    &high = samples_[static_cast<size_t>(b)];
  const double width = high.y - low.y, u = (y - y_ - low.y) / width;
  const double first = width / low.dy - length, last = width / high.dy - length;
  const double along = length * u + u * (1 - u) * (first * (1 - u) - last * u);
  return sample_s(a) + std::clamp(along, 0.0, length);
}

placed_profile::inner_face placed_profile::innermost(double height) const {
  const double top = extreme(), depth = evaluate(top).z + height;
  int i = extreme_, best = i;
  for (; i >= 0 && sample(i).z < depth; --i)
    if (sample(i).y < sample(best).y) best = i;
  inner_face out{evaluate(top).y, top, false};
  const auto consider = [&](double y, double s, bool at_height) {
    if (y < out.y) out = {y, s, at_height};
  };
  consider(sample(best).y, sample_s(best), false);
  // the samples only bracket where the height is reached ...
  if (i >= 0 && i < extreme_) {
    const double s =
        bisect(sample_s(i), sample_s(i + 1), [&](double m) { return evaluate(m).z - depth > 0; });
    consider(evaluate(s).y, s, true);
  }
  // ... and where an undercut face lies furthest in
  if (best > std::max(i + 1, 0) && best < extreme_) {
    const double s = bisect(sample_s(best - 1), sample_s(best + 1),
                            [&](double m) { return evaluate(m).dy < 0; });
    consider(evaluate(s).y, s, false);
  }
  return out;
}

double placed_profile::extreme() const {
  double lo = sample_s(std::max(extreme_ - 1, 0));
  double hi = std::min(sample_s(extreme_ + 1), curve_->end());
  const double sign = kind_ == body::rail ? 1 : -1;
  // dz changes sign from - to + at the top of a rail; at an end of the curve it need not
  if (sign * evaluate(lo).dz >= 0) return lo;
  if (sign * evaluate(hi).dz <= 0) return hi;
  return bisect(lo, hi, [&](double m) { return sign * evaluate(m).dz < 0; });
}

}  // namespace railpatch
