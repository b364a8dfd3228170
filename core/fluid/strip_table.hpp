// Strips under an elliptic pressure by their two numbers S and r (fluid/wet_strip.hpp), solved once
// and interpolated: the liquid's pressure over where in the strip, X_c, and the share of the load
// that asperities carry. Cubics through four nodes, over ln S and the root of r; S of 1e-6 to 1e5
// and r of 0.01 to 0.55, beyond that it stays as at the end.
#pragma once

#include <array>

namespace railpatch {

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
  };
  static constexpr int numbers = profile_nodes + 2;
  static double s_of(int row);
  static double r_of(int column);
  static strip at(double s, double r);
  // Share of asperities alone, and of all rows of an ellipse: r in its middle. S is the same in
  // all.
  static double share(double s, double r);
  static double share_of_ellipse(double s, double r);

 private:
  struct place {
    int s, r;  // first of four nodes
    double of_s[4], of_r[4];
  };
  static place place_of(double s, double r);
  static const double *node(int s, int r);
};

}  // namespace railpatch
