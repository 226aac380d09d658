#include "config/files.hpp"

#include "config/load.hpp"

namespace sandhopper {

RobotConfig load_robot(const std::filesystem::path& directory) {
  return load_file<RobotConfig>((directory / "robot.toml").string());
}

LinuxBoardConfig load_linux_board(const std::filesystem::path& directory, const char* file,
                                  const RobotConfig& robot) {
  auto board = load_file<LinuxBoardConfig>((directory / file).string());
  board.can.motor = robot.motor;
  return board;
}

}  // namespace sandhopper
