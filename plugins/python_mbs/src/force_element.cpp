// The class railpatch._core.ForceElement: all wheels of a model in one call, without allocation.

#include "force_element.hpp"

#include <nanobind/ndarray.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "convert.hpp"
#include "vehicle.hpp"
#include "watching.hpp"
#include "workers.hpp"

namespace railpatch::python {

namespace {

using Array = nb::ndarray<nb::numpy, double, nb::ndim<2>>;

static_assert(sizeof(TrackState) == 12 * sizeof(double));

enum {
  kMotion = 18,
  kWrench = 6,
  kState = 12,
  kContact = 6,
  kPower = 5,
  kPlacement = 12,
  kBySide = 144
};
// rails: offset and velocity, both by side; wheels: force, moment, creep power, patches, power of
// friction
enum { kRails = 12, kWheel = 9, kWheels = 2 * kWheel, kLateral = 2, kWater = 3 };

Placement placement_at(const double *from) {
  Placement placement;
  std::copy_n(from, 9, placement.rotation);
  std::copy_n(from + 9, 3, placement.origin);
  return placement;
}

void check_placements(const Grid &rows, size_t count) {
  if (rows.shape(1) != kPlacement) throw nb::value_error("a placement has 12 numbers");
  if (rows.shape(0) != count) throw nb::value_error("one placement a contact");
}

// NaN where the scene has no tangential problem: no friction
double or_zero(double power) { return std::isnan(power) ? 0.0 : power; }

bool is_bad(rp_status status) { return status == RP_NOT_CONVERGED || status == RP_OUT_OF_RANGE; }

std::string unfound_derivatives(rp_status status) {
  return std::string("method.tolerance: the contact's derivatives are ") + rp_status_text(status) +
         ", allowed a tolerance at which they converge";
}

struct Wheelset {
  Steppable *contact;
  rp_input given, input;  // as the case has it, as it was last solved
  rp_result result;
  Placement placement;
  double seconds;  // spent
  double waiting;  // s, gone by since the last step
  std::exception_ptr refused;
  bool by_differences;  // derivatives
  bool curved;          // has a curved reference surface
  std::vector<double> rows[2];
};

// Arrays live as long as the element and are seen from Python as they are: one row a wheelset.
class ForceElement final : public VehicleContacts {
 public:
  ForceElement(const nb::list &contacts, const nb::list &inputs, const Values &radii,
               const Grid &placements, const Grid &tracks, double frame_speed, int threads,
               const nb::list &curved)
      : frame_speed_(frame_speed), count_(nb::len(contacts)) {
    const bool fits =
        nb::len(inputs) == count_ && radii.shape(0) == count_ && nb::len(curved) == count_;
    if (!fits) throw nb::value_error("one input and radius a contact");
    if (threads < 1) throw nb::value_error("one thread or more");
    check_placements(placements, count_);
    check_placements(tracks, count_);
    workers_ = std::make_unique<Workers>(threads);
    tracks_.assign(tracks.data(), tracks.data() + count_ * kPlacement);
    wheelsets_.resize(count_);
    radii_.assign(radii.data(), radii.data() + count_);
    for (size_t k = 0; k < count_; ++k) {
      Wheelset &w = wheelsets_[k];
      w.contact = nb::cast<Steppable *>(nb::object(contacts[k]));
      rp_default_input(&w.given);
      fill_input(nb::cast<nb::dict>(nb::object(inputs[k])), w.given);
      w.input = w.given;
      w.result = {};
      w.placement = placement_at(placements.data() + kPlacement * k);
      w.seconds = w.waiting = 0;
      w.by_differences = false;
      w.curved = nb::cast<bool>(nb::object(curved[k]));
    }
    positions_.resize(count_);
    rails_.resize(count_ * kRails);
    water_.assign(count_ * kWater, 0.0);
    for (size_t k = 0; k < count_; ++k) water_[k * kWater] = std::nan("");
    wheels_.resize(count_ * kWheels);
    lateral_.resize(count_ * kLateral);
    motion_.resize(count_ * kMotion);
    wrench_.resize(count_ * kWrench);
    placed_.resize(count_ * kWrench);
    state_.resize(count_);
    contact_.resize(count_ * kContact);
    power_.resize(count_ * kPower);
    by_side_.resize(count_ * kBySide);
    columns_.resize(count_ * kBySide);
  }

  int step() {
    nb::gil_scoped_release unlocked;
    return solve();
  }

