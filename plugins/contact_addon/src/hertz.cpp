// Ellipses of IPOTCN < 0: their axes and curvatures by a contact of the core.
#include <cmath>
#include <vector>

#include "mapping.hpp"
#include "registry.hpp"

namespace contact_addon {

namespace {

// Hertz's contact of one load, on four elements either way.
ellipse hertz(rp_config c, bool by_force, double load) {
  c.kind = RP_PATCH;
  c.normal = RP_NORMAL_HERTZ;
  c.tangential = RP_TANGENTIAL_FASTSIM;
  c.load = by_force ? RP_FORCE : RP_POSITION;
  c.elements[0] = 4;
  c.elements[1] = c.geometry == RP_LINE_CONTACT ? 1 : 4;
  c.element_size[0] = c.element_size[1] = 0;
  rp_message message{};
  rp_contact *made = nullptr;
  if (rp_create(&c, &made, &message) != RP_OK) throw refusal{error_other, message.text};
  const std::unique_ptr<rp_contact, handle_deleter> contact(made);
  rp_input in;
  rp_default_input(&in);
  (by_force ? in.normal_force : in.approach) = load;
  rp_result result;
  if (rp_step(contact.get(), &in, &result, &message) != RP_OK)
    throw refusal{error_other, message.text};
  const rp_patch_result &r = result.side[RP_RIGHT].patch[0];
  if (result.status != RP_CONVERGED)
    throw refusal{error_other, "the ellipse needs a load: the bodies are apart"};
  ellipse e;
  e.a = 0.5 * r.grid[0] * r.element_size[0];
  e.b = 0.5 * r.grid[1] * r.element_size[1];
  const auto nx = static_cast<size_t>(r.grid[0]), ny = static_cast<size_t>(r.grid[1]);
  std::vector<double> h(nx * ny), x(nx), y(ny);
  size_t n = h.size();
  if (rp_get_field(contact.get(), RP_RIGHT, 0, RP_FIELD_UNDEFORMED_DISTANCE, h.data(), &n) != RP_OK)
    throw refusal{error_other, "the ellipse has no undeformed distance"};
  n = nx;
  rp_get_field(contact.get(), RP_RIGHT, 0, RP_FIELD_X, x.data(), &n);
  n = ny;
  rp_get_field(contact.get(), RP_RIGHT, 0, RP_FIELD_Y, y.data(), &n);
  const size_t mid = nx / 2, across = ny / 2;
  e.A1 = (h[across * nx] - h[across * nx + mid]) / (x[0] * x[0] - x[mid] * x[mid]);
  e.B1 = ny > 1 ? (h[mid] - h[across * nx + mid]) / (y[0] * y[0] - y[across] * y[across]) : 0.0;
  // elements across the contact, and a border
  const double counted[2] = {4, c.geometry == RP_LINE_CONTACT ? 1.0 : 4.0};
  e.a = 0.5 * counted[0] * r.element_size[0];
  e.b = 0.5 * counted[1] * r.element_size[1];
  return e;
}

}  // namespace

ellipse ellipse_of(const problem &p) {
  const grid_data &g = p.grid;
  rp_config c;
  rp_default_config(&c);
  for (int k = 0; k < 2; ++k) {
    c.shear_modulus[k] = p.material.shear[1 - k];
    c.poisson_ratio[k] = p.material.poisson[1 - k];
  }
  const bool by_force = p.flags.get(flag_normal) == 1;
  const double load = by_force ? p.basic.normal_force : p.basic.penetration;
  const double one = g.hertz[0], other = g.hertz[1];
  if (!(one > 0) || !(other > 0)) throw refusal{error_other, "an ellipse needs values > 0"};
  if (!(load > 0)) throw refusal{error_other, "the ellipse needs a load: FN or PEN > 0"};
  switch (g.ipotcn) {
    case -1:
      c.geometry = RP_CURVATURES;
      c.curvatures[0] = one;
      c.curvatures[1] = other;
      return hertz(c, by_force, load);
    case -2: {
      // the ratio of curvatures from any ellipse of that shape
      c.geometry = RP_SEMI_AXES;
      c.semi_axes[0] = 1e-3 * other;
      c.semi_axes[1] = 1e-3;
      const ellipse shape = hertz(c, true, 1.0);
      c.geometry = RP_CURVATURES;
      c.curvatures[0] = one;
      c.curvatures[1] = one * shape.B1 / shape.A1;
      return hertz(c, by_force, load);
    }
    case -3: {
      c.geometry = RP_SEMI_AXES;
      c.semi_axes[0] = one;
      c.semi_axes[1] = other;
      ellipse e = hertz(c, by_force, load);
      e.a = one;
      e.b = other;
      return e;
    }
    default: {
      if (!by_force) throw refusal{error_other, "a line contact needs the normal force, N = 1"};
      c.geometry = RP_LINE_CONTACT;
      c.width = 2 * other;
      c.line_contact_radius = g.ipotcn == -4 ? 0.5 / one : 1.0;
      ellipse e = hertz(c, true, load);
      if (g.ipotcn == -5) {  // half the length goes with the root of the radius
        e.A1 = 0.5 * (e.a / one) * (e.a / one);
        e.a = one;
      } else {
        e.A1 = one;
      }
      e.b = other;
      return e;
    }
  }
}

}  // namespace contact_addon
