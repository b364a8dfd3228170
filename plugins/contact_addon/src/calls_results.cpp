#include <algorithm>
#include <cmath>

#include "calls.hpp"
#include "solve.hpp"

using namespace contact_addon;

namespace {

// Asks for results of one contact patch; without one nothing is written.
template <class Task>
void get(const char *call, int *ire, int *icp, modules which, Task task) {
  with_problem(call, *ire, *icp, which, patches::patch, false, [&](problem &p) {
    const rp_patch_result *r = patch_of(p, *icp);
    if (r == nullptr && p.solved && !p.touching && !p.wheel_rail())
      r = &p.result.side[RP_RIGHT].patch[0];
    if (r == nullptr) {
      say(call, "contact patch " + std::to_string(*icp) + " of result element " +
                    std::to_string(*ire) + " has no results");
      return 0;
    }
    task(p, *r);
    return 0;
  });
}

double or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

bool is_shift(const problem &p) { return p.input.step_regime == RP_SHIFT; }

// Copies a part of a field to a caller's array, which may be shorter or longer.
void hand_out(const std::vector<double> &field, size_t part, size_t count, double unit, int n,
              double *out) {
  for (int i = 0; i < n; ++i) {
    const size_t at = part * count + static_cast<size_t>(i);
    out[i] = static_cast<size_t>(i) < count && at < field.size() ? or_zero(field[at]) * unit : 0.0;
  }
}

size_t count_of(const problem &p, const rp_patch_result &r) {
  const grid_data g = grid_of(p, r);
  return static_cast<size_t>(std::max(g.mx, 0)) * static_cast<size_t>(std::max(g.my, 0));
}

// Micro-slip and rigid slip are over V; in a shift over the step, which is 1 there.
double slip_unit(const problem &p) { return is_shift(p) ? 1 / p.unit().length : 1.0; }

// -> which field of the core, part, unit, whether the sign of the output body counts
struct field_row {
  int code;
  rp_field field;
  int parts, part;
  double (*unit)(const problem &);
  bool has_sign;
};

double of_length(const problem &p) { return 1 / p.unit().length; }
double of_pressure(const problem &p) { return 1 / p.unit().pressure(); }
double of_none(const problem &) { return 1.0; }

const field_row field_rows[] = {
    {1, RP_FIELD_UNDEFORMED_DISTANCE, 1, 0, of_length, false},
    {2, RP_FIELD_FRICTION, 1, 0, of_none, false},
    {3, RP_FIELD_TRACTION, 2, 0, of_pressure, true},
    {4, RP_FIELD_TRACTION, 2, 1, of_pressure, true},
    {5, RP_FIELD_PRESSURE, 1, 0, of_pressure, false},
    {11, RP_FIELD_YIELD_STRESS, 1, 0, of_pressure, false},
    {12, RP_FIELD_PLASTIC_DISPLACEMENT, 2, 0, of_length, false},
    {13, RP_FIELD_PLASTIC_DISPLACEMENT, 2, 1, of_length, false},
    {15, RP_FIELD_MICRO_SLIP, 2, 0, slip_unit, true},
    {16, RP_FIELD_MICRO_SLIP, 2, 1, slip_unit, true},
    {20, RP_FIELD_TEMPERATURE, 2, 1, of_none, false},
    {21, RP_FIELD_TEMPERATURE, 2, 0, of_none, false},
};

// Displacements along x, y, n of the surfaces, body 1 minus body 2: 7 ... 9.
void hand_out_displacements(const char *call, const problem &p, const rp_patch_result &r, int icp,
                            int first, int n, double *out) {
  const std::vector<double> u = displacements_of(p, icp);
  if (u.empty()) say(call, "this contact has no displacements");
  hand_out(u, static_cast<size_t>(first), count_of(p, r), of_length(p), n, out);
}

// Rigid slip of each element: 22, 23, minus that of body 1 over body 2 by the sign of the output.
void hand_out_rigid_slip(const problem &p, const rp_patch_result &r, int part, int n, double *out) {
  const grid_data g = grid_of(p, r);
  const double unit = -p.unit().sign * slip_unit(p);
  for (int k = 0; k < n; ++k) {
    out[k] = 0;
    if (static_cast<size_t>(k) >= count_of(p, r)) continue;
    const double x = g.x0 + k % g.mx * g.dx - p.mapped.offset[0];
    const double y = g.y0 + k / g.mx * g.dy - p.mapped.offset[1];
    double w =
        part == 0 ? r.creepage[0] - r.spin_creepage * y : r.creepage[1] + r.spin_creepage * x;
    const std::vector<double> &own = p.mapped.slip;
    if (!own.empty()) w += own[static_cast<size_t>(part) * count_of(p, r) + static_cast<size_t>(k)];
    out[k] = or_zero(w) * unit;
  }
}

void hand_out_field(const char *call, const problem &p, const rp_patch_result &r, int icp, int code,
                    int n, double *out) {
  if (code >= 7 && code <= 9) return hand_out_displacements(call, p, r, icp, code - 7, n, out);
  if (code == 22 || code == 23) return hand_out_rigid_slip(p, r, code - 22, n, out);
  for (const field_row &row : field_rows) {
    if (row.code != code) continue;
    const std::vector<double> field = field_of(p, icp, row.field, row.parts);
    if (field.empty() && p.touching)
      say(call, "field " + std::to_string(code) + " is not part of this case");
    const double unit = row.unit(p) * (row.has_sign ? p.unit().sign : 1.0);
    return hand_out(field, static_cast<size_t>(row.part), count_of(p, r), unit, n, out);
  }
  say(call, "field " + std::to_string(code) + " is unknown: zeros");
  std::fill_n(out, n, 0.0);
}

}  // namespace

