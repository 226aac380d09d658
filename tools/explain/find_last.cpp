#include "tools/explain/find_last.hpp"

#include <sys/stat.h>

#include <exception>

#include "drivers/clock.hpp"
#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/freeze/freeze_ring.hpp"
#include "firmware/log/mapped_file.hpp"

namespace sandhopper {
namespace {

std::int64_t written_ns(const std::filesystem::path& file) {
  struct stat about {};
  return ::stat(file.c_str(), &about) == 0 ? to_ns(about.st_mtim) : 0;
}

// CLOCK_REALTIME of the newest cycle of a ring or dump; nothing where it cannot be read.
std::optional<std::int64_t> newest_ns(const std::filesystem::path& file) {
  try {
    const MappedFile map(file);
    const FreezeReader ring(map.bytes());
    const auto cycle = ring.cycle(ring.count());
    if (cycle) return cycle->frame.time_ns + ring.header().realtime_offset_ns;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> find_last_freeze(const std::vector<std::filesystem::path>& folders) {
  std::optional<std::filesystem::path> last;
  std::int64_t last_ns = 0;
  const auto offer = [&](const std::filesystem::path& file, std::optional<std::int64_t> time_ns) {
    if (!time_ns || *time_ns < last_ns) return;
    last = file;
    last_ns = *time_ns;
  };
  for (const auto& folder : folders) {
    for (const auto& file : freeze::files_in(folder, freeze::kDumpEnding)) offer(file, newest_ns(file));
    for (const auto& file : freeze::files_in(folder, freeze::kMemoryEnding))
      if (!freeze::is_in_use(file)) offer(file, newest_ns(file));
    for (const auto& file : freeze::files_in(folder, freeze::kFrameEnding)) offer(file, written_ns(file));
  }
  return last;
}

}  // namespace sandhopper
