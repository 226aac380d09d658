#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "firmware/freeze/freeze_dump.hpp"
#include "firmware/freeze/freeze_frame.hpp"
#include "firmware/freeze/freeze_ring.hpp"

namespace sandhopper {

struct FreezeOptions {
  std::filesystem::path folder{};  // folder of the frames: freeze::frame_folder()
  std::size_t newest = 20;         // number of frames that are kept
  std::filesystem::path log_file{};
  std::int64_t start_ns = 0;
  std::int64_t realtime_offset_ns = 0;
  LogDescription description{};
  // Called from the recorder's thread or from the constructor.
  std::function<void(const std::string&)> warn{};
  std::function<void(const std::filesystem::path& frame)> told{};
};

// Keeps the last seconds in shared memory and writes a freeze frame for every fault, one second after it. A
// thread of ordinary priority looks for faults in the ring, so the cycle only pushes. If the folder cannot
// take a frame (disk full), the frame goes to the folder in memory and the next start moves it.
class FreezeRecorder {
 public:
  // Never throws. Without memory for the ring it warns and ring() is null.
  explicit FreezeRecorder(FreezeOptions options);
  ~FreezeRecorder();
  FreezeRecorder(const FreezeRecorder&) = delete;
  FreezeRecorder& operator=(const FreezeRecorder&) = delete;

  FreezeRing* ring() noexcept { return ring_.get(); }
  FreezeDump* dump() noexcept { return dump_.get(); }  // for the guard process; null: no room on the disk

  // Writes the frames that earlier processes left, then watches the ring.
  void start();
  // For an orderly end, after the last push. Frames whose second is not over are written with the available
  // cycles, and the shared memory is released.
  void stop();
  // Checks the ring once, at the time of its newest cycle. For a caller without the thread (simulation).
  void look();

 private:
  void run();
  void write(const FreezeInstant& instant);

  FreezeOptions options_;
  std::filesystem::path memory_;  // folder
  std::unique_ptr<FreezeRing> ring_;
  std::unique_ptr<FreezeDump> dump_;
  std::vector<FreezeInstant> due_;
  std::uint64_t looked_to_ = 0;
  bool kept_ = false;  // a frame could not be written, so the ring's file stays
  bool ended_ = false;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
};

// Writes the frames that earlier processes left: rings in memory that no process writes any more, dumps of
// the guard, and frames that are in memory because the disk was full. Returns the frames written or moved to
// `folder`. A file that cannot be read or written stays; `warn` names it.
std::vector<std::filesystem::path> write_leftovers(const std::filesystem::path& folder,
                                                   const std::vector<std::filesystem::path>& memory_folders,
                                                   const std::function<void(const std::string&)>& warn);

}  // namespace sandhopper
