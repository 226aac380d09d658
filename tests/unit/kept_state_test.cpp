#include "firmware/state/kept_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "firmware/controller.hpp"
#include "firmware/state/recollection.hpp"
#include "firmware/state/state_keeper.hpp"

// State that the robot keeps from run to run, and its assumptions if the state is missing or wrong.
namespace sandhopper {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

StateClock clock_at(double boottime_s, double realtime_s, const std::string& boot = "b1") {
  return {boot, static_cast<std::int64_t>(boottime_s * 1e9), static_cast<std::int64_t>(realtime_s * 1e9),
          true};
}

StateSample warm() {
  StateSample sample;
  sample.winding_C = {90.0, 80.0};
  sample.housing_C = {70.0, 60.0};
  sample.position_rad = {1.0, 1.1};
  sample.touchdowns = 1234;
  return sample;
}

StateRead kept(const StateClock& clock, bool closed = true, double period_s = 1.0,
               const StateSample& sample = warm()) {
  return state_from_text(state_text(kept_state(sample, clock, period_s, closed)));
}

const StateRead kNone{std::nullopt, false, "no such file"};

Recollection recall(const StateRead& boot, const StateRead& lasting, const StateClock& now) {
  return recollect(boot, lasting, now, RobotConfig{});
}

void expect_hot(const Recollection& r, const std::string& because) {
  EXPECT_FALSE(r.trusted);
  EXPECT_TRUE(r.start.temperatures_known);
  for (const double t :
       {r.start.winding_C[0], r.start.winding_C[1], r.start.housing_C[0], r.start.housing_C[1]})
    EXPECT_DOUBLE_EQ(t, 93.0);
  EXPECT_THAT(r.text, HasSubstr(because));
  EXPECT_THAT(r.text, HasSubstr("--motors-cold"));
}

TEST(KeptState, IsReadBackAsItWasWritten) {
  const auto read = kept(clock_at(100.0, 5000.0), false, 10.0);
  ASSERT_TRUE(read.state) << read.problem;
  EXPECT_EQ(state_text(*read.state), state_text(kept_state(warm(), clock_at(100.0, 5000.0), 10.0, false)));
  EXPECT_EQ(read.state->touchdowns, 1234U);
  EXPECT_EQ(read.state->winding_C[1], 80.0);
}

TEST(KeptState, EveryChangedByteAndEveryCutIsRefused) {
  const auto text = state_text(kept_state(warm(), clock_at(1.0, 2.0), 1.0, true));
  for (std::size_t i = 0; i < text.size(); ++i) {
    auto changed = text;
    changed[i] = static_cast<char>(changed[i] ^ 0x04);
    EXPECT_FALSE(state_from_text(changed).state) << "byte " << i;
    EXPECT_FALSE(state_from_text(text.substr(0, i)).state) << "cut at " << i;
  }
  EXPECT_FALSE(state_from_text(text + " ").state);
}

TEST(KeptState, AStateOfThisBootCoolsByTheTimeSinceWhateverTheDateDoes) {
  const auto boot = kept(clock_at(100.0, 5000.0));
  double winding_C = 90.0, housing_C = 70.0;
  cool(SupervisionConfig{}, 200.0, winding_C, housing_C);
  EXPECT_LT(winding_C, 70.0);
  for (const double date : {5200.0, 0.0, 1e9}) {
    const auto r = recall(boot, kept(clock_at(100.0, 5000.0), true, 10.0), clock_at(300.0, date));
    EXPECT_TRUE(r.trusted);
    EXPECT_DOUBLE_EQ(r.start.winding_C[0], winding_C);
    EXPECT_DOUBLE_EQ(r.start.housing_C[0], housing_C);
    EXPECT_EQ(r.start.touchdowns, 1234U);
  }
}

TEST(KeptState, CoolingIsNeverColderThanTheModelAndCloseToIt) {
  const SupervisionConfig config;
  for (const double age_s : {0.0, 1.0, 30.0, 300.0, 3000.0}) {
    ThermalModel model(config, 100.0, 60.0);
    for (double t = 0.5e-3; t < age_s; t += 1e-3) model.step(0.0, 1e-3);
    double winding_C = 100.0, housing_C = 60.0;
    cool(config, age_s, winding_C, housing_C);
    EXPECT_GE(winding_C, model.winding_C() - 1e-2) << age_s;
    EXPECT_NEAR(winding_C, model.winding_C(), 0.5) << age_s;
    EXPECT_NEAR(housing_C, model.housing_C(), 0.5) << age_s;
  }
  double winding_C = 100.0, housing_C = 60.0;
  cool(config, 1e9, winding_C, housing_C);
  EXPECT_NEAR(winding_C, config.ambient_C, 1e-3);
}

TEST(KeptState, AnotherBootsStateCoolsByTheDateIfBothClocksAreRight) {
  const auto lasting = kept(clock_at(100.0, 5000.0), true, 10.0);
  const auto r = recall(kNone, lasting, clock_at(50.0, 5400.0, "b2"));
  EXPECT_TRUE(r.trusted);
  double winding_C = 90.0, housing_C = 70.0;
  cool(SupervisionConfig{}, 400.0, winding_C, housing_C);
  EXPECT_DOUBLE_EQ(r.start.winding_C[0], winding_C);
}

TEST(KeptState, WithoutARightDateOnlyTheTimeSinceBootCounts) {
  const auto lasting = kept(clock_at(100.0, 5000.0), true, 10.0);
  auto now = clock_at(50.0, 1e9, "b2");
  now.synchronised = false;
  double winding_C = 90.0, housing_C = 70.0;
  cool(SupervisionConfig{}, 50.0, winding_C, housing_C);
  EXPECT_DOUBLE_EQ(recall(kNone, lasting, now).start.winding_C[0], winding_C);
}

TEST(KeptState, WhatCannotBeTrustedIsAssumedHot) {
  const auto now = clock_at(300.0, 5200.0);
  const auto lasting = kept(clock_at(100.0, 5000.0), true, 10.0);
  expect_hot(recall(kNone, kNone, now), "no state was kept yet");
  expect_hot(recall(kNone, lasting, now), "this boot's newest state is gone");
  expect_hot(recall({std::nullopt, true, "checksum"}, lasting, now), "cannot be read: checksum");
  expect_hot(recall(kNone, {std::nullopt, true, "checksum"}, now), "cannot be read: checksum");
  expect_hot(recall(kNone, lasting, clock_at(20.0, 4999.0, "b2")), "the date is earlier");
  expect_hot(recall(kept(clock_at(400.0, 5000.0)), lasting, now), "younger than now");
  expect_hot(recall(kept(clock_at(100.0, 5000.0, "b1")), kNone, clock_at(300.0, 5200.0, "b2")),
             "no state was kept yet");
  auto nameless = now;
  nameless.boot_id.clear();
  expect_hot(recall(kept(clock_at(100.0, 5000.0, "")), kNone, nameless), "no state was kept yet");
}

TEST(KeptState, ARunThatWasKilledMayHaveHeatedForOnePeriodAtTheTorqueLimit) {
  const auto now = clock_at(100.0, 5000.0);
  const auto closed = recall(kept(now, true), kNone, now);
  const auto killed = recall(kept(now, false), kNone, now);
  const auto killed_long =
      recall(kNone, kept(clock_at(100.0, 5000.0), false, 10.0), clock_at(0.0, 5000.0, "b2"));
  // 1.5 x 62.5 mOhm x (2.8 / 0.0868 A)^2 = 97.6 W into 40 J/K, minus the heat flow to the housing.
  EXPECT_NEAR(killed.start.winding_C[0] - closed.start.winding_C[0], 97.6 / 40.0, 0.6);
  EXPECT_NEAR(killed_long.start.winding_C[0] - closed.start.winding_C[0], 97.6 * 10.0 / 40.0, 8.0);
  EXPECT_THAT(killed.text, HasSubstr("did not end in order"));
}

TEST(KeptState, AFaultThatNeedsARestartSurvivesACrashAndNotARestartInOrder) {
  auto sample = warm();
  sample.fault = Fault::bus_off;
  const auto now = clock_at(100.0, 5000.0);
  EXPECT_EQ(recall(kept(now, true, 1.0, sample), kNone, now).start.fault, Fault::none);
  EXPECT_EQ(recall(kept(now, false, 1.0, sample), kNone, now).start.fault, Fault::bus_off);
  sample.fault = Fault::imu_stale;
  EXPECT_EQ(recall(kept(now, false, 1.0, sample), kNone, now).start.fault, Fault::none);
}

SensorFrame still_frame(std::uint64_t cycle, double current_A) {
  SensorFrame frame;
  frame.cycle = cycle;
  frame.time_ns = static_cast<std::int64_t>(cycle) * 1'000'000;
  for (auto& motor : frame.motor) {
    motor.fresh = true;
    motor.time_ns = frame.time_ns - 1'000'000;
    motor.position_rad = 1.0;
    motor.current_A = current_A;
  }
  return frame;
}

TEST(KeptState, AFaultOfTheLastRunHoldsArmingBackUntilDisarmed) {
  CycleConfig config;
  config.start.fault = Fault::bus_off;
  Controller controller(config);
  controller.switch_off(Fault::bus_off);
  auto frame = still_frame(1, 0.0);
  frame.request = Request::arm;
  EXPECT_EQ(controller.step(frame).state, State::fault);
  EXPECT_FALSE(controller.request_had_effect());
  frame = still_frame(2, 0.0);
  frame.request = Request::disarm;
  EXPECT_EQ(controller.step(frame).state, State::idle);
}

TEST(KeptState, TouchdownsCountOnFromRunToRun) {
  CycleConfig config;
  config.start.touchdowns = 100'001;
  Controller controller(config);
  EXPECT_EQ(controller.step(still_frame(1, 0.0)).fault, Fault::hop_count_limit);
  EXPECT_EQ(controller.touchdowns(), 100'001U);
}

TEST(KeptState, APositionPastTheDrivesRangeIsTold) {
  auto sample = warm();
  sample.position_rad[1] = 13.0;
  const auto now = clock_at(100.0, 5000.0);
  EXPECT_THAT(recall(kept(now, true, 1.0, sample), kNone, now).positions,
              HasSubstr("motor right stood at 13.00"));
  EXPECT_EQ(recall(kept(now), kNone, now).positions, "");
}

// 400 trials, each with a new controller as in a new process: two seconds at 25 A, five without current; the
// computer boots after every 50th. The state passes through the bytes of the file at each start.
TEST(KeptState, After400TrialsTheModelIsWithin3DegreesOfOneThatRanOnAndAColdStartIsNot) {
  const CycleConfig cold;
  ThermalModel reference(cold.supervision);
  StateRead boot = kNone, lasting = kNone;
  double worst_C = 0.0, now_s = 1000.0, booted_s = 0.0, last_cold_C = 0.0, last_reference_C = 0.0;
  int boots = 0;
  constexpr double kOn_s = 2.0, kPause_s = 5.0;
  for (int trial = 0; trial < 400; ++trial) {
    if (trial % 50 == 49) {
      ++boots;
      booted_s = now_s - 1.0;
      boot = kNone;
    }
    const auto clock = [&] { return clock_at(now_s - booted_s, 1e6 + now_s, std::to_string(boots)); };
    CycleConfig config;
    if (trial > 0) config.start = recall(boot, lasting, clock()).start;
    Controller kept_controller(config), cold_controller(cold);
    for (std::uint64_t cycle = 1; cycle <= 2000; ++cycle) {
      kept_controller.step(still_frame(cycle, 25.0));
      if (trial == 399) cold_controller.step(still_frame(cycle, 25.0));
      reference.step(25.0, 1e-3);
    }
    now_s += kOn_s;
    worst_C = std::max(worst_C, std::abs(kept_controller.thermal(0).winding_C() - reference.winding_C()));
    last_cold_C = cold_controller.thermal(0).winding_C();
    last_reference_C = reference.winding_C();
    StateSample sample = warm();
    for (std::size_t i = 0; i < kMotorCount; ++i) {
      sample.winding_C[i] = kept_controller.thermal(i).winding_C();
      sample.housing_C[i] = kept_controller.thermal(i).housing_C();
    }
    boot = kept(clock(), true, 1.0, sample);
    lasting = kept(clock(), true, 10.0, sample);
    for (int k = 0; k < 5'000; ++k) reference.step(0.0, 1e-3);
    now_s += kPause_s;
  }
  RecordProperty("worst_mC", static_cast<int>(1e3 * worst_C));
  std::printf(
      "400 trials: kept within %.3f C of the reference; cold start believes %.1f C, reference %.1f C\n",
      worst_C, last_cold_C, last_reference_C);
  EXPECT_LT(worst_C, 3.0);
  EXPECT_GT(last_reference_C - last_cold_C, 3.0) << "a cold start must not pass";
}

class StateFolder : public ::testing::Test {
 protected:
  StateFolder() : folder(fs::temp_directory_path() / ("kept_state." + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~StateFolder() override { fs::remove_all(folder); }
  fs::path folder;
};

TEST_F(StateFolder, AFileIsReplacedInOneStepAndNothingElseIsLeft) {
  const auto file = folder / "boot.state";
  const auto first = *kept(clock_at(1.0, 2.0)).state;
  write_state_file(file, first);
  auto second = first;
  second.touchdowns = 7;
  write_state_file(file, second);
  EXPECT_EQ(read_state_file(file).state->touchdowns, 7U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}), 1);
  EXPECT_FALSE(read_state_file(folder / "none").there);
  EXPECT_TRUE(read_state_file(folder).there) << "a directory";
  EXPECT_FALSE(read_state_file(folder).state);
  EXPECT_THROW(write_state_file(folder / "none" / "file", first), std::system_error);
}

TEST_F(StateFolder, TheKeeperWritesBothPlacesAndSaysWhetherTheRunEndedInOrder) {
  const auto places = state_places(folder.string());
  const auto await = [&](const auto& condition) {
    for (int i = 0; i < 200 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return condition();
  };
  std::string said;
  {
    StateKeeper keeper(places, [&](const std::string& text) { said = text; });
    auto sample = warm();
    keeper.newest().publish(sample);
    EXPECT_TRUE(await([&] { return read_state_file(places.lasting).state.has_value(); }));
    EXPECT_FALSE(read_state_file(places.boot).state->closed);
    EXPECT_EQ(read_state_file(places.lasting).state->period_s, StateKeeper::kLastingPeriod_s);
    sample.fault = Fault::imu_stale;
    keeper.newest().publish(sample);
    EXPECT_TRUE(await([&] { return read_state_file(places.lasting).state->fault == Fault::imu_stale; }))
        << "a fault is written before the period ends";
  }
  EXPECT_FALSE(read_state_file(places.boot).state->closed) << "not closed: as if killed";
  StateKeeper keeper(places, [&](const std::string& text) { said = text; });
  keeper.newest().publish(warm());
  keeper.close();
  EXPECT_TRUE(read_state_file(places.boot).state->closed);
  EXPECT_TRUE(read_state_file(places.lasting).state->closed);
  EXPECT_EQ(said, "");
}

TEST_F(StateFolder, WhereNothingCanBeKeptItIsSaidOnce) {
  int times = 0;
  StateKeeper keeper({folder / "none" / "boot.state", folder / "none" / "lasting.state"},
                     [&](const std::string& text) {
                       ++times;
                       EXPECT_THAT(text, HasSubstr("--state"));
                     });
  keeper.newest().publish(warm());
  keeper.close();
  EXPECT_EQ(times, 1);
}

}  // namespace
}  // namespace sandhopper
