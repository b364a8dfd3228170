// Stresses and displacements below the surface under the pressure and tractions of a uniform grid,
// below each of its elements at given depths: products with the coefficients of
// below_kernels.hpp by FFT. Two real components go back as one complex one.
//
// Single precision: some 1e-6 of the greatest stress at the depth.
#pragma once

#include <vector>

#include "half_space/below_kernels.hpp"
#include "half_space/influence.hpp"
#include "numeric/batch_fft.hpp"
#include "numeric/fft.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

class below_surface {
 public:
  // depths: m, >= 0; plans for the greatest grid; displacements: beside the stresses.
  // line_width: m, > 0 for plane strain, where there are no displacements.
  below_surface(const body_constants &body, std::vector<double> depths, const fft_plans &plans,
                bool displacements, bool plane_strain);

  // Coefficients of a grid; false where the grid exceeds the plans. Cheap where its elements have
  // the size of the last one's.
  bool set_grid(const grid &g);
  // Into the body p, on it qx and qy (may be null), Pa, [ny][nx]; out: component by component,
  // [components][depths][ny][nx].
  void product(const double *p, const double *qx, const double *qy, double *out);

  int components() const { return components_; }
  int depths() const { return static_cast<int>(depths_.size()); }
  double depth(int k) const { return depths_[static_cast<size_t>(k)]; }
  size_t bytes() const;

 private:
  using number = float;
  using fft = batch_fft<number>;
  using lines = fft::lines;
  static constexpr int loads = below::loads;

  void make_coefficients(int depth);
  void fill_corners(double z);
  void load(const double *p, const double *qx, const double *qy);
  void multiply(int depth, lines from);
  void back(int depth, double *out);
  int big_nx() const { return plans_.nx(plan_); }
  int big_ny() const { return plans_.ny(plan_); }
  int waves() const { return big_ny() / 2 + 1; }  // lateral ones, of a real field
  int columns() const { return fft::whole_packs(grid_.nx); }
  int pairs() const { return (components_ + 1) / 2; }
  // of the transforms along x, side by side: the waves of each load or component
  int loaded() const { return fft::whole_packs(loads * waves()); }
  int found() const { return fft::whole_packs(2 * pairs() * waves()); }

  body_constants body_;
  std::vector<double> depths_;
  const fft_plans &plans_;
  int components_;
  bool plane_strain_;
  grid grid_;
  int plan_ = -1;
  fft along_x_, along_y_;
  // [depths][big_nx/2 + 1][loads][components][waves], real or imaginary as below::odd has it
  aligned_buffer<number> spectrum_;
  aligned_buffer<below_coefficients> corner_;
  aligned_buffer<double> padded_;
  aligned_buffer<std::complex<double>> transform_;
  aligned_buffer<number> lateral_[4], along_[4], load_[2];
};

}  // namespace railpatch
