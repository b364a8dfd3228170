// The classes railpatch._core.Drive and .Drives: see wheelset_demo/vehicle/drives.py.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "convert.hpp"
#include "numeric/elementary.hpp"
#include "vehicle.hpp"

namespace railpatch::python {

namespace {

// of a body's columns; of a wheelset's carrier the first five
enum { kX, kY, kZ, kYaw, kRoll, kPitch, kPlaces };

struct Control {
  double target, least, proportional, integral, period, rate;
};

// torques of some wheelsets by one table and, with a control, their slip
class Drive {
 public:
  Drive(const Values &radii, const Values &times, const Values &torques, const Values &control)
      : radii_(radii.data(), radii.data() + radii.shape(0)),
        times_(times.data(), times.data() + times.shape(0)),
        torques_(torques.data(), torques.data() + torques.shape(0)) {
    if (times_.empty() || times_.size() != torques_.size() || radii_.empty())
      throw nb::value_error("a point or more, a wheelset or more");
    if (control.shape(0) != 0 && control.shape(0) != 6)
      throw nb::value_error("no control or its six numbers");
    controlled_ = control.shape(0) == 6;
    if (controlled_)
      control_ = {control(0), control(1), control(2), control(3), control(4), control(5)};
    braking_ = *std::min_element(torques_.begin(), torques_.end()) < 0;
    // a run begins with what is wanted then
    torque_.assign(radii_.size(), wanted(0.0));
    integral_.assign(radii_.size(), std::abs(torque_[0]));
  }

  // N m, straight lines between the points, held before and after
  double wanted(double time) const {
    const auto next = std::upper_bound(times_.begin(), times_.end(), time);
    if (next == times_.begin()) return torques_.front();
    if (next == times_.end()) return torques_.back();
    const auto k = static_cast<size_t>(next - times_.begin());
    const double slope = (torques_[k] - torques_[k - 1]) / (times_[k] - times_[k - 1]);
    return torques_[k - 1] + slope * (time - times_[k - 1]);
  }

  // Before a step: whether torques are sampled, and what is wanted.
  bool due(double time) {
    wanted_ = wanted(time);
    if (!controlled_) {
      std::fill(torque_.begin(), torque_.end(), wanted_);
      return false;
    }
    if (time < static_cast<double>(samples_) * control_.period - 1e-9) return false;
    samples_ = static_cast<int64_t>(std::floor(time / control_.period + 1e-6)) + 1;
    return true;
  }

  // a wheelset's torque from its speed of turning, rad/s, and the body's, m/s
  void sample(size_t i, double speed, double spin) {
    const double found = radii_[i] * std::abs(spin) - std::abs(speed);
    const double slip = braking_ ? -found : found;
    const double error = std::max(control_.target * std::abs(speed), control_.least) - slip;
    const double most = std::abs(wanted_);
    const double gained = integral_[i] + control_.integral * control_.period * error;
    integral_[i] = std::clamp(gained, 0.0, most);
    const double asked = std::clamp(control_.proportional * error + integral_[i], 0.0, most);
    const double before = std::abs(torque_[i]), change = control_.rate * control_.period;
    torque_[i] = std::copysign(std::clamp(asked, before - change, before + change), wanted_);
  }

  void update(double time, double speed, const Values &spins) {
    if (spins.shape(0) != count()) throw nb::value_error("a speed of turning a wheelset");
    if (!due(time)) return;
    for (size_t i = 0; i < count(); ++i) sample(i, speed, spins(i));
  }

  size_t count() const { return radii_.size(); }
  double *torque() { return torque_.data(); }

 private:
  std::vector<double> radii_, times_, torques_, torque_, integral_;
  Control control_{};
  bool controlled_ = false, braking_ = false;
  double wanted_ = 0;
  int64_t samples_ = 0;
};

using Columns = std::array<size_t, kPlaces>;

// columns of a wheelset's carrier and of its turning about the axle
struct Axle {
  size_t yaw, roll, spin;
};

struct Part {
  Drive drive;
  std::vector<size_t> wheelsets;
  Columns body;
};

class Drives final : public VehicleDrives {
 public:
  Drives(const IndexGrid &carriers, const Indices &spins, size_t width) : width_(width) {
    if (carriers.shape(1) != kPitch || spins.shape(0) != carriers.shape(0))
      throw nb::value_error("five columns and one a wheelset");
    for (size_t k = 0; k < spins.shape(0); ++k)
      axles_.push_back(
          {column_of(carriers(k, kYaw)), column_of(carriers(k, kRoll)), column_of(spins(k))});
    torque_.resize(axles_.size());
  }

  void add(const Drive &drive, const Indices &wheelsets, const Indices &body) {
    if (wheelsets.shape(0) != drive.count() || body.shape(0) != kPlaces)
      throw nb::value_error("an index a wheelset, six columns");
    Part part{drive, {}, columns_of(body.data())};
    for (size_t i = 0; i < wheelsets.shape(0); ++i) {
      if (wheelsets(i) < 0 || static_cast<size_t>(wheelsets(i)) >= axles_.size())
        throw nb::index_error();
      part.wheelsets.push_back(static_cast<size_t>(wheelsets(i)));
    }
    parts_.push_back(part);
    collect();
  }

