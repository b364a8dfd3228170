#include "patch/patch_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/elementary.hpp"
#include "numeric/nan.hpp"
#include "numeric/sums.hpp"
#include "patch/film_contact_of.hpp"
#include "patch/patch_contact.hpp"

namespace railpatch {

namespace {

constexpr int at_once = 8;  // directions of the normal problem
// so many directions cost less by their resultants
constexpr int few = 3;

bool on_half_space(const patch_scene &scene) { return scene.normal == RP_NORMAL_HALF_SPACE; }
bool rolls(const patch_scene &scene) { return scene.tangential == RP_TANGENTIAL_FULL; }
bool is_loaded(const patch_problem &problem, const patch_memory &memory) {
  const double *p = memory.pressure.data();
  if (memory.pressure.size() == 0) return problem.hertz.normal_force > 0;
  return std::any_of(p, p + problem.g.count(), [](double v) { return v > 0; });
}

}  // namespace

patch_derivative::patch_derivative(const patch_scene &scene, const fft_plans &plans, int max_nx,
                                   int max_ny, bool stretches) {
  const int count = max_nx * max_ny;
  if (stretches && !(scene.line_width > 0) && !scene.closed_form()) {
    influence::medium elastic{scene.elastic, 0.0, 0.0, rolls(scene)};
    elastic.by_length = true;
    by_length_.emplace(elastic, plans);
  }
  if (on_half_space(scene)) normal_.emplace(count, at_once);
  if (rolls(scene)) tangential_.emplace(max_nx, max_ny, few);
  if (scene.tangential == RP_TANGENTIAL_TABLE) ellipses_.emplace(max_ny);
  if (scene.closed_form()) return;
  pressure_ = aligned_buffer<double>::uninitialized(static_cast<size_t>(count) * at_once);
}

size_t patch_derivative::bytes() const {
  return sizeof *this + (by_length_ ? by_length_->bytes() : 0) + (normal_ ? normal_->bytes() : 0) +
         (tangential_ ? tangential_->bytes() : 0) + (ellipses_ ? ellipses_->bytes() : 0) +
         pressure_.bytes();
}

double *patch_derivative::rate_of(const solution &s, int k) {
  return pressure_.data() + static_cast<size_t>(k) * static_cast<size_t>(s.problem.g.count());
}

derivative_outcome patch_derivative::solve(const solution &s, const patch_variation *in, int count,
                                           const derivative_options &options, patch_change *out) {
  derivative_outcome outcome;
  derivative_options o = options;
  // no better than the solution is known; at 3e-6 rates are good to 1e-5 of the greatest of a row
  if (!(o.tolerance > 0)) o.tolerance = std::clamp(0.3 * s.scene.tolerance, 1e-9, 3e-6);
  const grid &g = s.problem.g;
  for (int k = 0; k < count; ++k) out[k] = {};
  if (!is_loaded(s.problem, s.memory)) return outcome;
  if (s.a) s.a->set_grid(g, s.problem.followed);
  if (by_length_) by_length_->set_grid(g);
  rolling_ = s.problem.rolling;
  rolling_.spin_offset = s.scene.spin_offset * rolling_.direction * g.dx;
  const bool by_resultants = count > few;
  const bool rolling = tangential_ && s.problem.rolling_speed > 0;
  if (rolling && by_resultants) {
    outcome.residual = tangential_->begin_resultants(point_of(s), {o.tolerance, o.energy});
  }
  const int step = by_resultants ? at_once : few;
  for (int k = 0; k < count; k += step)
    solve_some(s, in + k, std::min(step, count - k), o, by_resultants, out + k, outcome);
  outcome.converged = outcome.residual <= o.tolerance;
  return outcome;
}

tangential_point patch_derivative::point_of(const solution &s) const {
  const patch_memory &m = s.memory;
  return {*s.a,
          by_length_ ? const_cast<influence *>(&*by_length_) : nullptr,
          *s.blocks,
          s.problem.g,
          rolling_,
          friction_of(s),
          m.row_friction.size() ? m.row_friction.data() : nullptr,
          m.pressure.data(),
          m.px.data(),
          m.py.data(),
          m.sx.data(),
          m.sy.data(),
          m.division.data()};
}

void patch_derivative::solve_some(const solution &s, const patch_variation *in, int count,
                                  const derivative_options &o, bool by_resultants,
                                  patch_change *out, derivative_outcome &outcome) {
  if (normal_)
    differentiate_half_space(s, in, count, o, out, outcome);
  else
    for (int k = 0; k < count; ++k) differentiate_hertz(s, in[k], rate_of(s, k), out[k]);
  const bool closed = s.scene.closed_form();
  for (int k = 0; k < count && !closed; ++k) add_pressure(s, in[k], rate_of(s, k), out[k]);
  for (int k = 0; k < count && closed; ++k) out[k].wrench.force[2] = -out[k].normal_force;
  for (int k = 0; k < count && s.tables; ++k) differentiate_table(s, in[k], rate_of(s, k), out[k]);
  if (tangential_) differentiate_tractions(s, in, count, o, by_resultants, out, outcome);
  for (int k = 0; k < count && s.memory.slope_fields.size(); ++k)
    complete(s, in[k], rate_of(s, k), out[k]);
}

void patch_derivative::differentiate_tractions(const solution &s, const patch_variation *in,
                                               int count, const derivative_options &o,
                                               bool by_resultants, patch_change *out,
                                               derivative_outcome &outcome) {
  tangential_change t[at_once];
  double friction[at_once];
  for (int k = 0; k < count; ++k) friction[k] = friction_rate(s, in[k], rate_of(s, k), out[k]);
  if (s.problem.rolling_speed > 0) {
    tangential_variation v[at_once];
    for (int k = 0; k < count; ++k) {
      v[k] = {rate_of(s, k),
              in[k].row_friction,
              friction[k],
              {in[k].creepage[0], in[k].creepage[1]},
              in[k].spin_creepage,
              {in[k].size[0], in[k].size[1]},
              {in[k].origin[0], in[k].origin[1]},
              s.scene.spin_offset * rolling_.direction * in[k].size[0]};
      const double *rate = v[k].pressure;
      if (std::all_of(rate, rate + s.problem.g.count(), [](double r) { return r == 0; }))
        v[k].pressure = nullptr;
    }
    const tangential_point point = point_of(s);
    if (by_resultants) {
      for (int k = 0; k < count; ++k) tangential_->resultants(point, v[k], t[k]);
    } else {
      const double residual = tangential_->solve(point, v, count, {o.tolerance, o.energy}, t);
      outcome.residual = std::max(outcome.residual, residual);
    }
  }
  for (int k = 0; k < count; ++k) {
    add_tractions(s, in[k], t[k], o.energy, out[k]);
    out[k].capacity = capacity_rate(s, in[k], friction[k], rate_of(s, k));
  }
}

void patch_derivative::differentiate_half_space(const solution &s, const patch_variation *in,
                                                int count, const derivative_options &o,
                                                patch_change *out, derivative_outcome &outcome) {
  const patch_problem &problem = s.problem;
  const grid &g = problem.g;
  const double *p = s.memory.pressure.data(), *h = s.memory.undeformed_distance.data();
  normal_variation v[at_once];
  double approach[at_once];
  for (int k = 0; k < count; ++k) {
    v[k].distance = in[k].distance;
    std::copy_n(in[k].size, 2, v[k].size);
    std::copy_n(in[k].part_factor, contact_parts::capacity - 1, v[k].factor);
    v[k].force = in[k].normal_force;
    v[k].approach = in[k].approach;
  }
  const normal_point point{
      *s.a, by_length_ ? &*by_length_ : nullptr, *s.normal, g, problem.parts, problem.force_given,
      p};
  const double residual = normal_->solve(point, v, count, o.tolerance, rate_of(s, 0), approach);
  outcome.residual = std::max(outcome.residual, residual);
  const auto n = static_cast<size_t>(g.count());
  for (int k = 0; k < count; ++k) {
    const double *rate = rate_of(s, k);
    const double growth = in[k].size[0] / g.dx + in[k].size[1] / g.dy;
    double energy = 0, whole = 0;
    for (size_t i = 0; i < n; ++i) {
      if (!(p[i] > 0)) continue;
      const double dh = in[k].distance ? in[k].distance[i] : 0.0, u = s.memory.approach - h[i];
      energy += rate[i] * u + p[i] * (approach[k] - dh);
      whole += p[i] * u;
    }
    out[k].approach = approach[k];
    out[k].elastic_energy = out[k].pressure_energy = 0.5 * (energy + growth * whole) * g.dx * g.dy;
    const auto top = std::max_element(p, p + n) - p;
    out[k].max_pressure = rate[top];
    out[k].contact_area =
        growth * g.dx * g.dy *
        static_cast<double>(std::count_if(p, p + n, [](double v) { return v > 0; }));
    out[k].normal_force = (total(rate, n) + growth * total(p, n)) * g.dx * g.dy;
    for (int c = 0; c < 2; ++c) out[k].growth[c] = in[k].size[c] / (c == 0 ? g.dx : g.dy);
  }
}

// The ellipse's pressure, sampled and then scaled to the force (normal_stage.cpp).
void patch_derivative::differentiate_hertz(const solution &s, const patch_variation &v,
                                           double *rate, patch_change &out) const {
  const grid &g = s.problem.g;
  const hertz_contact &c = s.problem.hertz, &d = v.hertz;
  const double a = c.semi_axes[0], b = c.semi_axes[1];
  const double *p = s.memory.pressure.data();
  const double along = d.semi_axes[0] / a, across = b > 0 ? d.semi_axes[1] / b : 0.0;
  double sum = 0, change = 0;
  const bool on_grid = !s.scene.closed_form();
  for (int j = 0; j < g.ny && on_grid; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const auto at = static_cast<size_t>(j * g.nx + i);
      rate[at] = 0;
      if (!(p[at] > 0)) continue;
      const double x = g.x(i) / a, y = b > 0 ? g.y(j) / b : 0.0, level = 1.0 - x * x - y * y;
      const double dx = (v.origin[0] + i * v.size[0]) / a - x * along;
      const double dy = b > 0 ? (v.origin[1] + j * v.size[1]) / b - y * across : 0.0;
      rate[at] = -p[at] * (x * dx + y * dy) / level;
      sum += p[at];
      change += rate[at];
    }
  if (on_grid) {
    const double growth = v.size[0] / g.dx + v.size[1] / g.dy;
    const double scale = d.normal_force / c.normal_force - growth - change / sum;
    for (size_t i = 0; i < static_cast<size_t>(g.count()); ++i) rate[i] += scale * p[i];
  }
  out.normal_force = d.normal_force;
  out.max_pressure = d.max_pressure;
  const bool line = s.scene.line_width > 0;
  out.approach = line ? nan : d.approach;
  out.contact_area = line ? 2.0 * d.semi_axes[0] * s.scene.line_width
                          : std::numbers::pi * a * b * (along + across);
  out.growth[0] = along;
  out.growth[1] = line ? 0.0 : across;
  out.elastic_energy = out.pressure_energy =
      line ? nan : 0.4 * (d.normal_force * c.approach + c.normal_force * d.approach);
}

// The pressure's wrench.
void patch_derivative::add_pressure(const solution &s, const patch_variation &v, const double *rate,
                                    patch_change &out) const {
  const grid &g = s.problem.g;
  const double *p = s.memory.pressure.data();
  const double growth = v.size[0] / g.dx + v.size[1] / g.dy, area = g.dx * g.dy;
  double force = 0, moment[2] = {0, 0};
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int at = j * g.nx + i;
      const double change = rate[at] + growth * p[at];
      force += change;
      moment[0] += g.y(j) * change + (v.origin[1] + j * v.size[1]) * p[at];
      moment[1] += g.x(i) * change + (v.origin[0] + i * v.size[0]) * p[at];
    }
  out.wrench.force[2] = -area * force;
  out.wrench.moment[0] = -area * moment[0];
  out.wrench.moment[1] = area * moment[1];
}

