// What a patch gives the wheel: its wrench, and what the energy of its pressures changes by as the
// frame turns and the profiles go over into others.
#include "wheel/wheel_contact.hpp"

#include "geometry/place_slope.hpp"
#include "half_space/forces.hpp"

namespace railpatch {

namespace {

void scale(patch_wrench &wrench, double share) {
  for (int k = 0; k < 3; ++k) {
    wrench.force[k] *= share;
    wrench.moment[k] *= share;
  }
}

}  // namespace

void wheel_contact::add_force(const patch_region &region, double depth, patch_wrench wrench,
                              double normal_force, rp_side_result &out) const {
  scale(wrench, region.share);
  out.rolling_radius +=
      region.share * normal_force * geometry_->rolling_radius(region.frame, depth);
  const vec3 lever = geometry_->lever(region.frame);
  add_wrench(wrench, region.frame.contact_angle, lever.data(), out.force, out.moment,
             region.frame.inclination);
}

// The energy changes with the frame's angle too, as that follows the wheel's place: force and
// moment take that.
void wheel_contact::add_turning_force(const patch_region &region, double turning,
                                      rp_side_result &out) const {
  const vec3 centre = region.frame.origin - geometry_->lever(region.frame);
  add_yielding(scaled(region.share * turning, region.angle_slope), centre, out.force, out.moment);
}

// What the pressures' energy changes by as the rail's profile goes over into that farther on is the
// wheel's force along the track, and as the wheel's goes over into that of another pitch its moment
// about the axle. The force acts on the axle in the plane of the wheel's profile, whose place along
// the track is that of the rail's.
void wheel_contact::add_section_force(const patch_scene &scene, const patch_region &region,
                                      const patch_problem &problem, const patch_memory &memory,
                                      rp_side_result &out) const {
  const grid &g = problem.g;
  struct energy_of_rows final : section_visitor {
    const patch_scene &scene;
    const patch_problem &problem;
    const patch_memory &memory;
    int first = 0;
    double sum = 0;
    energy_of_rows(const patch_scene &s, const patch_problem &p, const patch_memory &m)
        : scene(s), problem(p), memory(m) {}
    void meet(int row, double rate) override {
      const hertz_contact &ellipse = problem.hertz;
      const double load =
          scene.closed_form()
              ? load_of_row(ellipse.semi_axes[1], ellipse.normal_force, problem.g, first + row)
              : load_of_row(problem.g, memory.pressure.data(), first + row);
      if (load > 0) sum += load * rate;
    }
  };
  // by the place of the rail, deeper where it rises, and by the wheel's pitch
  double energy[2] = {0, 0};
  const surface_grid on{g.nx, g.ny, g.x0, g.y0, g.dx, g.dy};
  for (int k = 0; k < 2; ++k) {
    const body which = k == 0 ? body::rail : body::wheel;
    if (!geometry_->varies(which)) continue;
    energy_of_rows rows(scene, problem, memory);
    if (!memory.curved) geometry_->section_heights(which, region.frame, on, rows);
    for (; memory.curved && rows.first < g.ny; ++rows.first)
      if (memory.curved->valid(rows.first))
        geometry_->section_heights(which, memory.curved->frame(rows.first),
                                   {g.nx, 1, g.x0, 0.0, g.dx, g.dy}, rows);
    energy[k] = k == 0 ? -rows.sum : rows.sum;
    if (scene.turns()) energy[k] += memory.turning.about_x * region.angle_rate[k];
  }
  const double along = -region.share * energy[0], pitching = -region.share * energy[1];
  const vec3 &axle = geometry_->wheel_offset(), about = geometry_->pitch_direction();
  out.force[0] += along;
  out.moment[1] += axle[2] * along;
  out.moment[2] -= axle[1] * along;
  for (size_t k = 0; k < 3; ++k) out.moment[k] += pitching * about[k];
}

}  // namespace railpatch
