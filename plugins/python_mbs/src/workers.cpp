// Threads that share the items of a task; see workers.hpp.

#include "workers.hpp"

namespace railpatch::python {

Workers::Workers(int threads) {
  for (int k = 1; k < threads; ++k) threads_.emplace_back([this] { wait_for_tasks(); });
}

Workers::~Workers() {
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
  {
    std::lock_guard<std::mutex> guard(mutex_);
    task_ = &task;
    count_ = open_ = count;
    next_ = 0;
    ++round_;
  }
  begin_.notify_all();
  take_items();
  std::unique_lock<std::mutex> lock(mutex_);
  end_.wait(lock, [this] { return open_ == 0; });
  task_ = nullptr;
}

void Workers::wait_for_tasks() {
  size_t seen = 0;
  while (true) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      begin_.wait(lock, [&] { return stop_ || round_ != seen; });
      if (stop_) return;
      seen = round_;
    }
    take_items();
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
