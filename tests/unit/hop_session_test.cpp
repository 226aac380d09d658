#include "firmware/hop_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "config/files.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/trial_description.hpp"
#include "firmware/operator_channel.hpp"
#include "tools/plant/sim_board.hpp"
#include "tools/trial/replay.hpp"

// The session in simulated time. Planned delays of the cycle must appear in the log and in the summary.
namespace sandhopper {
namespace {

constexpr std::int64_t kMs = 1'000'000;
const std::filesystem::path kConfig = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config";

class TestTime : public TimeSource {
 public:
  std::int64_t now_ns() noexcept override { return now_ns_; }
  void sleep_until(std::int64_t time_ns) noexcept override { now_ns_ = std::max(now_ns_, time_ns); }
  void pass(std::int64_t ns) noexcept { now_ns_ += ns; }

 private:
  std::int64_t now_ns_ = 0;
};

// Planned events by the number of the turn, counted from 1.
struct Plan {
  std::map<int, std::int64_t> sleep_ns;
  std::map<int, std::int64_t> step_ns;
  std::map<int, Quit> quit;
  std::map<int, std::vector<Word>> words;  // words that one read of the operator's pipe returns
  int trip_at = 0;
  StartState start{};
  int turns = 1000;
};

// The simulated robot with the planned events.
class PlannedBoard : public Board {
 public:
  PlannedBoard(TestTime& time, const Plan& plan, Heartbeat& heart, RequestBox& requests)
      : time_(time),
        plan_(plan),
        heart_(heart),
        requests_(requests),
        world_(WorldConfig{}, {}, 0),
        sim_(world_) {}

  void read(SensorFrame& frame) noexcept override { sim_.read(frame); }
  void write(const Command& command) noexcept override {
    sim_.write(command);
    ++turn;
    if (const auto sleep = plan_.sleep_ns.find(turn); sleep != plan_.sleep_ns.end())
      time_.pass(sleep->second);
    if (const auto step = plan_.step_ns.find(turn); step != plan_.step_ns.end()) offset_ns += step->second;
    if (const auto how = plan_.quit.find(turn); how != plan_.quit.end()) quit = how->second;
    if (const auto said = plan_.words.find(turn); said != plan_.words.end())
      post_words(said->second, time_.now_ns(), requests_, quit);
    if (turn == plan_.trip_at) heart_.trip(25'000'000);
    if (turn == plan_.turns) quit = Quit::softly;
  }

  std::atomic<Quit> quit{Quit::no};
  std::int64_t offset_ns = 1'800'000'000 * std::int64_t{1'000'000'000};
  int turn = 0;

