#include "wheel/wheels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "normal/row_contact.hpp"
#include "numeric/elementary.hpp"
#include "numeric/force_search.hpp"
#include "numeric/nan.hpp"
#include "patch/result_sums.hpp"
#include "wheel/force_samples.hpp"
#include "wheel/joined_forces.hpp"
#include "wheel/wheel_loads.hpp"
#include "wheel/wheelset_power.hpp"

namespace railpatch {

wheels::wheels(const wheels_setup &setup, const patch_scene &scene, const fft_plans &plans,
               stage_marks marks)
    : driver(scene, plans, setup.largest, marks,
             static_cast<int>(setup.wheel.size()) * setup.max_patches),
      patches_(static_cast<size_t>(setup.max_patches)),
      force_given_(setup.force_given),
      tolerance_(setup.tolerance),
      nominal_radius_(setup.nominal_radius),
      most_work_(setup.most_work),
      whole_forces_(setup.whole_forces),
      friction_along_(setup.friction_along) {
  wheels_.reserve(setup.wheel.size());
  for (const auto &wheel : setup.wheel) wheels_.emplace_back(wheel);
  for (const auto &wheel : wheels_) along_track_ = along_track_ || wheel.varies(body::rail);
  for (const auto &wheel : wheels_)
    if (force_given_ && !setup.support && (along_track_ || wheel.varies(body::wheel)))
      guess_.emplace();
  if (setup.support) support_.emplace(*setup.support);
  if (setup.bulk) bulk_.emplace(*setup.bulk);
  if (has_physics && scene.fluid && scene.fluid->regimes.recovery > 0) cleaning_.emplace();
  if (has_physics && scene.fluid && scene.fluid->paste.dries()) {
    drying_.emplace();
    paste_ = scene.fluid->paste;
  }
  balance_ = setup.balance;
  if (!scene.exact) return;
  rates_ = std::make_unique<rates>(
      rates{wheel_derivative(scene, setup.largest.nx * setup.largest.ny, setup.largest.ny), {}});
  rates_->changes.resize(2 * static_cast<size_t>(wheel_derivative::most_directions));
}

const patch_memory *wheels::find(int side, int patch) const {
  if (patch < 0 || static_cast<size_t>(patch) >= patches_) return nullptr;
  for (size_t w = 0; w < wheels_.size(); ++w)
    if (wheels_[w].side() == side) return memory_of(w) + patch;
  return nullptr;
}

driver::kept_numbers wheels::kept() {
  static_assert(std::is_trivially_copyable_v<rail_support::rail>);
  static_assert(std::is_trivially_copyable_v<bulk_temperatures::numbers>);
  static_assert(std::is_trivially_copyable_v<height_guess>);
  kept_numbers kept{&depth_};
  if (support_) {
    kept.more = support_->rails();
    kept.bytes = 2 * sizeof(rail_support::rail);
  } else if (guess_) {
    kept.more = &*guess_;
    kept.bytes = sizeof(height_guess);
    kept.begins_only = true;
  }
  if (bulk_) {
    kept.heat = bulk_->kept();
    kept.heat_bytes = sizeof(bulk_temperatures::numbers);
  }
  // not beside bodies that store heat: one needs the full theory, the other Polach's
  if (cleaning_) {
    kept.heat = &*cleaning_;
    kept.heat_bytes = sizeof(cleaning);
  }
  // nor a paste that dries
  if (drying_) {
    kept.heat = &*drying_;
    kept.heat_bytes = sizeof(drying);
  }
  return kept;
}

void wheels::reset() {
  depth_ = 0;
  if (guess_) *guess_ = {};
  if (support_) support_->reset();
  if (bulk_) bulk_->reset();
  if (cleaning_) *cleaning_ = {};
  if (drying_) *drying_ = {};
}

const char *wheels::geometry_reason() const {
  return "kind is wheel_rail or wheelset: placement and contact search";
}

size_t wheels::geometry_bytes() const {
  size_t sum = 0;
  for (const auto &wheel : wheels_) sum += wheel.bytes();
  return sum;
}

// Solves all wheels at z; returns their vertical force on the rails.
double wheels::evaluate(double z, rp_result &out) {
  solver_.scene().ask.check();
  double vertical = 0;
  verdict found{RP_NO_CONTACT};
  for (size_t w = 0; w < wheels_.size(); ++w) {
    wheel_contact &wheel = wheels_[w];
    rp_side_result &side = out.side[wheel.side()];
    wheel.move_to(z);
    set_bulk(wheel.side());
    solver_.set_friction_scale(scale_[wheel.side()]);
    if (cleaning_) solver_.set_cleaning_work(cleaned_[wheel.side()]);
    if (drying_) solver_.set_oxide_water(exp(-dry_[wheel.side()]));
    wheel.evaluate(solver_, memory_of(w), side);
    vertical -= side.force[2];
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i)
      out.work += 1 + side.patch[i].normal_iterations + side.patch[i].inner_iterations;
    combine(found, side);
  }
  ++out.evaluations;
  out.status = found.status;
  out.reason = found.reason;
  out.reason_value = found.reason_value;
  return vertical;
}

