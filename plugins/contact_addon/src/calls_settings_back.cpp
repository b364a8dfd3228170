// What was set, asked for again.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calls.hpp"
#include "frames.hpp"
#include "mapping.hpp"
#include "solve.hpp"

using namespace contact_addon;

namespace {

// L, NVF, memory, then place, FSTAT, FKIN of each set; lengths in mm.
std::vector<double> friction_parameters(const problem &p) {
  const friction_data &f = p.friction;
  std::vector<double> out{double(f.law), double(f.sets.size()), 0, 0};
  for (const friction_set &set : f.sets) {
    const double *v = set.values;
    double at_rest = v[0], kinetic = v[1];
    if (f.law >= 2 && f.law <= 4) {
      out[2] = v[5] * 1e3;
      out[3] = v[6] * 1e3;
      at_rest = v[0] + v[1] + v[3];
      kinetic = v[0];
    }
    if (f.law == 5) kinetic = v[0] * v[1];
    if (f.law == 6) kinetic = v[0] + v[2];
    const double place = f.variation == 2 ? set.place * 1e3 : set.place;
    out.insert(out.end(), {place, at_rest, kinetic});
  }
  return out;
}

std::vector<double> material_parameters(const problem &p) {
  const material_data &m = p.material;
  const units u = p.unit();
  const double pa = u.pressure(), one = m.shear[0], two = m.shear[1];
  const double shear = 2 / (1 / one + 1 / two);
  const double poisson = 0.5 * shear * (m.poisson[0] / one + m.poisson[1] / two);
  const double unlike =
      0.25 * shear * ((1 - 2 * m.poisson[0]) / one - (1 - 2 * m.poisson[1]) / two);
  const double *d = m.damping_values;
  return {one / pa,
          two / pa,
          shear / pa,
          m.poisson[0],
          m.poisson[1],
          poisson,
          unlike,
          0,
          0,
          0,
          m.k0,
          m.alpha,
          m.beta,
          m.k0 * (m.alpha + (1 - m.alpha) / (1 + m.beta)),
          m.layer_shear / pa,
          m.layer_thickness / u.length,
          m.yield_stress / pa,
          m.hardening * u.volume(),
          d[0],
          d[1],
          d[2],
          d[3]};
}

}  // namespace

void cntc_getflags(int *ire, int *icp, int *count, int *codes, int *values) {
  const char *call = "cntc_getflags";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, codes, values)
  with_problem(call, *ire, *icp, modules::both, patches::either, true, [&](problem &p) {
    for (int i = 0; i < *count; ++i) {
      const int code = codes[i];
      if (code == 0) continue;
      if (code == flag_friction)
        values[i] = p.friction.law;
      else if (code == flag_material)
        values[i] = p.material.method;
      else if (code == flag_heat)
        values[i] = p.heat.on ? 3 : 0;
      else if (code == flag_case)
        values[i] = p.cases;
      else if (code == flag_threads)
        values[i] = threads();
      else if (flag_values::place_of(code) >= 0)
        values[i] = p.flags.get(code);
      else
        say(call, "flag " + std::to_string(code) + " is unknown");
    }
    return 0;
  });
}

void cntc_getparameters(int *ire, int *icp, int *task, int *count, double *values) {
  const char *call = "cntc_getparameters";
  CONTACT_ADDON_NEEDS(call, ire, icp, task, count, values)
  with_problem(call, *ire, *icp, modules::both, patches::patch, false, [&](problem &p) {
    const double L = p.unit().length;
    std::vector<double> all;
    if (*task == 1) {
      const rp_patch_result *r = patch_of(p, *icp);
      const double speed = p.wheel_rail() ? (r ? r->rolling_speed : 0.0) : p.basic.velocity;
      const double step = p.wheel_rail() ? p.wheel.step_ratio * p.wheel.dx : p.basic.step;
      all = {speed / L, p.basic.chi, step / L, 0, 0, p.material.yield_stress / p.unit().pressure()};
    } else if (*task == 2) {
      all = material_parameters(p);
    } else if (*task == 3) {
      all = friction_parameters(p);
    } else {
      say(call, "task " + std::to_string(*task) + " is not 1, 2 or 3");
    }
    std::copy_n(all.data(), std::clamp(*count, 0, static_cast<int>(all.size())), values);
    return 0;
  });
}

