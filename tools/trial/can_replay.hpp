#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "drivers/can/cubemars.hpp"
#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper {

struct CanReplayResult {
  trace::TraceReport trace;                         // by the decoder alone
  std::optional<std::vector<MotorReading>> driven;  // by the real driver on the interface
  std::uint64_t different = 0;                      // readings whose values are not the same bits in both
  std::uint32_t overflows = 0;                      // dropped by the kernel on the way to the driver
  bool identical() const { return different == 0 && (!driven || driven->size() == trace.decoded.size()); }
};

struct CanReplaySetup {
  CanConfig config;
  trace::TraceLimits limits{};
  std::string bus;                          // interface of the trace to take; empty: all
  std::optional<std::string> interface {};  // to play its replies on
};

// Reads a candump trace, finds its replies and what else it contains (trace/trace_report.hpp) and, when
// `interface` is given, plays the replies on that CAN interface (one at a time, each read before the next)
// into the driver that the robot uses, and compares. Throws CandumpError for a file without a single frame,
// DeviceError when the interface is not there.
CanReplayResult replay_can(const std::filesystem::path& file, const CanReplaySetup& setup,
                           const std::function<void(std::uint64_t frames)>& progress = {});

}  // namespace sandhopper