  int solve() override {
    std::lock_guard<std::mutex> guard(mutex_);
    workers_->run(count_, [this](size_t k) { try_wheelset(k); });
    solves_ += count_;
    rp_status status = RP_NO_CONTACT;
    for (Wheelset &w : wheelsets_) {
      if (w.refused) std::rethrow_exception(w.refused);
      status = rp_join_status(status, w.result.status);
    }
    return status;
  }

  void find_derivatives(const size_t *wheelsets, size_t count) override {
    std::lock_guard<std::mutex> guard(mutex_);
    workers_->run(count, [this, wheelsets](size_t i) { try_derivatives(wheelsets[i]); });
    for (size_t i = 0; i < count; ++i)
      if (wheelsets_[wheelsets[i]].refused)
        std::rethrow_exception(wheelsets_[wheelsets[i]].refused);
  }

  const double *by_side() const override { return by_side_.data(); }
  bool by_differences(size_t k) const override { return wheelsets_[k].by_differences; }

  void find_column(size_t k, size_t column) override {
    std::lock_guard<std::mutex> guard(mutex_);
    double found[2][6];
    const rp_status status = wheelsets_[k].contact->differentiate_column(column, found);
    if (is_bad(status)) throw CallError{RP_ERROR_VALUE, unfound_derivatives(status)};
    double *to = columns_.data() + k * kBySide + column;
    for (size_t i = 0; i < 12; ++i) to[i * kState] = found[i / 6][i % 6];
  }

  void take_columns(size_t k) override {
    std::copy_n(columns_.data() + k * kBySide, kBySide, by_side_.data() + k * kBySide);
  }

  void state_at(size_t k, const double *placement, const double *velocity,
                double *state) const override {
    const Wheelset &w = wheelsets_[k];
    const TrackState s = track_state(placement_at(placement), velocity, w.placement, track(k),
                                     frame_speed_, radii_[k]);
    std::copy_n(&s.x, kState, state);
  }

  // for bodies that store heat; goes by in the next step that is solved
  void pass_time(double seconds) override {
    for (Wheelset &w : wheelsets_) w.waiting += seconds;
  }

  // a wrench at the centre, in track axes, to the row of `placed`
  void place(size_t k, double fx, double fy, double fz, double mx, double my, double mz) {
    if (k >= count_) throw nb::index_error();
    const double force[3] = {fx, fy, fz}, moment[3] = {mx, my, mz};
    joint_wrench(force, moment, joint(k), wheelsets_[k].placement, track(k),
                 placed_.data() + k * kWrench);
  }

  // the same for all wheelsets at once, [wheelsets, 6], then the power of these wrenches (W)
  double place_all(const Grid &wrenches) {
    if (wrenches.shape(0) != count_ || wrenches.shape(1) != kWrench)
      throw nb::value_error("one wrench of 6 a wheelset");
    place_wrenches(wrenches.data());
    double power = 0;
    for (size_t k = 0; k < count_; ++k)
      for (int i = 0; i < kWrench; ++i)
        power += placed_[k * kWrench + i] * motion_[k * kMotion + 12 + i];
    return power;
  }

  void place_wrenches(const double *given) override {
    for (size_t k = 0; k < count_; ++k, given += kWrench)
      joint_wrench(given, given + 3, joint(k), wheelsets_[k].placement, track(k),
                   placed_.data() + k * kWrench);
  }

  nb::dict result(size_t k) const {
    if (k >= count_) throw nb::index_error();
    return result_dict(wheelsets_[k].result);
  }

  nb::list warnings() const {
    uint32_t bits = 0;
    for (const Wheelset &w : wheelsets_) bits |= w.result.warnings;
    return warnings_of(bits);
  }

  double seconds() const {
    double sum = 0;
    for (const Wheelset &w : wheelsets_) sum += w.seconds;
    return sum;
  }
  size_t solves() const { return solves_; }
  double helper_seconds() { return workers_->seconds(); }

  double *tracks() override { return tracks_.data(); }
  double *positions() override { return positions_.data(); }
  double *rails() override { return rails_.data(); }
  double *water() override { return water_.data(); }
  double *wheels() override { return wheels_.data(); }
  double *lateral() override { return lateral_.data(); }

  double *motion() override { return motion_.data(); }
  double *wrench() override { return wrench_.data(); }
  double *placed() override { return placed_.data(); }
  double *state() { return &state_.data()->x; }
  double *contact() override { return contact_.data(); }
  double *power() override { return power_.data(); }
  size_t count() const override { return count_; }

 private:
  using Clock = std::chrono::steady_clock;

  Placement joint(size_t k) const {
    Placement placement;
    std::copy_n(motion_.data() + k * kMotion, 9, placement.rotation);
    std::copy_n(motion_.data() + k * kMotion + 9, 3, placement.origin);
    return placement;
  }

