// A caller's wish to end a step, asked for between iterations. Who is told yes leaves by an
// exception that only the C interface catches: what was solved so far is no result.
#pragma once

namespace railpatch {

struct interrupted {};

class interrupt {
 public:
  using callback = int (*)(void *user);
  interrupt() = default;
  interrupt(callback ask, void *user) : ask_(ask), user_(user) {}
  void check() const {
    if (ask_ && ask_(user_) != 0) throw interrupted{};
  }

 private:
  callback ask_ = nullptr;
  void *user_ = nullptr;
};

}  // namespace railpatch
