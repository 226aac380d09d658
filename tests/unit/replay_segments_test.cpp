#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "config/dump.hpp"
#include "firmware/cycle.hpp"
#include "firmware/log/trial_description.hpp"
#include "tools/plant/sim_board.hpp"
#include "tools/trial/replay.hpp"

namespace sandhopper {
namespace {

constexpr std::uint64_t kCycles = 4000;

enum class Serve { each_cycle, at_the_end };

// Records a trial whose log begins a new file after 600 kB each. `robot_toml`: configuration to store in the
// log instead of the full one.
void record(const std::filesystem::path& file, std::string_view robot_toml = {}, const WorldConfig& bed = {},
            Serve serve = Serve::each_cycle) {
  const RobotConfig robot;
  TrialLogOptions options;
  options.mcap_file = file;
  options.own_thread = false;
  options.limits = {.segment_bytes = 600'000, .quota_bytes = 0};
  TrialLogger logger(options);
  const TrialTopics topics(logger);
  if (robot_toml.empty())
    describe_trial(logger, robot, "sim");
  else
    logger.attach(kRobotAttachment, "application/toml", robot_toml);
  logger.start();
  World world(bed, {}, 0);
  SimBoard board(world);
  Controller controller(cycle_config(robot));
  Aftermath aftermath(robot.stiffness, logger, topics, {});
  Cycle cycle({board, controller, logger, topics, aftermath});
  Request request = Request::arm;
  for (std::uint64_t k = 1; k <= kCycles; ++k) {
    cycle.run({.time_ns = static_cast<std::int64_t>(k) * kCyclePeriod_ns, .cycle = k, .request = request});
    if (serve == Serve::each_cycle) aftermath.serve();
    request = Request::none;
    for (const auto& event : controller.events())
      if (event.kind == EventKind::armed) request = Request::release;
  }
  aftermath.serve();
  logger.stop();
  logger.close();
}

TEST(Replay, ALogInSeveralFilesIsReplayedWhole) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("replay_segments." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  record(folder / "trial.mcap");
  const auto result = replay_log(folder / "trial.mcap");
  EXPECT_GE(result.files, 3U);
  EXPECT_EQ(result.cycles, kCycles);
  EXPECT_EQ(result.strides, 3U);
  EXPECT_FALSE(result.mismatch) << result.mismatch->topic << " " << result.mismatch->record << " "
                                << result.mismatch->field;
  std::filesystem::remove_all(folder);
}

// In a deep crater the foot is clear long after liftoff. A record later than that instant must also be read
// after it.
TEST(Replay, GroundEventsAreTheSameHoweverLateTheFootIsClear) {
  WorldConfig bed;
  bed.bed_family = bed_family_of(BedFamily::stiff_over_soft);
  const auto folder = std::filesystem::temp_directory_path() / ("replay_deep." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  record(folder / "trial.mcap", {}, bed);
  const auto result = replay_log(folder / "trial.mcap");
  EXPECT_GE(result.strides, 1U);
  EXPECT_FALSE(result.mismatch) << result.mismatch->topic << " " << result.mismatch->record << " "
                                << result.mismatch->field;
  std::filesystem::remove_all(folder);
}

// The search for ground events uses the profile after their own stride, not that of a later one.
TEST(Replay, ResultsAreTheSameHoweverLateTheyAreComputed) {
  WorldConfig bed;
  bed.bed_family = bed_family_of(BedFamily::crust);
  const auto folder = std::filesystem::temp_directory_path() / ("replay_late." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  record(folder / "trial.mcap", {}, bed, Serve::at_the_end);
  const auto result = replay_log(folder / "trial.mcap");
  EXPECT_GE(result.strides, 2U);
  EXPECT_FALSE(result.mismatch) << result.mismatch->topic << " " << result.mismatch->record << " "
                                << result.mismatch->field;
  std::filesystem::remove_all(folder);
}

TEST(Replay, ALogFromBeforeAConfigurationKeyHasItsDefault) {
  const auto folder = std::filesystem::temp_directory_path() / ("replay_older." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  auto older = to_toml(RobotConfig{});
  const auto log_table = older.find("[log]");
  ASSERT_NE(log_table, std::string::npos);
  older.resize(log_table);
  record(folder / "trial.mcap", older);
  const auto result = replay_log(folder / "trial.mcap");
  EXPECT_EQ(result.cycles, kCycles);
  EXPECT_FALSE(result.mismatch);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sandhopper
