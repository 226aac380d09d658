#pragma once
#include <linux/can.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace sandhopper {

// Which frames have left for the bus. A controller may hold several cycles' frames that the kernel no longer
// counts; each comes back as an echo when it was sent (CAN_RAW_RECV_OWN_MSGS), and while one is overdue none
// should follow. A later frame's echo settles the earlier ones: a one-shot controller drops what lost
// arbitration. After kGiveUp_ns an echo is not waited for any more: by then the cycle has found its commands
// refused and sends only what takes the torque away, which is to stand right behind what is held.
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
  // Whether a frame sent earlier is overdue, so that none should follow it.
  bool holds(std::int64_t now_ns) noexcept {
    while (waiting_ > 0 && now_ns - entries_[0].sent_ns > kGiveUp_ns) give_up_oldest();
    return waiting_ > 0 && now_ns - entries_[0].sent_ns > kPatience_ns;
  }
  std::size_t waiting() const noexcept { return waiting_; }
  // Every frame sent has left, or one sent after it has: nothing old can still leave.
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
  bool given_up_ = false;  // on an echo, and none of a later frame has come since
};

}  // namespace sandhopper
