#pragma once
#include <memory>

#include "drivers/can/can_port.hpp"
#include "drivers/transmit_guard/transmit_guard.hpp"

namespace sandhopper {

// A port behind the transmit guard. A frame that breaks a rule does not reach the port. Its motor immediately
// gets a command without torque instead, unless the refused frame was an enter frame. send() returns nothing
// for the refused frame, and the port's own counters do not count it.
class GuardedPort final : public CanPort {
 public:
  GuardedPort(std::unique_ptr<CanPort> port, const transmit::Limits& limits) noexcept;

  // Call it before each cycle's frames. Before the first call only frames without torque and gains pass.
  void begin(const transmit::CycleState& state) noexcept { guard_.begin(state); }

  const RefusedFrames& refused() const noexcept { return refused_; }
  const transmit::TransmitGuard& guard() const noexcept { return guard_; }

  void begin_cycle() noexcept override;
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override;
  std::span<const ReceivedFrame> receive(bool& more) noexcept override;
  bool settled() const noexcept override { return port_->settled(); }
  void pause(std::int64_t duration_ns) noexcept override;
  bool wait(std::int64_t timeout_ns) noexcept override { return port_->wait(timeout_ns); }
  const CanCounters& counters() const noexcept override { return port_->counters(); }
  void set_tap(CanTap* tap) noexcept override;

 private:
  void refuse(const can_frame& frame, const transmit::TransmitGuard::Verdict& verdict) noexcept;

  std::unique_ptr<CanPort> port_;
  transmit::TransmitGuard guard_;
  RefusedFrames refused_{};
  CanTap* tap_ = nullptr;
};

}  // namespace sandhopper
