// A step of a wheelset in balance: roll angle and pitch rate are found, with z where the vertical
// force is prescribed, and with the rails' deflections where these are on springs.
//
// Conditions, over what they are compared with (F the vertical force, b half the track's width, r
// the nominal radius):
//   roll        moment of the contact forces about the track's x through the centre, over F b
//   pitch rate  torque of the contact forces about the axle less the one given, over F r; or their
//               sum along the track's x less the one given, over F
// The search starts where both wheels touch their rails at one height, and rolling without slip on
// average.
#include <algorithm>
#include <cmath>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "wheel/wheels.hpp"
#include "wheel/wheelset_power.hpp"

namespace railpatch {

namespace {

// Balanced twenty times as well as forces are known to be at worst.
constexpr double goal_share = 0.05, least_goal = 1e-10;
// of the pitch rate, longest step: as a creepage
constexpr double creepage_limit = 2e-3;
// rad; as far as wheels are looked for, and as both then touch at one height
constexpr double most_roll = 0.1, level = 1e-9;

}  // namespace

struct wheels::balanced_state final : balanced_wheelset {
  balanced_state(wheels &own, rp_input &input, rp_result &out)
      : own(own), setup(*own.balance_), in(input), out(out) {
    if (own.support_) std::copy_n(own.support_->rails(), own.wheels_.size(), rails.data());
  }

  double *unknown(size_t k) { return setup.roll && k == 0 ? &in.roll : &in.pitch_rate; }
  void set(const balance_pair &u) {
    const size_t count = setup.roll && setup.axle ? 2 : 1;
    for (size_t k = 0; k < count; ++k) *unknown(k) = u[k];
  }
  // The step begins with the same rails, whatever was tried before.
  void solve() {
    for (size_t w = 0; own.support_ && w < own.wheels_.size(); ++w) {
      own.support_->rails()[w].deflection = rails[w].deflection;
      own.support_->rails()[w].rate = rails[w].rate;
    }
    own.solve(in, out);
    carried = 0;
    for (const auto &wheel : own.wheels_) carried -= out.side[wheel.side()].force[2];
  }
  balance_pair residuals() const {
    double moment = 0;
    for (const auto &wheel : own.wheels_) moment += out.side[wheel.side()].moment[0];
    const double load = own.force_given_ ? in.vertical_force : carried;
    // where nothing is carried all is in balance
    const double scale = load > 0 ? 1.0 / load : 0.0;
    const double roll = moment * scale / setup.half_width;
    const double axle = own.pitch_condition(in, out) * scale / lever();
    return setup.roll ? balance_pair{roll, axle} : balance_pair{axle, 0.0};
  }

  // m, that the second condition is compared with beside the load
  double lever() const { return setup.along ? 1.0 : own.nominal_radius_; }
  bool evaluate(const balance_pair &u, balance_pair &residual) override {
    set(u);
    solve();
    residual = residuals();
    return !std::isnan(out.z);
  }
  bool slopes(balance_slope &slope) override {
    if (!own.rates_ || !own.balance_slopes(in, out, slope)) return false;
    const double load = own.force_given_ ? in.vertical_force : carried;
    for (size_t i = 0; i < 2; ++i)
      for (double &s : slope[i]) s /= load * (setup.roll && i == 0 ? setup.half_width : lever());
    return load > 0;
  }
  // m, deepest of the patches
  double approach() const {
    double deepest = 0;
    for (const auto &wheel : own.wheels_) {
      const rp_side_result &side = out.side[wheel.side()];
      for (int i = 0; i < side.patch_count; ++i)
        deepest = std::max(deepest, side.patch[i].approach);
    }
    return deepest;
  }
  // What the pitch rate lacks for no slip on average, weighted with the load.
  double missing_rate() const {
    double slip = 0, radius = 0;
    for (const auto &wheel : own.wheels_) {
      const rp_side_result &side = out.side[wheel.side()];
      for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
        const rp_patch_result &p = side.patch[i];
        const double force = p.share * p.normal_force;
        slip += force * p.creepage[0] * p.rolling_speed;
        radius += force * side.rolling_radius;
      }
    }
    return radius > 0 && std::isfinite(slip) ? -slip / radius : 0.0;
  }

  // What friction can carry of what drives the wheelset, N m or N.
  double most_driven() const {
    double most = 0;
    for (const auto &wheel : own.wheels_) {
      const rp_side_result &side = out.side[wheel.side()];
      const double arm = setup.along ? 1.0 : side.rolling_radius;
      for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
        const rp_patch_result &p = side.patch[i];
        if (!(p.utilised_friction > 0)) continue;
        most += arm * p.share * p.normal_force * p.traction_coefficient / p.utilised_friction;
      }
    }
    return most;
  }
  // Why the search found nothing.
  verdict failure(rp_status status, double residual) const {
    const double asked = setup.along ? in.longitudinal_force : in.axle_torque;
    const double most = setup.axle ? most_driven() : 0.0;
    if (most > 0 && std::abs(asked) > most)
      return {RP_OUT_OF_RANGE, setup.along ? RP_REASON_DRIVEN_FORCE : RP_REASON_TORQUE, most};
    return {status, RP_REASON_BALANCE, residual};
  }

  wheels &own;
  const balance_setup &setup;
  rp_input &in;
  rp_result &out;
  std::array<rail_support::rail, 2> rails{};
  double carried = 0;  // N
};

