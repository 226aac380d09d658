#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/load_cell.hpp"

namespace sandhopper::calibrate {
namespace {

const std::vector<double> kWeights_kg{0.0, 1.0, 2.0, 5.0, 2.0, 1.0, 0.0};

LinuxBoardConfig real_board() {
  LinuxBoardConfig board;
  board.load_cell.scale_N_per_V = 92.5;
  board.load_cell.zero_V = 0.031;
  board.load_cell.sign = -1;
  return board;
}

std::vector<WeighedPoint> weigh(std::uint64_t seed, const std::vector<double>& weights_kg = kWeights_kg) {
  std::vector<Step> steps;
  for (const double mass_kg : weights_kg) {
    steps.push_back({.prompt = "", .fixture = {}, .seconds = 1.0});
    steps.back().fixture.load_N = mass_kg * kGravity_mps2;
  }
  const auto recordings = record_on_sim(
      {}, {}, {.world = {}, .real_robot = {}, .real_board = real_board(), .trial = {.seed = seed}}, steps);
  std::vector<WeighedPoint> points;
  for (std::size_t i = 0; i < recordings.size(); ++i) points.push_back({weights_kg[i], recordings[i]});
  return points;
}

Outcome fit(const std::vector<WeighedPoint>& points) {
  return calibrate_load_cell(points, LoadCellConfig{}, {.gravity_mps2 = kGravity_mps2});
}

// Readings with one value per weight and 0.25 N of noise, for errors that the simulated load cell cannot
// have.
WeighedPoint read_as(double mass_kg, double reading_N, double end_N = 0.0) {
  static std::mt19937 generator(7);
  std::normal_distribution<double> noise(0.0, 0.25);
  WeighedPoint point{mass_kg, {}};
  point.recording.name = "recording";
  for (int i = 0; i < 1000; ++i) {
    const double force_N = reading_N + noise(generator) + (i > 700 ? end_N : 0.0);
    point.recording.load_cell.push_back({i * 1'160'000, force_N, 0, true});
  }
  return point;
}

TEST(CalibrateLoadCell, FindsScaleZeroAndSignWithinTheirIntervals) {
  Coverage scale, zero;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto outcome = fit(weigh(seed));
    ASSERT_EQ(reasons(outcome), "") << outcome.refusals.front().text;
    EXPECT_EQ(value_of(outcome, "load_cell.sign").after, -1.0);
    scale.see(value_of(outcome, "load_cell.scale_N_per_V"), 92.5);
    zero.see(value_of(outcome, "load_cell.zero_V"), 0.031);
    EXPECT_LT(value_of(outcome, "load_cell.scale_N_per_V").ci95, 0.25);
  }
  // 95 % of 20; fewer than 16 have a probability of 1 in 400.
  EXPECT_GE(scale.held, 16);
  EXPECT_GE(zero.held, 16);
}

TEST(CalibrateLoadCell, TheConfigurationThatResultsReadsTheWeights) {
  const auto points = weigh(3);
  const auto outcome = fit(points);
  const double scale = value_of(outcome, "load_cell.scale_N_per_V").after;
  const double zero_V = value_of(outcome, "load_cell.zero_V").after;
  const double voltage_V = 0.031 - 5.0 * kGravity_mps2 / 92.5;
  EXPECT_NEAR(-scale * (voltage_V - zero_V), 5.0 * kGravity_mps2, 0.1);
}

TEST(CalibrateLoadCell, TwoWeightsAreTooFew) {
  EXPECT_EQ(reasons(fit(weigh(1, {0.0, 2.0, 0.0}))), "too_few_points");
}

TEST(CalibrateLoadCell, AWeightThatSlipsWhileItIsRecordedIsRefused) {
  std::vector<WeighedPoint> points;
  for (const double mass_kg : kWeights_kg) points.push_back(read_as(mass_kg, mass_kg * 9.81));
  points[3] = read_as(5.0, 5.0 * 9.81, -1.0);
  EXPECT_EQ(reasons(fit(points)), "slipped");
}

TEST(CalibrateLoadCell, AWeightThatIsNotWhatItsLabelSaysIsNamed) {
  auto points = weigh(2);
  points[3].mass_kg = 5.5;
  const auto outcome = fit(points);
  EXPECT_EQ(reasons(outcome).substr(0, 7), "outlier");
  EXPECT_THAT(outcome.refusals.front().text, ::testing::HasSubstr("without 5.5 kg (reading 4)"));
}

TEST(CalibrateLoadCell, ACellThatIsNotLinearIsRefused) {
  std::vector<WeighedPoint> points;
  for (const double mass_kg : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.0}) {
    const double force_N = mass_kg * 9.81;
    points.push_back(read_as(mass_kg, force_N - 0.0008 * force_N * force_N));
  }
  EXPECT_EQ(reasons(fit(points)).substr(0, 9), "nonlinear");
}

TEST(CalibrateLoadCell, DriftFromWeightToWeightShowsInTheOnesPutOnTwice) {
  std::vector<WeighedPoint> points;
  for (const double mass_kg : kWeights_kg)
    points.push_back(read_as(mass_kg, mass_kg * 9.81 + 0.3 * static_cast<double>(points.size())));
  EXPECT_EQ(reasons(fit(points)).substr(0, 16), "repeats_disagree");
}

TEST(CalibrateLoadCell, DriftWithinARecordingIsRefused) {
  std::vector<WeighedPoint> points;
  for (const double mass_kg : kWeights_kg) points.push_back(read_as(mass_kg, mass_kg * 9.81));
  auto& samples = points[1].recording.load_cell;
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].force_N += 0.001 * static_cast<double>(i);
  EXPECT_EQ(reasons(fit(points)), "drifting");
}

TEST(CalibrateLoadCell, AConverterAtItsEndIsRefused) {
  auto points = weigh(1);
  for (auto& sample : points[3].recording.load_cell) sample.force_N = 409.59;
  EXPECT_THAT(reasons(fit(points)), ::testing::HasSubstr("saturated"));
}

TEST(CalibrateLoadCell, AWeightNobodyRecordedIsRefused) {
  auto points = weigh(1);
  points[2].recording.load_cell.clear();
  EXPECT_EQ(reasons(fit(points)), "too_few_samples");
}

}  // namespace
}  // namespace sandhopper::calibrate
