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
  trace::TraceReport trace;                         // result of the decoder alone
  std::optional<std::vector<MotorReading>> driven;  // result of the real driver on the interface
  std::uint64_t different = 0;                      // readings whose values differ in any bit
  std::uint32_t overflows = 0;                      // frames that the kernel dropped on the way to the driver
  bool identical() const { return different == 0 && (!driven || driven->size() == trace.decoded.size()); }
};

struct CanReplaySetup {
  CanConfig config;
  trace::TraceLimits limits{};
  std::string bus;                          // interface of the trace that is used; empty: all
  std::optional<std::string> interface {};  // interface on which its replies are played
};

// Reads a candump trace and finds its replies and its other content (trace/trace_report.hpp). If `interface`
// is given, it plays the replies on that CAN interface (one at a time, each read before the next) into the
// robot's driver and compares. Throws CandumpError for a file without any frame, and DeviceError if the
// interface does not exist.
CanReplayResult replay_can(const std::filesystem::path& file, const CanReplaySetup& setup,
                           const std::function<void(std::uint64_t frames)>& progress = {});

}  // namespace sandhopper
