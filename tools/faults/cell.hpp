#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/robot_config.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "tools/faults/injection.hpp"

namespace sandhopper::faults {

// Phase of the trial in which the fault is planted.
enum class Phase : std::uint8_t { idle, armed, flight, compression, extension };

// The frame of the last cycle before the injection; default-constructed if nothing was injected yet.
struct Injected {
  SensorFrame frame{};
};

// One cell of the matrix: the defect, its phase, and the expected fault.
struct Cell {
  Device device;
  Kind kind;
  Phase phase;
  Fault expected;  // none: it cannot be detected, see `note`
  // True in a cycle that can show the fault; empty: every cycle from the injection on can.
  std::function<bool(const SensorFrame& frame, const StepOutput& output, const Injected& injected)> visible{};
  std::function<void(RobotConfig& robot)> change{};  // changes the robot's configuration for this cell
  std::string note{};
  Fault or_else = Fault::none;  // also accepted: chance decides which of the two is found first

  // True if `found` is an accepted fault of this cell.
  bool names(Fault found) const { return found == expected || (or_else != Fault::none && found == or_else); }
  // Device and kind, for example "imu_body off".
  std::string name() const;
};

// Every cell, in the order of printing.
std::vector<Cell> all_cells();

}  // namespace sandhopper::faults

namespace sandhopper {
template <>
struct EnumNames<faults::Phase> {
  static constexpr std::array<std::string_view, 5> value{"idle", "armed", "flight", "compression",
                                                         "extension"};
};
}  // namespace sandhopper