void cntc_getfielddata(int *ire, int *icp, int *field, int *count, double *values) {
  const char *call = "cntc_getfielddata";
  CONTACT_ADDON_NEEDS(call, ire, icp, field, count, values)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    hand_out_field(call, p, r, *icp, *field, std::max(*count, 0), values);
  });
}

void cntc_gettractions(int *ire, int *icp, int *count, double *pn, double *px, double *py) {
  const char *call = "cntc_gettractions";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, pn, px, py)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const int n = std::max(*count, 0);
    const double unit = of_pressure(p);
    hand_out(field_of(p, *icp, RP_FIELD_PRESSURE), 0, count_of(p, r), unit, n, pn);
    const std::vector<double> t = field_of(p, *icp, RP_FIELD_TRACTION, 2);
    hand_out(t, 0, count_of(p, r), unit * p.unit().sign, n, px);
    hand_out(t, 1, count_of(p, r), unit * p.unit().sign, n, py);
  });
}

void cntc_getmicroslip(int *ire, int *icp, int *count, double *sx, double *sy) {
  const char *call = "cntc_getmicroslip";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, sx, sy)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const std::vector<double> s = field_of(p, *icp, RP_FIELD_MICRO_SLIP, 2);
    const double unit = slip_unit(p) * p.unit().sign;
    hand_out(s, 0, count_of(p, r), unit, std::max(*count, 0), sx);
    hand_out(s, 1, count_of(p, r), unit, std::max(*count, 0), sy);
  });
}

void cntc_getdisplacements(int *ire, int *icp, int *count, double *un, double *ux, double *uy) {
  const char *call = "cntc_getdisplacements";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, un, ux, uy)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const std::vector<double> u = displacements_of(p, *icp);
    if (u.empty()) say(call, "this contact has no displacements");
    double *const out[3] = {ux, uy, un};
    for (size_t k = 0; k < 3; ++k)
      hand_out(u, k, count_of(p, r), of_length(p), std::max(*count, 0), out[k]);
  });
}

void cntc_getelementdivision(int *ire, int *icp, int *count, int *values) {
  const char *call = "cntc_getelementdivision";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, values)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &) {
    std::vector<double> d = field_of(p, *icp, RP_FIELD_ELEMENT_DIVISION);
    if (d.empty())  // without a tangential problem: what bears pressure
      for (const double pn : field_of(p, *icp, RP_FIELD_PRESSURE))
        d.push_back(pn > 0 ? RP_STICK : RP_EXTERIOR);
    for (int i = 0; i < *count; ++i)
      values[i] =
          static_cast<size_t>(i) < d.size() ? static_cast<int>(d[static_cast<size_t>(i)]) : 0;
  });
}

