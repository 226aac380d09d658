#include "firmware/supervision/end_stop.hpp"

#include <gtest/gtest.h>

#include "config/robot_config.hpp"

namespace sandhopper {
namespace {

bool strikes(double accel_mps2, const CycleConfig& config = cycle_config(RobotConfig{})) {
  ImuSample body;
  body.accel_mps2 = {0.0, 0.0, accel_mps2};
  return strikes_end_stop(body, config);
}

// Half of 250 N at a body of 1.6 kg: 78.125 m/s^2.
TEST(EndStop, IsABlowOfHalfTheLoadCellsRangeOnTheBody) {
  EXPECT_FALSE(strikes(78.0));
  EXPECT_TRUE(strikes(78.2));
}

TEST(EndStop, HangingStandingAndFallingAreNone) {
  for (const double accel_mps2 : {9.81, 0.0, 3.0 * 9.81}) EXPECT_FALSE(strikes(accel_mps2));
}

TEST(EndStop, ABlowDownwardsIsNone) { EXPECT_FALSE(strikes(-150.0)); }

TEST(EndStop, AHeavierBodyNeedsLessAcceleration) {
  auto config = cycle_config(RobotConfig{});
  config.robot.body_mass_kg *= 2.0;
  EXPECT_TRUE(strikes(40.0, config));
  EXPECT_FALSE(strikes(38.0, config));
}

TEST(EndStop, NoNumberIsNone) { EXPECT_FALSE(strikes(kNotMeasured)); }

}  // namespace
}  // namespace sandhopper