double wheels::torque(const rp_input &in, const rp_result &out) const {
  double moment[3] = {0, 0, 0}, along = 0;
  for (const auto &wheel : wheels_) {
    const rp_side_result &side = out.side[wheel.side()];
    for (int i = 0; i < 3; ++i) moment[i] += side.moment[i];
    if (!whole_forces_ && side.patch_count > 0)
      along += (cos(in.yaw) * side.force[0] + sin(in.yaw) * side.force[1]) * side.rolling_radius;
  }
  return whole_forces_ ? axle_torque(in, moment) : along;
}

// What the pitch rate's condition lacks: N m, or N.
double wheels::pitch_condition(const rp_input &in, const rp_result &out) const {
  if (!balance_->along) return torque(in, out) - in.axle_torque;
  double sum = -in.longitudinal_force;
  for (const auto &wheel : wheels_) sum += out.side[wheel.side()].force[0];
  return sum;
}

double wheels::torque_rate(const rp_input &in, const rp_input &d, const rp_result &result,
                           const side_rates &rate) const {
  double moment[3] = {0, 0, 0}, change[3] = {0, 0, 0}, along = 0;
  for (const auto &wheel : wheels_) {
    const rp_side_result &side = result.side[wheel.side()], &by = *rate[wheel.side()];
    for (int i = 0; i < 3; ++i) {
      moment[i] += side.moment[i];
      change[i] += by.moment[i];
    }
    if (whole_forces_ || side.patch_count == 0) continue;
    const double c = cos(in.yaw), s = sin(in.yaw);
    along += (c * by.force[0] + s * by.force[1]) * side.rolling_radius;
    along += (c * side.force[1] - s * side.force[0]) * d.yaw * side.rolling_radius;
    along += (c * side.force[0] + s * side.force[1]) * by.rolling_radius;
  }
  return whole_forces_ ? axle_torque_rate(in, d, moment, change) : along;
}

// Rolls the wheelset until both wheels touch at one height; false: they do not.
bool wheels::touching_roll(rp_input &in) {
  const stage_mark mark = solver_.marks().enter(RP_STAGE_GEOMETRY);
  in.roll = 0;
  for (int round = 0; round < 20; ++round) {
    double z[2] = {0, 0};
    for (auto &wheel : wheels_) {
      wheel.place(in);
      if (!wheel.first_touch(z[wheel.side()])) return false;
    }
    const double change = (z[RP_RIGHT] - z[RP_LEFT]) / (2.0 * balance_->half_width);
    if (!(std::abs(change) > level)) return std::isfinite(change);
    in.roll = std::clamp(in.roll + change, -most_roll, most_roll);
  }
  return true;
}

void wheels::solve_balanced(rp_input &in, rp_result &out) {
  balanced_state state(*this, in, out);
  const auto fail = [&] {
    if (balance_->roll) in.roll = nan;
    if (balance_->axle) in.pitch_rate = nan;
  };
  if (balance_->roll && !touching_roll(in)) {
    in.roll = 0;
    state.solve();
    report_search({RP_OUT_OF_RANGE, RP_REASON_BALANCE}, HUGE_VAL, out);
    return fail();
  }
  const double turning = balance_->roller_radius * in.roller_pitch_rate;
  if (balance_->axle) in.pitch_rate = -(in.speed + turning) / nominal_radius_;
  state.solve();
  if (balance_->axle) in.pitch_rate += state.missing_rate();
  const double rolling = std::max(std::abs(nominal_radius_ * in.pitch_rate), balance_->least_speed);
  const balance_pair limits{std::max(state.approach(), 1e-6) / balance_->half_width,
                            creepage_limit * rolling / nominal_radius_};
  balance_search search;
  search.count = balance_->roll && balance_->axle ? 2 : 1;
  search.goal = std::max(goal_share * tolerance_, least_goal);
  search.tolerance = tolerance_;
  for (size_t k = 0; k < static_cast<size_t>(search.count); ++k) {
    search.start[k] = *state.unknown(k);
    search.limit[k] = limits[balance_->roll && k == 0 ? 0 : 1];
  }
  const balance_outcome found = find_balance(state, search);
  state.set(found.unknown);
  if (!found.known) {
    report_search(state.failure(RP_OUT_OF_RANGE, nan), HUGE_VAL, out);
    return fail();
  }
  verdict ended;
  if (!found.converged) ended = state.failure(RP_NOT_CONVERGED, found.residual);
  report_search(ended, found.residual, out);
}

}  // namespace railpatch
