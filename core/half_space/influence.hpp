// Influence coefficients of the elastic half-space (and third-body layer) on a uniform grid, and
// their products with pressure and traction by FFT (numeric/convolution.hpp).
//
// Piecewise-constant tractions on elements dx by dy (Kalker 1990, "Three-dimensional elastic
// bodies in rolling contact", appendix C). With observer minus source (x, y), r = |(x, y)| and
// [[f]] the alternating sum over the element's corners:
//   zz: (1-nu)/(pi G) [[y ln(x+r) + x ln(y+r)]]
//   xx: 1/(pi G) ([[y ln(x+r)]] + (1-nu) [[x ln(y+r)]]),  yy: x and y exchanged
//   xy: nu/(pi G) [[-r]]
// Line contact (plane strain, ny = 1): u = c int p ln(width/|x-s|) ds with c = 2(1-nu)/(pi G) for
// zz and xx, 2/(pi G) for yy: the displacement at the middle of a strip of the given width, so the
// approach of a line contact refers to that width (Johnson 1985, chapter 5).
// The layer adds thickness/G3 to the diagonal of xx and yy. In place of all of them there may be
// coefficients that the caller has, of any bodies that are the same wherever the load is.
//
// Index order: arrays [ny][nx], x fastest. All kernels are even (xx, yy, zz) or odd (xy) in both
// coordinates, so their spectra are real.
#pragma once

#include <memory>

#include "half_space/conformal_influence.hpp"
#include "half_space/kernel_book.hpp"
#include "half_space/physics.hpp"
#include "numeric/convolution.hpp"
#include "numeric/fft.hpp"
#include "numeric/kernel_transform.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct grid {
  int nx = 0, ny = 0;     // elements along rolling, lateral
  double dx = 0, dy = 0;  // m
  double x0 = 0, y0 = 0;  // m, centre of element (0, 0)
  double x(int i) const { return x0 + i * dx; }
  double y(int j) const { return y0 + j * dy; }
  int count() const { return nx * ny; }
};

struct elastic_constants {
  double shear_modulus;  // Pa, 1/G = (1/G_w + 1/G_r)/2
  double poisson_ratio;  // nu/G = (nu_w/G_w + nu_r/G_r)/2
  double mismatch;       // K, 0 for equal bodies (Kalker 1990, eq. 1.44)
};
elastic_constants combine(const double shear_modulus[2], const double poisson_ratio[2]);

enum class kernel { zz = 0, xx = 1, yy = 2, xy = 3 };

class influence {
 public:
  struct medium {
    elastic_constants elastic;
    double layer_flexibility = 0;  // m/Pa, thickness over shear modulus
    double line_width = 0;         // m, > 0: plane strain
    bool tangential = true;        // false: no xx, yy, xy at all
    // the coefficients' derivatives by dx instead, offsets in elements kept (not plane strain)
    bool by_length = false;
    bool curved = false;   // rows on a curved reference surface
    bool follows = false;  // of grids that follow each other: see set_grid()
    // in place of the half-space's, copied: [4][own_rows][own_columns] or the first of them, by
    // kernel and offset in elements; no others are used
    const double *own = nullptr;
    int own_columns = 0, own_rows = 0;
  };

  influence(const medium &of, const fft_plans &plans);

  // Prepares kernels and spectra for a grid; false where the grid exceeds the plans. Cheap when
  // neither element size nor transform size changes. followed: how many grids in a row, this one
  // the last, had a dy/dx close to that of the one before; kept kernels serve it, if there are any,
  // from kernel_book::lead on.
  bool set_grid(const grid &g, int followed = 0);
  // Whether it is: what is kept reaches as far.
  static bool close(const grid &a, const grid &b);

  // Of a curved reference surface: the inclination of each row (conformal_influence.hpp), before
  // the products. Their inverses and single coefficients stay those of the plane.
  void set_rows(const double *cosine, const double *sine) { curved_->set_rows(cosine, sine); }
  conformal_influence &curved() { return *curved_; }

  // u = A p for the normal direction, [ny][nx].
  void normal_product(const double *pressure, double *displacement);
  // The same in single precision, for what only steers an iteration.
  void normal_product_single(const double *pressure, double *displacement);
  // Circulant approximation of the inverse of normal_product, symmetric positive up to the rounding
  // of single precision.
  void normal_inverse(const double *displacement, double *pressure);
  // (u_x, u_y) = A (p_x, p_y).
  void tangential_product(const double *px, const double *py, double *ux, double *uy);
  // The same in single precision, for what only steers an iteration.
  void tangential_product_single(const double *px, const double *py, double *ux, double *uy);
  // Steady rolling: (u(x) - u(x + direction dx))/dx, the micro-slip caused by the tractions.
  // Returns p . A p (Pa m, over the elements); nan on a curved reference surface.
  double rolling_product(const double *px, const double *py, int direction, double *sx, double *sy);
  void rolling_product_single(const double *px, const double *py, int direction, double *sx,
                              double *sy);

  const medium &bodies() const { return medium_; }
  // xx, yy and xy of the bodies at any offset (m), observer minus source.
  void bodies_at(double x, double y, double values[3]) const;
  // The same of the half-space in two steps, for many elements that share corners: primitives at a
  // corner, and the coefficients from their alternating sums.
  static void corner_at(double x, double y, double values[3]);
  void from_corners(const double sum[3], double values[3]) const;
  // One coefficient at offset (i, j) elements, observer minus source.
  double coefficient(kernel k, int i, int j) const;
  size_t bytes() const;

 private:
  void make_kernels(int half_x, int half_y);
  void prepare_book();
  void make_half_space_kernels();
  void make_line_kernels();
  void take_own_kernels();
  void make_rates(double x, double y, double moves, size_t at);
  void make_spectra();
  void need_pressure();
  void need_tractions();
  void read_book();
  void write_page(double ratio, double *const *arrays);
  double *mixed(int k) { return mixed_.data() + static_cast<size_t>(k) * table_[0].size(); }
  double share_of_pressure() const;
  void take_spectrum(kernel k);
  void take_inverse();
  void give_spectrum(kernel k);
  bool is_curved() const { return has_physics && curved_; }

  medium medium_;
  const fft_plans &plans_;
  grid grid_;
  int plan_ = -1;
  int half_x_ = -1, half_y_ = -1;  // greatest offsets in the tables
  int stride_ = 0;
  aligned_buffer<double> table_[4];
  aligned_buffer<double> corner_[3];
  aligned_buffer<double> own_;
  aligned_buffer<double> spectrum_;  // of a kernel, real
  std::unique_ptr<kernel_book> book_;
  aligned_buffer<double> mixed_;  // of its pages: spectra
  bool read_ = false;             // kernels are those of the book
  // spectra are made when they are asked for
  bool pressed_ = false, rubbed_ = false;
  convolution<double> full_;
  convolution<float> single_;
  kernel_transform transform_;
  std::unique_ptr<conformal_influence> curved_;
};

}  // namespace railpatch
