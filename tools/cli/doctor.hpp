#pragma once
#include <string>
#include <vector>

#include "firmware/linux_board_config.hpp"
#include "firmware/realtime.hpp"

// What `hop doctor` looks at. Nothing is energised, taken over or changed: devices are looked up, not opened
// for use.
namespace sandhopper::cli {

enum class Health : std::uint8_t { ok, warn, fail };

struct Finding {
  Health health;
  std::string what;   // "SCHED_FIFO", "can0"
  std::string found;  // "priority 80 granted"
  std::string cure;   // empty when ok
};

// Kernel, priorities, memory locking, processors, clocks, disk space.
std::vector<Finding> examine_machine(const RealTimeConfig& wanted);

// CAN interface, device nodes and GPIO lines of the board's file.
std::vector<Finding> examine_devices(const LinuxBoardConfig& board);

}  // namespace sandhopper::cli
