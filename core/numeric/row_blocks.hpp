// Single-precision LU of each row's diagonal block of the linearised tangential problem: the
// preconditioner of the Newton steps. Rows of elements along rolling interact weakly with each
// other, so the blocks hold most of the operator.
//
// Where all rows' matrices begin alike, as those of equal elements do, the elements that stick from
// the leading edge on are eliminated by factors that all rows share: their equations differ from
// row to row in number only. What is left to a row is the Schur complement of the others, which was
// left over when those factors were made.
//
// No pivots are exchanged: along a row B is close to the Cauchy matrix 1/(i - j + 1/2), whose
// pivots all lie between 2 and pi; a layer and slip only add to the diagonal.
#pragma once

#include "numeric/memory.hpp"

namespace railpatch {

// How one element enters the linearised equations (see tangential/rolling_newton.hpp). A
// slipping element has one unknown z, its traction turning along the unit vector c: dp = z c, and
// the equation
//   keep z + stiff c . (B dp) = right side.
// A sticking element has two: dp = (z, z_y), c = (1, 0), with stiff (B dp)_y as second equation.
struct element_linearisation {
  double c[2];
  double keep;   // -, 1 - theta; 0 in stick
  double stiff;  // Pa, r theta; r in stick
  bool stick;
};

// What is kept of a matrix and its factors. Of the first n columns, those before `meet` do not meet
// the columns behind n; of the first `border` rows and columns, those further apart than `band` do
// not meet. order, band and border: whole packs.
struct block_shape {
  int order, n, meet, band, border;
};

// A row's vector holds z of all its elements and then z_y of those that stick.
class row_blocks {
 public:
  row_blocks(int max_row, int max_rows);

  // Forgets all rows: another problem begins, with the first elements of its rows.
  void start(int rows, const int *row_start);
  // Whether a row's last factors serve these equations too: its elements are in the same state and
  // slip in nearly the same direction.
  bool serves(int row, const element_linearisation *elements) const;
  // The matrices of a row of n elements begin with those of every row: factors them once, for the
  // elements that stick from the leading edge on.
  void share(int n, const double *bxx, const double *byy);
  // Factors the block of one row by what is shared; false where nothing is.
  bool set_row(int row, const element_linearisation *elements);
  // Factors the block of one row; B of the row as in rolling_operator.
  void set_row(int row, const double *bxx, const double *byy,
               const element_linearisation *elements);
  // Unknowns of a row.
  int size(int row) const { return blocks_[static_cast<size_t>(row)].size; }
  // v <- M^-1 v, of one row.
  void solve(int row, double *v);
  size_t bytes() const;

 private:
  struct block {
    int size;           // unknowns; 0: not factored yet
    int lead;           // elements that the shared factors serve
    block_shape shape;  // of the row's own factors: other unknowns and some of the unit matrix
  };
  const block_shape &shape_of(int row) const { return blocks_[static_cast<size_t>(row)].shape; }
  void prepare(int row, int lead, int meet, int band, const element_linearisation *elements);
  void factor_row(int row);

  float *factors(int row) {
    return factors_.data() + static_cast<size_t>(row) * (factors_.size() / blocks_.size());
  }

  aligned_buffer<block> blocks_;
  aligned_buffer<float> factors_;           // packed, row by row
  aligned_buffer<float> block_, inverses_;  // what is being factored
  aligned_buffer<float> vector_, row_x_, row_y_;
  // LU of B over its first entry, xx and yy, and what was left to be factored before each panel
  aligned_buffer<float> shared_[2], shared_inverses_[2], trailing_[2];
  int shared_order_ = 0;  // 0: nothing is shared
  double shared_scale_ = 1;
  aligned_buffer<int> sticking_;
  aligned_buffer<element_linearisation> factored_;
  int max_order_;
  int rows_ = 0;
  const int *row_start_ = nullptr;
};

}  // namespace railpatch
