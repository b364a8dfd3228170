// What a handle keeps for the derivatives of its last step, in scenes that ask for them.
#pragma once

#include <memory>

#include "handle/contact.hpp"

namespace railpatch {

struct derivative_record {
  // exact: what is around the patches is no obstacle to exact derivatives; max_nx, max_ny: of the
  // greatest grid.
  derivative_record(const rp_config &config, const patch_scene &scene, bool exact, int max_nx,
                    int max_ny);

  bool solved = false;  // there is a last step
  rp_input input{};
  rp_result result{};
  patch_problem problem;                          // kind RP_PATCH
  aligned_buffer<double> distance, row_friction;  // rates
  std::unique_ptr<wheel_derivative> wheels;       // wheel kinds, where exact
  std::vector<rp_side_result> changes;            // [side][direction]
  // handles for differences, where the derivatives are not exact: one that makes the steps beside
  // the last one, and where a step depends on the one before the state that the last one began with
  std::unique_ptr<contact> beside, before;
  size_t bytes() const;
};

}  // namespace railpatch
