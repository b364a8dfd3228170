// What stands around a call of the library: errors as exceptions, the time of its stages, Python's
// signals, locks.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <mutex>
#include <string>

#include "railpatch.h"

namespace railpatch::python {

namespace nb = nanobind;

// a call that the core refused
struct CallError {
  rp_error code;
  std::string text;
};

inline void check(rp_error code, const rp_message *message = nullptr) {
  if (code == RP_OK) return;
  const bool named = message != nullptr && message->text[0] != '\0';
  throw CallError{code, named ? message->text : rp_error_text(code)};
}

// time of each stage without that of the stages inside it
class StageClock {
 public:
  static void observe(void *user, rp_stage stage, int entering) {
    static_cast<StageClock *>(user)->turn(stage, entering != 0);
  }

  const double *seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;

  void turn(rp_stage stage, bool entering) {
    const auto now = Clock::now();
    if (depth_ > 0 && depth_ <= kDepth) {
      seconds_[open_[depth_ - 1]] += std::chrono::duration<double>(now - since_).count();
    }
    if (entering) {
      if (depth_ < kDepth) open_[depth_] = stage;
      ++depth_;
    } else if (depth_ > 0) {
      --depth_;
    }
    since_ = now;
  }

  static constexpr int kDepth = 16;
  double seconds_[RP_STAGE_COUNT] = {};
  rp_stage open_[kDepth] = {};
  int depth_ = 0;
  Clock::time_point since_;
};

// Asks Python's signal handlers now and then, while a call of the interpreter's own thread waits
// for the library with the interpreter's lock released.
class Signals {
 public:
  // As long as it lives the library asks.
  class Watch {
   public:
    explicit Watch(Signals &signals) : signals_(signals) {
      signals_.next_ = Clock::now() + kPause;
      signals_.watched_ = true;
    }
    ~Watch() { signals_.watched_ = false; }
    Watch(const Watch &) = delete;
    Watch &operator=(const Watch &) = delete;

   private:
    Signals &signals_;
  };

  static int ask(void *user) { return static_cast<Signals *>(user)->raised() ? 1 : 0; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPause{40};

  // a handler that raises leaves its exception with the interpreter
  bool raised() {
    if (!watched_) return false;
    const auto now = Clock::now();
    if (now < next_) return false;
    next_ = now + kPause;
    nb::gil_scoped_acquire locked;
    return PyErr_CheckSignals() != 0;
  }

  bool watched_ = false;
  Clock::time_point next_;
};

// A lock that is waited for without the interpreter's: who has it may be waiting for that one.
class Turn {
 public:
  explicit Turn(std::mutex &mutex) : guard_(mutex, std::defer_lock) {
    if (guard_.try_lock()) return;
    nb::gil_scoped_release unlocked;
    guard_.lock();
  }

 private:
  std::unique_lock<std::mutex> guard_;
};

}  // namespace railpatch::python
