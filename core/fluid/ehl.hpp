// Mixed elastohydrodynamic lubrication of a contact, steady or step by step: Newton's method on all
// equations of ehl_system.hpp at once, gap, pressure, cavitation and load.
//
// Each step solves the exact linearisation with GMRES; the deformation goes by FFT. The
// preconditioner is the same system with the influence of near elements alone (in a line contact:
// of all), as a band matrix, and the load by elimination. Steps are damped where a smooth film
// would lose more than a part of itself or asperities would move by more than their height.
#pragma once

#include <memory>

#include "fluid/ehl_system.hpp"
#include "half_space/influence.hpp"
#include "normal/normal.hpp"
#include "numeric/band_matrix.hpp"
#include "numeric/gmres.hpp"
#include "numeric/interrupt.hpp"

namespace railpatch {

struct ehl_options {
  double tolerance = 1e-9;  // of every residual
  int max_iterations = 60;
  interrupt ask{};
};

struct ehl_result {
  bool converged = false;
  int iterations = 0, products = 0;
  double residual = 0;      // greatest, in units of the scales
  double normal_force = 0;  // N
  double fluid_force = 0;   // N, of the liquid
  double approach = 0;      // m
  double imbalance = 0;     // of mass, of what passes
};

// How coarse a grid is for its film: the liquid's greatest rise from one element to the next along
// rolling, of its greatest, [ny][nx] Pa of the grid. What counts is the inlet, so the rise is that
// of the reduced pressure (1 - exp(-alpha p))/alpha (Weibull; Grubin 1949, not verified), by which
// Reynolds' equation has the viscosity at p = 0. 0 without pressure.
double greatest_rise(const grid &g, int direction, double pressure_coefficient,
                     const double *pressure);

// A film (m) of the right order: of isoviscous and piezoviscous line contacts (docs/ehl.md), the
// thicker one. modulus: E*; half_length (m) and pressure (Pa) of the dry contact, along the flow
// and at most.
double line_film(const ehl_liquid &liquid, double modulus, double half_length, double pressure,
                 double speed);

class ehl_solver {
 public:
  ehl_solver(int max_nx, int max_ny);

  // Solves from the state of the last solve where `warm`, else from the dry contact.
  ehl_result solve(influence &a, const ehl_problem &problem, bool warm, const ehl_options &options);
  ehl_system &system() { return system_; }
  const ehl_system &system() const { return system_; }
  size_t bytes() const;

 private:
  ehl_result solve_from(influence &a, const ehl_problem &problem, bool warm,
                        const ehl_options &options);
  ehl_result slow_down(influence &a, const ehl_problem &problem, ehl_result found,
                       const ehl_options &options);
  void cold_start(influence &a, const ehl_problem &problem);
  bool precondition_by(influence &a, const ehl_problem &problem);
  double load_of(const ehl_problem &problem, const double *v) const;
  void precondition(const ehl_problem &problem, double *v) const;
  double allowed_part(const ehl_problem &problem) const;
  void move(const ehl_problem &problem, double part);
  double merit() const;
  bool advance(influence &a, const ehl_problem &problem, double *part, double *best);
  double greatest_residual() const;
  ehl_scales scales_of(influence &a, const ehl_problem &problem, const ehl_options &options);

  ehl_system system_;
  band_matrix band_;
  gmres gmres_;
  normal_solver dry_;
  aligned_buffer<double> right_, step_, column_, by_gap_, by_pressure_, by_empty_, dry_pressure_,
      dry_gap_, from_;
  double column_load_ = 0;
  ehl_scales scales_;
  double dry_approach_ = 0, film_ = 0;  // m; a film of the right order
};

}  // namespace railpatch