// What patch_contact::complete adds.
void patch_derivative::complete(const solution &s, const patch_variation &v, const double *rate,
                                patch_change &out) const {
  const patch_memory &m = s.memory;
  const grid &g = s.problem.g;
  const double *p = m.pressure.data();
  patch_wrench whole{}, sum{};
  const double *force = out.creep_force_value;
  if (tangential_ || s.tables) {
    add_depth(v.contact_depth, force[0], force[1], sum);
    add_depth(s.problem.place.contact_depth, out.creep_force[0], out.creep_force[1], sum);
  }
  if (s.scene.closed_form()) {
    const hertz_contact &hertz = s.problem.hertz;
    add_inclined_ellipse_rates(directed_of(hertz.semi_axes[1], v.hertz.semi_axes[1]),
                               directed_of(hertz.normal_force, v.hertz.normal_force), g, m.slopes,
                               v.slopes, v.origin[1], v.size[1], sum);
    for (int k = 0; k < 3; ++k) {
      out.wrench.force[k] += sum.force[k];
      out.wrench.moment[k] += sum.moment[k];
    }
    return;
  }
  add_inclined(g, p, m.slopes, whole);
  add_inclined(g, rate, m.slopes, sum);
  add_inclined_rates(g, p, m.slopes, v.slopes, v.origin, v.size, sum);
  if (s.scene.turns()) {
    out.turning = energy_of_turning_rate(g, p, rate, m.undeformed_distance.data(), v.distance,
                                         m.slopes, v.slopes, v.size);
    add_turning(out.turning, s.problem.place.depth_part(), out.wrench);
    out.wrench.moment[1] += v.depth_part * m.turning.about_s;
  }
  const double growth = v.size[0] / g.dx + v.size[1] / g.dy;
  for (int k = 0; k < 3; ++k) {
    out.wrench.force[k] += sum.force[k] + growth * whole.force[k];
    out.wrench.moment[k] += sum.moment[k] + growth * whole.moment[k];
  }
}

