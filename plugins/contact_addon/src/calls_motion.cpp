#include <algorithm>
#include <cmath>
#include <numbers>

#include "calls.hpp"

using namespace contact_addon;

namespace {

template <class Task>
void set_wheel(const char *call, int *ire, Task task) {
  with_problem(call, *ire, -1, modules::wheels, patches::element, true, [&](problem &p) {
    task(p);
    return 0;
  });
}

template <class Task>
void set_basic(const char *call, int *ire, int *icp, Task task) {
  with_problem(call, *ire, *icp, modules::basic, patches::settings, true, [&](problem &p) {
    task(p);
    return 0;
  });
}

// values of one set of a friction law: counts by L; of L = 2 ... 4 and 6 with the memory
constexpr int set_sizes[7] = {2, 0, 7, 7, 7, 3, 6};

friction_set set_of(int law, const double *v, const units &u) {
  friction_set out;
  std::copy_n(v, set_sizes[law], out.values);
  if (law >= 2 && law <= 4)
    for (const int at : {2, 4, 5, 6}) out.values[at] *= u.length;
  if (law == 5) out.values[2] /= u.length;
  if (law == 6)
    for (const int at : {4, 5}) out.values[at] *= u.length;
  return out;
}

}  // namespace

void cntc_setfrictionmethod(int *ire, int *icp, int *method, int *count, double *params) {
  const char *call = "cntc_setfrictionmethod";
  CONTACT_ADDON_NEEDS(call, ire, icp, method, count)
  with_problem(call, *ire, *icp, modules::both, patches::settings, true, [&](problem &p) {
    const int law = *method % 10, variation = *method / 10;
    if (*method < 0 || law > 6 || variation > (p.wheel_rail() ? 2 : 0)) {
      say(call, "method " + std::to_string(*method) + " is unknown: nothing is changed");
      return 0;
    }
    if (law == 1) return 0;
    if (!params || *count < 1 || !finite(call, params, *count)) {
      counted(call, *count, set_sizes[law]);
      return 0;
    }
    const units u = p.unit();
    friction_data d;
    d.law = law;
    d.variation = variation;
    const int size = set_sizes[law];
    if (variation == 0) {
      if (!counted(call, *count, size)) return 0;
      d.sets = {set_of(law, params, u)};
    } else {
      const double said = params[0];
      const int sets = said >= 1 && said <= static_cast<int>(RP_MAX_POINTS)
                           ? static_cast<int>(std::lround(said))
                           : 0;
      if (sets == 0) {
        say(call, "NVF is " + shown(said) + ", allowed 1 ... 32: nothing is changed");
        return 0;
      }
      if (!counted(call, *count, 1 + sets * (1 + size))) return 0;
      d.sets.clear();
      for (int i = 0; i < sets; ++i) {
        const double *v = params + 1 + i * (1 + size);
        friction_set one = set_of(law, v + 1, u);
        one.place = variation == 1 ? v[0] : v[0] * u.length;
        if (i > 0 && !(one.place > d.sets.back().place)) {
          say(call, "places must increase: nothing is changed");
          return 0;
        }
        d.sets.push_back(one);
      }
    }
    p.friction = d;
    p.changed = true;
    return 0;
  });
}

void cntc_setverticalforce(int *ire, double *fz) {
  const char *call = "cntc_setverticalforce";
  CONTACT_ADDON_NEEDS(call, ire, fz)
  set_wheel(call, ire, [&](problem &p) {
    if (!finite(call, fz, 1)) return;
    p.wheel.vertical_force = *fz;
    std::string said;
    if (p.flags.set(flag_normal, 1, said)) p.changed = true;
  });
}

void cntc_setpenetration(int *ire, int *icp, double *pen) {
  const char *call = "cntc_setpenetration";
  CONTACT_ADDON_NEEDS(call, ire, icp, pen)
  set_basic(call, ire, icp, [&](problem &p) {
    if (!finite(call, pen, 1)) return;
    // an ellipse's grid goes with its load
    const double pen_in_metres = *pen * p.unit().length;
    if (p.grid.ipotcn < 0 && p.basic.penetration != pen_in_metres) p.changed = true;
    p.basic.penetration = pen_in_metres;
    std::string said;
    if (p.flags.set(flag_normal, 0, said)) p.changed = true;
  });
}

