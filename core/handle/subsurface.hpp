// Stresses below a patch of a handle's last step, as rp_solve_subsurface gives them.
#pragma once

#include <vector>

#include "half_space/below_surface.hpp"
#include "half_space/stress_measures.hpp"
#include "handle/contact.hpp"
#include "railpatch.h"

namespace railpatch {

class subsurface {
 public:
  // The config has been checked against the contact's; throws std::bad_alloc.
  subsurface(const rp_subsurface_config &config, const contact &of);

  // RP_ERROR_NO_FIELD: no such patch, or it has no elements.
  rp_error solve(const contact &of, int side, int patch, int body);
  rp_error field(rp_subsurface_field name, double *values, size_t *count);
  // Points (x, y, depth), m, [count][3]; values: stresses and displacements, [count][9].
  static rp_error at(const contact &of, int side, int patch, int body, const double *points,
                     size_t count, double *values);
  size_t bytes() const;

 private:
  struct patch_view;
  void spread(const patch_view &view);
  void give(rp_subsurface_field name, double *values);
  stress_tensor stress(size_t at, size_t points) const;

  std::vector<double> depths_;
  double dang_van_;
  fft_plans plans_;
  below_surface below_[2];  // of the wheel, of the rail
  dang_van_cycle cycle_;
  grid grid_;
  int components_ = 0;
  bool solved_ = false;
  double sign_[below::components] = {};  // of each component as it is handed out
  bool mirrored_ = false;
  aligned_buffer<double> load_[3], found_;
};

}  // namespace railpatch
