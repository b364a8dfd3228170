// What a handle keeps for the derivatives of its last step, in scenes that ask for them.
#pragma once

#include <memory>

#include "contact.hpp"

namespace railpatch {

struct derivative_record {
  // count: elements of a patch's grid, kind RP_PATCH.
  derivative_record(const rp_config &config, const patch_scene &scene, size_t count);

  bool solved = false;  // there is a last step
  rp_input input{};
  rp_result result{};
  patch_problem problem;                          // kind RP_PATCH
  aligned_buffer<double> distance, row_friction;  // rates
  // handles for differences, where the derivatives are not exact: one that makes the steps beside
  // the last one, and where a step depends on the one before the state that the last one began with
  std::unique_ptr<contact> beside, before;
  size_t bytes() const;
};

}  // namespace railpatch
