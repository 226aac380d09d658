#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "read_campaign.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto kHead = "plant = \"rotary_axis\"\n";

// A chirp of 0.8 rad from 0.6 to 1.8 Hz; its speed in other units, and limited by its sensor.
std::string chirp(double per_radps, double limit) {
  std::string csv = "t_s,position_rad,velocity_radps\n";
  for (int i = 0; i < 800; ++i) {
    const double t = 0.005 * i, phase = 6.2832 * (0.6 * t + 0.15 * t * t);
    const double speed = 0.8 * std::cos(phase) * 6.2832 * (0.6 + 0.3 * t);
    const double noise = 0.02 * std::sin(1000.0 * i * i);
    csv += fmt::format("{:.4f},{:.5f},{:.4f}\n", t, 0.8 * std::sin(phase),
                       std::clamp(per_radps * (speed + noise), -limit, limit));
  }
  return csv;
}

TEST(Rates, AClippedSpeedIsNoSpeedInAnotherUnit) {
  for (const double limit : {0.3, 0.6, 1.0}) {
    const auto told = read_campaign(kHead, chirp(1.0, limit));
    EXPECT_TRUE(told.recording.usable()) << told.text;
    EXPECT_THAT(told.text, Not(HasSubstr("the rate of position_rad")));
  }
}

TEST(Rates, ASpeedInAnotherUnitIsFoundClippedOrNot) {
  for (const double limit : {1e9, 100.0}) {
    const auto told = read_campaign(kHead, chirp(57.29578, limit));
    EXPECT_FALSE(told.recording.usable()) << limit;
    EXPECT_THAT(told.text, HasSubstr("the speed in deg/s")) << limit;
  }
}

TEST(Rates, ASpeedOfTheOtherSideOfAGearIsFoundAndAGainErrorIsNot) {
  for (const double ratio : {2.0, 3.0, 0.5, 1.0 / 3.0}) {
    const auto told = read_campaign(kHead, chirp(ratio, 1e9));
    EXPECT_FALSE(told.recording.usable()) << ratio;
    EXPECT_THAT(told.text, HasSubstr("of a gear side")) << ratio;
  }
  for (const double gain : {0.9, 1.1, 1.5, 1.8, 2.2}) {
    const auto told = read_campaign(kHead, chirp(gain, 1e9));
    EXPECT_TRUE(told.recording.usable()) << told.text;
  }
}

// A commanded speed is flat at its largest value without being clipped.
TEST(Rates, AnEvenStrokeInAnotherUnitIsFound) {
  std::string csv = "t_s,position_rad,velocity_radps\n";
  for (int i = 0; i < 600; ++i) {
    const double t = 0.01 * i, speed = 0.3 * std::clamp(std::min(t - 1.0, 5.0 - t) / 0.1, 0.0, 1.0);
    const double way = 0.3 * std::clamp(t - 1.05, 0.0, 3.9);
    csv += fmt::format("{:.4f},{:.5f},{:.4f}\n", t, way, 1000.0 * speed);
  }
  const auto told = read_campaign(kHead, csv);
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("1000: the speed"));
}

}  // namespace
}  // namespace sandhopper
