// Semi-smooth Newton method for tangential contact where the traction bound depends on the
// inelastic slip: friction that changes with slip velocity, with memory, and third-body layers with
// plasticity (bound_law.hpp). Notation, operators and vectors as in rolling_newton.hpp.
//
// With q = p - r s, Q = |q|, e = q/Q the law's resolvent is radial, P(q) = h(Q) e:
//   F = p - P(q),  dP = e dh + (h/Q) (I - e e^T) dq,  h = Q - R m,  R = r/dq,
//   (R + b_m) dm = dQ - b_angle dangle - b_U dU.
// r is at least a typical inverse diagonal entry of B and at least twice b's steepest fall, so that
// P is one-valued and smooth on either side of its kinks. A hardening layer falls only where
// plastic displacement is undone (magnitude rule), as steeply as it hardens but not far: such an r,
// which makes the equations stiff, is for where the other one fails. Every element keeps two
// unknowns. In steady rolling U, what material carries along its row from the leading edge, is a
// scalar recurrence, and so is its derivative: dU_i = A_i dU_(i-1) + E_i dq_i, a running sum in
// each product with the Jacobian and in each column of the row blocks.
//
// Convergence. Where b does not fall and nothing is carried along rows, -s is a monotone function
// of p (the subdifferential of a convex function of |p|), the problem is a mixed variational
// inequality with a monotone B, and the extragradient step with the resolvent as projection tends
// to its solution, as in rolling_newton.hpp. With falling friction, softening, plastic displacement
// undone (magnitude rule) or carried states there may be several solutions or, beyond the snap-back
// limit, none near by. The safeguard then is a heuristic, sweeps that solve element after element
// with all others held (Vollebregt 1995, 2010 solve whole problems so), and what has not converged
// says so and returns the best traction found.
#pragma once

#include "numeric/pivoted_blocks.hpp"
#include "tangential/bound_law.hpp"
#include "tangential/rolling_newton.hpp"

namespace railpatch {

// What a law adds to a rolling_problem, whose bound then is mu p_n, or p_n where the law says mu.
// Arrays per element, in the order of the problem.
struct inelastic_problem {
  const bound_law *law = nullptr;
  const carried_state *before = nullptr;  // null: carried along each row from its first element
  carried_state *after = nullptr;         // out
  // null without plasticity
  double *plastic_slip = nullptr;  // out, m, plastic displacement of the step along p
  double *yield_stress = nullptr;  // out, Pa
  double *friction = nullptr;      // out, Pa, g
  unsigned char *state = nullptr;  // out, rp_element
};

struct inelastic_result {
  tangential_result tangential;
  int plastic = 0;          // elements
  double plastic_work = 0;  // N, power of plastic displacement over the rolling speed
  int ambiguous = 0;        // elements whose law has a further solution
};

struct inelastic_task;

class inelastic_newton : row_newton<inelastic_newton, inelastic_task> {
 public:
  inelastic_newton(int max_row, int max_rows, bool forced);
  inelastic_result solve(rolling_operator &b, const rolling_problem &problem,
                         const inelastic_problem &inelastic, const tangential_options &options);
  size_t bytes() const;

 private:
  friend class row_newton<inelastic_newton, inelastic_task>;
  using task = inelastic_task;
  // dP = m dq + h dU before, dU after = e dq + a dU before
  struct linearisation {
    double m[2][2], h[2][3], e[3][2], a[3][3];
  };
  struct outcome {
    double error, size;  // |F|, and the size against which it is measured
    bool within(double tolerance) const { return error <= tolerance * size; }
  };

  // of row_newton: the law, and its derivative in the linear systems
  static constexpr double shortest_step = 1e-6;
  void residual(const task &t, const double *p, const double *s, double *f) const;
  void resolvent(const task &t, const double *p, const double *s, double length, double *out) const;
  double start_bound(const task &t, size_t k) const;
  void apply_jacobian(task &t, const double *v, double *out);
  void precondition(const task &t, double *v);
  void border(const task &t, int component, const double *s, double *column, double *row,
              double &right);

  void set_stiffness(const task &t, bool undone);
  outcome attempt(task &t, double tolerance, int max_iterations);
  outcome attempt_steeply(task &t, const outcome &before, const tangential_options &options);
  void settle(task &t, outcome &found, double tolerance, int max_iterations);
  double start(task &t);
  double iterate(task &t, double error, double goal, int max_iterations);
  double choose_branch(task &t, double error, double goal, int max_iterations);
  bool go_to_branch(task &t);
  double own_stiffness(task &t, int row, size_t element, const double e[2]);
  void try_march(task &t, double &error);
  double scale_of_solution(const task &t) const;
  template <class Each>
  void apply_law(const task &t, const double *p, const double *s, double length, Each &&each) const;
  void linearise(task &t);
  void fill_block(const task &t, int row);
  void derivative(const task &t, int row, const double *dp, const double *ds, double *out) const;
  void find_step(task &t, double tolerance);
  double descend(task &t, double goal);
  void sweep(task &t);
  void finish(task &t);

  aligned_buffer<double> most_;  // per element: greatest b
  aligned_buffer<double> started_, kept_, first_;
  aligned_buffer<linearisation> linear_, factored_;
  aligned_buffer<unsigned char> has_factors_;  // per row
  pivoted_blocks blocks_;
};

}  // namespace railpatch