void wheels::step(const rp_input &in, rp_result &out) {
  const double along = friction_along_.varies() ? friction_along_.at(in.x) : 1.0;
  for (int side = 0; side < 2; ++side) scale_[side] = along * in.friction_scale[side];
  if (bulk_) bulk_->begin(in.time_step);
  for (size_t side = 0; cleaning_ && side < 2; ++side)
    cleaned_[side] =
        in.rail_work[side] + cleaning_->work[side] + cleaning_->rate[side] * in.time_step;
  for (int side = 0; drying_ && side < 2; ++side)
    dry_[side] = drying_->dryness[side] + (paste_.per_second + drying_->rate[side]) * in.time_step;
  if (solver_.scene().keeps_steps())
    for (auto &m : memory_) solver_.remember(m);
  if (!balance_) {
    solve(in, out);
    return finish(in, out);
  }
  rp_input found = in;
  solve_balanced(found, out);
  finish(found, out);
}

// At the place and with the velocities of an input.
void wheels::solve(const rp_input &in, rp_result &out) {
  {
    const stage_mark mark = solver_.marks().enter(RP_STAGE_GEOMETRY);
    for (auto &wheel : wheels_) wheel.place(in, !force_given_ && !support_);
  }
  if (support_) {
    solve_supported(in, out);
  } else if (!force_given_) {
    out.z = in.z;
    evaluate(in.z, out);
  } else {
    find_z(in, out);
  }
}

// Sums of what was solved, and what the next step begins with.
void wheels::finish(const rp_input &in, rp_result &out) {
  bool there[2] = {false, false};
  for (const auto &wheel : wheels_) {
    rp_side_result &side = out.side[wheel.side()];
    there[wheel.side()] = true;
    set_bulk(wheel.side());
    sum_patches(solver_.scene(), side);
    side.contact_power = wheelset_power(in, {side.force, side.moment});
    set_loads(wheel.side(), side);
  }
  sum_sides(there, out, out);
  out.roll = in.roll;
  out.pitch_rate = in.pitch_rate;
  out.axle_torque = torque(in, out);
  if (there[RP_LEFT] && there[RP_RIGHT]) set_conicity(in.y, out);
  // more heat than the air takes
  if (bulk_ && !bulk_->within_range())
    report_search({RP_OUT_OF_RANGE, RP_REASON_BULK_TEMPERATURE}, out.residual, out);
  if (bulk_) keep_heat(out);
  if (cleaning_) keep_cleaning(in, out);
  if (drying_) keep_drying(out);
}

