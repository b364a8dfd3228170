// Influence coefficients of viscoelastic half-spaces in steady rolling, and their products.
//
// Each body is a standard linear solid with Poisson's ratio constant: a spring in series with a
// spring and a dashpot side by side. Its creep compliance is
//   J(t) = (1/G) (1 + f (1 - exp(-t/tau))),
// with f the flexibility of the second spring over that of the first and tau the relaxation time at
// constant stress. In steady rolling with speed V the material under an element was ahead of it
// before, so what an elastic body's displacement u would be becomes (Kalker 1990,
// "Three-dimensional elastic bodies in rolling contact"; Wang and Knothe 1993, J. Appl. Mech. 60)
//   u + f int_0^inf u(x + d s) exp(-s/L)/L ds,  L = V tau, d = 1 (-1) for rolling towards +x (-x).
// L = 0 stands for a body that has all the time to yield: of compliance (1 + f)/G.
//
// The coefficients are those of influence.hpp under this integral, K. From one element to the next,
// against rolling,
//   K(x) = int_0^dx A(x + d s) exp(-s/L)/L ds + exp(-dx/L) K(x + d dx),
// so a row is one recursion that damps its errors; the integrals are by Gauss-Legendre with 16
// nodes on panels no longer than twice L or their distance from the load's edges, those that meet
// an edge on panels that halve towards it: exact to some 1e-13 of the greatest coefficient.
//
// Power that the bodies take up, over V and element area: -p . du/ds, by central differences over
// two elements. The elastic part, even along x, has none of it, and what is left of the power that
// the rigid motion supplies to tractions is friction's: with the slip's backward differences it is
// friction's work on the slip and half of a second difference of K, both >= 0. The bodies' stored
// energy is 1/2 p . u, with u their whole displacement: the second spring's is 1/2 p . K p in
// steady rolling.
#pragma once

#include "half_space/influence.hpp"
#include "numeric/plane_transform.hpp"

namespace railpatch {

// Of wheel and rail.
struct viscous_bodies {
  double shear_modulus[2] = {0, 0}, poisson_ratio[2] = {0, 0};
  double ratio[2] = {0, 0};            // f, 0: elastic
  double relaxation_time[2] = {0, 0};  // s
  bool any() const { return ratio[0] > 0 || ratio[1] > 0; }
  // The bodies after all time: their compliance is (1 + f)/G.
  elastic_constants relaxed() const;
  // K of the second springs alone, as elastic_constants::mismatch: whether yielding couples
  // pressure and tractions.
  bool couples() const;
};

class viscous_influence {
 public:
  // elastic: bodies without their second springs, on the same plans; kept.
  viscous_influence(const viscous_bodies &of, influence &elastic, const fft_plans &plans);

  // Prepares kernels and spectra for the grid that the elastic part has. direction: 1 or -1; speed:
  // m/s, 0: all has yielded. Cheap where nothing has changed.
  void set(const grid &g, int direction, double speed);

  // u = A p of the normal direction, [ny][nx].
  void normal_product(const double *pressure, double *displacement);
  // Approximate inverse of normal_product from and to the elements that are marked: along each row
  // u - L du/dx is an elastic displacement by (1 + f) p - L dp/dx, with u and p zero ahead; the
  // elastic part by its circulant, alone where little yields along the grid. displacement is used
  // up.
  void normal_inverse(const unsigned char *inside, double *displacement, double *pressure);
  // (u_x, u_y) = A (p_x, p_y).
  void tangential_product(const double *px, const double *py, double *ux, double *uy);
  // (u(x) - u(x + direction dx))/dx, the micro-slip caused by the tractions.
  void rolling_product(const double *px, const double *py, double *sx, double *sy);
  // What the bodies take up by pressure, and by tractions, over the rolling speed, N.
  double normal_loss(const double *pressure);
  double tangential_loss(const double *px, const double *py);

  int direction() const { return direction_; }
  bool is_line() const { return elastic_.bodies().line_width > 0; }
  // xx, yy or zz, with the source so many elements ahead of the observer, in the direction of
  // rolling, and j rows aside.
  double coefficient(kernel k, int ahead, int j) const;
  size_t bytes() const;

 private:
  using lines = plane_transform::lines;
  // second springs of one relaxation length
  struct springs {
    double flexibility = 0;  // 1/Pa, sum of f/(2 pi G)
    double by_poisson = 0;   // the same times Poisson's ratio
    double length = 0;       // m, L
  };
  // places of the observer ahead of the load, in elements
  struct places {
    int first, count;
  };
  int half() const { return plane_.nx() / 2; }
  int columns() const { return 2 * half() + 1; }
  int lines_across() const { return plane_.ny() / 2 + 1; }
  int kernels() const { return elastic_.bodies().tangential ? 4 : 1; }
  void make_tables();
  void add_springs(const springs &b);
  void add_panels(const springs &b, places at, double begin, double end, double apart);
  void add_towards(const springs &b, places at, double begin, double end);
  void add_node(const springs &b, places at, double s, double weight);
  void make_corners(places at, double s);
  void add_to(const springs &b, double weight, const double sum[3], size_t at);
  void make_spectra();
  void set_inverse();
  template <class F>
  void along_rows(const unsigned char *inside, F &&f) const;
  template <class F>
  lines product(const double *re, const double *im, F &&of_wave);
  void take(lines u, double *re, double *im) const;

  viscous_bodies bodies_;
  influence &elastic_;
  const fft_plans &plans_;
  plane_transform plane_;
  grid grid_;
  int plan_ = -1, direction_ = 0;
  double speed_ = -1;
  double decay_ = 0, yielding_ = 0;  // exp(-dx/L) and f of both bodies together, for the inverse
  // [rows across][places from -nx/2 to nx/2], of A and of the springs being added: zz, xx, yy, xy
  aligned_buffer<double> table_[4], part_[4];
  aligned_buffer<double> corner_[3];      // primitives
  aligned_buffer<double> re_[4], im_[4];  // spectra, [nx][ny]
  aligned_buffer<double> shift_[2];       // (1 - exp(i k direction dx))/dx of each wave
  aligned_buffer<double> taken_[2];       // products whose sums alone are asked for
};

}  // namespace railpatch
