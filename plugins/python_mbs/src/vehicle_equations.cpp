// See vehicle_equations.hpp.

#include "vehicle_equations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "numeric/elementary.hpp"
#include "workers.hpp"

namespace railpatch::python {

namespace {

// of coordinates (m, rad) and velocities: differences of numbers with some ten digits leave six
constexpr double small = 1e-6;

enum { kPitch = 5 };
// columns of a wheelset's state that a rail's lateral and vertical deviations and its vertical rate
// move against
constexpr size_t against[3] = {1, 2, 8};
// and those that its places and rates on a support move against
constexpr size_t on_rail[2][2] = {{1, 2}, {7, 8}};

}  // namespace

VehicleEquations::VehicleEquations(VehicleContacts &contacts, VehicleCourse &course,
                                   VehicleSuspension &suspension, VehicleExtras extras,
                                   Bodies bodies, VehicleNumbers numbers)
    : contacts_(contacts),
      course_(course),
      suspension_(suspension),
      extras_(extras),
      bodies_(std::move(bodies)),
      numbers_(std::move(numbers)),
      bodies_n_(bodies_.count()),
      n_(bodies_n_ + (extras.support != nullptr ? extras.support->count() : 0)),
      m_(suspension.series()) {
  const size_t count = contacts.count();
  const bool fits =
      suspension.width() == bodies_n_ && course.width() == bodies_n_ && course.count() == count &&
      numbers_.axle.size() == count && numbers_.radius.size() == count &&
      n_ - bodies_n_ == (extras.support != nullptr ? count * extras.support->width() : 0);
  if (!fits) throw nb::value_error("parts of a vehicle do not fit together");
  for (const size_t joint : numbers_.axle)
    if (joint >= bodies_n_) throw nb::index_error();
  for (const size_t column : numbers_.ahead)
    if (column >= bodies_n_) throw nb::index_error();
  const size_t most = bodies_.most_joints();
  rates_.resize(size());
  powers_.resize(powers_count());
  for (auto *to : {&tau_, &moved_, &found_, &base_}) to->resize(bodies_n_);
  slopes_.resize(count * 6);
  wrenches_.resize(count * 6);
  by_state_.resize(n_ * size());
  forces_.resize(bodies_n_ * size());
  by_inputs_.resize(n_ * known());
  inputs_.resize(bodies_n_ * known());
  series_by_v_.resize(m_ * n_);
  series_by_series_.resize(m_);
  loads_.resize(count * 6);
  states_.resize(count * kState);
  by_joint_.resize(2 * count * most * kState);
  inverse_.resize(bodies_n_ * most);
}

void VehicleEquations::give_motion() {
  for (size_t k = 0; k < wheelsets(); ++k) {
    const Placement at = bodies_.placement(numbers_.axle[k]);
    double *row = contacts_.motion() + k * kMotion;
    std::copy_n(at.rotation, 9, row);
    std::copy_n(at.origin, 3, row + 9);
    bodies_.velocity(numbers_.axle[k], row + 12);
  }
}

int VehicleEquations::evaluate(const double *values) {
  const double *q = values, *v = values + n_, *series = values + 2 * n_;
  bodies_.move(q, v);
  course_.place_all(q, v, contacts_.tracks(), contacts_.rails());
  std::copy_n(course_.positions(), wheelsets(), contacts_.positions());
  VehicleSupport *support = extras_.support;
  if (support != nullptr) support->put_rails(q + bodies_n_, v + bodies_n_, contacts_.rails());
  if (extras_.wet != nullptr) extras_.wet->put(contacts_.positions(), contacts_.water());
  give_motion();
  ++evaluations;
  const double begin = thread_seconds();
  const int status = contacts_.solve();
  contact_seconds += thread_seconds() - begin;
  double contact = 0, friction = 0;
  for (size_t k = 0; k < wheelsets(); ++k) {
    bodies_.load(numbers_.axle[k], contacts_.wrench() + 6 * k);
    contact += contacts_.power()[5 * k];
  }
  contact += add_slopes();
  powers_[2] = suspension_.find_forces(q, v, series);
  std::copy_n(suspension_.generalised(), bodies_n_, tau_.data());
  powers_[3] = drive(q, v);
  if (extras_.drives != nullptr) powers_[3] += extras_.drives->add_forces(q, v, tau_.data());
  if (support != nullptr) {
    contact += support->find_rates(contacts_.wheels(), kWheel, rates_.data() + n_ + bodies_n_);
    powers_[2] += support->damping_power();
  }
  for (size_t k = 0; k < 2 * wheelsets(); ++k) {
    powers_[kWorks + k] = contacts_.wheels()[kWheel * k + 6];
    friction += powers_[kWorks + k];
  }
  powers_[0] = contact;
  powers_[1] = friction;
  std::copy_n(v, n_, rates_.data());
  bodies_.accelerate(tau_.data(), rates_.data() + n_);
  std::copy_n(suspension_.series_rates(), m_, rates_.data() + 2 * n_);
  return status;
}

// W, of what rails that are not level add
double VehicleEquations::add_slopes() {
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  if (!sloped || course_.level()) return 0.0;
  std::fill(wrenches_.begin(), wrenches_.end(), 0.0);
  for (size_t w = 0; w < 2 * wheelsets(); ++w) {
    double *found = slopes_.data() + 3 * w, *sum = wrenches_.data() + 6 * (w / 2);
    slope_wrench(contacts_.wheels() + kWheel * w, contacts_.lateral()[w], course_.slopes() + 2 * w,
                 numbers_.radius[w / 2], w % 2 == 0 ? -numbers_.arm : numbers_.arm, found);
    sum[0] += found[0];
    sum[4] += found[1];
    sum[5] += found[2];
  }
  contacts_.place_wrenches(wrenches_.data());
  double power = 0;
  for (size_t k = 0; k < wheelsets(); ++k) {
    const double *placed = contacts_.placed() + 6 * k;
    const double *velocity = contacts_.motion() + k * kMotion + 12;
    bodies_.load(numbers_.axle[k], placed);
    for (size_t i = 0; i < 6; ++i) power += placed[i] * velocity[i];
  }
  return power;
}

void VehicleEquations::ahead(const double *q, double *found) const {
  const double yaw = q[numbers_.ahead[kAhead]];
  found[0] = cos(yaw);
  found[1] = sin(yaw);
  found[2] = numbers_.hold;
}

double VehicleEquations::drive(const double *q, const double *v) {
  double along[kAhead], speed = 0;
  ahead(q, along);
  const size_t *at = numbers_.ahead;
  for (size_t i = 0; i < kAhead; ++i) speed += along[i] * v[at[i]];
  const double force = numbers_.gain * (numbers_.speed - speed);
  for (size_t i = 0; i < kAhead; ++i) tau_[at[i]] += force * along[i];
  return force * speed;
}

// The wheelsets' forces as they are held in the world.
void VehicleEquations::load_bodies() {
  for (size_t k = 0; k < wheelsets(); ++k)
    bodies_.load_in_world(numbers_.axle[k], loads_.data() + 6 * k, loads_.data() + 6 * k + 3);
}

void VehicleEquations::differentiate(const double *values, const size_t *wheelsets, size_t count) {
  ++renewals;
  const double begin = thread_seconds();
  contacts_.find_derivatives(wheelsets, count);
  std::fill(forces_.begin(), forces_.end(), 0.0);
  std::fill(inputs_.begin(), inputs_.end(), 0.0);
  std::fill(by_inputs_.begin(), by_inputs_.end(), 0.0);
  bend_inertia(values);
  for (size_t k = 0; k < this->wheelsets(); ++k) add_contacts(k);
  suspension_.add_derivatives(forces_.data(), n_);
  suspension_.series_derivatives(series_by_v_.data(), n_, series_by_series_.data());
  double along[kAhead];
  ahead(values, along);
  for (size_t i = 0; i < kAhead; ++i)
    for (size_t j = 0; j < kAhead; ++j)
      forces_[numbers_.ahead[i] * size() + n_ + numbers_.ahead[j]] -=
          numbers_.gain * along[i] * along[j];
  find_inverse();
  to_accelerations(forces_.data(), by_state_.data(), size());
  to_accelerations(inputs_.data(), by_inputs_.data(), known());
  if (extras_.support != nullptr) add_support();
  derivative_seconds += thread_seconds() - begin;
}

void VehicleEquations::find_column(size_t wheelset, size_t column) {
  const double begin = thread_seconds();
  contacts_.find_column(wheelset, column);
  derivative_seconds += thread_seconds() - begin;
}

// How accelerations change with the bodies' places and velocities while all forces stay as they are
// in the world, at points that move with their joints, by differences. Trees do not know of each
// other: one coordinate of each moves at a time.
void VehicleEquations::bend_inertia(const double *values) {
  for (size_t k = 0; k < wheelsets(); ++k) {
    double *row = loads_.data() + 6 * k;
    std::fill_n(row, 6, 0.0);
    const Placement at = bodies_.placement(numbers_.axle[k]);
    for (const double *wrench : {contacts_.wrench() + 6 * k, contacts_.placed() + 6 * k}) {
      if (wrench == contacts_.placed() + 6 * k && (!sloped || course_.level())) continue;
      for (size_t i = 0; i < 6; ++i)
        for (size_t j = 0; j < 3; ++j)
          row[i] += at.rotation[3 * (i % 3) + j] * wrench[3 * (i / 3) + j];
    }
    contacts_.state_at(k, contacts_.motion() + k * kMotion, contacts_.motion() + k * kMotion + 12,
                       states_.data() + k * kState);
  }
  std::copy_n(rates_.data() + n_, bodies_n_, base_.data());
  std::fill(by_state_.begin(), by_state_.end(), 0.0);
  for (size_t number = 0; number < bodies_.most_joints(); ++number)
    for (const bool velocity : {false, true}) vary(values, number, velocity);
  bodies_.move(values, values + n_);
  load_bodies();
  bodies_.accelerate(tau_.data(), found_.data());
}

// One coordinate of each tree, or its velocity.
void VehicleEquations::vary(const double *values, size_t number, bool velocity) {
  const size_t most = bodies_.most_joints(), shift = velocity ? n_ : 0;
  std::copy_n(values + shift, bodies_n_, moved_.data());
  for (size_t i = 0; i < bodies_n_; ++i)
    if (bodies_.number(i) == number) moved_[i] += small;
  bodies_.move(velocity ? values : moved_.data(), velocity ? moved_.data() : values + n_);
  load_bodies();
  bodies_.accelerate(tau_.data(), found_.data());
  for (size_t j = 0; j < bodies_n_; ++j) {
    if (bodies_.number(j) != number) continue;
    for (size_t i = 0; i < bodies_n_; ++i)
      if (bodies_.tree(i) == bodies_.tree(j))
        by_state_[i * size() + shift + j] = (found_[i] - base_[i]) / small;
  }
  for (size_t k = 0; k < wheelsets(); ++k) {
    double placement[12], speed[6], state[kState];
    const Placement at = bodies_.placement(numbers_.axle[k]);
    std::copy_n(at.rotation, 9, placement);
    std::copy_n(at.origin, 3, placement + 9);
    bodies_.velocity(numbers_.axle[k], speed);
    contacts_.state_at(k, placement, speed, state);
    double *to = by_joint_.data() + ((velocity ? wheelsets() : 0) + k) * most * kState;
    for (size_t i = 0; i < kState; ++i) {
      double change = state[i] - states_[k * kState + i];
      if (i == kPitch) change -= 2 * std::numbers::pi * std::round(change / (2 * std::numbers::pi));
      to[number * kState + i] = change / small;
    }
  }
}

// Generalised forces by the motion of the wheelset's tree and by its rails.
void VehicleEquations::add_contacts(size_t k) {
  const size_t most = bodies_.most_joints(), joint = numbers_.axle[k];
  const double *left = contacts_.by_side() + k * 144, *right = left + 72;
  for (const bool velocity : {false, true}) {
    const double *states = by_joint_.data() + ((velocity ? wheelsets() : 0) + k) * most * kState;
    for (size_t j = 0; j < bodies_n_; ++j) {
      if (bodies_.tree(j) != bodies_.tree(joint)) continue;
      const double *by = states + bodies_.number(j) * kState;
      double wrench[6] = {};
      for (size_t i = 0; i < 6; ++i)
        for (size_t c = 0; c < kState; ++c)
          wrench[i] += (left[i * kState + c] + right[i * kState + c]) * by[c];
      add_wrench(k, wrench, forces_.data() + (velocity ? n_ : 0) + j, size());
    }
  }
  const size_t count = wheelsets();
  for (size_t side = 0; side < 2; ++side)
    for (size_t input = 0; input < 3; ++input) {
      // a rail that moves is a wheel that moves the other way
      double wrench[6];
      for (size_t i = 0; i < 6; ++i)
        wrench[i] = -(side == 0 ? left : right)[i * kState + against[input]];
      const size_t column = input < 2 ? 4 * k + 2 * side + input : 4 * count + 2 * k + side;
      add_wrench(k, wrench, inputs_.data() + column, known());
    }
  if (extras_.support != nullptr) add_rails(k);
}

// What a wheelset's rails do to it as they move on their support.
void VehicleEquations::add_rails(size_t k) {
  const size_t first = bodies_n_ + k * extras_.support->width();
  for (size_t side = 0; side < 2; ++side)
    for (const bool velocity : {false, true})
      for (size_t way = 0; way < 2; ++way) {
        const double *by = contacts_.by_side() + k * 144 + side * 72 + on_rail[velocity][way];
        double wrench[6];
        for (size_t i = 0; i < 6; ++i) wrench[i] = -by[i * kState];
        const size_t column = (velocity ? n_ : 0) + first + 2 * side + way;
        add_wrench(k, wrench, forces_.data() + column, size());
      }
}

// Rows of the support: its springs and what the wheels feel, the other way.
void VehicleEquations::add_support() {
  const VehicleSupport &support = *extras_.support;
  const size_t width = support.width(), most = bodies_.most_joints(), count = wheelsets();
  for (size_t k = 0; k < count; ++k) {
    const size_t first = bodies_n_ + k * width, tree = bodies_.tree(numbers_.axle[k]);
    for (size_t i = 0; i < width; ++i) {
      double *row = by_state_.data() + (first + i) * size() + first;
      std::copy_n(support.by_places() + i * width, width, row);
      std::copy_n(support.by_rates() + i * width, width, row + n_);
    }
    for (size_t wheel = 0; wheel < 4; ++wheel) {
      const size_t side = wheel / 2, rail = first + 2 * side;
      const double *force = contacts_.by_side() + k * 144 + side * 72 + (1 + wheel % 2) * kState;
      double felt[kState];
      for (size_t c = 0; c < kState; ++c) felt[c] = force[c] / support.rail_mass();
      double *row = by_state_.data() + (first + wheel) * size();
      for (const bool velocity : {false, true}) {
        const size_t shift = velocity ? n_ : 0;
        const double *states = by_joint_.data() + ((velocity ? count : 0) + k) * most * kState;
        for (size_t j = 0; j < bodies_n_; ++j) {
          if (bodies_.tree(j) != tree) continue;
          const double *by = states + bodies_.number(j) * kState;
          for (size_t c = 0; c < kState; ++c) row[shift + j] -= felt[c] * by[c];
        }
        for (size_t way = 0; way < 2; ++way)
          row[shift + rail + way] += felt[on_rail[velocity][way]];
      }
      double *known_row = by_inputs_.data() + (first + wheel) * known();
      for (size_t way = 0; way < 2; ++way) known_row[4 * k + 2 * side + way] = felt[against[way]];
      known_row[4 * count + 2 * k + side] = felt[against[2]];
    }
  }
}

// A wrench on a wheelset, at its centre in track axes, into a column of generalised forces.
void VehicleEquations::add_wrench(size_t k, const double *wrench, double *column, size_t stride) {
  const double *track = contacts_.tracks() + 12 * k;
  double world[6] = {};
  for (size_t i = 0; i < 6; ++i)
    for (size_t j = 0; j < 3; ++j) world[i] += track[3 * (i % 3) + j] * wrench[3 * (i / 3) + j];
  bodies_.project(numbers_.axle[k], world, world + 3,
                  [&](size_t joint, double force) { column[joint * stride] += force; });
}

// [n][joints of a tree]: what a force on a joint of the same tree changes an acceleration by
void VehicleEquations::find_inverse() {
  const size_t most = bodies_.most_joints();
  for (size_t i = 0; i < bodies_n_; ++i)
    for (size_t j = 0; j < most; ++j) inverse_[i * most + j] = bodies_.number(i) == j ? 1.0 : 0.0;
  bodies_.respond(inverse_.data(), most, most);
}

// Adds what generalised forces change accelerations by.
void VehicleEquations::to_accelerations(const double *from, double *to, size_t stride) {
  const size_t most = bodies_.most_joints();
  for (size_t i = 0; i < bodies_n_; ++i)
    for (size_t j = 0; j < bodies_n_; ++j) {
      if (bodies_.tree(i) != bodies_.tree(j)) continue;
      const double factor = inverse_[i * most + bodies_.number(j)];
      const double *row = from + j * stride;
      double *sum = to + i * stride;
      for (size_t c = 0; c < stride; ++c) sum[c] += factor * row[c];
    }
}

}  // namespace railpatch::python