double patch_derivative::friction_of(const solution &s) {
  return s.scene.fluid ? s.memory.wet.friction * s.scene.friction_scale : s.scene.friction();
}

double patch_derivative::friction_rate(const solution &s, const patch_variation &v,
                                       const double *rate, patch_change &out) {
  const patch_scene &scene = s.scene;
  if (!scene.fluid)
    return scene.friction_scale * v.friction.coefficient +
           scene.friction_coefficient * v.friction.scale;
  out.film = film_rates_of(scene, s.problem, s.memory, v, rate, out.normal_force);
  const auto &wet = s.memory.wet;
  if (wet.shear > 0)
    out.shear_part = (out.film.shear - wet.shear / wet.friction * out.film.friction) / wet.friction;
  // as it is reported: with the scale
  out.film.friction = scene.friction_scale * out.film.friction + wet.friction * v.friction.scale;
  return out.film.friction;
}

// Of the sum of friction coefficient times pressure, Coulomb's law. rate: of the pressure.
double patch_derivative::capacity_rate(const solution &s, const patch_variation &v, double friction,
                                       const double *rate) {
  const grid &g = s.problem.g;
  const double *p = s.memory.pressure.data();
  const double growth = v.size[0] / g.dx + v.size[1] / g.dy, mu = friction_of(s);
  double sum = 0;
  for (int j = 0; j < g.ny; ++j) {
    double load = 0, change = 0;
    for (int i = j * g.nx; i < (j + 1) * g.nx; ++i) {
      load += p[i];
      change += rate[i];
    }
    const auto row = static_cast<size_t>(j);
    const double factor = s.memory.row_friction.size() ? s.memory.row_friction[row] : 1.0;
    const double turned = v.row_friction ? v.row_friction[row] : 0.0;
    sum += mu * (factor * (change + growth * load) + turned * load) + friction * factor * load;
  }
  return sum * g.dx * g.dy;
}

