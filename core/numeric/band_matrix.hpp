// Band matrices and their factors, for preconditioners: no pivoting, so an answer is only as good
// as the pivots are; who asks measures what is left.
//
// Row r holds columns r - below ... r + above side by side.
#pragma once

#include <cstddef>

#include "numeric/memory.hpp"

namespace railpatch {

class band_matrix {
 public:
  // of the greatest number of rows and of numbers in all: rows times (below + above + 1)
  band_matrix(size_t max_rows, size_t max_numbers);
  // sets all to zero
  void set_size(size_t rows, size_t below, size_t above);
  double &at(size_t row, size_t column) { return numbers_[row * width_ + column + below_ - row]; }
  bool holds(size_t row, size_t column) const {
    return row < rows_ && column < rows_ && column + below_ >= row && column <= row + above_;
  }
  // L U in place (Golub and Van Loan 2013, algorithm 4.3.1); false where a pivot vanishes
  bool factor();
  // v <- U^-1 L^-1 v
  void solve(double *v) const;
  size_t bytes() const { return numbers_.bytes() + inverse_.bytes(); }

 private:
  size_t rows_ = 0, below_ = 0, above_ = 0, width_ = 1;
  aligned_buffer<double> numbers_, inverse_;
};

}  // namespace railpatch