void cntc_setnormalforce(int *ire, int *icp, double *fn) {
  const char *call = "cntc_setnormalforce";
  CONTACT_ADDON_NEEDS(call, ire, icp, fn)
  set_basic(call, ire, icp, [&](problem &p) {
    if (!finite(call, fn, 1)) return;
    if (p.grid.ipotcn < 0 && p.basic.normal_force != *fn) p.changed = true;
    p.basic.normal_force = *fn;
    std::string said;
    if (p.flags.set(flag_normal, 1, said)) p.changed = true;
  });
}

// Body 1 minus body 2 in all units.
void cntc_setcreepages(int *ire, int *icp, double *vx, double *vy, double *phi) {
  const char *call = "cntc_setcreepages";
  CONTACT_ADDON_NEEDS(call, ire, icp, vx, vy, phi)
  set_basic(call, ire, icp, [&](problem &p) {
    const double all[3] = {*vx, *vy, *phi};
    if (!finite(call, all, 3)) return;
    const bool shift = p.flags.get(flag_tangential) == 1;
    const double L = p.unit().length;
    p.basic.creepage[0] = shift ? *vx * L : *vx;
    p.basic.creepage[1] = shift ? *vy * L : *vy;
    p.basic.creepage[2] = shift ? *phi : *phi / L;
  });
}

// Body 1 minus body 2 in all units, as creepages; lengths with T = 1.
void cntc_setextrarigidslip(int *ire, int *icp, int *count, double *wx, double *wy) {
  const char *call = "cntc_setextrarigidslip";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, wx, wy)
  set_basic(call, ire, icp, [&](problem &p) {
    const bool large = p.grid.mx > 1000 || p.grid.my > 1000;
    if (!counted(call, *count, large ? 0 : p.grid.mx * p.grid.my)) return;
    if (!finite(call, wx, *count) || !finite(call, wy, *count)) return;
    const double size = p.flags.get(flag_tangential) == 1 ? p.unit().length : 1.0;
    const double *given[2] = {wx, wy};
    for (int c = 0; c < 2; ++c) {
      p.extra_slip[c].assign(given[c], given[c] + *count);
      for (double &w : p.extra_slip[c]) w *= size;
    }
    std::string said;
    p.flags.set(flag_extra_slip, 1, said);
    p.changed = true;
  });
}

void cntc_settangentialforces(int *ire, int *icp, double *fx, double *fy) {
  const char *call = "cntc_settangentialforces";
  CONTACT_ADDON_NEEDS(call, ire, icp, fx, fy)
  with_problem(call, *ire, *icp, modules::both, patches::settings, true, [&](problem &p) {
    const double all[2] = {*fx, *fy};
    if (!finite(call, all, 2)) return 0;
    if (p.wheel_rail()) {
      p.wheel.longitudinal_force = *fx;
      return 0;
    }
    const double size = std::sqrt(*fx * *fx + *fy * *fy);
    const double cut = size > 1 ? 1 / size : 1.0;
    p.basic.force[0] = *fx * cut;
    p.basic.force[1] = *fy * cut;
    return 0;
  });
}

void cntc_settrackdimensions(int *ire, int *ztrack, int *count, double *params) {
  const char *call = "cntc_settrackdimensions";
  CONTACT_ADDON_NEEDS(call, ire, ztrack, count)
  set_wheel(call, ire, [&](problem &p) {
    const int z = *ztrack, n = *count;
    if (z == 0) return;
    if (!params || n < 1 || !finite(call, params, n)) {
      counted(call, n, 1);
      return;
    }
    const double L = p.unit().length;
    wheel_data d = p.wheel;
    const bool design = z == 1 || z == 3, moved = z == 2 || z == 3, support = z == 32 || z == 33;
    const int wanted = z == 1 ? 5 : z == 2 ? 6 : z == 3 ? 11 : 4;
    if (!design && !moved && !support) {
      say(call, "Z = " + std::to_string(z) + " is not 0 ... 3, 32 or 33: nothing is changed");
      return;
    }
    if (n != wanted && !((design || support) && n == wanted + 1)) {
      counted(call, n, wanted);
      return;
    }
    int at = 0;
    if (design) {
      d.gauge_height = params[0] * L;
      if (d.gauge_height > 0) {
        d.gauge = params[2] * L;
      } else {
        d.rail_place[0] = params[1] * L;
        d.rail_place[1] = params[2] * L;
      }
      d.cant = params[3];
      d.roller_radius = params[4] * L;
      d.curvature = n > wanted ? params[5] / L : 0.0;
      at = n > wanted ? 6 : 5;
    }
    const double unit[6] = {L, L, 1, L, L, 1};
    if (moved)
      for (int i = 0; i < 6; ++i) d.rail[i] = params[at + i] * unit[i];
    if (support) {
      for (int i = 0; i < 4; ++i) d.support[i] = i % 2 == 0 ? params[i] / L : params[i];
      const bool stepped = n == 5 && params[4] != 0;
      p.refuse("DYSTEP0", stepped ? "DYSTEP0 of massless rails has no counterpart" : "");
    }
    if (design || support) p.changed = true;
    p.wheel = d;
  });
}

