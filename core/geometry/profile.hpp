// Wheel and rail profiles as smooth curves.
//
// A profile is a cubic Hermite curve y(s), z(s) in arc length s, m. It is a right-hand profile: s
// and y grow from the flange or gauge side to the field side, z points down. The inclination
// atan2(dz, dy) and the curvature (dy d2z - dz d2y)/|d|^3 follow from the same polynomials.
//
// A placed profile is turned by an angle about x, (y, z) -> (c y - s z, s y + c z), and then moved.
// Its running branch is what can be touched from the other side: around the highest point of a rail
// (least z), the lowest of a wheel (greatest z), as far as y keeps growing with s.
#pragma once

#include <cstddef>
#include <vector>

namespace railpatch {

struct profile_view {
  const double *s, *y, *z, *dy, *dz;  // n values each; derivatives with respect to s
  int n;
};

enum class profile_fault {
  none,
  too_few_points,
  not_finite,
  not_increasing,
  not_arc_length,
  too_long,
  wrong_direction
};
profile_fault validate(const profile_view &view);
const char *text(profile_fault fault);

struct curve_point {
  double y, z, dy, dz, d2y, d2z;
};
// y and z as polynomials of s - begin, up to s = end.
struct profile_piece {
  double begin, end;  // m
  double y[4], z[4];
};
double inclination(const curve_point &p);
double curvature(const curve_point &p);

class profile {
 public:
  // The view must have passed validate(); its values are copied.
  explicit profile(const profile_view &view) { assign(view); }
  // Another curve; allocates only where it has more points.
  void assign(const profile_view &view);

  double begin() const { return begin_; }
  double end() const { return end_; }
  // Beyond the ends the end polynomials go on; ask covers() where that matters.
  bool covers(double s) const { return s >= begin_ && s <= end_; }
  // The interval that holds s; last is where a neighbouring s was found.
  int interval(double s, int last) const {
    const auto k = static_cast<std::size_t>(last);
    const auto ends = [&](std::size_t i) {
      return i + 1 == pieces_.size() || s < pieces_[i + 1].s;
    };
    if (last > 0 && s < pieces_[k].s)
      return last == 1 || s >= pieces_[k - 1].s ? last - 1 : interval(s);
    if (ends(k)) return last;
    return ends(k + 1) ? last + 1 : interval(s);
  }
  int interval(double s) const;
  curve_point evaluate(double s, int interval) const {
    const piece &p = pieces_[static_cast<std::size_t>(interval)];
    const double t = s - p.s;
    const auto value = [t](const double *c) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
    const auto slope = [t](const double *c) { return c[1] + t * (2 * c[2] + 3 * t * c[3]); };
    const auto bend = [t](const double *c) { return 2 * c[2] + 6 * t * c[3]; };
    return {value(p.y), value(p.z), slope(p.y), slope(p.z), bend(p.y), bend(p.z)};
  }
  curve_point evaluate(double s) const { return evaluate(s, interval(s)); }
  profile_piece piece_at(int interval) const;
  std::size_t bytes() const { return pieces_.size() * sizeof(piece) + first_.size() * sizeof(int); }

 private:
  struct piece {
    double s, y[4], z[4];  // knot, polynomial coefficients from there
  };
  std::vector<piece> pieces_;
  std::vector<int> first_;  // interval at the start of each of equal buckets of s
  double begin_ = 0, end_ = 0, buckets_per_length_ = 0;
};

enum class body { wheel, rail };

// Where a search on a placed profile ended, for the next one to start from. What is found does not
// depend on it.
struct profile_place {
  int sample = -1, interval = 0;
};

class placed_profile {
 public:
  placed_profile(const profile &curve, body kind);
  // The curve has changed: place() must follow.
  void reload();

  void place(double angle, double y, double z);
  curve_point evaluate(double s, int interval) const {
    return moved(turned(curve_->evaluate(s, interval)));
  }
  curve_point evaluate(double s) const { return evaluate(s, curve_->interval(s)); }
  // Turned and moved.
  profile_piece piece_at(int interval) const;
  const profile &curve() const { return *curve_; }
  double angle() const { return angle_; }
  double moved_y() const { return y_; }
  double moved_z() const { return z_; }

  // The arc length of the running branch at y (turned and moved); false where there is none.
  bool find(double y, double &s) const {
    curve_point p;
    profile_place anywhere;
    return find(y, s, p, anywhere);
  }
  // And the point there; last: where a search nearby ended, and this one.
  bool find(double y, double &s, curve_point &p, profile_place &last) const;
  // Samples of the running branch, equally spaced in s: first() to last(), both included.
  int first() const { return first_; }
  int last() const { return last_; }
  // The first of them that is not before y; last() + 1 where all are.
  int first_not_before(double y) const;
  double sample_s(int i) const { return curve_->begin() + i * step_; }
  curve_point sample(int i) const { return moved(samples_[static_cast<std::size_t>(i)]); }
  double step() const { return step_; }
  // The extreme point in z: highest of a rail, lowest of a wheel.
  double extreme() const;
  // The least y down to the given height below the top of a rail: the gauge face.
  struct inner_face {
    double y, s;     // m
    bool at_height;  // it is where the height is reached
  };
  inner_face innermost(double height) const;
  std::size_t bytes() const {
    return samples_.size() * 2 * sizeof(curve_point) + before_.size() * sizeof(int);
  }

 private:
  curve_point turned(const curve_point &p) const {
    const double c = cos_, s = sin_;
    return {c * p.y - s * p.z,   s * p.y + c * p.z,     c * p.dy - s * p.dz,
            s * p.dy + c * p.dz, c * p.d2y - s * p.d2z, s * p.d2y + c * p.d2z};
  }
  curve_point moved(curve_point p) const {
    p.y += y_;
    p.z += z_;
    return p;
  }
  int sample_before(double y, int last) const;
  double start_between(int a, int b, double y, double length) const;
  void find_branch();
  void index_branch();

  const profile *curve_;
  body kind_;
  bool placed_ = false;
  double angle_ = 0, cos_ = 1, sin_ = 0, y_ = 0, z_ = 0, step_ = 0;
  std::vector<curve_point> raw_, samples_;  // these turned, not moved
  std::vector<int> before_;  // of a rail: sample of the branch at the start of equal stretches of y
  double stretches_per_length_ = 0;
  int first_ = 0, last_ = 0, extreme_ = 0;
};

}  // namespace railpatch
