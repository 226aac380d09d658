#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace sandhopper::trace {

// A file that is not `candump -L` text, and the way to convert it.
struct ForeignFormat {
  std::string what;  // such as "a Vector ASC log"
  std::string cure;  // the command line to convert it
};

// Examines the first bytes and lines. Recognises Vector ASC and BLF, PEAK TRC, ASAM MDF, python-can's CSV,
// database and print-out, candump without -L (with and without times), packet captures, compressed files,
// UTF-16, MCAP, slcan and times with a decimal comma. Empty for `candump -L` text and for unknown formats.
// Throws std::system_error if the file cannot be opened.
std::optional<ForeignFormat> recognise_format(const std::filesystem::path& file);

}  // namespace sandhopper::trace
