#pragma once
#include <string>
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// Finds values that are valid one by one but contradict each other, such as a range below the limit it must
// represent, an age limit that no sensor can keep, or a reaction that comes too late. `hop config check` and
// everything that starts a cycle (hopperd, hop trial, simulations) use these rules through config/files.hpp.
// Replay does not use them, so that older logs can still be replayed.
namespace sandhopper {

struct Contradiction {
  std::string key;   // key whose line is shown
  std::string text;  // the arithmetic and the cure
};

// Contradictions within robot.toml.
std::vector<Contradiction> contradictions(const RobotConfig& robot);

// Contradictions between the device file and robot.toml. The keys are those of the device file.
// `board.can.motor` is ignored, because the motors are in robot.toml.
std::vector<Contradiction> contradictions(const LinuxBoardConfig& board, const RobotConfig& robot);

// Throws ConfigError if there are any, with their lines if the document has them.
void refuse(const std::vector<Contradiction>& found, const ConfigDocument& document);

}  // namespace sandhopper
