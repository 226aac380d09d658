#include "config/files.hpp"

#include <fstream>
#include <string>

#include "config/load.hpp"

namespace sandhopper {

RobotConfig load_robot(const std::filesystem::path& directory) {
  return load_file<RobotConfig>((directory / "robot.toml").string());
}

const char* board_file() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.find("User Mode Linux") != std::string::npos) return "bench.toml";
  return "linux.toml";
}

LinuxBoardConfig load_linux_board(const std::filesystem::path& file, const RobotConfig& robot) {
  auto board = load_file<LinuxBoardConfig>(file.string());
  board.can.motor = robot.motor;
  board.can.motor_torque_Nm = robot.limits.motor_torque_Nm;
  board.limits = robot.limits;
  return board;
}

}  // namespace sandhopper
