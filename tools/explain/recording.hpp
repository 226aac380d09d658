#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/node.hpp"
#include "firmware/event.hpp"
#include "firmware/freeze/freeze_frame.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// The part of a log that an explanation shows: cycles around one instant.
struct Recording {
  std::filesystem::path file;
  FreezeCause cause = FreezeCause::fault;
  std::int64_t time_ns = 0;             // of the instant, CLOCK_MONOTONIC
  std::int64_t realtime_offset_ns = 0;  // to CLOCK_REALTIME
  std::vector<std::pair<SensorFrame, StepOutput>> cycles;
  std::vector<Event> events;
  std::optional<ConfigNode> robot;  // the configuration that the log carries
  std::string robot_toml;
  std::map<std::string, std::string> facts;  // metadata: version, board, trial sheet
  bool cut = false;                          // the file was not closed
};

// From a freeze frame, a trial's log, a ring in memory or a dump of one. Of a log: around the fault that
// began its last episode of faults. Of a ring or dump: around its newest fault, or its end. Throws
// mcap::Error or std::runtime_error for a file that is none of these or has no fault, std::system_error where
// it cannot be opened.
Recording read_recording(const std::filesystem::path& file);

}  // namespace sandhopper
