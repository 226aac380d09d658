#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace sandhopper {

// Output queue for a reader that may be slow, stopped or gone: the caller never waits for it. A thread of its
// own writes to the descriptor only as much as it accepts. Only the newest status line is kept. The first
// kMost other unread lines are kept; the rest is dropped, and a line reports their number.
class Outbox {
 public:
  static constexpr std::size_t kMost = 4096;

  explicit Outbox(int fd);
  // Gives the reader up to kPatience_ms to take the remaining lines.
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