// Each metre of the circumference is in contact once a turn, for its length over the speed.
void wheels::keep_cleaning(const rp_input &in, const rp_result &out) {
  const bool solved = out.status == RP_CONVERGED || out.status == RP_WORK_SPENT;
  if (!solved && out.status != RP_NO_CONTACT) return;
  for (const auto &wheel : wheels_) {
    const auto s = static_cast<size_t>(wheel.side());
    const rp_side_result &side = out.side[s];
    cleaning_->work[s] = cleaned_[s] - in.rail_work[s];
    const double around = 2.0 * std::numbers::pi * side.rolling_radius;
    cleaning_->rate[s] = around > 0 ? side.friction_power / around : 0.0;
  }
}

// As cleaning; what the step was solved with is told.
void wheels::keep_drying(rp_result &out) {
  const bool solved = out.status == RP_CONVERGED || out.status == RP_WORK_SPENT;
  for (const auto &wheel : wheels_) {
    const int s = wheel.side();
    rp_side_result &side = out.side[s];
    side.oxide_water = exp(-dry_[s]);
    if (!solved && out.status != RP_NO_CONTACT) continue;
    drying_->dryness[s] = dry_[s];
    const double around = 2.0 * std::numbers::pi * side.rolling_radius;
    drying_->rate[s] = around > 0 ? side.friction_power / around * paste_.per_work : 0.0;
  }
}

// Of bodies that store heat: what the step begins with.
void wheels::set_bulk(int side) {
  for (int k = 0; bulk_ && k < 2; ++k)
    if (bulk_->setup().stores(k)) solver_.set_bulk_temperature(k, bulk_->now(side, k));
}

// A step that is no solution leaves temperatures and heat as they were.
void wheels::keep_heat(const rp_result &out) {
  const bool solved = out.status == RP_CONVERGED || out.status == RP_WORK_SPENT;
  if (!solved && out.status != RP_NO_CONTACT) return;
  bulk_flow flow[2];
  for (size_t w = 0; w < wheels_.size(); ++w) {
    const rp_side_result &side = out.side[wheels_[w].side()];
    bulk_flow &own = flow[wheels_[w].side()];
    own.heat[0] = side.wheel_heat;
    own.heat[1] = side.rail_heat;
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
      const patch_memory &m = memory_of(w)[i];
      if (m.solved) own.exchange += side.patch[i].share * m.heat->conductance;
    }
  }
  bulk_->keep(flow);
}

// N, by all patches.
double wheels::carried(const rp_result &out) const {
  double sum = 0;
  for (const auto &wheel : wheels_) {
    const rp_side_result &side = out.side[wheel.side()];
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i)
      sum += side.patch[i].share * side.patch[i].normal_force;
  }
  return sum;
}

// N/m: what the vertical force rises by with the depth, by Hertz's law of each patch alone.
double wheels::hertzian_slope(const rp_result &out) const {
  double sum = 0;
  for (const auto &wheel : wheels_) {
    const rp_side_result &side = out.side[wheel.side()];
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
      const rp_patch_result &patch = side.patch[i];
      const double cosine = cos(patch.contact_angle);
      if (patch.normal_force > 0 && patch.approach > 0)
        sum += patch.share * 1.5 * patch.normal_force / patch.approach * cosine * cosine;
    }
  }
  return sum;
}

