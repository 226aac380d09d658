#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_port.hpp"
#include "drivers/can/cubemars.hpp"
#include "firmware/board.hpp"
#include "firmware/linux_board_config.hpp"
#include "firmware/watchdog/heartbeat.hpp"

namespace sandhopper {

// Status of the Linux board's buses; all counts are cumulative since start.
struct LinuxBoardStatus {
  struct SlowBus {
    std::uint32_t failed_transfers = 0;
    std::uint32_t missed_edges = 0;
    std::uint32_t invalid = 0;

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("failed_transfers", self.failed_transfers);
      visit("missed_edges", self.missed_edges);
      visit("invalid", self.invalid);
    }
  };

  CanCounters can{};
  std::array<CubeMarsCounters, kMotorCount> motor{};
  SlowBus imu_body{};
  SlowBus imu_foot{};
  SlowBus load_cell{};
  SlowBus tof{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("can", self.can);
    visit("motor", self.motor);
    visit("imu_body", self.imu_body);
    visit("imu_foot", self.imu_foot);
    visit("load_cell", self.load_cell);
    visit("tof", self.tof);
  }
};

struct LinuxBoardDevices;

// The robot's device nodes. A thread per slow bus takes samples as they come; the cycle reads the newest ones
// and the CAN replies, and waits for nothing.
//
// The constructor opens every device, asks each drive for its state and throws DeviceError with one line for
// each device that failed. Until then the drives get only "leave motor mode". The destructor shuts the drives
// down.
class LinuxBoard : public Board {
 public:
  // `tap`, if given, gets every CAN frame in both directions.
  explicit LinuxBoard(const LinuxBoardConfig& config, CanTap* tap = nullptr);
  ~LinuxBoard() override;
  LinuxBoard(const LinuxBoard&) = delete;
  LinuxBoard& operator=(const LinuxBoard&) = delete;

  void read(SensorFrame& frame) noexcept override;
  void note_fault(Fault latched) noexcept override { latched_ = latched; }
  void write(const Command& command) noexcept override;

  // After a trip of the cycle's watchdog the board does not send a command that was computed before it.
  // `heart` must outlive the board.
  void heed(const Heartbeat& heart) noexcept { heart_ = &heart; }

  LinuxBoardStatus status() const noexcept;

  // Opens the relay in the drives' supply, if there is one. Any thread; never waits.
  void cut_supply() noexcept;

  // Removes torque and leaves motor mode until every drive has confirmed it, for at most
  // CubeMarsDrives::kShutDown_ns. If a drive does not confirm, it also opens the relay. Returns the names of
  // the motors that did not confirm: they may still produce their last torque, and the guard process must not
  // be dismissed. Empty if all confirmed. Not for the cycle; write nothing afterwards. Later calls return the
  // first result.
  std::string shut_down();

 private:
  struct Acquisition;

  std::unique_ptr<LinuxBoardDevices> devices_;
  std::unique_ptr<Acquisition> acquisition_;
  const Heartbeat* heart_ = nullptr;
  std::optional<std::string> shut_down_;  // result of shut_down()
  Fault latched_ = Fault::none;
  bool emergency_stop_ = true;  // last reading of the line
};

// One line per device: the error that a start would report, empty if none. Energises nothing and starts no
// thread.
struct DeviceReport {
  std::string device;
  std::string problem;
};
std::vector<DeviceReport> examine_devices(const LinuxBoardConfig& config);

}  // namespace sandhopper
