#include <algorithm>
#include <cmath>
#include <numbers>

#include "calls.hpp"

using namespace contact_addon;

namespace {

// of lists that are given: a grid of 1000 by 1000 elements
constexpr int most_points = 1000000;

// Of settings: module 1 with icp = -1, module 3 with a patch.
template <class Task>
void set(const char *call, int *ire, int *icp, modules which, Task task) {
  with_problem(call, *ire, *icp, which, patches::settings, true, [&](problem &p) {
    task(p);
    return 0;
  });
}

// Flags whose values change nothing but what is written.
bool about_output(int code) {
  return code == flag_xflow || code == flag_output || code == flag_flow || code == flag_matfile ||
         code == flag_block_output || code == flag_block_file || code == flag_write_input ||
         code == flag_timers || code == flag_debug || code == flag_licence;
}

bool moves_only(int code) {
  return about_output(code) || code == flag_units || code == flag_sequence || code == flag_start ||
         code == flag_return;
}

void set_flag(const char *call, problem &p, int code, int value) {
  if (code == 0) return;
  if (code == flag_material || code == flag_friction || code == flag_heat) {
    say(call,
        "flag " + std::to_string(code) + " is read only: M, L and H are set by their own calls");
    return;
  }
  if (code == flag_threads || code == flag_case) return;
  std::string said;
  if (p.flags.set(code, value, said) && !moves_only(code)) p.changed = true;
  if (!said.empty()) say(call, said);
  if (code == flag_units && value == 1937) say(call, "imperial units are taken as 1934: mm, N");
  if ((code == flag_matfile || code == flag_block_file) && value > 0)
    say(call, "flag " + std::to_string(code) + ": no mat-files are written here");
  if (code == flag_write_input && value > 0)
    say(call, "flag 2002: no input files are written here");
}

}  // namespace

void cntc_setflags(int *ire, int *icp, int *count, int *codes, int *values) {
  const char *call = "cntc_setflags";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, codes, values)
  set(call, ire, icp, modules::both, [&](problem &p) {
    for (int i = 0; i < *count; ++i) set_flag(call, p, codes[i], values[i]);
  });
}

void cntc_setmetadata(int *ire, int *icp, int *count, int *codes, double *values) {
  const char *call = "cntc_setmetadata";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, codes, values)
  set(call, ire, icp, modules::both, [&](problem &) {
    for (int i = 0; i < *count; ++i) {
      const int code = codes[i];
      if (code != 0 && !(code >= 2011 && code <= 2016) && !(code >= 2021 && code <= 2023))
        say(call, "code " + std::to_string(code) + " is unknown and ignored");
    }
  });
}

void cntc_setsolverflags(int *ire, int *icp, int *gdigit, int *nints, int *ints, int *nreals,
                         double *reals) {
  const char *call = "cntc_setsolverflags";
  CONTACT_ADDON_NEEDS(call, ire, icp, gdigit, nints, nreals)
  set(call, ire, icp, modules::both, [&](problem &p) {
    struct row {
      int ints, reals;
    };
    constexpr row rows[7] = {{4, 1}, {0, 0}, {5, 4}, {5, 4}, {5, 3}, {5, 8}, {1, 1}};
    const int g = *gdigit;
    if (g < 0 || g > 6) {
      say(call, "method " + std::to_string(g) + " is not in 0 ... 6: nothing is changed");
      return;
    }
    if (!counted(call, *nints, rows[g].ints) || !counted(call, *nreals, rows[g].reals)) return;
    if (g == 1 || g == 6) return;  // what was said stays; sensitivities are exact
    if (any_null(ints, reals) || !finite(call, reals, *nreals)) return;
    if (!(reals[0] > 0) || ints[0] < 1) {
      say(call, "EPS and MAXGS must be > 0: nothing is changed");
      return;
    }
    p.solver.method = g;
    put(p, p.solver.tolerance, std::clamp(reals[0], 1e-12, 0.1));
    put(p, p.solver.max_iterations, std::clamp(ints[0], 1, 100000));
  });
}

