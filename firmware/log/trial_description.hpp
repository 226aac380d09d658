#pragma once
#include <string_view>

#include "config/robot_config.hpp"
#include "firmware/log/trial_logger.hpp"

namespace sandhopper {

inline constexpr std::string_view kRobotAttachment = "robot.toml";

// What every trial's log carries besides its records: the robot's whole configuration and the build it was
// made by.
void describe_trial(TrialLogger& logger, const RobotConfig& robot, std::string_view board);

}  // namespace sandhopper
