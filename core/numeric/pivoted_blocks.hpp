// Single-precision LU, with pivots exchanged by rows, of each row's diagonal block of a linearised
// problem with two unknowns in every element: a preconditioner. What makes row_blocks.hpp safe
// without pivots does not hold with falling friction or a softening layer.
#pragma once

#include "numeric/memory.hpp"

namespace railpatch {

class pivoted_blocks {
 public:
  pivoted_blocks(int max_row, int max_rows);

  // The matrix of a row of n elements to be filled, column-major [2n][2n], before factor.
  float *matrix(int row) { return factors_.data() + static_cast<size_t>(row) * block_; }
  void factor(int row, int n);
  // v <- M^-1 v, of one row.
  void solve(int row, int n, double *v);
  size_t bytes() const { return factors_.bytes() + pivots_.bytes() + vector_.bytes(); }

 private:
  int max_order_;
  size_t block_;
  aligned_buffer<float> factors_, vector_;
  aligned_buffer<int> pivots_;
};

}  // namespace railpatch
