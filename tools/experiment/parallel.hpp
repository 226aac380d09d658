#pragma once
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sandhopper {

inline unsigned processors() { return std::max(1u, std::thread::hardware_concurrency()); }

// Threads that stay for the whole process, so that short pieces of work need no new ones.
class Workers {
 public:
  static Workers& of_process() {
    static Workers workers;
    return workers;
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
  }

  // Runs `job`, which must not throw, on this thread and on up to `helpers` others at once; returns when all
  // have left it. Within a job, or while another thread has one, on this thread alone.
  void run(std::size_t helpers, const std::function<void()>& job) {
    if (helpers == 0 || in_job()) return job();
    const std::unique_lock alone(one_at_a_time_, std::try_to_lock);
    if (!alone) return job();
    {
      const std::lock_guard lock(mutex_);
      while (threads_.size() < helpers) threads_.emplace_back([this] { serve(); });
      job_ = &job;
      wanted_ = helpers;
    }
    wake_.notify_all();
    in_job() = true;
    job();
    in_job() = false;
    std::unique_lock lock(mutex_);
    wanted_ = 0;
    left_.wait(lock, [&] { return running_ == 0; });
  }

 private:
  Workers() = default;

  static bool& in_job() {
    thread_local bool value = false;
    return value;
  }

  void serve() {
    in_job() = true;
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return stop_ || wanted_ > 0; });
      if (stop_) return;
      --wanted_;
      ++running_;
      const auto* job = job_;
      lock.unlock();
      (*job)();
      lock.lock();
      if (--running_ == 0) left_.notify_one();
    }
  }

  std::mutex one_at_a_time_, mutex_;
  std::condition_variable wake_, left_;
  const std::function<void()>* job_ = nullptr;
  std::size_t wanted_ = 0, running_ = 0;
  bool stop_ = false;
  std::vector<std::jthread> threads_;  // last: they end before what they use
};

// work(i) for every i in [0, total), on `threads` threads, each i once; progress(done, total) from one thread
// at a time. What work(i) leaves behind must depend on i alone, then the answer does not depend on the number
// of threads. After a first exception nothing more is begun, and it is thrown again here.
inline void parallel_for(long total, unsigned threads, const std::function<void(long)>& work,
                         const std::function<void(long, long)>& progress = {}) {
  std::atomic<long> next{0};
  std::atomic<bool> stop{false};
  std::mutex report;
  std::exception_ptr failure;
  long done = 0;
  const auto run = [&] {
    for (long i = next++; i < total && !stop; i = next++) {
      try {
        work(i);
        const std::lock_guard lock(report);
        ++done;
        if (progress) progress(done, total);
      } catch (...) {
        const std::lock_guard lock(report);
        if (!failure) failure = std::current_exception();
        stop = true;
      }
    }
  };
  Workers::of_process().run(static_cast<std::size_t>(std::max(0L, std::min<long>(threads, total) - 1)), run);
  if (failure) std::rethrow_exception(failure);
}

// On every processor.
inline void parallel_for(std::size_t total, const std::function<void(std::size_t)>& work) {
  parallel_for(static_cast<long>(total), processors(), [&](long i) { work(static_cast<std::size_t>(i)); });
}

}  // namespace sandhopper
