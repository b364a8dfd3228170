#include "tangential/rolling_operator.hpp"

#include <algorithm>

namespace railpatch {

void rolling_operator::micro_slip(const rolling_problem &problem, const double *p, double *s) {
  product(p, s);
  for (int i = 0; i < 2 * problem.count(); ++i) s[i] += problem.rigid_slip[i];
  if (!problem.force) return;
  for (int row = 0; row < problem.rows; ++row) {
    const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
    for (int k = 0; k < n; ++k) {
      s[2 * begin + k] += problem.creepage(0);
      s[2 * begin + n + k] += problem.creepage(1);
    }
  }
}

void rolling_operator::slip_of_creepage(const rolling_problem &problem, int component,
                                        double *s) const {
  for (int row = 0; row < problem.rows; ++row) {
    const int begin = problem.row_start[row], n = problem.row_start[row + 1] - begin;
    std::fill_n(s + 2 * begin, n, component == 0 ? 1.0 : 0.0);
    std::fill_n(s + 2 * begin + n, n, component == 1 ? 1.0 : 0.0);
  }
}

}  // namespace railpatch
