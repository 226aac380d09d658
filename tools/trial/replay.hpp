#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "firmware/records.hpp"

namespace sandhopper {

struct ReplayMismatch {
  std::string topic;
  std::uint64_t record = 0;  // index in that topic, from 0
  std::int64_t time_ns = 0;
  std::string field;  // the first field that differs, with both values
};

struct ReplayResult {
  std::uint64_t files = 0;  // number of files of the log
  std::uint64_t cycles = 0;
  std::uint64_t events = 0;
  std::uint64_t strides = 0;
  std::uint64_t gaps = 0;  // records that the logger lost; outputs after a gap cannot be compared
  double seconds = 0.0;    // wall time of the replay
  double x_real_time = 0.0;
  std::optional<ReplayMismatch> mismatch;
  std::optional<std::uint64_t> truncated_at;
};

// Runs the cycle again on the frames of a log, with the configuration in the log, and compares every output,
// event and stride result byte for byte with the log. Throws mcap::Error if the file is no trial's log. For a
// log in several files, name the first; the others follow in order. `stride` receives the cycle's sums of
// each stride.
ReplayResult replay_log(const std::filesystem::path& log,
                        const std::function<void(double share)>& progress = {},
                        const std::function<void(const StrideSums&)>& stride = {});

}  // namespace sandhopper
