#pragma once
#include <memory>
#include <string>
#include <vector>

#include "config/problem.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// What `hop doctor` looks at. No drive is energised and no setting changed.
namespace sandhopper::cli {

enum class Health : std::uint8_t { ok, warn, fail };

struct Finding {
  Health health;
  std::string what;   // "SCHED_FIFO", "can0"
  std::string found;  // "priority 80 granted"
  std::string cure;   // empty when ok
};

// Kernel, priorities, memory locking, processors, clocks, disk space.
std::vector<Finding> examine_machine(const RobotConfig& robot);

// Disk space and date only.
std::vector<Finding> examine_storage();

// CAN interface, device nodes and GPIO lines of the board's file: looked up, not opened for use.
std::vector<Finding> examine_devices(const LinuxBoardConfig& board);

// Priorities of the kernel's threads that serve the interrupts of the board's buses.
std::vector<Finding> examine_interrupts(const RobotConfig& robot, const LinuxBoardConfig& board);

// Bit rate, error state and queue of a CAN interface that is up; empty of one that is not.
std::vector<Finding> examine_bus(const std::string& interface);

// Opens every device as a start of hopperd would, but for the catch: chip identities, companion controller,
// drives and their dialect. Where hopperd runs, it has them, and that is said instead. Devices whose finding
// in `known` is red are left out.
std::vector<Finding> examine_identities(const LinuxBoardConfig& board, const std::vector<Finding>& known);

// What calibrations left in the configuration, and values that were edited since.
std::vector<Finding> examine_calibrations(const RobotConfig& robot, const LinuxBoardConfig& board);

// What the robot remembers of earlier runs: temperatures as a start now would take them, touchdowns, the last
// fault, positions.
std::vector<Finding> examine_state(const RobotConfig& robot);

// A configuration that cannot be read.
std::vector<Finding> examine_problems(const ConfigError& error);

// Collects identifiers on a CAN interface from its making on.
class BusListener {
 public:
  explicit BusListener(const std::string& interface);
  ~BusListener();
  Finding seen(const CanConfig& config);

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace sandhopper::cli