namespace {

// Arc lengths at which values are asked for: the input's points, the spline's knots, at a step, or
// knots refined.
std::vector<double> sampled(const profile_curve &curve, int sampling, double step) {
  const std::vector<double> &s = curve.arc_length;
  std::vector<double> out;
  if (sampling == 1 && step > 0) {
    const double length = s.back() - s.front();
    const auto pieces = static_cast<size_t>(std::clamp(std::floor(length / step + 1e-9), 1.0, 1e6));
    for (size_t k = 0; k <= pieces; ++k) out.push_back(s.front() + static_cast<double>(k) * step);
    if (out.back() < s.back() - 1e-12) out.push_back(s.back());
  } else if (sampling >= 2 && sampling <= 1000) {
    for (size_t i = 0; i + 1 < s.size(); ++i)
      for (int k = 0; k < sampling; ++k) out.push_back(s[i] + (s[i + 1] - s[i]) * k / sampling);
    out.push_back(s.back());
  } else {
    out = s;
  }
  return out;
}

bool varies(const problem &p, bool rail) {
  return !(rail ? p.wheel.rail_slices : p.wheel.wheel_slices).empty();
}

// All values of a task; of slices where the last case has them; lengths in mm, arc lengths in the
// caller's unit.
std::vector<double> profile_values(const problem &p, bool rail, int task, int sampling,
                                   double step) {
  const profile_curve &curve = varies(p, rail) ? profile_now(p, rail)
                               : rail          ? p.wheel.rail_profile
                                               : p.wheel.wheel_profile;
  const profile_points &points = rail ? p.wheel.rail_points : p.wheel.wheel_points;
  if (sampling < 0 && (task == 0 || task == 1)) {
    std::vector<double> out;
    if (task == 0) return {double(points.y.size())};
    for (const double y : points.y) out.push_back(1e3 * y);
    for (const double z : points.z) out.push_back(1e3 * z);
    return out;
  }
  const std::vector<double> arcs = sampled(curve, sampling, step * p.unit().length);
  if (task == 0) return {double(arcs.size())};
  std::vector<double> y, z, angle, out;
  for (const double s : arcs) {
    double at_y, at_z, slope;
    curve.at(s, at_y, at_z, slope);
    y.push_back(at_y);
    z.push_back(at_z);
    angle.push_back(slope);
  }
  if (task == 4) {
    for (const double s : arcs) out.push_back(1e3 * s);
    return out;
  }
  if (task == 5) return angle;
  if (task == 6) return std::vector<double>(arcs.size(), 0.0);
  if (task == 2 && p.solved) {
    const frames f = frames_of(p);
    const marker &m = rail ? f.rail : f.wheel;
    const double side = p.left() ? -1.0 : 1.0;
    for (size_t i = 0; i < y.size(); ++i) {
      const double u = side * y[i], w = z[i];
      const double track_y = m.place[1] + m.axes[1][1] * u + m.axes[1][2] * w;
      z[i] = m.place[2] + m.axes[2][1] * u + m.axes[2][2] * w;
      y[i] = track_y;
    }
  }
  if (task != 8)
    for (const double at : y) out.push_back(1e3 * at);
  if (task != 7)
    for (const double at : z) out.push_back(1e3 * at);
  return out;
}

std::vector<double> gauge_values(const problem &p) {
  const wheel_data &w = p.wheel;
  const profile_curve &rail = varies(p, true) ? profile_now(p, true) : w.rail_profile;
  const double height = w.gauge_height > 0 ? w.gauge_height : 0.014;
  const auto place = design_place(rail, p.roller(), w.gauge, height, p.roller() ? 0.0 : w.cant);
  const double inner = 0.5 * w.gauge - place[0];
  const double L = p.unit().length, side = p.left() ? -1.0 : 1.0;
  const bool placed = !(w.gauge_height > 0);
  const double at[2] = {placed ? side * w.rail_place[0] : place[0],
                        placed ? w.rail_place[1] : place[1]};
  return {inner / L, (height - place[1]) / L, at[0] / L, at[1] / L, 0, 0};
}

}  // namespace

void cntc_getprofilevalues(int *ire, int *task, int *nints, int *ints, int *nreals, double *reals,
                           int *count, double *values) {
  const char *call = "cntc_getprofilevalues";
  CONTACT_ADDON_NEEDS(call, ire, task, nints, nreals, count, values)
  with_problem(call, *ire, -1, modules::wheels, patches::element, false, [&](problem &p) {
    const int type = ints && *nints > 0 ? ints[0] : 0, sampling = ints && *nints > 1 ? ints[1] : 0;
    const double step = reals && *nreals > 0 ? reals[0] : 0.0;
    const bool rail = type == 0;
    const bool there = !(rail ? p.wheel.rail_profile : p.wheel.wheel_profile).empty();
    std::vector<double> all;
    if (*task == -1) {
      all = {there ? 0.0 : double(error_profile), there ? 0.0 : double(error_profile)};
    } else if (!there) {
      say(call, "there is no such profile");
    } else if (*task == 3) {
      all = gauge_values(p);
    } else if (*task >= 0 && *task <= 8) {
      all = profile_values(p, rail, *task, sampling, step);
    } else {
      say(call, "task " + std::to_string(*task) + " has no counterpart");
    }
    std::copy_n(all.data(), std::clamp(*count, 0, static_cast<int>(all.size())), values);
    return 0;
  });
}

void cntc_getprofilevalues_new(int *ire, int *task, int *nints, int *ints, int *nreals,
                               double *reals, int *count, double *values) {
  cntc_getprofilevalues(ire, task, nints, ints, nreals, reals, count, values);
}

void cntc_getcalculationtime(int *ire, int *icp, double *cpu, double *wall) {
  const char *call = "cntc_getcalculationtime";
  CONTACT_ADDON_NEEDS(call, ire, icp, cpu, wall)
  with_problem(call, *ire, *icp, modules::both, patches::either, false, [&](problem &p) {
    *cpu = p.cpu;
    *wall = p.wall;
    return 0;
  });
}

void cntc_resetcalculationtime(int *ire, int *icp) {
  const char *call = "cntc_resetcalculationtime";
  CONTACT_ADDON_NEEDS(call, ire, icp)
  with_problem(call, *ire, *icp, modules::both, patches::either, false, [&](problem &p) {
    p.cpu = p.wall = 0;
    return 0;
  });
}
