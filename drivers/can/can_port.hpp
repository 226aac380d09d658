#pragma once
#include <linux/can.h>

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/samples.hpp"

namespace sandhopper {

// Observer of every frame of a port, in both directions. Runs in the thread that sends or receives; must not
// block.
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
  std::uint32_t send_failures = 0;      // refused by the kernel or held back; not tried again
  std::uint32_t receive_overflows = 0;  // dropped because unread (SO_RXQ_OVFL), or by the controller
  std::uint32_t error_frames = 0;       // sum of all error frames, including those below
  std::uint32_t no_acknowledge = 0;
  std::uint32_t errors = 0;           // protocol, transceiver, transmit time-out or overflow
  BusState state = BusState::active;  // off is latched until the program restarts

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

// Counts an error frame (CAN_ERR_FLAG, linux/can/error.h). Bus-off stays until the program is restarted; the
// program never restarts the interface.
void count_error_frame(const can_frame& frame, CanCounters& counters) noexcept;

// Access to a CAN bus for a 1 kHz cycle: no function waits, except pause() and wait().
class CanPort {
 public:
  virtual ~CanPort() = default;

  // Call it before a cycle's frames. If frames of the previous cycle have not left yet, send() takes no frame
  // of this cycle. So at most one cycle's frames wait in the queue, and a bus that recovers does not send a
  // series of old torques.
  virtual void begin_cycle() noexcept = 0;

  // Returns the time of sending, or nothing if the frame was not taken. A refused frame is counted and not
  // tried again.
  virtual std::optional<std::int64_t> send(const can_frame& frame) noexcept = 0;

  // Returns up to one batch of received frames, oldest first; `more` is false when the port is empty.
  virtual std::span<const ReceivedFrame> receive(bool& more) noexcept = 0;

  // True if no sent frame is still waiting to leave, as far as the port can tell.
  virtual bool settled() const noexcept { return true; }

  // Outside the cycle only. pause() sleeps. wait() waits until a frame can be read; false if none came.
  virtual void pause(std::int64_t duration_ns) noexcept = 0;
  virtual bool wait(std::int64_t timeout_ns) noexcept = 0;

  virtual const CanCounters& counters() const noexcept = 0;
  virtual void set_tap(CanTap* tap) noexcept = 0;

  // Calls on_frame(const ReceivedFrame&) for every received frame. Ends when the port is empty, or after
  // kMaxBatches, so that a node that floods the bus cannot delay the cycle.
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
