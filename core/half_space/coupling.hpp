// Coupling of the normal and the tangential directions of unlike bodies (K not 0) on a uniform
// grid: pressure moves the surfaces along each other, traction moves them apart.
//
// With observer minus source (x, y), r = |(x, y)| and [[f]] the alternating sum over the element's
// corners (Kalker 1990, "Three-dimensional elastic bodies in rolling contact", appendix C)
//   u_x from p_n: -K/(pi G) [[y ln r + x atan(y/x)]], the integral of x/r^2,
//   u_y from p_n: x and y exchanged; u_n from p_x and p_y: the same with the other sign.
// Line contact (plane strain): u_x = -K/G int p sign(x-s) ds, the integral of x/r^2 over y, so that
// du_x/dx = -2 K/G p where the pressure acts (Johnson 1985, eq. 2.25); u_y = 0.
#pragma once

#include <cmath>

#include "half_space/coupling_operator.hpp"
#include "numeric/plane_transform.hpp"

namespace railpatch {

// Whether pressure and traction act on each other at all. A mismatch below the limit, of 1/Pa times
// G, is rounding in the combination of equal bodies.
inline bool is_coupled(const elastic_constants &e) { return !(std::abs(e.mismatch) < 1e-12); }

class coupling_influence final : public coupling_operator {
 public:
  coupling_influence(const elastic_constants &elastic, bool line, const fft_plans &plans);

  // false where the grid exceeds the plans.
  bool set_grid(const grid &g) override;
  // Tangential displacement (m) from pressure, seen from `offset` (m) further along x. Kernels are
  // kept for offset 0 and for the last other one.
  void from_pressure(double offset, const double *p, double *ux, double *uy) override;
  // Normal displacement (m) from traction.
  void from_traction(const double *px, const double *py, double *un) override;
  size_t bytes() const override;

 private:
  using fft = plane_transform::fft;
  using lines = plane_transform::lines;
  struct wave {
    double re, im;
  };
  // of K_x + i K_y with the kernels u_x, u_y from p_n, [big_nx][big_ny]
  struct spectrum {
    bool made = false;
    double offset = 0;
    aligned_buffer<double> re, im;
  };
  void prepare(spectrum &s, double offset);
  void fill_kernel(int component, double offset);
  void fill_corners(int component, double offset);
  template <class F>
  lines product(const double *re, const double *im, F &&times);
  int big_nx() const { return plans_.nx(plan_); }
  int big_ny() const { return plans_.ny(plan_); }

  double factor_;  // -K/(pi G)
  bool line_;
  const fft_plans &plans_;
  grid grid_;
  int plan_ = -1;
  plane_transform plane_;
  spectrum here_, there_;
  aligned_buffer<double> corner_;
};

}  // namespace railpatch
