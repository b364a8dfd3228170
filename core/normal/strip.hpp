// Integrals over the strip of one row of contact, of width dy, whose squared half chord l^2 is a
// quadratic function of the lateral distance t from the strip's middle; contact is where it is
// positive.
#pragma once

namespace railpatch {

struct quadratic {
  double c0 = 0, c1 = 0, c2 = 0;
  double at(double t) const { return c0 + (c1 + c2 * t) * t; }
  quadratic operator+(double s) const { return {c0 + s, c1, c2}; }
  quadratic operator-(double s) const { return {c0 - s, c1, c2}; }
  quadratic operator*(double s) const { return {c0 * s, c1 * s, c2 * s}; }
};

class strip {
 public:
  strip(const quadratic &squared_half_chord, double dy);

  bool empty() const { return intervals_ == 0; }
  double width() const;                 // m, where there is contact
  double log_integral(double y) const;  // int ln|y + t| dt
  // int f(t, l^2) dt; exact to degree three, ends of contact like sqrt(distance) included
  template <class F>
  double integral(const F &f) const {
    double sum = 0;
    for (int k = 0; k < nodes_; ++k) sum += weight_[k] * f(t_[k], squared_[k]);
    return sum;
  }

 private:
  void add_interval(const quadratic &q, double from, double to);

  int intervals_ = 0, nodes_ = 0;
  double from_[2], to_[2];
  double t_[14], weight_[14], squared_[14];
};

// int sqrt(l^2 - x^2)/sqrt(x^2 + y^2) dx over the chord: pi E* times the displacement at distance y
// from a row with k = 1. With m = l^2/(l^2 + y^2) it is 2 sqrt(l^2 + y^2) (K(m) - E(m)).
double row_potential(double squared_half_chord, double y);

}  // namespace railpatch
