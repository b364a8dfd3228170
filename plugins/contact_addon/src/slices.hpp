// Profiles by slices: .slcs along the track, .slcw round the wheel. Read as
// railpatch/inp/profiles.py does, matched knot by knot as railpatch/profiles/sections.py.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "profile.hpp"

namespace railpatch {
class profile_sections;
}

namespace contact_addon {

struct profile_slices {
  std::vector<double> place;                  // m along the track, rad round the wheel
  std::vector<profile_curve> curve;           // as read
  std::vector<std::vector<double>> features;  // m, of each: none, or as many for all
  profile_points first;                       // of the first

  bool empty() const { return place.empty(); }
  bool featured() const { return !features.empty() && !features.front().empty(); }
};

// A body's slices with knots that belong together, and what the core does between them.
struct matched_slices {
  std::vector<double> place;
  std::vector<profile_curve> curve;
  std::vector<int32_t> kink;
  // the core's own blend, for what is asked of a profile at a place
  std::shared_ptr<railpatch::profile_sections> blend;
  profile_curve now;
  double now_at = 0;

  std::vector<rp_profile> views() const;
};

bool names_slices(const std::string &path);
// Raises profile_error.
profile_slices read_slices(const std::string &path, const profile_options &options);
// by_knot: features somewhere in the case; cubic: more than one slice somewhere. Raises
// profile_error.
matched_slices match_slices(const profile_slices &slices, profile_role role, bool by_knot,
                            bool cubic);
// The profile at a place; kept until another is asked for.
const profile_curve &slice_at(matched_slices &slices, double place);

}  // namespace contact_addon