 private:
  TestTime& time_;
  const Plan& plan_;
  Heartbeat& heart_;
  RequestBox& requests_;
  World world_;
  SimBoard sim_;
};

struct Recorded {
  SessionResult result;
  std::uint32_t overruns = 0;       // of the last frame in the log
  std::uint64_t missed = 0;         // cycles without a frame in the log
  std::vector<std::uint64_t> gaps;  // their lengths in cycles, in order
  std::vector<Event> events;
  std::vector<RequestRecord> requests;
  std::map<std::uint64_t, Request> inputs;  // by cycle, only cycles with a request
  std::optional<ReplayMismatch> mismatch;
  StateSample state{};  // the last sample published
};

void read_log(const std::filesystem::path& file, Recorded& out) {
  mcap::Reader log(file);
  TopicOf<SensorFrame> frames(topic::kFrame);
  TopicOf<Event> events(topic::kEvent);
  TopicOf<RequestRecord> requests(topic::kRequest);
  mcap::Message message;
  RequestRecord request;
  SensorFrame frame;
  Event event;
  std::uint64_t last = 0;
  while (log.next(message)) {
    if (events.take(message, event)) out.events.push_back(event);
    if (requests.take(message, request)) out.requests.push_back(request);
    if (!frames.take(message, frame)) continue;
    if (frame.request != Request::none) out.inputs[frame.cycle] = frame.request;
    if (frame.cycle > last + 1) out.gaps.push_back(frame.cycle - last - 1);
    out.missed += frame.cycle - last - 1;
    last = frame.cycle;
    out.overruns = frame.overruns;
  }
}

Recorded run(const Plan& plan) {
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("hop_session_") +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".mcap");
  std::filesystem::remove(file);
  Recorded out;
  {
    auto robot = load_robot(kConfig);
    robot.real_time = {.priority = 0, .lock_memory = false, .stack_prefault_kB = 0, .hold_cpu_awake = false};
    TrialLogOptions options;
    options.mcap_file = file;
    options.own_thread = false;
    TrialLogger logger(options);
    TestTime time;
    Heartbeat heart;
    RequestBox requests;
    PlannedBoard board(time, plan, heart, requests);
    describe_trial(logger, robot, "sim");
    describe_start(logger, plan.start);
    HopSession session(robot, board, logger, {}, plan.start);
    Latest<StateSample> state;
    out.result = session.run({.quit = board.quit,
                              .requests = requests,
                              .heart = heart,
                              .say = {},
                              .time = time,
                              .wall_clock = WallClock([&board] { return board.offset_ns; }),
                              .status = nullptr,
                              .state = &state});
    state.take(out.state);
    EXPECT_FALSE(heart.beating()) << "the end was not told to the watchdog";
    logger.close();
  }
  read_log(file, out);
  out.mismatch = replay_log(file).mismatch;
  std::filesystem::remove(file);
  return out;
}

// Each sleep begins at the start of a cycle, so it misses one cycle per whole millisecond.
std::uint64_t missed_by(const Plan& plan) {
  std::uint64_t missed = 0;
  for (const auto& [turn, sleep] : plan.sleep_ns) missed += static_cast<std::uint64_t>(sleep / kMs);
  return missed;
}

Plan planted(const std::map<int, double>& sleeps_ms) {
  Plan plan;
  for (const auto& [turn, ms] : sleeps_ms) plan.sleep_ns[turn] = static_cast<std::int64_t>(ms * 1e6);
  return plan;
}

void expect_counted(const Plan& plan) {
  const auto seen = run(plan);
  const auto count = missed_by(plan);
  EXPECT_EQ(seen.result.overruns, count) << "summary";
  EXPECT_EQ(seen.overruns, count) << "last frame in the log";
  EXPECT_EQ(seen.missed, count) << "frames missing in the log";
  EXPECT_EQ(seen.result.lost_records, 0U);
}

TEST(HopSession, ACycleThatKeepsTimeHasNoOverrun) {
  expect_counted(planted({}));
  expect_counted(planted({{100, 0.2}, {200, 0.999}}));
}

TEST(HopSession, OverrunsInLogAndSummaryAreThosePlanted) {
  expect_counted(planted({{100, 1.2}}));
  expect_counted(planted({{100, 3.7}}));
  expect_counted(planted({{1, 2.5}, {2, 1.1}, {900, 19.9}}));
  Plan bursts;
  for (const int start : {100, 300, 600})
    for (int turn = start; turn < start + 10; ++turn)
      bursts.sleep_ns[turn] = 1'200'000 + 100'000 * (turn % 3);
  expect_counted(bursts);
  EXPECT_EQ(missed_by(bursts), 30U);
}

TEST(HopSession, TheLogSaysWhenAndForHowLongTheCycleWasHeldUp) {
  EXPECT_THAT(run(planted({{100, 1.2}, {101, 3.7}, {500, 12.01}})).gaps, ::testing::ElementsAre(1, 3, 12));
}