// Finds z for a prescribed vertical force.
void wheels::find_z(const rp_input &in, rp_result &out) {
  const double target = in.vertical_force, last = depth_;
  double touch = HUGE_VAL;
  for (const auto &wheel : wheels_) {
    double z = 0;
    if (wheel.first_touch(z)) touch = std::min(touch, z);
  }
  if (touch == HUGE_VAL) {
    evaluate(0.0, out);
    out.z = nan;
    out.status = RP_NO_CONTACT;
    combine(out, verdict{RP_OUT_OF_RANGE, RP_REASON_NO_OVERLAP});
    return;
  }
  if (target == 0) {
    rest_at(touch, out);
    return;
  }
  double depth = depth_;
  if (!(depth > 0)) {
    // a ball on a plane with the load of one wheel and a typical combined radius
    const double load = target / static_cast<double>(wheels_.size());
    const double modulus = solver_.scene().modulus(), radius = 0.5 * nominal_radius_;
    depth = cbrt(9.0 * load * load / (16.0 * modulus * modulus * radius));
  }
  const height_guess::way way{along_track_ ? in.x : in.pitch, touch, target};
  if (guess_ && last > 0) depth = guess_->depth(last, way);
  force_search search(target, depth, tolerance_);
  force_samples samples(target);
  std::array<joined_forces, 2> forces;
  double nearest = HUGE_VAL, residual = HUGE_VAL;  // m, depth that came nearest; its residual
  double force = 0, stiffness = 1;
  bool spent = false;
  for (int i = 0; i < force_search::most_steps; ++i) {
    depth = search.depth();
    force = evaluate(touch + depth, out);
    if (guess_) stiffness = hertzian_slope(out) * depth / (1.5 * force);
    if (guess_ && i == 0) search.assume(guess_->stiffness(stiffness));
    search.report(force, beyond());
    if (!beyond()) samples.add(depth, force);
    if (search.residual() < residual) nearest = depth, residual = search.residual();
    if (search.converged() || search.exhausted()) break;
    // where no force is known yet there is nothing to end with
    spent = most_work_ > 0 && out.work >= most_work_ && std::isfinite(residual);
    if (spent) break;
    if (!beyond()) foresee(touch, target, forces, search);
  }
  if (spent) {
    if (depth != nearest) residual = std::fabs(evaluate(touch + nearest, out) - target) / target;
    out.z = touch + nearest;
    report_search({RP_WORK_SPENT, RP_REASON_WORK, residual}, residual, out);
    depth_ = search.depth();  // where it would have gone on
    return;
  }
  if (search.converged() && carried(out) > force_samples::steep * target)
    force = look_deeper(touch, depth, force, samples, out);
  out.z = touch + depth;
  verdict found;
  if (!search.converged())
    found = search.too_deep()
                ? verdict{RP_OUT_OF_RANGE, RP_REASON_TOO_DEEP, search.residual()}
                : verdict{RP_NOT_CONVERGED, RP_REASON_FORCE_SEARCH, search.residual()};
  report_search(found, search.residual(), out);
  if (search.converged() &&
      (samples.jump_near(depth, force) || falls_while_joining(depth, force, out)))
    for (const auto &wheel : wheels_)
      out.side[wheel.side()].warnings |= uint32_t{1} << RP_WARNING_HEIGHTS;
  depth_ = search.converged() ? depth : 0.0;
  if (!guess_) return;
  double known;
  const double found_stiffness = search.stiffness(known);
  guess_->learn(found_stiffness, stiffness, known);
  guess_->keep(depth_, force / target - 1, stiffness, way);
}

// Forces of depths beyond the one that carries the load, and of one on the way to it, for as much
// work as a step may take; returns the force of that one, solved again.
double wheels::look_deeper(double touch, double depth, double carries, force_samples &samples,
                           rp_result &out) {
  const auto divided = [&](const wheel_contact &wheel) {
    const rp_side_result &side = out.side[wheel.side()];
    return side.patch_count + side.alternative_count > 1;
  };
  // or one whose rows lose and find contact
  const bool several =
      takes_rows(solver_.scene().normal) || std::any_of(wheels_.begin(), wheels_.end(), divided);
  for (size_t k = several ? 0 : force_samples::of_divisions; k < force_samples::beyond.size();
       ++k) {
    if (most_work_ > 0 && out.work >= most_work_) break;
    const double deeper = depth * (1 + force_samples::beyond[k]);
    const double force = evaluate(touch + deeper, out);
    if (!beyond()) samples.add(deeper, force);
  }
  const double between = samples.in_between(depth, carries);
  if (between > 0) {
    const double force = evaluate(touch + between, out);
    if (!beyond()) samples.add_between(between, force, carries);
  }
  return evaluate(touch + depth, out);
}

