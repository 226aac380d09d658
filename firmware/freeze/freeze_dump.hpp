#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "drivers/unique_fd.hpp"
#include "firmware/freeze/freeze_ring.hpp"
#include "firmware/watchdog/last_act.hpp"

namespace sandhopper {

// The guard process's part: when hopperd was killed or stands still, the ring goes to the disk as it is. The
// file is made and its room on the disk taken beforehand, under a hidden name; run() gives it its own.
class FreezeDump final : public LastAct {
 public:
  // Makes `folder`. Throws std::system_error when the file cannot be made or the disk has no room for it.
  FreezeDump(FreezeRing& ring, const std::filesystem::path& folder);
  FreezeDump(const FreezeDump&) = delete;
  FreezeDump& operator=(const FreezeDump&) = delete;

  // Async-signal-safe: write, fdatasync and rename only. Where the disk does not take it, the ring's own file
  // in memory is still there.
  void run() noexcept override;
  std::span<const int> descriptors() const noexcept override { return {&descriptor_, 1}; }

  // In hopperd, which stood still, let the guard act, and goes on: the file is hidden again, for the next
  // time. The standstill's picture is the freeze frame of watchdog_tripped.
  void take_back() noexcept;
  // Takes both names away: hopperd ended in order.
  void remove() noexcept;

 private:
  FreezeRing& ring_;
  std::filesystem::path final_;
  std::filesystem::path hidden_;
  UniqueFd file_;
  int descriptor_ = -1;
};

}  // namespace sandhopper
