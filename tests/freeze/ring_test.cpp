#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "firmware/freeze/freeze_folders.hpp"
#include "firmware/log/mapped_file.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"
#include "tests/freeze/folders.hpp"
#include "tools/explain/recording.hpp"

namespace sandhopper {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(FreezeRing, KeepsTheNewestCyclesAndForgetsTheOldest) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  ASSERT_NE(recorder.ring(), nullptr);
  MadeUpCycles cycles;
  cycles.run(*recorder.ring(), freeze::kSlots + 100);
  const FreezeReader reader(recorder.ring()->bytes());
  EXPECT_EQ(reader.count(), freeze::kSlots + 100);
  EXPECT_EQ(reader.oldest(), 101U);
  EXPECT_FALSE(reader.cycle(100));
  ASSERT_TRUE(reader.cycle(101));
  EXPECT_EQ(reader.cycle(101)->frame.cycle, 101U);
  EXPECT_FALSE(reader.cycle(freeze::kSlots + 101));
}

TEST(FreezeRing, CarriesWhatTheLogCarriesInFrontOfItsRecords) {
  Folders folders;
  auto options = folders.options();
  options.description.attachments = {{"robot.toml", "application/toml", "[limits]\n"}};
  options.description.metadata = {{"sandhopper", {{"board", "sim"}, {"version", "0.1.0"}}}};
  FreezeRecorder recorder(options);
  const auto description = FreezeReader(recorder.ring()->bytes()).description();
  ASSERT_EQ(description.attachments.size(), 1U);
  EXPECT_EQ(description.attachments[0].text, "[limits]\n");
  ASSERT_EQ(description.metadata.size(), 1U);
  EXPECT_EQ(description.metadata[0].second.at("board"), "sim");
}

TEST(FreezeRing, OfAnotherBuildIsRefusedByName) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  recorder.ring()->header().schema_hash ^= 1U;
  EXPECT_THROW(
      {
        try {
          FreezeReader reader(recorder.ring()->bytes());
        } catch (const std::runtime_error& error) {
          EXPECT_THAT(error.what(), HasSubstr("another build"));
          throw;
        }
      },
      std::runtime_error);
  recorder.ring()->header().schema_hash ^= 1U;
}

TEST(FreezeRecorder, WritesFiveSecondsBeforeAndOneAfterAFault) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  MadeUpCycles cycles;
  cycles.run(*recorder.ring(), 7000);
  cycles.raise(*recorder.ring(), Fault::bus_off);
  cycles.run(*recorder.ring(), 998);
  recorder.look();
  EXPECT_THAT(folders.told, IsEmpty()) << "before its second is over";
  cycles.run(*recorder.ring(), 500);
  recorder.look();
  ASSERT_EQ(folders.told.size(), 1U);
  EXPECT_THAT(folders.told[0].filename().string(), HasSubstr("_trial_007_bus_off.freeze.mcap"));
  const Recording recording = read_recording(folders.told[0]);
  ASSERT_EQ(recording.cycles.size(), 6001U);
  EXPECT_EQ(recording.cycles.front().first.cycle, 2001U);
  EXPECT_EQ(recording.cycles.back().first.cycle, 8001U);
  EXPECT_EQ(recording.time_ns, 7'002'000'000);
  recorder.look();
  EXPECT_EQ(folders.told.size(), 1U) << "once only";
}

TEST(FreezeRecorder, AtAnOrderlyEndWritesWhatThereIsAndGivesTheMemoryBack) {
  Folders folders;
  {
    FreezeRecorder recorder(folders.options());
    MadeUpCycles cycles;
    cycles.run(*recorder.ring(), 300);
    cycles.raise(*recorder.ring(), Fault::emergency_stop);
    cycles.run(*recorder.ring(), 40);
    recorder.stop();
  }
  ASSERT_EQ(folders.told.size(), 1U);
  EXPECT_EQ(read_recording(folders.told[0]).cycles.size(), 341U);
  EXPECT_TRUE(std::filesystem::is_empty(folders.memory()));
  EXPECT_THAT(freeze::files_in(folders.frames(), freeze::kDumpEnding), IsEmpty());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folders.frames()), {}), 1);
}

TEST(FreezeRecorder, EveryFaultHasAFrameOfItsOwnAndTheNewestAreKept) {
  Folders folders;
  auto options = folders.options();
  options.newest = 2;
  FreezeRecorder recorder(options);
  MadeUpCycles cycles;
  for (const auto fault : {Fault::tilt_limit, Fault::imu_stale, Fault::bus_off}) {
    cycles.run(*recorder.ring(), 10);
    cycles.raise(*recorder.ring(), fault);
  }
  cycles.run(*recorder.ring(), 1001);
  recorder.look();
  EXPECT_EQ(folders.told.size(), 3U);
  const auto kept = freeze::files_in(folders.frames(), freeze::kFrameEnding);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_THAT(kept[0].string(), HasSubstr("imu_stale"));
  EXPECT_THAT(kept[1].string(), HasSubstr("bus_off"));
}

