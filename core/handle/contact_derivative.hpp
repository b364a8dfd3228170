// What a handle keeps for the derivatives of its last step, in scenes that ask for them.
#pragma once

#include <memory>

#include "handle/contact.hpp"

namespace railpatch {

struct derivative_record {
  derivative_record(const rp_config &config, driver &driver);

  bool solved = false;  // there is a last step
  bool broken = false;  // the step beside it was interrupted
  rp_input input{};
  rp_result result{};
  // handles for differences, where the derivatives are not exact: one that makes the steps beside
  // the last one, and where a step depends on the one before the state that the last one began with
  std::unique_ptr<contact> beside, before;
  size_t bytes() const;
};

}  // namespace railpatch