// The tractions' wrench. In steady rolling friction takes the power -V sum p . w dA.
void patch_derivative::add_tractions(const solution &s, const patch_variation &v,
                                     const tangential_change &t, bool energy,
                                     patch_change &out) const {
  const patch_memory &m = s.memory;
  out.elastic_energy = energy ? out.elastic_energy + t.energy : nan;
  const patch_wrench w = sum_tractions(s.problem.g, m.pressure.data(), m.px.data(), m.py.data());
  const double force[2] = {w.force[0], w.force[1]};
  for (int c = 0; c < 2; ++c) out.creep_force[c] = t.force[c];
  out.spin_moment = t.moment;
  add_creep_forces(s, v, force, w.moment[2], out);
}

// Creep forces, whose rates are in out, in the wrench; their size and power.
void patch_derivative::add_creep_forces(const solution &s, const patch_variation &v,
                                        const double (&force)[2], double moment,
                                        patch_change &out) const {
  std::copy_n(force, 2, out.creep_force_value);
  for (int c = 0; c < 2; ++c) out.wrench.force[c] = out.creep_force[c];
  out.wrench.moment[2] = out.spin_moment;
  const double speed = s.problem.rolling_speed;
  if (!(speed > 0)) return;
  const double size = hypot(force[0], force[1]);
  if (size > 0)
    out.creep_size = (force[0] * out.creep_force[0] + force[1] * out.creep_force[1]) / size;
  const double work = rolling_.creepage[0] * force[0] + rolling_.creepage[1] * force[1] +
                      rolling_.spin_creepage * moment;
  const double rate = v.creepage[0] * force[0] + v.creepage[1] * force[1] +
                      v.spin_creepage * moment + rolling_.creepage[0] * out.creep_force[0] +
                      rolling_.creepage[1] * out.creep_force[1] +
                      rolling_.spin_creepage * out.spin_moment;
  out.friction_power = -(v.rolling_speed * work + speed * rate);
}

