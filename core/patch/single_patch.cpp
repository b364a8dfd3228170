#include "patch/single_patch.hpp"

#include <algorithm>
#include <cmath>

#include "numeric/nan.hpp"
#include "patch/film_contact_of.hpp"
#include "patch/result_sums.hpp"

namespace railpatch {

namespace {

// m; below it the squares of the patch's size vanish, and with them all meaning
constexpr double least_approach = 1e-100;

}  // namespace

single_patch::single_patch(const single_patch_setup &setup, const patch_scene &scene,
                           const fft_plans &plans, stage_marks marks)
    : driver(scene, plans, setup.largest, marks, 1), setup_(setup) {
  const auto count = static_cast<size_t>(setup.largest.nx * setup.largest.ny);
  if (setup.distance) {
    distance_ = aligned_buffer<double>(count);
    std::copy_n(setup.distance, count, distance_.data());
    setup_.distance = nullptr;
  }
  if (setup.geometry == RP_SEMI_AXES) ellipse_ = hertz_ellipse_of(setup.semi_axes);
  if (setup.geometry == RP_CURVATURES) shape_ = hertz_shape_of(setup.curvatures);
  if (!scene.exact) return;
  rates_.emplace();
  rates_->distance = aligned_buffer<double>(count);
  if (scene.friction_variation.varies()) rates_->row_friction = aligned_buffer<double>(count);
}

const patch_memory *single_patch::find(int side, int patch) const {
  return side == RP_RIGHT && patch == 0 ? &memory_.front() : nullptr;
}

const char *single_patch::geometry_reason() const {
  return "undeformed distance of the given shape";
}

// That the step asks for, else the scene's.
motion single_patch::regime_of(const rp_input &in) const {
  if (in.step_regime < 0) return solver_.scene().regime;
  return in.step_regime == RP_SHIFT               ? motion::shift
         : in.step_regime == RP_TRANSIENT_ROLLING ? motion::transient
                                                  : motion::steady;
}

rolling_input single_patch::motion_of(const rp_input &in) const {
  rolling_input step{
      {in.creepage[0], in.creepage[1]}, in.spin_creepage, in.direction, 0.0, nullptr};
  step.regime = regime_of(in);
  step.speed = in.rolling_speed;
  if (step.regime != motion::transient) return step;
  // what stands still does not roll on: tractions stay, as in a shift by nothing
  if (in.rolling_speed > 0)
    step.distance = in.distance;
  else
    step.regime = motion::shift;
  return step;
}

// Whether the patch is off without a solve: no load, or an approach that leaves a gap.
bool single_patch::is_apart(const rp_input &in) const {
  if (setup_.force_given) return in.normal_force == 0;
  return setup_.geometry != RP_UNDEFORMED_DISTANCE && in.approach < least_approach;
}

// Bodies without load just touch.
double single_patch::approach_apart(const rp_input &in) const {
  if (!setup_.force_given) return in.approach;
  const double *h = distance_.data();
  return distance_.size() ? *std::min_element(h, h + distance_.size()) : 0.0;
}

void single_patch::step(const rp_input &in, rp_result &out) {
  rp_side_result &side = out.side[RP_RIGHT];
  rp_patch_result &result = side.patch[0];
  side.patch_count = 1;
  solver_.set_friction_scale(in.friction_scale[RP_RIGHT]);
  if (rates_) rates_->problem = {};
  patch_memory &m = memory();
  patch_problem problem;
  problem.place.rolling_speed = in.rolling_speed;
  if (is_apart(in)) {
    const heat_outcome h = solver_.leave_contact(motion_of(in), m);
    report_apart(solver_.scene(), problem.place, approach_apart(in), h, result);
  } else if (!pose(in, m, problem)) {
    report_beyond(problem.place, problem.g, result);
  } else {
    solver_.begin_step(problem, m);
    solver_.start_from(m, problem);
    set_distance(problem, m);
    patch_wrench wrench;
    solver_.solve(problem, m, result, wrench);
    if (rates_) rates_->problem = problem;
  }
  out.status = side.status = result.status;
  out.reason = side.reason = result.reason;
  out.reason_value = side.reason_value = result.reason_value;
  sum_patches(solver_.scene(), side);
  sum_up(out, out);
}

// A patch has no force on a wheelset.
void single_patch::sum_up(const rp_result &value, rp_result &sum) {
  sum_sides({false, true}, value, sum);
  std::fill_n(sum.force, 3, nan);
  std::fill_n(sum.moment, 3, nan);
}

// The problem of a patch's step but for its distance. Returns whether there is a grid for it.
bool single_patch::pose(const rp_input &in, const patch_memory &m, patch_problem &problem) const {
  const patch_scene &scene = solver_.scene();
  problem.hertz = hertz_of(in);
  if (!set_grid(in, m, problem) || !solver_.fits(problem.g)) return false;
  problem.force_given = setup_.force_given;
  problem.force = in.normal_force;
  problem.approach = in.approach;
  if (scene.tangential == RP_TANGENTIAL_NONE && !scene.is_viscous()) return true;
  problem.place.direction = in.rolling_speed > 0 ? in.direction : 0;
  problem.rolling_speed = in.rolling_speed;
  problem.rolling = motion_of(in);
  problem.shifts = regime_of(in) == motion::shift;
  problem.slip_field = in.slip_field;
  for (int k = 0; k < 2; ++k) problem.tangential_force[k] = in.tangential_force[k];
  return true;
}

hertz_contact single_patch::hertz_of(const rp_input &in) const {
  const double modulus = solver_.scene().modulus();
  const bool force = setup_.force_given;
  switch (setup_.geometry) {
    case RP_SEMI_AXES:
      return force ? hertz_from_ellipse(ellipse_, modulus, in.normal_force)
                   : hertz_ellipse_from_approach(ellipse_, modulus, in.approach);
    case RP_CURVATURES:
      return force ? hertz_from_force(shape_, modulus, in.normal_force)
                   : hertz_from_approach(shape_, modulus, in.approach);
    case RP_LINE_CONTACT:
      return hertz_line(setup_.line_contact_radius, setup_.width, modulus, in.normal_force);
    case RP_UNDEFORMED_DISTANCE:
      break;
  }
  return {};
}

// Grid over the ellipse's bounding box, centred, with one free element around it.
grid single_patch::hertz_grid(const hertz_contact &hertz, const rp_input &in) const {
  grid g;
  if (!setup_.has_grid) return g;
  const grid_rules &rules = setup_.grid;
  const bool line = setup_.geometry == RP_LINE_CONTACT;
  const auto cells = [&](int k, double &size) {
    const double length = 2.0 * rules.relative_size(hertz, k) * hertz.semi_axes[k];
    if (rules.sized) {
      size = rules.element_size[k];
      const int n = static_cast<int>(std::clamp(std::ceil(length / size - 1e-9), 1.0, 1e6));
      // a grid of given capacity holds what fits
      const int most = k == 0 ? setup_.largest.nx : setup_.largest.ny;
      return std::max(n + 2, std::min(rules.with_margin(n) + 2, most));
    }
    size = length / rules.elements[k];
    return rules.with_margin(rules.elements[k]) + 2;
  };
  g.nx = cells(0, g.dx);
  g.ny = line ? 1 : cells(1, g.dy);
  if (line) g.dy = setup_.width;
  g.x0 = -0.5 * (g.nx - 1) * g.dx;
  g.y0 = -0.5 * (g.ny - 1) * g.dy;
  if (rules.farthest > 0) reach_ahead(hertz, in, g);
  return g;
}

// To where the film begins, as far as there is room for it.
void single_patch::reach_ahead(const hertz_contact &hertz, const rp_input &in, grid &g) const {
  const int across = static_cast<int>(std::ceil(2.0 * hertz.semi_axes[0] / g.dx - 1e-9));
  const double wanted = inlet_reach(solver_.scene(), hertz, in.rolling_speed);
  const int more = std::min(setup_.grid.ahead_of(across, wanted), setup_.largest.nx - g.nx);
  if (more <= 0) return;
  g.nx += more;
  if (in.direction < 0) g.x0 -= more * g.dx;
}

// The grid of a step. Returns whether it covers what is drawn on it.
bool single_patch::set_grid(const rp_input &in, const patch_memory &m,
                            patch_problem &problem) const {
  const grid_rules &rules = setup_.grid;
  grid &g = problem.g;
  const auto centre = [&] {
    g.x0 = -0.5 * (g.nx - 1) * g.dx;
    g.y0 = -0.5 * (g.ny - 1) * g.dy;
  };
  if (setup_.geometry == RP_UNDEFORMED_DISTANCE) {
    g.nx = setup_.largest.nx;
    g.ny = setup_.largest.ny;
    g.dx = rules.element_size[0];
    g.dy = rules.element_size[1];
    centre();
  } else if (!solver_.scene().closed_form()) {
    g = hertz_grid(problem.hertz, in);
  }
  if (!solver_.scene().keeps_steps()) return true;
  // shift and transient rolling stay on the grid of their first step
  if (m.history.begun) {
    g = m.g;
  } else if (setup_.geometry != RP_UNDEFORMED_DISTANCE) {
    if (rules.most[0] > 0) g.nx = rules.most[0];
    if (rules.most[1] > 0 && setup_.geometry != RP_LINE_CONTACT) g.ny = rules.most[1];
    centre();
  }
  // Hertz's ellipse is drawn on the grid and not found on it
  return solver_.scene().normal != RP_NORMAL_HERTZ ||
         (2.0 * problem.hertz.semi_axes[0] <= g.nx * g.dx &&
          2.0 * problem.hertz.semi_axes[1] <= g.ny * g.dy);
}

// The undeformed distance of the elements and the friction of the rows.
void single_patch::set_distance(const patch_problem &problem, patch_memory &m) const {
  const stage_mark mark = solver_.marks().enter(RP_STAGE_GEOMETRY);
  const grid &g = problem.g;
  const hertz_contact &hertz = problem.hertz;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      const double x = g.x(i), y = g.y(j);
      m.undeformed_distance[at] = distance_.size()
                                      ? distance_[at]
                                      : hertz.curvatures[0] * x * x + hertz.curvatures[1] * y * y;
    }
  for (size_t j = 0; j < m.row_friction.size() && j < static_cast<size_t>(g.ny); ++j)
    m.row_friction[j] = solver_.scene().friction_variation.at(g.y(static_cast<int>(j)));
}

}  // namespace railpatch
