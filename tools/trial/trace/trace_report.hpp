#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "drivers/can/cubemars.hpp"
#include "tools/trial/trace/bus_errors.hpp"
#include "tools/trial/trace/clock.hpp"
#include "tools/trial/trace/dialects.hpp"
#include "tools/trial/trace/exchange.hpp"
#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/roles.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// Limits from robot.toml against which a trace is checked.
struct TraceLimits {
  ReplyLimits replies{};
  int cycle_gap = 20;                 // supervision.cycle_gap: number of periods without any frame
  double motor_temperature_C = 90.0;  // limits.motor_temperature_C
};

// A reply; the list is in the order of the times.
struct TimedReading {
  std::int64_t trace_ns = 0;  // time of the frame in the trace
  std::uint64_t line = 0;
  can_frame frame{};
  MotorReading reading{};
};

struct TraceReport {
  std::uint64_t frames = 0;
  std::uint64_t fd_frames = 0;
  std::vector<TimedReading> decoded;
  std::array<Exchange, kMotorCount> motors{};
  std::array<std::map<std::uint8_t, std::uint64_t>, kMotorCount> drive_errors{};  // error code and number of
                                                                                  // replies with it
  ClockReport clock;
  BusErrors bus;
  DialectsSeen dialects;
  std::uint64_t doubled_others = 0;  // copies of frames that are not replies
  Findings findings;
  bool trusted() const { return all_trusted(findings); }
};

// Examines everything in a trace besides the values in the replies, for `config.motor_count` motors. Throws
// std::invalid_argument for an invalid configuration.
TraceReport examine_trace(Trace trace, const CanConfig& config, const TraceLimits& limits);

}  // namespace sandhopper::trace
