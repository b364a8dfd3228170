#include <algorithm>
#include <cmath>

#include "angles.hpp"
#include "calls.hpp"
#include "frames.hpp"
#include "solve.hpp"

using namespace contact_addon;

namespace {

void copy(const double *from, int most, const int *count, double *to) {
  std::copy_n(from, std::clamp(*count, 0, most), to);
}

// Pressure's centre in the track: x, y.
void pressure_centre(const problem &p, int icp, const rp_patch_result &r, double out[2]) {
  const std::vector<double> pn = field_of(p, icp, RP_FIELD_PRESSURE);
  const grid_data g = grid_of(p, r);
  double sum = 0, x = 0, y = 0;
  for (size_t k = 0; k < pn.size() && g.mx > 0; ++k) {
    const auto at = static_cast<int>(k);
    sum += pn[k];
    x += pn[k] * (g.x0 + at % g.mx * g.dx);
    y += pn[k] * (g.y0 + at / g.mx * g.dy);
  }
  if (sum > 0) x /= sum, y /= sum;
  out[0] = r.position[0] + x;
  out[1] = r.position[1] + y * contact_addon::cos(r.contact_angle);
}

// Arc length along a profile, counted as in task 4 of the profile's values; of the left side away
// from it.
double arc_at(const profile_curve &curve, bool left, const vector3 &own) {
  const double side = left ? -1.0 : 1.0;
  return side * curve.nearest(side * own[1], own[2]);
}

// A point in a body's axes: x, y, z, s, angle.
void put_place(double *out, const marker &m, const vector3 &at, const profile_curve &curve,
               bool left, double angle, double L) {
  const vector3 own = m.point_inside(at);
  for (size_t k = 0; k < 3; ++k) out[k] = own[k] / L;
  out[3] = arc_at(curve, left, own) / L;
  out[4] = angle;
}

void location(const problem &p, int icp, const rp_patch_result &r, double out[38]) {
  const frames f = frames_of(p);
  const double L = p.unit().length;
  const vector3 at{r.position[0], r.position[1], r.position[2]};
  for (size_t k = 0; k < 3; ++k) out[k] = at[k] / L;
  out[3] = r.contact_angle;
  put_place(out + 4, f.rail, at, profile_now(p, true), p.left(), r.contact_angle - f.rail_roll, L);
  put_place(out + 9, f.wheel, at, profile_now(p, false), p.left(), r.contact_angle - f.wheel_roll,
            L);
  pressure_centre(p, icp, r, out + 14);
  out[14] /= L;
  out[15] /= L;
  for (int k = 0; k < 2; ++k) {
    const double moved = p.at_side().rail_deflection[k], stiff = p.wheel.support[2 * k];
    const bool set = p.flags.get(flag_force) == 3 && stiff > 0;
    out[17 + k] =
        ((std::isfinite(moved) ? moved : 0.0) + (set ? p.wheel.support[2 * k + 1] / stiff : 0.0)) /
        L;
  }
  for (size_t k = 0; k < 3; ++k) out[20 + k] = f.wheel.place[k] / L;
  out[23] = f.wheel_roll;
  out[24] = f.wheel_yaw;
  out[25] = f.rail.place[1] / L;
  out[26] = f.rail.place[2] / L;
  out[27] = f.rail_roll;
  const vector3 of_wheelset = f.wheelset.point_inside(at);
  for (size_t k = 0; k < 3; ++k) out[29 + k] = of_wheelset[k] / L;
  out[32] = r.contact_angle - p.wheel.position[3];
  const vector3 wheel_in = f.wheelset.point_inside(f.wheel.place);
  for (size_t k = 0; k < 3; ++k) out[33 + k] = wheel_in[k] / L;
  out[36] = p.wheel.flexibility[3];
  out[37] = p.wheel.flexibility[4];
}

// Of the force and moment on the output body: in track, wheelset, rail and wheel axes, each with
// the moment about its marker.
void hand_out_wrench(const problem &p, const wrench &on_wheel, double out[24]) {
  const frames f = frames_of(p);
  const units u = p.unit();
  const vector3 force{u.sign * on_wheel.force[0], u.sign * on_wheel.force[1],
                      u.sign * on_wheel.force[2]};
  const auto about = [&](const marker &m) {
    const vector3 lever = cross(minus(m.place, f.wheelset.place), on_wheel.force);
    const vector3 moved = minus(on_wheel.moment, lever);
    return vector3{u.sign * moved[0] / u.length, u.sign * moved[1] / u.length,
                   u.sign * moved[2] / u.length};
  };
  const vector3 at_rail = about(f.rail), at_wheel = about(f.wheel);
  const vector3 parts[8] = {force,
                            at_rail,
                            f.wheelset.inside(force),
                            f.wheelset.inside(at_wheel),
                            f.rail.inside(force),
                            f.rail.inside(at_rail),
                            f.wheel.inside(force),
                            f.wheel.inside(at_wheel)};
  for (size_t i = 0; i < 8; ++i) std::copy_n(parts[i].data(), 3, out + 3 * i);
}

}  // namespace

