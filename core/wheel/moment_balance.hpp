// Search for the balance of a wheelset: one or two unknowns, each with a condition that falls as it
// rises, by Newton's method.
//
// Roll angle and roll moment, pitch rate and torque about the axle: rolling to one side loads the
// wheel there, which turns the wheelset back; turning forward faster than it rolls drives it ahead,
// and brakes the axle. Slopes are exact where the contacts give them; else they are found by
// differences and corrected by Broyden's rule (Broyden 1965, Math. Comp. 19, eq. 4.5). A step is no
// longer than a limit, within which the contacts stay much alike; an unknown that would go farther,
// or whose own slope has the wrong sign (a wheel without contact, saturated creep forces), goes by
// its limit to the side that its condition tells. A limit is halved where its step went past the
// zero, which is bisection where the conditions have kinks. Other steps have to make the greatest
// residual smaller, and are halved until they do.
#pragma once

#include <array>

namespace railpatch {

using balance_pair = std::array<double, 2>;
using balance_slope = std::array<balance_pair, 2>;  // [condition][unknown]

// The wheelset as its balance needs it.
class balanced_wheelset {
 public:
  virtual ~balanced_wheelset() = default;
  // Solves the contacts; each condition over its scale; false: not known there.
  virtual bool evaluate(const balance_pair &unknown, balance_pair &residual) = 0;
  // Exact slopes at the state that evaluate() solved last; false: there are none.
  virtual bool slopes(balance_slope &slope) = 0;
};

struct balance_search {
  int count = 1;                  // of unknowns
  balance_pair start{}, limit{};  // longest steps, > 0
  double goal = 0;                // greatest residual aimed at
  double tolerance = 0;           // that counts as found where no step comes nearer
};

struct balance_outcome {
  bool known = false, converged = false;
  balance_pair unknown{};  // the state solved last
  double residual = 0;
};

balance_outcome find_balance(balanced_wheelset &wheelset, const balance_search &search);

}  // namespace railpatch
