#include "wheel_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railpatch {

namespace {

std::unique_ptr<profile> make_profile(const rp_profile &p, const char *field) {
  if (!p.arc_length || !p.y || !p.z || !p.dy || !p.dz) throw profile_error{field, "is not given"};
  const profile_view view{p.arc_length, p.y, p.z, p.dy, p.dz, p.count};
  if (const profile_fault fault = validate(view); fault != profile_fault::none)
    throw profile_error{field, text(fault)};
  return std::make_unique<profile>(view);
}

// Both rails lean inwards by the same cant; a right-hand curve is a left-hand one in the mirror.
track_config track_of(const rp_config &c, int side) {
  return {c.track == RP_ROLLER ? track_kind::roller : track_kind::rail,
          c.gauge,
          c.gauge_height,
          c.cant,
          side == RP_LEFT ? -c.curvature : c.curvature,
          c.roller_radius};
}

deviation deviation_of(const double offset[3], const double rotation[3], const double velocity[3],
                       const double angular_velocity[3]) {
  const auto vector = [](const double v[3]) { return vec3{v[0], v[1], v[2]}; };
  return {vector(offset), vector(rotation), vector(velocity), vector(angular_velocity)};
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// greatest distance a reference may move between steps for its solution to be a useful start
constexpr double warm_distance = 2e-3;

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

}  // namespace

wheel_contact::wheel_contact(const rp_config &c, int side)
    : config_(c),
      side_(side),
      wheel_(make_profile(c.wheel[side], side == RP_LEFT ? "wheel_left" : "wheel_right")),
      rail_(make_profile(c.rail[side], side == RP_LEFT ? "rail_left" : "rail_right")) {
  const wheel_config sizes{c.nominal_radius, c.flange_back_distance, c.flange_back_position};
  geometry_ = std::make_unique<side_geometry>(*wheel_, *rail_, sizes, track_of(c, side));
  if (!longitudinal_shape::wanted(c, side)) return;
  shape_ = std::make_unique<longitudinal_shape>(c, side);
  geometry_->set_shape(shape_.get());
}

void wheel_contact::place(const rp_input &in) {
  time_step_ = in.time_step;
  side_motion motion;
  motion.wheelset = {in.y,  in.z,  in.roll,      in.yaw,      in.speed,
                     in.vy, in.vz, in.roll_rate, in.yaw_rate, in.pitch_rate};
  motion.wheel = deviation_of(in.wheel_offset[side_], in.wheel_rotation[side_],
                              in.wheel_velocity[side_], in.wheel_angular_velocity[side_]);
  motion.rail = deviation_of(in.rail_offset[side_], in.rail_rotation[side_],
                             in.rail_velocity[side_], in.rail_angular_velocity[side_]);
  motion.roller_pitch_rate = in.roller_pitch_rate;
  if (shape_) shape_->place(in.pitch + in.wheel_rotation[side_][1], in.x, config_.nominal_radius);
  geometry_->place(side_ == RP_LEFT ? mirrored(motion) : motion);
}

grid wheel_contact::choose_grid(const patch_region &r) const {
  grid g;
  const double low[2] = {r.x_min, r.s_min}, high[2] = {r.x_max, r.s_max};
  double size[2], origin[2];
  int count[2];
  for (int k = 0; k < 2; ++k) {
    if (config_.element_size[0] > 0) {
      // element centres on multiples of the size, so that the grid moves with the reference
      size[k] = config_.element_size[k];
      const double first = std::floor(low[k] / size[k]) - 1.0;
      const double last = std::ceil(high[k] / size[k]) + 1.0;
      origin[k] = first * size[k];
      // bounds that are not finite, from a wild profile, give no grid
      const double cells = last - first + 1.0;
      count[k] = cells >= 1.0 && cells < 1e6 ? static_cast<int>(cells) : 0;
    } else {
      size[k] = (high[k] - low[k]) / config_.elements[k];
      origin[k] = low[k] - 0.5 * size[k];
      count[k] = config_.elements[k] + 2;
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
  solver.observe(RP_STAGE_GEOMETRY, true);
  const search_result found =
      find_patches(*geometry_, patch_rules{}, regions_.data(), config_.max_patches);
  solver.observe(RP_STAGE_GEOMETRY, false);
  out.status = RP_NO_CONTACT;
  const int count = found_ = found.count;
  out.patch_count = count;
  for (int k = 0; k < 3; ++k) out.force[k] = out.moment[k] = 0;
  out.rolling_radius = 0;
  for (auto &patch : out.patch) patch = empty_patch_result();
  beyond_ = found.status == search_status::out_of_range ||
            found.status == search_status::too_many_patches;
  if (beyond_) out.status = RP_OUT_OF_RANGE;
  for (int i = 0; i < count; ++i)
    out.status = combine_status(
        out.status, solve_patch(solver, regions_[static_cast<size_t>(i)], i, memory, out));
  for (int i = count; i < config_.max_patches; ++i) {
    memory[i].warm = memory[i].solved = false;
    memory[i].history.clear_now();
  }
  // of several patches the mean radius, each weighted with its load
  double load = 0;
  for (int i = 0; i < count; ++i)
    if (out.patch[i].normal_force > 0) load += out.patch[i].normal_force;
  out.rolling_radius = load > 0 ? out.rolling_radius / load : nan;
  if (side_ == RP_LEFT) mirror(out);
}

rp_status wheel_contact::solve_patch(patch_contact &solver, const patch_region &region, int index,
                                     patch_memory *memories, rp_side_result &out) {
  rp_patch_result &result = out.patch[index];
  patch_memory &memory = memories[index];
  patch_problem problem;
  problem.g = choose_grid(region);
  const grid &g = problem.g;
  const bool usable = g.nx > 0 && g.ny > 0 && g.dx > 0 && g.dy > 0 && std::isfinite(g.x0 + g.y0);
  if (!usable || !solver.fits(g)) {
    // what this patch carries is not known, so neither is the sum
    std::fill_n(out.force, 3, nan);
    std::fill_n(out.moment, 3, nan);
    beyond_ = true;
    memory.history.clear_now();
    return result.status = RP_OUT_OF_RANGE;
  }

  // the reference moves with the contact; a new contact elsewhere starts afresh
  const vec3 &origin = region.frame.origin;
  if (std::hypot(origin[1] - memory.reference[1], origin[2] - memory.reference[2]) > warm_distance)
    memory.warm = false;
  memory.reference = origin;
  solver.start_from(memory, g);

  solver.observe(RP_STAGE_GEOMETRY, true);
  double *h = memory.undeformed_distance.data();
  geometry_->undeformed_distance(region.frame, {g.nx, g.ny, g.x0, g.y0, g.dx, g.dy}, h);
  const double depth = -*std::min_element(h, h + g.count());
  const creepage_state rolling = geometry_->creepages(region.frame, depth);
  if (memory.row_friction.size() > 0) set_friction(solver, region.frame, memory);
  solver.observe(RP_STAGE_GEOMETRY, false);

  problem.rolling_speed = rolling.rolling_speed;
  problem.rolling = {{rolling.xi, rolling.eta}, rolling.phi, rolling.direction < 0 ? -1 : 1, 0.0};
  problem.parts = parts_on(region, g);
  past_tractions past[RP_MAX_PATCHES];
  if (solver.scene().keeps_steps()) set_past(memories, index, region.frame, problem, past);
  if (solver.scene().normal == RP_NORMAL_HERTZ) {
    // the paraboloid whose overlap has the same depth, length and width
    const double half[2] = {0.5 * (region.x_max - region.x_min),
                            0.5 * (region.s_max - region.s_min)};
    const double curvatures[2] = {depth / (half[0] * half[0]), depth / (half[1] * half[1])};
    problem.hertz = hertz_from_approach(curvatures, solver.scene().modulus(), depth);
  }
  patch_wrench wrench;
  solver.solve(problem, memory, result, wrench);
  memory.history.begun = solver.scene().keeps_steps();

  out.rolling_radius += result.normal_force * geometry_->rolling_radius(region.frame, depth);
  const vec3 lever = geometry_->lever(region.frame);
  add_wrench(wrench, region.frame.contact_angle, lever.data(), out.force, out.moment);
  std::copy_n(origin.begin(), 3, result.position);
  result.contact_angle = region.frame.contact_angle;
  result.approach = depth;
  // beyond a profile's end there is no surface: an edge in contact is outside the theory
  if (region.at_profile_end && result.status == RP_CONVERGED) result.status = RP_OUT_OF_RANGE;
  beyond_ = beyond_ || memory.beyond || (region.at_profile_end && result.status == RP_OUT_OF_RANGE);
  result.rolling_speed = rolling.rolling_speed;
  result.direction = rolling.direction;
  if (solver.scene().tangential != RP_TANGENTIAL_NONE) {
    result.creepage[0] = rolling.xi;
    result.creepage[1] = rolling.eta;
    result.spin_creepage = rolling.phi;
  }
  return result.status;
}

// The rail's material stays where it is on the rail, while the wheel moves on by the distance
// rolled and the reference by what its place has changed; the wheel's differs from it by creepage
// only. Rows go to the patch that is nearest, where it is near at all.
void wheel_contact::set_past(const patch_memory *memory, int patch, const contact_frame &frame,
                             patch_problem &problem, past_tractions *past) const {
  rolling_input &rolling = problem.rolling;
  rolling.speed = problem.rolling_speed;
  // what stands still does not roll on
  rolling.regime = problem.rolling_speed > 0 ? motion::transient : motion::shift;
  if (rolling.regime == motion::transient) rolling.distance = problem.rolling_speed * time_step_;
  problem.past = past;
  const auto lateral = [&](const vec3 &at) {
    return std::cos(frame.contact_angle) * (at[1] - frame.origin[1]) +
           std::sin(frame.contact_angle) * (at[2] - frame.origin[2]);
  };
  // half way to the edges of the neighbours
  const auto edge = [&](int k, bool last) {
    const patch_region &r = regions_[static_cast<size_t>(k)];
    const double s = last ? r.s_max : r.s_min, angle = r.frame.contact_angle;
    return lateral(
        {0, r.frame.origin[1] + s * std::cos(angle), r.frame.origin[2] + s * std::sin(angle)});
  };
  const patch_region &own = regions_[static_cast<size_t>(patch)];
  double low = own.s_min - patch_rules{}.separate, high = own.s_max + patch_rules{}.separate;
  if (patch > 0) low = std::max(low, 0.5 * (own.s_min + edge(patch - 1, true)));
  if (patch + 1 < found_) high = std::min(high, 0.5 * (own.s_max + edge(patch + 1, false)));
  for (int k = 0; k < config_.max_patches; ++k) {
    const patch_history &h = memory[k].history;
    if (!h.held) continue;
    const grid &g = h.last_grid;
    const double place = lateral(h.last_reference);  // in this frame
    const double first = std::ceil((low - place - g.y0) / g.dy),
                 last = std::floor((high - place - g.y0) / g.dy);
    const int begin = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(g.ny)));
    const int end = static_cast<int>(std::clamp(last + 1, 0.0, static_cast<double>(g.ny)));
    if (end <= begin) continue;
    past[problem.past_count++] = {
        &h,
        begin,
        end - begin,
        {frame.origin[0] + problem.g.x0 + rolling.upstream() - h.last_reference[0] - g.x0,
         problem.g.y0 - place - g.y(begin)}};
  }
}

// The factor of each row by the angle of the rail's surface there, > 0 towards the gauge face; a
// row beyond the profile has no contact, and any factor.
void wheel_contact::set_friction(const patch_contact &solver, const contact_frame &frame,
                                 patch_memory &memory) const {
  for (int j = 0; j < memory.g.ny; ++j) {
    const double across = std::cos(frame.contact_angle) * memory.g.y(j);
    double z = 0, slope = frame.contact_angle;
    geometry_->rail_surface(frame.origin[0], frame.origin[1] + across, z, slope);
    memory.row_friction[static_cast<size_t>(j)] = solver.scene().friction_variation.at(-slope);
  }
}

bool wheel_contact::first_touch(double &z) const { return railpatch::first_touch(*geometry_, z); }

size_t wheel_contact::bytes() const {
  return wheel_->bytes() + rail_->bytes() + geometry_->bytes() + (shape_ ? shape_->bytes() : 0);
}

rp_status combine_status(rp_status a, rp_status b) {
  if (a == RP_OUT_OF_RANGE || b == RP_OUT_OF_RANGE) return RP_OUT_OF_RANGE;
  if (a == RP_NOT_CONVERGED || b == RP_NOT_CONVERGED) return RP_NOT_CONVERGED;
  return a == RP_CONVERGED || b == RP_CONVERGED ? RP_CONVERGED : RP_NO_CONTACT;
}

void mirror(rp_side_result &side) {
  // a reflection at the plane y = 0: vectors change their y, axial vectors their x and z
  side.force[1] = -side.force[1];
  side.moment[0] = -side.moment[0];
  side.moment[2] = -side.moment[2];
  for (auto &p : side.patch) {
    for (double *v : {&p.creep_force[1], &p.spin_moment, &p.position[1], &p.contact_angle,
                      &p.creepage[1], &p.spin_creepage})
      *v = -*v;
    p.grid_origin[1] = -(p.grid_origin[1] + (p.grid[1] - 1) * p.element_size[1]);
  }
}

}  // namespace railpatch
