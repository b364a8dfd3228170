// Influence coefficients between elements of a curved reference surface, as products by FFT.
//
// Rows of elements lie equally spaced in arc length s on a curve across the rolling direction; row
// j is inclined by a_j, its axes x, s_j, n_j. A traction in row j acts in its own axes, and a
// displacement is felt in row i in those of i. Half-space coefficients A at the distance (x, arc
// length), corrected by the difference of inclination d = a_i - a_j, the vectors turned by R(d)
// (Li 2002, thesis, Delft; Vollebregt and Segal 2014, Veh. Syst. Dyn. 52 suppl.). The half-space
// may stand along the source's surface, u = R(d) A p, or along the observer's, u = A R(d) p.
// Neither alone obeys Maxwell's and Betti's law, the mean of both does:
//   x from x: A_xx            x from s, s from x: (1 + cos d)/2 A_xs
//   s from s: cos d A_ss      n from n: cos d A_nn
//   gap from s:  sin d (A_ss + A_nn)/2,   gap from x:  sin d A_xs/2,
//   s from p_n: -sin d (A_ss + A_nn)/2,   x from p_n: -sin d A_xs/2
// (p_n the pressure, which pushes the wheel along -n; gap: displacement that parts the bodies).
// cos d = cos a_i cos a_j + sin a_i sin a_j is a sum of products of unit vectors, so A_nn and A_ss
// stay positive definite for any curve (Schur's product theorem). Along x nothing changes from
// element to element, as
// tangential/rolling_newton.hpp asks. Every part is a convolution of rows multiplied by cos a or
// sin a before and after: two products in place of one for the pressure, three for the tractions.
// The layer's flexibility is a row's own: d = 0.
#pragma once

#include "numeric/convolution.hpp"
#include "numeric/fft.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

class conformal_influence {
 public:
  // layer_flexibility: part of the spectra of xx and yy, m/Pa
  conformal_influence(const fft_plans &plans, bool tangential, double layer_flexibility);

  void set_size(int nx, int ny, int transform_nx, int transform_ny);
  // Spectra of the half-space, of the transform's size, [count]; zz comes last.
  void take_xx(const double *spectrum, size_t count);
  void take_yy(const double *spectrum, size_t count);
  void take_xy(const double *spectrum, size_t count);
  void take_zz(const double *spectrum, size_t count);
  // Cosine and sine of each row's inclination, [ny]; kept by address.
  void set_rows(const double *cosine, const double *sine);

  // u = A p by the half-space's own product; p, u: [ny][nx]
  template <class Product>
  void normal(const double *p, double *u, Product &&flat) {
    for (int k = 0; k < 2; ++k) {
      scale_rows(k, p, work_[0].data());
      flat(work_[0].data(), work_[1].data());
      add_rows(k, 1.0, work_[1].data(), u, k == 0);
    }
  }
  // (u_x, u_s) from (p_x, p_s), or the micro-slip that they cause in steady rolling
  void tangential(const double *px, const double *py, double *ux, double *uy);
  void rolling(const double *px, const double *py, int direction, double dx, double *sx,
               double *sy);
  void rolling_single(const double *px, const double *py, int direction, double dx, double *sx,
                      double *sy);
  void tangential_single(const double *px, const double *py, double *ux, double *uy);
  // Tangential displacement from pressure; with direction not 0 the micro-slip that it causes.
  void from_pressure(const double *p, int direction, double dx, double *ux, double *uy);
  // What tractions add to the gap.
  void from_traction(const double *px, const double *py, double *gap);
  size_t bytes() const;

 private:
  // with the parts that no inclination changes, and those that it does
  template <class T>
  struct parts {
    convolution<T> plain, turned;
  };
  template <class T, class Product>
  void tangential_parts(parts<T> &c, const double *px, const double *py, double *ux, double *uy,
                        Product &&product);
  const double *scaled(const double *spectrum, size_t count, double factor);
  // k: 0 cosine, 1 sine
  void scale_rows(int k, const double *in, double *out) const;
  void add_rows(int k, double sign, const double *in, double *out, bool first) const;

  bool tangential_;
  double layer_flexibility_;
  int nx_ = 0, ny_ = 0;
  const double *row_[2] = {nullptr, nullptr};
  parts<double> full_;
  parts<float> single_;
  convolution<double> crossed_;  // between normal and tangential directions
  aligned_buffer<double> scaled_, mean_, work_[4];
};

}  // namespace railpatch
