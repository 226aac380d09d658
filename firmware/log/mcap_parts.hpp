#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/log/mcap_format.hpp"
#include "firmware/log/mcap_reader.hpp"

// Files that hold more than one log, as `cat a.mcap >> b.mcap` makes them, or bytes behind a log's end.
namespace sandhopper::mcap {

struct Part {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
};

// The stretches of the file that begin with the magic and a header record. Bytes in front of the first magic
// belong to the first part.
std::vector<Part> parts_of(Bytes file);

// The one log of a file.
struct OneLog {
  Part part{};    // without the bytes behind its end
  Bytes bytes{};  // its content
  std::uint64_t file_bytes = 0;
  std::uint64_t copies = 1;  // number of times that the file holds it; a cut copy counts
  std::uint64_t behind = 0;  // bytes behind the end of a closed log, in its part
  bool zeros = true;         // these bytes are zeros, as of a file that was allocated in advance
};

// Different logs in one file. `cure` has the commands that cut it.
struct SeveralLogs : Error {
  SeveralLogs(const std::filesystem::path& file, const std::vector<Part>& parts);
  std::string cure;
};

// Throws SeveralLogs if the file holds different logs. Parts that are the beginning of the longest one are
// copies of it. `file` must outlive the result.
OneLog one_log_of(Bytes file, const std::filesystem::path& name);

}  // namespace sandhopper::mcap
