// How far the tangential traction of one element can go, as a function of its inelastic slip: law
// of friction and yield stress of a third-body layer.
//
// Inelastic slip m (m) over a step: plastic displacement of the layer first, as long as the yield
// stress is below the traction bound, then slip of the surfaces (Vollebregt 2024,
// DOT/FRA/ORD-24/18, section 4.3, with the state S* in which both bounds are met):
//   b(m) = tau(u* after m) while below g(0), else g(m - m_p) with tau = g(0) at m_p; where friction
//   has risen with slip above that, with tau = g(m - m_p) at m_p: the layer goes on to yield.
// Coulomb: g constant. Slip velocity: g = mu(s) p_n with the slip's speed s = V slip/dq, and with a
// memory of the friction coefficient over the distance d_c
//   mu = (d_c mu_before + D mu(s))/(d_c + D),  D = max(s, s_0) dq/V.
// Accumulated plastic displacement u*: length of the path (eq. 37) or length of the vector sum
// (eq. 38).
//
// The traction p opposes the slip: with q = p - r s, |p| = h solves h = b((|q| - h)/R), R = r/dq,
// beyond |q| = b(0), where the element sticks. R above twice the steepest fall of b makes h unique.
#pragma once

#include "railpatch.h"

namespace railpatch {

// mu(s) = kinetic + sum of amplitude f(s/halving), f by its shape.
struct slip_velocity_law {
  rp_slip_law shape = RP_SLIP_EXPONENTIAL;
  double kinetic = 0;
  double amplitude[2] = {0, 0};
  double halving_speed[2] = {1, 1};  // m/s
  double memory_distance = 0;        // m, d_c; 0: none
  double memory_speed = 1e-3;        // m/s, s_0
  double coefficient(double speed, double &slope) const;
  double standing() const { return kinetic + amplitude[0] + amplitude[1]; }
  double greatest() const;
  // Whether mu may rise with slip from what the material carries.
  bool rises(double carried) const;
  // Steepest fall of mu with the length of slip, 1/m, at a rate (1/s) of speed over length.
  double steepest_fall(double rate) const;
};

// Yield stress over accumulated plastic displacement: straight between points, going on with
// last_slope.
struct hardening_curve {
  int points = 0;  // 0: no yield
  double displacement[RP_MAX_POINTS] = {}, stress[RP_MAX_POINTS] = {};
  double last_slope = 0;
  // tau = yield_stress + hardening u, not below a tenth of the yield stress
  static hardening_curve straight(double yield_stress, double hardening);
  double at(double u, double &slope) const;
  // The next u above (below) `from` where the stress is `level`; infinite (negative): nowhere.
  double next_above(double from, double level) const;
  double next_below(double from, double level) const;
  double greatest() const;
  double steepest() const;
};

// What an element carries from step to step, or along its row: friction coefficient minus that at
// rest, so that all is 0 in material that comes into contact, and plastic displacement: {length of
// the path, 0} or the vector.
struct carried_state {
  double v[3];
};

// b and what the element carries after inelastic slip m in direction e, with derivatives with
// regard to m, the angle of e and the state before.
struct bound_point {
  double bound, by_slip, by_angle, by_state[3];
  carried_state state;
  double state_by_slip[3], state_by_angle[3], state_by_state[3][3];
  double plastic;       // m, plastic part of the slip
  double yield_stress;  // Pa, after it
  double friction;      // Pa, g
};

class bound_law {
 public:
  slip_velocity_law slip;
  hardening_curve yield;
  bool by_velocity = false;   // slip velocity, else Coulomb
  bool by_magnitude = false;  // rule of accumulated plastic displacement
  double step = 1;            // m, dq: slip over it is relative
  double speed = 0;           // m/s

  bool plastic() const { return yield.points > 0; }
  bool remembers() const { return by_velocity && slip.memory_distance > 0; }
  // friction: Pa, mu p_n, or p_n where mu depends on the slip's speed.
  bound_point evaluate(double friction, const carried_state &before, const double e[2],
                       double m) const;
  // m for |q| = size above b(0): one of the solutions above `low`, where size - stiffness m > b(m).
  double resolve(double friction, const carried_state &before, const double e[2], double size,
                 double stiffness, double low = 0) const;
  double at_rest(double friction, const carried_state &before) const;
  // of b in any state, Pa and Pa/m. Where friction rises with slip it takes the layer on, both in
  // series: if then one of them falls, b falls without limit, as fast as the other rises
  double greatest(double friction) const;
  double steepest_fall(double friction) const;
  // of friction alone and of the layer alone, the greater: always finite
  double fall_of_each(double friction) const;
  // the same while plastic displacement grows
  double fall_ahead(double friction) const;
  // Whether more than one m, stick among them, solves size - stiffness m = b(m).
  bool ambiguous(double friction, const carried_state &before, const double e[2], double size,
                 double stiffness) const;

 private:
  struct slipping;
  struct yielding;
  // derivatives of the plastic part of m
  struct plastic_part {
    double by_slip, by_angle, by_state[3];
  };
  bool falls_in_series(double friction, double carried) const;
  slipping friction_at(double normal, double carried, double slip) const;
  yielding yield_at(const carried_state &before, const double e[2], double m) const;
  yielding until(const carried_state &before, const double e[2], double level) const;
  double split(double friction, const carried_state &before, const double e[2], double limit,
               double m) const;
  static plastic_part shared(const yielding &y, const slipping &s);
  static plastic_part ended(const yielding &y, const slipping &rest);
  void carry_on(bound_point &b, const carried_state &before, const double e[2],
                const plastic_part &part, const slipping &s) const;
  double value(double friction, const carried_state &before, const double e[2], double limit,
               double m, double &slope) const;
};

}  // namespace railpatch
