// Logs on a disk that is full, fails, or is slow.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numeric>

#include "firmware/log/can_log.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/trial_logger.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "tests/unit/failing_disk.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr int kFramesOfAChunk = 39;  // a chunk has 16 kB, see options()

struct Found {
  std::vector<std::uint64_t> cycles;
  std::vector<LogGap> gaps;
  bool closed = false;

  std::uint64_t lost() const {
    return std::accumulate(gaps.begin(), gaps.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const LogGap& gap) { return sum + gap.lost; });
  }
};

class LogDisk : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("sandhopper_disk_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  TrialLogOptions options() {
    TrialLogOptions options;
    options.mcap_file = folder_ / "trial.mcap";
    options.realtime_offset_ns = 1'700'000'000'000'000'000;
    options.own_thread = false;
    options.slots = 16;
    options.mcap.chunk_bytes = 16'384;
    options.mcap.calls = disk_.calls();
    options.say = [this](const std::string& text) { said_.push_back(text); };
    return options;
  }
  static void push_cycles(TrialLogger& logger, LogTopic<SensorFrame> frames, int from, int to) {
    for (int i = from; i < to; ++i) {
      SensorFrame frame;
      frame.time_ns = kMillisecond_ns * i;
      frame.cycle = static_cast<std::uint64_t>(i);
      logger.push(frames, frame.time_ns, frame);
    }
  }
  Found read(const std::string& name = "trial.mcap") const {
    Found found;
    mcap::Reader log(folder_ / name);
    TopicOf<SensorFrame> frames(topic::kFrame);
    TopicOf<LogGap> gaps(topic::kGap);
    SensorFrame frame;
    LogGap gap;
    for (mcap::Message message; log.next(message);) {
      if (frames.take(message, frame)) found.cycles.push_back(frame.cycle);
      if (gaps.take(message, gap)) found.gaps.push_back(gap);
    }
    found.closed = !log.truncated_at();
    return found;
  }

  // The gap record must cover exactly the times of the missing cycles.
  static void expect_gap_in_its_place(const Found& found) {
    const LogGap& gap = found.gaps.at(0);
    const auto before = std::adjacent_find(found.cycles.begin(), found.cycles.end(),
                                           [](auto a, auto b) { return b != a + 1; });
    ASSERT_NE(before, found.cycles.end());
    EXPECT_EQ(gap.first_lost_ns, kMillisecond_ns * static_cast<std::int64_t>(*before + 1));
    EXPECT_EQ(gap.last_lost_ns, kMillisecond_ns * static_cast<std::int64_t>(*(before + 1) - 1));
    EXPECT_EQ(*(before + 1) - *before - 1, gap.lost);
  }

  FailingDisk disk_;
  std::filesystem::path folder_;
  std::vector<std::string> said_;
};

TEST_F(LogDisk, OnAFullDiskTheLogIsClosedAndSaysWhatIsMissing) {
  constexpr int kLast = 145 * kFramesOfAChunk + 4;  // the last chunk is small enough for the remaining space
  TrialLogger logger(options());
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  logger.start();
  push_cycles(logger, frames, 0, 500);
  disk_.capacity_bytes = 400'000;  // less than is allocated already: no more space from now on
  push_cycles(logger, frames, 500, kLast);
  logger.stop();
  logger.attach("wake_latency_us.json", "application/json", "[]");
  logger.close();

  const Found found = read();
  EXPECT_TRUE(found.closed);
  ASSERT_EQ(found.gaps.size(), 1U);
  EXPECT_EQ(found.gaps[0].cause, LossCause::write_failed);
  EXPECT_EQ(found.cycles.size() + found.gaps[0].lost, std::size_t{kLast});
  EXPECT_EQ(found.gaps[0].lost, logger.lost_records());
  expect_gap_in_its_place(found);
  ASSERT_GE(said_.size(), 1U);
  EXPECT_LE(said_.size(), 2U)
      << "said as it begins, and when a last, smaller chunk fits after all; not each time";
  EXPECT_NE(said_[0].find("No space left on device"), std::string::npos) << said_[0];
  mcap::Reader log(folder_ / "trial.mcap");
  for (mcap::Message message; log.next(message);) continue;
  EXPECT_EQ(log.attachments().size(), 1U) << "what is attached at the end has its place in the reserve";
}

