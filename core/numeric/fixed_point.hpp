// Fixed points x = g(x) of maps that cost much more than a few sums over x: Anderson's method
// (1965, J. ACM 12; Walker and Ni 2011, SIAM J. Numer. Anal. 49, type II) over the last few steps.
//
// Safeguard: where the remainder |g(x) - x| grows beyond twice the least so far, the iteration goes
// back to the best point, forgets the past and takes a step half as long. A map whose Jacobian has
// eigenvalues with real parts below 1 contracts with steps short enough; as the remainder falls the
// steps grow again.
#pragma once

#include "numeric/memory.hpp"

namespace railpatch {

class fixed_point {
 public:
  explicit fixed_point(size_t max_count);
  void begin(size_t count);
  // x becomes the next point; gx = g(x).
  void advance(double *x, const double *gx);
  size_t bytes() const { return (2 * depth + 5) * last_x_.bytes(); }

 private:
  static constexpr int depth = 5;
  void remember(const double *x);
  int combine(double weight[depth]) const;

  size_t n_ = 0;
  int kept_ = 0, next_ = 0;  // differences, and the place of the next one
  double damping_ = 1, best_size_ = 0;
  bool started_ = false;
  aligned_buffer<double> remainder_, last_x_, last_remainder_, best_x_, best_remainder_;
  aligned_buffer<double> dx_[depth], df_[depth];
};

}  // namespace railpatch
