#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace sandhopper {

struct CsvExportOptions {
  // Gyroscopes, bus voltage and the firmware's own estimates besides. A cycle's force estimates belong to the
  // instant of its newest motor reply, up to a cycle earlier than t_s.
  bool optional_channels = false;
  bool phase_names = false;  // `phase` as "flight", "compression", "extension" in place of 0, 1, 2
};

struct CsvExportResult {
  std::uint64_t rows = 0;
  std::vector<std::string> columns;
  std::uint64_t lost_records = 0;             // as the log's gap records say
  std::optional<std::uint64_t> truncated_at;  // the log was cut here
};

// A trial's log as CSV, channels as in the README of this folder: one row a cycle, t_s from the first logged
// cycle, an empty cell where nothing fresh was measured (or where the time-of-flight sensor says its value is
// not good), `phase` empty outside of a hop. Motion capture is there when the log has it. Numbers are written
// with as many digits as give the same double back. Reads logs of other versions as long as the fields it
// needs are there; throws mcap::Error when the log is damaged or has no /frame.
CsvExportResult export_csv(const std::filesystem::path& log, std::ostream& out,
                           CsvExportOptions options = {});

}  // namespace sandhopper
