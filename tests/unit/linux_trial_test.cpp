#include "tools/trial/linux_trial.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "config/load.hpp"

namespace sandhopper {
namespace {

TEST(LinuxTrial, HopperdGetsTheRobotAndItsLogsQuotaAsConfigured) {
  const auto folder = std::filesystem::temp_directory_path() / ("linux_trial." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  RobotConfig robot;
  robot.log = {.segment_MB = 7, .quota_MB = 21};
  const auto command = daemon_command({.config_directory = folder,
                                       .devices = folder / "linux.toml",
                                       .robot = robot,
                                       .log = folder / "trial.mcap",
                                       .say = {}});
  const auto option = std::ranges::find(command, "--robot");
  ASSERT_NE(option, command.end());
  const auto given = load_file<RobotConfig>(*(option + 1));
  EXPECT_EQ(given.log.segment_MB, 7);
  EXPECT_EQ(given.log.quota_MB, 21);
  EXPECT_EQ(std::ranges::find(command, "--segment-MB"), command.end()) << "the file's keys must hold";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sandhopper