void cntc_getwheelsetposition(int *ire, int *count, double *values) {
  const char *call = "cntc_getwheelsetposition";
  CONTACT_ADDON_NEEDS(call, ire, count, values)
  with_problem(call, *ire, -1, modules::wheels, patches::element, false, [&](problem &p) {
    const double L = p.unit().length, *w = p.wheel.position;
    const double z = p.solved ? p.result.z : w[2];
    const double all[6] = {w[0] / L, w[1] / L, z / L, w[3], w[4], w[5]};
    copy(all, 6, count, values);
    return 0;
  });
}

void cntc_getwheelsetvelocity(int *ire, int *count, double *values) {
  const char *call = "cntc_getwheelsetvelocity";
  CONTACT_ADDON_NEEDS(call, ire, count, values)
  with_problem(call, *ire, -1, modules::wheels, patches::element, false, [&](problem &p) {
    const double L = p.unit().length, *w = p.wheel.velocity;
    const int force = p.flags.get(flag_force);
    const bool found = p.solved && (force == 1 || force == 2);
    const double turns = found ? p.result.pitch_rate : w[5];
    const double all[6] = {w[0] / (p.roller() ? 1.0 : L), w[1] / L, w[2] / L, w[3], w[4], turns};
    copy(all, 6, count, values);
    return 0;
  });
}

void cntc_getnumcontactpatches(int *ire, int *count) {
  const char *call = "cntc_getnumcontactpatches";
  CONTACT_ADDON_NEEDS(call, ire, count)
  with_problem(call, *ire, -1, modules::wheels, patches::element, false, [&](problem &p) {
    *count = p.patches();
    return 0;
  });
}

void cntc_getcontactlocation(int *ire, int *icp, int *count, double *values) {
  const char *call = "cntc_getcontactlocation";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, values)
  with_problem(call, *ire, *icp, modules::wheels, patches::patch, false, [&](problem &p) {
    double all[38] = {};
    if (const rp_patch_result *r = patch_of(p, *icp))
      location(p, *icp, *r, all);
    else
      say(call, "contact patch " + std::to_string(*icp) + " has no results: zeros");
    copy(all, 38, count, values);
    return 0;
  });
}

void cntc_getglobalforces(int *ire, int *icp, int *count, double *values) {
  const char *call = "cntc_getglobalforces";
  CONTACT_ADDON_NEEDS(call, ire, icp, count, values)
  with_problem(call, *ire, *icp, modules::wheels, patches::either, false, [&](problem &p) {
    double all[24] = {};
    const rp_patch_result *r = *icp > 0 ? patch_of(p, *icp) : nullptr;
    if (!p.solved || (*icp > 0 && r == nullptr)) {
      say(call, "there is no solved contact: zeros");
    } else if (p.touching) {
      wrench w;
      if (r) {
        w = wrench_of(p, *r);
      } else {
        std::copy_n(p.at_side().force, 3, w.force.data());
        std::copy_n(p.at_side().moment, 3, w.moment.data());
      }
      hand_out_wrench(p, w, all);
    }
    copy(all, 24, count, values);
    return 0;
  });
}
