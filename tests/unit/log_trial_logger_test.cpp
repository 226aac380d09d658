#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "firmware/log/can_log_tap.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/trial_logger.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {
namespace {

class TrialLog : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("sandhopper_logger_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  TrialLogOptions options(const std::string& name, bool own_thread) const {
    TrialLogOptions options;
    options.mcap_file = folder_ / (name + ".mcap");
    options.candump_file = folder_ / (name + ".can.log");
    options.realtime_offset_ns = 1'700'000'000'000'000'000;
    options.own_thread = own_thread;
    options.mcap.chunk_bytes = 32'768;
    return options;
  }
  std::string content(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  // One second of a trial. The result of a stride comes 3 ms after its instant.
  void run_trial(const TrialLogOptions& options) const {
    TrialLogger logger(options);
    const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
    const auto outputs = logger.add_topic<StepOutput>(topic::kOutput);
    const auto strides = logger.add_topic<StrideResult>(topic::kStride, Lane::background);
    const auto can = logger.add_can_interface("can0");
    logger.attach("robot.toml", "application/toml", "mass_kg = 1.0\n");
    logger.add_metadata("build", {{"version", "1"}});
    logger.start();
    for (int i = 0; i < 1'000; ++i) {
      SensorFrame frame;
      frame.time_ns = std::int64_t{1'000'000} * i;
      frame.cycle = static_cast<std::uint64_t>(i);
      logger.push(frames, frame.time_ns, frame);
      StepOutput output;
      output.time_ns = frame.time_ns;
      logger.push(outputs, output.time_ns, output);
      if (i % 250 == 103) logger.push(strides, frame.time_ns - 3'000'000, StrideResult{});
      logger.push_can(can, {.time_ns = frame.time_ns + 100'000, .id = 1, .direction = CanDirection::sent});
      logger.push_can(can,
                      {.time_ns = frame.time_ns - 700'000, .id = 0, .direction = CanDirection::received});
    }
    logger.stop();
    logger.close();
    EXPECT_EQ(logger.lost_records(), 0U);
    EXPECT_EQ(logger.lost_can_frames(), 0U);
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(TrialLog, EverythingPushedIsInTheFilesInOrder) {
  run_trial(options("a", true));
  mcap::Reader log(path("a.mcap"));
  ASSERT_EQ(log.attachments().size(), 1U);
  TopicOf<SensorFrame> frames("/frame");
  TopicOf<StepOutput> outputs("/output");
  TopicOf<StrideResult> strides("/stride");
  std::uint64_t frame_count = 0;
  std::uint64_t output_count = 0;
  std::uint64_t stride_count = 0;
  SensorFrame frame;
  StepOutput output;
  StrideResult stride;
  for (mcap::Message message; log.next(message);) {
    if (frames.take(message, frame)) {
      EXPECT_EQ(frame.cycle, frame_count++);
    } else if (outputs.take(message, output)) {
      EXPECT_EQ(output.time_ns, frame.time_ns);
      ++output_count;
    } else if (strides.take(message, stride)) {
      ++stride_count;
    }
  }
  EXPECT_EQ(frame_count, 1'000U);
  EXPECT_EQ(output_count, 1'000U);
  EXPECT_EQ(stride_count, 4U);
}

TEST_F(TrialLog, FilesDoNotShowWhenTheThreadRan) {
  run_trial(options("threaded", true));
  run_trial(options("inline", false));
  auto tiny = options("tiny", false);
  tiny.slots = 16;
  run_trial(tiny);
  EXPECT_EQ(content("threaded.mcap"), content("inline.mcap"));
  EXPECT_EQ(content("threaded.can.log"), content("inline.can.log"));
  EXPECT_EQ(content("tiny.mcap"), content("inline.mcap"));
  EXPECT_EQ(content("tiny.can.log"), content("inline.can.log"));
}

TEST_F(TrialLog, CanFramesAreInTheOrderOfTheirTimes) {
  run_trial(options("a", true));
  CandumpReader reader(path("a.can.log"));
  CandumpFrame frame;
  std::string_view interface;
  std::int64_t last_ns = 0;
  int count = 0;
  for (; reader.next(frame, interface); ++count) {
    EXPECT_GE(frame.time_ns, last_ns);
    last_ns = frame.time_ns;
    EXPECT_EQ(interface, "can0");
  }
  EXPECT_EQ(count, 2'000);
}

TEST_F(TrialLog, ATapLogsBothDirectionsOfItsSocket) {
  TrialLogger logger(options("a", false));
  CanLogTap tap(logger, "can1");
  can_frame frame{};
  frame.can_id = 0x123;
  frame.can_dlc = 2;
  frame.data[1] = 0xAB;
  tap.on_frame(frame, 5'000, true);
  frame.can_id = 0x868 | CAN_EFF_FLAG;
  tap.on_frame(frame, 6'000, false);
  logger.stop();
  EXPECT_EQ(content("a.can.log"),
            "(1700000000.000005) can1 123#00AB T\n(1700000000.000006) can1 00000868#00AB R\n");
}

// A tool that plays the text back must not send a frame that the guard refused.
TEST_F(TrialLog, AFrameRefusedByTheTransmitGuardIsAComment) {
  TrialLogger logger(options("a", false));
  CanLogTap tap(logger, "can1");
  can_frame frame{};
  frame.can_id = 0x001;
  frame.can_dlc = 2;
  frame.data[1] = 0xAB;
  tap.on_refused(frame, 5'000);
  tap.on_frame(frame, 6'000, true);
  logger.stop();
  EXPECT_EQ(content("a.can.log"),
            "# refused by the transmit guard: (1700000000.000005) can1 001#00AB\n"
            "(1700000000.000006) can1 001#00AB T\n");
}

TEST_F(TrialLog, WhatDoesNotFitLeavesAGapRecordInItsPlace) {
  auto small = options("a", true);
  small.slots = 8;
  TrialLogger logger(small);
  const auto events = logger.add_topic<Event>(topic::kEvent);
  for (int i = 0; i < 20; ++i) logger.push(events, i, Event{.time_ns = i});  // no thread takes them out yet
  EXPECT_EQ(logger.lost_records(), 12U);
  logger.start();
  for (std::uint64_t lost = 0; lost != logger.lost_records();) {  // until the thread has made space
    ::usleep(1'000);
    lost = logger.lost_records();
    logger.push(events, 100, Event{.time_ns = 100});
  }
  logger.stop();
  logger.close();

  mcap::Reader log(path("a.mcap"));
  TopicOf<Event> event_topic("/event");
  TopicOf<LogGap> gap_topic("/gap");
  Event event;
  LogGap gap;
  std::uint64_t events_seen = 0;
  std::uint64_t lost = 0;
  for (mcap::Message message; log.next(message);) {
    if (event_topic.take(message, event)) ++events_seen;
    if (!gap_topic.take(message, gap)) continue;
    EXPECT_EQ(events_seen, 8U) << "the gap belongs behind the eighth event";
    EXPECT_EQ(gap.first_lost_ns, 8);
    lost += gap.lost;
  }
  EXPECT_EQ(lost, logger.lost_records());
}

TEST_F(TrialLog, AFullDiskIsReportedAndStopsNothing) {
  auto full = options("a", true);
  full.candump_file.clear();
  full.mcap.chunk_bytes = 1'024;
  TrialLogger logger(full);
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  ::rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const ::rlimit small{16'384, before.rlim_max};  // acts like a full disk
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  for (int i = 0; i < 200; ++i) logger.push(frames, i, SensorFrame{.time_ns = i});
  logger.start();
  logger.stop();
  logger.close();
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(logger.error().find("File too large"), std::string::npos) << logger.error();
  mcap::Reader log(path("a.mcap"));
  std::uint64_t count = 0;
  for (mcap::Message message; log.next(message);)
    if (message.channel->topic == topic::kFrame) ++count;
  EXPECT_GT(count, 10U);
  EXPECT_EQ(logger.lost_records(), 200U - count);
}

}  // namespace
}  // namespace sandhopper
