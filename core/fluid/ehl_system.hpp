// The equations of mixed elastohydrodynamic lubrication on the elements of a grid, their residuals
// and their exact linearisation.
//
// Unknown are the gap h between mean planes, the liquid's pressure p >= 0 (above the surroundings)
// and the empty share theta of the gap, 0 <= theta < 1, in each element, and the gap's constant h0:
//   elasticity  h = h0 + g(x, y) + A (p + p_a(h))     (A: half_space/influence.hpp)
//   liquid      div(V c - (rho cube(h)/(12 eta)) grad p) + dc/dt = 0,  c = rho h_T (1 - theta)
//               (Reynolds 1886 with the mean film and the flow factor of ehl_laws.hpp;
//               mass-conserving cavitation after Elrod and Adams 1974)
//   cavitation  p + theta - sqrt(p^2 + theta^2) = 0, p in units of p_ref (Fischer 1992, Burmeister;
//               Woloszynski, Podsiadlo and Stachowiak 2015)
//   load        sum(p + p_a) dx dy = F, or h0 given.
// Finite volumes: what leaves an element enters the next, so mass is conserved as well as the
// equations are solved. Content on a face is that of the element upstream; where it and both its
// neighbours along the flow are full, (2 c_after + 5 c - c_before)/6 (upwind-biased, third order).
// At the border p = 0; the liquid arrives with a given film or fills the gap.
//
// Order of the elements here: along the flow first, k = s ny + j, s from the leading edge on.
#pragma once

#include "fluid/ehl_laws.hpp"
#include "half_space/influence.hpp"
#include "numeric/memory.hpp"

namespace railpatch {

struct ehl_problem {
  grid area;
  int direction = 1;                 // rolling towards +x or -x; the liquid enters at that side
  double speed = 0;                  // m/s, mean of both surfaces
  const double *distance = nullptr;  // m, [ny][nx], undeformed
  bool force_given = true;
  double force = 0;     // N
  double approach = 0;  // m, -h0, where no force is given
  ehl_liquid liquid;
  ehl_roughness roughness;
  double inlet_film = 0;                   // m, of liquid that arrives; 0: it fills the gap
  const double *thinning = nullptr;        // of the viscosity by heat, [ny][nx]; null: 1
  double time_step = 0;                    // s; 0: steady
  const double *content_before = nullptr;  // m, rho/rho0 h_T (1 - theta), [ny][nx]
};

// of one problem, in the units that the unknowns are solved in
struct ehl_scales {
  double pressure = 0;  // Pa
  double gap = 0;       // m
  double flow = 0;      // m^3/s through an element's face
};

class ehl_system {
 public:
  explicit ehl_system(int max_count);

  // Takes over a problem; `a` has its grid set.
  void set(const ehl_problem &problem, const ehl_scales &scales);
  size_t count() const { return count_; }
  int rows() const { return ny_; }  // of the grid
  // Element of the grid at (s, j).
  size_t on_grid(int s, int j) const {
    const int i = problem_.direction > 0 ? problem_.area.nx - 1 - s : s;
    return static_cast<size_t>(j * problem_.area.nx + i);
  }
  void to_flow(const double *field, double *v) const;
  void to_grid(const double *v, double *field) const;

  // Residuals of all equations at the fields below, in units of the scales.
  void evaluate(influence &a);
  // Its linearisation there; delay: elements over the way that the flow goes in a step of time that
  // is put between this state and the next, 0: none.
  void linearise(double delay);
  // After linearise: minus the residuals, with what is missing to the curve of cavitation.
  void right_side(influence &a, double *b);
  // out = J v for v of gap and place on the curve of cavitation in turn, and last the constant h0.
  void product(influence &a, const double *v, double *out);
  // Changes of all fields by v, with what is missing to the curve of cavitation.
  void step_of(const double *v, double *gap, double *pressure, double *empty) const;

  // state, in the flow's order
  aligned_buffer<double> gap, pressure, empty;
  double constant = 0;  // h0, m
  // of evaluate: 2 count + 1 residuals, in the order of v; the curve's own are apart
  aligned_buffer<double> residual, curve;
  aligned_buffer<double> content, asperity, displacement;
  // m^3/s of liquid that enters less what leaves, of the last evaluation, and what passes
  double imbalance = 0, passing = 0;
  double load = 0;  // N

  // of linearise, for preconditioners: columns of the liquid's equation of element k by element
  // k's neighbours, by gap and by place on the curve
  enum place { before_last, before, here, after, left, right, places };
  struct pair {
    double by_gap, by_curve;
  };
  const pair &coefficient(size_t k, place at) const { return jacobian_[k * places + at]; }
  // change of p (by curve) and of p_a (by gap), both in units, and the scale of A
  double pressure_by_curve(size_t k) const { return along_pressure_[k]; }
  double asperity_by_gap(size_t k) const { return asperity_slope_[k]; }
  const ehl_scales &scales() const { return scales_; }
  double elastic_scale() const { return scales_.pressure / scales_.gap; }
  size_t bytes() const;

 private:
  // of a flow or a content
  struct slopes {
    double pressure, gap, empty;
    slopes &operator+=(const slopes &o) {
      pressure += o.pressure;
      gap += o.gap;
      empty += o.empty;
      return *this;
    }
    friend slopes operator*(double f, const slopes &s) {
      return {f * s.pressure, f * s.gap, f * s.empty};
    }
  };
  void evaluate_elements();
  void evaluate_flows();
  double upstream_content(int j) const;
  double correction(size_t k, int s) const;
  slopes content_slopes(size_t k) const;
  void add(size_t row, place at, size_t node, const slopes &by);
  void linearise_along(int s, int j);
  void linearise_across(int s, int j);

  ehl_problem problem_;
  ehl_scales scales_;
  size_t count_ = 0;
  double shift_ = 0;  // sum of off_pressure_
  int nx_ = 0, ny_ = 0;
  aligned_buffer<double> distance_, before_, thinning_;
  // film m = rho h_T and conductance e = rho cube/(12 eta) with slopes by p and h
  aligned_buffer<double> film_, film_by_p_, film_by_h_, ease_, ease_by_p_, ease_by_h_;
  aligned_buffer<double> asperity_slope_, along_pressure_, along_empty_, off_pressure_, off_empty_;
  aligned_buffer<pair> jacobian_;
  aligned_buffer<double> grid_in_, grid_out_;
};

}  // namespace railpatch
