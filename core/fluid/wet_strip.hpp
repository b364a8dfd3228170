// Liquid along one strip of a rough contact that rolls: which part of the nominal pressure it bears
// and where (the balance of Tomberger, Dietmaier, Sextro and Six 2011, Wear 271; equations of
// docs/fluids.md).
//
// The nominal pressure p_n(x) of the dry contact stays. With X = x/a along rolling from the leading
// edge (-1), p_0 a unit of pressure, P = p_f/p_0 the liquid's, S = 12 eta V a/(sigma^2 p_0),
// r = p_0/H, d, t(d) = h_T/sigma of fluid/asperities.hpp:
//   p_n/p_0 = P + (1 - Phi(d))/r,   t - K(t)/S dP/dX = C,   P(-1) = 0,
//   P = dP/dX = 0 at X_c, where the liquid cavitates, P = 0 beyond.
// K is the flow factor of Wilson and Marsault 1998 for isotropic roughness: 0.37739 (t - t_c)^2 +
// 1.00190 (t - t_c)^3 above t_c = 0.27774, else 0, where flow is barred and C is t of the strip.
//
// Solved from X_c against rolling: that way errors die out, along rolling they grow. X =
// -cos(theta) takes the root of the pressure's ends away. Each step is the trapezoidal rule in
// theta, of which d at its end is the unknown; X_c is found so that P vanishes at the leading edge:
// where it is too far ahead, P falls below zero before, where too far behind it meets the nominal
// pressure. Each march carries the rates by theta of X_c along, so X_c is found by Newton's method,
// and its last, small step is taken by these rates, without a march.
#pragma once

#include <cmath>

#include "numeric/memory.hpp"

namespace railpatch {

// Nominal pressure over p_0 at X = -cos(theta), and theta where it is greatest.
struct strip_pressure {
  // of theta; slope: its rate by theta
  virtual double at(double cosine, double sine, double &slope) const = 0;
  virtual double peak() const = 0;

 protected:
  ~strip_pressure() = default;
};

struct elliptic_strip final : strip_pressure {
  double at(double cosine, double sine, double &slope) const override;
  double peak() const override;
};

// The search for theta of X_c by Newton's steps, while they stay within its bracket, and shrink.
class end_search {
 public:
  static constexpr int most_steps = 12;
  end_search() = default;
  // begin: where, or 0 for anywhere; low: least, where the pressure is greatest
  end_search(double begin, double low);
  double at() const { return at_; }
  // Takes P at the leading edge and its rate, or 0 where there is none. Whether X_c is found, to
  // `precision` of P and itself: farther `by`, which the march's rates are to take.
  bool take(double value, double slope, double precision);
  double by() const { return by_; }
  double residual() const { return residual_; }
  // a march's, of d, before that last step, which squares it
  static double tolerance_of_distance(double precision);

 private:
  double at_ = 0, least_ = 0, most_ = 0, high_ = 0, last_ = HUGE_VAL;
  double back_ = 0.03;  // where a march has no rate
  double by_ = 0, residual_ = 0;
};

struct strip_solution {
  bool converged = false;
  double cavitation = -1;  // X_c
  double flow = 0;         // C
  double residual = 0;     // P at the leading edge
  int marches = 0;
};

class strip_solver {
 public:
  explicit strip_solver(int steps);  // from X_c to the leading edge

  // start: X_c to begin with, or any other number; precision: of P and X_c.
  strip_solution solve(const strip_pressure &pressure, double s, double r, double start = -2,
                       double precision = 1e-14);
  int nodes() const { return steps_ + 1; }
  // Of the last solution, from the leading edge to X_c: theta, P, t.
  const double *theta() const { return theta_.data(); }
  const double *liquid() const { return liquid_.data(); }
  const double *film() const { return film_.data(); }
  size_t bytes() const { return 5 * theta_.bytes() + bell_.bytes() + tail_.bytes(); }

 private:
  struct section;
  section at(double d) const;
  // P at the leading edge, or more than it could be where P meets the nominal pressure before. The
  // slope is its rate by theta of X_c, then 0.
  double march(const strip_pressure &pressure, double s, double r, double end, double tolerance,
               double &slope);
  void move(double end, double by);
  // theta of X_c: where to begin, by which step, and between which ends
  struct range_of_end {
    double begin, step, low, high;
  };
  strip_solution search(const strip_pressure &pressure, double s, double r,
                        const range_of_end &range, double tolerance, double precision, int marches);

  int steps_;
  double flow_ = 0, flow_rate_ = 0;
  aligned_buffer<double> theta_, liquid_, film_;
  aligned_buffer<double> liquid_rate_, film_rate_;  // by theta of X_c
  aligned_buffer<double> bell_, tail_;              // phi and 1 - Phi at steps of d
};

// of the flow factor, isotropic: of ln 9 and 1.47476, as the source's equations have them
constexpr double barred_film = 0.27774310294369754, flow_quadratic = 0.37738917651535963,
                 flow_cubic = 1.0019;
double flow_factor(double t);

}  // namespace railpatch