TEST_F(LogDisk, WhenThereIsRoomAgainTheLogGoesOnBehindAGapRecord) {
  TrialLogger logger(options());
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  logger.start();
  push_cycles(logger, frames, 0, 300);
  disk_.write_error = EIO;
  push_cycles(logger, frames, 300, 900);
  disk_.write_error = 0;
  push_cycles(logger, frames, 900, 1'500);
  logger.stop();
  logger.close();

  const Found found = read();
  EXPECT_TRUE(found.closed);
  ASSERT_EQ(found.gaps.size(), 1U);
  EXPECT_EQ(found.cycles.size() + found.gaps[0].lost, 1'500U);
  EXPECT_EQ(found.gaps[0].lost, logger.lost_records());
  expect_gap_in_its_place(found);
  ASSERT_EQ(said_.size(), 2U);
  EXPECT_NE(said_[0].find("Input/output error"), std::string::npos) << said_[0];
}

TEST_F(LogDisk, GapRecordsThatAreLostAreSaidAgain) {
  auto threaded = options();
  threaded.own_thread = true;
  threaded.slots = 8;
  TrialLogger logger(threaded);
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  disk_.write_error = EROFS;
  push_cycles(logger, frames, 0, 1'000);  // no thread takes them out, so the ring fills up
  logger.start();
  ::usleep(50'000);
  push_cycles(logger, frames, 1'000, 1'004);
  ::usleep(50'000);
  disk_.write_error = 0;
  logger.stop();
  logger.close();
  const Found found = read();
  EXPECT_EQ(found.cycles.size() + found.lost(), 1'004U);
  EXPECT_EQ(found.lost(), logger.lost_records());
}

// If space cannot be allocated beforehand, a write that fails half-way must leave nothing in the file.
TEST_F(LogDisk, AFileSystemThatCannotAllocateLeavesWholeChunks) {
  constexpr int kAll = 24 * kFramesOfAChunk + 36;  // 36 frames need as much space as a whole chunk
  disk_.can_allocate = false;
  TrialLogger logger(options());
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  logger.start();
  disk_.capacity_bytes = 100'000;
  push_cycles(logger, frames, 0, kAll);
  logger.stop();
  disk_.capacity_bytes = 110'000;  // a little more space becomes free
  logger.close();
  EXPECT_GT(logger.lost_records(), 100U);
  const Found found = read();
  EXPECT_EQ(found.cycles.size() + logger.lost_records(), std::size_t{kAll});
  for (std::size_t i = 0; i < found.cycles.size(); ++i) ASSERT_EQ(found.cycles[i], i);
}

TEST_F(LogDisk, ADiskThatCannotSyncIsInTheLog) {
  disk_.sync_error = EIO;
  TrialLogger logger(options());
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  logger.start();
  push_cycles(logger, frames, 0, 2'500);
  logger.stop();
  logger.close();
  const Found found = read();
  EXPECT_EQ(found.cycles.size(), 2'500U);
  ASSERT_GE(found.gaps.size(), 2U);
  EXPECT_EQ(found.gaps[0].cause, LossCause::sync_failed);
  EXPECT_EQ(found.lost(), 0U);
  EXPECT_FALSE(logger.error().empty());
}

TEST_F(LogDisk, ASlowDiskCostsRecordsAndNotTheCycle) {
  auto threaded = options();
  threaded.own_thread = true;
  threaded.slots = 64;
  disk_.delay_us = 50'000;
  TrialLogger logger(threaded);
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  logger.start();
  for (int i = 0; i < 3'000; ++i) {
    push_cycles(logger, frames, i, i + 1);
    if (i % 10 == 9) ::usleep(1'000);  // ten times as fast as the cycle
  }
  disk_.delay_us = 0;
  logger.stop();
  logger.close();
  const Found found = read();
  EXPECT_GT(logger.lost_records(), 0U);
  EXPECT_EQ(found.cycles.size() + found.lost(), 3'000U);
  EXPECT_EQ(found.lost(), logger.lost_records());
  for (const LogGap& gap : found.gaps) EXPECT_EQ(gap.cause, LossCause::ring_full);
}

TEST_F(LogDisk, AFullDiskAtTheStartIsRefused) {
  disk_.capacity_bytes = 100'000;  // less than the reserve for the end of the log
  EXPECT_THROW(TrialLogger{options()}, std::system_error);
}

TEST_F(LogDisk, AReadOnlyFolderIsRefusedAtTheStart) {
  auto elsewhere = options();
  elsewhere.mcap_file = "/proc/self/trial.mcap";  // not even root can create a file there
  EXPECT_THROW(TrialLogger{elsewhere}, std::system_error);
}

TEST_F(LogDisk, SegmentsAreWholeLogsAndTheOldestGoWhenTheQuotaIsReached) {
  auto segments = options();
  segments.limits = {.segment_bytes = 100'000, .quota_bytes = 350'000};
  segments.candump_file = folder_ / "trial.candump";
  TrialLogger logger(segments);
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  const auto can = logger.add_can_interface("can0");
  logger.attach("robot.toml", "application/toml", "mass_kg = 1.0\n");
  logger.start();
  for (int i = 0; i < 2'000; ++i) {
    push_cycles(logger, frames, i, i + 1);
    logger.push_can(can, {.time_ns = kMillisecond_ns * i, .id = 1, .direction = CanDirection::sent});
  }
  logger.stop();
  logger.close();
  EXPECT_EQ(logger.lost_records(), 0U);

  std::vector<std::string> names;
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    bytes += entry.file_size();
    if (entry.path().extension() == ".mcap") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  ASSERT_GE(names.size(), 2U);
  EXPECT_LE(bytes, 350'000U + 20'000U) << "the summaries come on top";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "trial.mcap")) << "the oldest has gone";
  std::uint64_t next = 0;
  std::uint64_t removed = 0;
  for (const auto& name : names) {
    const Found found = read(name);
    EXPECT_TRUE(found.closed) << name;
    mcap::Reader log(folder_ / name);
    EXPECT_EQ(log.attachments().size(), 1U) << name;
    EXPECT_TRUE(std::filesystem::exists((folder_ / name).replace_extension(".candump"))) << name;
    if (next != 0) {
      EXPECT_EQ(found.cycles.front(), next) << name;
    }
    next = found.cycles.back() + 1;
    for (const LogGap& gap : found.gaps) {
      EXPECT_EQ(gap.cause, LossCause::segment_removed);
      removed = std::max(removed, static_cast<std::uint64_t>(gap.last_lost_ns / kMillisecond_ns) + 1);
    }
  }
  EXPECT_EQ(next, 2'000U);
  EXPECT_EQ(read(names.front()).cycles.front(), removed) << "what is gone is said in what is left";
}

TEST_F(LogDisk, CanFramesTheDiskDoesNotTakeAreCountedInAComment) {
  CanLog log(folder_ / "trial.candump", 0, 1'024, disk_.calls());
  const auto can = log.add_interface("can0");
  const auto push = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      log.push(can, {.time_ns = kMillisecond_ns * i, .id = 1});
      log.drain();
    }
  };
  push(0, 5'000);
  disk_.write_error = ENOSPC;
  push(5'000, 10'000);
  disk_.write_error = 0;
  push(10'000, 12'000);
  log.close();
  std::ifstream in(folder_ / "trial.candump");
  std::uint64_t lines = 0;
  std::uint64_t lost = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("# "))
      lost += std::stoull(line.substr(2));
    else
      ++lines;
  }
  EXPECT_GT(lost, 3'000U);
  EXPECT_EQ(lost, log.lost());
  EXPECT_EQ(lines + lost, 12'000U);
  EXPECT_NE(log.error().find("No space left"), std::string::npos);
}

}  // namespace
}  // namespace sandhopper
