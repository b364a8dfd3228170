// See vehicle_bodies.hpp.

#include "vehicle_bodies.hpp"

#include <algorithm>
#include <utility>

#include "numeric/elementary.hpp"

namespace railpatch::python {

namespace {

void cross(const double *a, const double *b, double *to) {
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
               z = a[0] * b[1] - a[1] * b[0];
  to[0] = x;
  to[1] = y;
  to[2] = z;
}

double dot(const Spatial &a, const Spatial &b) {
  double sum = 0;
  for (size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

// a motion's rate of change in a frame that moves with v
Spatial turned(const Spatial &v, const Spatial &motion) {
  double a[3], b[3], c[3];
  cross(v.data(), motion.data(), a);
  cross(v.data(), motion.data() + 3, b);
  cross(v.data() + 3, motion.data(), c);
  return {a[0], a[1], a[2], b[0] + c[0], b[1] + c[1], b[2] + c[2]};
}

// the same of a force
Spatial turned_force(const Spatial &v, const Spatial &force) {
  double a[3], b[3], c[3];
  cross(v.data(), force.data(), a);
  cross(v.data() + 3, force.data() + 3, b);
  cross(v.data(), force.data() + 3, c);
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], c[0], c[1], c[2]};
}

// a matrix kept as its upper triangle
Spatial product(const double *inertia, const Spatial &of) {
  Spatial found{};
  for (size_t i = 0, at = 0; i < 6; ++i) {
    found[i] += inertia[at++] * of[i];
    for (size_t j = i + 1; j < 6; ++j, ++at) {
      found[i] += inertia[at] * of[j];
      found[j] += inertia[at] * of[i];
    }
  }
  return found;
}

void multiply(const double *a, const double *b, double *to) {
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      to[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

void turn(const double *rotation, const double *v, double *to) {
  double found[3];
  for (size_t i = 0; i < 3; ++i)
    found[i] = rotation[3 * i] * v[0] + rotation[3 * i + 1] * v[1] + rotation[3 * i + 2] * v[2];
  std::copy_n(found, 3, to);
}

void turn_back(const double *rotation, const double *v, double *to) {
  double found[3];
  for (size_t i = 0; i < 3; ++i)
    found[i] = rotation[i] * v[0] + rotation[3 + i] * v[1] + rotation[6 + i] * v[2];
  std::copy_n(found, 3, to);
}

constexpr double nothing[3] = {0, 0, 0}, no_turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

// about a point from which the centre is at c, of a body with m and I about its centre
void rigid_inertia(double m, const double *about_centre, const double *c, double *to) {
  const double square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
  const double lever[9] = {0, -m * c[2], m * c[1], m * c[2], 0, -m * c[0], -m * c[1], m * c[0], 0};
  size_t at = 0;
  for (size_t i = 0; i < 6; ++i)
    for (size_t j = i; j < 6; ++j, ++at) {
      if (i >= 3)
        to[at] = i == j ? m : 0.0;
      else if (j >= 3)
        to[at] = lever[3 * i + j - 3];
      else
        to[at] = about_centre[3 * i + j] + m * ((i == j ? square : 0.0) - c[i] * c[j]);
    }
}

}  // namespace

Bodies::Bodies(std::vector<Joint> joints, const double gravity[3])
    : joints_(std::move(joints)), states_(joints_.size()) {
  std::copy_n(gravity, 3, gravity_);
  std::vector<size_t> sizes;
  for (size_t k = 0; k < joints_.size(); ++k) {
    const int parent = joints_[k].parent;
    if (parent >= static_cast<int>(k)) throw nanobind::value_error("a parent after its joint");
    if (parent < 0) {
      sizes.push_back(0);
      last_.push_back(k);
    }
    tree_.push_back(parent < 0 ? sizes.size() - 1 : tree_[static_cast<size_t>(parent)]);
    number_.push_back(sizes[tree_[k]]++);
    last_[tree_[k]] = k;
  }
  trees_ = sizes.size();
  for (const size_t size : sizes) most_joints_ = std::max(most_joints_, size);
}

void Bodies::place(size_t k, double q) {
  const Joint &joint = joints_[k];
  State &s = states_[k];
  const bool hangs = joint.parent < 0;
  const State *parent = hangs ? nullptr : &states_[static_cast<size_t>(joint.parent)];
  const double *outer = hangs ? no_turn : parent->rotation;
  double from[9], along[3];
  multiply(outer, joint.placement.rotation, from);
  turn(outer, joint.placement.origin, s.origin);
  for (size_t i = 0; i < 3; ++i) s.origin[i] += hangs ? 0.0 : parent->origin[i];
  const auto kind = static_cast<size_t>(joint.kind), axis = kind % 3;
  for (size_t i = 0; i < 3; ++i) along[i] = from[3 * i + axis];
  if (kind < 3) {
    for (size_t i = 0; i < 3; ++i) s.origin[i] += q * along[i];
    std::copy_n(from, 9, s.rotation);
    s.axis = {0, 0, 0, along[0], along[1], along[2]};
    return;
  }
  const double c = cos(q), t = sin(q);
  const size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
  for (size_t i = 0; i < 3; ++i) {
    s.rotation[3 * i + axis] = along[i];
    s.rotation[3 * i + next] = c * from[3 * i + next] + t * from[3 * i + last];
    s.rotation[3 * i + last] = c * from[3 * i + last] - t * from[3 * i + next];
  }
  s.axis = {along[0], along[1], along[2], 0, 0, 0};
}

void Bodies::move(const double *q, const double *v) {
  for (size_t k = 0; k < joints_.size(); ++k) place(k, q[k]);
  for (size_t k = 0; k < joints_.size(); ++k) {
    State &s = states_[k];
    std::copy_n(states_[last_[tree_[k]]].origin, 3, s.point);
    if (joints_[k].kind >= JointKind::about_x) {
      double lever[3];
      for (size_t i = 0; i < 3; ++i) lever[i] = s.origin[i] - s.point[i];
      cross(lever, s.axis.data(), s.axis.data() + 3);
    }
    start(k, v[k]);
  }
}

// velocity, and the rigid body's part of all else
void Bodies::start(size_t k, double rate) {
  const Joint &joint = joints_[k];
  State &s = states_[k];
  s.velocity = joint.parent < 0 ? Spatial{} : states_[static_cast<size_t>(joint.parent)].velocity;
  s.change = turned(s.velocity, s.axis);
  for (size_t i = 0; i < 6; ++i) {
    s.change[i] *= rate;
    s.velocity[i] += rate * s.axis[i];
  }
  s.force.fill(0.0);
  if (joint.mass == 0) {
    std::fill_n(s.inertia, 21, 0.0);
    s.carried.fill(0.0);
    return;
  }
  double centre[3], half[9], back[9], about[9];
  turn(s.rotation, joint.centre, centre);
  for (size_t i = 0; i < 3; ++i) centre[i] += s.origin[i] - s.point[i];
  multiply(s.rotation, joint.inertia, half);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) back[3 * i + j] = s.rotation[3 * j + i];
  multiply(half, back, about);
  rigid_inertia(joint.mass, about, centre, s.inertia);
  s.carried = turned_force(s.velocity, product(s.inertia, s.velocity));
}

void Bodies::load_in_world(size_t joint, const double *force, const double *moment) {
  State &s = states_[joint];
  double lever[3], turning[3];
  for (size_t i = 0; i < 3; ++i) lever[i] = s.origin[i] - s.point[i];
  cross(lever, force, turning);
  for (size_t i = 0; i < 3; ++i) {
    s.force[i] += moment[i] + turning[i];
    s.force[3 + i] += force[i];
  }
}

void Bodies::load(size_t joint, const double *wrench) {
  double force[3], moment[3];
  turn(states_[joint].rotation, wrench, force);
  turn(states_[joint].rotation, wrench + 3, moment);
  load_in_world(joint, force, moment);
}

void Bodies::accelerate(const double *tau, double *found) {
  for (State &s : states_)
    for (size_t i = 0; i < 6; ++i) s.carried[i] -= s.force[i];
  for (size_t k = joints_.size(); k-- > 0;) {
    State &s = states_[k];
    s.drawn = product(s.inertia, s.axis);
    s.along = dot(s.axis, s.drawn);
    found[k] = tau[k] - dot(s.axis, s.carried);
    if (joints_[k].parent < 0) continue;
    State &parent = states_[static_cast<size_t>(joints_[k].parent)];
    for (size_t i = 0, at = 0; i < 6; ++i)
      for (size_t j = i; j < 6; ++j, ++at) s.inertia[at] -= s.drawn[i] * s.drawn[j] / s.along;
    const Spatial bent = product(s.inertia, s.change);
    for (size_t i = 0; i < 6; ++i)
      parent.carried[i] += s.carried[i] + bent[i] + s.drawn[i] * (found[k] / s.along);
    for (size_t at = 0; at < 21; ++at) parent.inertia[at] += s.inertia[at];
  }
  for (size_t k = 0; k < joints_.size(); ++k) {
    State &s = states_[k];
    const int parent = joints_[k].parent;
    if (parent < 0)
      s.acceleration = {0, 0, 0, -gravity_[0], -gravity_[1], -gravity_[2]};
    else
      s.acceleration = states_[static_cast<size_t>(parent)].acceleration;
    for (size_t i = 0; i < 6; ++i) s.acceleration[i] += s.change[i];
    found[k] = (found[k] - dot(s.drawn, s.acceleration)) / s.along;
    for (size_t i = 0; i < 6; ++i) s.acceleration[i] += found[k] * s.axis[i];
  }
}

void Bodies::respond(double *matrix, size_t columns, size_t stride) {
  for (size_t c = 0; c < columns; ++c) {
    double *found = matrix + c;
    for (State &s : states_) s.carried.fill(0.0);
    for (size_t k = joints_.size(); k-- > 0;) {
      const State &s = states_[k];
      found[k * stride] -= dot(s.axis, s.carried);
      if (joints_[k].parent < 0) continue;
      State &parent = states_[static_cast<size_t>(joints_[k].parent)];
      for (size_t i = 0; i < 6; ++i)
        parent.carried[i] += s.carried[i] + s.drawn[i] * (found[k * stride] / s.along);
    }
    for (size_t k = 0; k < joints_.size(); ++k) {
      State &s = states_[k];
      const int parent = joints_[k].parent;
      s.acceleration = parent < 0 ? Spatial{} : states_[static_cast<size_t>(parent)].acceleration;
      double &value = found[k * stride];
      value = (value - dot(s.drawn, s.acceleration)) / s.along;
      for (size_t i = 0; i < 6; ++i) s.acceleration[i] += value * s.axis[i];
    }
  }
}

Placement Bodies::placement(size_t joint) const {
  Placement found;
  std::copy_n(states_[joint].rotation, 9, found.rotation);
  std::copy_n(states_[joint].origin, 3, found.origin);
  return found;
}

void Bodies::velocity(size_t joint, double *found) const {
  const State &s = states_[joint];
  double lever[3], linear[3];
  for (size_t i = 0; i < 3; ++i) lever[i] = s.origin[i] - s.point[i];
  cross(s.velocity.data(), lever, linear);
  for (size_t i = 0; i < 3; ++i) linear[i] += s.velocity[3 + i];
  turn_back(s.rotation, linear, found);
  turn_back(s.rotation, s.velocity.data(), found + 3);
}

double Bodies::generalised(const State &on, size_t joint, const double *force,
                           const double *moment) const {
  const State &s = states_[joint];
  double lever[3], turning[3], sum = 0;
  for (size_t i = 0; i < 3; ++i) lever[i] = s.origin[i] - s.point[i];
  cross(lever, force, turning);
  for (size_t i = 0; i < 3; ++i)
    sum += on.axis[i] * (moment[i] + turning[i]) + on.axis[3 + i] * force[i];
  return sum;
}

}  // namespace railpatch::python
