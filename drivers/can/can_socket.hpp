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

// Filter that passes exactly one data-frame identifier. Extended and remote frames of the same number do not
// match.
can_filter exact_standard_id(canid_t id) noexcept;
can_filter exact_extended_id(canid_t id) noexcept;

// A raw, non-blocking SocketCAN socket. Own frames come back only as echoes, which show that they have left:
// pass the identifiers of own frames in `filters`, too. Without any filter there are no echoes. Loopback is
// on, so candump sees own frames. Error frames of the controller are received and counted.
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
  std::uint32_t kernel_drops_ = 0;  // kernel's count of dropped frames
  std::int64_t emptied_ns_;         // time at which the receive queue was last empty
  std::unique_ptr<Batch> batch_;
  bool echoes_;           // the socket receives echoes of own frames
  bool holding_ = false;  // frames of the previous cycle have not left
  DepartureLedger ledger_;
};

}  // namespace sandhopper