TEST(HopSession, AGapOverTheLimitIsCountedAndEndsInItsFault) {
  const auto plan = planted({{400, 25.4}});
  expect_counted(plan);
  const auto seen = run(plan);
  EXPECT_EQ(seen.result.last_fault, Fault::cycle_gap);
  ASSERT_FALSE(seen.events.empty());
  EXPECT_EQ(seen.events.front().fault, Fault::cycle_gap);
  EXPECT_EQ(seen.events.front().values[0], 25.0);
  EXPECT_EQ(run(planted({{400, 20.4}})).result.last_fault, Fault::none) << "at the limit";
}

TEST(HopSession, AWatchdogThatTrippedMeanwhileIsTheFaultTheCycleWakesTo) {
  auto plan = planted({{400, 25.4}});
  plan.trip_at = 400;
  const auto seen = run(plan);
  EXPECT_EQ(seen.result.last_fault, Fault::watchdog_tripped);
  EXPECT_EQ(seen.result.last_state, State::fault);
  ASSERT_FALSE(seen.events.empty());
  EXPECT_EQ(seen.events.front().fault, Fault::watchdog_tripped);
  EXPECT_EQ(seen.events.front().values[0], 0.025) << "seconds";
}

TEST(HopSession, AStepOfTheDateIsAnEventAndDisturbsNothing) {
  Plan plan;
  plan.step_ns = {{300, -3600 * 1'000'000'000LL}, {500, 25'000'000}, {700, 1'000'000}};
  const auto seen = run(plan);
  EXPECT_EQ(seen.result.clock_steps, 2U) << "a millisecond is within what NTP slews";
  EXPECT_EQ(seen.result.overruns, 0U);
  EXPECT_EQ(seen.result.last_fault, Fault::none);
  ASSERT_EQ(seen.events.size(), 2U);
  EXPECT_EQ(seen.events[0].kind, EventKind::clock_stepped);
  EXPECT_EQ(seen.events[0].values[0], -3600.0);
  EXPECT_EQ(seen.events[1].values[0], 0.025);
}

TEST(HopSession, AskedTwiceToQuitItDoesNotWaitForTheRobot) {
  Plan softly;
  softly.turns = 500;
  Plan at_once = softly;
  at_once.quit = {{505, Quit::at_once}};
  EXPECT_GT(run(softly).result.cycles, 519U) << "the drives' last commands are sent and logged";
  EXPECT_EQ(run(at_once).result.cycles, 506U) << "one turn more";
}

// The requests and their outcomes, in words.
std::vector<std::string> answers_of(const Recorded& seen) {
  std::vector<std::string> answers;
  for (const auto& r : seen.requests) {
    answers.push_back(std::string(name_of(r.word)) + " " + std::string(name_of(r.outcome)));
    if (r.outcome == RequestOutcome::overruled) answers.back() += " " + std::string(name_of(r.overruled_by));
  }
  return answers;
}

bool happened(const Recorded& seen, EventKind kind) {
  return std::ranges::any_of(seen.events, [&](const Event& event) { return event.kind == kind; });
}

using ::testing::ElementsAre;

TEST(HopSession, StopAndReleaseInOneWriteAreAStop) {
  for (const auto& write : {std::vector{Word::stop, Word::release}, std::vector{Word::release, Word::stop}}) {
    Plan plan;
    plan.words = {{10, {Word::arm}}, {400, write}};
    plan.turns = 900;
    const auto seen = run(plan);
    EXPECT_FALSE(happened(seen, EventKind::released)) << "the robot was let go";
    EXPECT_THAT(answers_of(seen), ElementsAre("arm served", "stop served", "release overruled stop"));
    EXPECT_EQ(seen.result.last_state, State::idle);
    EXPECT_FALSE(seen.mismatch) << seen.mismatch->field;
  }
}

TEST(HopSession, StopAndArmInOneWriteInFlightEndTheHop) {
  Plan plan;
  plan.words = {{10, {Word::arm}}, {400, {Word::release}}, {520, {Word::stop, Word::arm}}};
  plan.turns = 8000;
  const auto seen = run(plan);
  EXPECT_TRUE(happened(seen, EventKind::released));
  EXPECT_TRUE(happened(seen, EventKind::stopped));
  EXPECT_FALSE(happened(seen, EventKind::liftoff)) << "it hopped on";
  EXPECT_THAT(answers_of(seen),
              ElementsAre("arm served", "release served", "stop served", "arm overruled stop"));
  EXPECT_FALSE(seen.mismatch) << seen.mismatch->field;
}

TEST(HopSession, AnUnknownWordStopsARobotThatHopsAndNotOneWhoseDrivesAreOff) {
  Plan plan;
  plan.words = {{5, {Word::unknown}}, {10, {Word::arm}}, {400, {Word::release}}, {520, {Word::unknown}}};
  plan.turns = 8000;
  const auto seen = run(plan);
  EXPECT_TRUE(happened(seen, EventKind::stopped));
  EXPECT_FALSE(happened(seen, EventKind::liftoff)) << "it hopped on";
  EXPECT_THAT(answers_of(seen),
              ElementsAre("unknown no_effect", "arm served", "release served", "unknown served"));
}

TEST(HopSession, EveryWordIsInTheLogWithTheTimesItWasReceivedAndServed) {
  Plan plan;
  plan.words = {{10, {Word::release}}, {20, {Word::arm, Word::release}}};
  const auto seen = run(plan);
  EXPECT_THAT(answers_of(seen), ElementsAre("release no_effect", "arm served", "release no_effect"));
  EXPECT_THAT(seen.inputs,
              ElementsAre(::testing::Pair(11, Request::release), ::testing::Pair(21, Request::arm),
                          ::testing::Pair(22, Request::release), ::testing::Pair(1001, Request::stop)));
  ASSERT_EQ(seen.requests.size(), 3U);
  // The first cycle is at 2 ms.
  for (const auto& [index, received, served] : {std::tuple{0U, 10, 11}, {1U, 20, 21}, {2U, 20, 22}}) {
    EXPECT_EQ(seen.requests[index].number, index + 1);
    EXPECT_EQ(seen.requests[index].received_ns, (received + 1) * kMs);
    EXPECT_EQ(seen.requests[index].time_ns, (served + 1) * kMs);
  }
  EXPECT_EQ(seen.requests[2].state, State::armed);
}

TEST(HopSession, AfterQuitNothingArmsAndEveryWordIsAnswered) {
  Plan plan;
  plan.words = {{100, {Word::arm, Word::quit, Word::disarm}}, {103, {Word::release}}, {121, {Word::arm}}};
  const auto seen = run(plan);
  EXPECT_THAT(answers_of(seen), ElementsAre("quit served", "arm overruled quit", "disarm served",
                                            "release overruled quit", "arm overruled quit"));
  EXPECT_FALSE(happened(seen, EventKind::armed));
  EXPECT_LT(seen.result.cycles, 130U);
}

// Without the start state in the log a replay would begin with cold motors and find no fault.
TEST(HopSession, StartsFromTheStateItIsGivenAndItsLogReplaysFromTheSame) {
  Plan plan;
  plan.start = {
      .temperatures_known = true, .winding_C = {111.0, 60.0}, .housing_C = {100.0, 50.0}, .touchdowns = 40};
  const auto seen = run(plan);
  EXPECT_EQ(seen.result.last_fault, Fault::motor_winding_hot);
  EXPECT_FALSE(seen.mismatch) << seen.mismatch->field;
  EXPECT_NEAR(seen.state.winding_C[1], 60.0, 0.5);
  EXPECT_NEAR(seen.state.housing_C[0], 100.0, 0.5);
  EXPECT_EQ(seen.state.touchdowns, 40U);
  EXPECT_EQ(seen.state.fault, Fault::motor_winding_hot);
  EXPECT_TRUE(std::isfinite(seen.state.position_rad[0]));
}

}  // namespace
}  // namespace sandhopper
