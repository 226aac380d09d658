#include <gmock/gmock.h>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/tof.hpp"

namespace sandhopper::calibrate {
namespace {

const std::vector<double> kHeights_m{0.40, 0.45, 0.50, 0.45, 0.40};

// The sensor's bias of each trial would add to the mounting offset, so it is 0 here.
std::vector<HeightPoint> record(std::uint64_t seed, const std::vector<double>& heights_m = kHeights_m) {
  LinuxBoardConfig real;
  real.tof.mount_offset_m = 0.0374;
  WorldConfig world;
  world.spread.tof_bias_m = 0.0;
  std::vector<Step> steps;
  for (const double height_m : heights_m) {
    steps.push_back({.prompt = "", .fixture = {}, .seconds = 1.0});
    steps.back().fixture.body_height_m = height_m;
  }
  const auto recordings = record_on_sim(
      {}, {}, {.world = world, .real_robot = {}, .real_board = real, .trial = {.seed = seed}}, steps);
  std::vector<HeightPoint> points;
  for (std::size_t i = 0; i < recordings.size(); ++i) points.push_back({heights_m[i], recordings[i]});
  return points;
}

Outcome fit(const std::vector<HeightPoint>& points) { return calibrate_tof(points, TofConfig{}); }

TEST(CalibrateTof, FindsTheOffsetWithinItsInterval) {
  Coverage offset;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto outcome = fit(record(seed));
    ASSERT_EQ(reasons(outcome), "") << outcome.refusals.front().text;
    offset.see(value_of(outcome, "tof.mount_offset_m"), 0.0374);
    EXPECT_LT(value_of(outcome, "tof.mount_offset_m").ci95, 0.001);
  }
  EXPECT_GE(offset.held, 16);
}

TEST(CalibrateTof, TwoHeightsAreTooFew) {
  EXPECT_EQ(reasons(fit(record(1, {0.4, 0.5, 0.4}))), "too_few_points");
}

TEST(CalibrateTof, AHeightThatWasNotMeasuredWellIsNamed) {
  auto points = record(1);
  points[3].height_m = 0.47;
  const auto outcome = fit(points);
  EXPECT_EQ(reasons(outcome).substr(0, 7), "outlier");
  EXPECT_THAT(outcome.refusals.front().text, ::testing::HasSubstr("without height 4"));
}

TEST(CalibrateTof, HeightsThatAreNotThoseOfTheBodyAreRefused) {
  auto points = record(1);
  for (auto& point : points) point.height_m *= 0.9;
  EXPECT_THAT(reasons(fit(points)), ::testing::StartsWith("wrong_slope"));
}

TEST(CalibrateTof, ABodyThatSinksIsRefused) {
  auto points = record(1);
  auto& samples = points[2].recording.tof;
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].height_m -= 6e-5 * static_cast<double>(i);
  EXPECT_EQ(reasons(fit(points)), "drifting");
}

TEST(CalibrateTof, ASensorThatSeesNothingIsRefused) {
  auto points = record(1);
  points[4].recording.tof.resize(20);
  EXPECT_EQ(reasons(fit(points)), "too_few_samples");
}

}  // namespace
}  // namespace sandhopper::calibrate
