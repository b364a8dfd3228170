// The Hertzian contact of curvatures A (along rolling) and B (lateral) as two functions of A/B,
// tabulated at creation, for theories that ask for it row by row:
//   edge(A/B)     = A a^2 / approach, so that B b^2 / approach = edge(B/A)
//   pressure(A/B) = p0 / (E* A a), the peak pressure over the semi-axis
// Their logarithms are smooth in ln(A/B) and are interpolated by cubics; the table ends at 1e6 and
// 1e-6, beyond which the nearest value is taken.
#pragma once

#include "numeric/memory.hpp"

namespace railpatch {

class hertz_ratios {
 public:
  hertz_ratios();
  struct values {
    double edge_along, edge_across;  // -, edge(A/B), edge(B/A)
    double pressure;                 // -
  };
  values at(double curvature_along, double curvature_across) const;
  size_t bytes() const { return edge_.bytes() + pressure_.bytes(); }

 private:
  aligned_buffer<double> edge_, pressure_;  // logarithms
};

}  // namespace railpatch
