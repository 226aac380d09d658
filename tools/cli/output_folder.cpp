#include "tools/cli/output_folder.hpp"

#include <fmt/format.h>

#include "tools/cli/failure.hpp"

namespace sandhopper::cli {

namespace fs = std::filesystem;

const fs::path& made(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Failure(ExitCode::usage, fmt::format("cannot make {}: {}", folder.string(), error.message()),
                  "name a folder you may write with --output");
  return folder;
}

fs::path not_there_yet(const fs::path& folder) {
  fs::path free = folder;
  for (int run = 2; fs::exists(free); ++run) free = fmt::format("{}_{}", folder.string(), run);
  return free;
}

}  // namespace sandhopper::cli