void cntc_setmaterialparameters(int *ire, int *icp, int *mdigit, int *count, double *params) {
  const char *call = "cntc_setmaterialparameters";
  CONTACT_ADDON_NEEDS(call, ire, icp, mdigit, count)
  set(call, ire, icp, modules::both, [&](problem &p) {
    const units u = p.unit();
    const int m = *mdigit;
    material_data d = p.material;
    if (m == 10 || m == 12) {
      if (m == 10 && *count <= 1) {
        p.material.damping = false;
      } else if (m == 12 && counted(call, *count, 4) && params && finite(call, params, 4)) {
        p.material.damping = true;
        std::copy_n(params, 4, p.material.damping_values);
      } else if (m == 10) {
        say(call, "method 10 takes one value at most: nothing is changed");
      }
      p.refuse("M2", p.material.damping ? "M2 = 2, contact damping, has no counterpart" : "");
      return;
    }
    if (m == 11) return;
    constexpr int counts[8] = {4, 8, 8, 7, 8, 7, 4, 4};
    if (m < 0 || m > 7) {
      say(call,
          "method " + std::to_string(m) + " is not in 0 ... 7, 10 ... 12: nothing is changed");
      return;
    }
    if (!counted(call, *count, counts[m]) || !params || !finite(call, params, *count)) return;
    d.method = m;
    for (int k = 0; k < 2; ++k) {
      d.poisson[k] = params[k];
      d.shear[k] = params[2 + k] * u.pressure();
    }
    for (int k = 0; m == 1 && k < 2; ++k) {
      d.flexibility[k] = params[4 + k];
      d.relaxation[k] = params[6 + k];
    }
    if (m == 3 || m == 5 || m == 2) {
      const int at = m == 2 ? 5 : 4;
      d.k0 = params[at], d.alpha = params[at + 1], d.beta = params[at + 2];
    }
    if (m == 4) {
      d.layer_shear = params[4] * u.pressure();
      d.layer_thickness = params[5] * u.length;
      const double yield = params[6] * u.pressure();
      d.yield_stress = params[6] >= 1e10 ? 0.0 : yield;
      d.hardening = params[7] / u.volume();
    }
    p.refuse("M", m == 2 ? "M = 2, one flexibility for all directions, has no counterpart" : "");
    p.material = d;
    p.changed = true;
  });
}

void cntc_settemperaturedata(int *ire, int *icp, int *hdigit, int *count, double *params) {
  const char *call = "cntc_settemperaturedata";
  CONTACT_ADDON_NEEDS(call, ire, icp, hdigit, count)
  with_problem(call, *ire, *icp, modules::both, patches::either, true, [&](problem &p) {
    if (*hdigit == 1 && *count <= 1) return 0;
    if (*hdigit == 0 && *count <= 1) {
      put(p, p.heat.on, false);
      return 0;
    }
    if (*hdigit != 3) {
      say(call, "method " + std::to_string(*hdigit) + " is not 0, 1 or 3: nothing is changed");
      return 0;
    }
    if (!counted(call, *count, 9) || !params || !finite(call, params, 9)) return 0;
    const units u = p.unit();
    p.heat.on = true;
    for (int k = 0; k < 2; ++k) {
      p.heat.bulk[k] = params[4 * k];
      p.heat.capacity[k] = params[4 * k + 1];
      p.heat.conductivity[k] = params[4 * k + 2] * u.per_length();
      p.heat.density[k] = params[4 * k + 3] / u.volume();
    }
    p.heat.plastic_fraction = params[8];
    p.changed = true;
    return 0;
  });
}

// A step's time follows from its length and the speed, here as there.
void cntc_settimestep(int *ire, int *icp, double *dt) {
  const char *call = "cntc_settimestep";
  CONTACT_ADDON_NEEDS(call, ire, icp, dt)
  set(call, ire, icp, modules::both, [](problem &) {});
}

void cntc_setreferencevelocity(int *ire, int *icp, double *veloc) {
  const char *call = "cntc_setreferencevelocity";
  CONTACT_ADDON_NEEDS(call, ire, icp, veloc)
  set(call, ire, icp, modules::basic, [&](problem &p) {
    if (!finite(call, veloc, 1)) return;
    p.basic.velocity = std::max(std::fabs(*veloc) * p.unit().length, 1e-12);
  });
}

void cntc_setrollingstepsize(int *ire, int *icp, double *chi, double *dq) {
  const char *call = "cntc_setrollingstepsize";
  CONTACT_ADDON_NEEDS(call, ire, icp, chi, dq)
  set(call, ire, icp, modules::both, [&](problem &p) {
    if (!finite(call, chi, 1) || !finite(call, dq, 1)) return;
    if (p.wheel_rail()) {
      p.wheel.step_ratio = *dq;
      return;
    }
    const double turned = std::remainder(*chi, 2 * std::numbers::pi);
    const bool along =
        std::fabs(turned) < 1e-9 || std::fabs(std::fabs(turned) - std::numbers::pi) < 1e-9;
    p.refuse("CHI",
             along ? "" : "CHI = " + shown(*chi) + " rad: rolling is along +x (0) or -x (pi)");
    p.basic.chi = turned;
    p.basic.step = *dq * p.unit().length;
  });
}

void cntc_sethertzcontact(int *ire, int *icp, int *ipotcn, int *count, double *params) {
  const char *call = "cntc_sethertzcontact";
  CONTACT_ADDON_NEEDS(call, ire, icp, ipotcn, count, params)
  set(call, ire, icp, modules::basic, [&](problem &p) {
    const int kind = *ipotcn;
    if (kind < -6 || kind > -1) {
      say(call, "IPOTCN " + std::to_string(kind) + " is not in -6 ... -1: nothing is changed");
      return;
    }
    if (!counted(call, *count, kind == -6 ? 6 : 5) || !finite(call, params, *count)) return;
    grid_data g;
    g.ipotcn = kind;
    g.mx = count_of(params[0]);
    g.my = count_of(params[1]);
    const units u = p.unit();
    const double L = u.length, k = u.per_length();
    const double unit[6][3] = {{k, k, 1}, {k, 1, 1}, {L, L, 1}, {k, L, 1}, {L, L, 1}, {L, L, L}};
    for (int i = 0; i < 3; ++i) g.hertz[i] = params[2 + i] * unit[-kind - 1][i];
    if (kind == -6) g.hertz[3] = params[5];
    p.refuse("IPOTCN",
             kind == -6 ? "IPOTCN = -6, an ellipse of two halves (SDEC), has no counterpart" : "");
    p.grid = g;
    p.changed = true;
    std::string said;
    if (kind == -4 || kind == -5) p.flags.set(flag_bound, 2, said);
    if (kind == -4) p.flags.set(flag_normal, 1, said);
  });
}

