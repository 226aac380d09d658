#include <fmt/format.h>

#include <exception>
#include <system_error>

#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/freeze/freeze_recorder.hpp"
#include "firmware/log/mapped_file.hpp"

namespace sandhopper {
namespace {

class Leftovers {
 public:
  Leftovers(const std::filesystem::path& folder, const std::function<void(const std::string&)>& warn)
      : folder_(folder), warn_(warn) {}

  // Writes all frames of a ring, then removes the ring's file.
  void write(const std::filesystem::path& ring_file) {
    try {
      const MappedFile file(ring_file);
      const FreezeReader reader(file.bytes());
      for (const auto& instant : instants_left(reader))
        frames.push_back(write_frame(reader, instant, folder_));
    } catch (const std::exception& error) {
      warn_(fmt::format("{}: no freeze frame can be made of it: {}", ring_file.string(), error.what()));
      return;
    }
    std::error_code ignored;
    std::filesystem::remove(ring_file, ignored);
  }

  void move(const std::filesystem::path& frame) {
    std::error_code error;
    const auto to = folder_ / frame.filename();
    std::filesystem::create_directories(folder_, error);
    if (!std::filesystem::exists(to)) {
      const auto part = folder_ / ("." + frame.filename().string() + ".part");
      std::filesystem::copy_file(frame, part, std::filesystem::copy_options::overwrite_existing, error);
      if (!error) std::filesystem::rename(part, to, error);
      std::error_code ignored;
      if (error) std::filesystem::remove(part, ignored);
    }
    if (error) {
      warn_(fmt::format("{} stays in memory: {}", frame.string(), error.message()));
      return;
    }
    std::filesystem::remove(frame, error);
    frames.push_back(to);
  }

  std::vector<std::filesystem::path> frames;

 private:
  const std::filesystem::path& folder_;
  const std::function<void(const std::string&)>& warn_;
};

}  // namespace

std::vector<std::filesystem::path> write_leftovers(const std::filesystem::path& folder,
                                                   const std::vector<std::filesystem::path>& memory_folders,
                                                   const std::function<void(const std::string&)>& warn) {
  Leftovers leftovers(folder, warn);
  for (const auto& memory : memory_folders) {
    for (const auto& ring : freeze::files_in(memory, freeze::kMemoryEnding))
      if (!freeze::is_in_use(ring)) leftovers.write(ring);
    if (memory == folder) continue;
    for (const auto& frame : freeze::files_in(memory, freeze::kFrameEnding)) leftovers.move(frame);
  }
  // A dump of a ring above would give the same frame names; those frames exist already and are left as they
  // are.
  for (const auto& dump : freeze::files_in(folder, freeze::kDumpEnding)) leftovers.write(dump);
  return leftovers.frames;
}

}  // namespace sandhopper
