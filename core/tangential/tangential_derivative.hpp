// Derivatives of the tangential problem's solution in steady rolling with Coulomb's law, on the
// uniform grid and on the solution's active sets.
//
// With the micro-slip s = w + B p and the bound g (rolling_newton.hpp):
//   stick: B dp = -(dw + dB p),
//   slip:  p = -g n, n = s/|s|, so dp = -n dg - (g/|s|)(I - n n^T)(dw + dB p + B dp).
// In slip the traction turns along c, normal to n, and its part -n dg =: dp_n is known, so the
// unknowns z are those of a Newton step: dp = dp_n + E z, with K the unknowns' keep, S their stiff
// and E^T the transpose of E (numeric/row_blocks.hpp)
//   (K + S E^T B E) z = -S E^T v,  v = dw + dB p + B dp_n.
// A linear resultant l . dp follows either from z, one system for each direction, or from
//   (K + S E^T B^T E) y = S E^T l,  m = E y:  l . dp = (l - B^T m) . dp_n - m . (dw + dB p),
// one system for each resultant and none for a direction. B^T is B of rolling the other way.
//
// Elements that change size by (ddx, ddy), with B = (A(x) - A(x + dx))/dx and A as in
// normal/normal_derivative.hpp, plus the layer's part, which is constant in A:
//   dB = (ddy/dy - ddx/dx) B_bodies + (ddx - dx ddy/dy) B' - (ddx/dx) B_layer,
// B' made from dA/d(dx) as B from A; in plane strain only the last term is there.
#pragma once

#include "numeric/row_blocks.hpp"
#include "numeric/shared_krylov.hpp"
#include "tangential/tangential.hpp"

namespace railpatch {

// One direction.
struct tangential_variation {
  const double *pressure = nullptr;      // Pa, rate of the pressure on the grid; null: zero
  const double *row_friction = nullptr;  // -, rate of each row's factor; null: zero
  double friction_coefficient = 0;       // -
  double creepage[2] = {0, 0}, spin_creepage = 0;
  double size[2] = {0, 0}, origin[2] = {0, 0};  // m, of dx, dy and x0, y0
  double spin_offset = 0;                       // m
};

// What was solved: fields on the grid.
struct tangential_point {
  influence &a;
  influence *by_length;  // derivatives of the coefficients; null: grids only scale
  row_blocks &blocks;
  const grid &g;
  const rolling_input &rolling;
  double friction_coefficient;
  const double *row_friction;  // null: one everywhere
  const double *pressure, *px, *py, *sx, *sy;
  const unsigned char *division;
};

// Rates of the sums over the elements.
struct tangential_change {
  double force[2] = {0, 0};  // N
  double moment = 0;         // N m
  double energy = 0;         // J, elastic
};

class tangential_derivative {
 public:
  tangential_derivative(int max_nx, int max_ny, int directions);

  struct options {
    double tolerance;
    bool energy;  // its rate is asked for
  };
  // The resultants of any number of directions follow from `begin_resultants`, whose systems are
  // solved there; those of a few directions from `solve`. Each returns the greatest relative
  // residual of its systems.
  double begin_resultants(const tangential_point &point, const options &o);
  void resultants(const tangential_point &point, const tangential_variation &in,
                  tangential_change &out);
  double solve(const tangential_point &point, const tangential_variation *in, int count,
               const options &o, tangential_change *out);
  // of the last call: products, and of these in double precision
  int products() const { return products_; }
  int exact_products() const { return exact_; }
  size_t bytes() const;

 private:
  void collect(const tangential_point &point);
  void factor(const tangential_point &point, bool transposed);
  void product(const tangential_point &point, const double *v, double *out, bool transposed,
               bool exact);
  double solve_systems(const tangential_point &point, int sides, bool transposed, double tolerance);
  // tractions' rate that the bound's gives; false where it is zero
  bool along_bound(const tangential_point &point, const tangential_variation &in, double *dp) const;
  void slip_rate(const tangential_point &point, const tangential_variation &in, double *v);
  void prepare_sizes(const tangential_point &point);
  void restrict_to_unknowns(const double *v, double sign, double *right) const;
  void expand(const double *z, double *dp) const;
  void set_weights(const tangential_point &point, const options &o);
  void add_geometry(const tangential_point &point, const tangential_variation &in,
                    tangential_change &out) const;
  double *side(aligned_buffer<double> &b, int k) const {
    return b.data() + static_cast<size_t>(k) * vector_;
  }
  // f(element, index of z, index of z_y, indices of its components in vectors)
  template <class F>
  size_t for_each_unknown(F &&f) const;

  int directions_, weights_ = 3, products_ = 0, exact_ = 0;
  size_t vector_ = 0, unknowns_ = 0;
  bool sizes_ready_ = false;
  double stretch_energy_ = 0;  // 1/2 p . dA/d(dx) p dA
  row_elements elements_;
  row_strips strips_;
  aligned_buffer<element_linearisation> linear_;
  aligned_buffer<double> normal_[2];  // of each element: -n in slip, else 0
  aligned_buffer<double> matrix_[2];
  aligned_buffer<double> right_, solution_;      // unknowns, one after the other
  aligned_buffer<double> weight_, dual_, back_;  // l, m and l - B^T m
  aligned_buffer<double> known_, rate_, work_, unknown_;
  aligned_buffer<double> by_size_[3];  // B p of the bodies, of dA/d(dx) and of the layer
  shared_krylov systems_;
};

}  // namespace railpatch
