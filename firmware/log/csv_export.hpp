#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace sandhopper {

struct CsvExportOptions {
  // Adds gyroscopes, bus voltage and the firmware's own estimates. A cycle's force estimates belong to the
  // instant of its newest motor reply, which is up to one cycle earlier than t_s.
  bool optional_channels = false;
  bool phase_names = false;  // `phase` as "flight", "compression", "extension" in place of 0, 1, 2
};

struct CsvExportResult {
  std::uint64_t rows = 0;
  std::vector<std::string> columns;
  std::uint64_t lost_records = 0;             // from the log's gap records
  std::string lost_text;                      // the same with the causes
  std::optional<std::uint64_t> truncated_at;  // the log was cut here
};

// Writes a trial's log as CSV with the channels in the README of this folder. It has one row per cycle; t_s
// counts from the first logged cycle. A cell is empty if nothing fresh was measured or if the time-of-flight
// status is not good. `phase` is empty outside of a hop. Motion capture columns exist if the log has them.
// Numbers have enough digits to give the same double when read. Reads logs of other versions if they contain
// the needed fields. Throws mcap::Error if the log is damaged or has no /frame.
CsvExportResult export_csv(const std::filesystem::path& log, std::ostream& out,
                           CsvExportOptions options = {});

}  // namespace sandhopper
