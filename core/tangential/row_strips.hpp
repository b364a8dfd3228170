// What stands for B within a row in the preconditioner, on the uniform grid in steady rolling.
//
// The tractions that a step changes differ little from a row to its neighbours, whose slip one row
// alone does not see. So the preconditioner's rows are strips: the mean slip in a strip of several
// rows from tractions that are the same in all of them. xy has no part in it.
#pragma once

#include "tangential/row_elements.hpp"

namespace railpatch {

class row_strips {
 public:
  // across: strips over all rows, few enough to hold what neighbouring rows do together, enough to
  // follow the edge of slip.
  row_strips(int max_nx, int across);
  // transposed: those of B^T.
  void set(influence &a, const grid &g, int rows, bool transposed = false);
  // n x n, column-major, source by source; direction: of rolling.
  void matrices(const row_elements &elements, int row, int direction, double *bxx,
                double *byy) const;
  size_t bytes() const { return 2 * line_[0].bytes(); }

 private:
  void set_line(influence &a, const grid &g, kernel k, int strip, bool transposed,
                double *line) const;

  int across_, nx_ = 0;
  // by the number of elements, -nx ... nx, that the source lies ahead of the observer
  aligned_buffer<double> line_[2];  // xx, yy
};

}  // namespace railpatch
