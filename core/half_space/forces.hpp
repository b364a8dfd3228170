// Resultants of pressure and traction, in the contact frame and at the wheelset centre.
//
// Contact frame seen from the track frame with contact angle d: e_x = (1, 0, 0),
// e_s = (0, cos d, sin d), n = (0, -sin d, cos d); the pressure pushes the wheel along -n.
#pragma once

#include <cmath>

#include "geometry/surface_slopes.hpp"
#include "half_space/influence.hpp"
#include "numeric/dual.hpp"
#include "numeric/elementary.hpp"

namespace railpatch {

template <class T>
struct basic_wrench {
  T force[3];   // N on the wheel: longitudinal, lateral, along n
  T moment[3];  // N m on the wheel about the contact reference, contact frame
};
using patch_wrench = basic_wrench<double>;

// px, py may be null where the scene has no tangential stage.
patch_wrench sum_tractions(const grid &g, const double *pressure, const double *px,
                           const double *py);

// N, of the pressure in a row of elements; of an ellipse's, with its semi-axis across.
double load_of_row(const grid &g, const double *pressure, int row);
double load_of_row(double half_width, double force, const grid &g, int row);

// Adds what pressure has beside its force along n, as it acts along the normals of an inclined
// surface.
void add_inclined(const grid &g, const double *pressure, const surface_slopes &slopes,
                  patch_wrench &wrench);
// The same of a force (N) with its moment along x (N m), where the surface has the same slopes.
void add_inclined(double force, double moment, double s, double height, double across, double along,
                  patch_wrench &wrench);
// The same of an elliptic pressure that is not on the grid, by rows with the slopes of their
// middle. half_width: m, of the ellipse.
void add_inclined_ellipse(double half_width, double force, const grid &g,
                          const surface_slopes &slopes, patch_wrench &wrench);
// Its rates, with those of half width, force, rows (origin + index size, m) and slopes (null:
// zero).
void add_inclined_ellipse_rates(const directed &half_width, const directed &force, const grid &g,
                                const surface_slopes &slopes, const surface_slopes *rates,
                                double origin, double size, patch_wrench &wrench);
// Adds the rates where the elements of a pressure move by origin + index size (m), and the slopes
// by their rates (null: by none).
void add_inclined_rates(const grid &g, const double *pressure, const surface_slopes &slopes,
                        const surface_slopes *rates, const double origin[2], const double size[2],
                        patch_wrench &wrench);

// N m, what the elastic energy grows by as the half-space turns about x and s against the bodies.
// Pressure has its moment about the rail's surface; about the wheel's it differs by as much.
struct turning_energy {
  double about_x = 0, about_s = 0;
};
turning_energy energy_of_turning(const grid &g, const double *pressure,
                                 const double *undeformed_distance, const surface_slopes &slopes);
// Adds the moments that a wheel has about its own surface beside those about the rail's. About s,
// where the half-space does not turn along with a roller, wheel and roller have one moment of both:
// part: that of the wheel's own.
inline void add_turning(const turning_energy &turning, double part, patch_wrench &wrench) {
  wrench.moment[0] += turning.about_x;
  wrench.moment[1] += part * turning.about_s;
}
// Its rate; those of distance and slopes may be null: zero. size: m, of the elements.
turning_energy energy_of_turning_rate(const grid &g, const double *pressure,
                                      const double *pressure_rate,
                                      const double *undeformed_distance,
                                      const double *distance_rate, const surface_slopes &slopes,
                                      const surface_slopes *slope_rates, const double size[2]);

// Moves forces in the plane from the contact reference to a depth (m) along n.
void add_depth(double depth, double longitudinal, double lateral, patch_wrench &wrench);

// Adds the wrench at a contact reference `lever` away from the wheelset centre (track axes), in a
// frame turned by the contact angle about x and then inclined about y.
template <class T>
void add_wrench(const basic_wrench<T> &wrench, const T &contact_angle, const T lever[3], T force[3],
                T moment[3], double inclination = 0) {
  const T c = cos(contact_angle), s = sin(contact_angle);
  const auto rotate = [&](const T v[3], T out[3]) {
    out[0] = v[0];
    out[1] = c * v[1] - s * v[2];
    out[2] = s * v[1] + c * v[2];
    if (inclination == 0) return;
    const double d = cos(inclination), t = sin(inclination);
    const T along = out[0], down = out[2];
    out[0] = d * along - t * down;
    out[2] = t * along + d * down;
  };
  T f[3], m[3];
  rotate(wrench.force, f);
  rotate(wrench.moment, m);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, n = (k + 2) % 3;
    force[k] += f[k];
    moment[k] += m[k] + lever[l] * f[n] - lever[n] * f[l];
  }
}

}  // namespace railpatch
