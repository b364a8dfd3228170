// Writes fluid/strip_table.inc: strips under an elliptic pressure, solved on even steps and on half
// of them, from both of which the second-order error is taken (Richardson). Not part of the
// library:
//   c++ -std=c++20 -O2 -ffp-contract=off -Icore -Icore/include core/fluid/strip_table_writer.cpp
//       core/fluid/{wet_strip,asperities}.cpp core/numeric/{elementary,memory}.cpp
//   ./a.out > core/fluid/strip_table.inc
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "fluid/strip_table.hpp"
#include "fluid/wet_strip.hpp"
#include "numeric/elementary.hpp"

using namespace railpatch;

namespace {

// X_c as theta, share, profile.
std::vector<double> numbers_of(int steps, double s, double r) {
  strip_solver solver(steps);
  // slow liquids have little pressure to tell X_c by
  const double precision = 1e-14 * std::min(s, 1.0);
  const strip_solution found = solver.solve(elliptic_strip{}, s, r, -2, precision);
  const double *theta = solver.theta(), *p = solver.liquid();
  double sum = 0;  // of P dX
  for (int k = 1; k < solver.nodes(); ++k)
    sum += 0.5 * (theta[k] - theta[k - 1]) *
           (p[k] * railpatch::sin(theta[k]) + p[k - 1] * railpatch::sin(theta[k - 1]));
  std::vector<double> v{railpatch::acos(-found.cavitation),
                        1.0 - sum / (0.5 * 3.14159265358979323846)};
  const int last = strip_table::profile_nodes - 1;
  for (int k = 0; k <= last; ++k) {
    const double at = 0.5 * (1.0 - railpatch::cos(3.14159265358979323846 * k / last)) * steps;
    const int first = std::min(std::max(static_cast<int>(at) - 1, 0), steps - 3);
    const double x = at - first;
    const double a = x, b = x - 1, c = x - 2, d = x - 3;
    v.push_back(k == 0 ? 0.0
                       : -b * c * d / 6 * p[first] + a * c * d / 2 * p[first + 1] -
                             a * b * d / 2 * p[first + 2] + a * b * c / 6 * p[first + 3]);
  }
  return v;
}

}  // namespace

int main() {
  for (int i = 0; i < strip_table::rows; ++i)
    for (int j = 0; j < strip_table::columns; ++j) {
      const double s = strip_table::s_of(i), r = strip_table::r_of(j);
      const int steps = s > 10 ? 4096 : 2048;
      const std::vector<double> coarse = numbers_of(steps / 2, s, r),
                                fine = numbers_of(steps, s, r);
      for (size_t k = 0; k < fine.size(); ++k)
        std::printf("%.6g,%s", (4 * fine[k] - coarse[k]) / 3, k + 1 < fine.size() ? " " : "\n");
    }
}
