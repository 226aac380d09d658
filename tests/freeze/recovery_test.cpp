#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "firmware/cycle.hpp"
#include "firmware/freeze/newest_cycles.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "tests/freeze/folders.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

// A trial of the simulated robot with log and freeze ring, from idle to the hop.
class TrialWithRing {
 public:
  explicit TrialWithRing(Folders& folders) : recorder_(folders.options()) {
    TrialLogOptions options;
    options.mcap_file = log_ = folders.root() / "trial.mcap";
    options.own_thread = false;
    TrialLogger logger(options);
    const TrialTopics topics(logger);
    World world(WorldConfig{}, {}, 0);
    SimBoard board(world);
    Controller controller(CycleConfig{});
    Aftermath aftermath(StiffnessConfig{}, logger, topics, {});
    Cycle cycle({board, controller, logger, topics, aftermath, recorder_.ring()});
    logger.start();
    for (std::uint64_t i = 1; i <= kCycles; ++i) {
      const auto request = i == 300 ? Request::arm : i == 700 ? Request::release : Request::none;
      if (i == kSkippedAt) overruns_ = 3;
      number_ += i == kSkippedAt ? 4 : 1;
      cycle.run({.time_ns = static_cast<std::int64_t>(number_) * kCyclePeriod_ns,
                 .cycle = number_,
                 .overruns = overruns_,
                 .request = request});
      for (const auto& event : controller.events()) events_.push_back(event);
    }
    logger.stop();
    logger.close();
  }

