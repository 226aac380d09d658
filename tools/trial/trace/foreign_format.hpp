#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace sandhopper::trace {

// A file that is no `candump -L` text, and how to make one of it.
struct ForeignFormat {
  std::string what;  // "a Vector ASC log"
  std::string cure;  // the command line to convert it
};

// Looks at the first bytes and lines: Vector ASC and BLF, PEAK TRC, ASAM MDF, python-can's CSV, database and
// print-out, candump without -L (with and without times), packet captures, compressed files, UTF-16, MCAP.
// Empty for `candump -L` text and for what is not known. Throws std::system_error if it cannot be opened.
std::optional<ForeignFormat> recognise_format(const std::filesystem::path& file);

}  // namespace sandhopper::trace
