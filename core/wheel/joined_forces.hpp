// What the vertical force of a wheel will be at heights between those that were solved, where two
// neighbouring parts of its contact become one patch.
//
// There the force is (1 - joined) apart + joined together: that of both divisions into patches, by
// the measure of patch_parts.hpp. It goes from 0 to 1 within less than a micrometre, steeply but by
// geometry alone, while the force of a division changes with depth as that of any contact. So what
// was solved tells the force of each division, and geometry how much each counts.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "geometry/joining.hpp"
#include "numeric/force_search.hpp"
#include "wheel/wheel_contact.hpp"

namespace railpatch {

// The force of one division by depth, from the last two depths that it was solved at. That of parts
// as one goes with the width of the part that appeared at `from`, the root of how far it has sunk
// in; that of patches of their own goes with depth.
class division_force {
 public:
  void begin(double from) {
    count_ = 0;
    from_ = from;
  }
  void add(double depth, double force);
  bool known() const { return count_ > 0; }
  double at(double depth) const;

 private:
  double measure(double depth) const;

  int count_ = 0;
  double from_ = 0;                               // m; 0: not by a root
  double depth_[2] = {0, 0}, force_[2] = {0, 0};  // the last one first
};

class joined_forces {
 public:
  // After the wheel was solved at touch + depth.
  void add(double touch, double depth, const wheel_contact &wheel);
  // Looks for parts that appear between two depths.
  void look_between(double touch, double low, double high, const wheel_contact &wheel);
  // Whether two parts are being joined, and both divisions' forces are known.
  bool joins() const { return pair_ && apart_.known() && joined_.known(); }
  double force(double depth, const wheel_contact &wheel) const;

 private:
  void take(const joining &pair, const wheel_contact &wheel);

  struct sample {
    double depth = 0, force = 0;
  };
  std::optional<joining> pair_;
  bool looked_ = false;
  double touch_ = 0;  // m, of z
  division_force apart_, joined_, whole_;
  std::size_t count_ = 0;
  std::array<sample, force_search::most_steps> samples_;
};

}  // namespace railpatch