void cntc_getreferencevelocity(int *ire, int *icp, double *veloc) {
  const char *call = "cntc_getreferencevelocity";
  CONTACT_ADDON_NEEDS(call, ire, icp, veloc)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    *veloc = (p.wheel_rail() ? or_zero(r.rolling_speed) : p.basic.velocity) / p.unit().length;
  });
}

void cntc_gethertzcontact(int *ire, int *icp, int *count, double *values) {
  const char *call = "cntc_gethertzcontact";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, values)
  get(call, ire, icp, modules::basic, [&](problem &p, const rp_patch_result &) {
    double all[10] = {};
    const grid_data &g = p.mapped.grid;
    if (g.ipotcn >= 0) {
      say(call, "the contact was not given by an ellipse: zeros");
    } else {
      const double L = p.unit().length, scale = g.hertz[2], A1 = p.mapped.hertz[0],
                   B1 = p.mapped.hertz[1];
      const double a = 0.5 * g.dx * g.mx / scale, b = 0.5 * g.dy * g.my / scale;
      const double found[10] = {
          A1 * L, B1 * L, a / L, b / L, 2 / (A1 + B1) / L, std::sqrt(a * b) / L,
          scale,  b / L,  b / L, a / b};
      std::copy_n(found, 10, all);
    }
    std::copy_n(all, std::clamp(*count, 0, 10), values);
  });
}

void cntc_getnumelements(int *ire, int *icp, int *mx, int *my) {
  const char *call = "cntc_getnumelements";
  CONTACT_ADDON_NEEDS(call, ire, icp, mx, my)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const grid_data g = grid_of(p, r);
    *mx = g.mx;
    *my = g.my;
  });
}

void cntc_getgriddiscretization(int *ire, int *icp, double *dx, double *dy) {
  const char *call = "cntc_getgriddiscretization";
  CONTACT_ADDON_NEEDS(call, ire, icp, dx, dy)
  with_problem(call, *ire, *icp, modules::both, patches::either, false, [&](problem &p) {
    const double L = p.unit().length;
    if (p.wheel_rail() && *icp <= 0) {
      *dx = p.wheel.dx / L;
      *dy = p.wheel.ds / L;
      return 0;
    }
    const rp_patch_result *r = patch_of(p, *icp);
    if (r == nullptr) {
      say(call, "there is no solved contact");
      return 0;
    }
    const grid_data g = grid_of(p, *r);
    *dx = g.dx / L;
    *dy = g.dy / L;
    return 0;
  });
}

void cntc_getpotcontact(int *ire, int *icp, int *count, double *values) {
  const char *call = "cntc_getpotcontact";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, values)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const grid_data g = grid_of(p, r);
    const double k = 1 / p.unit().length;
    const double all[6] = {double(g.mx), double(g.my), g.x0 * k, g.y0 * k, g.dx * k, g.dy * k};
    std::copy_n(all, std::clamp(*count, 0, 6), values);
  });
}

void cntc_getpenetration(int *ire, int *icp, double *pen) {
  const char *call = "cntc_getpenetration";
  CONTACT_ADDON_NEEDS(call, ire, icp, pen)
  get(call, ire, icp, modules::both,
      [&](problem &p, const rp_patch_result &r) { *pen = or_zero(r.approach) / p.unit().length; });
}

void cntc_getcreepages(int *ire, int *icp, double *vx, double *vy, double *phi) {
  const char *call = "cntc_getcreepages";
  CONTACT_ADDON_NEEDS(call, ire, icp, vx, vy, phi)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const units u = p.unit();
    const double spin = or_zero(r.spin_creepage);
    const double own[2] = {or_zero(r.creepage[0]) + spin * p.mapped.offset[1],
                           or_zero(r.creepage[1]) - spin * p.mapped.offset[0]};
    *vx = u.sign * own[0] * slip_unit(p);
    *vy = u.sign * own[1] * slip_unit(p);
    *phi = u.sign * spin * (is_shift(p) ? 1.0 : u.length);
  });
}

