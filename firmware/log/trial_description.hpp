#pragma once
#include <string_view>

#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"
#include "firmware/log/trial_logger.hpp"

namespace sandhopper {

inline constexpr std::string_view kRobotAttachment = "robot.toml";
inline constexpr std::string_view kBoardAttachment = "board.toml";
inline constexpr std::string_view kStartAttachment = "start.toml";

// What every trial's log carries besides its records: the robot's whole configuration and the build it was
// made by.
void describe_trial(TrialLogger& logger, const RobotConfig& robot, std::string_view board);

// Of a trial that does not start anew: what its cycle starts from, which a replay needs.
void describe_start(TrialLogger& logger, const StartState& start);

// Of a trial on devices: what turned their raw figures into the frames' SI units.
void describe_devices(TrialLogger& logger, const LinuxBoardConfig& devices);

}  // namespace sandhopper
