#include "fast/fastrip.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fast/fastsim.hpp"
#include "numeric/elementary.hpp"
#include "railpatch.h"

namespace railpatch {

namespace {

using std::numbers::pi;

// factors of the creepages in strip theory, times G/2 or G/(2(1 - nu)); Pa
struct strip_factors {
  double xi, spin_x, eta, spin_y;
};

strip_factors factors_of(const elastic_constants &elastic, const creepage_coefficients &c,
                         double axis_ratio) {
  const double half = 0.5 * elastic.shear_modulus, plane = half / (1.0 - elastic.poisson_ratio);
  const double pi2 = pi * pi;
  return {plane * c.c11 * 4.0 * (1.0 - elastic.poisson_ratio) / pi2,
          plane * c.c33 * 16.0 * (1.0 - elastic.poisson_ratio) * axis_ratio / pi2,
          half * c.c22 * 4.0 / pi2, half * c.c23 * 3.0 / (pi * std::sqrt(axis_ratio))};
}

// Integral of sqrt(h^2 - x^2) from 0 to x; the ends beyond h count as h.
double cap_integral(double h, double x) {
  if (!(h > 0)) return 0;
  const double u = std::clamp(x / h, -1.0, 1.0);
  return 0.5 * h * h * (u * std::sqrt(1.0 - u * u) + asin(u));
}

// One strip; x from its middle, positive towards the leading edge.
struct strip {
  double half = 0;   // m
  double stick = 0;  // m, half the length that sticks
  double a = 0, b = 0, t = 0;
  double boundary() const { return half - 2.0 * stick; }  // x where the slip area begins

  // Integrals from 0 to x of the outer root and of the difference of both over d.
  struct integrals {
    double outer, difference;
  };
  integrals up_to(double x) const {
    const double d = half - stick, outer = cap_integral(half, x);
    if (d > 1e-6 * half) return {outer, (outer - cap_integral(stick, x - d)) / d};
    // the limit d -> 0: sqrt((half - x)/(half + x))
    const double u = std::clamp(x / half, -1.0, 1.0);
    return {outer, half * (asin(u) + std::sqrt(1.0 - u * u))};
  }
};

// a, b, t: A, B, T above; bound: K0, Pa/m.
strip solve_strip(double half, double bound, double a, double b, double t) {
  strip s{half, 0.0, a, b, t};
  const double square = a * a + b * b, product = b * t;
  const double root = product * product + square * (bound * bound - t * t);
  if (!(half > 0) || !(root >= 0) || !(std::abs(t) <= bound || square > 0)) return s;
  // d = square/(product + sqrt(root)), and zero without creepage
  const double slope = product + std::sqrt(root);
  if (square > 0 && !(slope * half > square)) return s;
  s.stick = half - (square > 0 ? square / slope : 0.0);
  return s;
}

// Mean traction between two places of which the stick area holds at least a part, as `from` and
// `to` have it; returns whether the bound cut it.
bool stick_traction(const strip &s, const strip::integrals &from, const strip::integrals &to,
                    double length, double bound, double q[2]) {
  const double difference = (to.difference - from.difference) / length;
  q[0] = s.a * difference;
  q[1] = s.b * difference - s.t * (to.outer - from.outer) / length;
  const double size = hypot(q[0], q[1]);
  if (!(size > bound)) return false;
  q[0] *= bound / size;
  q[1] *= bound / size;
  return true;
}

// Traction of the slip area: the direction is FASTSIM's, the size that of the bound.
void slip_traction(const flexibilities &l, double length, const double w[2], double bound,
                   double p[2], double s[2]) {
  double trial[2] = {p[0], p[1]};
  if (march(l, length, w[0], w[1], bound, trial, s)) {
    p[0] = trial[0];
    p[1] = trial[1];
    return;
  }
  const double size = hypot(trial[0], trial[1]);
  for (int k = 0; k < 2; ++k) p[k] = size == 0 ? 0.0 : bound * (trial[k] / size);
}

}  // namespace

tangential_result solve_fastrip(const fast_problem &problem, tangential_fields fields,
                                creep_resultants & /*sums*/) {
  const grid &g = problem.g;
  const double *pressure = problem.pressure, *bound = problem.bound, *axes = problem.axes;
  const row_ends &rows = problem.rows;
  const flexibilities &l = problem.l;
  const rolling_input &input = problem.rolling;
  const strip_factors f = factors_of(problem.elastic, problem.coefficients, axes[0] / axes[1]);
  const int way = input.direction;
  // rolling towards -x is the mirror image: longitudinal creepage, spin and p_x change sign; x
  // below runs from a row's middle towards its leading edge
  const double spin = way * input.spin_creepage;
  const double xi = way * input.creepage[0] - spin * rows.centre;
  tangential_result result;
  for (int j = 0; j < g.ny; ++j) {
    const double y = g.y(j) - rows.centre, middle = 0.5 * (rows.leading[j] + rows.trailing[j]);
    const double half = 0.5 * way * (rows.leading[j] - rows.trailing[j]);
    double load = 0;
    for (int i = 0; i < g.nx; ++i) load += pressure[j * g.nx + i] > 0 ? bound[j * g.nx + i] : 0.0;
    const double eta = input.creepage[1] + input.spin_creepage * (middle + input.spin_offset);
    const strip strip = solve_strip(half, half > 0 ? 2.0 * load * g.dx / (pi * half * half) : 0.0,
                                    f.spin_x * spin * y - f.xi * xi, -f.eta * eta, f.spin_y * spin);
    const double spin_x = spin * y * l.l1 / l.l3, spin_y = spin * l.l2 / l.l3;
    double p[2] = {0, 0}, before = half;
    strip::integrals ahead = strip.up_to(half);
    for (int n = 0; n < g.nx; ++n) {
      const int i = way > 0 ? g.nx - 1 - n : n;
      const int at = j * g.nx + i;
      fields.px[at] = fields.py[at] = fields.sx[at] = fields.sy[at] = 0;
      fields.division[at] = static_cast<unsigned char>(RP_EXTERIOR);
      if (!(pressure[at] > 0)) continue;
      // the last element reaches to the trailing edge, as the first does to the leading one
      const double x = way * (g.x(i) - middle);
      const double face = x - g.dx > -half ? x - 0.5 * g.dx : -half;
      double s[2] = {0, 0};
      bool slip = !(strip.stick > 0 && x + 0.5 * g.dx > strip.boundary());
      if (slip) {
        const double w[2] = {xi - spin_x, eta + spin_y * 0.5 * (before + x)};
        slip_traction(l, before - x, w, bound[at], p, s);
      } else {
        const strip::integrals behind = strip.up_to(face);
        const bool cut = stick_traction(strip, behind, ahead, g.dx, bound[at], p);
        slip = cut || x < strip.boundary();
        ahead = behind;
      }
      before = x;
      fields.px[at] = way * p[0];
      fields.py[at] = p[1];
      fields.sx[at] = way * s[0];
      fields.sy[at] = s[1];
      // the place of the spin term does no work (tangential_solver::take_offset_work)
      const double own = eta - input.spin_creepage * input.spin_offset;
      result.friction -= (p[0] * (xi - spin * y) + p[1] * (own + spin * x)) * g.dx * g.dy;
      fields.division[at] = static_cast<unsigned char>(slip ? RP_SLIP : RP_STICK);
      ++(slip ? result.slip : result.stick);
    }
  }
  result.converged = true;
  return result;
}

}  // namespace railpatch
