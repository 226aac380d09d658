#pragma once
#include <filesystem>
#include <string>

namespace sandhopper {

// Content of an MCAP file in words, for messages about a log that cannot be used.
struct LogContent {
  bool is_of_this_firmware = false;  // it has the cycle's inputs or outputs
  bool has_cycles = false;           // it has outputs of the cycle: a trial, not a calibration's recording
  std::string topics;                // those with messages: "/joint_state (300 messages)"
};

// True if the file begins as an MCAP file does.
bool is_mcap(const std::filesystem::path& file);

// Reads the log to its end or to the first damage. Throws mcap::Error if the file is no MCAP log.
LogContent content_of_log(const std::filesystem::path& file);

}  // namespace sandhopper