void cntc_setwheelsetdimensions(int *ire, int *ewheel, int *count, double *params) {
  const char *call = "cntc_setwheelsetdimensions";
  CONTACT_ADDON_NEEDS(call, ire, ewheel, count)
  set_wheel(call, ire, [&](problem &p) {
    const int e = *ewheel;
    if ((e == 0 || e == 1 || e == 2 || e == 4) && *count <= 0) return;
    if (e != 3 && e != 5) {
      say(call, "E = " + std::to_string(e) + " takes no dimensions: nothing is changed");
      return;
    }
    if (*count != 4 && !counted(call, *count, 3)) return;
    if (!params || !finite(call, params, *count)) return;
    const double L = p.unit().length;
    put(p, p.wheel.flange_back_distance, params[0] * L);
    put(p, p.wheel.flange_back_position, params[1] * L);
    put(p, p.wheel.nominal_radius, params[2] * L);
    const bool taped = *count == 4 && params[3] * L < 1.0;
    p.refuse("YTAPE",
             taped ? "YTAPE has no counterpart: the radius is that at the profile's z = 0" : "");
  });
}

namespace {

void set_six(const char *call, int *ire, int *ewheel, int least, int *count, double *params,
             double (wheel_data::*target)[6], bool velocity) {
  set_wheel(call, ire, [&](problem &p) {
    if (*ewheel < least || *ewheel > 5) {
      if (*ewheel != 0 || *count > 0)
        say(call, "E = " + std::to_string(*ewheel) + " is not in " + std::to_string(least) +
                      " ... 5: nothing is changed");
      return;
    }
    if (!counted(call, *count, 6) || !params || !finite(call, params, 6)) return;
    const double L = p.unit().length;
    // of a roller the first velocity is its rate of turning
    const double unit[6] = {velocity && p.roller() ? 1.0 : L, L, L, 1, 1, 1};
    for (int i = 0; i < 6; ++i) (p.wheel.*target)[i] = params[i] * unit[i];
  });
}

}  // namespace

void cntc_setwheelsetposition(int *ire, int *ewheel, int *count, double *params) {
  const char *call = "cntc_setwheelsetposition";
  CONTACT_ADDON_NEEDS(call, ire, ewheel, count)
  set_six(call, ire, ewheel, 1, count, params, &wheel_data::position, false);
}

void cntc_setwheelsetvelocity(int *ire, int *ewheel, int *count, double *params) {
  const char *call = "cntc_setwheelsetvelocity";
  CONTACT_ADDON_NEEDS(call, ire, ewheel, count)
  set_six(call, ire, ewheel, 2, count, params, &wheel_data::velocity, true);
}

void cntc_setwheelsetflexibility(int *ire, int *ewheel, int *count, double *params) {
  const char *call = "cntc_setwheelsetflexibility";
  CONTACT_ADDON_NEEDS(call, ire, ewheel, count)
  set_wheel(call, ire, [&](problem &p) {
    if (*ewheel < 0 || *ewheel > 5) {
      say(call, "E = " + std::to_string(*ewheel) + " is not in 0 ... 5: nothing is changed");
      return;
    }
    if (*ewheel < 4) {
      std::fill_n(p.wheel.flexibility, 12, 0.0);
      return;
    }
    if (!counted(call, *count, 12) || !params || !finite(call, params, 12)) return;
    const double L = p.unit().length;
    for (int i = 0; i < 12; ++i) p.wheel.flexibility[i] = params[i] * (i % 6 < 3 ? L : 1.0);
  });
}
