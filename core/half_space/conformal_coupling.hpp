// Coupling of the normal and the tangential directions of like bodies where the reference surface
// is curved: rows of different inclination move each other along and apart
// (conformal_influence.hpp).
#pragma once

#include "half_space/coupling_operator.hpp"

namespace railpatch {

class conformal_coupling final : public coupling_operator {
 public:
  // The influence keeps the grid and its rows; it must outlive this object.
  conformal_coupling(influence &a, int max_count);

  bool set_grid(const grid &g) override;
  // offset: 0, or one element to either side
  void from_pressure(double offset, const double *p, double *ux, double *uy) override;
  void from_traction(const double *px, const double *py, double *un) override;
  size_t bytes() const override { return 2 * slip_[0].bytes(); }

 private:
  influence &a_;
  grid grid_;
  aligned_buffer<double> slip_[2];
};

}  // namespace railpatch
