#include <cmath>

#include "calls.hpp"
#include "mapping.hpp"
#include "solve.hpp"

namespace contact_addon {

namespace {

// Of one input: rates of Fn, Fx, Fy, Mz (SI, on the wheel), and of the approach.
bool rates(problem &p, int input, double out[4], double &approach) {
  rp_input direction;
  rp_default_direction(&direction);
  const bool by_force = p.mapped.config.load == RP_FORCE;
  if (input == 0) (by_force ? direction.normal_force : direction.approach) = 1;
  if (input == 1) direction.creepage[0] = 1;
  if (input == 2) direction.creepage[1] = 1;
  if (input == 3) {  // about the caller's origin
    direction.spin_creepage = 1;
    direction.creepage[0] = -p.mapped.offset[1];
    direction.creepage[1] = p.mapped.offset[0];
  }
  rp_result change;
  rp_message message{};
  if (rp_differentiate(p.contact.get(), &direction, &change, nullptr, &message) != RP_OK) {
    say("cntc_getsensitivities", message.text);
    return false;
  }
  const rp_patch_result &r = change.side[RP_RIGHT].patch[0];
  out[0] = r.normal_force;
  out[1] = r.creep_force[0];
  out[2] = r.creep_force[1];
  out[3] = spin_moment_of(p, r);
  approach = r.approach;
  return true;
}

}  // namespace

void sensitivities(const char *call, problem &p, const rp_patch_result &r, int nout, int nin,
                   double *values) {
  const units u = p.unit();
  const double bound = static_friction(p) * r.normal_force, fn = r.normal_force;
  for (int k = 0; k < 2; ++k)
    if (p.mapped.config.force_prescribed[k]) {
      say(call, "where forces are prescribed there are no sensitivities by creepages");
      return;
    }
  for (int j = 0; j < nin && j < 4; ++j) {
    double d[4], approach;
    if (!rates(p, j, d, approach)) return;
    // by the penetration, also where the force is given; creepages at that penetration or force
    double scale = j == 0 ? u.length : j == 3 ? u.per_length() : 1.0;
    if (j == 0 && p.mapped.config.load == RP_FORCE) scale /= approach;
    if (j > 0) scale *= u.sign;  // as those that are handed out
    const double rows[4] = {d[0], u.sign * (d[1] * fn - r.creep_force[0] * d[0]) / (bound * fn),
                            u.sign * (d[2] * fn - r.creep_force[1] * d[0]) / (bound * fn),
                            u.sign * d[3] / u.length};
    for (int i = 0; i < nout && i < 4; ++i) values[j * nout + i] = rows[i] * scale;
  }
}

}  // namespace contact_addon
