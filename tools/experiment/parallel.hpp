#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sandhopper {

// work(i) for every i in [0, total), on `threads` threads, each i once; progress(done, total) from one thread
// at a time. What work(i) leaves behind must depend on i alone, then the answer does not depend on the number
// of threads.
inline void parallel_for(long total, unsigned threads, const std::function<void(long)>& work,
                         const std::function<void(long, long)>& progress = {}) {
  std::atomic<long> next{0};
  std::mutex report;
  long done = 0;
  const auto run = [&] {
    for (long i = next++; i < total; i = next++) {
      work(i);
      const std::lock_guard lock(report);
      ++done;
      if (progress) progress(done, total);
    }
  };
  std::vector<std::jthread> pool;
  for (unsigned t = 1; t < threads; ++t) pool.emplace_back(run);
  run();
}

}  // namespace sandhopper
