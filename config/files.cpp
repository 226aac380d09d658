#include "config/files.hpp"

#include <fstream>
#include <string>

#include "config/consistency.hpp"
#include "config/load.hpp"

namespace sandhopper {

RobotConfig load_robot(const std::filesystem::path& directory) {
  return load_robot_file(directory / "robot.toml");
}

RobotConfig load_robot_file(const std::filesystem::path& file) {
  const auto document = parse_config_file(file.string());
  auto robot = load_document<RobotConfig>(document);
  refuse(contradictions(robot), document);
  return robot;
}

const char* board_file() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.find("User Mode Linux") != std::string::npos) return "bench.toml";
  return "linux.toml";
}

LinuxBoardConfig load_linux_board(const std::filesystem::path& file, const RobotConfig& robot) {
  const auto document = parse_config_file(file.string());
  auto board = load_document<LinuxBoardConfig>(document);
  refuse(contradictions(board, robot), document);
  board.can.motor = robot.motor;
  board.can.motor_torque_Nm = robot.limits.motor_torque_Nm;
  board.limits = robot.limits;
  return board;
}

}  // namespace sandhopper
