// Marks of the stages of a step, as a handle's observer sees them: entered where a mark is made,
// left where it goes.
#pragma once

#include "railpatch.h"

namespace railpatch {

class stage_mark {
 public:
  stage_mark(rp_observer observer, void *user, rp_stage stage)
      : observer_(observer), user_(user), stage_(stage) {
    if (observer_) observer_(user_, stage_, 1);
  }
  ~stage_mark() {
    if (observer_) observer_(user_, stage_, 0);
  }
  stage_mark(const stage_mark &) = delete;
  stage_mark &operator=(const stage_mark &) = delete;

 private:
  rp_observer observer_;
  void *user_;
  rp_stage stage_;
};

struct stage_marks {
  rp_observer observer = nullptr;
  void *user = nullptr;
  [[nodiscard]] stage_mark enter(rp_stage stage) const { return {observer, user, stage}; }
};

}  // namespace railpatch
