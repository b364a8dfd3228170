// How the statuses of parts join to that of the whole.
#pragma once

#include "numeric/nan.hpp"
#include "railpatch.h"

namespace railpatch {

// How a part of a step ended, and why it is not good.
struct verdict {
  rp_status status = RP_CONVERGED;
  rp_reason reason = RP_REASON_NONE;
  double reason_value = nan;
};

// Of one solution that several stages contribute to: the first that is not good stays. What takes
// it is a verdict or a result.
template <class Result>
void degrade(Result &so_far, rp_status status, rp_reason reason, double value = nan) {
  if (so_far.status != RP_CONVERGED || status == RP_CONVERGED) return;
  so_far.status = status;
  so_far.reason = reason;
  so_far.reason_value = value;
}
template <class Result, class Part>
void degrade(Result &so_far, const Part &part) {
  degrade(so_far, part.status, part.reason, part.reason_value);
}

// Of contacts beside each other, patches of a wheel, wheels or wheelsets: the worse where one is
// not good, else contact where one of them has contact.
inline rp_status combine_status(rp_status a, rp_status b) {
  if (a == RP_OUT_OF_RANGE || b == RP_OUT_OF_RANGE) return RP_OUT_OF_RANGE;
  if (a == RP_NOT_CONVERGED || b == RP_NOT_CONVERGED) return RP_NOT_CONVERGED;
  if (a == RP_WORK_SPENT || b == RP_WORK_SPENT) return RP_WORK_SPENT;
  if (a == RP_ACCURACY_NOT_MET || b == RP_ACCURACY_NOT_MET) return RP_ACCURACY_NOT_MET;
  return a == RP_CONVERGED || b == RP_CONVERGED ? RP_CONVERGED : RP_NO_CONTACT;
}

// The same with the reason of the one that gives the status.
template <class Result, class Part>
void combine(Result &so_far, const Part &part) {
  const rp_status joined = combine_status(so_far.status, part.status);
  if (joined != so_far.status) {
    so_far.reason = part.reason;
    so_far.reason_value = part.reason_value;
  }
  so_far.status = joined;
}

// Of rates that did not converge: what is good of the result is not of its rates.
template <class Result>
void fail_rates(Result &change) {
  if (change.status != RP_CONVERGED && change.status != RP_NO_CONTACT &&
      change.status != RP_ACCURACY_NOT_MET && change.status != RP_WORK_SPENT)
    return;
  change.status = RP_NOT_CONVERGED;
  change.reason = RP_REASON_DERIVATIVE;
  change.reason_value = nan;
}
// Of a wheel with all its patches.
inline void fail_rates_of_wheel(rp_side_result &side) {
  fail_rates(side);
  for (int i = 0; i < side.patch_count + side.alternative_count; ++i) fail_rates(side.patch[i]);
}

}  // namespace railpatch
