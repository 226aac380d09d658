#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace sandhopper {

// Lines on their way to a reader who may be slow, stopped or gone: whoever says something never waits for
// him. A thread of its own writes them to the descriptor, and only as much as it takes at once. Of the status
// only the newest is kept; of other lines, the first kMost that are not yet read, the rest is counted and the
// number told in their place.
class Outbox {
 public:
  static constexpr std::size_t kMost = 4096;

  explicit Outbox(int fd);
  // Gives the reader `patience` to take what is left, then leaves it.
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void put(std::string line);
  void put_status(std::string line);

 private:
  static constexpr int kPatience_ms = 2000;
  static constexpr int kLook_ms = 50;

  bool next(std::string& line);
  bool write_all(const std::string& line);
  void run();

  int fd_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> lines_;
  std::string status_;  // empty: none
  std::uint64_t lost_ = 0;
  bool ending_ = false;
  std::int64_t give_up_ns_ = INT64_MAX;
  std::thread thread_;
};

}  // namespace sandhopper
