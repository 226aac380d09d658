#pragma once
#include <memory>
#include <string>
#include <vector>

#include "config/problem.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// The checks of `hop doctor`. They energise no drive and change no setting.
namespace sandhopper::cli {

// fail: the machine is not ready, and `hop doctor` ends with exit status 1.
enum class Health : std::uint8_t { ok, warn, fail };

// Result of one check.
struct Finding {
  Health health;
  std::string what;   // name of the check: "SCHED_FIFO", "can0"
  std::string found;  // result: "priority 80 granted"
  std::string cure;   // for the user; empty if ok
};

// Kernel, priorities, memory locking, processors, clocks, disk space.
std::vector<Finding> examine_machine(const RobotConfig& robot);

// Disk space and date only.
std::vector<Finding> examine_storage();

// CAN interface, device nodes and GPIO lines of the board's file. They are looked up, not opened for use.
std::vector<Finding> examine_devices(const LinuxBoardConfig& board);

// Priorities of the kernel threads that serve the interrupts of the board's buses.
std::vector<Finding> examine_interrupts(const RobotConfig& robot, const LinuxBoardConfig& board);

// Bit rate, error state and queue of a CAN interface that is up; empty if it is down.
std::vector<Finding> examine_bus(const std::string& interface);

// Opens every device as hopperd does, except the catch, and reads chip identities, companion controller,
// drives and their dialect. If hopperd runs, the devices are busy and one finding reports that. Devices with
// a failed finding in `known` are left out.
std::vector<Finding> examine_identities(const LinuxBoardConfig& board, const std::vector<Finding>& known);

// Dates of the calibrations in the configuration, and calibrated values that were edited afterwards.
std::vector<Finding> examine_calibrations(const RobotConfig& robot, const LinuxBoardConfig& board);

// State kept from earlier runs: motor temperatures as a start now would assume them, touchdowns, the last
// fault, positions.
std::vector<Finding> examine_state(const RobotConfig& robot);

// Findings for a configuration that cannot be read.
std::vector<Finding> examine_problems(const ConfigError& error);

// Collects the identifiers seen on a CAN interface since its construction.
class BusListener {
 public:
  explicit BusListener(const std::string& interface);
  ~BusListener();
  // Lists the identifiers. Fails if there are none although the drives were asked for their state.
  Finding seen(const CanConfig& config);

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace sandhopper::cli
