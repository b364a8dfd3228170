// How the statuses of parts join to that of the whole.
#pragma once

#include "railpatch.h"

namespace railpatch {

// Of one solution that several stages contribute to: the first that is not good stays.
inline void degrade(rp_status &so_far, rp_status status) {
  if (so_far == RP_CONVERGED) so_far = status;
}

// Of contacts beside each other, patches of a wheel, wheels or wheelsets: the worse where one is
// not good, else contact where one of them has contact.
inline rp_status combine_status(rp_status a, rp_status b) {
  if (a == RP_OUT_OF_RANGE || b == RP_OUT_OF_RANGE) return RP_OUT_OF_RANGE;
  if (a == RP_NOT_CONVERGED || b == RP_NOT_CONVERGED) return RP_NOT_CONVERGED;
  if (a == RP_ACCURACY_NOT_MET || b == RP_ACCURACY_NOT_MET) return RP_ACCURACY_NOT_MET;
  return a == RP_CONVERGED || b == RP_CONVERGED ? RP_CONVERGED : RP_NO_CONTACT;
}

// Of rates that did not converge: what is good of the result is not of its rates.
inline void fail_rates(rp_status &status) {
  if (status == RP_CONVERGED || status == RP_NO_CONTACT || status == RP_ACCURACY_NOT_MET)
    status = RP_NOT_CONVERGED;
}
// Of a wheel with all its patches.
inline void fail_rates(rp_side_result &side) {
  fail_rates(side.status);
  for (int i = 0; i < side.patch_count + side.alternative_count; ++i)
    fail_rates(side.patch[i].status);
}

}  // namespace railpatch
