#include "patch/normal_stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/nan.hpp"

namespace railpatch {

using std::numbers::pi;

namespace {

// m, along x and y, of the elements in contact.
void find_size(const grid &g, const double *pressure, double *size) {
  int first = g.nx, last = -1, low = g.ny, high = -1;
  for (int j = 0; j < g.ny; ++j) {
    const double *p = pressure + j * g.nx;
    int begin = 0, end = g.nx - 1;
    while (begin < g.nx && !(p[begin] > 0)) ++begin;
    if (begin == g.nx) continue;
    while (!(p[end] > 0)) --end;
    first = std::min(first, begin);
    last = std::max(last, end);
    low = std::min(low, j);
    high = j;
  }
  size[0] = std::max(0, last - first + 1) * g.dx;
  size[1] = std::max(0, high - low + 1) * g.dy;
}

// m, of the ends of the rows, with the gaps between areas.
void find_size(const grid &g, const row_contact &rows, const double *pressure, double *size) {
  double begin = HUGE_VAL, end = -HUGE_VAL;
  int low = g.ny, high = -1, touching = 0;
  for (int j = 0; j < g.ny; ++j) {
    const double *p = pressure + j * g.nx;
    if (!std::any_of(p, p + g.nx, [](double v) { return v > 0; })) continue;
    begin = std::min(begin, rows.leading_edge(j, -1));
    end = std::max(end, rows.leading_edge(j, 1));
    low = std::min(low, j);
    high = j;
    ++touching;
  }
  size[0] = std::max(0.0, end - begin);
  size[1] = rows.width() + std::max(0, high - low + 1 - touching) * g.dy;
}

}  // namespace

normal_stage::normal_stage(patch_workspace &shared, int max_nx, int max_ny) : shared_(shared) {
  const patch_scene &scene = shared.scene;
  if (scene.is_viscous())
    viscous_.emplace(max_nx * max_ny);
  else if (scene.normal == RP_NORMAL_HALF_SPACE)
    normal_.emplace(max_nx * max_ny);
  if (takes_rows(scene.normal)) rows_.emplace(scene.normal, scene.modulus(), max_ny);
}

pressure_outcome normal_stage::solve(const patch_problem &problem, patch_memory &memory) {
  pressure_outcome found = rows_                 ? solve_rows(problem, memory)
                           : normal_ || viscous_ ? solve_half_space(problem, memory)
                                                 : solve_hertz(problem, memory);
  if (rows_) found.rows = &*rows_;
  if (memory.pressure.size() == 0) {
    found.loaded = found.normal_force > 0;
  } else {
    const double *p = memory.pressure.data();
    const int count = problem.g.count();
    const int touching =
        static_cast<int>(std::count_if(p, p + count, [](double v) { return v > 0; }));
    found.exterior = count - touching;
    found.loaded = touching > 0;
  }
  if (!found.loaded) degrade(found, RP_NO_CONTACT, RP_REASON_NONE);
  return found;
}

pressure_outcome normal_stage::solve_half_space(const patch_problem &problem,
                                                patch_memory &memory) {
  const grid &g = problem.g;
  double tolerance = shared_.scene.normal_tolerance;
  if (shared_.coupled) tolerance = shared_.coupled->tolerance(tolerance);
  const normal_options options{tolerance, shared_.scene.max_iterations, shared_.scene.ask,
                               shared_.scene.strips, shared_.scene.stretches && problem.follows};
  double *p = memory.pressure.data();
  const double *h =
      shared_.coupled ? shared_.coupled->distance() : memory.undeformed_distance.data();
  const normal_result n =
      viscous_ ? solve_viscous(problem, options, h, p)
      : problem.force_given
          ? normal_->with_force(*shared_.influence, g, h, problem.force, options, p, problem.parts)
          : normal_->with_approach(*shared_.influence, g, h, problem.approach, options, p,
                                   problem.parts);
  pressure_outcome found;
  if (!n.converged) degrade(found, RP_NOT_CONVERGED, RP_REASON_NORMAL_ITERATIONS, n.residual);
  if (shared_.coupled) shared_.coupled->set_scale(n.scale);
  if (n.touches_border) degrade(found, RP_OUT_OF_RANGE, RP_REASON_BORDER);
  found.normal_force = n.normal_force;
  found.approach = n.approach;
  found.iterations = n.iterations;
  found.residual = n.residual;
  found.max_pressure = *std::max_element(p, p + g.count());
  found.contact_area = n.contact_count * g.dx * g.dy;
  find_size(g, p, found.size);
  // at the solution the elastic displacement is approach minus distance wherever p > 0
  double energy = 0;
  for (int i = 0; i < g.count(); ++i) energy += p[i] * (n.approach - h[i]);
  found.elastic_energy = 0.5 * energy * g.dx * g.dy;
  if (shared_.viscous)
    found.viscous_power = problem.rolling_speed * shared_.viscous->normal_loss(p);
  return found;
}

normal_result normal_stage::solve_viscous(const patch_problem &problem,
                                          const normal_options &options, const double *h,
                                          double *p) {
  viscous_influence &a = *shared_.viscous;
  return problem.force_given
             ? viscous_->with_force(a, problem.g, h, problem.force, options, p)
             : viscous_->with_approach(a, problem.g, h, problem.approach, options, p);
}

// The fast theories for contact areas of any shape.
pressure_outcome normal_stage::solve_rows(const patch_problem &problem, patch_memory &memory) {
  const row_contact_result n =
      rows_->solve(problem.g, memory.undeformed_distance.data(),
                   {problem.force_given, problem.force, problem.approach, problem.hertz.approach},
                   problem.parts, memory.pressure.data());
  pressure_outcome found;
  if (!n.converged) degrade(found, RP_NOT_CONVERGED, RP_REASON_NORMAL_ITERATIONS, n.residual);
  if (n.touches_border) degrade(found, RP_OUT_OF_RANGE, RP_REASON_BORDER);
  found.normal_force = n.normal_force;
  found.approach = n.approach;
  found.iterations = n.iterations;
  found.residual = n.residual;
  found.max_pressure = n.max_pressure;
  found.contact_area = n.contact_area;
  find_size(problem.g, *rows_, memory.pressure.data(), found.size);
  found.elastic_energy = n.elastic_energy;
  return found;
}

pressure_outcome normal_stage::solve_hertz(const patch_problem &problem,
                                           patch_memory &memory) const {
  const grid &g = problem.g;
  const hertz_contact &hertz = problem.hertz;
  double sum = 0;
  for (int j = 0; j < g.ny && memory.pressure.size(); ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double level = inside_ellipse(hertz.semi_axes, g.x(i), g.y(j));
      const double p = level > 0 ? hertz.max_pressure * std::sqrt(level) : 0.0;
      memory.pressure[static_cast<size_t>(j * g.nx + i)] = p;
      sum += p * g.dx * g.dy;
    }
  // the sampled pressure carries exactly the closed form's force
  for (int i = 0; i < g.count() && sum > 0; ++i)
    memory.pressure[static_cast<size_t>(i)] *= hertz.normal_force / sum;
  pressure_outcome found;
  found.normal_force = hertz.normal_force;
  found.approach = hertz.approach;
  found.max_pressure = hertz.max_pressure;
  const bool line = shared_.scene.line_width > 0;
  found.contact_area = line ? 2.0 * hertz.semi_axes[0] * shared_.scene.line_width
                            : pi * hertz.semi_axes[0] * hertz.semi_axes[1];
  found.size[0] = 2.0 * hertz.semi_axes[0];
  found.size[1] = line ? shared_.scene.line_width : 2.0 * hertz.semi_axes[1];
  // 1/2 int p u dA of the elliptic pressure (Johnson 1985, section 3.3)
  found.elastic_energy = 0.4 * hertz.normal_force * hertz.approach;
  if (line) found.approach = found.elastic_energy = nan;
  return found;
}

}  // namespace railpatch
