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

// When the fault comes.
enum class Phase : std::uint8_t { idle, armed, flight, compression, extension };

// The cycle before the injection, or an empty one.
struct Injected {
  SensorFrame frame{};
};

// One cell of the matrix: what breaks, when, and what must come of it.
struct Cell {
  Device device;
  Kind kind;
  Phase phase;
  Fault expected;  // none: cannot be seen, see `note`
  // The first cycle that could show it, where that is not the cycle of the injection.
  std::function<bool(const SensorFrame& frame, const StepOutput& output, const Injected& injected)> visible{};
  std::function<void(RobotConfig& robot)> change{};  // of the robot's file for this cell
  std::string note{};
  Fault or_else = Fault::none;  // as right as `expected`: chance decides which of the two sees it first

  bool names(Fault found) const { return found == expected || (or_else != Fault::none && found == or_else); }
  std::string name() const;
};

// Every cell, in the order in which they are printed.
std::vector<Cell> all_cells();

}  // namespace sandhopper::faults

namespace sandhopper {
template <>
struct EnumNames<faults::Phase> {
  static constexpr std::array<std::string_view, 5> value{"idle", "armed", "flight", "compression",
                                                         "extension"};
};
}  // namespace sandhopper
