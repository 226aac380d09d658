#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

// Sensors whose range ends.
namespace sandhopper::diagnose {
namespace {

// An impact is short: few samples are at the limit, but they are consecutive.
TEST(DiagnoseClipping, ALimitThatIsMetInShortBlowsIsASaturation) {
  auto trials = drops([](double, double, double) { return 0.0; }).trials;
  for (auto& trial : trials)
    for (std::size_t i = 0; i < 9; ++i) {
      auto& a = trial.channels["accel_mps2"][30 + i];
      a = std::min(50.0, a + 60.0 * std::sin(0.1 * std::numbers::pi * static_cast<double>(i + 1)));
    }
  double samples = 0.0;
  for (const auto& trial : trials) samples += static_cast<double>(trial.channels.at("accel_mps2").size());
  const auto faults = remove_data_faults(trials);
  ASSERT_EQ(faults.size(), 1u) << samples << " samples";
  EXPECT_EQ(faults.front().id, "sensor.saturation");
  EXPECT_EQ(faults.front().limit, 50.0);
}

// Steps between 0 and 0.1 N m, then a sweep. `sd_Nm`: noise of a sensor that reads at most 0.1 N m.
std::vector<Trial> steps_and_sweeps(double sd_Nm) {
  std::vector<Trial> trials(4);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    Random random(7, t);
    for (int i = 0; i < 800; ++i) {
      const double time_s = 0.005 * i;
      trials[t].time_s.push_back(time_s);
      const double stepped = i < 100 || i > 600 ? 0.0 : 0.1,
                   swept = 0.08 * std::sin(2.0 * std::numbers::pi * (0.3 + 1.2 * time_s) * time_s);
      trials[t].channels["torque_Nm"].push_back(
          std::min(0.1, (t < 2 ? stepped : swept) + sd_Nm * random.normal()));
    }
  }
  return trials;
}

// A commanded torque has no noise: it stands at its largest value because it was commanded.
TEST(DiagnoseClipping, ACommandThatStepsToItsLargestValueIsNoSaturation) {
  auto commanded = steps_and_sweeps(0.0), measured = steps_and_sweeps(1e-3);
  EXPECT_TRUE(remove_data_faults(commanded).empty());
  const auto faults = remove_data_faults(measured);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().id, "sensor.saturation");
}

TEST(DiagnoseClipping, SamplesThatPileUpAtALimitAreASaturation) {
  auto recordings = drops([](double, double, double v) { return -0.02 * std::abs(v) * v; });
  for (auto& trial : recordings.trials)
    for (double& a : trial.channels["accel_mps2"]) a = std::min(a, 2.0);
  const auto d = diagnose(recordings);
  std::set<std::string> named;
  for (const auto& e : d.effects) named.insert(e.id);
  EXPECT_TRUE(named.contains("sensor.saturation"));
  EXPECT_TRUE(named.contains("air.quadratic_drag"));
}

// A reading that approaches its limit slowly, by 3 % of its noise per sample. If only samples at the limit
// were removed, the mean of the remaining ones would be low by half a standard deviation at the end.
TEST(DiagnoseClipping, WhatIsLeftBelowALimitIsWhatTheQuantityWas) {
  constexpr double kNoise = 0.05, kLimit = 0.6, kPerSample = 0.0015;
  std::vector<Trial> trials(20);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    Random random(7, t);
    for (int i = 0; i < 600; ++i) {
      trials[t].time_s.push_back(0.002 * i);
      const double read = std::min(kPerSample * i + kNoise * random.normal(), kLimit);
      trials[t].channels["accel_mps2"].push_back(1e-3 * std::round(1e3 * read));
    }
  }
  ASSERT_EQ(remove_data_faults(trials).size(), 1u);
  double sum = 0.0, count = 0.0, highest = 0.0;
  for (const auto& trial : trials)
    for (std::size_t i = 300; i < 600; ++i) {
      const double left = trial.channels.at("accel_mps2")[i], was = kPerSample * static_cast<double>(i);
      if (!std::isfinite(left)) continue;
      highest = std::max(highest, was);
      sum += (left - was) / kNoise;
      ++count;
    }
  EXPECT_GT(highest, kLimit - 4.0 * kNoise);  // near enough for the bias to show
  EXPECT_LT(highest, kLimit - 1.5 * kNoise);
  EXPECT_LT(std::abs(sum) / count, 4.0 / std::sqrt(count)) << count << " samples";
}

// At the limit most samples show no noise at all.
TEST(DiagnoseClipping, ALimitThatIsMetMostOfTheTimeIsASaturation) {
  auto trials = drops([](double, double, double v) { return -0.1 * std::abs(v) * v; }).trials;
  for (auto& trial : trials)
    for (double& a : trial.channels["accel_mps2"]) a = 1e-3 * std::round(1e3 * std::min(a, 0.6));
  const auto faults = remove_data_faults(trials);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().id, "sensor.saturation");
  EXPECT_EQ(faults.front().limit, 0.6);
}

// A speed in steps that are nearly as coarse as its noise: noise would not leave it in one step. Without
// noise it does stay in one step where it turns.
TEST(DiagnoseClipping, ALimitShowsInCoarseStepsBecauseTheNoiseIsMissingThere) {
  constexpr double kStep = 0.02;
  const auto faults_of = [](double noise, double limit) {
    std::vector<Trial> trials(3);
    for (std::size_t t = 0; t < trials.size(); ++t) {
      Random random(5, t);
      for (int i = 0; i < 600; ++i) {
        trials[t].time_s.push_back(0.005 * i);
        const double read = std::min(std::sin(0.05 * i) + noise * random.normal(), limit);
        trials[t].channels["velocity_radps"].push_back(kStep * std::round(read / kStep));
      }
    }
    return remove_data_faults(trials);
  };
  const auto faults = faults_of(1.4 * kStep, 0.6);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().id, "sensor.saturation");
  EXPECT_NEAR(faults.front().limit, 0.6, 1e-9);
  EXPECT_FALSE(faults.front().at_both_ends);
  EXPECT_TRUE(faults_of(1.4 * kStep, 9.0).empty());
  EXPECT_TRUE(faults_of(0.1 * kStep, 9.0).empty());
}

// An accelerometer that is at its limit in every sample gives no evidence of anything else.
TEST(DiagnoseClipping, WhereAChannelShowsNothingButItsLimitNothingElseIsNamed) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (auto& trial : recordings.trials) {
    std::ranges::fill(trial.channels["accel_mps2"], 0.6);
    trial.channels.erase("height_m");
  }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "sensor.saturation");
}

// At rest on a hard bed an accelerometer stays at its limit from contact to the end.
TEST(DiagnoseClipping, ALimitThatIsMetUntilTheEndIsNoDropout) {
  auto trials = drops([](double, double, double) { return 0.0; }).trials;
  for (auto& trial : trials) {
    auto& accel = trial.channels["accel_mps2"];
    std::fill(accel.end() - 12, accel.end(), 9.5);
  }
  for (const auto& fault : remove_data_faults(trials)) EXPECT_NE(fault.id, "data.dropout");
}

}  // namespace
}  // namespace sandhopper::diagnose
