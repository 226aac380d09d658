#pragma once
#include <string>
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// Values that are right one by one and contradict each other: a range that cannot carry the limit it must
// carry, an age no sensor can keep, a reaction that comes too late to be one. `hop config check` and
// everything that starts a cycle (hopperd, hop trial, simulations) use these same rules, by way of
// config/files.hpp. Replay does not: a log from before a rule was known still replays.
namespace sandhopper {

struct Contradiction {
  std::string key;   // whose line is shown
  std::string text;  // the arithmetic and the cure
};

// Within robot.toml.
std::vector<Contradiction> contradictions(const RobotConfig& robot);

// Between the device file and robot.toml. Keys are the device file's. `board.can.motor` counts for nothing:
// the motors are the robot's.
std::vector<Contradiction> contradictions(const LinuxBoardConfig& board, const RobotConfig& robot);

// Throws ConfigError if there are any, with their lines where the document has any.
void refuse(const std::vector<Contradiction>& found, const ConfigDocument& document);

}  // namespace sandhopper
