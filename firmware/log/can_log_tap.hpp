#pragma once
#include <linux/can.h>

#include <algorithm>
#include <cstddef>

#include "drivers/can/can_port.hpp"
#include "firmware/log/trial_logger.hpp"

namespace sandhopper {

// Hands every frame of one CAN socket to the trial's log:  socket.set_tap(&tap).
class CanLogTap final : public CanTap {
 public:
  CanLogTap(TrialLogger& logger, const std::string& interface)
      : logger_(logger), number_(logger.add_can_interface(interface)) {}

  void on_frame(const can_frame& frame, std::int64_t monotonic_ns, bool sent) noexcept override {
    log(frame, monotonic_ns, sent ? CanDirection::sent : CanDirection::received);
  }
  void on_refused(const can_frame& frame, std::int64_t monotonic_ns) noexcept override {
    log(frame, monotonic_ns, CanDirection::refused);
  }

 private:
  void log(const can_frame& frame, std::int64_t monotonic_ns, CanDirection direction) noexcept {
    CandumpFrame logged;
    logged.time_ns = monotonic_ns;
    logged.id = frame.can_id;  // the flags are linux/can.h's in both
    logged.length = std::min<std::uint8_t>(frame.can_dlc, CAN_MAX_DLEN);
    std::copy_n(frame.data, logged.length, logged.data.begin());
    logged.direction = direction;
    logger_.push_can(number_, logged);
  }

  TrialLogger& logger_;
  std::size_t number_;
};

}  // namespace sandhopper
