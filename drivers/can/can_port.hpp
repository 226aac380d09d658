#pragma once
#include <linux/can.h>

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/samples.hpp"

namespace sandhopper {

// Sees every frame of a port, both ways, in the thread that sends or receives; must not block.
class CanTap {
 public:
  virtual ~CanTap() = default;
  virtual void on_frame(const can_frame& frame, std::int64_t monotonic_ns, bool sent) noexcept = 0;
  // The transmit guard kept this frame from being sent.
  virtual void on_refused(const can_frame&, std::int64_t /*monotonic_ns*/) noexcept {}
};

struct ReceivedFrame {
  can_frame frame{};
  std::int64_t time_ns = 0;  // kernel's receive time, CLOCK_MONOTONIC
};

struct CanCounters {
  std::uint32_t sent = 0;
  std::uint32_t received = 0;           // data frames
  std::uint32_t send_failures = 0;      // not taken by the kernel, or held back: never tried again
  std::uint32_t receive_overflows = 0;  // dropped because nobody read (SO_RXQ_OVFL), or by the controller
  std::uint32_t error_frames = 0;       // all of the following
  std::uint32_t no_acknowledge = 0;
  std::uint32_t errors = 0;           // protocol, transceiver, transmit time-out or overflow
  BusState state = BusState::active;  // off is latched

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("sent", self.sent);
    visit("received", self.received);
    visit("send_failures", self.send_failures);
    visit("receive_overflows", self.receive_overflows);
    visit("error_frames", self.error_frames);
    visit("no_acknowledge", self.no_acknowledge);
    visit("errors", self.errors);
    visit("state", self.state);
  }
};

// What an error frame (CAN_ERR_FLAG) says, into the counters: linux/can/error.h. Bus-off stays until the
// program is started again; the interface is never restarted by it.
void count_error_frame(const can_frame& frame, CanCounters& counters) noexcept;

// A place on a CAN bus for a 1 kHz cycle: nothing here waits, except pause().
class CanPort {
 public:
  virtual ~CanPort() = default;

  // Before a cycle's frames. If frames of the cycle before have not left yet, none of this cycle is taken: at
  // most one cycle's frames ever wait in the queue, so that a bus that heals does not let out a row of old
  // torques.
  virtual void begin_cycle() noexcept = 0;

  // The time of sending, or nothing when the frame was not taken. It is counted and not tried again.
  virtual std::optional<std::int64_t> send(const can_frame& frame) noexcept = 0;

  // Up to one batch of what has arrived, oldest first; `more` is false when the port is empty.
  virtual std::span<const ReceivedFrame> receive(bool& more) noexcept = 0;

  // Nothing that was sent waits to leave any more, as far as the port can tell.
  virtual bool settled() const noexcept { return true; }

  // Not for the cycle: lets time pass; and waits until something can be read, false if nothing came.
  virtual void pause(std::int64_t duration_ns) noexcept = 0;
  virtual bool wait(std::int64_t timeout_ns) noexcept = 0;

  virtual const CanCounters& counters() const noexcept = 0;
  virtual void set_tap(CanTap* tap) noexcept = 0;

  // Everything that has arrived: on_frame(const ReceivedFrame&). Ends when the port is empty, or after
  // kMaxBatches so that a babbling node cannot hold the cycle.
  template <class OnFrame>
  void drain(OnFrame&& on_frame) noexcept {
    bool more = true;
    for (int i = 0; i < kMaxBatches && more; ++i)
      for (const auto& received : receive(more)) on_frame(received);
  }

 private:
  static constexpr int kMaxBatches = 64;
};

}  // namespace sandhopper
