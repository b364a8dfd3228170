// The FMU's functions give the bits of the C interface, over scenes of all kinds.
#include "made_fmu.hpp"

namespace {

using made::scene;

// What the FMU is set to, for rp_step.
void put(rp_input &in, fmi2ValueReference reference, double value) {
  double *const reals[] = {&in.y, &in.z};
  switch (reference) {
    case made::lateral:
    case made::height:
      *reals[reference - 1] = value;
      break;
    case made::yaw:
      in.yaw = value;
      break;
    case 6:
      in.speed = value;
      break;
    case 7:
      in.vy = value;
      break;
    case 11:
      in.pitch_rate = value;
      break;
    case 12:
      in.roller_pitch_rate = value;
      break;
    case made::normal_force:
      in.normal_force = value;
      break;
    case made::creepage:
    case made::creepage + 1:
      in.creepage[reference - made::creepage] = value;
      break;
    case made::spin:
      in.spin_creepage = value;
      break;
    case made::speed:
      in.rolling_speed = value;
      break;
    case made::wheel_bulk:
    case made::rail_bulk:
      in.bulk_temperature[reference - made::wheel_bulk] = value;
      break;
    default:
      break;
  }
}

double number_of(const rp_patch_result &p, fmi2ValueReference k) {
  const double numbers[] = {p.normal_force,   p.approach,     p.creep_force[0], p.creep_force[1],
                            p.spin_moment,    p.max_pressure, p.contact_area,   p.friction_power,
                            p.elastic_energy, p.residual};
  if (k == 18) return p.max_temperature;
  return k == 19 ? p.share : numbers[k - 2];
}

// The number of the result behind a value reference; NaN for what is a sum of the FMU's own.
double number_of(const rp_result &r, fmi2ValueReference reference) {
  const fmi2ValueReference side = reference / 1000, patch = reference % 1000 / 100;
  const fmi2ValueReference k = reference % 100;
  if (patch > 0) return number_of(r.side[side - 1].patch[patch - 1], k);
  if (k == 42) return r.z;
  if (k >= 55) return NAN;
  const double *force = side > 0 ? r.side[side - 1].force : r.force;
  const double *moment = side > 0 ? r.side[side - 1].moment : r.moment;
  if (k == 49) return r.side[side - 1].rolling_radius;
  return k < 46 ? force[k - 43] : moment[k - 46];
}

void expect_same(made::slave &slave, const scene &s, const rp_result &result, int step) {
  int compared = 0;
  for (const made::variable &v : s.variables) {
    if (v.reference < 41 && v.reference != made::friction) continue;
    if (v.reference == made::friction) continue;
    const fmi2ValueReference side = v.reference / 1000, patch = v.reference % 1000 / 100;
    const double wanted = number_of(result, v.reference);
    const bool absent = patch > 0 && static_cast<int>(patch) > result.side[side - 1].patch_count;
    if (absent || std::isnan(wanted)) continue;
    EXPECT_EQ(slave.get(v.reference), wanted) << s.name << ", step " << step << ", " << v.name;
    ++compared;
  }
  EXPECT_GT(compared, 7) << s.name;
}

TEST(Fmu, GivesTheBitsOfTheCoreInEveryScene) {
  const scenes::profile_pair pair;
  for (const scene &s : made::scenes_of(pair)) {
    SCOPED_TRACE(s.name);
    made::slave slave(made::write(s));
    slave.initialize();
    scenes::handle contact(s.config);
    rp_input in;
    rp_default_input(&in);
    for (const made::variable &v : s.variables) put(in, v.reference, v.start);
    in.distance = s.distance > 0 ? s.distance : 1e-3;
    in.time_step = s.time_step;
    expect_same(slave, s, contact.step(in), 0);
    const double length = 1e-3;
    for (int k = 1; k <= 5; ++k) {
      const bool wheels = s.config.kind != RP_PATCH;
      const fmi2ValueReference moved = wheels ? made::lateral : made::creepage;
      const double value = wheels ? 4e-4 * k : 1e-3 + 2e-4 * k;
      EXPECT_EQ(slave.set(moved, value), fmi2OK);
      put(in, moved, value);
      if (k == 3 && !wheels) {
        EXPECT_EQ(slave.set(made::normal_force, 6e4), fmi2OK);
        put(in, made::normal_force, 6e4);
      }
      ASSERT_EQ(slave.step(length), fmi2OK) << slave.message;
      in.distance = in.rolling_speed * length;
      in.time_step = length;
      expect_same(slave, s, contact.step(in), k);
    }
  }
}

}  // namespace
