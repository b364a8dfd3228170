// The normal problem of one patch by the scene's theory.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/nan.hpp"
#include "patch/patch_contact.hpp"

namespace railpatch {

namespace {

using std::numbers::pi;

double inside_ellipse(const double semi_axes[2], double x, double y) {
  const double u = x / semi_axes[0], v = semi_axes[1] > 0 ? y / semi_axes[1] : 0.0;
  return 1.0 - u * u - v * v;
}

}  // namespace

bool patch_contact::solve_normal(const patch_problem &problem, patch_memory &memory,
                                 rp_patch_result &result) {
  const grid &g = problem.g;
  if (rows_)
    solve_rows(problem, memory, result);
  else if (normal_)
    solve_half_space(problem, memory, result);
  else
    solve_hertz(problem, memory, result);
  if (memory.pressure.size() == 0) {
    if (result.normal_force > 0) return true;
    degrade(result, RP_NO_CONTACT);
    return false;
  }
  const int touching = static_cast<int>(std::count_if(
      memory.pressure.data(), memory.pressure.data() + g.count(), [](double p) { return p > 0; }));
  result.elements[RP_EXTERIOR] = g.count() - touching;
  if (touching > 0) return true;
  degrade(result, RP_NO_CONTACT);
  return false;
}

void patch_contact::solve_half_space(const patch_problem &problem, patch_memory &memory,
                                     rp_patch_result &result) {
  const grid &g = problem.g;
  double tolerance = scene_.normal_tolerance;
  if (coupled_) tolerance = coupled_->tolerance(tolerance);
  const normal_options options{tolerance, scene_.max_iterations};
  double *p = memory.pressure.data();
  const double *h = coupled_ ? coupled_->distance() : memory.undeformed_distance.data();
  const normal_result n =
      problem.force_given
          ? normal_->with_force(*influence_, g, h, problem.force, options, p, problem.parts)
          : normal_->with_approach(*influence_, g, h, problem.approach, options, p, problem.parts);
  if (!n.converged) degrade(result, RP_NOT_CONVERGED);
  if (coupled_) coupled_->set_scale(n.scale);
  if (n.touches_border) degrade(result, RP_OUT_OF_RANGE);
  result.normal_force = n.normal_force;
  result.approach = n.approach;
  result.normal_iterations = n.iterations;
  result.residual = n.residual;
  result.max_pressure = *std::max_element(p, p + g.count());
  result.contact_area = n.contact_count * g.dx * g.dy;
  // at the solution the elastic displacement is approach minus distance wherever p > 0
  double energy = 0;
  for (int i = 0; i < g.count(); ++i) energy += p[i] * (n.approach - h[i]);
  result.elastic_energy = 0.5 * energy * g.dx * g.dy;
}

// The fast theories for contact areas of any shape.
void patch_contact::solve_rows(const patch_problem &problem, patch_memory &memory,
                               rp_patch_result &result) {
  const row_contact_result n =
      rows_->solve(problem.g, memory.undeformed_distance.data(),
                   {problem.force_given, problem.force, problem.approach, problem.hertz.approach},
                   problem.parts, memory.pressure.data());
  if (!n.converged) degrade(result, RP_NOT_CONVERGED);
  if (n.touches_border) degrade(result, RP_OUT_OF_RANGE);
  result.normal_force = n.normal_force;
  result.approach = n.approach;
  result.normal_iterations = n.iterations;
  result.residual = n.residual;
  result.max_pressure = n.max_pressure;
  result.contact_area = n.contact_area;
  result.elastic_energy = n.elastic_energy;
}

void patch_contact::solve_hertz(const patch_problem &problem, patch_memory &memory,
                                rp_patch_result &result) {
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
  result.normal_force = hertz.normal_force;
  result.approach = hertz.approach;
  result.max_pressure = hertz.max_pressure;
  const bool line = scene_.line_width > 0;
  result.contact_area = line ? 2.0 * hertz.semi_axes[0] * scene_.line_width
                             : pi * hertz.semi_axes[0] * hertz.semi_axes[1];
  // 1/2 int p u dA of the elliptic pressure (Johnson 1985, section 3.3)
  result.elastic_energy = 0.4 * hertz.normal_force * hertz.approach;
  if (line) result.approach = result.elastic_energy = nan;
}

}  // namespace railpatch
