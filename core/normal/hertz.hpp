// Hertz contact of two quadratic surfaces in closed form, by Carlson's symmetric elliptic
// integrals.
//
// For p(x, y) = p0 sqrt(1 - (x/a)^2 - (y/b)^2) and E* = G/(1 - nu) of the combined bodies
// (Johnson 1985, "Contact mechanics", section 3.3; Carlson 1995 for R_F and R_D):
//   curvatures   c0 = F/(2 pi E*) R_D(0, b^2, a^2),  c1 = F/(2 pi E*) R_D(0, a^2, b^2)
//   approach     3 F/(2 pi E*) R_F(0, a^2, b^2),     p0 = 3 F/(2 pi a b)
// where the undeformed distance is c0 x^2 + c1 y^2. Line contact of radius R and force per length
// f: a^2 = 4 f R/(pi E*), p0 = 2 f/(pi a).
#pragma once

namespace railpatch {

struct hertz_contact {
  double semi_axes[2] = {0, 0};   // m, along rolling, lateral
  double curvatures[2] = {0, 0};  // 1/m
  double normal_force = 0;        // N
  double approach = 0;            // m
  double max_pressure = 0;        // Pa
};

// Pressure over its greatest, squared: 1 in the middle, 0 on the edge, negative outside. Of a line
// contact, whose second axis is zero, across rolling the same everywhere.
inline double inside_ellipse(const double semi_axes[2], double x, double y) {
  const double u = x / semi_axes[0], v = semi_axes[1] > 0 ? y / semi_axes[1] : 0.0;
  return 1.0 - u * u - v * v;
}

// What curvatures say of the ellipse without a load: found by bisection, so where they stay as they
// are it is found once.
struct hertz_shape {
  double curvatures[2];  // 1/m
  double a, b, rd0, rf;  // semi-axes with a b = 1, and their integrals R_D(0, b^2, a^2) and R_F
};
hertz_shape hertz_shape_of(const double curvatures[2]);
hertz_contact hertz_from_force(const hertz_shape &shape, double modulus, double force);
hertz_contact hertz_from_approach(const hertz_shape &shape, double modulus, double approach);
hertz_contact hertz_from_force(const double curvatures[2], double modulus, double force);
hertz_contact hertz_from_approach(const double curvatures[2], double modulus, double approach);
// Of an ellipse that is given R_D(0, b^2, a^2), R_D(0, a^2, b^2) and R_F(0, a^2, b^2), whatever the
// load.
struct hertz_ellipse {
  double semi_axes[2];  // m
  double rd[2], rf;
};
hertz_ellipse hertz_ellipse_of(const double semi_axes[2]);
// The curvatures that give the ellipse under the load.
hertz_contact hertz_from_ellipse(const hertz_ellipse &ellipse, double modulus, double force);
hertz_contact hertz_from_ellipse(const double semi_axes[2], double modulus, double force);
hertz_contact hertz_ellipse_from_approach(const hertz_ellipse &ellipse, double modulus,
                                          double approach);
hertz_contact hertz_ellipse_from_approach(const double semi_axes[2], double modulus,
                                          double approach);
// Line contact, force and approach-free: semi_axes[1] and the approach stay zero.
hertz_contact hertz_line(double radius, double width, double modulus, double force);

// Rates of everything above, by the rates of curvatures and of either force or approach; of a line
// contact or where the ellipse stays as it is, of the force alone.
hertz_contact hertz_rate_of_force(const hertz_contact &c, const double curvatures[2], double force);
hertz_contact hertz_rate_of_approach(const hertz_contact &c, const double curvatures[2],
                                     double approach);
hertz_contact hertz_rate_of_line(const hertz_contact &c, double force);
hertz_contact hertz_rate_of_ellipse(const hertz_contact &c, double force);

}  // namespace railpatch