  // The log cut after a share of its bytes, as after a kill.
  std::filesystem::path cut(double share) const {
    auto cut = log_;
    cut.replace_extension(".cut.mcap");
    std::filesystem::copy_file(log_, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(
        cut, static_cast<std::uintmax_t>(share * static_cast<double>(std::filesystem::file_size(log_))));
    return cut;
  }

  const std::filesystem::path& log() const { return log_; }
  std::uint64_t last_cycle() const { return number_; }
  const std::vector<Event>& events() const { return events_; }
  FreezeRing& ring() { return *recorder_.ring(); }

  static constexpr std::uint64_t kCycles = 1500;
  static constexpr std::uint64_t kSkippedAt = 200;

 private:
  FreezeRecorder recorder_;
  std::filesystem::path log_;
  std::uint64_t number_ = 0;
  std::uint32_t overruns_ = 0;
  std::vector<Event> events_;
};

struct Contents {
  std::vector<std::uint64_t> frames;
  std::vector<std::uint64_t> outputs;
  std::size_t events = 0;
};

Contents read(const std::filesystem::path& file) {
  Contents contents;
  mcap::Reader log(file);
  TopicOf<SensorFrame> frames(topic::kFrame);
  TopicOf<StepOutput> outputs(topic::kOutput);
  TopicOf<Event> events(topic::kEvent);
  mcap::Message message;
  SensorFrame frame;
  StepOutput output;
  Event event;
  while (log.next(message)) {
    if (frames.take(message, frame)) contents.frames.push_back(frame.cycle);
    if (outputs.take(message, output)) contents.outputs.push_back(output.cycle);
    contents.events += events.take(message, event) ? 1 : 0;
  }
  return contents;
}

TEST(RecoveryOfTheEnd, WhatTheRingHasIsInTheCopyWhereverTheLogWasCut) {
  Folders folders;
  TrialWithRing trial(folders);
  for (const double share : {0.31, 0.5, 0.501, 0.502, 0.77, 0.9}) {
    SCOPED_TRACE(share);
    const auto cut = trial.cut(share);
    const auto seen = look_at_mcap(cut);
    ASSERT_TRUE(seen.cycles);
    const auto newest = find_newest_cycles(*seen.cycles, {folders.memory()});
    ASSERT_TRUE(newest);
    const auto copy = folders.root() / "copy.mcap";
    std::filesystem::remove(copy);
    const auto found = recover_mcap(cut, copy, newest->cycles);
    EXPECT_TRUE(found.end_is_known());
    EXPECT_EQ(found.cycles->missing_at_end, 0U);
    EXPECT_EQ(found.cycles->last + found.cycles->restored, trial.last_cycle());
    EXPECT_EQ(found.cycles->missing_inside, 0U);
    EXPECT_EQ(found.cycles->skipped, 3U);
    const auto contents = read(copy);
    EXPECT_EQ(contents.frames, read(trial.log()).frames);
    EXPECT_EQ(contents.outputs, contents.frames);
    EXPECT_EQ(contents.events, trial.events().size());
  }
}

TEST(RecoveryOfTheEnd, WithoutARingNobodyKnowsWhatTheEndTook) {
  Folders folders;
  TrialWithRing trial(folders);
  const auto found = recover_mcap(trial.cut(0.5), folders.root() / "copy.mcap");
  EXPECT_FALSE(found.end_is_known());
  EXPECT_FALSE(found.cycles->missing_at_end);
  EXPECT_EQ(found.cycles->restored, 0U);
}

TEST(RecoveryOfTheEnd, AClosedLogHasLostNothing) {
  Folders folders;
  TrialWithRing trial(folders);
  const auto found = look_at_mcap(trial.log());
  EXPECT_TRUE(found.whole);
  EXPECT_TRUE(found.end_is_known());
  EXPECT_EQ(found.cycles->missing_at_end, 0U);
  EXPECT_EQ(found.cycles->last, trial.last_cycle());
}

TEST(RecoveryOfTheEnd, TheRingOfAnotherTrialIsNotTaken) {
  Folders folders;
  TrialWithRing trial(folders);
  auto seen = look_at_mcap(trial.cut(0.5));
  ++seen.cycles->first_ns;
  EXPECT_FALSE(find_newest_cycles(*seen.cycles, {folders.memory()}));
}

TEST(FreezeFrameOfATrialWithoutALog, IsWrittenAllTheSame) {
  Folders folders;
  auto recorder_options = folders.options();
  recorder_options.log_file.clear();
  FreezeRecorder recorder(recorder_options);
  TrialLogOptions options;
  options.own_thread = false;
  TrialLogger logger(options);
  const TrialTopics topics(logger);
  World world(WorldConfig{}, {}, 0);
  SimBoard board(world);
  Controller controller(CycleConfig{});
  Aftermath aftermath(StiffnessConfig{}, logger, topics, {});
  Cycle cycle({board, controller, logger, topics, aftermath, recorder.ring()});
  logger.start();
  for (std::uint64_t i = 1; i <= 700; ++i)
    cycle.run({.time_ns = static_cast<std::int64_t>(i) * kCyclePeriod_ns,
               .cycle = i,
               .watchdog_stall_ns = i == 500 ? 30'000'000 : 0});
  logger.stop();
  logger.close();
  EXPECT_EQ(logger.error(), "");
  recorder.stop();
  ASSERT_EQ(folders.told.size(), 1U);
  EXPECT_THAT(folders.told[0].filename().string(),
              ::testing::EndsWith("_no_log_watchdog_tripped.freeze.mcap"));
}

// The log is cut so early that the ring, which holds 8.2 s, does not reach back to the log's end.
TEST(RecoveryOfTheEnd, CyclesBetweenLogAndRingAreCounted) {
  Folders folders;
  TrialWithRing trial(folders);
  const auto cut = trial.cut(0.3);
  auto newest = find_newest_cycles(*look_at_mcap(cut).cycles, {folders.memory()})->cycles;
  newest.erase(newest.begin(), newest.end() - 100);
  const auto found = recover_mcap(cut, folders.root() / "copy.mcap", newest);
  EXPECT_EQ(found.cycles->restored, 100U);
  EXPECT_EQ(found.cycles->missing_at_end, trial.last_cycle() - 100 - found.cycles->last);
}

}  // namespace
}  // namespace sandhopper
