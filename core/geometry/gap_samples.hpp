// What is kept of a full look along a wheel's profile, so that the next one need not be full.
//
// Samples of the wheel go in blocks. At one place, the reference, each block has the least gap that
// it could have if its samples lay up to `reach` further to either side. Elsewhere no sample's gap
// is below that by more than its point has moved down from the rail, and by how much it has at most
// follows from how the axes have turned and moved. Blocks that cannot be near the rail are passed
// over: what is found is to the bit what a full look finds.
#pragma once

#include <array>
#include <vector>

#include "geometry/placement.hpp"

namespace railpatch {

// Where wheel and rail stand at a look, at z = 0 of the wheelset.
struct look_place {
  vec3 origin{};                                      // of the wheel's axis
  mat3 axes{};                                        // of the wheel
  std::array<double, 3> wheel_moved{}, rail_moved{};  // of the profiles: rad, m, m
};

struct gap_samples {
  static constexpr int block = 16;
  static constexpr double reach = 2.5e-4;  // m

  // Samples of one block: their points on the wheel, y along the axis and radius r.
  struct stretch {
    double y = 0, half_y = 0, r = 0, half_r = 0;  // m, middle and half the range
    double steepest = 0;                          // -, greatest |dz/dy|
    double least = 0;                             // m, gap at the reference
    double bound = 0;                             // m, the same at this place
    bool known = false;                           // gaps are those of this place
  };

  explicit gap_samples(int count);

  // Whether a place is as near to the last one that a reference there may serve the next.
  bool follows(const look_place &at) const;
  // The bounds at a place, from the reference; false where they cannot be told.
  bool set_bounds(const look_place &at);

  std::vector<double> gap;  // m, by sample, for z = 0
  std::vector<stretch> stretches;
  look_place reference, last;
  bool referred = false, begun = false;
};

}  // namespace railpatch
