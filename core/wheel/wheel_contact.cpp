#include "wheel/wheel_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "patch/creep_power.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

deviation deviation_of(const double offset[3], const double rotation[3], const double velocity[3],
                       const double angular_velocity[3]) {
  const auto vector = [](const double v[3]) { return vec3{v[0], v[1], v[2]}; };
  return {vector(offset), vector(rotation), vector(velocity), vector(angular_velocity)};
}

// greatest distance a reference may move between steps for its solution to be a useful start
constexpr double warm_distance = 2e-3;
// m, of a patch's bounds, within which the last step's tractions are taken for its own
constexpr double near = 4e-3;

// The rows of a patch's parts on its grid.
contact_parts parts_on(const patch_region &region, const grid &g) {
  static_assert(max_parts <= contact_parts::capacity);
  contact_parts parts;
  parts.count = region.parts;
  for (int k = 0; k + 1 < region.parts; ++k) {
    const double row = std::ceil((region.cut[k] - g.y0) / g.dy);
    parts.first_row[k + 1] = static_cast<int>(std::clamp(row, 0.0, static_cast<double>(g.ny)));
    parts.factor[k] = region.coupling[k];
  }
  return parts;
}

std::unique_ptr<profile_sections> sections_from(const std::vector<profile_view> &views,
                                                const double *positions,
                                                const section_rules &rules) {
  if (views.empty()) return nullptr;
  return std::make_unique<profile_sections>(views.data(), positions, static_cast<int>(views.size()),
                                            rules);
}

}  // namespace

wheel_contact::wheel_contact(const wheel_setup &setup)
    : side_(setup.side),
      max_patches_(setup.max_patches),
      nominal_radius_(setup.sizes.nominal_radius),
      standstill_speed_(setup.sizes.standstill_speed),
      grid_(setup.grid),
      rules_(setup.rules) {
  sections_ = sections_from(setup.sections, setup.section_position, setup.along);
  wheel_sections_ = sections_from(setup.wheel_sections, setup.wheel_section_angle, setup.around);
  wheel_ = std::make_unique<profile>(setup.wheel);
  rail_ = std::make_unique<profile>(setup.rail);
  geometry_ = std::make_unique<side_geometry>(*wheel_, *rail_, setup.sizes, setup.track);
  // made for the longest section
  if (sections_ && setup.along.by_knot) {
    rail_->assign(setup.sections.front());
    geometry_->reload_rail();
  }
  if (wheel_sections_) {
    wheel_->assign(setup.wheel_sections.front());
    geometry_->reload_wheel();
  }
  geometry_->set_sections(sections_.get(), wheel_sections_.get());
  if (setup.keeps_solutions) solutions_.resize(static_cast<size_t>(setup.max_patches));
  if (!setup.shape.given()) return;
  shape_ = std::make_unique<longitudinal_shape>(setup.shape);
  geometry_->set_shape(shape_.get());
}

// Of the inputs, or of their rates: what a right-hand wheel does.
side_motion wheel_contact::motion_of(const rp_input &in) const {
  side_motion motion;
  motion.wheelset = {in.y,  in.z,  in.roll,      in.yaw,      in.speed,
                     in.vy, in.vz, in.roll_rate, in.yaw_rate, in.pitch_rate};
  motion.wheel = deviation_of(in.wheel_offset[side_], in.wheel_rotation[side_],
                              in.wheel_velocity[side_], in.wheel_angular_velocity[side_]);
  motion.rail = deviation_of(in.rail_offset[side_], in.rail_rotation[side_],
                             in.rail_velocity[side_], in.rail_angular_velocity[side_]);
  motion.roller_pitch_rate = in.roller_pitch_rate;
  return side_ == RP_LEFT ? mirrored(motion) : motion;
}

void wheel_contact::place(const rp_input &in, bool at_height) {
  const double pitch = in.pitch + in.wheel_rotation[side_][1];
  const side_motion motion = motion_of(in);
  bool changed = false;
  if (sections_) {
    const profile_view now = sections_->at(in.x + geometry_->section_place(motion), changed);
    if (changed) {
      rail_->assign(now);
      geometry_->reload_rail();
    }
  }
  if (wheel_sections_) {
    const profile_view now = wheel_sections_->at(pitch, changed);
    if (changed) {
      wheel_->assign(now);
      geometry_->reload_wheel();
    }
  }
  time_step_ = in.time_step;
  step_regime_ = in.step_regime;
  if (shape_) shape_->place(pitch, in.x, nominal_radius_);
  geometry_->place(motion, at_height);
}

