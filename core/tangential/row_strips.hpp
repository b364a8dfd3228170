// What stands for B within a row in the preconditioner, on the uniform grid in steady rolling.
//
// The tractions that a step changes differ little from a row to its neighbours, whose slip one row
// alone does not see. So the preconditioner's rows are strips: the mean slip in a strip of several
// rows from tractions that are the same in all of them. xy has no part in it.
#pragma once

#include <algorithm>

#include "tangential/row_elements.hpp"

namespace railpatch {

class row_strips {
 public:
  // across: strips over all rows, few enough to hold what neighbouring rows do together, enough to
  // follow the edge of slip.
  row_strips(int max_nx, int across);
  // transposed: those of B^T.
  void set(influence &a, const grid &g, int rows, bool transposed = false) {
    set([&](kernel k, int ahead, int j) { return a.coefficient(k, ahead, j); }, g, rows,
        transposed);
  }
  // coefficient(kernel, elements that the source lies ahead of the observer, rows aside)
  template <class Coefficient>
  void set(Coefficient &&coefficient, const grid &g, int rows, bool transposed = false) {
    nx_ = g.nx;
    const int strip = 1 + rows / across_;
    set_line(coefficient, g, kernel::xx, strip, transposed, line_[0].data() + nx_);
    set_line(coefficient, g, kernel::yy, strip, transposed, line_[1].data() + nx_);
  }
  // n x n, column-major, source by source; direction: of rolling.
  void matrices(const row_elements &elements, int row, int direction, double *bxx,
                double *byy) const;
  size_t bytes() const { return 2 * line_[0].bytes(); }

 private:
  // Rows of a strip that lie j apart are strip - j pairs.
  template <class Coefficient>
  void set_line(Coefficient &&coefficient, const grid &g, kernel k, int strip, bool transposed,
                double *line) const {
    std::fill(line - g.nx, line + g.nx + 1, 0.0);
    for (int j = 0; j < strip; ++j) {
      const double weight = (j == 0 ? 1.0 : 2.0) * (strip - j) / (strip * g.dx);
      // one element further upstream it is one less that the source lies ahead
      double before = coefficient(k, -g.nx - 1, j);
      for (int ahead = -g.nx; ahead <= g.nx; ++ahead) {
        const double here = coefficient(k, ahead, j);
        line[transposed ? -ahead : ahead] += weight * (here - before);
        before = here;
      }
    }
  }

  int across_, nx_ = 0;
  // by the number of elements, -nx ... nx, that the source lies ahead of the observer
  aligned_buffer<double> line_[2];  // xx, yy
};

}  // namespace railpatch
