#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "drivers/can/cubemars.hpp"

namespace sandhopper {

struct TimedReading {
  std::int64_t trace_ns = 0;  // of the frame in the trace
  MotorReading reading{};
};

struct CanReplayResult {
  std::uint64_t frames = 0;                         // lines of the trace
  std::vector<TimedReading> decoded;                // by the decoder alone
  std::optional<std::vector<MotorReading>> driven;  // by the real driver on the interface
  std::uint64_t different = 0;                      // readings whose values are not the same bits in both
  std::uint32_t rejected = 0;                       // frames that do not look like the configured dialect
  std::uint32_t overflows = 0;                      // dropped by the kernel on the way to the driver
  bool identical() const { return different == 0 && (!driven || driven->size() == decoded.size()); }
};

// Reads a candump trace through the drives' decoder and, when `interface` is given, plays its frames on that
// CAN interface (one at a time, each read before the next) into the driver that the robot uses, and compares.
// Throws CandumpError for a line that is no CAN frame, DeviceError when the interface is not there.
CanReplayResult replay_can(const std::filesystem::path& trace, const CanConfig& config,
                           const std::optional<std::string>& interface,
                           const std::function<void(std::uint64_t frames)>& progress = {});

}  // namespace sandhopper
