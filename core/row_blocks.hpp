// Exact single-precision LU of each row's diagonal block of the linearised tangential problem: the
// preconditioner of the Newton steps. Rows of elements along rolling interact weakly with each
// other, so the blocks hold most of the operator.
#pragma once

#include "memory.hpp"

namespace railpatch {

// How one element enters the linearised equations (see rolling_newton.hpp):
// row of the block = keep + stiff B, both 2 x 2 symmetric.
struct element_linearisation {
  double keep[3];   // xx, xy, yy of I - theta (I - n n^T), zero in stick
  double stiff[3];  // Pa; xx, xy, yy of r theta (I - n n^T), r times unit in stick
};

class row_blocks {
 public:
  row_blocks(int max_row, int max_rows);

  void clear() { used_ = 0, pivots_used_ = 0; }
  // Appends and factors the block of one row of n elements; B of the row as in rolling_operator.
  void add_row(int n, const double *bxx, const double *byy, const element_linearisation *elements);
  // v <- M^-1 v; v is the concatenation of the rows' (p_x, p_y) parts in the order of add_row.
  void solve(const int *row_start, int rows, double *v);
  size_t bytes() const;

 private:
  aligned_buffer<float> factors_;
  aligned_buffer<int> pivots_;
  aligned_buffer<float> vector_;
  size_t used_ = 0, pivots_used_ = 0;
};

}  // namespace railpatch
