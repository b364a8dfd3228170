// Friction that depends on the surface temperature, which depends on the friction's heat: the
// outer loop between the tangential problem and the temperature.
//
// With the heat per friction coefficient h = q/mu held, the temperature of an element depends on
// coefficients at and ahead of it only, so mu = law(T(h mu)) is solved exactly, however steep the
// law, element by element from the leading edge; the tangential problem then gives new h. In full
// sliding h does not change and one pass is exact; otherwise the passes are a fixed point with
// Anderson's acceleration (1965), on two former passes, and damping where it does not settle.
#pragma once

#include <algorithm>
#include <cmath>

#include "temperature/temperature.hpp"

namespace railpatch {

struct temperature_loop_options {
  double tolerance = 1e-5;  // of the coefficient, relative to the law's greatest
  int max_iterations = 100;
};

struct temperature_loop_result {
  bool converged = false;
  int iterations = 0;  // tangential problems solved
  // greatest change of a friction coefficient that the next pass would make, and where that is
  // within the tolerance also how far one is from the law at the temperatures of its own heat,
  // relative to the law's greatest; of a converged result the tangential problem is the one of
  // these coefficients
  double residual = 0;
};

class temperature_loop {
 public:
  temperature_loop() = default;
  explicit temperature_loop(int max_count);

  struct problem {
    temperature_law law;
    heat_rows rows;
    const heat_kernel *kernel;
    double effusivity;         // sum of both bodies
    const double *background;  // surface temperature without this step's heat, degrees C
    const double *pressure;    // > 0: contact
  };
  // tangential(mu, q): solves with these coefficients and fills the flux, false where it failed.
  // mu: start in, solution out; the last call of tangential is the solution's.
  template <class Tangential>
  temperature_loop_result solve(const problem &p, const temperature_loop_options &options,
                                double *mu, double *q, Tangential &&tangential);
  size_t bytes() const { return 7 * next_.bytes(); }

 private:
  void pass(const problem &p, const double *mu, const double *q, bool keep);
  double change(int n, const double *mu) const;
  double missed(const problem &p, const double *mu, const double *q) const;
  void advance(const problem &p, double *mu);
  void restart(int n, double *mu);

  int former_ = 0;      // passes kept
  double damping_ = 1;  // share of a pass that is taken
  double best_ = 0;     // least change so far
  int since_best_ = 0;
  aligned_buffer<double> next_, best_mu_, heat_, f_[2], g_[2];
};

// The root of mu = law(a + b mu), b >= 0. A rising law may have three where the own heat of one
// element is great (b goes with the root of its size): of the two stable ones that nearest to mu.
double consistent_coefficient(const temperature_law &law, double a, double b, double mu);

template <class Tangential>
temperature_loop_result temperature_loop::solve(const problem &p,
                                                const temperature_loop_options &options, double *mu,
                                                double *q, Tangential &&tangential) {
  const int n = p.rows.nx * p.rows.ny;
  const double scale =
      std::max(std::fabs(p.law.reference), std::fabs(p.law.reference + p.law.change));
  former_ = since_best_ = 0;
  damping_ = 1;
  temperature_loop_result result;
  // one is left for going back to the best
  const int most = std::max(options.max_iterations - 1, 1);
  int failures = 0;    // in a row
  bool again = false;  // the best coefficients for the second time
  for (;;) {
    const bool solved = tangential(static_cast<const double *>(mu), q);
    ++result.iterations;
    // an element with two roots takes the cold one, from which material enters it, until the
    // passes should have settled: then each keeps its own
    pass(p, mu, q, result.iterations > 6);
    const double now = change(n, mu);
    const auto relative = [&](double value) { return scale > 0 ? value / scale : value; };
    result.residual = relative(now);
    // a pass follows its own coefficients downstream: a steep law is missed by more than it changes
    if (result.residual <= options.tolerance)
      result.residual = std::max(result.residual, relative(missed(p, mu, q)));
    result.converged = solved && result.residual <= options.tolerance;
    if (result.converged || !(now >= 0)) return result;
    // tractions that are only so exact give the best coefficients another change the second time
    if (result.iterations == 1 || again || now < best_) {
      best_ = now;
      since_best_ = 0;
      std::copy_n(mu, n, best_mu_.data());
    } else {
      ++since_best_;
    }
    failures = solved ? 0 : failures + 1;
    if (result.iterations >= most || failures > 2) break;
    again = now > 2.0 * best_ || since_best_ > 4;
    if (again)
      restart(n, mu);
    else
      advance(p, mu);
  }
  // the best pass is the result, with the tangential solution that belongs to it
  if (since_best_ > 0) {
    std::copy_n(best_mu_.data(), n, mu);
    tangential(static_cast<const double *>(mu), q);
    ++result.iterations;
    pass(p, mu, q, true);
    result.residual = scale > 0 ? change(n, mu) / scale : change(n, mu);
  }
  return result;
}

}  // namespace railpatch
