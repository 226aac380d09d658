#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "drivers/unique_fd.hpp"
#include "firmware/freeze/freeze_ring.hpp"
#include "firmware/watchdog/last_act.hpp"

namespace sandhopper {

// Copy of the ring on disk, written by the guard process when hopperd was killed or stands still. The file is
// created and its disk space allocated beforehand under a hidden name. run() gives it its final name.
class FreezeDump final : public LastAct {
 public:
  // Creates `folder`. Throws std::system_error if the file cannot be created or the disk has no room for it.
  FreezeDump(FreezeRing& ring, const std::filesystem::path& folder);
  FreezeDump(const FreezeDump&) = delete;
  FreezeDump& operator=(const FreezeDump&) = delete;

  // Async-signal-safe: write, fdatasync and rename only. If the disk does not accept the data, the ring's own
  // file in memory remains.
  void run() noexcept override;
  std::span<const int> descriptors() const noexcept override { return {&descriptor_, 1}; }

  // For use after a standstill in which the guard wrote the file and hopperd then continued. Hides the file,
  // so that the next standstill can publish it. The freeze frame of watchdog_tripped records this one.
  void take_back() noexcept;
  // Removes both names after hopperd ended in order.
  void remove() noexcept;

 private:
  FreezeRing& ring_;
  std::filesystem::path final_;
  std::filesystem::path hidden_;
  UniqueFd file_;
  int descriptor_ = -1;
};

}  // namespace sandhopper
