#include <gtest/gtest.h>

#include <cmath>

#include "tools/diagnose/recordings/data_fault_parts.hpp"
#include "tools/plant/random.hpp"

// Limits of the data faults: each with a case just inside and one just outside.
namespace sandhopper::diagnose {
namespace {

// Rows of 1 ms without those that `gaps` gaps of `lost` rows each leave out; at least eight rows between
// gaps.
Trial with_gaps(std::size_t rows, std::size_t gaps, std::size_t lost) {
  Trial trial;
  std::size_t at = 0;
  for (std::size_t row = 0; row < rows; ++row, ++at) {
    if (row > 0 && row % 12 == 0 && row / 12 <= gaps) at += lost;
    trial.time_s.push_back(1e-3 * static_cast<double>(at));
  }
  return trial;
}

bool loses_rows(const std::vector<Trial>& trials) {
  std::vector<DataFault> faults;
  find_lost_rows(trials, faults);
  return !faults.empty();
}

TEST(DiagnoseFaultLimits, ShortGapsAreAFaultFromTwelvePerCentOn) {
  EXPECT_FALSE(loses_rows({with_gaps(1000, 55, 2)}));
  EXPECT_TRUE(loses_rows({with_gaps(1000, 65, 2)}));
}

TEST(DiagnoseFaultLimits, LongGapsFromOnePerCentOn) {
  EXPECT_FALSE(loses_rows({with_gaps(1300, 2, 6)}));
  EXPECT_TRUE(loses_rows({with_gaps(1100, 2, 6)}));
  EXPECT_FALSE(loses_rows({with_gaps(1000, 3, 5)})) << "no long gaps";
}

TEST(DiagnoseFaultLimits, GapsComeTwiceATrialAndInHalfOfTheTrials) {
  const auto trials = [](std::size_t once, std::size_t twice, std::size_t often, std::size_t without) {
    std::vector<Trial> all;
    for (const auto& [count, gaps] : {std::pair{once, 1}, {twice, 2}, {often, 3}, {without, 0}})
      for (std::size_t i = 0; i < count; ++i) {
        all.push_back(with_gaps(500, static_cast<std::size_t>(gaps), 20));
        all.back().name = std::to_string(all.size());
      }
    return all;
  };
  EXPECT_FALSE(loses_rows(trials(1, 9, 0, 0)));
  EXPECT_TRUE(loses_rows(trials(0, 9, 1, 0)));
  EXPECT_FALSE(loses_rows(trials(0, 4, 0, 6)));
  EXPECT_TRUE(loses_rows(trials(0, 6, 0, 4)));
}

std::vector<Trial> one_trial(const std::string& channel, std::vector<double> values) {
  Trial trial;
  trial.name = "1";
  for (std::size_t i = 0; i < values.size(); ++i) trial.time_s.push_back(1e-3 * static_cast<double>(i));
  trial.channels[channel] = std::move(values);
  return {std::move(trial)};
}

template <class Find>
bool finds(Find find, const std::string& channel, std::vector<double> values) {
  auto trials = one_trial(channel, std::move(values));
  std::vector<DataFault> faults;
  find(trials, channel, faults);
  return !faults.empty();
}

std::vector<double> ramp(std::size_t samples, double per_sample = 1.0) {
  std::vector<double> values;
  for (std::size_t i = 0; i < samples; ++i) values.push_back(per_sample * static_cast<double>(i));
  return values;
}

bool has_spike(std::vector<double> values) { return finds(find_spikes, "position_rad", std::move(values)); }

TEST(DiagnoseFaultLimits, ASpikeIsEightTimesWhatSamplesChangeBy) {
  for (const double least : {7.8, 8.2}) {
    auto values = ramp(1000);
    values[500] += least + 1.0;  // the sample after it is nearer by one step
    EXPECT_EQ(has_spike(values), least > 8.0);
  }
}

TEST(DiagnoseFaultLimits, ItComesBackToHalfOfItsSize) {
  for (const double apart : {18.0, 22.0}) {
    auto values = ramp(1000);
    for (std::size_t i = 501; i < values.size(); ++i) values[i] += apart - 2.0;
    values[500] = values[501] + 40.0;
    EXPECT_EQ(has_spike(values), apart < 20.0);
  }
}

TEST(DiagnoseFaultLimits, ItLastsTwoSamplesAtMost) {
  for (const std::size_t samples : {2U, 3U}) {
    auto values = ramp(1000);
    for (std::size_t i = 500; i < 500 + samples; ++i) values[i] += 100.0;
    EXPECT_EQ(has_spike(values), samples == 2);
  }
}

// The fourth to the sixth change on each side are large: half of the twelve that count.
TEST(DiagnoseFaultLimits, SixChangesOnEachSideCount) {
  auto values = ramp(1000);
  for (const std::size_t i : {494U, 495U, 496U, 505U, 506U, 507U})
    for (std::size_t k = i; k < values.size(); ++k) values[k] += 9.0;
  values[500] += 30.0;
  EXPECT_FALSE(has_spike(values));
}

// Noise of a standard deviation on a grid of 0.01, with samples at a limit of 2 in runs of these lengths.
bool is_clipped(std::size_t samples, const std::vector<std::size_t>& runs, double sd = 0.05) {
  Random random(5, 0);
  std::vector<double> values;
  for (std::size_t i = 0; i < samples; ++i) values.push_back(0.01 * std::round(100.0 * sd * random.normal()));
  const std::size_t apart = samples / (runs.size() + 1);
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (std::size_t k = 0; k < runs[r]; ++k) values[(r + 1) * apart + k] = 2.0;
  return finds(find_clipping, "force_N", std::move(values));
}
std::vector<std::size_t> lone(std::size_t count) { return std::vector<std::size_t>(count, 1); }

TEST(DiagnoseFaultLimits, SamplesPileUpFromOnePerCentOn) {
  EXPECT_FALSE(is_clipped(1000, lone(9)));
  EXPECT_TRUE(is_clipped(1000, lone(11)));
}

TEST(DiagnoseFaultLimits, SixSamplesPileUp) {
  EXPECT_FALSE(is_clipped(400, lone(5)));
  EXPECT_TRUE(is_clipped(400, lone(7)));
}

TEST(DiagnoseFaultLimits, OrFourPairsInARow) {
  EXPECT_FALSE(is_clipped(3000, {2, 2, 2, 1, 1}));
  EXPECT_TRUE(is_clipped(3000, {3, 3, 2}));
}

TEST(DiagnoseFaultLimits, EqualSamplesProveSomethingIfNoiseIsThreeStepsOfTheGrid) {
  EXPECT_FALSE(is_clipped(1000, lone(20), 0.025));
  EXPECT_TRUE(is_clipped(1000, lone(20), 0.035));
}

// A slow torque from 10 to 11 with stretches of five samples at a code.
bool falls_out(std::size_t stretches, double code) {
  std::vector<double> values;
  for (std::size_t i = 0; i < 1001; ++i) values.push_back(10.0 + 1e-3 * static_cast<double>(i));
  for (std::size_t s = 0; s < stretches; ++s)
    for (std::size_t k = 0; k < 5; ++k) values[100 * (s + 1) + k] = code;
  return finds(find_dropouts, "torque_Nm", std::move(values));
}

TEST(DiagnoseFaultLimits, ThreeStretchesProveThatAChannelFallsOut) {
  EXPECT_FALSE(falls_out(2, 0.0));
  EXPECT_TRUE(falls_out(4, 0.0));
}

TEST(DiagnoseFaultLimits, ACodeLiesThirtyPerCentOfTheRangeFromAllOthers) {
  EXPECT_FALSE(falls_out(6, 9.75));
  EXPECT_TRUE(falls_out(6, 9.65));
}

}  // namespace
}  // namespace sandhopper::diagnose
