// The equations of motion of a vehicle, y' = f(y, u), and their derivatives; y, u and what is left
// out of them: wheelset_demo/vehicle/system.py. Allocates nothing once made.
#pragma once

#include <vector>

#include "vehicle.hpp"
#include "vehicle_bodies.hpp"

namespace railpatch::python {

// Forces of rails that are not level, the drive.
struct VehicleNumbers {
  double arm;                  // m, half the distance of the contacts
  size_t ahead[4];             // columns of the driven body's x, y, pitch, yaw
  double hold;                 // m, below its centre, where the speed is held
  double gain, speed;          // N s/m, m/s
  std::vector<size_t> axle;    // joints of the wheelsets
  std::vector<double> radius;  // m, of their wheels
};

class VehicleEquations {
 public:
  VehicleEquations(VehicleContacts &contacts, VehicleCourse &course, VehicleSuspension &suspension,
                   VehicleExtras extras, Bodies bodies, VehicleNumbers numbers);

  // Rates and powers at a state; the contacts' worst status. Throws for a state that they refuse.
  int evaluate(const double *values);
  // Derivatives at the state of the last evaluate(), those of the contacts found anew for some
  // wheelsets and held for the others. Throws where they are not found.
  void differentiate(const double *values, const size_t *wheelsets, size_t count);
  // A part of that, for later.
  void find_column(size_t wheelset, size_t column);

  size_t coordinates() const { return n_; }
  size_t series() const { return m_; }
  size_t size() const { return 2 * n_ + m_; }
  size_t wheelsets() const { return contacts_.count(); }
  size_t known() const { return 6 * wheelsets(); }
  size_t powers_count() const { return kWorks + 2 * wheelsets(); }

  // [size] of a state; [4 + wheels], W: contacts, friction, dampers, drive, friction of each wheel
  double *rates() { return rates_.data(); }
  double *powers() { return powers_.data(); }
  double *slope_wrenches() { return slopes_.data(); }  // [wheelsets][2][3]
  // [n][size], of accelerations by a state, and [n][known] by u; of the series' rates by velocities
  // [m][n] and by themselves [m]
  double *by_state() { return by_state_.data(); }
  double *by_inputs() { return by_inputs_.data(); }
  double *series_by_v() { return series_by_v_.data(); }
  double *series_by_series() { return series_by_series_.data(); }

  bool sloped = true;  // whether slopes have forces
  // s, CPU time of the calling thread in the contacts and in differentiate()
  double contact_seconds = 0, derivative_seconds = 0;
  size_t evaluations = 0, renewals = 0;  // calls of evaluate() and of differentiate()

 private:
  enum { kAhead = 3, kWorks = 4, kWheel = 9, kMotion = 18, kState = 12 };

  void give_motion();
  double add_slopes();
  double drive(const double *q, const double *v);
  void ahead(const double *q, double *found) const;
  void load_bodies();
  void bend_inertia(const double *values);
  void vary(const double *values, size_t number, bool velocity);
  void add_contacts(size_t k);
  void add_support();
  void add_rails(size_t k);
  void add_wrench(size_t k, const double *wrench, double *column, size_t stride);
  void find_inverse();
  void to_accelerations(const double *from, double *to, size_t stride);

  VehicleContacts &contacts_;
  VehicleCourse &course_;
  VehicleSuspension &suspension_;
  VehicleExtras extras_;
  Bodies bodies_;
  VehicleNumbers numbers_;
  // coordinates of bodies, of all, forces in series
  size_t bodies_n_, n_, m_;
  std::vector<double> rates_, powers_, tau_, slopes_, wrenches_;
  std::vector<double> by_state_, by_inputs_, series_by_v_, series_by_series_;
  // of differentiate(): world forces and moments on the wheelsets, their states and derivatives
  // [2][joints of a tree][12], generalised forces, inverse of the inertia by tree
  std::vector<double> loads_, states_, by_joint_, moved_, found_, base_, forces_, inputs_, inverse_;
};

}  // namespace railpatch::python
