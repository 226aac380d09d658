#include "tools/campaign/repeated_recordings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandhopper {
namespace {

// A press of 300 rows whose force and depth have their own noise.
TrialRecording press(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  TrialRecording recording;
  recording.channels = {{"foot_z_m", {}}, {"force_N", {}}};
  for (int i = 0; i < 300; ++i) {
    const double depth_m = 2e-4 * i - 0.005;
    recording.t_s.push_back(0.005 * i);
    recording.channels[0].values.push_back(-depth_m + 1e-5 * noise(random));
    recording.channels[1].values.push_back(2000.0 * std::max(0.0, depth_m) + 0.1 * noise(random));
  }
  return recording;
}

// Every `step`-th row from `first` to `end`.
TrialRecording rows_of(const TrialRecording& all, std::size_t first, std::size_t end, std::size_t step) {
  TrialRecording some;
  for (std::size_t row = first; row < end; row += step) some.t_s.push_back(all.t_s[row]);
  for (const auto& channel : all.channels) {
    some.channels.push_back({channel.name, {}});
    for (std::size_t row = first; row < end; row += step)
      some.channels.back().values.push_back(channel.values[row]);
  }
  return some;
}

bool are_one(const TrialRecording& a, const TrialRecording& b) {
  const bool there = have_one_noise(fingerprint_of(a), fingerprint_of(b));
  EXPECT_EQ(have_one_noise(fingerprint_of(b), fingerprint_of(a)), there);
  return there;
}

TEST(RepeatedRecordings, ACopyWithOtherDigitsRowsEndsOrClockIsRecognised) {
  const auto original = press(1);
  auto rounded = original;
  for (auto& z : rounded.channels[0].values) z = std::round(z * 1e5) / 1e5;
  for (auto& force : rounded.channels[1].values) force = std::round(force * 1e2) / 1e2;
  EXPECT_TRUE(are_one(original, rounded));
  EXPECT_TRUE(are_one(original, rows_of(original, 0, 300, 2)));
  EXPECT_TRUE(are_one(original, rows_of(original, 50, 300, 1)));
  EXPECT_TRUE(are_one(original, rows_of(original, 0, 200, 1)));
  auto later = rows_of(original, 30, 300, 1);
  for (auto& t_s : later.t_s) t_s += 7.3;
  EXPECT_TRUE(are_one(original, later));
  auto other_zero = original;
  for (auto& force : other_zero.channels[1].values) force += 12.0;
  EXPECT_TRUE(are_one(original, other_zero));
}

TEST(RepeatedRecordings, TwoMeasurementsOfOneCourseAreNone) {
  for (unsigned seed = 2; seed < 30; ++seed) EXPECT_FALSE(are_one(press(1), press(seed))) << seed;
}

// Two strokes of one file, or two cells on one carriage, are two trials.
TEST(RepeatedRecordings, OtherRowsOrAnotherForceAreNone) {
  const auto original = press(1);
  EXPECT_FALSE(are_one(rows_of(original, 0, 150, 1), rows_of(original, 150, 300, 1)));
  EXPECT_FALSE(are_one(rows_of(original, 0, 160, 1), rows_of(original, 100, 300, 1)));
  auto other_cell = original;
  other_cell.channels[1] = press(2).channels[1];
  EXPECT_FALSE(are_one(original, other_cell));
}

// Two runs with one command: its dither is the same, the motion is not.
TEST(RepeatedRecordings, OneCommandOfTwoMotionsIsNone) {
  auto first = press(1), again = press(1);
  for (std::size_t row = 0; row < first.t_s.size(); ++row) {
    const double t_s = first.t_s[row];
    first.channels[0].values[row] = 1e-4 * std::round(1e4 * 0.02 * std::sin(3.0 * t_s));
    again.channels[0].values[row] = 1e-4 * std::round(1e4 * 0.02 * std::sin(3.1 * t_s));
  }
  EXPECT_FALSE(are_one(first, again));
  auto copy = first;
  for (auto& force : copy.channels[1].values) force = std::round(force * 1e2) / 1e2;
  for (auto& z : copy.channels[0].values) z += 0.01;
  EXPECT_TRUE(are_one(first, copy));
}

TEST(RepeatedRecordings, ALongRecordingIsRecognisedByThePartAroundItsLargestValue) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  TrialRecording recording;
  recording.channels = {{"force_N", {}}};
  for (int i = 0; i < 20000; ++i) {
    recording.t_s.push_back(0.001 * i);
    recording.channels[0].values.push_back(80.0 * std::exp(-1e-7 * std::pow(i - 12000.0, 2)) + noise(random));
  }
  EXPECT_EQ(fingerprint_of(recording).noisy.at(0).values.size(), 4001u);
  EXPECT_TRUE(are_one(recording, rows_of(recording, 3000, 20000, 2)));
}

}  // namespace
}  // namespace sandhopper
