// Forward dynamics of bodies that hang from the world by joints of one degree of freedom.
//
// The articulated-body algorithm (R. Featherstone, Rigid Body Dynamics Algorithms, 2008, table 7.1)
// in world axes. Spatial vectors are angular, then linear part; those of a tree refer to a point
// near its last body, at rest in the world, so that inertias of all its bodies simply add and far
// places lose no digits. Tests compare it with Pinocchio.
#pragma once

#include <array>
#include <vector>

#include "force_element.hpp"

namespace railpatch::python {

using Spatial = std::array<double, 6>;

enum class JointKind { x, y, z, about_x, about_y, about_z };

// One of Pinocchio's joints and the body on it.
struct Joint {
  int parent;  // index of a joint before it, or -1: the world
  JointKind kind;
  Placement placement;  // in the parent
  double mass, centre[3];
  double inertia[9];  // kg m^2, about the centre, by rows
};

class Bodies {
 public:
  // gravity: m/s^2, [3]
  Bodies(std::vector<Joint> joints, const double gravity[3]);

  // Places and velocities of all joints. Forces on them are none then.
  void move(const double *q, const double *v);
  // A wrench on a joint, in its axes at its origin: force (N), moment (N m).
  void load(size_t joint, const double *wrench);
  // The same in world axes.
  void load_in_world(size_t joint, const double *force, const double *moment);
  // Accelerations with generalised forces.
  void accelerate(const double *tau, double *found);
  // What generalised forces alone change accelerations by, after accelerate(). columns: of `stride`
  // numbers a row, [joints][columns], turned into accelerations in place.
  void respond(double *matrix, size_t columns, size_t stride);

  Placement placement(size_t joint) const;
  // linear (m/s), then angular (rad/s), in its own axes
  void velocity(size_t joint, double *found) const;
  // of a force and a moment in world axes at the joint's origin: the generalised forces of the
  // joints that carry it
  template <typename Take>
  void project(size_t joint, const double *force, const double *moment, Take &&take) const {
    for (int k = static_cast<int>(joint); k >= 0; k = joints_[static_cast<size_t>(k)].parent) {
      const State &on = states_[static_cast<size_t>(k)];
      take(static_cast<size_t>(k), generalised(on, joint, force, moment));
    }
  }

  size_t count() const { return joints_.size(); }
  // of the tree that a joint belongs to, and the joint's number in it
  size_t tree(size_t joint) const { return tree_[joint]; }
  size_t number(size_t joint) const { return number_[joint]; }
  size_t trees() const { return trees_; }
  size_t most_joints() const { return most_joints_; }

 private:
  struct State {
    double rotation[9], origin[3];
    double point[3];                 // what spatial vectors refer to
    Spatial axis, velocity, change;  // change: of the axis, as the joint moves
    Spatial force, carried;          // outer; what the joint carries
    double inertia[21];              // articulated, upper triangle by rows
    Spatial drawn;                   // inertia times axis
    double along;                    // of it along the axis
    Spatial acceleration;
  };

  void place(size_t k, double q);
  void start(size_t k, double rate);
  double generalised(const State &on, size_t joint, const double *force,
                     const double *moment) const;

  std::vector<Joint> joints_;
  std::vector<State> states_;
  std::vector<size_t> tree_, number_, last_;  // last_: joint of a tree
  size_t trees_ = 0, most_joints_ = 0;
  double gravity_[3];
};

}  // namespace railpatch::python
