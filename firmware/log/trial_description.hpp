#pragma once
#include <string_view>

#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"
#include "firmware/log/trial_logger.hpp"

namespace sandhopper {

inline constexpr std::string_view kRobotAttachment = "robot.toml";
inline constexpr std::string_view kBoardAttachment = "board.toml";
inline constexpr std::string_view kStartAttachment = "start.toml";

// Adds to every trial's log the robot's whole configuration and the program's build.
void describe_trial(TrialLogger& logger, const RobotConfig& robot, std::string_view board);

// Adds the start state of a trial that has one. A replay needs it.
void describe_start(TrialLogger& logger, const StartState& start);

// Adds the configuration of a trial's devices, which converted their raw values into the frames' SI units.
void describe_devices(TrialLogger& logger, const LinuxBoardConfig& devices);

}  // namespace sandhopper