grid wheel_contact::choose_grid(const patch_region &r) const {
  grid g;
  const double low[2] = {r.x_min, r.s_min}, high[2] = {r.x_max, r.s_max};
  double size[2], origin[2];
  int count[2];
  for (int k = 0; k < 2; ++k) {
    if (grid_.sized) {
      // element centres on multiples of the size, so that the grid moves with the reference
      size[k] = grid_.element_size[k];
      const double first = std::floor(low[k] / size[k]) - 1.0;
      const double last = std::ceil(high[k] / size[k]) + 1.0;
      origin[k] = first * size[k];
      // bounds that are not finite, from a wild profile, give no grid
      const double cells = last - first + 1.0;
      count[k] = cells >= 1.0 && cells < 1e6 ? static_cast<int>(cells) : 0;
    } else {
      size[k] = (high[k] - low[k]) / grid_.elements[k];
      origin[k] = low[k] - 0.5 * size[k];
      count[k] = grid_.elements[k] + 2;
    }
  }
  g.nx = count[0];
  g.ny = count[1];
  g.dx = size[0];
  g.dy = size[1];
  g.x0 = origin[0];
  g.y0 = origin[1];
  return g;
}

void wheel_contact::evaluate(patch_contact &solver, patch_memory *memory, rp_side_result &out) {
  const search_result found = find_regions(solver);
  out = empty_side_result();
  const int count = patches_ = found.count;
  out.patch_count = found.lead;
  out.alternative_count = count - found.lead;
  out.rolling_radius = 0;
  beyond_ = found.status == search_status::out_of_range ||
            found.status == search_status::too_many_patches;
  if (found.status == search_status::out_of_range) fail(RP_REASON_NO_OVERLAP, nan, out);
  if (beyond_) fail(RP_REASON_TOO_MANY_PATCHES, max_patches_, out);
  match_memory(regions_.data(), count, memory, max_patches_);
  for (int i = 0; i < count; ++i) {
    solve_patch(solver, regions_[static_cast<size_t>(i)], i, memory, out);
    combine(out, out.patch[i]);
  }
  for (int i = count; i < max_patches_; ++i) {
    memory[i].warm = memory[i].solved = false;
    memory[i].history.clear_now();
  }
  // of several patches the mean radius, each weighted with the load it adds to the sum
  double load = 0;
  for (int i = 0; i < count; ++i)
    if (out.patch[i].normal_force > 0) load += out.patch[i].share * out.patch[i].normal_force;
  out.rolling_radius = load > 0 ? out.rolling_radius / load : nan;
  if (side_ == RP_LEFT) mirror(out);
}

// A wheel whose patches are not known.
void wheel_contact::fail(rp_reason reason, double value, rp_side_result &out) {
  combine(out, verdict{RP_OUT_OF_RANGE, reason, value});
}

search_result wheel_contact::find_regions(const patch_contact &solver) {
  const stage_mark mark = solver.marks().enter(RP_STAGE_GEOMETRY);
  return find_patches(*geometry_, rules_, parts_, regions_.data(), max_patches_);
}

void match_memory(const patch_region *regions, int count, patch_memory *memory, int slots) {
  if (slots == 1) return;
  const auto unlike = [&](const patch_region &region, const patch_memory &m) {
    const vec3 &at = region.frame.origin;
    const double moved = hypot(at[1] - m.reference[1], at[2] - m.reference[2]);
    if (!m.warm || moved > warm_distance) return HUGE_VAL;
    const double low = m.g.y0, high = m.g.y(m.g.ny - 1);
    return moved + std::fabs(region.s_min - low) + std::fabs(region.s_max - high);
  };
  std::array<int, RP_MAX_PATCHES> taken;  // slot of each patch
  std::array<bool, RP_MAX_PATCHES> used{};
  taken.fill(-1);
  const auto at = [](int i) { return static_cast<size_t>(i); };
  for (int round = 0; round < count; ++round) {
    double best = HUGE_VAL;
    int patch = -1, slot = -1;
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < slots; ++k) {
        if (taken[at(i)] >= 0 || used[at(k)]) continue;
        const double u = unlike(regions[i], memory[k]);
        if (u < best) best = u, patch = i, slot = k;
      }
    if (patch < 0) break;
    taken[at(patch)] = slot;
    used[at(slot)] = true;
  }
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < slots && taken[at(i)] < 0; ++k)
      if (!used[at(k)]) taken[at(i)] = k, used[at(k)] = true;
  for (int i = 0; i < count; ++i) {
    const int from = taken[at(i)];
    if (from == i) continue;
    std::swap(memory[i], memory[from]);
    // what was here now lies there
    for (int j = i + 1; j < count; ++j)
      if (taken[at(j)] == i) taken[at(j)] = from;
  }
}

