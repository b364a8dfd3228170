// Tangential contact, full theory (Kalker 1990, chapter 4), on the uniform grid of the normal
// problem.
//
// Rigid slip, wheel minus rail and over the rolling speed:
//   w_x = xi - phi y, w_y = eta + phi (x + offset);
// in steady rolling the tractions add B p = (u(x) - u(x + direction dx))/dx, in a step of transient
// rolling over the distance dq (u(x) - u_before(x + direction dq))/dq with the last step's u: a
// known part and A p/dq. A shift is such a step that does not roll, dq = 1 m: its slips are
// lengths. Products by FFT. Equations and solver: rolling_newton.hpp, for laws beyond Coulomb's
// inelastic_newton.hpp.
#pragma once

#include <memory>
#include <optional>

#include "half_space/influence.hpp"
#include "half_space/offset_influence.hpp"
#include "half_space/physics.hpp"
#include "half_space/viscous_influence.hpp"
#include "tangential/inelastic_newton.hpp"
#include "tangential/rolling_newton.hpp"
#include "tangential/row_strips.hpp"

namespace railpatch {

enum class motion { steady, shift, transient };

struct rolling_input {
  double creepage[2] = {0, 0};        // longitudinal, lateral
  double spin_creepage = 0;           // rad/m
  int direction = 1;                  // rolling towards +x or -x
  double spin_offset = 0;             // m, added to x in the spin term
  prescribed_force *force = nullptr;  // its components' creepages above are then 0
  motion regime = motion::steady;
  double distance = 1;                        // m, rolled in a step of transient rolling
  double speed = 0;                           // m/s, for friction that depends on it
  const double *px = nullptr, *py = nullptr;  // Pa, tractions of the last step on the same grid
  // m, to where the material was in the last step
  double upstream() const { return regime == motion::transient ? direction * distance : 0.0; }
  // m, of wheels in place of px, py: displacement of the last step where the material was, [ny][nx]
  const double *before[2] = {nullptr, nullptr};
  const double *coupled[2] = {nullptr, nullptr};  // null: none; slip from pressure, [ny][nx]
  // Whether anything can move a traction away from zero, or to it.
  bool drives() const {
    return creepage[0] != 0 || creepage[1] != 0 || spin_creepage != 0 || force || px || before[0] ||
           coupled[0];
  }
  const double *row_spin = nullptr;  // in place of the spin above, which is then 0: of curved rows
  double spin_of(int row) const { return row_spin ? row_spin[row] : spin_creepage; }
  double slip(int component, double x, double y) const {
    return component == 0 ? creepage[0] - spin_creepage * y
                          : creepage[1] + spin_creepage * (x + spin_offset);
  }
};

// Outputs of every tangential method, [ny][nx].
struct tangential_fields {
  double *px, *py;          // Pa on the wheel; start in, solution out
  double *sx, *sy;          // micro-slip, relative to the rolling speed
  unsigned char *division;  // rp_element
};

// What laws beyond Coulomb's need and give, on the grid.
struct inelastic_fields {
  bound_law *law;               // step and speed are set by the solver
  const carried_state *before;  // null: carried along the rows, in steady rolling
  carried_state *after;
  double *plastic_x, *plastic_y;    // m, vector sum: of the step before in, out
  double *yield_stress, *friction;  // Pa, traction bound g
};
struct inelastic_sums {
  int plastic = 0, ambiguous = 0;
  double plastic_work = 0;  // N, as tangential_result::friction
};

// What is solved for; arrays on the grid.
struct tangential_problem {
  influence &a;
  const grid &g;
  const double *pressure, *bound;  // Pa; traction bound g, zero outside the contact area
  const rolling_input &input;
  tangential_options options;
  tangential_fields fields;
  int followed = 0;                             // see influence::set_grid()
  const inelastic_fields *inelastic = nullptr;  // of laws beyond Coulomb's, with their sums
  inelastic_sums *sums = nullptr;
  viscous_influence *viscous = nullptr;  // of viscoelastic bodies in steady rolling, in place of a
};

class tangential_solver {
 public:
  struct setup {
    bool forced = false;                   // for inputs with a prescribed force
    bool inelastic = false;                // for laws beyond Coulomb's
    bool plastic = false;                  // of these, for a layer that yields
    bool history = false;                  // for shift and transient rolling
    const fft_plans *transient = nullptr;  // transient rolling: those of the influence
    bool moves = false;                    // of patches whose grid moves: add_moved()
    // Products in steady rolling on the least grid that holds the contact, with these bodies and
    // plans; null: on the problem's.
    const influence::medium *bodies = nullptr;
    const fft_plans *plans = nullptr;
  };
  tangential_solver(int max_nx, int max_ny, const setup &setup);

  tangential_result solve(const tangential_problem &problem);
  // The preconditioner's, for linear systems of the same rows between solves; null: other laws.
  row_blocks *blocks() { return newton_ ? &newton_->blocks() : nullptr; }
  // Displacement that the last step's tractions (input.px, py) caused where the material of the
  // elements was.
  void displacement_before(influence &a, const grid &g, const rolling_input &input, double *ux,
                           double *uy);
  // See half_space/offset_influence.hpp; on the grid of a.
  void add_moved(const influence &a, const grid &from, const grid &to, const double offset[2],
                 double share, const double *px, const double *py, double *ux, double *uy) {
    offset_->add_moved(a, from, to, offset, share, px, py, ux, uy);
  }
  void add_curved(const influence &a, const grid &from, const grid &to, const double offset[2],
                  double share, const curved_past &past, const curved_sums &sums) {
    offset_->add_curved(a, from, to, offset, share, past, sums);
  }
  // all, and what of it serves the last step and the plastic layer
  size_t bytes() const;
  size_t history_bytes() const { return (offset_ ? offset_->bytes() : 0) + before_.bytes(); }
  size_t plastic_bytes() const { return plastic_slip_.bytes() + yield_stress_.bytes(); }

 private:
  class grid_operator;
  class viscous_operator;
  class step_operator;
  void collect(const tangential_problem &problem);
  void add_history(const tangential_problem &problem);
  void take_offset_work(const tangential_problem &problem, tangential_result &result) const;
  tangential_result solve_inelastic(rolling_operator &b, const rolling_problem &rows,
                                    const tangential_problem &problem);
  void carry_plastic(const inelastic_fields &fields);
  void release(const grid &g, tangential_fields fields) const;

  influence &products(const tangential_problem &problem);

  row_elements elements_;
  row_strips strips_;
  std::unique_ptr<influence> boxed_;
  aligned_buffer<double> bound_, area_, rigid_, p_, s_;
  std::optional<rolling_newton> newton_;
  physics_part<inelastic_newton> inelastic_;
  physics_part<offset_influence> offset_;
  aligned_buffer<carried_state> before_, after_;
  aligned_buffer<double> plastic_slip_, yield_stress_, friction_;
  aligned_buffer<unsigned char> state_;
};

}  // namespace railpatch
