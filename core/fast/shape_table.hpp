// Corrections of creep forces on contacts that are no ellipse: of one pair of profiles, or of a
// book of shapes.
//
// A shape is known by eight features of its pressure, about the centre and in units of the
// semi-axes that Hertz's pressure with the same second moments would have: ln(a/b), the moments
// y^3, y^4, x y, x^2 y, x^2 y^2, x^4, and how far the load is gathered in few rows, ln of the
// integral of its square over y (P^2 b, its integral being 1). A node of the table is a shape that
// the full theory solved at many creepages. What it has beyond the table of ellipses on the
// ellipses of pressed_ellipses.hpp, over the bound B = mu Fn (moment: c B, c = sqrt(a b)), depends
// on
//   v = (G c^2/B) (4.2 xi, 3.7 eta, 2.3 r phi),   r^2 = (a^2 + b^2)/2
// by cubics with continuous slopes in the spin v3, in the direction of (v1, v2) and in
// t = |(v1, v2)|/(R + |(v1, v2)|), at t = 1 nothing. All shapes have it as a sum of the same few
// functions of v, the principal components of what the nodes have. How much of each a shape has is
// a Gaussian process through the nodes (kriging: Sacks, Welch, Mitchell and Wynn 1989, Stat. Sci.
// 4),
//   c_k = sum_n weight[n][k] (1 - d_n)^4 (4 d_n + 1),   d_n the distance to node n, below 1
// with Wendland's function (1995, Adv. Comput. Math. 4), so that forces follow the shape with
// continuous slopes and curvatures. v -> -v turns the signs; rolling along -x is the mirror image
// in x.
//
// One block of bytes, little-endian, made by `railpatch table --wheel --rail`: header, then
//   float   feature[node/8][8][8 nodes]      times the scales; of nodes that fill up the last block
//                                            greater than any
//   double  weight[node/8][8 nodes][24]      of the first function 0: it counts once; 0 of nodes
//                                            that fill up
//   int16   function[spin][direction][t][3][24]   Fx, Fy, Mz
//   char    recipe[recipe_bytes]             how it was made, as JSON
//   the table of ellipses (creep_table.hpp)
// each padded to a multiple of 8 bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "fast/creep_table.hpp"
#include "fast/pressure_view.hpp"

namespace railpatch {

struct shape_table_header {
  static constexpr int features = 8, spins = 12, functions = 24;
  char magic[8];      // "RPSHAPE3"
  uint64_t bytes;     // of all
  uint64_t checksum;  // as creep_table_header's
  int32_t node_count, recipe_bytes;
  double poisson_ratio;
  double reach;        // distance of the nearest node beyond which a shape is not in the table
  double radius;       // R
  double spin[spins];  // v3 of the nodes, from 0
  double scale[features];
  double unit;      // of the functions, where the first counts once
  double error[2];  // of force over B and of moment over c B, 95th percentile
};

// What a pressure's first to fourth moments and the load of its rows tell.
template <class T>
struct basic_shape {
  T centre[2];  // m
  T axes[2];    // m
  std::array<T, shape_table_header::features> feature;
};
using shape_of_pressure = basic_shape<double>;

class shape_table {
 public:
  static constexpr int directions = 12, radii = 9;
  static constexpr int lanes = 8;  // nodes of a block of features

  // Whether a block of bytes says that it is one.
  static bool is_one(const void *data, size_t size);
  // Says what is wrong with it, but for the table of ellipses in it; null: nothing.
  static const char *defect(const void *data, size_t size);
  // The table of ellipses in a block without defect.
  static std::pair<const void *, size_t> ellipses(const void *data);

  // The block is used in place, not copied.
  shape_table(const void *data, double poisson_ratio);

  template <class T>
  struct correction {
    T force[2];  // N
    T moment;    // N m, about the grid's origin
    bool in_range;
  };
  // Of a pressure that is somewhere above 0; creepages at the grid's origin. T: double or directed.
  template <class T>
  correction<T> evaluate(const pressure_view<T> &pressure, double shear_modulus, const T &bound,
                         const T creepage[2], const T &spin_creepage, int direction) const;
  double force_error() const { return header_->error[0]; }
  double moment_error() const { return header_->error[1]; }

  template <class T>
  static basic_shape<T> describe(const pressure_view<T> &pressure);

 private:
  template <class T>
  struct row_sums {
    T zero, one, two, four;  // of the pressure times powers of x
  };
  template <class T>
  using shape_features = std::array<T, shape_table_header::features>;
  template <class T>
  using amounts = std::array<T, shape_table_header::functions>;
  double weigh(const shape_features<double> &feature, amounts<double> &amount) const;
  double weigh(const shape_features<directed> &feature, amounts<directed> &amount) const;
  template <class T>
  struct place_between;
  template <class T>
  place_between<T> between(const T v[3]) const;
  template <class T>
  void interpolate(const place_between<T> &place, const amounts<T> &amount, T sum[3]) const;

  const shape_table_header *header_;
  const float *feature_;
  const double *weight_;
  const int16_t *function_;
  bool poisson_in_range_;
};

// Of a table of ellipses or of shapes: what is wrong with it; null: nothing.
const char *creep_table_defect(const void *data, size_t size);

}  // namespace railpatch
