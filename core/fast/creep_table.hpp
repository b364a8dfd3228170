// Creep forces of elliptic contacts, interpolated from a table that the full theory filled.
//
// With c = sqrt(a b) and the bound B = mu Fn, forces and moment of a Hertz contact depend on
//   v = (G c^2/B) (s1 xi, s2 eta, s3 c phi),   a/b and Poisson's ratio
// only; the scales s1 = C11, s2 = C22 and s3, between C22 and C23, make the friction bound be
// reached at about |v| = 3 in every direction. The table is in t = |v|/(R + |v|) and the direction
// n = v/|v|:
//   (Fx, Fy, Mz/c)/B = t (A(t) n + (1 - n3^2) h(t, psi, theta)),
//   n = (cos psi cos theta, cos psi sin theta, sin psi),
// A with the five entries that the symmetries leave and A(0) n the linear theory, h(0) = 0. All are
// tensor products of uniform cubic B-splines, in ln(a/b) too; Poisson's ratio has three nodes and
// a parabola. So forces are C1 in the creepages everywhere: at v = 0 by h(0) = 0, at pure spin
// (n3 = 1) by the factor 1 - n3^2, across xi = 0 and phi = 0 because the coefficients beyond hold
// the mirror images. t = 1 is sliding without elasticity.
//
// Symmetries of steady rolling along +x: v -> -v turns all signs; (eta, phi) -> -(eta, phi) turns
// those of Fy and Mz (mirror image). So xi -> -xi turns that of Fx. Rolling along -x is the mirror
// image in x: xi, phi, Fx and Mz change sign.
//
// The table is one block of bytes, little-endian, made by `railpatch table`: header, then
//   double  scale[poisson][ratio][3]                      s1, s2, s3
//   float   linear[poisson][ratio][t][8]                  A11, A22, A23, A32, A33, three zeros
//   int16   remainder[poisson][ratio][psi][theta][t][3]   h over remainder_scale
//   char    recipe[recipe_bytes]                          how it was made, as JSON
// each padded to a multiple of 8 bytes. Counts are of coefficients: of n intervals n + 3.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast/fast_problem.hpp"
#include "numeric/dual.hpp"

namespace railpatch {

struct creep_table_header {
  char magic[8];      // "RPCREEP1"
  uint64_t bytes;     // of all
  uint64_t checksum;  // FNV-1a, by words of 8 bytes, of all that follows
  int32_t ratio_count, psi_count, theta_count, t_count;
  int32_t recipe_bytes, reserved;
  double poisson_ratio[3];
  double log_ratio[2];        // ln(a/b), first and last
  double radius;              // R
  double remainder_scale[3];  // of one unit
  double error[2];            // of force over B and of moment over c B, 95th percentile
};

// FNV-1a (Fowler, Noll, Vo 1991) by words of 8 bytes.
uint64_t table_checksum(const unsigned char *data, size_t size);

// T: double, or directed, which tells how the forces change along a direction.
template <class T>
struct basic_creep_problem {
  T semi_axes[2];        // m
  double shear_modulus;  // Pa
  T bound;               // N, mu Fn
  T creepage[2], spin_creepage;
  int direction;
};
using creep_problem = basic_creep_problem<double>;

template <class T>
struct basic_creep_forces {
  T force[2];     // N
  T moment;       // N m
  T friction;     // N, frictional power over the rolling speed
  bool in_range;  // of the table; outside, its nearest a/b stands for a/b, and its parabola
                  // continues in Poisson's ratio
};
using creep_forces = basic_creep_forces<double>;

class creep_table {
 public:
  // Says what is wrong with a block of bytes; null: nothing.
  static const char *defect(const void *data, size_t size);

  // The block is used in place, not copied, and has no defect.
  creep_table(const void *data, double poisson_ratio);

  template <class T>
  basic_creep_forces<T> evaluate(const basic_creep_problem<T> &problem) const;
  // a/b itself within the table, else the one that stands for it.
  double nearest_ratio(double ratio) const;
  // 95th percentiles: of force over B and of moment over c B.
  double force_error() const { return header().error[0]; }
  double moment_error() const { return header().error[1]; }

 private:
  template <class T>
  struct axis {
    int first;    // coefficient
    T weight[4];  // of this and the next three
  };
  template <class T>
  static axis<T> locate(const T &position, int count);
  const creep_table_header &header() const { return *header_; }
  template <class T>
  bool in_range(const T &log_ratio) const {
    return poisson_in_range_ && log_ratio >= header().log_ratio[0] &&
           log_ratio <= header().log_ratio[1];
  }
  template <class T>
  basic_creep_forces<T> from_rest(const basic_creep_problem<T> &p, const axis<T> &ratio,
                                  const T n[3], double along, double mirror, const T &c) const;
  template <class T>
  void interpolate_scale(const axis<T> &ratio, T s[3]) const;
  template <class T>
  void interpolate_linear(const axis<T> &ratio, const axis<T> &t, T m[5]) const;
  template <class T>
  void interpolate_remainder(const axis<T> &ratio, const axis<T> &psi, const axis<T> &theta,
                             const axis<T> &t, T h[3]) const;

  const creep_table_header *header_;
  const double *scale_;
  const float *linear_;
  const int16_t *remainder_;
  double poisson_weight_[3];
  bool poisson_in_range_;
};

tangential_result solve_table(const fast_problem &problem, tangential_fields fields,
                              creep_resultants &sums);

}  // namespace railpatch
