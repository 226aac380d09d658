#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

// Loads the files of one configuration directory. All functions throw ConfigError with every error found,
// including contradictions between values (config/consistency.hpp).
namespace sandhopper {

RobotConfig load_robot(const std::filesystem::path& directory);
RobotConfig load_robot_file(const std::filesystem::path& file);

// Name of the board's file on this machine: bench.toml on the virtual bench (a User Mode Linux kernel),
// otherwise linux.toml.
const char* board_file();

// Takes the motors from `robot`, and checks that the devices can represent its limits.
LinuxBoardConfig load_linux_board(const std::filesystem::path& file, const RobotConfig& robot);

}  // namespace sandhopper