TEST(FreezeRecorder, WithoutAFolderThatTakesFilesTheFrameStaysInMemoryAndTheNextStartBringsIt) {
  Folders folders;
  std::ofstream(folders.frames()) << "a file where the folder should be";
  {
    FreezeRecorder recorder(folders.options());
    MadeUpCycles cycles;
    cycles.run(*recorder.ring(), 20);
    cycles.raise(*recorder.ring(), Fault::drive_error);
    recorder.stop();
  }
  EXPECT_FALSE(folders.warnings.empty());
  ASSERT_EQ(folders.told.size(), 1U);
  EXPECT_EQ(folders.told[0].parent_path(), folders.memory());
  std::filesystem::remove(folders.frames());
  const auto moved = write_leftovers(folders.frames(), {folders.memory()}, folders.options().warn);
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_EQ(moved[0].parent_path(), folders.frames());
  EXPECT_TRUE(std::filesystem::is_empty(folders.memory()));
}

// Pushes cycles in a child process and kills it. With a guard, a child of that process writes the dump when
// its pipe to the parent breaks, as the guard process does.
void run_and_kill(const FreezeOptions& options, bool with_guard, std::uint64_t cycles, Fault fault) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    FreezeRecorder recorder(options);
    int line[2];
    if (::pipe(line) != 0) ::_exit(1);
    if (with_guard && ::fork() == 0) {
      ::close(line[1]);
      ::close(ready[0]);
      char none = 0;
      while (::read(line[0], &none, 1) > 0) {
      }
      recorder.dump()->run();
      ::_exit(0);
    }
    MadeUpCycles made_up;
    made_up.run(*recorder.ring(), cycles);
    if (fault != Fault::none) made_up.raise(*recorder.ring(), fault);
    [[maybe_unused]] const auto told = ::write(ready[1], "k", 1);
    ::pause();
  }
  ::close(ready[1]);
  char told = 0;
  ASSERT_EQ(::read(ready[0], &told, 1), 1);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  // The guard holds its end of the pipe open until it has written.
  while (::read(ready[0], &told, 1) > 0) {
  }
  ::close(ready[0]);
}

TEST(FreezeAfterSigkill, TheNextStartWritesTheLastSecondsFromMemory) {
  Folders folders;
  run_and_kill(folders.options(), false, 9000, Fault::none);
  const auto frames = write_leftovers(folders.frames(), {folders.memory()}, folders.options().warn);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_THAT(frames[0].string(), HasSubstr("_killed"));
  const Recording recording = read_recording(frames[0]);
  EXPECT_EQ(recording.cause, FreezeCause::killed);
  ASSERT_EQ(recording.cycles.size(), 5001U);
  EXPECT_EQ(recording.cycles.back().first.cycle, 9000U) << "to the last cycle";
  EXPECT_TRUE(std::filesystem::is_empty(folders.memory()));
}

TEST(FreezeAfterSigkill, AFaultThatHadNoFrameYetGetsOne) {
  Folders folders;
  run_and_kill(folders.options(), false, 6000, Fault::motor_reply_lost);
  const auto frames = write_leftovers(folders.frames(), {folders.memory()}, folders.options().warn);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_THAT(frames[0].string(), HasSubstr("motor_reply_lost"));
}

TEST(FreezeAfterSigkill, TheGuardWritesTheRingToTheDisk) {
  Folders folders;
  run_and_kill(folders.options(), true, 6500, Fault::none);
  const auto dumps = freeze::files_in(folders.frames(), freeze::kDumpEnding);
  ASSERT_EQ(dumps.size(), 1U);
  // Without the memory, as after a restart of the computer.
  for (const auto& ring : freeze::files_in(folders.memory(), freeze::kMemoryEnding))
    std::filesystem::remove(ring);
  EXPECT_EQ(read_recording(dumps[0]).cycles.back().first.cycle, 6500U);
  const auto frames = write_leftovers(folders.frames(), {folders.memory()}, folders.options().warn);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(read_recording(frames[0]).cycles.size(), 5001U);
  EXPECT_THAT(freeze::files_in(folders.frames(), freeze::kDumpEnding), IsEmpty());
}

TEST(FreezeAfterSigkill, RingAndDumpOfOneProcessGiveOneFrame) {
  Folders folders;
  run_and_kill(folders.options(), true, 100, Fault::none);
  write_leftovers(folders.frames(), {folders.memory()}, folders.options().warn);
  EXPECT_EQ(freeze::files_in(folders.frames(), freeze::kFrameEnding).size(), 1U);
}

TEST(FreezeLeftovers, TheRingOfARunningProcessIsLeftAlone) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  MadeUpCycles cycles;
  cycles.run(*recorder.ring(), 10);
  EXPECT_THAT(write_leftovers(folders.frames(), {folders.memory()}, folders.options().warn), IsEmpty());
  EXPECT_EQ(freeze::files_in(folders.memory(), freeze::kMemoryEnding).size(), 1U);
}

TEST(FreezeDump, OfAStandstillThatEndedIsHiddenAgainAndWrittenTheNextTime) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  MadeUpCycles cycles;
  cycles.run(*recorder.ring(), 10);
  recorder.dump()->run();
  EXPECT_EQ(freeze::files_in(folders.frames(), freeze::kDumpEnding).size(), 1U);
  cycles.run(*recorder.ring(), 10);
  recorder.look();
  EXPECT_THAT(freeze::files_in(folders.frames(), freeze::kDumpEnding), IsEmpty());
  recorder.dump()->run();
  const auto dumps = freeze::files_in(folders.frames(), freeze::kDumpEnding);
  ASSERT_EQ(dumps.size(), 1U);
  EXPECT_EQ(read_recording(dumps[0]).cycles.size(), 20U);
}

}  // namespace
}  // namespace sandhopper
