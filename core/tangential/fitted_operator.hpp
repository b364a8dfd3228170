// Micro-slip of the fitted rows (contact_rows.hpp), by dense products.
//
// Collocation: at the Gauss-Chebyshev points of the first kind, n + 1 in a row,
//   X_i = x_row + direction a_row cos((2i+1) pi/(2(n+1))), i = 0 ... n,
// which lie between the nodes and the edges. There the slope of the displacement in a row is exact
// for any polynomial times the square root at the edges (Erdogan and Gupta 1972, Q. Appl. Math.
// 29), and in two dimensions one row of eight nodes gives Carter's force to 0.3 per cent. Strips
// act as line loads across rolling. With observer minus source (X, Y +- h/2), r their distance and
// [[f]] the difference between the strip's two edges (derivatives of Kalker 1990, appendix C)
//   du_x/dx from p_x: (1/(pi G)) [[-XY/r^3 + (1-nu)(XY/r^3 - Y/(X r))]]
//   du_y/dx from p_y: (1/(pi G)) [[(XY/r^3 - Y/(X r)) - (1-nu) XY/r^3]]
//   du_x/dx from p_y = du_y/dx from p_x: (nu/(pi G)) [[-Y^2/r^3]]
// Where nodes are wider apart than the strip is away, the traction is interpolated to a finer set
// of nodes first, by cubics in the angle.
//
// Steady rolling: s(X_i) = w(X_i) - direction du/dx. Node k sticks where s(X_k) = 0, half a step
// ahead of it, so that what enters at the leading edge is carried on downstream. Traction in slip
// opposes the slip at the node itself, between X_k and X_(k+1); taking it at X_k would turn the
// traction by what the slip changes over half a step. The slip of node k therefore is
//   s_k = s(X_k) + lambda d,  d = tau (s(X_(k+1)) - s(X_k)),
//   lambda = |s(X_k)|^2/(|s(X_k)|^2 + 4 |d|^2),
// which vanishes together with s(X_k) and tends to the slip at the node as slip grows.
//
// Displacement, for the energy alone: at the leading edge, the only point of a row that has it in
// closed form without a singular node, and from there on by summing the slope. There
//   u_x from p_x: (1/(pi G)) [[(1-nu) asinh(Y/|X|) + nu Y/r]]
//   u_y from p_y: (1/(pi G)) [[asinh(Y/|X|) - nu Y/r]]
//   u_x from p_y = u_y from p_x: (nu/(pi G)) [[-X/r]]
// The third-body layer adds its flexibility times -direction dp/dx, by differences of the nodes.
#pragma once

#include "tangential/contact_rows.hpp"
#include "tangential/rolling_newton.hpp"
#include "tangential/tangential.hpp"

namespace railpatch {

class fitted_operator final : public rolling_operator {
 public:
  // line: rows are of infinite height (plane strain).
  fitted_operator(const elastic_constants &elastic, double layer_flexibility, bool line,
                  const contact_rows &rows);

  // Prepares the influence coefficients (kept where the rows are as they were) and rigid slip.
  void set(const contact_rows &rows, const rolling_input &input);

  void micro_slip(const rolling_problem &problem, const double *p, double *s) override;
  void linearise() override;
  void slip_of_creepage(const rolling_problem &, int component, double *s) const override;
  void product(const double *v, double *ds) override;
  bool product_of_rows_before(int row, const double *v, double *ds) override;
  void row_matrices(int row, double *bxx, double *byy) const override;
  double projection_scale(int row) const override;
  // J, 1/2 sum p . u dA of the traction of the last call of micro_slip; NaN for a line contact,
  // whose displacement is known up to a constant only.
  double elastic_energy(const contact_rows &rows, const double *p) const;
  size_t bytes() const;

 private:
  // how the slip of one node follows from that at its two collocation points
  struct slip_blend {
    double ahead[4], between[4];  // 2 x 2, of ds(X_k) and of dd
  };
  struct refinement {
    int factor;
    aligned_buffer<int> column;     // [fine nodes][4], node or -1
    aligned_buffer<double> weight;  // [fine nodes][4]
    aligned_buffer<double> cosine, sine;
  };
  void make_refinement(refinement &r, int factor);
  void make_blocks();
  void assemble(int target, int source);
  void make_kernels(int count, double upper, double lower, bool own);
  void gather(const refinement &r, int first, int count, double scale, bool coupled,
              double *px) const;
  void mirror(int target, int source);
  void add_layer(int row);
  void collocation_slip(int row, const double *v, int begin, int end, double *t) const;
  void edge_displacement(const contact_rows &rows, int row, const double *p, double u[2]) const;
  void blend_change(int row, const double *t, double *ds) const;
  // [source component][stride], the slip at row target's collocation points
  const double *block(int target, int source) const;

  elastic_constants elastic_;
  double flexibility_;
  bool line_;
  int nodes_, points_, stride_;  // points = nodes + 1 collocations; stride of a block's columns
  int count_ = 0;
  int direction_ = 0;
  aligned_buffer<contact_row> rows_;
  aligned_buffer<double> point_cosine_, tau_;
  static constexpr int factors = 8;
  refinement fine_[factors];
  aligned_buffer<double> matrix_;     // blocks [target row][source row]
  aligned_buffer<double> rigid_;      // [row][stride], at the collocation points
  aligned_buffer<double> slip_;       // [row][stride], of the last call of micro_slip
  double creepage_[2] = {0, 0};       // found for a prescribed force, of that call
  aligned_buffer<double> change_;     // scratch of one row
  aligned_buffer<double> kernel_[4];  // scratch of some nodes: distance, xx, yy, xy
  aligned_buffer<slip_blend> blends_;
};

}  // namespace railpatch
