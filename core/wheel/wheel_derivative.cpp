#include "wheel/wheel_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "patch/report.hpp"
#include "patch/result_fields.hpp"

namespace railpatch {

namespace {

constexpr int blocks = wheel_derivative::most_directions / rate_directions;

// whether more than velocities change
bool moves_surfaces(const side_motion &m) {
  const auto moved = [](const deviation &d) { return d.offset != vec3{} || d.rotation != vec3{}; };
  const wheelset_state &w = m.wheelset;
  return w.y != 0 || w.z != 0 || w.roll != 0 || w.yaw != 0 || moved(m.wheel) || moved(m.rail);
}

// the number itself as it was found, with its rates
rated with_value(rated a, double value) {
  a.value = value;
  return a;
}

rated_frame fixed_frame(const contact_frame &f) {
  return {{f.origin[0], f.origin[1], f.origin[2]}, f.contact_angle};
}

}  // namespace

wheel_derivative::wheel_derivative(const patch_scene &scene, int max_count, int max_rows)
    : max_count_(max_count), max_rows_(max_rows) {
  const auto directions = static_cast<size_t>(rate_directions);
  distance_ = aligned_buffer<double>::uninitialized(directions * static_cast<size_t>(max_count));
  if (scene.friction_variation.varies())
    row_friction_ =
        aligned_buffer<double>::uninitialized(directions * static_cast<size_t>(max_rows));
  if (!scene.local_normals) return;
  const bool along = scene.slopes_along_rows && !scene.closed_form();
  const auto each = static_cast<size_t>(along ? max_count : max_rows);
  slope_fields_ = aligned_buffer<double>::uninitialized(3 * directions * each);
  for (size_t k = 0; k < directions; ++k) {
    double *at = slope_fields_.data() + 3 * k * each;
    slopes_[k] = {at, at + each, at + 2 * each};
  }
}

size_t wheel_derivative::bytes() const {
  return sizeof *this + distance_.bytes() + row_friction_.bytes() + slope_fields_.bytes();
}

// What is known of the wheel on the way through its patches. Directions come in blocks, each with a
// geometry that moves along them.
struct wheel_derivative::step {
  const wheel_solution &wheel;
  patch_contact &solver;
  int count;
  const derivative_options &options;
  const friction_rates *friction;
  const rp_side_result &result;
  rp_side_result *changes;
  derivative_outcome outcome{};

  std::optional<moving_geometry> geometry[blocks];
  int size[blocks] = {};
  int moving = 0;  // directions of the first block up to the last that moves the surfaces
  basic_part<rated> parts[max_parts];
  rated join[max_parts];

  // of the patch at hand, in the first block
  rated_frame frame;
  rated share, depth;
  basic_place_slope<rated> angle_slope;
  lattice_rates lattice[rate_directions];
  basic_bounds<rated> bounds;
  basic_creepage_state<rated> rolling[blocks];

  // of the patch at hand in any block: surfaces move in the first one only
  rated_frame frame_in(int b, const patch_region &region) const {
    return b == 0 ? frame : fixed_frame(region.frame);
  }
  rated share_in(int b, const patch_region &region) const {
    return b == 0 ? share : rated(region.share);
  }
  rated depth_in(int b, const patch_solution &solution) const {
    return b == 0 ? depth : rated(solution.depth);
  }

  step(const wheel_solution &w, patch_contact &p, const friction_rates *f, int n,
       const derivative_options &o, const rp_side_result &found, rp_side_result *out)
      : wheel(w), solver(p), count(n), options(o), friction(f), result(found), changes(out) {}

  // sums over the patches
  vec<rated> force[blocks], moment[blocks];
  rated load[blocks], loaded_radius[blocks];

