// Derivatives of the normal problem's solution on its contact area.
//
// Where p > 0, A p = approach - h holds and goes on to hold: on the contact area
//   A dp = dapproach - dh - dA p,
// with the change of the force as a further equation where the force is prescribed. Elements change
// size by (ddx, ddy): the coefficients of the half-space are homogeneous of degree one in (dx, dy),
//   dA = (ddy/dy) A + (ddx - dx ddy/dy) dA/d(dx),
// in plane strain, by the logarithm, up to a constant: dA p = (ddx/dx) (A p - c dx sum p).
#pragma once

#include "normal/normal.hpp"
#include "numeric/shared_krylov.hpp"

namespace railpatch {

// One direction.
struct normal_variation {
  const double *distance = nullptr;  // m, rate of the undeformed distance; null: zero
  double size[2] = {0, 0};           // m, of dx, dy
  double factor[contact_parts::capacity - 1] = {};  // of contact_parts::factor
  double force = 0, approach = 0;                   // N or m, of what is prescribed
  // Nothing that the pressure depends on changes.
  bool still(bool force_given) const {
    for (double f : factor)
      if (f != 0) return false;
    return !distance && size[0] == 0 && size[1] == 0 && (force_given ? force : approach) == 0;
  }
};

// What was solved, with its pressure.
struct normal_point {
  influence &a;
  influence *by_length;  // derivatives of the coefficients; null: grids only scale
  normal_solver &solver;
  const grid &g;
  const contact_parts &parts;
  bool force_given;
  const double *pressure;
};

class normal_derivative {
 public:
  // directions: at once, at most
  normal_derivative(int max_count, int directions);

  // Rates of pressure, [direction][ny][nx], and of the approach. Returns the greatest relative
  // residual.
  double solve(const normal_point &point, const normal_variation *in, int count, double tolerance,
               double *pressure, double *approach);
  // Products of the last call, for tests and reports.
  int products() const { return products_; }
  size_t bytes() const;

 private:
  void collect(const normal_point &point);
  void size_term(const normal_point &point, const normal_variation &v, double *right);
  void factor_term(const normal_point &point, const normal_variation &v, double *right);

  int directions_, count_ = 0, products_ = 0;
  aligned_buffer<int> at_;
  aligned_buffer<double> right_, solution_, grid_in_, grid_out_;
  aligned_buffer<double> term_[2];  // A p and dA/d(dx) p on the grid, where sizes change
  bool terms_ = false;
  shared_krylov systems_;
};

}  // namespace railpatch
