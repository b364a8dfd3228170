// How far two neighbouring parts of contact are one patch, at heights between those that the
// contact search was made at.
//
// As the wheelset goes down by z the gap between both parts falls by as much. The part that
// appeared last grows in width about as the root of how far it has sunk in, and the distance to its
// neighbour falls by half of that: by that root, with the edges' rates at the last search, which
// are exact, or by what the appearance of a part tells. For the blended rule, and where nothing
// varies along x.
#pragma once

#include "geometry/patch.hpp"

namespace railpatch {

class joining {
 public:
  // Of parts k and k + 1 as they were found.
  joining(const side_geometry &side, const part_set &found, int k);
  // Of a part that appears, and its neighbour.
  joining(const side_geometry &side, const blend_rules &rule, const appearance &found);

  // The parts of another search at the wheelset's place.
  void add(const side_geometry &side, const part &a, const part &b);
  // The measure of patch_parts.hpp at z: from 0, apart, to 1.
  double joined(const blend_rules &rule, double z) const;
  // m, z at which there are two parts.
  double appears() const { return appears_; }
  // m, arc length on the wheel inside of a part at any z of interest.
  double inside(int part) const { return inside_[part]; }

 private:
  struct node {
    double root = 0;                           // m^0.5, of how far the part has sunk in
    double distance = 0, width = 0;            // m
    double distance_rate = 0, width_rate = 0;  // of these by the root
  };
  double root(double z) const;

  double inside_[2] = {0, 0}, angle_[2] = {0, 0};
  double appears_ = 0, merges_ = 0;
  int nodes_ = 0;  // that were found by searches, the last one first; 0: one that is estimated
  node node_[2];
};

}  // namespace railpatch
