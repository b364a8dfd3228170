// Corrections of creep forces on contacts that are no ellipse: of one pair of profiles, or of a
// book of shapes.
//
// A shape is known by seven features of its pressure, about the centre and in units of the
// semi-axes that Hertz's pressure with the same second moments would have: ln(a/b) and the moments
// y^3, y^4, x y, x^2 y, x^2 y^2, x^4. A node of the table is a shape that the full theory solved at
// many creepages: what is kept is the difference to the table of ellipses on the ellipses of
// pressed_ellipses.hpp, over the bound B = mu Fn (moment: c B, c = sqrt(a b)). It depends on
//   v = (G c^2/B) (4.2 xi, 3.7 eta, 2.3 r phi),   r^2 = (a^2 + b^2)/2
// by cubics with continuous slopes in the spin v3, in the direction of (v1, v2) and in
// t = |(v1, v2)|/(R + |(v1, v2)|), at t = 1 nothing. Between shapes the nearest nodes count: of
// what they have the plane is fitted through the features, moving least squares with the weights
//   w = ((1 - d/D)/(d + d0))^2,   D the distance of the nearest that does not count
// (Franke and Nielson 1980, Int. J. Numer. Meth. Engng 15), so that forces follow the shape without
// jumps. Slopes are drawn to 0 as far as nodes lie closer than features are known; where a shape
// lies so far outside of its nodes that the plane would magnify what they have, w itself counts.
// v -> -v turns the signs; rolling along -x is the mirror image in x.
//
// One block of bytes, little-endian, made by `railpatch table --wheel --rail`: header, then
//   float   feature[node/8][8][8 nodes]             times the scales, the last 0; of nodes that
//                                                   fill up the last block greater than any
//   int16   remainder[node][spin][direction][t][4]  Fx, Fy, Mz over their units, 0
//   char    recipe[recipe_bytes]                how it was made, as JSON
//   the table of ellipses (creep_table.hpp)
// each padded to a multiple of 8 bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "fast/creep_table.hpp"
#include "half_space/influence.hpp"

namespace railpatch {

struct shape_table_header {
  static constexpr int features = 8, spins = 12;
  char magic[8];      // "RPSHAPE2"
  uint64_t bytes;     // of all
  uint64_t checksum;  // as creep_table_header's
  int32_t node_count, recipe_bytes;
  double poisson_ratio;
  double reach;        // distance of the nearest node beyond which a shape is not in the table
  double radius;       // R
  double spin[spins];  // v3 of the nodes, from 0
  double scale[features];
  double unit[3];
  double error[2];  // of force over B and of moment over c B, 95th percentile
};

// First to fourth moments of a pressure.
struct shape_of_pressure {
  double centre[2];  // m
  double axes[2];    // m
  std::array<double, shape_table_header::features> feature;
};

class shape_table {
 public:
  static constexpr int directions = 12, radii = 9, neighbours = 14;
  static constexpr int lanes = 8;  // nodes of a block of features

  // Whether a block of bytes says that it is one.
  static bool is_one(const void *data, size_t size);
  // Says what is wrong with it, but for the table of ellipses in it; null: nothing.
  static const char *defect(const void *data, size_t size);
  // The table of ellipses in a block without defect.
  static std::pair<const void *, size_t> ellipses(const void *data);

  // The block is used in place, not copied.
  shape_table(const void *data, double poisson_ratio);

  struct correction {
    double force[2];  // N
    double moment;    // N m, about the grid's origin
    bool in_range;
  };
  // Of a pressure that is somewhere above 0; creepages at the grid's origin.
  correction evaluate(const grid &g, const double *pressure, double shear_modulus, double bound,
                      const double creepage[2], double spin_creepage, int direction);
  double force_error() const { return header_->error[0]; }
  double moment_error() const { return header_->error[1]; }

  static shape_of_pressure describe(const grid &g, const double *pressure);

 private:
  struct row_sums {
    double zero, one, two, four;  // of the pressure times powers of x
  };
  struct near {
    int node;
    double distance;
  };
  using shape_features = std::array<float, shape_table_header::features>;
  using node_weights = std::array<double, neighbours>;
  int nearest(const shape_features &feature, std::array<near, neighbours + 1> &found) const;
  node_weights weigh(const shape_features &feature,
                     const std::array<near, neighbours + 1> &found) const;
  struct place_between;
  place_between between(const double v[3]) const;
  void interpolate(int node, const place_between &place, double weight, double sum[3]) const;

  const shape_table_header *header_;
  const float *feature_;
  const int16_t *remainder_;
  bool poisson_in_range_;
};

// Of a table of ellipses or of shapes: what is wrong with it; null: nothing.
const char *creep_table_defect(const void *data, size_t size);

}  // namespace railpatch
