#pragma once
#include <linux/can.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace sandhopper {

// Records which sent frames have left for the bus. A controller may hold frames of several cycles, which the
// kernel no longer counts. Each frame comes back as an echo after it was sent (CAN_RAW_RECV_OWN_MSGS). While
// an echo is overdue no frame should follow. An echo also settles all earlier frames, because a one-shot
// controller drops a frame that lost arbitration. After kGiveUp_ns the ledger stops waiting for an echo. By
// then the cycle has seen its commands refused and sends only frames that take the torque away; these should
// be queued right behind the held frames.
class DepartureLedger {
 public:
  static constexpr std::int64_t kPatience_ns = 1'500'000;  // a cycle and a half
  static constexpr std::int64_t kGiveUp_ns = 10'000'000;

  void sent(canid_t id, std::int64_t now_ns) noexcept {
    if (waiting_ == entries_.size()) give_up_oldest();
    entries_[waiting_++] = {id, now_ns};
  }
  void departed(canid_t id) noexcept {
    for (std::size_t i = 0; i < waiting_; ++i)
      if (entries_[i].id == id) {
        given_up_ = false;
        return forget(i + 1);
      }
  }
  // True if a frame sent earlier is overdue, so that none should follow it.
  bool holds(std::int64_t now_ns) noexcept {
    while (waiting_ > 0 && now_ns - entries_[0].sent_ns > kGiveUp_ns) give_up_oldest();
    return waiting_ > 0 && now_ns - entries_[0].sent_ns > kPatience_ns;
  }
  std::size_t waiting() const noexcept { return waiting_; }
  // True if every sent frame, or a frame sent after it, has left: no old frame can still leave.
  bool settled() const noexcept { return waiting_ == 0 && !given_up_; }

 private:
  struct Entry {
    canid_t id = 0;
    std::int64_t sent_ns = 0;
  };
  void give_up_oldest() noexcept {
    given_up_ = true;
    forget(1);
  }
  void forget(std::size_t count) noexcept {
    for (std::size_t i = count; i < waiting_; ++i) entries_[i - count] = entries_[i];
    waiting_ -= count;
  }

  std::array<Entry, 16> entries_{};  // oldest first
  std::size_t waiting_ = 0;
  bool given_up_ = false;  // stopped waiting for an echo, and no echo of a later frame has come since
};

}  // namespace sandhopper
