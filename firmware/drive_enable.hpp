#pragma once
#include <atomic>
#include <functional>
#include <utility>

namespace sandhopper {

// The GPIO line `drive_enable` controls a relay in the drives' supply; the relay is closed while the line is
// active. The drives need power to be probed and supervised, so the line is active from the start of the
// board. It is dropped when CAN can no longer be trusted to take the torque away:
//   - the torque watchdog trips
//   - the drives do not confirm in time that they left motor mode (CubeMarsDrives::leave_overdue)
//   - hopperd ends
// Then it stays dropped until hopperd is restarted, because a drive that lost its supply has lost its state.
// Any thread may call drop(); nothing here waits.
class DriveEnable {
 public:
  // `set` writes the level and returns false if it could not. The line becomes active at once.
  explicit DriveEnable(std::function<bool(bool active)> set) : set_(std::move(set)) { set_(true); }
  ~DriveEnable() { drop(); }
  DriveEnable(const DriveEnable&) = delete;
  DriveEnable& operator=(const DriveEnable&) = delete;

  // If the line could not be written, the next call tries again.
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
