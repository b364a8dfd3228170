// Products of the influence coefficients with a grid's pressure or tractions, in single or double
// precision. Single precision serves what only steers an iteration: steps of GMRES,
// preconditioners, lengths of steps. What a solution is measured by is formed in double precision.
//
// Lateral direction first, all columns at once; then along x, all lateral wave numbers at once. Two
// real fields travel as one complex one and are told apart after the lateral transform.
#pragma once

#include <type_traits>

#include "numeric/batch_fft.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

template <class T>
class convolution {
 public:
  // Greatest transform, and with it the greatest padded grid; tangential: tractions too.
  convolution(int max_nx, int max_ny, bool tangential);

  // Sets grid and transform sizes.
  void set_size(int nx, int ny, int transform_nx, int transform_ny);
  enum kernel_name { zz, zz_inverse, xx, yy, xy };
  // Takes over a kernel's spectrum as fft_plans lays it out: real, of an even kernel but for xy,
  // which is odd in both directions.
  void set_spectrum(kernel_name name, const double *spectrum);

  // u = A p with zz or its inverse, [ny][nx].
  void product(kernel_name name, const double *p, double *u);
  // (u_x, u_y) = A (p_x, p_y)
  void tangential_product(const double *px, const double *py, double *ux, double *uy);
  // (s_x, s_y) = (u(x) - u(x + direction dx))/dx; returns p . A p, by the waves (Parseval), in
  // double precision, else nan.
  double rolling_product(const double *px, const double *py, int direction, double dx, double *sx,
                         double *sy);
  size_t bytes() const;

 private:
  static constexpr bool exact = std::is_same_v<T, double>;
  using fft = batch_fft<T>;
  using lines = typename fft::lines;
  // Two fields on the grid, or the two halves of one.
  struct two_fields {
    int columns[2];  // of each
    int waves;       // numbers from one x to the next
    size_t second;   // from a wave number of the first field to that of the second
  };
  template <class Multiply>
  void convolve(const two_fields &f, const double *const in[2], double *const out[2],
                Multiply &&multiply);
  void load_lateral(const two_fields &f, const double *const in[2]);
  void store_lateral(const two_fields &f, lines z, double *const out[2]) const;
  void tell_apart(const two_fields &f, lines z);
  void join(const two_fields &f, lines from);
  template <bool squares, class Turn>
  void two_products(const double *const in[2], double *const out[2], Turn &&turn);

  int nx_ = 0, ny_ = 0, big_nx_ = 1, big_ny_ = 1;
  int half_ = 1;  // lateral wave numbers kept: 0 ... big_ny/2
  bool tangential_;
  fft along_x_, along_y_;
  aligned_buffer<T> lateral_[4], along_[4];  // data and work, real and imaginary
  aligned_buffer<T> spectrum_[5];            // [big_nx/2 + 1][half]
  aligned_buffer<T> turn_re_, turn_im_;      // 1 - exp(i k dx)
  aligned_buffer<double> square_;            // p . A p of each lateral wave
};

extern template class convolution<float>;
extern template class convolution<double>;

}  // namespace railpatch