  Placement track(size_t k) const { return placement_at(tracks_.data() + k * kPlacement); }

  // a call that the core refuses is thrown again where all threads have ended
  void try_wheelset(size_t k) {
    wheelsets_[k].refused = nullptr;
    try {
      step_wheelset(k);
    } catch (...) {
      wheelsets_[k].refused = std::current_exception();
    }
  }

  void try_derivatives(size_t k) {
    Wheelset &w = wheelsets_[k];
    w.refused = nullptr;
    try {
      rp_jacobian found;
      w.contact->differentiate_all(found);
      if (is_bad(found.status)) throw CallError{RP_ERROR_VALUE, unfound_derivatives(found.status)};
      w.by_differences = found.kind == RP_DERIVATIVE_BY_DIFFERENCES;
      std::copy_n(&found.side[0][0][0], kBySide, by_side_.data() + k * kBySide);
    } catch (...) {
      w.refused = std::current_exception();
    }
  }

  void step_wheelset(size_t k) {
    Wheelset &w = wheelsets_[k];
    const Placement at = joint(k), on = track(k);
    const double *velocity = motion_.data() + k * kMotion + 12;
    TrackState s = track_state(at, velocity, w.placement, on, frame_speed_, radii_[k]);
    s.x += positions_[k];
    fill(s, w.input);
    move_rails(w, rails_.data() + k * kRails);
    wet_rails(w, water_.data() + k * kWater);
    const auto begin = Clock::now();
    w.input.time_step = w.waiting;
    w.contact->solve(w.input, w.result);
    if (w.result.status != RP_NOT_CONVERGED && w.result.status != RP_OUT_OF_RANGE) w.waiting = 0;
    w.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
    state_[k] = s;
    report(k, w.result);
    joint_wrench(w.result.force, w.result.moment, at, w.placement, on,
                 wrench_.data() + k * kWrench);
  }

  // what the rails deviate by in this step adds to what the case says
  static void move_rails(Wheelset &w, const double *moved) {
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < 3; ++i) {
        w.input.rail_offset[side][i] = w.given.rail_offset[side][i] + moved[3 * side + i];
        w.input.rail_velocity[side][i] = w.given.rail_velocity[side][i] + moved[6 + 3 * side + i];
      }
  }

  // the supply of liquid where the wheelset is, NaN: as the case says, and the work on the rails
  static void wet_rails(Wheelset &w, const double *water) {
    w.input.water_rate = std::isnan(water[0]) ? w.given.water_rate : water[0];
    for (int side = 0; side < 2; ++side)
      w.input.rail_work[side] = w.given.rail_work[side] + water[1 + side];
  }

  static void fill(const TrackState &s, rp_input &input) {
    input.x = s.x;
    input.pitch = s.pitch;
    input.y = s.y;
    input.z = s.z;
    input.roll = s.roll;
    input.yaw = s.yaw;
    input.speed = s.speed;
    input.vy = s.vy;
    input.vz = s.vz;
    input.roll_rate = s.roll_rate;
    input.yaw_rate = s.yaw_rate;
    input.pitch_rate = s.pitch_rate;
  }

  void report(size_t k, const rp_result &result) {
    std::copy_n(result.force, 3, contact_.data() + k * kContact);
    std::copy_n(result.moment, 3, contact_.data() + k * kContact + 3);
    double *power = power_.data() + k * kPower;
    power[0] = result.contact_power;
    power[1] = result.elastic_energy;
    power[2] = or_zero(result.creep_power);
    power[3] = or_zero(result.friction_power);
    power[4] = result.pressure_energy;
    double *wheel = wheels_.data() + k * kWheels;
    double *lateral = lateral_.data() + k * kLateral;
    int number = 0;
    for (const rp_side_result &side : result.side) {
      const double creep =
          wheelsets_[k].curved
              ? lateral_creep_of_rows(*wheelsets_[k].contact, number++, side, wheelsets_[k].rows)
              : lateral_creep(side);
      *lateral++ = side.force[1] - creep;
      std::copy_n(side.force, 3, wheel);
      std::copy_n(side.moment, 3, wheel + 3);
      wheel[6] = or_zero(side.creep_power);
      wheel[7] = side.patch_count;
      wheel[8] = or_zero(side.friction_power);
      wheel += kWheel;
    }
  }

