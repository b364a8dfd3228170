// Contact search: where wheel and rail interpenetrate, and the frame of each contact patch.
//
// Along the contact locus (geometry.hpp) the vertical gap is a function of the wheel's arc length.
// A stretch with negative gap is one part of contact. In each of its rows, at a lateral position
// y, the overlap is a parabola in x of depth d and curvature k, so the integral of its square over
// x is (16/15) d^2.5 / sqrt(k). With that weight the reference position and the contact angle are
// means over the rows: they move smoothly with the wheelset, and a part that appears or vanishes
// does so with weight zero.
//
// Parts close to each other share a patch. By the blended rule (patch_parts.hpp) several divisions
// into patches may count at once, each with its share. By the rule of the program CONTACT, so that
// results compare, the distance d between facing edges decides:
// up to `combine` they influence each other fully; up to `separate` by a factor
// ((separate - d)/(separate - combine))^0.8; up to `turn` they are patches of their own, with
// angles turned towards their weighted mean, by all at `separate`, by nothing at `turn`.
//
// A pure function of its inputs: no history, no allocation.
#pragma once

#include "geometry/geometry.hpp"
#include "geometry/patch_parts.hpp"

namespace railpatch {

struct patch_rules {
  bool blended = true;    // else by the distances below
  bool inclined = false;  // frames follow a roller's surface along x
  blend_rules blend;
  double combine = 4e-3, separate = 8e-3, turn = 12e-3;  // m
  double max_angle = 1.5707963267948966;  // rad, a greater difference always separates
  double coupling_exponent = 0.8;
};

struct patch_region {
  contact_frame frame;
  // bounds of the interpenetration in the frame; leave a margin of an element around them
  double x_min = 0, x_max = 0, s_min = 0, s_max = 0;  // m
  double weight = 0;                                  // of all rows, to compare patches
  double share = 1;                                   // that this solution has in the wheel's force
  place_slope angle_slope;                            // blended rule only
  double angle_rate[2] = {0, 0};                      // as basic_part has them
  bool at_profile_end = false;                        // cut off by the end of a profile
  // parts follow each other in s: between part k and k + 1 lies s = cut[k], and there tractions
  // on one side act on the other with the factor coupling[k]
  int first_part = 0, parts = 1;  // of those found on the wheel
  double cut[max_parts - 1] = {};
  double coupling[max_parts - 1] = {};
};

enum class search_status { contact, no_contact, out_of_range, too_many_patches };

struct search_result {
  search_status status = search_status::no_contact;
  int count = 0;  // patches written; where there are too many, those of greatest weight
  int lead = 0;   // of these, first: the division of greatest share, along the rail
};

// The parts of contact of one wheel, with their sums over rows, in the order of s.
struct part_set {
  int count = 0;
  bool overflow = false;  // there are more
  part parts[max_parts];
};

void find_parts(const side_geometry &side, part_set &found);
search_result find_patches(const side_geometry &side, const patch_rules &rules, part_set &found,
                           patch_region *out, int max_patches);

// A second part of contact that appears as the wheel goes down: beside another it soon belongs to
// one patch with that one, so that what the wheel carries rises within less than a micrometre.
struct appearance {
  double z = 0;          // m, of the wheelset, at which it appears
  double length = 0;     // m, of z, until it is one with its neighbour
  double at = 0;         // m, arc length on the wheel
  double neighbour = 0;  // m, from there to inside of the neighbour, > 0 along the arc length
  double bump = 0;       // m, greatest gap between both
};
// Those for which z lies between low and high: how many of `most` were written. Blended rule only.
int find_appearances(const side_geometry &side, const patch_rules &rules, double low, double high,
                     appearance *out, int most);

// The arc length on the wheel of the least gap between two, where it has one minimum.
double lowest_gap(const side_geometry &side, double begin, double end);

// The wheelset's z at which this wheel first touches; false where the profiles do not overlap.
bool first_touch(const side_geometry &side, double &z);

patch_region mirrored(patch_region p);

}  // namespace railpatch