  void begin(const side_motion *directions) {
    for (int b = 0; b < blocks && b * rate_directions < count; ++b) {
      motion_rates rates;
      size[b] = rates.count = std::min(rate_directions, count - b * rate_directions);
      std::copy_n(directions + b * rate_directions, size[b], rates.direction.begin());
      geometry[b].emplace(wheel.geometry, rates);
    }
    for (int k = 0; k < size[0]; ++k)
      if (moves_surfaces(directions[k])) moving = k + 1;
    if (moving == 0) return;
    const int found = wheel.parts.count;
    for (int i = 0; i < found; ++i) parts[i] = geometry[0]->part_of(wheel.parts.parts[i]);
    for (int k = 0; k + 1 < found; ++k) join[k] = joined(wheel.rules.blend, parts[k], parts[k + 1]);
  }
};

derivative_outcome wheel_derivative::solve(const wheel_solution &wheel, patch_contact &solver,
                                           const side_motion *directions,
                                           const friction_rates *friction, int count,
                                           const derivative_options &o,
                                           const rp_side_result &result, rp_side_result *changes) {
  step s(wheel, solver, friction, count, o, result, changes);
  s.begin(directions);
  for (int k = 0; k < count; ++k) {
    changes[k] = {};
    for (auto &patch : changes[k].patch) {
      patch = empty_patch_result();
      patch.share = 0;
    }
  }
  for (int i = 0; i < wheel.count; ++i) solve_patch(s, i);
  for (int k = 0; k < count; ++k) {
    const auto b = static_cast<size_t>(k / rate_directions),
               slot = static_cast<size_t>(k % rate_directions);
    for (size_t c = 0; c < 3; ++c) {
      changes[k].force[c] = s.force[b][c].rate[slot];
      changes[k].moment[c] = s.moment[b][c].rate[slot];
    }
    const bool loaded = s.load[b].value > 0;
    changes[k].rolling_radius = loaded ? (s.loaded_radius[b] / s.load[b]).rate[slot] : nan;
  }
  return s.outcome;
}

// Frame, bounds, undeformed distance and depth of a patch, where they move.
void wheel_derivative::set_shape(step &s, int index, patch_variation *in) {
  const patch_region &region = s.wheel.regions[index];
  const patch_solution &solution = s.wheel.patches[index];
  const grid &g = solution.problem.g;
  s.frame = fixed_frame(region.frame);
  s.share = region.share;
  s.depth = solution.depth;
  for (auto &l : s.lattice) l = {};
  if (s.moving == 0) return;
  const moving_geometry &geometry = *s.geometry[0];
  const int end = region.first_part + region.parts;
  const basic_interval<rated> parts = sum_parts(s.parts, region.first_part, end);
  rated z, angle;
  if (geometry.rail_surface(parts.x, parts.y, z, angle))
    s.frame.origin[2] = with_value(z, region.frame.origin[2]);
  s.frame.origin[0] = with_value(parts.x, region.frame.origin[0]);
  s.frame.origin[1] = with_value(parts.y, region.frame.origin[1]);
  s.frame.contact_angle = with_value(parts.angle, region.frame.contact_angle);
  const rated share = interval_share(s.join, s.wheel.parts.count, region.first_part, end);
  s.share = with_value(share, region.share);
  s.angle_slope = parts.angle_slope;
  s.bounds = bounds_of(s.parts, parts, s.frame.origin, s.frame.contact_angle);

  double *rates[rate_directions];
  for (int k = 0; k < s.moving; ++k) {
    const auto at = static_cast<size_t>(k);
    rates[k] = distance_.data() + at * static_cast<size_t>(max_count_);
    if (!s.wheel.elements) continue;
    // the lattice fills the bounds
    const rated *low[2] = {&s.bounds.x_min, &s.bounds.s_min},
                *high[2] = {&s.bounds.x_max, &s.bounds.s_max};
    for (int c = 0; c < 2; ++c) {
      double &size = s.lattice[k].size[c];
      size = (high[c]->rate[at] - low[c]->rate[at]) / s.wheel.elements[c];
      s.lattice[k].origin[c] = low[c]->rate[at] - 0.5 * size;
    }
  }
  const double *h = s.wheel.memory[index].undeformed_distance.data();
  auto deepest = static_cast<int>(std::min_element(h, h + g.count()) - h);
  const bool all = s.solver.scene().normal != RP_NORMAL_HERTZ;
  if (all) {
    geometry.distance_rates(s.frame, {g.nx, g.ny, g.x0, g.y0, g.dx, g.dy}, s.lattice, s.moving,
                            rates);
  } else {
    set_depth(s, geometry, g, deepest, rates);
    deepest = 0;
  }
  for (int k = 0; k < s.moving; ++k) {
    if (all) in[k].distance = rates[k];
    std::copy_n(s.lattice[k].size, 2, in[k].size);
    std::copy_n(s.lattice[k].origin, 2, in[k].origin);
    for (int i = region.first_part; i + 1 < end; ++i)
      in[k].part_factor[i - region.first_part] =
          interaction(s.wheel.rules.blend, s.parts[i], s.parts[i + 1]).rate[static_cast<size_t>(k)];
    s.depth.rate[static_cast<size_t>(k)] = -rates[k][deepest];
  }
}

// Of an ellipse the depth alone counts: rates of the distance at the deepest element.
void wheel_derivative::set_depth(const step &s, const moving_geometry &geometry, const grid &g,
                                 int deepest, double *const *rates) {
  const int at[2] = {deepest % g.nx, deepest / g.nx};
  lattice_rates one[rate_directions];
  for (int k = 0; k < s.moving; ++k)
    for (int c = 0; c < 2; ++c)
      one[k].origin[c] = s.lattice[k].origin[c] + at[c] * s.lattice[k].size[c];
  geometry.distance_rates(s.frame, {1, 1, g.x(at[0]), g.y(at[1]), g.dx, g.dy}, one, s.moving,
                          rates);
}

// Slopes of the rail's surface.
void wheel_derivative::set_slopes(step &s, int index, patch_variation *in) {
  const grid &g = s.wheel.patches[index].problem.g;
  s.geometry[0]->rail_slope_rates(s.frame, {g.nx, g.ny, g.x0, g.y0, g.dx, g.dy}, s.lattice,
                                  s.moving, !s.solver.scene().closed_form(), slopes_);
  for (int k = 0; k < s.moving; ++k) in[k].slopes = &slopes_[k];
}

// The friction of each row by the angle of the rail's surface there: wheel_contact::set_friction.
void wheel_derivative::set_friction(step &s, int index, const lattice_rates *lattice,
                                    patch_variation *in) {
  const grid &g = s.wheel.patches[index].problem.g;
  for (int j = 0; j < g.ny; ++j) {
    rated y(g.y(j));
    for (int k = 0; k < s.moving; ++k)
      y.rate[static_cast<size_t>(k)] = lattice[k].origin[1] + j * lattice[k].size[1];
    rated z, slope = s.frame.contact_angle;
    s.geometry[0]->rail_surface(s.frame.origin[0],
                                s.frame.origin[1] + cos(s.frame.contact_angle) * y, z, slope);
    const double by_angle = s.solver.scene().friction_variation.slope(-slope.value);
    for (int k = 0; k < s.moving; ++k) {
      double *row = row_friction_.data() + k * max_rows_;
      row[j] = -by_angle * slope.rate[static_cast<size_t>(k)];
      in[k].row_friction = row;
    }
  }
}

// Creepages and speed in all directions.
void wheel_derivative::set_motion(step &s, int index, patch_variation *in) {
  const patch_region &region = s.wheel.regions[index];
  for (int b = 0; b < blocks && s.geometry[b]; ++b) {
    const rated_frame frame = s.frame_in(b, region);
    const rated approach = s.depth_in(b, s.wheel.patches[index]);
    s.rolling[b] = s.geometry[b]->creepages(frame, approach);
    const rated contact_depth = s.geometry[b]->contact_depth(frame, approach);
    const rated depth_part = contact_depth / approach;
    for (int k = 0; k < s.size[b]; ++k) {
      const auto slot = static_cast<size_t>(k);
      patch_variation &v = in[b * rate_directions + k];
      v.contact_depth = contact_depth.rate[slot];
      v.depth_part = approach.value > 0 ? depth_part.rate[slot] : 0.0;
      v.creepage[0] = s.rolling[b].xi.rate[slot];
      v.creepage[1] = s.rolling[b].eta.rate[slot];
      v.spin_creepage = s.rolling[b].phi.rate[slot];
      v.rolling_speed = s.rolling[b].rolling_speed.rate[slot];
      v.friction = s.friction[b * rate_directions + k];
    }
  }
}

// The paraboloid of Hertz's contact: wheel_contact::hertz_of.
void wheel_derivative::set_hertz(step &s, int index, patch_variation *in) {
  const rated half[2] = {0.5 * (s.bounds.x_max - s.bounds.x_min),
                         0.5 * (s.bounds.s_max - s.bounds.s_min)};
  const rated curvature[2] = {s.depth / (half[0] * half[0]), s.depth / (half[1] * half[1])};
  for (int k = 0; k < s.moving; ++k) {
    const auto slot = static_cast<size_t>(k);
    const double rates[2] = {curvature[0].rate[slot], curvature[1].rate[slot]};
    in[k].hertz =
        hertz_rate_of_approach(s.wheel.patches[index].problem.hertz, rates, s.depth.rate[slot]);
  }
}

void wheel_derivative::solve_patch(step &s, int index) {
  const patch_solution &solution = s.wheel.patches[index];
  const patch_scene &scene = s.solver.scene();
  if (!solution.solved) {
    // what it carries is not known
    rated unknown(nan);
    unknown.rate.fill(nan);
    for (auto *sums : {&s.force, &s.moment})
      for (auto &sum : *sums) sum.fill(unknown);
    for (auto &sum : s.loaded_radius) sum = unknown;
    return;
  }
  patch_variation in[most_directions];
  patch_change out[most_directions];
  set_shape(s, index, in);
  if (s.moving > 0 && row_friction_.size() > 0) set_friction(s, index, s.lattice, in);
  if (s.moving > 0 && slope_fields_.size() > 0) set_slopes(s, index, in);
  set_motion(s, index, in);
  if (scene.normal == RP_NORMAL_HERTZ && s.moving > 0) set_hertz(s, index, in);
  const derivative_outcome ended =
      s.solver.differentiate(solution.problem, s.wheel.memory[index], in, s.count, s.options, out);
  s.outcome.residual = std::max(s.outcome.residual, ended.residual);
  s.outcome.converged = s.outcome.converged && ended.converged;
  for (int b = 0; b < blocks && s.geometry[b]; ++b) {
    const patch_change *changes = out + b * rate_directions;
    add_forces(s, index, b, changes);
    for (int k = 0; k < s.size[b]; ++k) report(s, index, b, k, changes[k]);
  }
}

// Adds a patch's part to the wheel's force, moment and load, in the directions of a block.
void wheel_derivative::add_forces(step &s, int index, int b, const patch_change *changes) {
  const patch_region &region = s.wheel.regions[index];
  const patch_solution &solution = s.wheel.patches[index];
  const auto rates_of = [&](double value, auto &&get) {
    rated a(value);
    for (int k = 0; k < s.size[b]; ++k) a.rate[static_cast<size_t>(k)] = get(changes[k]);
    return a;
  };
  const rated_frame frame = s.frame_in(b, region);
  const rated share = s.share_in(b, region);
  basic_wrench<rated> wrench;
  for (int c = 0; c < 3; ++c) {
    wrench.force[c] = share * rates_of(solution.wrench.force[c],
                                       [c](const patch_change &d) { return d.wrench.force[c]; });
    wrench.moment[c] = share * rates_of(solution.wrench.moment[c],
                                        [c](const patch_change &d) { return d.wrench.moment[c]; });
  }
  const vec<rated> lever = s.geometry[b]->lever(frame);
  add_wrench(wrench, frame.contact_angle, lever.data(), s.force[b].data(), s.moment[b].data());
  add_turning_force(s, index, b, changes);
  const double normal_force = s.result.patch[index].normal_force;
  if (!(normal_force > 0)) return;
  const rated load =
      share * rates_of(normal_force, [](const patch_change &d) { return d.normal_force; });
  s.load[b] += load;
  s.loaded_radius[b] += load * s.geometry[b]->rolling_radius(frame, s.depth_in(b, solution));
}

// wheel_contact::add_turning_force: nothing but what moves the surfaces changes it.
void wheel_derivative::add_turning_force(step &s, int index, int b, const patch_change *changes) {
  if (!s.solver.scene().turns() || b > 0 || s.moving == 0) return;
  rated turning(s.wheel.memory[index].turning.about_x);
  for (int k = 0; k < s.size[b]; ++k)
    turning.rate[static_cast<size_t>(k)] = changes[k].turning.about_x;
  const vec<rated> centre = s.frame.origin - s.geometry[b]->lever(s.frame);
  add_yielding(scaled(s.share * turning, s.angle_slope), centre, s.force[b].data(),
               s.moment[b].data());
}

// The patch's own numbers in direction k of a block.
void wheel_derivative::report(step &s, int index, int b, int k, const patch_change &d) {
  const patch_region &region = s.wheel.regions[index];
  const rp_patch_result &found = s.result.patch[index];
  const rated_frame frame = s.frame_in(b, region);
  const auto slot = static_cast<size_t>(k);
  rp_patch_result &to = s.changes[b * rate_directions + k].patch[index];
  report_rates(found, d, to);
  to.approach = s.depth_in(b, s.wheel.patches[index]).rate[slot];
  to.share = s.share_in(b, region).rate[slot];
  for (size_t c = 0; c < 3; ++c) to.position[c] = frame.origin[c].rate[slot];
  const auto on_wheel =
                 s.geometry[b]->on_wheel_profile(frame, s.depth_in(b, s.wheel.patches[index])),
             on_rail = s.geometry[b]->on_rail_profile(frame);
  for (size_t c = 0; c < 2; ++c) {
    to.wheel_profile_position[c] = on_wheel[c].rate[slot];
    to.rail_profile_position[c] = on_rail[c].rate[slot];
  }
  to.contact_angle = frame.contact_angle.rate[slot];
  to.rolling_speed = s.rolling[b].rolling_speed.rate[slot];
  for (int c = 0; c < 2; ++c) {
    to.grid[c] = found.grid[c];
    to.grid_origin[c] = b == 0 ? s.lattice[k].origin[c] : 0.0;
    to.element_size[c] = b == 0 ? s.lattice[k].size[c] : 0.0;
  }
  if (s.solver.scene().tangential == RP_TANGENTIAL_NONE) return;
  to.creepage[0] = s.rolling[b].xi.rate[slot];
  to.creepage[1] = s.rolling[b].eta.rate[slot];
  to.spin_creepage = s.rolling[b].phi.rate[slot];
}

}  // namespace railpatch
