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
  std::filesystem::path folder{};  // of the frames: freeze::frame_folder()
  std::size_t newest = 20;         // frames that are kept
  std::filesystem::path log_file{};
  std::int64_t start_ns = 0;
  std::int64_t realtime_offset_ns = 0;
  LogDescription description{};
  // Called from the recorder's thread, or from the constructor.
  std::function<void(const std::string&)> warn{};
  std::function<void(const std::filesystem::path& frame)> told{};
};

// Keeps the last seconds in shared memory and writes a freeze frame for every fault, one second after it. A
// thread of ordinary priority looks for faults in the ring, so the cycle only pushes. Where the folder takes
// no frame (disk full), the frame goes to the folder in memory, and the next start brings it to its place.
class FreezeRecorder {
 public:
  // Never throws: without memory for the ring, warns, and ring() is null.
  explicit FreezeRecorder(FreezeOptions options);
  ~FreezeRecorder();
  FreezeRecorder(const FreezeRecorder&) = delete;
  FreezeRecorder& operator=(const FreezeRecorder&) = delete;

  FreezeRing* ring() noexcept { return ring_.get(); }
  FreezeDump* dump() noexcept { return dump_.get(); }  // for the guard process; null: no room on the disk

  // First writes the frames that earlier processes left, then watches the ring.
  void start();
  // At an orderly end, after the last push: frames whose second is not over are written with what there is,
  // and the shared memory is given back.
  void stop();
  // One look at the ring, at the time of its newest cycle. For a caller without the thread (simulation).
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
  bool kept_ = false;  // a frame found no place: the ring's file stays
  bool ended_ = false;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
};

// Frames of what earlier processes left: rings in memory that nobody writes any more, dumps of the guard,
// frames that lie in memory because the disk was full. Returns the frames written or moved to `folder`; what
// cannot be read or written stays and is named to `warn`.
std::vector<std::filesystem::path> write_leftovers(const std::filesystem::path& folder,
                                                   const std::vector<std::filesystem::path>& memory_folders,
                                                   const std::function<void(const std::string&)>& warn);

}  // namespace sandhopper
