#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// The files of one configuration directory. All throw ConfigError with everything that is wrong, values that
// contradict each other included (config/consistency.hpp).
namespace sandhopper {

RobotConfig load_robot(const std::filesystem::path& directory);
RobotConfig load_robot_file(const std::filesystem::path& file);

// The board's file on this machine: bench.toml on the virtual bench (a User Mode Linux kernel), else
// linux.toml.
const char* board_file();

// The motors are the robot's, and the devices must carry its limits.
LinuxBoardConfig load_linux_board(const std::filesystem::path& file, const RobotConfig& robot);

}  // namespace sandhopper
