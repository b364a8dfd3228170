// Slopes of the rail's surface against a contact frame, and their rates.
#include "geometry/surface_slopes.hpp"

#include "geometry/geometry.hpp"
#include "geometry/rates.hpp"

namespace railpatch {

namespace {

surface_grid at_centre(surface_grid g) {
  g.nx = 1;
  g.x0 = 0;
  return g;
}

}  // namespace

// Where the line along n at a place of the frame meets the rail, at an arc length and a height.
void side_geometry::put_slope(const vec3 &origin, const frame_axes<double> &f,
                              const std::array<double, 2> &place, double p, double n,
                              std::ptrdiff_t to, surface_slopes &out) const {
  const bool roller = track_.kind == track_kind::roller;
  const bool shaped = shape_ && shape_->has_height() && !roller;
  const curve_point m = rail_.evaluate(p);
  const vec3 at = origin + place[0] * f.x + place[1] * f.s + n * f.n;
  const double r = axle_z_ - m.z;
  const vec3 normal = roller
                          ? vec3{(at[0] - axle_x_) / r * m.dy, m.dz, (at[2] - axle_z_) / r * m.dy}
                          : vec3{shaped ? shape_->height_slope(at[0]) * m.dy : 0.0, -m.dz, m.dy};
  const double along_n = dot(normal, f.n);
  out.height[to] = n;
  out.across[to] = -dot(normal, f.s) / along_n;
  out.along[to] = -dot(normal, f.x) / along_n;
}

void side_geometry::rail_slopes(const contact_frame &frame, const surface_grid &whole,
                                bool along_rows, surface_slopes &out) const {
  const surface_grid g = along_rows && !level() ? whole : at_centre(whole);
  const frame_axes<double> f = axes_of(frame);
  out.clear(g.nx, g.ny);
  each_element elements([&](int column, int row, double p, double n) {
    put_slope(frame.origin, f, {g.x0 + column * g.dx, g.y0 + row * g.dy}, p, n,
              out.place(row) + column, out);
  });
  meet_surface(body::rail, frame, g, elements);
}

// As on the side, the arc length where the rail is met being unknown.
void moving_geometry::rail_slope_rates(const rated_frame &frame, const surface_grid &whole,
                                       const lattice_rates *lattice, int count, bool along_rows,
                                       surface_slopes *out) const {
  const bool roller = track_.kind == track_kind::roller, along = roller && along_rows;
  const surface_grid g = along ? whole : at_centre(whole);
  const frame_axes<rated> f = axes_of(frame);
  for (int k = 0; k < count; ++k) {
    out[k].clear(g.nx, g.ny);
  }
  const auto on_lattice = [&](int axis, double first, int index, double size) {
    rated v(first + index * size);
    for (int k = 0; k < count; ++k)
      v.rate[static_cast<size_t>(k)] = lattice[k].origin[axis] + index * lattice[k].size[axis];
    return v;
  };
  each_element elements([&](int column, int row, double p, double) {
    const rated s = on_lattice(1, g.y0, row, g.dy);
    rated ahead(0.0);
    if (roller) ahead = frame.origin[0] - axle_x_;
    if (along) ahead += on_lattice(0, g.x0, column, g.dx);
    // from the frame's origin to the surface, in the plane across x
    const auto reach = [&](const point &m) {
      const rated r = axle_z_ - m.z;
      const rated z = roller ? axle_z_ - sqrt(r * r - ahead * ahead) : m.z;
      return vec<rated>{rated(0.0), m.y - frame.origin[1], z - frame.origin[2]};
    };
    point m = evaluate(rail_, unknown(p, arc_slot));
    m = evaluate(rail_, solved(p, dot(f.s, reach(m)) - s, arc_slot));
    const vec<rated> to = reach(m);
    vec<rated> normal{rated(0.0), -m.dz, m.dy};
    if (roller) {
      const rated r = axle_z_ - m.z;
      normal = {ahead / r * m.dy, m.dz, (to[2] + frame.origin[2] - axle_z_) / r * m.dy};
    }
    const rated along_n = dot(normal, f.n), height = dot(to, f.n);
    const rated across = -dot(normal, f.s) / along_n, ahead_slope = -normal[0] / along_n;
    for (int k = 0; k < count; ++k) {
      const auto from = static_cast<size_t>(k);
      const auto at = out[k].place(row) + column;
      out[k].height[at] = height.rate[from];
      out[k].across[at] = across.rate[from];
      out[k].along[at] = ahead_slope.rate[from];
    }
  });
  const contact_frame fixed{{frame.origin[0].value, frame.origin[1].value, frame.origin[2].value},
                            frame.contact_angle.value};
  side_.meet_surface(body::rail, fixed, g, elements);
}

}  // namespace railpatch
