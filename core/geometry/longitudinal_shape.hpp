// Shape along the rolling direction: a wheel's radius over its pitch angle (out of round, flats)
// and the height of a rail's running surface along the track (joints, dips).
//
// Both are C2 cubic splines through equally spaced values. The wheel's radius at the angle a ahead
// of its lowest point is that of its profile plus runout(pitch - a): a wheel rolling forward
// (pitch falls) brings what lies ahead to the bottom. The rail's surface lies height(x + xi) above
// its profile, xi ahead of the wheelset's centre.
//
// In one row of the contact locus (geometry.hpp), a meridian of the wheel, the vertical gap is that
// of the round wheel on the level rail less both:
//   gap(a) = gap0 + r (1 - cos(a - a0)) + c (x(a) - x(a0))^2 - runout(pitch - a) cos a - height(x +
//   x(a))
// with a0 where the round wheel comes closest and c the half curvature of a roller. It may have
// several minima, for example at the two ends of a flat.
#pragma once

#include <vector>

namespace railpatch {

// A C2 cubic spline through equally spaced values, periodic or constant beyond its ends.
class even_spline {
 public:
  even_spline() = default;
  even_spline(const double *values, int count, double start, double spacing, bool periodic);

  bool given() const { return !nodes_.empty(); }
  double at(double x, double &slope) const;
  double at(double x) const {
    double slope;
    return at(x, slope);
  }
  // Not less than any value from a to b; b - a at most a period.
  double greatest(double a, double b) const;
  std::size_t bytes() const { return nodes_.size() * sizeof(node); }

 private:
  struct node {
    double value, slope;
  };
  int cell(double x, double &share) const;

  std::vector<node> nodes_;
  double start_ = 0, spacing_ = 1;
  bool periodic_ = false;
};

// A wheel's runout and a rail's height at even spacings; counts of 0: round, level.
struct longitudinal_values {
  const double *runout = nullptr;  // m, round the wheel
  int runout_count = 0;
  const double *height = nullptr;  // m, at height_start + i height_spacing
  int height_count = 0;
  double height_start = 0, height_spacing = 1;
  bool given() const { return runout_count > 0 || height_count > 0; }
};

class longitudinal_shape {
 public:
  static constexpr double widest = 0.25;  // rad either side of a row's round locus point

  explicit longitudinal_shape(const longitudinal_values &values);

  // pitch: rad, of the wheel; x: m, of the wheelset's centre along the track; radius: m, nominal
  void place(double pitch, double x, double radius);
  bool has_runout() const { return runout_.given(); }
  bool has_height() const { return height_.given(); }
  // m, by the angle ahead of the wheel's lowest point, and its derivative
  double runout(double angle, double &slope) const;
  double runout(double angle) const { return has_runout() ? runout_.at(pitch_ - angle) : 0.0; }
  // m, xi ahead of the wheelset's centre
  double height(double xi) const { return has_height() ? height_.at(x_ + xi) : 0.0; }
  double height_slope(double xi) const {
    double slope;
    height_.at(x_ + xi, slope);
    return slope;
  }
  // not less than their sum anywhere near
  double greatest() const { return greatest_; }
  std::size_t bytes() const { return sizeof *this + runout_.bytes() + height_.bytes(); }

 private:
  even_spline runout_, height_;
  double pitch_ = 0, x_ = 0, greatest_ = 0;
};

// Where a row overlaps.
struct row_overlap {
  double weight = 0;            // m^3, 15/16 of the integral of overlap^2 over x
  double x = 0;                 // m, mean with overlap^2
  double x_min = 0, x_max = 0;  // m
};

struct longitudinal_row {
  const longitudinal_shape *shape;
  double angle, radius;  // rad, m: of the round wheel's closest point, ahead of the lowest
  double gap;            // m, there, without the shape
  double x0, advance;    // m: x(a) = x0 + advance (sin a - sin angle)
  double bend;           // 1/m, c above

  double x(double a) const;
  double at(double a) const;
  // The least gap and where.
  double least(double &a) const;
  row_overlap overlap() const;

 private:
  double half_width(double level) const;
  double dip(double middle, double step, const double gaps[3], double &best) const;
  double edge(double outside, double inside) const;
  void add(double from, double to, row_overlap &sum) const;
};

}  // namespace railpatch
