// How fine and how large the grids of contacts are.
#pragma once

#include "normal/hertz.hpp"

namespace railpatch {

struct grid_rules {
  bool sized = false;               // elements of a size, else as many across the contact
  double element_size[2] = {0, 0};  // m
  int elements[2] = {0, 0};
  int most[2] = {0, 0};  // where a grid of sized elements is to stay as it is; 0: not given
  // of unlike bodies' contact area, over Hertz's: tractions shift and stretch it; 1: they do not
  double reach = 1;
  double farthest = 0;  // that a grid may reach ahead of the contact, likewise; 0: not beyond reach
  bool interpenetrates = false;  // the theory's grid covers the virtual interpenetration
  bool corrected = false;        // which is that of Hertz's area
  bool force_given = true;

  // n elements across Hertz's contact and those to add on either side.
  int with_margin(int n) const;
  // And those to add ahead of it, that the grid reaches as far there as wanted, or may.
  int ahead_of(int n, double wanted) const;
  // Half of what the theory's grid must cover along axis k, over Hertz's semi-axis.
  double relative_size(const hertz_contact &hertz, int k) const;
};

}  // namespace railpatch
