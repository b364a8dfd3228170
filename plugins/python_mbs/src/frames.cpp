// Placements and velocities of rigid bodies; see force_element.hpp.

#include <cmath>

#include "force_element.hpp"
#include "numeric/elementary.hpp"

namespace railpatch::python {

namespace {

struct Vector {
  double x, y, z;
};

Vector at(const double *v) { return {v[0], v[1], v[2]}; }
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// from the placed frame's axes to those it is placed in
Vector out_of(const Placement &p, Vector a) {
  const double *r = p.rotation;
  return {r[0] * a.x + r[1] * a.y + r[2] * a.z, r[3] * a.x + r[4] * a.y + r[5] * a.z,
          r[6] * a.x + r[7] * a.y + r[8] * a.z};
}

Vector into(const Placement &p, Vector a) {
  const double *r = p.rotation;
  return {r[0] * a.x + r[3] * a.y + r[6] * a.z, r[1] * a.x + r[4] * a.y + r[7] * a.z,
          r[2] * a.x + r[5] * a.y + r[8] * a.z};
}

// an axis of the wheelset (0, 1, 2) in track axes
Vector axis(int k, const Placement &joint, const Placement &wheelset, const Placement &track) {
  const double *r = wheelset.rotation;
  return into(track, out_of(joint, {r[k], r[3 + k], r[6 + k]}));
}

}  // namespace

TrackState track_state(const Placement &joint, const double velocity[6], const Placement &wheelset,
                       const Placement &track, double frame_speed, double nominal_radius) {
  const Vector offset = at(wheelset.origin), spin = at(velocity + 3);
  const Vector centre = out_of(joint, offset) + at(joint.origin) - at(track.origin);
  const Vector p = into(track, centre);
  const Vector v = into(track, out_of(joint, at(velocity) + cross(spin, offset)));
  const Vector w = into(track, out_of(joint, spin));
  const Vector a = axis(1, joint, wheelset, track), e = axis(0, joint, wheelset, track);

  TrackState s;
  s.x = p.x;
  s.y = p.y;
  s.z = p.z + nominal_radius;
  const double level = hypot(a.y, a.z);  // cos yaw, the yaw angle being below a quarter turn
  s.roll = atan2(a.z, a.y);
  s.yaw = atan2(-a.x, level);
  const double c = a.y / level, r = a.z / level;
  // x axis after Rx(roll) Rz(yaw) is (cos yaw, sin yaw g), z axis h; e turned by pitch from there
  const double along = e.x * level - a.x * (c * e.y + r * e.z);
  s.pitch = atan2(r * e.y - c * e.z, along);
  s.speed = v.x + frame_speed;
  s.vy = v.y;
  s.vz = v.z;
  s.pitch_rate = (c * w.y + r * w.z) / level;
  s.yaw_rate = c * w.z - r * w.y;
  s.roll_rate = w.x - s.pitch_rate * a.x;
  return s;
}

void joint_wrench(const double force[3], const double moment[3], const Placement &joint,
                  const Placement &wheelset, const Placement &track, double wrench[6]) {
  const Vector f = into(joint, out_of(track, at(force)));
  const Vector m = into(joint, out_of(track, at(moment))) + cross(at(wheelset.origin), f);
  const double values[6] = {f.x, f.y, f.z, m.x, m.y, m.z};
  for (int i = 0; i < 6; ++i) wrench[i] = values[i];
}

double lateral_creep(const rp_side_result &side) {
  double sum = 0;
  for (int i = 0; i < side.patch_count + side.alternative_count; ++i) {
    const rp_patch_result &patch = side.patch[i];
    const double force = patch.creep_force[1];
    // none without a tangential problem
    if (!std::isnan(force)) sum += patch.share * force * cos(patch.contact_angle);
  }
  return sum;
}

double lateral_creep_of_rows(Steppable &contact, int side, const rp_side_result &result,
                             std::vector<double> room[2]) {
  double sum = 0;
  for (int i = 0; i < result.patch_count + result.alternative_count; ++i) {
    const size_t rows = contact.read_field(side, i, RP_FIELD_ROW_ANGLE, room[0]);
    const size_t tractions = contact.read_field(side, i, RP_FIELD_TRACTION, room[1]);
    if (rows == 0 || tractions == 0) continue;
    // the lateral ones come second
    const size_t elements = tractions / 2, along = elements / rows;
    const rp_patch_result &patch = result.patch[i];
    double force = 0;
    for (size_t j = 0; j < rows; ++j) {
      double row = 0;
      for (size_t k = 0; k < along; ++k) row += room[1][elements + j * along + k];
      force += cos(room[0][j]) * row;
    }
    sum += patch.share * patch.element_size[0] * patch.element_size[1] * force;
  }
  return sum;
}

}  // namespace railpatch::python