// Whether the force falls where a part that has appeared becomes one patch with its neighbour, so
// far that it is the target's at another height too: by the forces of both divisions at this one.
bool wheels::falls_while_joining(double depth, double force, const rp_result &out) const {
  const double slope = 1.5 * force / depth;  // of a Hertzian contact
  const double whole = carried(out);
  for (const wheel_contact &wheel : wheels_) {
    const rp_side_result &side = out.side[wheel.side()];
    if (side.alternative_count == 0) continue;
    double normal[2] = {0, 0}, mean = 0;  // of both divisions
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
      normal[i < side.patch_count ? 0 : 1] += side.patch[i].normal_force;
      mean += side.patch[i].share * side.patch[i].normal_force;
    }
    const bool joined_first = side.patch_count < side.alternative_count;
    const double apart = force * (1.0 + (normal[joined_first ? 1 : 0] - mean) / whole);
    const double joined = force * (1.0 + (normal[joined_first ? 0 : 1] - mean) / whole);
    appearance found;
    if (wheel.appearances(out.z - force_samples::joins_within * depth, out.z, &found, 1) == 0)
      continue;
    const double top = found.z + found.length;
    if (force_samples::crosses(apart - slope * (out.z - found.z), force)) return true;
    if (top > out.z && force_samples::crosses(force, joined + slope * (top - out.z))) return true;
  }
  return false;
}

// Whether a force is not known; a creep force outside its theory's range is one all the same.
bool wheels::beyond() const {
  return std::any_of(wheels_.begin(), wheels_.end(),
                     [](const wheel_contact &wheel) { return wheel.beyond(); });
}

// Where parts are being joined, the depth at which the divisions' forces will make up the target.
void wheels::foresee(double touch, double target, std::array<joined_forces, 2> &forces,
                     force_search &search) const {
  constexpr double far = 1e-2;  // of the force, from which on parts that appear are looked for
  constexpr double way = 0.5;   // of the depth
  const double depth = search.last();
  bool joins = false;
  for (size_t w = 0; w < wheels_.size(); ++w) {
    forces[w].add(touch, depth, wheels_[w]);
    if (search.between_known() && search.residual() > far)
      forces[w].look_between(touch, search.low(), search.high(), wheels_[w]);
    joins = joins || forces[w].joins();
  }
  if (!joins) return;
  const auto excess = [&](double at) {
    double sum = -target;
    for (size_t w = 0; w < wheels_.size(); ++w) sum += forces[w].force(at, wheels_[w]);
    return sum;
  };
  const double low = std::max(search.low(), (1 - way) * depth);
  const double high = std::min(search.high(), (1 + way) * depth);
  const double found = root_between(low, high, 0.1 * tolerance_ * target, excess);
  if (found > low && found < high) search.suggest(found);
}

// Without load the wheels just touch; what rounding leaves of a contact there they are lifted off.
void wheels::rest_at(double touch, rp_result &out) {
  bool apart = false;
  for (double lift = 0; !apart && lift < most_lift; lift = lift > 0 ? 2 * lift : least_lift) {
    evaluate(out.z = touch - lift, out);
    apart = out.status == RP_NO_CONTACT;
  }
  verdict found;
  if (!apart) found = {RP_NOT_CONVERGED, RP_REASON_FORCE_SEARCH};
  report_search(found, 0.0, out);
  depth_ = 0;
}

// What does not carry the force asked for is no solution of the case, wheel by wheel.
void wheels::report_search(const verdict &found, double residual, rp_result &out) const {
  for (auto &side : out.side) {
    degrade(side, found);
    for (int i = 0; i < side.patch_count + side.alternative_count; ++i)
      railpatch::report_search(found, residual, side.patch[i]);
  }
  if (found.status != RP_CONVERGED) combine(out, found);
}

}  // namespace railpatch
