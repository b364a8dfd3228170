// What a vehicle does between contact solves, compiled: forces of its suspension, its way along the
// track, means of its wheels' forces. Formulas and frames: wheelset_demo/vehicle, whose modules
// prepare the arrays. No contacts here: these come as VehicleContacts, a force element.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

using Indices = nb::ndarray<const int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IndexGrid = nb::ndarray<const int64_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Cube = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

// What a vehicle's steps (vehicle_steps.cpp) ask of the other classes, without the interpreter's
// lock. Arrays as their Python properties say.
class VehicleContacts {
 public:
  virtual size_t count() const = 0;  // wheelsets
  virtual int solve() = 0;           // the worst status
  virtual void pass_time(double seconds) = 0;
  virtual void place_wrenches(const double *wrenches) = 0;
  // of these wheelsets at the last step, to by_side(); throws where they are not found
  virtual void find_derivatives(const size_t *wheelsets, size_t count) = 0;
  virtual const double *by_side() const = 0;  // [wheelsets][2][6][12]
  // Whether a wheelset's are found by differences: then also column by column, each at another step
  // and all of them taken at last.
  virtual bool by_differences(size_t k) const = 0;
  virtual void find_column(size_t k, size_t column) = 0;
  virtual void take_columns(size_t k) = 0;
  // of a wheelset's joint placed and moving like this
  virtual void state_at(size_t k, const double *placement, const double *velocity,
                        double *state) const = 0;
  virtual double *motion() = 0;
  virtual double *tracks() = 0;
  virtual double *positions() = 0;
  virtual double *rails() = 0;
  virtual double *water() = 0;
  virtual double *wheels() = 0;
  virtual double *lateral() = 0;
  virtual double *wrench() = 0;
  virtual double *placed() = 0;
  virtual double *contact() = 0;
  virtual double *power() = 0;

 protected:
  ~VehicleContacts() = default;
};

class VehicleCourse {
 public:
  virtual void place_all(const double *q, const double *v, double *tracks, double *rails) = 0;
  virtual void look_ahead_all(const double *v, double step) = 0;
  virtual bool level() const = 0;
  virtual double middle() const = 0;
  virtual size_t count() const = 0;
  virtual size_t width() const = 0;
  virtual double *positions() = 0;
  virtual double *slopes() = 0;
  virtual double *inputs() = 0;
  virtual double *ahead() = 0;
  virtual double *bend() = 0;

 protected:
  ~VehicleCourse() = default;
};

class VehicleSuspension {
 public:
  virtual double find_forces(const double *q, const double *v, const double *series) = 0;
  // what slides stays where the last forces moved it to: once a time step
  virtual void settle() {}
  virtual double *generalised() = 0;
  virtual double *series_rates() = 0;
  virtual size_t width() const = 0;
  virtual size_t series() const = 0;
  // derivatives of the last forces, nearly, see Suspension.jacobian: added to
  // [width][2 coordinates + series], of the generalised force by q, v and series forces,
  virtual void add_derivatives(double *to, size_t coordinates) const = 0;
  // and of the series' rates: written to [series][coordinates], by v, and [series], by themselves
  virtual void series_derivatives(double *by_v, size_t coordinates, double *by_series) const = 0;

 protected:
  ~VehicleSuspension() = default;
};

// Track below the rails: coordinates beside the bodies', `width` a wheelset, rails first.
class VehicleSupport {
 public:
  // deflections and their rates onto rails that are placed
  virtual void put_rails(const double *place, const double *rate, double *rails) = 0;
  // second derivatives of the coordinates; W, of the wheels on the rails
  virtual double find_rates(const double *wheels, size_t row, double *found) = 0;
  virtual void meet() = 0;
  virtual double damping_power() const = 0;  // W
  virtual double rail_mass() const = 0;      // kg
  virtual size_t width() const = 0;
  virtual size_t count() const = 0;
  // [width][width], of a wheelset's second derivatives without its wheels
  virtual const double *by_places() const = 0;
  virtual const double *by_rates() const = 0;

 protected:
  ~VehicleSupport() = default;
};

class VehicleDrives {
 public:
  virtual void update(double time, const double *q, const double *v) = 0;
  // to generalised forces; W
  virtual double add_forces(const double *q, const double *v, double *tau) = 0;

 protected:
  ~VehicleDrives() = default;
};

class VehicleWetRails {
 public:
  virtual void put(const double *positions, double *water) const = 0;
  // friction's work in a step, J, of each wheel
  virtual void leave(const double *positions, const double *work) = 0;

 protected:
  ~VehicleWetRails() = default;
};

// What not every vehicle has; none: nullptr.
struct VehicleExtras {
  VehicleSupport *support = nullptr;
  VehicleDrives *drives = nullptr;
  VehicleWetRails *wet = nullptr;
};

class VehicleMeans {
 public:
  virtual void add_step(double way, const double *wheels, size_t row) = 0;

 protected:
  ~VehicleMeans() = default;
};

// Of rails that are not level, see wheelset_demo.vehicle.slope: of left and right wheel, Fx, My,
// Mz. wheel: its row; normal: N, its part to the right; slope: lateral, vertical.
void slope_wrench(const double *wheel, double normal, const double *slope, double radius,
                  double place, double *to);

void bind_steps(nb::module_ &m);
void bind_suspension(nb::module_ &m);
void bind_course(nb::module_ &m);
void bind_support(nb::module_ &m);
void bind_drives(nb::module_ &m);
void bind_wet_rails(nb::module_ &m);
void bind_means(nb::module_ &m);

}  // namespace railpatch::python
