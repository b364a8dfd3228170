// Stress and displacement below the surface of a half-space z > 0 under a uniformly loaded
// rectangle: pressure p into the body, tractions q_x and q_y on its surface.
//
// All follow from four harmonic integrals over the rectangle, with R the distance from its points:
//   V = int 1/R, F = int ln(R + z), F1 = int z ln(R + z) - R        (F_z = V, F1_z = F)
// by Boussinesq and Cerruti (Love 1929, Phil. Trans. A 228; Johnson 1985, eqs. 3.2 to 3.7):
//   p:   2 pi s_xx/p = 2 nu V_z - z V_xx - (1 - 2 nu) F_xx       4 pi G u_x/p = -(1 - 2 nu) F_x - z
//   V_x
//        2 pi s_zz/p = V_z - z V_zz                              4 pi G u_z/p = 2 (1 - nu) V - z
//        V_z 2 pi s_xy/p = -(1 - 2 nu) F_xy - z V_xy,                2 pi s_xz/p = -z V_xz
//   q_x: 2 pi s_xx/q = 2 (1 + nu) V_x + 2 nu F1_xxx - z F_xxx    4 pi G u_x/q = 2 V + 2 nu F1_xx -
//   z F_xx
//        2 pi s_yy/q = 2 nu V_x + 2 nu F1_xyy - z F_xyy          4 pi G u_y/q = 2 nu F1_xy - z F_xy
//        2 pi s_zz/q = -z V_xz,                                  4 pi G u_z/q = (1 - 2 nu) F_x - z
//        V_x 2 pi s_xy/q = V_y + 2 nu F1_xxy - z F_xxy 2 pi s_xz/q = V_z - z V_xx,     2 pi s_yz/q
//        = -z V_xy
// and q_y with x and y exchanged; tension is positive. Each is an alternating sum over the
// rectangle's corners.
#pragma once

#include <array>

namespace railpatch {

struct below {
  enum load { p, qx, qy, loads };
  enum component { xx, yy, zz, xy, yz, zx, ux, uy, uz, components, stresses = ux };
  static constexpr int all = static_cast<int>(loads) * static_cast<int>(components);
  static constexpr int at(int l, int c) { return l * components + c; }

  // Whether a coefficient changes its sign with x (axis 0) or y (axis 1): tensors and vectors do so
  // with each index of that axis, loads along it too.
  static constexpr bool odd(int l, int c, int axis) {
    constexpr bool of_component[2][components] = {
        {false, false, false, true, false, true, true, false, false},
        {false, false, false, true, true, false, false, true, false}};
    return of_component[axis][c] != (l == (axis == 0 ? qx : qy));
  }
};

struct body_constants {
  double shear_modulus = 0, poisson_ratio = 0;  // Pa, -
};

// Pa/Pa, m/Pa: load by load the stresses xx, yy, zz, xy, yz, zx and the displacements
using below_coefficients = std::array<double, below::all>;

// The primitive of all coefficients at a corner, observer minus corner; z >= 0, m. length: of the
// rectangle, which nothing depends on but where the observer stands on an edge.
below_coefficients below_corner(const body_constants &body, double x, double y, double z,
                                double length);

// Of a rectangle size[0] by size[1] around the origin at (x, y, z).
below_coefficients below_rectangle(const body_constants &body, const double size[2], double x,
                                   double y, double z);

}  // namespace railpatch
