// Within the solver of inelastic laws: one solve's problem, and the law at all of its elements.
#pragma once

#include <cmath>

#include "numeric/elementary.hpp"
#include "tangential/inelastic_newton.hpp"

namespace railpatch {

// One element at q = p - length r s.
struct inelastic_element {
  int row;
  size_t k, ix, iy;
  const carried_state *before;
  double e[2], size, stiffness;  // q = size e; R
  double m;                      // m, inelastic slip; 0 in stick
  bool stick;
  bound_point point;  // only where states are carried along
  double bound() const { return stick ? size : size - stiffness * m; }
};

struct inelastic_task : row_task {
  const inelastic_problem &inelastic;
  const bound_law &law;
  const double *friction;
  inelastic_result sums{};
  int projections = 0, descents = 0;
  int row = -1;        // whose matrices row_matrix_ holds for own_stiffness
  bool falls = false;  // the law, somewhere

  bool carried() const { return !inelastic.before; }
};

// Goes through all elements, rows from their first element on, at q = p - length r s.
template <class Each>
void inelastic_newton::apply_law(const task &t, const double *p, const double *s, double length,
                                 Each &&each) const {
  inelastic_element at;
  const carried_state fresh{{0, 0, 0}};
  carried_state upstream = fresh;
  int row = 0;
  t.for_each_element([&](size_t k, size_t ix, size_t iy) {
    while (static_cast<int>(k) >= t.problem.row_start[row + 1]) ++row;
    if (static_cast<int>(k) == t.problem.row_start[row]) upstream = fresh;
    const double r = length * r_[k];
    const double q[2] = {p[ix] - r * s[ix], p[iy] - r * s[iy]};
    at.row = row, at.k = k, at.ix = ix, at.iy = iy;
    at.before = t.carried() ? &upstream : t.inelastic.before + k;
    at.size = hypot(q[0], q[1]);
    at.stiffness = r / t.law.step;
    at.stick = at.size <= t.law.at_rest(t.friction[k], *at.before);
    for (int c = 0; c < 2; ++c) at.e[c] = at.size > 0 ? q[c] / at.size : c == 0 ? 1.0 : 0.0;
    at.m = at.stick ? 0.0 : t.law.resolve(t.friction[k], *at.before, at.e, at.size, at.stiffness);
    if (t.carried()) at.point = t.law.evaluate(t.friction[k], *at.before, at.e, at.m);
    each(at);
    if (t.carried()) upstream = at.point.state;
  });
}

}  // namespace railpatch
