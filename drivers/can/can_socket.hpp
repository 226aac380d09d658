#pragma once
#include <linux/can.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// Sees every frame of a socket, both ways, in the thread that sends or receives; must not block.
class CanTap {
 public:
  virtual ~CanTap() = default;
  virtual void on_frame(const can_frame& frame, std::int64_t monotonic_ns, bool sent) noexcept = 0;
};

struct ReceivedFrame {
  can_frame frame{};
  std::int64_t time_ns = 0;  // kernel's receive time, CLOCK_MONOTONIC
};

struct CanSocketCounters {
  std::uint32_t sent = 0;
  std::uint32_t received = 0;           // data frames
  std::uint32_t send_failures = 0;      // the queue was full or the interface down: never tried again
  std::uint32_t receive_overflows = 0;  // frames the kernel dropped because nobody read (SO_RXQ_OVFL)
  std::uint32_t error_frames = 0;
  bool bus_off = false;  // latched

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("sent", self.sent);
    visit("received", self.received);
    visit("send_failures", self.send_failures);
    visit("receive_overflows", self.receive_overflows);
    visit("error_frames", self.error_frames);
    visit("bus_off", self.bus_off);
  }
};

// Passes exactly one data-frame identifier: extended and remote frames of the same number do not match.
can_filter exact_standard_id(canid_t id) noexcept;
can_filter exact_extended_id(canid_t id) noexcept;

// A raw SocketCAN socket for a 1 kHz cycle: non-blocking, own frames not received, loopback on so that
// candump on the same host sees them, error frames of the controller received and counted.
class CanSocket {
 public:
  // Throws DeviceError when the interface is missing or down.
  CanSocket(const std::string& interface, std::span<const can_filter> filters);
  ~CanSocket();

  void set_tap(CanTap* tap) noexcept { tap_ = tap; }

  // The time of sending, or nothing when the kernel did not take the frame.
  std::optional<std::int64_t> send(const can_frame& frame) noexcept;

  // Everything that has arrived, oldest first, in batches: on_frame(const ReceivedFrame&). Ends when the
  // socket is empty, or after kMaxBatches so that a babbling node cannot hold the cycle.
  template <class OnFrame>
  void drain(OnFrame&& on_frame) noexcept {
    for (int i = 0; i < kMaxBatches; ++i) {
      const auto batch = receive_batch();
      for (const auto& received : batch) on_frame(received);
      if (batch_was_last_) return;
    }
  }

  // Waits until something can be read. Not for the cycle.
  bool wait(std::int64_t timeout_ns) const noexcept;

  const CanSocketCounters& counters() const noexcept { return counters_; }

 private:
  static constexpr int kMaxBatches = 64;
  struct Batch;

  std::span<const ReceivedFrame> receive_batch() noexcept;
  void count_error(const can_frame& frame) noexcept;

  UniqueFd fd_;
  CanTap* tap_ = nullptr;
  CanSocketCounters counters_{};
  std::unique_ptr<Batch> batch_;
  bool batch_was_last_ = true;
};

}  // namespace sandhopper
