// What a material point's stress is judged by. A stress is (xx, yy, zz, xy, yz, zx), tension > 0.
#pragma once

#include <array>

#include "numeric/memory.hpp"

namespace railpatch {

using stress_tensor = std::array<double, 6>;

// Pa, from the greatest (Smith 1961, Comm. ACM 4, 168).
std::array<double, 3> principal_stresses(const stress_tensor &s);
// Pa (von Mises 1913).
double von_mises_stress(const stress_tensor &s);
// Pa, half the difference of the outer principal stresses.
double greatest_shear(const stress_tensor &s);

// The equivalent stress of Dang Van's criterion along a cycle of stress:
//   max over the cycle of tau + a sigma_h,   sigma_h the mean of the normal stresses,
// tau the greatest shear of the deviator less that of the shakedown state, which is the middle of
// the smallest ball around the deviators of the cycle (Dang Van, Griveau, Message 1989; Ekberg,
// Kabo, Andersson 2002, Fatigue Fract. Engng Mater. Struct. 25). The ball by Frank and Wolfe's
// method with steps away (Yildirim 2008, SIAM J. Optim. 19).
class dang_van_cycle {
 public:
  explicit dang_van_cycle(int most_states);
  void clear() { count_ = 0; }
  void add(const stress_tensor &s);
  // Pa; 0 of an empty cycle
  double equivalent(double a);
  size_t bytes() const { return state_.bytes() + point_.bytes() + weight_.bytes(); }

 private:
  using deviator = std::array<double, 6>;  // shears times root 2: lengths are tensors' norms
  deviator middle();

  int count_ = 0;
  aligned_buffer<stress_tensor> state_;
  aligned_buffer<deviator> point_;
  aligned_buffer<double> weight_;
};

}  // namespace railpatch
