// Displacement that tractions on a grid cause at points off it by a constant distance along x:
// where the material was one step of transient rolling ago, before it came to the elements'
// centres. Exact for tractions constant on elements, by FFT; the layer's part is interpolated
// between them, as all that belongs to elements is (for a step of one element both are exact).
// With `moves` also from one grid to another that lies anywhere: the patches of wheels move.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/plane_transform.hpp"

namespace railpatch {

// Tractions and pressure on rows of a curved reference surface, and sums of what they cause at
// those of another one; inclinations of both are seen from one direction.
struct curved_past {
  const double *px, *py, *pressure;  // Pa, [ny][nx] of the grid that they lie on
  const double *cosine[2];           // of its rows, and of the rows that see them
  const double *sine[2];
};
struct curved_sums {
  double *from_traction[2];  // m, tangential
  double *from_pressure[2];  // m, tangential
  double *gap;               // m, from the tractions
};

class offset_influence {
 public:
  explicit offset_influence(const fft_plans &plans, bool moves = false);

  // (u_x, u_y) at x + offset; the grid is that of a. Kernels are only made anew when offset,
  // element size or transform change.
  void product(const influence &a, const grid &g, double offset, const double *px, const double *py,
               double *ux, double *uy);
  // Adds share (u_x, u_y) at the elements of `to`, whose element (0, 0) lies at offset from that of
  // `from`, with elements of the same size. Needs `moves`.
  void add_moved(const influence &a, const grid &from, const grid &to, const double offset[2],
                 double share, const double *px, const double *py, double *ux, double *uy);
  // The same from one curved reference surface to another (conformal_influence.hpp), whose rows are
  // seen at their distance in arc length; with what the pressure moves along, and the tractions
  // apart.
  void add_curved(const influence &a, const grid &from, const grid &to, const double offset[2],
                  double share, const curved_past &past, const curved_sums &sums);
  size_t bytes() const;

 private:
  using fft = plane_transform::fft;
  using lines = plane_transform::lines;
  void make_spectra(const influence &a, const grid &g);
  void make_moved_spectra(const influence &a);
  void place(const influence &a, const grid &from, const grid &to, const double offset[2]);
  void add_layer(const influence &a, const grid &from, const grid &to, const double offset[2],
                 double share, const double *px, const double *py, double *ux, double *uy) const;
  void transform_kernel(int k) { plane_.spectrum_of_kernel(re_[k].data(), im_[k].data()); }
  // the product itself; its result lies in the first columns of the rows returned
  lines transfer(const grid &from, const grid &to, const double *px, const double *py);
  void multiply(lines from, lines to, int stride) const;

  const fft_plans &plans_;
  int plan_ = -1;
  double offset_ = 0, dx_ = 0, dy_ = 0;
  plane_transform plane_;
  aligned_buffer<double> re_[3], im_[3];  // [big_nx][big_ny]
  // of grids that move: size of both, lateral offset, corners of the elements
  int from_[2] = {0, 0}, to_[2] = {0, 0};
  double lateral_offset_ = 0;
  aligned_buffer<double> corner_[3];
};

// Field values at x + offset, straight between element centres; `outside` beyond the grid.
void shift_field(const grid &g, double offset, double outside, const double *from, double *to);

}  // namespace railpatch
