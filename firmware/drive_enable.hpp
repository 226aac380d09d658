#pragma once
#include <atomic>
#include <functional>
#include <utility>

namespace sandhopper {

// The line `drive_enable`: a relay in the drives' supply, closed while the line is active. Drives must have
// power to be probed and watched, so it is active from the start of the board on. It is dropped when CAN can
// no longer be trusted to take the torque away:
//   - the torque watchdog trips
//   - the drives do not confirm in time that they left motor mode (CubeMarsDrives::leave_overdue)
//   - hopperd ends
// and then stays dropped until hopperd is started again: a drive that lost its supply has lost its state.
// Any thread may call drop(); nothing here waits.
class DriveEnable {
 public:
  // `set`: writes the level, false when it could not. Active at once.
  explicit DriveEnable(std::function<bool(bool active)> set) : set_(std::move(set)) { set_(true); }
  ~DriveEnable() { drop(); }
  DriveEnable(const DriveEnable&) = delete;
  DriveEnable& operator=(const DriveEnable&) = delete;

  // Tried again by the next call when the line could not be written.
  void drop() noexcept {
    if (dropped_.exchange(true, std::memory_order_acq_rel)) return;
    if (!set_(false)) dropped_.store(false, std::memory_order_release);
  }
  bool dropped() const noexcept { return dropped_.load(std::memory_order_acquire); }

 private:
  std::function<bool(bool)> set_;
  std::atomic<bool> dropped_{false};
};

}  // namespace sandhopper