void wheel_contact::solve_patch(patch_contact &solver, patch_region &region, int index,
                                patch_memory *memories, rp_side_result &out) {
  rp_patch_result &result = out.patch[index];
  patch_memory &memory = memories[index];
  if (!solutions_.empty()) solutions_[static_cast<size_t>(index)].solved = false;
  patch_problem problem;
  problem.place.share = region.share;
  const bool reached = !memory.curved || memory.curved->begin(*geometry_, region);
  problem.g = reached ? choose_grid(region) : grid{};
  const grid &g = problem.g;
  const bool usable = g.nx > 0 && g.ny > 0 && g.dx > 0 && g.dy > 0 && std::isfinite(g.x0 + g.y0);
  if (!usable || !solver.fits(g)) {
    // what this patch carries is not known, so neither is the sum
    std::fill_n(out.force, 3, nan);
    std::fill_n(out.moment, 3, nan);
    beyond_ = true;
    // nor are there fields: those of an earlier height of this step belong to no result
    memory.solved = false;
    memory.history.clear_now();
    report_beyond(problem.place, usable ? g : grid{}, result);
    return;
  }

  // the reference moves with the contact; a new contact elsewhere starts afresh
  const vec3 &origin = region.frame.origin;
  if (hypot(origin[1] - memory.reference[1], origin[2] - memory.reference[2]) > warm_distance)
    memory.warm = false;
  memory.reference = origin;
  solver.start_from(memory, problem);

  place_patch(solver, region, memory, problem);
  const double depth = problem.place.depth;
  past_tractions past[RP_MAX_PATCHES];
  if (solver.scene().keeps_steps()) {
    memory.rolling = rolling_of(problem);
    const bool steady = step_regime_ < 0 ? solver.scene().regime == motion::steady
                                         : step_regime_ == RP_STEADY_ROLLING;
    if (!steady) {
      set_past(memories, index, region, problem, past);
      const double mean[4] = {problem.rolling.creepage[0], problem.rolling.creepage[1],
                              problem.rolling.spin_creepage, problem.rolling_speed};
      if (memory.curved) memory.curved->take_mean(g, memory.rolling.data(), mean);
    }
  }
  if (solver.scene().normal == RP_NORMAL_HERTZ)
    problem.hertz = hertz_of(region, depth, solver.scene().modulus());
  patch_wrench wrench;
  solver.solve(problem, memory, result, wrench);
  memory.history.begun = solver.scene().keeps_steps();
  memory.share = region.share;
  for (size_t k = 0; k < 2; ++k) memory.rail[k] = geometry_->motion().rail.offset[k + 1];

  if (!solutions_.empty()) solutions_[static_cast<size_t>(index)] = {true, problem, wrench, depth};
  const double before = out.force[2];
  add_force(region, depth, wrench, result.normal_force, out);
  if (solver.scene().turns()) add_turning_force(region, memory.turning.about_x, out);
  if (rules_.blended && (sections_ || wheel_sections_))
    add_section_force(solver.scene(), region, problem, memory, out);
  vertical_[static_cast<size_t>(index)] = (before - out.force[2]) / region.share;
  // beyond a profile's end there is no surface: an edge in contact is outside the theory
  if (region.at_profile_end)
    degrade(result, RP_OUT_OF_RANGE, RP_REASON_PROFILE_END, region.frame.origin[1]);
  beyond_ = beyond_ || memory.beyond || (region.at_profile_end && result.status == RP_OUT_OF_RANGE);
}

