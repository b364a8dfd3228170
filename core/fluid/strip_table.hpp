// Strips under an elliptic pressure by their two numbers S and r (fluid/wet_strip.hpp), solved once
// and interpolated: the liquid's pressure over where in the strip, X_c, and the share of the load
// that asperities carry. Cubics through four nodes, over ln S and the root of r; S of 1e-6 to 1e5
// and r of 0.01 to 0.55, beyond that it stays as at the end.
#pragma once

#include <array>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/simd.hpp"

namespace railpatch {

// acos within 2e-8, of -1 to 1 (a number beyond): Hastings' polynomial (Abramowitz and Stegun
// 1964, 4.4.46).
RAILPATCH_INLINE double near_acos(double x) {
  constexpr double pi = 3.141592653589793;
  const double y = std::fabs(x);
  double p = 0.0066700901 - 0.0012624911 * y;
  p = -0.0170881256 + p * y;
  p = 0.0308918810 + p * y;
  p = -0.0501743046 + p * y;
  p = 0.0889789874 + p * y;
  p = -0.2145988016 + p * y;
  p = 1.5707963050 + p * y;
  return 0.5 * pi - std::copysign(0.5 * pi - p * std::sqrt(std::fabs(1.0 - y)), x);
}

class strip_table {
 public:
  static constexpr int rows = 60, columns = 11;  // of S and r
  static constexpr int profile_nodes = 19;  // from the leading edge to X_c, denser towards both
  // One strip, read from the table.
  struct strip {
    double end;                                // theta of X_c
    double share;                              // of asperities
    std::array<double, profile_nodes> liquid;  // P
    // P over p_0 at X = -cos(theta)
    double pressure(double theta) const;
    // At count places X, -1 the leading edge; angles within 4e-8.
    void pressures(const double *x, int count, double *found) const;
  };
  static constexpr int numbers = profile_nodes + 2;
  // logarithm of the least S and from it to the most, square root of the least r and from it
  static constexpr double low_s = -13.815510557964274, across_s = 25.328436022934503;
  static constexpr double low_r = 0.1, across_r = 0.64161984870956632;
  static double s_of(int row) { return exp(low_s + row * across_s / (rows - 1)); }
  static double r_of(int column) {
    const double root = low_r + column * across_r / (columns - 1);
    return root * root;
  }
  static strip at(double s, double r);
  // All strips of one S, as the rows of an elliptic contact have it.
  class rows_of {
   public:
    explicit rows_of(double s);
    strip at(double r) const;
    // Of asperities, of all rows of an ellipse: r in its middle.
    double share_of_ellipse(double r) const;

   private:
    std::array<double, columns * numbers> of_r_;
  };
  static double share(double s, double r);  // of asperities alone
  static double end(double s, double r);    // theta of X_c alone

 private:
  struct place {
    int first;  // of four nodes
    double weight[4];
  };
  static place place_of_s(double s);
  static place place_of_r(double r);
  static const double *node(int s, int r);
  static double number(double s, double r, int which);  // of a strip's
};

}  // namespace railpatch
