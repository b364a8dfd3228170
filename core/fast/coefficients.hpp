// Kalker's creepage coefficients of an elliptic contact at vanishing creepage, with c^2 = a b:
//   F_x = -G c^2 C11 xi,  F_y = -G c^2 (C22 eta + c C23 phi),  M_z = G c^3 (C23 eta - c C33 phi)
// for rolling along +x (Kalker 1967, Delft; 1990, "Three-dimensional elastic bodies in rolling
// contact", eq. 5.30). Two sources: our own full theory with all of the contact in stick, for every
// method, and Kalker's published table, for comparison with programs that use it.
#pragma once

namespace railpatch {

struct creepage_coefficients {
  double c11 = 0, c22 = 0, c23 = 0, c33 = 0;
  bool in_range = true;  // false: a/b is outside the table and was taken from its edge
};

// Computed coefficients for a/b = 1/20 ... 20. Relative differences between two sets of grids
// (railpatch.evidence.kalker_table --check), greatest of Poisson's ratios: C11, C22 and C23 3e-4
// for 0.1 < a/b < 5, 1.3e-3 up to 10, 7e-3 up to 20, C23 2e-3 down to 1/20; C33 2e-4 for a/b < 2.2,
// 2e-3 up to 5 and 0.1 at 20, where it hardly counts.
class coefficient_table {
 public:
  explicit coefficient_table(double poisson_ratio);
  creepage_coefficients at(double axis_ratio) const;
  // The same c11, c22, c23, c33, with rates of the ratio's. T: double or directed.
  template <class T>
  void at(const T &axis_ratio, T coefficients[4]) const;

 private:
  static constexpr int nodes = 25;
  double values_[nodes][4][2];  // values and derivatives to ln(a/b)
};

// Kalker 1990, table E3, three digits, for a/b = 0.1 ... 10; no C33. Between the tabulated
// Poisson's ratios 0, 1/4, 1/2 the flexibilities 1/C are linear.
creepage_coefficients published_coefficients(double axis_ratio, double poisson_ratio);

}  // namespace railpatch