// What geometry says of a patch: its distance, how it rolls, where it lies.
void wheel_contact::place_patch(const patch_contact &solver, patch_region &region,
                                patch_memory &memory, patch_problem &problem) const {
  const stage_mark mark = solver.marks().enter(RP_STAGE_GEOMETRY);
  const double depth = place_grid(solver, region, problem.g, memory);
  const creepage_state rolling = geometry_->creepages(region.frame, depth);
  if (memory.curved) memory.curved->set_slip(*geometry_, depth, rolling.rolling_speed);
  problem.rolling_speed = rolling.rolling_speed;
  problem.rolling = {{rolling.xi, rolling.eta}, rolling.phi, rolling.direction < 0 ? -1 : 1};
  // what slip is divided by, near standstill too: so the slip velocity is that of the surfaces
  problem.rolling.speed = rolling.rolling_speed;
  problem.parts = parts_on(region, problem.g);
  patch_place &place = problem.place;
  place.on_wheel = true;
  std::copy_n(region.frame.origin.begin(), 3, place.position);
  place.contact_angle = region.frame.contact_angle;
  place.depth = depth;
  place.contact_depth = geometry_->contact_depth(region.frame, depth);
  const auto on_wheel = geometry_->on_wheel_profile(region.frame, depth);
  const auto on_rail = geometry_->on_rail_profile(region.frame);
  std::copy(on_wheel.begin(), on_wheel.end(), place.on_wheel_profile);
  std::copy(on_rail.begin(), on_rail.end(), place.on_rail_profile);
  place.rolling_speed = rolling.rolling_speed;
  place.direction = rolling.direction;
}

// Fills the undeformed distance, and the friction where it varies. Returns the greatest depth (m).
double wheel_contact::place_grid(const patch_contact &solver, patch_region &region, const grid &g,
                                 patch_memory &memory) const {
  double *h = memory.undeformed_distance.data();
  const surface_grid on{g.nx, g.ny, g.x0, g.y0, g.dx, g.dy};
  const bool sloped = memory.slope_fields.size() && !memory.curved;
  const bool by_row = sloped && geometry_->level();  // found with the distance
  if (memory.curved)
    memory.curved->place(*geometry_, g, h, memory.slopes);
  else
    geometry_->undeformed_distance(region.frame, on, h, by_row ? &memory.slopes : nullptr);
  if (sloped && !by_row)
    geometry_->rail_slopes(region.frame, on, !solver.scene().closed_form(), memory.slopes);
  if (memory.row_friction.size() > 0) set_friction(solver, region.frame, memory);
  return -*std::min_element(h, h + g.count());
}

// The paraboloid whose overlap has the same depth, length and width.
hertz_contact wheel_contact::hertz_of(const patch_region &region, double depth, double modulus) {
  const double half[2] = {0.5 * (region.x_max - region.x_min), 0.5 * (region.s_max - region.s_min)};
  const double curvatures[2] = {depth / (half[0] * half[0]), depth / (half[1] * half[1])};
  return hertz_from_approach(curvatures, modulus, depth);
}

// The rail's material stays where it is on the rail, while the wheel moves on by the distance
// rolled and the reference by what its place has changed; the wheel's differs from it by creepage
// only. What solutions of the last step left counts with their shares, as it did in the force, and
// goes to a patch where it lies nearer to its parts than to others, and near at all.
void wheel_contact::set_past(const patch_memory *memory, int index, const patch_region &region,
                             patch_problem &problem, past_tractions *past) const {
  problem.past = past;
  const vec3 &rail = geometry_->motion().rail.offset;
  const contact_frame &frame = region.frame;
  const auto lateral = [&](const vec3 &at) {
    return lateral_in(frame.origin, frame.contact_angle, at);
  };
  double low = region.s_min - near, high = region.s_max + near;
  const int first_part = region.first_part, last_part = first_part + region.parts - 1;
  const auto part_at = [&](int k) -> const part & { return parts_.parts[k]; };
  if (first_part > 0)
    low = std::max(low, 0.5 * (region.s_min + lateral(part_at(first_part - 1).last)));
  if (last_part + 1 < parts_.count)
    high = std::min(high, 0.5 * (region.s_max + lateral(part_at(last_part + 1).first)));
  for (int k = 0; k < max_patches_; ++k) {
    const patch_history &h = memory[k].history;
    if (!h.held) continue;
    const grid &g = h.last_grid;
    // in this frame; the rail has taken its material along
    double place = lateral({0, h.last_reference[1] + rail[1], h.last_reference[2] + rail[2]});
    if (memory[index].curved) place = memory[index].curved->arc_of(*geometry_, place);
    const auto row = [&](double s) {
      return static_cast<int>(
          std::clamp(std::ceil((s - place - g.y0) / g.dy), 0.0, static_cast<double>(g.ny)));
    };
    const int begin = row(low), end = row(high);
    if (end <= begin) continue;
    past_tractions &p = past[problem.past_count++];
    p = {&h, begin, end - begin, {0, problem.g.y0 - place - g.y(begin)}};
  }
  problem.rolled = set_rolling(problem);
  for (int k = 0; k < problem.past_count; ++k) {
    const patch_history &h = *past[k].history;
    past[k].offset[0] =
        frame.origin[0] + problem.g.x0 + problem.rolled - h.last_reference[0] - h.last_grid.x0;
  }
}

