#pragma once
#include <linux/can.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "drivers/can/can_port.hpp"
#include "drivers/can/departure_ledger.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// Passes exactly one data-frame identifier: extended and remote frames of the same number do not match.
can_filter exact_standard_id(canid_t id) noexcept;
can_filter exact_extended_id(canid_t id) noexcept;

// A raw SocketCAN socket: non-blocking, own frames received as echoes only, which say that they have left
// (pass their identifiers, too; with no filters at all there are none), loopback on so that candump sees
// them, error frames of the controller received and counted.
class CanSocket : public CanPort {
 public:
  // Throws DeviceError when the interface is missing or down.
  CanSocket(const std::string& interface, std::span<const can_filter> filters);
  ~CanSocket() override;

  void begin_cycle() noexcept override;
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override;
  std::span<const ReceivedFrame> receive(bool& more) noexcept override;
  bool settled() const noexcept override { return ledger_.settled(); }
  void pause(std::int64_t duration_ns) noexcept override;
  bool wait(std::int64_t timeout_ns) noexcept override;
  const CanCounters& counters() const noexcept override { return counters_; }
  void set_tap(CanTap* tap) noexcept override { tap_ = tap; }
  int descriptor() const noexcept { return fd_.get(); }

 private:
  struct Batch;

  UniqueFd fd_;
  CanTap* tap_ = nullptr;
  CanCounters counters_{};
  std::uint32_t kernel_drops_ = 0;  // as the kernel counts them
  std::int64_t emptied_ns_;         // when it was last seen that nothing waits
  std::unique_ptr<Batch> batch_;
  bool echoes_;           // of own frames are received
  bool holding_ = false;  // frames of the cycle before have not left
  DepartureLedger ledger_;
};

}  // namespace sandhopper
