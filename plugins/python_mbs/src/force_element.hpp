// Force element for multibody codes: joint placement and velocity in, wrench out, plain doubles.
//
// Frames. World: the host's inertial frame. Track: placed in the world by `track`, x forward, y
// right, z down; the world moves along the track's x axis at `frame_speed`. Joint: the frame of the
// joint that carries the spinning wheelset. Wheelset: placed in the joint frame by `wheelset`,
// y along the axle, origin at its centre.
//
// Attitude. The axle's direction a = Rx(roll) Rz(yaw) e_y is that of the wheelset's y axis, however
// it has spun, so one frame gives it:
//     a = (-sin yaw, cos roll cos yaw, sin roll cos yaw)
// With h = Rx(roll) e_z = (0, -sin roll, cos roll) and g = Rx(roll) e_y = (0, cos roll, sin roll)
// the angular velocity of the wheelset is  w = roll_rate e_x + yaw_rate h + pitch_rate a,  thus
//     pitch_rate = w.g / cos yaw,  yaw_rate = w.h,  roll_rate = w_x + pitch_rate sin yaw.
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

#include "railpatch.h"

namespace railpatch::python {

// A contact that another class may step; calls that the core refuses are thrown.
class Steppable {
 public:
  virtual void solve(const rp_input &input, rp_result &result) = 0;
  virtual void differentiate_all(rp_jacobian &found) = 0;
  // one column of the same
  virtual rp_status differentiate_column(size_t column, double found[2][6]) = 0;
  // of the last step's patch; its numbers, none where it has no such field
  virtual size_t read_field(int side, int patch, rp_field field, std::vector<double> &to) = 0;

 protected:
  ~Steppable() = default;
};

// Position and velocity of a wheelset in track axes, in the order of the array `state`.
struct TrackState {
  double x, y, z;                          // m; z = 0: one nominal radius above the rails' tops
  double roll, yaw, pitch;                 // rad
  double speed, vy, vz;                    // m/s
  double roll_rate, yaw_rate, pitch_rate;  // rad/s
};

// A frame in another one: rotation by rows, then the origin (m).
struct Placement {
  double rotation[9], origin[3];
};

// velocity: of the joint frame, linear (m/s) then angular (rad/s), in its own axes
TrackState track_state(const Placement &joint, const double velocity[6], const Placement &wheelset,
                       const Placement &track, double frame_speed, double nominal_radius);

// force (N) and moment (N m) at the wheelset's centre in track axes -> linear and angular part in
// the joint frame, at its origin
void joint_wrench(const double force[3], const double moment[3], const Placement &joint,
                  const Placement &wheelset, const Placement &track, double wrench[6]);

// N, to the right on a wheel, of the tractions of all its patches, on planes
double lateral_creep(const rp_side_result &side);
// The same on a curved reference surface, where the lateral `creep_force` holds a part of pressure,
// by rows, each at an angle of its own. side: the last step's, 0 or 1; room: for two fields.
double lateral_creep_of_rows(Steppable &contact, int side, const rp_side_result &result,
                             std::vector<double> room[2]);

void bind_force_element(nanobind::module_ &m);

}  // namespace railpatch::python