// What a patch goes on with: creepages, spin, rolling speed, and the way per second along x. Near
// standstill creepages refer to another speed than that of the way.
std::array<double, 5> wheel_contact::rolling_of(const patch_problem &problem) const {
  const double speed = problem.rolling_speed, slow = standstill_speed_;
  const double moved = speed < slow ? std::sqrt(std::max(slow * (2 * speed - slow), 0.0)) : speed;
  const rolling_input &r = problem.rolling;
  return {r.creepage[0], r.creepage[1], r.spin_creepage, speed, problem.place.direction * moved};
}

// The motion of a step is the mean of the velocities at both its ends, where material has been in
// contact before. Returns the way rolled along x (m).
double wheel_contact::set_rolling(patch_problem &problem) const {
  rolling_input &rolling = problem.rolling;
  std::array<double, 5> now = rolling_of(problem);
  std::array<double, 5> last{};
  double shares = 0;
  for (int k = 0; k < problem.past_count; ++k) {
    const patch_history &h = *problem.past[k].history;
    shares += h.last_share;
    for (size_t i = 0; i < 5; ++i)
      last[i] += h.last_share * h.last_rolling[i] * (i < 3 ? h.last_rolling[3] : 1.0);
  }
  if (shares > 0) {
    // slip is what has a mean, creepage is slip over the speed
    const double speed = 0.5 * (now[3] + last[3] / shares);
    for (size_t i = 0; i < 3; ++i)
      now[i] = speed > 0 ? 0.5 * (now[i] * now[3] + last[i] / shares) / speed : 0.0;
    now[3] = speed;
    now[4] = 0.5 * (now[4] + last[4] / shares);
  }
  rolling.creepage[0] = now[0];
  rolling.creepage[1] = now[1];
  rolling.spin_creepage = now[2];
  problem.rolling_speed = rolling.speed = now[3];
  // what stands still does not roll on
  rolling.regime = now[3] > 0 ? motion::transient : motion::shift;
  if (now[3] > 0) rolling.distance = now[3] * time_step_;
  return now[4] * time_step_;
}

// The factor of each row by the angle of the rail's surface there, > 0 towards the gauge face; a
// row beyond the profile has no contact, and any factor. Rows of a curved reference surface have
// an angle of their own.
void wheel_contact::set_friction(const patch_contact &solver, const contact_frame &frame,
                                 patch_memory &memory) const {
  for (int j = 0; j < memory.g.ny; ++j) {
    const double across = cos(frame.contact_angle) * memory.g.y(j);
    double z = 0, slope = frame.contact_angle;
    if (memory.curved)
      slope = memory.curved->angle(j);
    else
      geometry_->rail_surface(frame.origin[0], frame.origin[1] + across, z, slope);
    memory.row_friction[static_cast<size_t>(j)] = solver.scene().friction_variation.at(-slope);
  }
}

derivative_outcome wheel_contact::differentiate(patch_contact &solver, const patch_memory *memory,
                                                wheel_derivative &work, const rp_input *directions,
                                                const friction_rates *friction, int count,
                                                const derivative_options &options,
                                                const rp_side_result &result,
                                                rp_side_result *changes) const {
  side_motion motions[wheel_derivative::most_directions];
  for (int k = 0; k < count; ++k) motions[k] = motion_of(directions[k]);
  const wheel_solution solution{
      *geometry_,        rules_, parts_,   regions_.data(),
      solutions_.data(), memory, patches_, grid_.sized ? nullptr : grid_.elements};
  const derivative_outcome outcome =
      work.solve(solution, solver, motions, friction, count, options, result, changes);
  for (int k = 0; k < count; ++k) {
    if (side_ == RP_LEFT) mirror(changes[k]);
    for (int i = 0; i < patches_; ++i) {
      rp_patch_result &change = changes[k].patch[i];
      change.creep_power = creep_power_rate(result.patch[i], change);
      change.wear_number = wear_number_rate(result.patch[i], change);
    }
  }
  return outcome;
}

bool wheel_contact::first_touch(double &z) const { return railpatch::first_touch(*geometry_, z); }

size_t wheel_contact::bytes() const {
  return wheel_->bytes() + rail_->bytes() + geometry_->bytes() +
         solutions_.size() * sizeof(patch_solution) + (sections_ ? sections_->bytes() : 0) +
         (wheel_sections_ ? wheel_sections_->bytes() : 0) + (shape_ ? shape_->bytes() : 0);
}

}  // namespace railpatch