void cntc_getcontactforces(int *ire, int *icp, double *fn, double *tx, double *ty, double *mz) {
  const char *call = "cntc_getcontactforces";
  CONTACT_ADDON_NEEDS(call, ire, icp, fn, tx, ty, mz)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const units u = p.unit();
    *fn = or_zero(r.normal_force);
    *tx = u.sign * or_zero(r.creep_force[0]);
    *ty = u.sign * or_zero(r.creep_force[1]);
    *mz = u.sign * or_zero(spin_moment_of(p, r)) / u.length;
  });
}

void cntc_getcontactpatchareas(int *ire, int *icp, double *contact, double *adhesion,
                               double *slip) {
  const char *call = "cntc_getcontactpatchareas";
  CONTACT_ADDON_NEEDS(call, ire, icp, contact, adhesion, slip)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const double element = r.element_size[0] * r.element_size[1] / p.unit().area();
    const bool divided = r.elements[RP_STICK] + r.elements[RP_SLIP] + r.elements[RP_PLASTIC] > 0;
    *contact = or_zero(r.contact_area) / p.unit().area();
    *adhesion = divided ? r.elements[RP_STICK] * element : *contact;
    *slip = r.elements[RP_SLIP] * element;
  });
}

void cntc_getmaximumpressure(int *ire, int *icp, double *value) {
  const char *call = "cntc_getmaximumpressure";
  CONTACT_ADDON_NEEDS(call, ire, icp, value)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    *value = or_zero(r.max_pressure) / p.unit().pressure();
  });
}

void cntc_getmaximumtraction(int *ire, int *icp, double *value) {
  const char *call = "cntc_getmaximumtraction";
  CONTACT_ADDON_NEEDS(call, ire, icp, value)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const std::vector<double> t = field_of(p, *icp, RP_FIELD_TRACTION, 2);
    const size_t n = std::min(count_of(p, r), t.size() / 2);
    double most = 0;
    for (size_t i = 0; i < n; ++i) most = std::max(most, t[i] * t[i] + t[n + i] * t[n + i]);
    *value = std::sqrt(most) / p.unit().pressure();
  });
}

void cntc_getmaximumtemperature(int *ire, int *icp, double *body1, double *body2) {
  const char *call = "cntc_getmaximumtemperature";
  CONTACT_ADDON_NEEDS(call, ire, icp, body1, body2)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    const std::vector<double> t = field_of(p, *icp, RP_FIELD_TEMPERATURE, 2);
    const size_t n = std::min(count_of(p, r), t.size() / 2);
    double most[2] = {0, 0};
    for (size_t k = 0; k < 2 && n > 0; ++k) {
      most[k] = t[k * n];
      for (size_t i = 0; i < n; ++i) most[k] = std::max(most[k], t[k * n + i]);
    }
    *body1 = most[1];
    *body2 = most[0];
  });
}

// Columns: penetration, creepages; rows: Fn, Fx, Fy, Mz, of which Fx and Fy over FSTAT Fn.
void cntc_getsensitivities(int *ire, int *icp, int *nout, int *nin, double *values) {
  const char *call = "cntc_getsensitivities";
  CONTACT_ADDON_NEEDS(call, ire, icp, nout, nin, values)
  get(call, ire, icp, modules::both, [&](problem &p, const rp_patch_result &r) {
    std::fill_n(values, std::max(*nout, 0) * std::max(*nin, 0), 0.0);
    if (p.wheel_rail() || p.mapped.config.derivatives == 0) {
      say(call, p.wheel_rail() ? "wheels on rails have no sensitivities of a patch by its creepages"
                               : "sensitivities need flag 1988 = 2 or 3 before the case is solved");
      return;
    }
    sensitivities(call, p, r, *nout, *nin, values);
  });
}
