#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// The files of one configuration directory. All throw ConfigError with everything that is wrong.
namespace sandhopper {

RobotConfig load_robot(const std::filesystem::path& directory);

// `file` is linux.toml on the robot, bench.toml on the virtual bench. The motors are the robot's.
LinuxBoardConfig load_linux_board(const std::filesystem::path& directory, const char* file,
                                  const RobotConfig& robot);

}  // namespace sandhopper