namespace {

void set_basic_grid(const char *call, problem &p, int kind, int count, const double *params) {
  if (kind < 1 || kind > 4) {
    say(call, "IPOTCN " + std::to_string(kind) + " is not in 1 ... 4: nothing is changed");
    return;
  }
  if (!counted(call, count, 6) || !finite(call, params, 6)) return;
  grid_data g;
  g.ipotcn = kind;
  g.mx = count_of(params[0]);
  g.my = count_of(params[1]);
  const double L = p.unit().length;
  const double low[2] = {params[2] * L, params[3] * L}, other[2] = {params[4] * L, params[5] * L};
  const double counts[2] = {static_cast<double>(g.mx), static_cast<double>(g.my)};
  double size[2], first[2];
  for (int k = 0; k < 2; ++k) {
    size[k] = kind == 1 || kind == 3 ? other[k]
              : kind == 2            ? (other[k] - low[k]) / counts[k]
              : counts[k] > 1        ? (other[k] - low[k]) / (counts[k] - 1)
                                     : 0.0;
    first[k] = kind <= 2 ? low[k] + 0.5 * size[k] : low[k];
  }
  g.x0 = first[0], g.y0 = first[1], g.dx = size[0], g.dy = size[1];
  p.refuse("IPOTCN", "");
  p.grid = g;
  p.changed = true;
}

void set_wheel_grid(const char *call, problem &p, int kind, int count, const double *params) {
  if (kind != 0 && kind != -1) {
    say(call, "IPOTCN " + std::to_string(kind) + " is neither 0 nor -1: nothing is changed");
    return;
  }
  const int least = kind == 0 ? 2 : 5, most = kind == 0 ? 3 : 7;
  if (count < least || count > most) {
    counted(call, count, least);
    return;
  }
  if (!finite(call, params, count)) return;
  const double L = p.unit().length;
  wheel_data d = p.wheel;
  d.dx = params[0] * L;
  d.ds = params[1] * L;
  if (kind == -1) {
    d.separation_angle = params[2];
    d.combination[0] = params[3] * L;
    d.combination[1] = params[4] * L;
    d.combination[2] = count > 5 ? params[5] * L : 2 * d.combination[0] - d.combination[1];
    d.misses = count > 6 && params[6] >= 0;
  }
  p.wheel = d;
  p.changed = true;
}

}  // namespace

void cntc_setpotcontact(int *ire, int *icp, int *ipotcn, int *count, double *params) {
  const char *call = "cntc_setpotcontact";
  CONTACT_ADDON_NEEDS(call, ire, icp, ipotcn, count, params)
  set(call, ire, icp, modules::both, [&](problem &p) {
    if (p.wheel_rail())
      set_wheel_grid(call, p, *ipotcn, *count, params);
    else
      set_basic_grid(call, p, *ipotcn, *count, params);
  });
}

void cntc_setundeformeddistc(int *ire, int *icp, int *ibase, int *count, double *params) {
  const char *call = "cntc_setundeformeddistc";
  CONTACT_ADDON_NEEDS(call, ire, icp, ibase, count, params)
  set(call, ire, icp, modules::basic, [&](problem &p) {
    const double L = p.unit().length, k = p.unit().per_length();
    const int n = std::clamp(*count, 0, most_points), kind = *ibase;
    std::vector<double> v(params, params + n);
    int wanted = n;
    if (kind == 1) wanted = 6;
    if (kind == 2) wanted = n >= 1 ? 5 + count_of(v[0]) : 6;
    if (kind == 3) wanted = 8;
    if (kind == 9) wanted = p.grid.mx > 1000 || p.grid.my > 1000 ? 0 : p.grid.mx * p.grid.my;
    if (kind != 1 && kind != 2 && kind != 3 && kind != 9) {
      say(call, "IBASE " + std::to_string(kind) + " is not 1, 2, 3 or 9: nothing is changed");
      return;
    }
    if (!counted(call, n, wanted) || !finite(call, params, n)) return;
    const double quadratic[6] = {k, k, k, 1, 1, L}, wavy[8] = {L, k, L, L, k, L, L, L};
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<size_t>(i);
      v[at] *= kind == 1 ? quadratic[i] : kind == 3 ? wavy[i] : kind == 2 && i == 0 ? 1.0 : L;
    }
    p.distance = {kind, v};
    p.changed = true;
  });
}
