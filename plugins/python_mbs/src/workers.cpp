// Threads that share the items of a task; see workers.hpp.

#include "workers.hpp"

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

#include <chrono>
#include <ctime>

namespace railpatch::python {

double thread_seconds() {
#ifdef CLOCK_THREAD_CPUTIME_ID
  timespec now;
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0) return now.tv_sec + 1e-9 * now.tv_nsec;
#endif
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

namespace {

long process_number() {
#if defined(__unix__) || defined(__APPLE__)
  return static_cast<long>(getpid());
#else
  return 0;
#endif
}

}  // namespace

Workers::Workers(int threads)
    : process_(process_number()),
      awake_(static_cast<unsigned>(threads) <= std::thread::hardware_concurrency()) {
  try {
    for (int k = 1; k < threads; ++k) threads_.emplace_back([this] { wait_for_tasks(); });
  } catch (...) {
    stop();
    throw;
  }
}

Workers::~Workers() { stop(); }

// Others that want the processor get it meanwhile.
template <class F>
void Workers::stay_awake(F until) const {
  constexpr std::chrono::microseconds long_enough{300};
  const auto begin = std::chrono::steady_clock::now();
  while (awake_ && !until() && std::chrono::steady_clock::now() - begin < long_enough)
    std::this_thread::yield();
}

void Workers::stop() {
  // threads stay behind in the process that a fork came from
  if (process_number() != process_) {
    for (std::thread &thread : threads_) thread.detach();
    return;
  }
  {
    std::lock_guard<std::mutex> guard(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (std::thread &thread : threads_) thread.join();
}

void Workers::run(size_t count, const std::function<void(size_t)> &task) {
  if (threads_.empty()) {
    for (size_t k = 0; k < count; ++k) task(k);
    return;
  }
  bool asleep = false;
  {
    std::lock_guard<std::mutex> guard(mutex_);
    task_ = &task;
    count_ = count;
    open_ = count;
    next_ = 0;
    ++round_;
    asleep = asleep_ > 0;
  }
  if (asleep) begin_.notify_all();
  take_items();
  stay_awake([this] { return open_ == 0; });
  std::unique_lock<std::mutex> lock(mutex_);
  end_.wait(lock, [this] { return open_ == 0; });
  task_ = nullptr;
}

double Workers::seconds() {
  std::lock_guard<std::mutex> guard(mutex_);
  return seconds_;
}

void Workers::wait_for_tasks() {
  size_t seen = 0;
  const auto called = [&] { return stop_ || round_ != seen; };
  while (true) {
    stay_awake(called);
    {
      std::unique_lock<std::mutex> lock(mutex_);
      ++asleep_;
      begin_.wait(lock, called);
      --asleep_;
      if (stop_) return;
      seen = round_;
    }
    const double begin = thread_seconds();
    take_items();
    const double spent = thread_seconds() - begin;
    std::lock_guard<std::mutex> guard(mutex_);
    seconds_ += spent;
  }
}

// items are few and long: one lock for all will do
void Workers::take_items() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (task_ != nullptr && next_ < count_) {
    const size_t k = next_++;
    const std::function<void(size_t)> *task = task_;
    lock.unlock();
    (*task)(k);
    lock.lock();
    if (--open_ == 0) end_.notify_one();
  }
}

}  // namespace railpatch::python