  std::vector<Wheelset> wheelsets_;
  double frame_speed_;
  size_t count_;
  std::vector<double> radii_, motion_, wrench_, contact_, power_, placed_, by_side_, columns_;
  std::vector<double> tracks_, positions_, rails_, water_, wheels_, lateral_;
  std::vector<TrackState> state_;
  size_t solves_ = 0;
  std::unique_ptr<Workers> workers_;
  std::mutex mutex_;
};

// a view of the element's own memory that keeps the element alive
template <size_t Columns, double *(ForceElement::*Data)()>
Array view(nb::handle_t<ForceElement> self) {
  ForceElement &element = nb::cast<ForceElement &>(self);
  return Array((element.*Data)(), {element.count(), Columns}, self);
}

}  // namespace

void bind_force_element(nb::module_ &m) {
  using E = ForceElement;
  nb::class_<VehicleContacts>(m, "VehicleContacts", "What a vehicle's steps ask of contacts.");
  nb::class_<E, VehicleContacts>(
      m, "ForceElement",
      "Contacts of wheelsets in a multibody model; arrays have one row a wheelset.")
      .def(nb::init<const nb::list &, const nb::list &, const Values &, const Grid &, const Grid &,
                    double, int, const nb::list &>(),
           nb::arg("contacts"), nb::arg("inputs"), nb::arg("radii"), nb::arg("placements"),
           nb::arg("tracks"), nb::arg("frame_speed"), nb::arg("threads"), nb::arg("curved"),
           nb::keep_alive<1, 2>(),
           "contacts: Contact, kept alive by the list, which must not change; inputs: fields of "
           "rp_input that stay; radii: m, nominal; placements: of the wheelsets in their joints, "
           "tracks: of the track in the world at each, rotation by rows and origin, 12 numbers; "
           "frame_speed: m/s, of the world along the track; threads: that solve them; curved: "
           "whether a contact has a curved reference surface.")
      .def("step", &E::step,
           "Reads 'motion', solves all contacts, writes the other arrays; returns the worst "
           "status. The interpreter's lock is released.")
      .def("pass_time", &E::pass_time, nb::arg("seconds"),
           "Time that goes by before the next step, for bodies that store heat.")
      .def("place", &E::place, nb::arg("index"), nb::arg("fx"), nb::arg("fy"), nb::arg("fz"),
           nb::arg("mx"), nb::arg("my"), nb::arg("mz"),
           "Another wrench at a wheelset's centre, track axes, into its row of 'placed'.")
      .def("place_all", &E::place_all, nb::arg("wrenches"),
           "The same for all wheelsets, [wheelsets, 6]; their power (W) at the last step's motion.")
      .def("result", &E::result, nb::arg("index"), "The last step's rp_result.")
      .def("warnings", &E::warnings, "Texts, of all wheelsets at the last step.")
      .def_prop_ro("seconds", &E::seconds,
                   "Wall-clock time inside the contact solves, of all threads.")
      .def_prop_ro("helper_seconds", &E::helper_seconds,
                   "CPU time of the threads beside the caller's.")
      .def_prop_ro("solves", &E::solves, "Number of contact solves.")
      .def_prop_ro("motion", &view<kMotion, &E::motion>,
                   "In: rotation by rows, origin (m), linear and angular velocity, joint frame.")
      .def_prop_ro("wrench", &view<kWrench, &E::wrench>,
                   "Force (N) and moment (N m) in the joint frame, at its origin.")
      .def_prop_ro("placed", &view<kWrench, &E::placed>, "As 'wrench', of the last place().")
      .def_prop_ro("state", &view<kState, &E::state>,
                   "x, y, z, roll, yaw, pitch, speed, vy, vz, roll_rate, yaw_rate, pitch_rate.")
      .def_prop_ro("contact", &view<kContact, &E::contact>,
                   "Contact force and moment at the wheelset's centre, track axes.")
      .def_prop_ro("tracks", &view<kPlacement, &E::tracks>,
                   "In: of the track in the world, rotation by rows and origin (m).")
      .def_prop_ro("positions", &view<1, &E::positions>,
                   "In: m, along the track, of the track frame's origin.")
      .def_prop_ro("rails", &view<kRails, &E::rails>,
                   "In: beside the case's, offsets of left and right rail (m), their velocities.")
      .def_prop_ro("water", &view<kWater, &E::water>,
                   "In: supply (m^3/s; NaN: the case's), work on left and right rail (J/m).")
      .def_prop_ro(
          "wheels", &view<kWheels, &E::wheels>,
          "By side: force, moment about the centre, creep power, patches, power of friction.")
      .def_prop_ro("lateral", &view<kLateral, &E::lateral>,
                   "By side: lateral force without that of tractions.")
      .def_prop_ro("power", &view<kPower, &E::power>,
                   "Of the contacts: power of the forces (W), elastic energy (J), creep power (W), "
                   "frictional power (W), elastic energy of the pressure (J).");
}

}  // namespace railpatch::python
