// From what callers have set to a case of the core.
#pragma once

#include <string>

#include "problem.hpp"

namespace contact_addon {

// Why there is no such case; code: what the call answers then.
struct refusal {
  int code;
  std::string text;
};

// in_history: a step that goes on from the last one's tractions, or leaves them to the next, also
// of steady rolling. Raises refusal.
mapped_case map_case(const problem &p, bool in_history);
// Needs the case that was mapped. Raises refusal.
rp_input map_input(const problem &p, const mapped_case &mapped);
bool same_case(const mapped_case &a, const mapped_case &b);
// Takes a case of steady rolling for one whose regime changes.
void let_regime_change(rp_config &config);
// Coefficient of friction at rest, of the first set.
double static_friction(const problem &p);
// Of a basic problem's grid by an ellipse: semi-axes a, b (m) and A1, B1 (1/m) of it, by the core.
// Raises refusal.
struct ellipse {
  double a = 0, b = 0, A1 = 0, B1 = 0;
};
ellipse ellipse_of(const problem &p);

}  // namespace contact_addon
