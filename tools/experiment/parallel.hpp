#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sandhopper {

inline unsigned processors() { return std::max(1u, std::thread::hardware_concurrency()); }

// Calls work(i) once for every i in [0, total) on `threads` threads, and progress(done, total) from one
// thread at a time. The result of work(i) must depend on i only; then the result is independent of the number
// of threads. After the first exception no further work begins and the exception is rethrown.
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
  {
    std::vector<std::jthread> pool;
    for (long t = 1; t < std::min<long>(threads, total); ++t) pool.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

// The same on all processors.
inline void parallel_for(std::size_t total, const std::function<void(std::size_t)>& work) {
  parallel_for(static_cast<long>(total), processors(), [&](long i) { work(static_cast<std::size_t>(i)); });
}

}  // namespace sandhopper
