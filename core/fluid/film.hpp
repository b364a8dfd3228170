// Central film of an elliptic contact of smooth bodies with a Newtonian liquid whose viscosity
// grows by the pressure as exp(alpha p): Nijenbanning, Venner and Moes 1994, Wear 176.
//
// With 2/E' = (1 - nu_w^2)/E_w + (1 - nu_r^2)/E_r, R_x along rolling, u_s the sum of the surfaces'
// speeds: U = eta u_s/(E' R_x), N = F/(E' R_x^2) U^(-3/4), L = alpha E' U^(1/4), D = R_x/R_y,
//   K = 1 + 0.006 ln D + 0.63 D^(4/7),  h_00 = 1.8/D
//   h_RI = 145 (1 + 0.796 D^(14/15))^(-15/7) D^-1 N^-2     rigid, isoviscous
//   h_EI = 3.18 K^(-14/25) D^(-1/15) N^(-2/15)             elastic, isoviscous
//   h_RP = 1.29 (1 + 0.691 D)^(-2/3) L^(2/3)               rigid, piezoviscous
//   h_EP = 1.48 K^(-7/20) D^(-1/24) N^(-1/12) L^(3/4)      elastic, piezoviscous
//   I = (h_RI^(3/2) + (h_EI^-4 + h_00^-4)^(-3/8))^(2/3),  s = 3/2 (1 + exp(-1.2 h_EI/h_EP))
//   h = (I^s + (h_RP^-8 + h_EP^-8)^(-s/8))^(1/s),         h_c = h R_x U^(1/2)
// Where asperities carry the share f of the load, the film is that of the reduced problem, load
// F (1 - f) and modulus E' (1 - f) (Johnson, Greenwood and Poon 1972): with q = 1 - f the four
// films grow as q^(-3/2), q^(-1/10), q^(1/2), q^(1/2), and U^(1/2) as q^(-1/2).
#pragma once

namespace railpatch {

struct film_contact {
  double radius[2];             // m, of the undeformed distance x^2/(2 R_x) + y^2/(2 R_y)
  double modulus;               // Pa, E'
  double force;                 // N
  double speed;                 // m/s, mean of both surfaces'
  double viscosity;             // Pa s
  double pressure_coefficient;  // 1/Pa, alpha
};

struct film_point {
  double unit, over_unit;    // m; ln(h/unit)
  double by_load;            // d ln h/d ln F, at the same radii
  double by_speed;           // d ln h/d ln(speed), and by the viscosity the same
  double by_part;            // d ln h/d ln q
  double by_ratio;           // d ln h/d ln D, at the same groups
  double thickness() const;  // m
  double by_radius_along() const { return 1.0 - by_speed - 2.0 * by_load + by_ratio; }
  double by_radius_across() const { return -by_ratio; }
};

// The parts of the formula that do not depend on q.
class elliptic_film {
 public:
  explicit elliptic_film(const film_contact &contact);  // speed > 0, force > 0
  film_point at(double part = 1.0) const;               // part: q, 0 < q <= 1

 private:
  double rigid_, elastic_, limit_;  // h_RI^(3/2), h_EI^-4, h_00^-4
  double piezo_, log_piezo_,
      of_rigid_;  // of h_RP^-8 + h_EP^-8 = P^-8: P; its logarithm; share of h_RP
  double ratio_;  // h_EI/h_EP
  double unit_;   // m, R_x U^(1/2)
  struct {
    double ri, ei, rp, ep;
  } by_ratio_;  // d ln/d ln D of each film
  bool piezoviscous_;
};

}  // namespace railpatch
