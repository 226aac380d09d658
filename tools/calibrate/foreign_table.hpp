#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/calibrate/timing.hpp"

namespace sandhopper::calibrate {

// The table cannot be used. `cure` tells the user what to do.
struct ForeignTableError : std::runtime_error {
  ForeignTableError(const std::string& what, std::string with_cure)
      : std::runtime_error(what), cure(std::move(with_cure)) {}
  std::string cure;
};

// One column of the table against time.
struct ForeignTable {
  ForeignRecording recording;
  double time_scale = 1.0;         // seconds in the unit of the table's t_s; the recording is in seconds
  std::vector<std::string> notes;  // problems found in a table that can still be used
};

// Reads column `column` against t_s. The times are in `time_unit` (foreign_time.hpp); if it is empty, in the
// unit of the table's line of units, or in seconds. Throws ForeignTableError if a column is missing, if the
// clock goes backwards, if most times are no number or repeat, or if most cells of the column are no number;
// std::system_error if the file cannot be opened.
ForeignTable read_foreign_table(const std::filesystem::path& file, const std::string& column,
                                const std::string& time_unit = {});

}  // namespace sandhopper::calibrate
