#include "mapping.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "angles.hpp"
#include "railpatch_fields.h"
#include "registry.hpp"

namespace contact_addon {

namespace {

[[noreturn]] void no(const std::string &text, int code = error_other) { throw refusal{code, text}; }

// A body without second spring is elastic, whatever its time.
void map_viscous(const problem &p, rp_config &c) {
  const material_data &m = p.material;
  for (int k = 0; k < 2; ++k) {
    c.viscoelastic_ratio[k] = m.flexibility[1 - k];
    c.relaxation_time[k] = m.flexibility[1 - k] > 0 ? m.relaxation[1 - k] : 0.0;
  }
  if (!(m.flexibility[0] > 0 || m.flexibility[1] > 0)) return;
  if (p.wheel_rail()) no("M = 1, viscoelastic bodies, of wheels on rails has no counterpart");
  if (p.flags.get(flag_tangential) != 3)
    no("M = 1, viscoelastic bodies, is for steady rolling, T = 3");
}

void map_bodies(const problem &p, rp_config &c) {
  const material_data &m = p.material;
  for (int k = 0; k < 2; ++k) {
    c.shear_modulus[k] = m.shear[1 - k];
    c.poisson_ratio[k] = m.poisson[1 - k];
  }
  if (m.method == 1) map_viscous(p, c);
  if (m.method == 4) {
    c.layer_shear_modulus = m.layer_shear;
    c.layer_thickness = m.layer_thickness;
    c.layer_yield_stress = m.yield_stress;
    c.layer_hardening = m.yield_stress > 0 ? m.hardening : 0.0;
    c.plastic_rule = RP_PLASTIC_PATH;
  }
  c.tolerance = p.solver.tolerance;
  c.max_iterations = p.solver.max_iterations;
  const bool viscous = c.viscoelastic_ratio[0] > 0 || c.viscoelastic_ratio[1] > 0;
  c.derivatives = p.flags.get(flag_sensitivity) >= 2 && !p.wheel_rail() && !viscous;
}

void map_normal(const problem &p, rp_config &c) {
  const int b = p.flags.get(flag_bound);
  if (b == 1) no("B = 1, a thin sheet, has no counterpart");
  if (b == 4) no("B = 4, SDEC, has no counterpart");
  const bool ellipse = b == 2 || b == 3;
  if (ellipse && p.wheel_rail()) no("B = 2 and 3 are for basic contacts (module 3)");
  if (ellipse && p.grid.ipotcn > 0) no("B = 2 and 3 need an ellipse, IPOTCN < 0");
  c.normal = ellipse  ? RP_NORMAL_HERTZ
             : b == 5 ? RP_NORMAL_KIK_PIOTROWSKI
             : b == 6 ? RP_NORMAL_ANALYN
                      : RP_NORMAL_HALF_SPACE;
}

void map_tangential(const problem &p, bool in_history, rp_config &c) {
  const int t = p.flags.get(flag_tangential), m = p.material.method, b = p.flags.get(flag_bound);
  if (t == 1 && p.wheel_rail()) no("T = 1, a shift, of wheels on rails has no counterpart");
  c.regime = t > 0 ? RP_STEADY_ROLLING : RP_REGIME_NONE;
  c.tangential = RP_TANGENTIAL_FULL;
  c.spin_offset = RP_SPIN_OFFSET_SIXTH;
  if (t == 0) {
    c.spin_offset = RP_SPIN_OFFSET_AUTOMATIC;
    if (p.wheel_rail()) {
      c.regime = RP_STEADY_ROLLING;
      c.tangential = RP_TANGENTIAL_NONE;
    }
    return;
  }
  const bool fast = m == 3 || m >= 5;
  if (fast && t != 3) no("M = " + std::to_string(m) + " is for steady rolling, T = 3");
  if (fast) c.spin_offset = RP_SPIN_OFFSET_NONE;
  if (m == 3) {
    c.tangential = RP_TANGENTIAL_FASTSIM;
    c.flexibility_blending = RP_BLENDING_CONTACT;
    c.traction_bound = b == 3   ? RP_BOUND_PARABOLIC
                       : b == 2 ? RP_BOUND_ELLIPTIC
                                : RP_BOUND_AUTOMATIC;
    c.fastsim_k0 = p.material.k0;
    c.fastsim_alpha = p.material.alpha;
    c.fastsim_beta = p.material.beta;
  } else if (m >= 5) {
    const material_data &d = p.material;
    if (m == 5 && !(d.k0 == 1 && d.alpha == 1))
      no("M = 5, FaStrip with factors K0 and ALFA other than 1, has no counterpart");
    c.tangential = RP_TANGENTIAL_FASTRIP;
    c.flexibility_blending = m == 6 ? RP_BLENDING_NONE : RP_BLENDING_SLIDING;
  } else if (b == 3) {
    no("B = 3, the parabolic bound, is for FASTSIM (M = 3) here");
  }
  if (t < 3 || in_history) let_regime_change(c);
  if (p.flags.get(flag_extra_slip) > (p.wheel_rail() ? 0 : 1))
    no("E3, spin dropped from the slip, has no counterpart");
}

void map_heat(const problem &p, rp_config &c) {
  if (!p.heat.on) return;
  if (p.flags.get(flag_tangential) != 3) no("H = 3, temperature, is for steady rolling, T = 3");
  c.temperature = 1;
  for (int k = 0; k < 2; ++k) {
    c.bulk_temperature[k] = p.heat.bulk[1 - k];
    c.heat_capacity[k] = p.heat.capacity[1 - k];
    c.conductivity[k] = p.heat.conductivity[1 - k];
    c.density[k] = p.heat.density[1 - k];
  }
  c.plastic_heat_fraction = p.heat.plastic_fraction;
}

void map_law(const friction_data &f, const friction_set &set, rp_config &c) {
  const double *v = set.values;
  c.friction_law = RP_COULOMB;
  if (f.law == 0) {
    c.friction_coefficient = std::min(v[0], v[1]);  // the peer takes the lesser for both
  } else if (f.law <= 4) {
    c.friction_law = RP_SLIP_VELOCITY;
    c.slip_law = f.law == 2 ? RP_SLIP_LINEAR : f.law == 3 ? RP_SLIP_RATIONAL : RP_SLIP_EXPONENTIAL;
    if (f.law == 3 && v[3] != 0)
      no("L = 3 with F2, a term of the square of slip, has no counterpart", error_friction);
    c.friction_kinetic = v[0];
    for (int k = 0; k < 2; ++k) {
      c.friction_amplitude[k] = v[1 + 2 * k];
      c.friction_halving_speed[k] = v[1 + 2 * k] != 0 ? v[2 + 2 * k] : 1.0;
    }
    c.friction_memory_distance = v[5];
    c.friction_memory_speed = v[6] > 0 ? v[6] : 1e-3;
  } else if (f.law == 5) {
    c.friction_law = RP_SLIP_VELOCITY;
    c.slip_law = RP_SLIP_EXPONENTIAL;
    c.friction_kinetic = v[1] * v[0];
    c.friction_amplitude[0] = (1 - v[1]) * v[0];
    c.friction_halving_speed[0] = std::numbers::ln2 / v[2];
    c.friction_memory_distance = 1e-6;
    c.friction_memory_speed = 0.01;
  } else {
    c.friction_law = RP_TEMPERATURE;
    if (v[4] != 0) no("L = 6 with a memory distance has no counterpart", error_friction);
    c.friction_reference = v[0];
    c.friction_reference_temperature = v[1];
    c.friction_change = v[2];
    c.friction_temperature_range = v[3];
  }
}

// Of a set over the first one, where it is a multiple of it.
double factor_of(const friction_data &f, const friction_set &set) {
  const double *one = f.sets[0].values, *v = set.values;
  const bool slip = f.law >= 2 && f.law <= 4;
  const double first = f.law == 0 ? std::min(one[0], one[1]) : one[0];
  const double here = f.law == 0 ? std::min(v[0], v[1]) : v[0];
  if (!(first > 0))
    no("friction that varies needs a coefficient > 0 in its first set", error_friction);
  const double factor = here / first;
  const auto kept = [&](int i) { return std::fabs(v[i] - one[i]) <= 1e-9 * std::fabs(one[i]); };
  const auto scaled = [&](int i) {
    return std::fabs(v[i] - factor * one[i]) <= 1e-9 * std::fabs(factor * one[i]);
  };
  bool multiple = true;
  if (slip) multiple = scaled(1) && kept(2) && scaled(3) && kept(4) && kept(5) && kept(6);
  if (f.law == 5) multiple = kept(1) && kept(2);
  if (f.law == 6) multiple = kept(1) && scaled(2) && kept(3);
  if (!multiple)
    no("friction sets that are no multiples of the first one have no counterpart", error_friction);
  return factor;
}

void map_friction(const problem &p, rp_config &c) {
  const friction_data &f = p.friction;
  if (c.regime == RP_REGIME_NONE || c.tangential == RP_TANGENTIAL_NONE) return;
  map_law(f, f.sets[0], c);
  if (c.friction_law == RP_TEMPERATURE && !p.heat.on)
    no("L = 6, friction over temperature, needs temperatures, H = 3", error_friction);
  const auto count = static_cast<int>(f.sets.size());
  if (f.variation == 0 || count == 1) return;
  const bool along = f.variation == 2;
  (along ? c.friction_along_points : c.friction_points) = count;
  for (int i = 0; i < count; ++i) {
    // the rail's surface angle counts the other way, from the track
    const friction_set &set = f.sets[static_cast<size_t>(along ? i : count - 1 - i)];
    (along ? c.friction_along_position : c.friction_position)[i] =
        along ? set.place : p.wheel.cant - set.place;
    (along ? c.friction_along_factor : c.friction_factor)[i] = factor_of(f, set);
  }
}

// Where a basic contact's undeformed distance is, h (m) at x, y.
double distance_at(const distance_data &d, double x, double y) {
  const double *b = d.values.data();
  if (d.ibase == 1) return b[0] * x * x + b[1] * x * y + b[2] * y * y + b[3] * x + b[4] * y + b[5];
  if (d.ibase == 3)
    return b[0] * contact_addon::sin(b[1] * (x - b[2])) -
           b[3] * contact_addon::sin(b[4] * (x - b[5])) + x * x / b[6] + y * y / b[7];
  const auto count = static_cast<int>(d.values.size()) - 5;
  const double at = (y - b[3]) / b[4];
  if (count < 2 || at < -1e-9 || at > count - 1 + 1e-9)
    no("IBASE = 2: a row of the grid is outside the given heights");
  const int k = std::clamp(static_cast<int>(std::floor(at)), 0, count - 2);
  const double height = b[5 + k] + (at - k) * (b[6 + k] - b[5 + k]);
  return height + (x - b[1]) * (x - b[1]) / (2 * b[2]);
}

void check_size(const grid_data &g) {
  if (g.mx < 1 || g.my < 1)
    no("a grid of " + std::to_string(g.mx) + " x " + std::to_string(g.my) +
       " elements: fewer than 1 either way are not possible");
  if (g.mx > 1000 || g.my > 1000)
    no("a grid of more than 1000 elements either way has no counterpart");
}

void map_grid(const problem &p, mapped_case &out) {
  rp_config &c = out.config;
  grid_data g = p.grid;
  ellipse e;
  if (g.ipotcn < 0) {
    e = ellipse_of(p);
    const double scale = g.hertz[2];
    if (!(scale >= 1)) no("SCALE must be 1 or more");
    g.dx = 2 * scale * e.a / g.mx;
    g.dy = 2 * scale * e.b / g.my;
    g.x0 = -scale * e.a + 0.5 * g.dx;
    g.y0 = -scale * e.b + 0.5 * g.dy;
    out.hertz[0] = e.A1;
    out.hertz[1] = e.B1;
  }
  out.grid = g;
  c.element_size[0] = g.dx;
  c.element_size[1] = g.dy;
  c.elements[0] = c.elements[1] = 0;
  if (g.ipotcn == -4 || g.ipotcn == -5) {
    c.geometry = RP_LINE_CONTACT;
    c.line_contact_radius = 0.5 / e.A1;
    c.width = 2 * e.b;
    const bool viscous = c.viscoelastic_ratio[0] > 0 || c.viscoelastic_ratio[1] > 0;
    c.normal = viscous ? RP_NORMAL_HALF_SPACE : RP_NORMAL_HERTZ;
    return;
  }
  if (c.normal == RP_NORMAL_HERTZ) {
    c.geometry = RP_CURVATURES;
    c.curvatures[0] = e.A1;
    c.curvatures[1] = e.B1;
    c.max_elements[0] = std::clamp(g.mx + 4, 0, 1002);
    c.max_elements[1] = std::clamp(g.my + 4, 0, 1002);
    return;
  }
  check_size(g);
  c.geometry = RP_UNDEFORMED_DISTANCE;
  c.distance_shape[0] = g.mx;
  c.distance_shape[1] = g.my;
  out.on_own_grid = true;
  out.offset[0] = g.x0 + 0.5 * (g.mx - 1) * g.dx;
  out.offset[1] = g.y0 + 0.5 * (g.my - 1) * g.dy;
  if (g.ipotcn < 0) out.offset[0] = out.offset[1] = 0;
  const bool given = g.ipotcn > 0 && p.distance.ibase == 9;
  const auto count = static_cast<size_t>(g.mx) * static_cast<size_t>(g.my);
  if (given && p.distance.values.size() != count)
    no("IBASE = 9 has as many values as the grid has elements");
  out.distance.resize(count);
  for (int j = 0; j < g.my; ++j)
    for (int i = 0; i < g.mx; ++i) {
      const size_t at = static_cast<size_t>(j) * static_cast<size_t>(g.mx) + static_cast<size_t>(i);
      const double x = g.x0 + i * g.dx, y = g.y0 + j * g.dy;
      out.distance[at] = given          ? p.distance.values[at]
                         : g.ipotcn < 0 ? e.A1 * x * x + e.B1 * y * y
                                        : distance_at(p.distance, x, y);
    }
}

// Extra rigid slip of each element; none where none was set.
void map_slip(const problem &p, mapped_case &out) {
  rp_config &c = out.config;
  const bool rolls = c.regime != RP_REGIME_NONE;
  if (p.flags.get(flag_extra_slip) == 0 || !rolls || p.extra_slip[0].empty()) return;
  if (!out.on_own_grid || c.tangential != RP_TANGENTIAL_FULL)
    no("E = 1, extra rigid slip of each element, needs the full theory (M = 0, 4) on a grid: not "
       "with B = 2, 3 and IPOTCN = -4, -5");
  if (p.extra_slip[0].size() != out.distance.size())
    no("extra rigid slip has as many values as the grid has elements");
  c.slip_by_element = 1;
  c.derivatives = 0;
  for (const auto &part : p.extra_slip)
    for (const double w : part) out.slip.push_back(-w);
}

void map_basic(const problem &p, mapped_case &out) {
  rp_config &c = out.config;
  c.kind = RP_PATCH;
  c.load = p.flags.get(flag_normal) == 1 ? RP_FORCE : RP_POSITION;
  const int f = c.regime == RP_REGIME_NONE ? 0 : p.flags.get(flag_force);
  if (f == 3) no("F = 3 is for wheels on rails (module 1)");
  if (f > 0 && c.load != RP_FORCE)
    no("F > 0, forces relative to FSTAT FN, needs the normal force, N = 1");
  c.force_prescribed[0] = f >= 1;
  c.force_prescribed[1] = f == 2;
  if (f > 0 && c.tangential != RP_TANGENTIAL_FULL) no("F > 0 needs the full theory, M = 0 or 4");
  map_grid(p, out);
  map_slip(p, out);
}

void map_wheel(const problem &p, mapped_case &out) {
  const wheel_data &w = p.wheel;
  rp_config &c = out.config;
  c.kind = RP_WHEEL_RAIL;
  c.side = p.side();
  c.load = p.flags.get(flag_normal) == 1 ? RP_FORCE : RP_POSITION;
  const int f = p.flags.get(flag_force), d = p.flags.get(flag_patches);
  if ((f == 1 || f == 2) && c.tangential == RP_TANGENTIAL_NONE)
    no("F = 1 and 2, force or torque on the wheel, need a tangential problem");
  c.longitudinal_prescribed = f == 1;
  c.axle_free = f == 2;
  if (d == 3 || d >= 6)
    no("D = " + std::to_string(d) + ", this search for contacts, has no counterpart");
  c.patch_rule = RP_PATCHES_CONTACT;
  c.contact_frame = RP_FRAME_TRACK;
  if (d == 4) c.reference_surface = RP_REFERENCE_CURVED;
  const int c3 = p.flags.get(flag_influence);
  if (c3 == 3) no("C3 = 3, bilinear elements, has no counterpart");
  if (c3 == 4 && d != 4) no("C3 = 4, influence of angles, goes with D = 4, conformal contact");
  const double usual[3] = {8e-3, 4e-3, 12e-3};
  for (int i = 0; i < 3; ++i)
    if (std::fabs(w.combination[i] - usual[i]) > 1e-9)
      no("D_SEP, D_COMB, D_TURN other than 8, 4 and 12 mm have no counterpart");
  if (w.separation_angle < 1.57) no("A_SEP below 90 degrees has no counterpart");
  if (w.misses) no("G_MISS has no counterpart");
  c.elements[0] = c.elements[1] = 0;
  c.element_size[0] = w.dx;
  c.element_size[1] = w.ds;
  c.standstill_speed = 0;
  c.nominal_radius = w.nominal_radius;
  c.flange_back_distance = w.flange_back_distance;
  c.flange_back_position = w.flange_back_position;
  c.track = p.roller() ? RP_ROLLER : RP_RAIL;
  if (w.gauge_height > 0) {
    c.gauge = w.gauge;
    c.gauge_height = w.gauge_height;
  } else {
    if (p.roller()) no("GAUGHT <= 0, placed by RAILY0 and RAILZ0, of rollers has no counterpart");
    c.rail_origin_y[c.side] = w.rail_place[0];
    c.rail_origin_z[c.side] = w.rail_place[1];
  }
  if (p.roller()) {
    if (w.cant != 0) no("CANT of rollers has no counterpart: incline the profile");
    if (w.curvature != 0) no("CURV of rollers has no counterpart");
    c.roller_radius = w.roller_radius;
  } else {
    c.cant = w.cant;
    c.curvature = w.curvature;
  }
  if (f == 3) {
    c.rail_stiffness[0] = w.support[0];
    c.rail_stiffness[1] = w.support[2];
  }
  if (w.wheel_profile.empty()) no("no wheel profile was given", error_profile);
  if (w.rail_profile.empty()) no("no rail profile was given", error_profile);
  out.wheel_profile = w.wheel_profile;
  out.rail_profile = w.rail_profile;
  out.wheel_slices = w.wheel_matched;
  out.rail_slices = w.rail_matched;
  if (w.wheel_slices.featured() || w.rail_slices.featured()) c.section_match = RP_SECTIONS_BY_KNOT;
  if (w.wheel_slices.place.size() > 1 || w.rail_slices.place.size() > 1)
    c.section_blend = RP_SECTIONS_CUBIC;
  out.profile_changes = w.profile_changes;
}

}  // namespace

double static_friction(const problem &p) {
  const double *v = p.friction.sets[0].values;
  if (p.friction.law == 0) return std::min(v[0], v[1]);
  if (p.friction.law <= 4) return v[0] + v[1] + v[3];
  return v[0];
}

void let_regime_change(rp_config &c) {
  c.regime = RP_TRANSIENT_ROLLING;
  c.regime_changes = 1;
  c.spin_offset = RP_SPIN_OFFSET_CONTACT;
}

mapped_case map_case(const problem &p, bool in_history) {
  for (const auto &[call, why] : p.refused)
    if (!why.empty()) no(why, why.starts_with("profile: ") ? error_profile : error_other);
  mapped_case out;
  rp_default_config(&out.config);
  map_bodies(p, out.config);
  map_normal(p, out.config);
  map_tangential(p, in_history, out.config);
  map_heat(p, out.config);
  map_friction(p, out.config);
  if (p.wheel_rail())
    map_wheel(p, out);
  else
    map_basic(p, out);
  return out;
}

namespace {

void input_of_basic(const problem &p, const mapped_case &mapped, rp_input &in) {
  const basic_data &b = p.basic;
  const rp_config &c = mapped.config;
  in.normal_force = b.normal_force;
  in.approach = b.penetration;
  in.rolling_speed = b.velocity;
  in.direction = std::fabs(b.chi) > 1 ? -1 : 1;
  if (p.flags.get(flag_tangential) == 2) {
    if (!(b.step > 0)) throw refusal{error_other, "DQ must be > 0 with T = 2"};
    in.distance = b.step;
  }
  if (c.regime == RP_REGIME_NONE) return;
  // wheel minus rail; about the middle of the grid
  const double phi = -b.creepage[2];
  in.spin_creepage = phi;
  in.creepage[0] = -b.creepage[0] - phi * mapped.offset[1];
  in.creepage[1] = -b.creepage[1] + phi * mapped.offset[0];
  for (int k = 0; k < 2; ++k)
    if (c.force_prescribed[k]) {
      in.creepage[k] = 0;
      in.tangential_force[k] = -b.force[k] * static_friction(p) * b.normal_force;
    }
}

void input_of_wheel(const problem &p, rp_input &in) {
  const wheel_data &w = p.wheel;
  const int s = p.side();
  in.x = w.position[0];
  in.y = w.position[1];
  in.z = w.position[2];
  in.roll = w.position[3];
  in.yaw = w.position[4];
  in.pitch = w.position[5];
  in.vertical_force = w.vertical_force;
  (p.roller() ? in.roller_pitch_rate : in.speed) = w.velocity[0];
  in.vy = w.velocity[1];
  in.vz = w.velocity[2];
  in.roll_rate = w.velocity[3];
  in.yaw_rate = w.velocity[4];
  // force and torque are those on body 1
  const int force = p.flags.get(flag_force);
  if (force == 1)
    in.longitudinal_force = -w.longitudinal_force;
  else if (force == 2)
    in.axle_torque = -w.velocity[5] * p.unit().length;
  else
    in.pitch_rate = w.velocity[5];
  // roll, yaw, pitch there; about x, y, z here
  constexpr int order[3] = {0, 2, 1};
  for (int k = 0; k < 3; ++k) {
    in.wheel_offset[s][k] = w.flexibility[k];
    in.wheel_rotation[s][order[k]] = w.flexibility[3 + k];
    in.wheel_velocity[s][k] = w.flexibility[6 + k];
    in.wheel_angular_velocity[s][order[k]] = w.flexibility[9 + k];
  }
  in.rail_offset[s][1] = w.rail[0];
  in.rail_offset[s][2] = w.rail[1];
  in.rail_rotation[s][0] = w.rail[2];
  in.rail_velocity[s][1] = w.rail[3];
  in.rail_velocity[s][2] = w.rail[4];
  in.rail_angular_velocity[s][0] = w.rail[5];
  if (p.flags.get(flag_force) == 3)
    for (int k = 0; k < 2; ++k)
      if (w.support[2 * k] > 0) in.rail_offset[s][1 + k] += w.support[2 * k + 1] / w.support[2 * k];
  if (p.flags.get(flag_tangential) == 2) {
    const double speed = std::fabs(w.velocity[0]) * (p.roller() ? w.roller_radius : 1.0);
    if (!(speed > 0) || !(w.step_ratio > 0))
      throw refusal{error_other, "T = 2 needs a speed and a step DQREL > 0"};
    in.time_step = w.step_ratio * w.dx / speed;
  }
}

}  // namespace

rp_input map_input(const problem &p, const mapped_case &mapped) {
  rp_input in;
  rp_default_input(&in);
  if (mapped.config.regime_changes == 1) {
    const int t = p.flags.get(flag_tangential);
    in.step_regime = t == 1 ? RP_SHIFT : t == 2 ? RP_TRANSIENT_ROLLING : RP_STEADY_ROLLING;
  }
  if (p.wheel_rail())
    input_of_wheel(p, in);
  else
    input_of_basic(p, mapped, in);
  if (!mapped.slip.empty()) in.slip_field = mapped.slip.data();
  return in;
}

bool same_case(const mapped_case &a, const mapped_case &b) {
  const rp_config &c = a.config, &d = b.config;
#define SAME(type, name, count, ...) \
  if (std::memcmp(&c.name, &d.name, sizeof c.name) != 0) return false;
#define OTHER(type, name, count)
  RP_CONFIG_FIELDS(SAME, OTHER)
#undef SAME
#undef OTHER
  return a.distance == b.distance && a.profile_changes == b.profile_changes &&
         a.grid.mx == b.grid.mx && a.grid.my == b.grid.my && a.grid.x0 == b.grid.x0 &&
         a.grid.y0 == b.grid.y0;
}

}  // namespace contact_addon
