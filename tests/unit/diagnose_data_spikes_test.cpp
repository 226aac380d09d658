#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

// Single samples of a position that jump away and back.
namespace sandhopper::diagnose {
namespace {

std::size_t empty_cells(const Trial& trial, const std::string& channel) {
  return static_cast<std::size_t>(
      std::ranges::count_if(trial.channels.at(channel), [](double v) { return std::isnan(v); }));
}

// Trials of `rows` heights at 100 Hz, height_m(row, noise), with a noise of 1 mm.
template <class Height>
std::vector<Trial> heights(std::size_t trials, int rows, const Height& height_m) {
  Random random(4, 1);
  std::vector<Trial> all(trials);
  for (auto& trial : all)
    for (int i = 0; i < rows; ++i) {
      trial.time_s.push_back(0.01 * i);
      trial.channels["height_m"].push_back(height_m(i, 1e-3 * random.normal()));
    }
  return all;
}

TEST(DiagnoseDataSpikes, AreLeftOutAndNoted) {
  auto recordings = presses([](double, double) { return 0.0; }, 2, 6);
  for (auto& trial : recordings.trials) {
    auto& z = trial.channels.at("foot_z_m");
    z[30] -= 0.08;
    z[61] += 0.2;
    z[62] += 0.19;
  }
  auto trials = recordings.trials;
  const auto faults = remove_data_faults(trials);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().id, "data.spike");
  EXPECT_EQ(faults.front().stretches, 12u);
  EXPECT_NEAR(faults.front().limit, 0.2, 0.01);
  for (const auto& trial : trials) EXPECT_EQ(empty_cells(trial, "foot_z_m"), 3u);

  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  EXPECT_TRUE(std::ranges::any_of(d.notes, [](const auto& note) {
    return note.starts_with("foot_z_m: jumps away and back") && note.find("12 times in 6 of 6") != note.npos;
  }));
}

// A ball that bounces is at its lowest in one row only; a force may jump at any time.
TEST(DiagnoseDataSpikes, ABounceOrABlowIsNone) {
  Random random(3, 1);
  std::vector<Trial> trials(3);
  for (auto& trial : trials)
    for (int i = 0; i < 60; ++i) {
      const double t = std::fmod(i / 30.0 + 0.017, 0.6) - 0.3;
      trial.time_s.push_back(i / 30.0);
      trial.channels["height_m"].push_back(4.905 * (0.09 - t * t));
      trial.channels["force_N"].push_back((i % 18 == 9 ? 50.0 : 0.0) + 0.1 * random.normal());
    }
  EXPECT_TRUE(remove_data_faults(trials).empty());
}

// Two kinds of reading that are no spikes: too long, and no farther than the noise goes.
TEST(DiagnoseDataSpikes, ThreeSamplesOrTheNoiseAreNone) {
  auto trials = heights(2, 200, [](int i, double noise_m) {
    return 1.0 - 0.1 * 0.01 * i + noise_m + (i >= 100 && i < 103 ? 0.1 : 0.0);
  });
  EXPECT_TRUE(remove_data_faults(trials).empty());
}

// A sensor that falls to the same value every time has dropouts, which are a fault.
TEST(DiagnoseDataSpikes, ADropoutIsNone) {
  auto trials = heights(
      6, 300, [](int i, double noise_m) { return i % 50 == 20 ? 0.0 : 6.0 - 0.5 * 0.01 * i + noise_m; });
  const auto faults = remove_data_faults(trials);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().id, "data.dropout");
}

}  // namespace
}  // namespace sandhopper::diagnose