  void update(double time, const double *q, const double *v) override {
    for (Part &part : parts_) {
      if (!part.drive.due(time)) continue;
      const double yaw = q[part.body[kYaw]];
      const double speed = cos(yaw) * v[part.body[kX]] + sin(yaw) * v[part.body[kY]];
      for (size_t i = 0; i < part.wheelsets.size(); ++i)
        part.drive.sample(i, speed, v[axles_[part.wheelsets[i]].spin]);
    }
    collect();
  }

  // A torque turns the wheelset about its axle, the body the other way; forward is a negative turn
  // about y.
  double add_forces(const double *q, const double *v, double *tau) override {
    double power = 0;
    for (Part &part : parts_)
      for (size_t i = 0; i < part.wheelsets.size(); ++i) {
        const Axle &on = axles_[part.wheelsets[i]];
        const Columns &body = part.body;
        double axle[3], across[3];
        lateral_axis(q[on.yaw], q[on.roll], axle);
        lateral_axis(q[body[kYaw]], q[body[kRoll]], across);
        const double turning[kPlaces] = {axle[2],  about(q[on.yaw], axle),      1.0,
                                         -axle[2], -about(q[body[kYaw]], axle), -dot(axle, across)};
        const size_t columns[kPlaces] = {on.yaw,     on.roll,     on.spin,
                                         body[kYaw], body[kRoll], body[kPitch]};
        double rate = 0;
        for (size_t j = 0; j < kPlaces; ++j) {
          tau[columns[j]] -= part.drive.torque()[i] * turning[j];
          rate += turning[j] * v[columns[j]];
        }
        power -= part.drive.torque()[i] * rate;
      }
    return power;
  }

  void update_from(double time, const Values &q, const Values &v) {
    check(q);
    check(v);
    update(time, q.data(), v.data());
  }

  double add_to(const Values &q, const Values &v,
                nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu> tau) {
    check(q);
    check(v);
    if (tau.shape(0) < width_) throw nb::value_error("a force of another size");
    return add_forces(q.data(), v.data(), tau.data());
  }

  double *torque() { return torque_.data(); }
  size_t count() const { return torque_.size(); }

 private:
  static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  // of a body's y in the world
  static void lateral_axis(double yaw, double roll, double *to) {
    const double c = cos(roll);
    to[0] = -sin(yaw) * c;
    to[1] = cos(yaw) * c;
    to[2] = sin(roll);
  }

  // of a body's rolling, about its level x, along an axle
  static double about(double yaw, const double *axle) {
    return axle[0] * cos(yaw) + axle[1] * sin(yaw);
  }

  size_t column_of(int64_t index) const {
    if (index < 0 || static_cast<size_t>(index) >= width_) throw nb::index_error();
    return static_cast<size_t>(index);
  }

  Columns columns_of(const int64_t *from) const {
    Columns found;
    for (size_t i = 0; i < kPlaces; ++i) found[i] = column_of(from[i]);
    return found;
  }

  void check(const Values &state) const {
    if (state.shape(0) < width_) throw nb::value_error("a state of another size");
  }

  void collect() {
    std::fill(torque_.begin(), torque_.end(), 0.0);
    for (Part &part : parts_)
      for (size_t i = 0; i < part.wheelsets.size(); ++i)
        torque_[part.wheelsets[i]] += part.drive.torque()[i];
  }

  size_t width_;
  std::vector<Axle> axles_;
  std::vector<Part> parts_;
  std::vector<double> torque_;
};

using Array = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

template <typename C>
Array torque_of(nb::handle_t<C> self) {
  C &found = nb::cast<C &>(self);
  return Array(found.torque(), {found.count()}, self);
}

}  // namespace

void bind_drives(nb::module_ &m) {
  nb::class_<Drive>(m, "Drive", "Torques of wheelsets by one table.")
      .def(nb::init<const Values &, const Values &, const Values &, const Values &>(),
           nb::arg("radii"), nb::arg("times"), nb::arg("torques"), nb::arg("control"),
           "radii: m, of the wheelsets; times, torques: s, N m, points of what is wanted; control: "
           "none, or target (-), least (m/s), proportional, integral, period (s), rate (N m/s).")
      .def("wanted", &Drive::wanted, nb::arg("time"), "N m, at a time (s).")
      .def("update", &Drive::update, nb::arg("time"), nb::arg("speed"), nb::arg("spins"),
           "Before a step. speed: m/s, of the body; spins: rad/s, of the wheelsets.")
      .def_prop_ro("torque", &torque_of<Drive>, "N m, of each, now.");
  using D = Drives;
  nb::class_<VehicleDrives>(m, "VehicleDrives", "What a vehicle's steps ask of drives.");
  nb::class_<D, VehicleDrives>(m, "Drives", "All drives of a vehicle.")
      .def(nb::init<const IndexGrid &, const Indices &, size_t>(), nb::arg("carriers"),
           nb::arg("spins"), nb::arg("width"),
           "carriers, spins: columns of the wheelsets' x, y, z, yaw, roll and turns about "
           "the axle, in a state of `width` numbers.")
      .def("append", &D::add, nb::arg("drive"), nb::arg("wheelsets"), nb::arg("body"),
           "A drive of these wheelsets, a copy; body: columns of the one that carries the motors.")
      .def("update", &D::update_from, nb::arg("time"), nb::arg("q"), nb::arg("v"),
           "Before a step from a time (s): torques until the next one.")
      .def("add", &D::add_to, nb::arg("q"), nb::arg("v"), nb::arg("tau"),
           "Adds to the generalised force; the torques' power (W).")
      .def_prop_ro("torque", &torque_of<D>, "N m, on each wheelset now.");
}

}  // namespace railpatch::python
