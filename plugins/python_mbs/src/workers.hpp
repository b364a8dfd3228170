// Threads that share the items of a task. Items must not depend on each other, then neither do
// results on the number of threads or on which thread took which item. Where there is a processor
// for each, threads stay awake for a while after a task, as one that sleeps takes longer to come
// back than a vehicle's step leaves.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace railpatch::python {

// s, CPU time of this thread; where the system has no such clock, of any
double thread_seconds();

class Workers {
 public:
  // threads: >= 1, of which the caller is one: 1 makes none. Raises std::system_error where the
  // system has none left.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers &) = delete;
  Workers &operator=(const Workers &) = delete;

  // task(0) ... task(count - 1), each once; returns when all are done. task must not throw.
  void run(size_t count, const std::function<void(size_t)> &task);

  // s, CPU time of the threads beside the caller's, up to tasks that have ended, without that in
  // which they stayed awake
  double seconds();

 private:
  void stop();
  void wait_for_tasks();
  void take_items();
  template <class F>
  void stay_awake(F until) const;

  const long process_;
  const bool awake_;  // threads stay so
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  const std::function<void(size_t)> *task_ = nullptr;
  size_t count_ = 0, next_ = 0, asleep_ = 0;
  std::atomic<size_t> open_{0}, round_{0};
  std::atomic<bool> stop_{false};
  double seconds_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace railpatch::python
