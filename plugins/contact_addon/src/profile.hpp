// Profiles for the core, from files and points: what railpatch.profiles does for Python, in the
// same order of operations, as callers of this interface hand over names of files. Smoothing is
// always said here, so nothing is sought in the noise of the points.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "railpatch.h"

namespace contact_addon {

// A profile that cannot be used: the text names file and line.
struct profile_error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct profile_points {
  std::vector<double> y, z, weight;  // m; from the flange or gauge side, z down once oriented
};

struct profile_curve {
  std::vector<double> arc_length, y, z, dy, dz;

  rp_profile view() const {
    return {arc_length.data(), y.data(),  z.data(),
            dy.data(),         dz.data(), static_cast<int32_t>(y.size())};
  }
  bool empty() const { return y.empty(); }
  // Position at an arc length, by the cubics; slope: also its direction (rad, y towards z).
  void at(double s, double &y_at, double &z_at, double &slope) const;
  // The arc length of the point nearest to y on the running surface, where z is least.
  double nearest(double y_at, double z_at) const;
};

enum class profile_role { wheel, rail };

struct profile_options {
  profile_role role = profile_role::wheel;
  double scale = 1.0;      // to mm, of files and points that do not say their unit
  double smoothing = 0.0;  // m, wave length of which half the amplitude is kept; 0: interpolation
  bool mirror_y = false;   // beside what a file says itself
  int mirror_z = 0;        // -1 no, 1 yes, 0 where the flange or the head's sides point up
};

// Slopes at the knots of the C2 cubic spline with those at its ends.
std::vector<double> slopes(const std::vector<double> &x, const std::vector<double> &y, double first,
                           double last);
// By content and extension: SIMPACK, MiniProf, two columns. Raises profile_error.
profile_points read_points(const std::string &path, const profile_options &options);
// Mirrored and turned round as asked, in place. Raises profile_error.
void orient(const std::string &name, const profile_options &options, profile_points &points);
// The smooth curve through or near oriented points. Raises profile_error.
profile_curve fit(const std::string &name, const profile_points &points, double smoothing);

}  // namespace contact_addon
