#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/calibrate/timing.hpp"

namespace sandhopper::calibrate {

// A table that cannot be used, and what to do.
struct ForeignTableError : std::runtime_error {
  ForeignTableError(const std::string& what, std::string with_cure)
      : std::runtime_error(what), cure(std::move(with_cure)) {}
  std::string cure;
};

struct ForeignTable {
  ForeignRecording recording;
  std::vector<std::string> notes;  // what the reader found, where the rest can be used
};

// Column `column` against t_s. Throws ForeignTableError for a table without these columns, one whose clock
// goes backwards, and one in which most cells of the column are no number; std::system_error when it cannot
// be opened.
ForeignTable read_foreign_table(const std::filesystem::path& file, const std::string& column);

}  // namespace sandhopper::calibrate