// A table's forces, as fast_solver::solve has them.
void patch_derivative::differentiate_table(const solution &s, const patch_variation &v,
                                           const double *rate, patch_change &out) {
  if (!(s.problem.rolling_speed > 0)) return;
  const grid &g = s.problem.g;
  const double *p = s.memory.pressure.data();
  const rolling_input &r = s.problem.rolling;
  const creep_motion<directed> motion{
      {directed_of(r.creepage[0], v.creepage[0]), directed_of(r.creepage[1], v.creepage[1])},
      directed_of(r.spin_creepage, v.spin_creepage),
      r.direction};
  const hertz_contact &hertz = s.problem.hertz;
  const double load = on_half_space(s.scene)
                          ? total(p, static_cast<size_t>(g.count())) * g.dx * g.dy
                          : hertz.normal_force;
  const directed bound = directed_of(friction_of(s), friction_rate(s, v, rate, out)) *
                         directed_of(load, out.normal_force);
  table_resultants<directed> found;
  if (hertz.semi_axes[0] > 0) {
    const directed axes[2] = {directed_of(hertz.semi_axes[0], v.hertz.semi_axes[0]),
                              directed_of(hertz.semi_axes[1], v.hertz.semi_axes[1])};
    found = s.tables->of_ellipse(axes, motion, bound);
  } else {
    found =
        s.tables->of_pressure<directed>({g, p, rate, v.origin, v.size}, motion, bound, *ellipses_);
  }
  for (int c = 0; c < 2; ++c) out.creep_force[c] = found.force[c].rate[0];
  out.spin_moment = found.moment.rate[0];
  out.capacity = bound.rate[0];
  const double force[2] = {found.force[0].value, found.force[1].value};
  add_creep_forces(s, v, force, found.moment.value, out);
}

}  // namespace railpatch
