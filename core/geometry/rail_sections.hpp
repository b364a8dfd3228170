// A rail's profile that varies along the track: profiles at given positions, blended in between.
//
// Knot i of one section belongs to knot i of the next: both lie at the same share of the arc
// length. Between two neighbouring sections the knots' y and z, and their derivatives by that
// share, are linear in the position; before the first and beyond the last section the profile is
// constant. Where the profile changes, each step's rail is prismatic with the profile at x.
#pragma once

#include <vector>

#include "geometry/profile.hpp"

namespace railpatch {

class rail_sections {
 public:
  // Views that have passed validate() and fault(), copied; positions (m) increase.
  rail_sections(const profile_view *sections, const double *positions, int count);
  // Whether two sections have knots that belong together.
  static bool belong_together(const profile_view &a, const profile_view &b);

  // The profile at x; changed tells whether it is another than the last one.
  profile_view at(double x, bool &changed);
  std::size_t bytes() const;

 private:
  struct section {
    double position;
    std::vector<double> s, y, z, dy, dz;
  };
  profile_view view() const {
    return {now_.s.data(),  now_.y.data(),  now_.z.data(),
            now_.dy.data(), now_.dz.data(), static_cast<int>(now_.s.size())};
  }

  std::vector<section> sections_;
  section now_;
  std::size_t first_ = 0;  // section before x, and the share of the one that follows it
  double share_ = 0;
};

}  // namespace railpatch
